//! A wavefront: one ray, emitter point and variate per pixel, as a renderer hands it over in an .npz file.

use crate::npy;
use airlight::{Emitter, Emitters, Error, Ray, Rays};
use anyhow::{Context, Result, bail, ensure};
use glam::Vec3;
use std::io::{Cursor, Read};
use std::path::Path;
use zip::ZipArchive;
use zip::result::ZipError;

/// The wavefront that is built in, described in `data/README.md`.
const CORNELL: &[u8] = include_bytes!("../data/cornell.npz");

/// The columns of a wavefront, all of the same length, which is not 0.
#[derive(Debug)]
pub(crate) struct Wavefront {
    /// What it is called in reports.
    pub(crate) name: String,
    origin: [Vec<f32>; 3],
    direction: [Vec<f32>; 3],
    t_min: Vec<f32>,
    t_max: Vec<f32>,
    position: [Vec<f32>; 3],
    normal: [Vec<f32>; 3],
    /// The variates of the first repetition.
    pub(crate) u: Vec<f32>,
}

impl Wavefront {
    /// Reads the wavefront at `path`.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let name = path.display().to_string();
        let file = std::fs::read(path).with_context(|| format!("cannot read {name}"))?;
        Self::decode(name.clone(), &file).context(name)
    }

    /// The Cornell box in fog.
    pub(crate) fn cornell() -> Result<Self> {
        let name = "cornell".to_owned();
        Self::decode(name.clone(), CORNELL).context(name)
    }

    fn decode(name: String, file: &[u8]) -> Result<Self> {
        let mut archive = Archive::open(file)?;
        let wavefront = Self {
            name,
            origin: archive.columns(["ox", "oy", "oz"])?,
            direction: archive.columns(["dx", "dy", "dz"])?,
            t_min: archive.column("t_min")?,
            t_max: archive.column("t_max")?,
            position: archive.columns(["ex", "ey", "ez"])?,
            normal: archive.columns(["nx", "ny", "nz"])?,
            u: archive.column("u")?,
        };
        ensure!(wavefront.len() > 0, "the wavefront is empty: its columns have no values");
        Ok(wavefront)
    }

    /// The number of its rays.
    pub(crate) fn len(&self) -> usize {
        self.u.len()
    }

    /// The first `count` rays.
    pub(crate) fn rays(&self, count: usize) -> Rays<'_> {
        Rays {
            origin: first(&self.origin, count),
            direction: first(&self.direction, count),
            t_min: &self.t_min[..count],
            t_max: &self.t_max[..count],
        }
    }

    /// The emitters of the first `count` rays.
    pub(crate) fn emitters(&self, count: usize) -> Emitters<'_> {
        Emitters::Each { position: first(&self.position, count), normal: first(&self.normal, count) }
    }

    /// Ray number `i`.
    pub(crate) fn ray(&self, i: usize) -> Result<Ray, Error> {
        Ray::new(vector(&self.origin, i), vector(&self.direction, i), self.t_min[i], self.t_max[i])
    }

    /// The emitter of ray number `i`.
    pub(crate) fn emitter(&self, i: usize) -> Result<Emitter, Error> {
        let (position, normal) = (vector(&self.position, i), vector(&self.normal, i));
        if normal == Vec3::ZERO { Emitter::point(position) } else { Emitter::point_normal(position, normal) }
    }
}

fn first(columns: &[Vec<f32>; 3], count: usize) -> [&[f32]; 3] {
    columns.each_ref().map(|column| &column[..count])
}

fn vector(columns: &[Vec<f32>; 3], i: usize) -> Vec3 {
    Vec3::from_array(columns.each_ref().map(|column| column[i]))
}

/// An .npz file, whose columns must be of one length.
struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    /// The first column and its length.
    reference: Option<(&'static str, usize)>,
}

impl<'a> Archive<'a> {
    fn open(file: &'a [u8]) -> Result<Self> {
        let zip = ZipArchive::new(Cursor::new(file)).context("not a complete .npz file")?;
        Ok(Self { zip, reference: None })
    }

    fn columns(&mut self, names: [&'static str; 3]) -> Result<[Vec<f32>; 3]> {
        let [x, y, z] = names;
        Ok([self.column(x)?, self.column(y)?, self.column(z)?])
    }

    fn column(&mut self, name: &'static str) -> Result<Vec<f32>> {
        let values = match self.file(name) {
            Ok(file) => npy::decode(&file),
            Err(error) => Err(error),
        }
        .with_context(|| format!("column '{name}'"))?;
        let (first, length) = *self.reference.get_or_insert((name, values.len()));
        if values.len() != length {
            bail!("column '{name}' has {} values, column '{first}' has {length}", values.len());
        }
        Ok(values)
    }

    fn file(&mut self, name: &str) -> Result<Vec<u8>> {
        let mut entry = match self.zip.by_name(&format!("{name}.npy")) {
            Err(ZipError::FileNotFound) => bail!("is missing"),
            entry => entry?,
        };
        let mut file = Vec::new();
        entry.read_to_end(&mut file).context("the data are corrupt")?;
        Ok(file)
    }
}
