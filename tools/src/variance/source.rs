//! Where the scenes come from.

use crate::check::spread;
use crate::validity::Validity;
use crate::wavefront::Wavefront;
use airlight::Medium;
use airlight::oracle::Coloured;
use airlight_tools::scenes::Set;
use anyhow::{Context, Result, ensure};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Named sets, or a wavefront file.
#[derive(Clone, Debug)]
pub(super) enum Source {
    Sets(Vec<Set>),
    File(PathBuf),
}

impl FromStr for Source {
    type Err = String;
    fn from_str(name: &str) -> Result<Self, String> {
        let path = Path::new(name);
        match Set::named(name) {
            Some(sets) => Ok(Self::Sets(sets)),
            None if path.extension().is_some_and(|extension| extension == "npz") || path.exists() => {
                Ok(Self::File(path.to_owned()))
            }
            None => Err(format!(
                "no set is called '{name}'; there are broad, generic, dense, tame, spot, colour, colour-strong, canonical, and any FILE.npz of a wavefront"
            )),
        }
    }
}

impl Source {
    /// How many sets it is.
    pub(super) fn count(&self) -> usize {
        match self {
            Self::Sets(sets) => sets.len(),
            Self::File(_) => 1,
        }
    }

    /// Every set's name and its `count` scenes; of a wavefront at most that many of its rays, spread over it, in
    /// `medium`, less those that are invalid or not lit.
    pub(super) fn scenes(&self, medium: &Medium, seed: u64, count: usize) -> Result<Vec<(String, Vec<Coloured>)>> {
        match self {
            Self::Sets(sets) => Ok(sets.iter().map(|set| (set.name().to_owned(), set.coloured(seed, count))).collect()),
            Self::File(path) => {
                let wavefront = Wavefront::read(path)?;
                let validity = Validity::of(wavefront.len(), |i| wavefront.ray(i).map(|_| ()));
                let valid = validity.first(wavefront.len()).with_context(|| wavefront.name.clone())?;
                if let Some(invalid) = &validity.invalid {
                    eprintln!("{}: {invalid}", wavefront.name);
                }
                let scene =
                    |i: usize| wavefront.ray(valid[i]).map(|(ray, emitter)| Coloured::new(&ray, &emitter, medium));
                let drawn = spread(valid.len(), count.min(valid.len()), seed);
                let scenes: Vec<Coloured> =
                    drawn.into_iter().flat_map(scene).filter(|scene| scene.mean().lit().is_some()).collect();
                ensure!(!scenes.is_empty(), "{}: none of the rays is lit", wavefront.name);
                Ok(vec![(wavefront.name, scenes)])
            }
        }
    }
}
