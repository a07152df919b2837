//! Kernels of others, out of shared libraries with the functions `peer_*` on a `PeerBatch`, one for each width.

use super::subject::{Subject, TOTAL};
use crate::arguments;
use airlight::oracle::Scene;
use airlight::{Backend, Ray, Samples, Strategy};
use airlight_tools::errors::quantile;
use airlight_tools::workload::{Call, EMITTER, MEDIUM, Wanted, Workload, emitter, medium};
use anyhow::{Context, Result};
use libloading::Library;
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Where a library is, and the backend whose width it has; none is the widest that is measured.
#[derive(Clone, Debug)]
pub(super) struct Source {
    pub(super) backend: Option<Backend>,
    pub(super) path: PathBuf,
}

impl FromStr for Source {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            // A path of several parts may have a sign in one of them.
            Some((name, path)) if !name.contains(['/', '\\']) => {
                Ok(Self { backend: Some(arguments::backend(name)?), path: path.into() })
            }
            _ => Ok(Self { backend: None, path: text.into() }),
        }
    }
}

/// A kernel of theirs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Peer {
    EquiAngular,
    PointNormal,
    /// 4 plain steps of Newton's method.
    TaylorTransmittance4,
    /// 8 steps in a bracket.
    TaylorTransmittance8,
}

impl Peer {
    pub(super) const ALL: [Self; 4] =
        [Self::EquiAngular, Self::PointNormal, Self::TaylorTransmittance4, Self::TaylorTransmittance8];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::EquiAngular => "equi-angular",
            Self::PointNormal => "point-normal",
            Self::TaylorTransmittance4 => "taylor-transmittance-4",
            Self::TaylorTransmittance8 => "taylor-transmittance-8",
        }
    }

    /// The one that a strategy is measured against.
    pub(super) fn of(strategy: Strategy) -> Option<Self> {
        match strategy {
            Strategy::EquiAngular => Some(Self::EquiAngular),
            Strategy::PointNormal => Some(Self::PointNormal),
            Strategy::TaylorTransmittance => Some(Self::TaylorTransmittance8),
            Strategy::Product5 | Strategy::Product9 => Some(Self::TaylorTransmittance4),
            _ => None,
        }
    }

    /// What it samples.
    fn strategy(self) -> Strategy {
        match self {
            Self::EquiAngular => Strategy::EquiAngular,
            Self::PointNormal => Strategy::PointNormal,
            Self::TaylorTransmittance4 | Self::TaylorTransmittance8 => Strategy::TaylorTransmittance,
        }
    }

    fn symbol(self) -> &'static str {
        match self {
            Self::EquiAngular => "peer_equiangular",
            Self::PointNormal => "peer_point_normal",
            Self::TaylorTransmittance4 => "peer_taylor_transmittance_4",
            Self::TaylorTransmittance8 => "peer_taylor_transmittance_8",
        }
    }
}

/// Their batch: one emitter and one medium, no `t_min`.
#[repr(C)]
struct Batch {
    /// Origin and direction, `t_max`, `u`.
    inputs: [*const f32; 8],
    t: *mut f32,
    pdf: *mut f32,
    /// The emitter's position and normal, `mu_t`.
    parameters: *const f32,
}

/// Samples the rays from one index up to another.
type Kernel = unsafe extern "C" fn(*const Batch, usize, usize);

/// The kernels of a library.
#[derive(Debug)]
pub(super) struct Peers {
    /// The one of their width.
    pub(super) backend: Backend,
    kernels: [Kernel; Peer::ALL.len()],
    /// Keeps their code in memory.
    _library: Library,
}

impl Peers {
    pub(super) fn load(path: &Path, backend: Backend) -> Result<Self> {
        let name = path.display();
        // SAFETY: whoever names the library vouches for what its initialisers do.
        let library = unsafe { Library::new(path) }.with_context(|| format!("cannot load {name}"))?;
        let mut kernels = Vec::new();
        for peer in Peer::ALL {
            // SAFETY: and for the type of what it calls so; the kernel is called while the library is there.
            let kernel = unsafe { library.get::<Kernel>(peer.symbol()) };
            kernels.push(*kernel.with_context(|| format!("{name} has no {}", peer.symbol()))?);
        }
        let kernels = kernels.try_into().expect("one for each");
        Ok(Self { backend, kernels, _library: library })
    }

    /// Of a time of one of them, where the rest of the subject is known.
    pub(super) fn subject(&self, peer: Peer, of: Subject) -> Subject {
        Subject { peer: Some(peer.name()), backend: Some(self.backend.name()), stage: Some(TOTAL), ..of }
    }

    /// What 0.1 % of the first `rays` rays that are lit and have a sample exceed in `|CDF(t) - u|`.
    pub(super) fn cdf_p999(&self, peer: Peer, rays: usize, workload: &mut Workload) -> f64 {
        let cases = workload.one_by_one(rays);
        let mut call = workload.call(rays, 1, Wanted::Densities);
        self.sample(peer, &mut call);
        let (emitter, medium) = (emitter(), medium());
        let error = |(((ray, u), &t), &pdf): ((&(Ray, f32), &f32), &f32)| {
            let scene = Scene::new(ray, &emitter, &medium);
            let error = (scene.cdf(peer.strategy(), t.into()) - f64::from(*u)).abs();
            // What is no number is as bad as can be.
            (pdf > 0.0 && scene.lit().is_some()).then_some(if error < 1.0 { error } else { 1.0 })
        };
        let drawn = cases.par_iter().zip(&*call.samples.t).zip(&*call.samples.pdf);
        let mut errors: Vec<f64> = drawn.filter_map(error).collect();
        errors.sort_by(f64::total_cmp);
        quantile(&errors, 0.999)
    }

    /// Draws one sample for every ray.
    pub(super) fn sample(&self, peer: Peer, call: &mut Call<'_>) {
        let [[ox, oy, oz], [dx, dy, dz]] = [call.rays.origin, call.rays.direction];
        let inputs = [ox, oy, oz, dx, dy, dz, call.rays.t_max, call.u];
        let [position, normal] = EMITTER.map(|v| v.to_array());
        let [mu_a, mu_s, _] = MEDIUM;
        let parameters: Vec<f32> = [position, normal].concat().into_iter().chain([mu_a + mu_s]).collect();
        let Samples { t, pdf, .. } = &mut call.samples;
        let n = ox.len();
        assert!(inputs.iter().all(|column| column.len() == n) && t.len() == n && pdf.len() == n);
        let batch = Batch {
            inputs: inputs.map(<[f32]>::as_ptr),
            t: t.as_mut_ptr(),
            pdf: pdf.as_mut_ptr(),
            parameters: parameters.as_ptr(),
        };
        // SAFETY: all columns have n values, and those that are written are borrowed mutably.
        unsafe { self.kernels[peer as usize](&raw const batch, 0, n) };
    }
}
