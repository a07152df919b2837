//! Kernels of others, out of a shared library with the functions `peer_*` on a `PeerBatch`.

use airlight::{Samples, Strategy};
use airlight_tools::workload::{Call, EMITTER, MEDIUM};
use anyhow::{Context, Result};
use libloading::Library;
use std::path::Path;

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

/// Their kernels.
#[derive(Debug)]
pub(super) struct Peers {
    kernels: [Kernel; Peer::ALL.len()],
    /// Keeps their code in memory.
    _library: Library,
}

impl Peers {
    pub(super) fn load(path: &Path) -> Result<Self> {
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
        Ok(Self { kernels, _library: library })
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
