//! Borrowed columns of a batch: rays, emitters, media in, samples out, and how they are split.

use crate::Error;
use crate::geometry::{EmitterLanes, RayLanes};
use crate::integrand::MediumLanes;
use crate::scene::{Emitter, Medium};
use crate::simd::{Isa, Lanes, MOST_LANES};
use core::ops::Range;

/// A batch of rays as a structure of arrays; every column has the length of the batch and any alignment.
///
/// The values mean what they mean in [`Ray::new`](crate::Ray::new). A ray whose values are out of range there is
/// *invalid*: it is counted, and what is written for it is zero.
#[derive(Clone, Copy, Debug)]
pub struct Rays<'a> {
    /// Where the rays start, x, y, z \[m\].
    pub origin: [&'a [f32]; 3],
    /// Where they go, x, y, z, of length 1 within [`UNIT_TOLERANCE`](crate::UNIT_TOLERANCE).
    pub direction: [&'a [f32]; 3],
    /// Where they enter the medium \[m\].
    pub t_min: &'a [f32],
    /// Where they leave it \[m\], may be infinite.
    pub t_max: &'a [f32],
}

/// The emitter of each ray.
#[derive(Clone, Copy, Debug)]
pub enum Emitters<'a> {
    /// One for the whole batch.
    One(Emitter),
    /// One per ray, as columns of the batch's length.
    Each {
        /// Positions, x, y, z \[m\].
        position: [&'a [f32]; 3],
        /// Unit normals, x, y, z; the normal (0, 0, 0) stands for a point emitter.
        normal: [&'a [f32]; 3],
    },
}

/// The medium of each ray.
#[derive(Clone, Copy, Debug)]
pub enum Media<'a> {
    /// One for the whole batch.
    One(Medium),
    /// One per ray, as columns of the batch's length; the values mean what they mean in [`Medium::new`].
    Each {
        /// Absorption coefficients \[1/m\].
        mu_a: &'a [f32],
        /// Scattering coefficients \[1/m\].
        mu_s: &'a [f32],
        /// Mean cosines \[1\].
        g: &'a [f32],
    },
}

/// Where a batch of samples is written; every column has the length of the variates: that of the batch, or a multiple of
/// it, the samples of one ray next to each other.
#[derive(Debug)]
pub struct Samples<'a> {
    /// Distances along the rays, in `[t_min, t_max]` \[m\].
    pub t: &'a mut [f32],
    /// Probability densities over distance \[1/m\]; one below f32's range is 0.
    pub pdf: &'a mut [f32],
    /// `mu_s T rho N / (r^2 pdf)`: the one-sample estimate of the ray's single-scattered radiance per unit of the
    /// emitter's intensity \[1/m^2\], with `1/r^2` cancelled analytically and `T` counted from `t_min`.
    pub weight: Option<&'a mut [f32]>,
    /// Distances from the samples to the emitters \[m\], exact also where `t` alone cannot resolve them.
    pub r: Option<&'a mut [f32]>,
}

/// What became of the rays of a batch: `sampled + empty + invalid` is its length. Where a call has several variates or
/// distances for each ray, every one of them counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Counts {
    /// Rays with a sample.
    pub sampled: usize,
    /// Valid rays without one: `t_min = t_max`, or no point of the ray is lit, or less than f32 can say anything about:
    /// an interval shorter than 1e-18 m, or than 1e-36 of `r^2`, or that subtends 1e-30 rad, or 1e-25 of the light.
    pub empty: usize,
    /// Rays with a value that is NaN or out of range.
    pub invalid: usize,
    /// Sampled rays whose Newton iteration fell back to bisection at least once.
    pub bisected: usize,
}

impl std::ops::Add for Counts {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self {
            sampled: self.sampled + o.sampled,
            empty: self.empty + o.empty,
            invalid: self.invalid + o.invalid,
            bisected: self.bisected + o.bisected,
        }
    }
}

/// The columns that a call reads: the batch, and for each ray some numbers (variates, or distances) next to each other.
#[derive(Clone, Copy)]
pub(crate) struct Inputs<'a> {
    pub(crate) rays: Rays<'a>,
    pub(crate) emitters: Emitters<'a>,
    pub(crate) media: Media<'a>,
    pub(crate) given: &'a [f32],
    /// How many of them each ray has.
    pub(crate) per_ray: usize,
}

impl<'a> Inputs<'a> {
    /// The inputs, if every column has the same length; nothing is given yet.
    pub(crate) fn new(rays: &Rays<'a>, emitters: &Emitters<'a>, media: &Media<'a>) -> Result<Self, Error> {
        let inputs = Self { rays: *rays, emitters: *emitters, media: *media, given: &[], per_ray: 0 };
        const O: [&str; 3] = ["rays.origin[0]", "rays.origin[1]", "rays.origin[2]"];
        const D: [&str; 3] = ["rays.direction[0]", "rays.direction[1]", "rays.direction[2]"];
        const P: [&str; 3] = ["emitters.position[0]", "emitters.position[1]", "emitters.position[2]"];
        const N: [&str; 3] = ["emitters.normal[0]", "emitters.normal[1]", "emitters.normal[2]"];
        for k in 0..3 {
            inputs.check(O[k], rays.origin[k])?;
            inputs.check(D[k], rays.direction[k])?;
        }
        inputs.check("rays.t_min", rays.t_min)?;
        inputs.check("rays.t_max", rays.t_max)?;
        if let Emitters::Each { position, normal } = emitters {
            for k in 0..3 {
                inputs.check(P[k], position[k])?;
                inputs.check(N[k], normal[k])?;
            }
        }
        if let Media::Each { mu_a, mu_s, g } = media {
            inputs.check("media.mu_a", mu_a)?;
            inputs.check("media.mu_s", mu_s)?;
            inputs.check("media.g", g)?;
        }
        Ok(inputs)
    }

    /// The same with `given`, if its length is that of the batch or a multiple; `name` is what it is called.
    pub(crate) fn with(self, given: &'a [f32], name: &'static str) -> Result<Self, Error> {
        let (length, expected) = (given.len(), self.len());
        let per_ray = length.checked_div(expected).unwrap_or(1);
        if length == per_ray * expected && per_ray > 0 {
            Ok(Self { given, per_ray, ..self })
        } else {
            Err(Error::Length { field: name, length, expected })
        }
    }

    /// `Ok` if `column` has the length of the batch.
    pub(crate) fn check(&self, field: &'static str, column: &[f32]) -> Result<(), Error> {
        let (length, expected) = (column.len(), self.len());
        if length == expected { Ok(()) } else { Err(Error::Length { field, length, expected }) }
    }

    /// `Ok` if `column` has the length of what was given.
    pub(crate) fn check_given(&self, field: &'static str, column: &[f32]) -> Result<(), Error> {
        let (length, expected) = (column.len(), self.given.len());
        if length == expected { Ok(()) } else { Err(Error::Length { field, length, expected }) }
    }

    pub(crate) fn len(&self) -> usize {
        self.rays.origin[0].len()
    }

    /// The rays of `range` alone.
    pub(crate) fn slice(&self, range: Range<usize>) -> Self {
        let cut = |column: &'a [f32]| &column[range.clone()];
        Self {
            rays: Rays {
                origin: self.rays.origin.map(cut),
                direction: self.rays.direction.map(cut),
                t_min: cut(self.rays.t_min),
                t_max: cut(self.rays.t_max),
            },
            emitters: match self.emitters {
                Emitters::Each { position, normal } => {
                    Emitters::Each { position: position.map(cut), normal: normal.map(cut) }
                }
                one => one,
            },
            media: match self.media {
                Media::Each { mu_a, mu_s, g } => Media::Each { mu_a: cut(mu_a), mu_s: cut(mu_s), g: cut(g) },
                one => one,
            },
            given: &self.given[range.start * self.per_ray..range.end * self.per_ray],
            per_ray: self.per_ray,
        }
    }

    #[inline(always)]
    pub(crate) fn ray_lanes<I: Isa>(&self, isa: I, range: Range<usize>) -> RayLanes<I> {
        let [ox, oy, oz] = self.rays.origin;
        let [dx, dy, dz] = self.rays.direction;
        RayLanes {
            origin: [load(isa, ox, &range), load(isa, oy, &range), load(isa, oz, &range)],
            direction: [load(isa, dx, &range), load(isa, dy, &range), load(isa, dz, &range)],
            t_min: load(isa, self.rays.t_min, &range),
            t_max: load(isa, self.rays.t_max, &range),
        }
    }
}

impl Emitters<'_> {
    /// The emitters of a lane group; those of the whole batch where there is one.
    #[inline(always)]
    pub(crate) fn lanes<I: Isa>(&self, isa: I, range: Range<usize>) -> EmitterLanes<I> {
        match self {
            Self::One(emitter) => {
                let [px, py, pz] = emitter.position().to_array();
                let [nx, ny, nz] = emitter.normal().unwrap_or_default().to_array();
                EmitterLanes {
                    position: [isa.splat(px), isa.splat(py), isa.splat(pz)],
                    normal: [isa.splat(nx), isa.splat(ny), isa.splat(nz)],
                }
            }
            Self::Each { position: [px, py, pz], normal: [nx, ny, nz] } => EmitterLanes {
                position: [load(isa, px, &range), load(isa, py, &range), load(isa, pz, &range)],
                normal: [load(isa, nx, &range), load(isa, ny, &range), load(isa, nz, &range)],
            },
        }
    }
}

impl Media<'_> {
    /// The media of a lane group.
    #[inline(always)]
    pub(crate) fn lanes<I: Isa>(&self, isa: I, range: Range<usize>) -> MediumLanes<I> {
        match self {
            Self::One(m) => MediumLanes::new(isa, isa.splat(m.mu_a()), isa.splat(m.mu_s()), isa.splat(m.g())),
            Self::Each { mu_a, mu_s, g } => {
                MediumLanes::new(isa, load(isa, mu_a, &range), load(isa, mu_s, &range), load(isa, g, &range))
            }
        }
    }
}

/// The lanes of `column` in `range`.
#[inline(always)]
fn load<I: Isa>(isa: I, column: &[f32], range: &Range<usize>) -> I::V {
    isa.load_padded(&column[range.start..range.end])
}

/// Which of the numbers that lie next to each other for every ray: number `index` of `per_ray`.
#[derive(Clone, Copy)]
pub(crate) struct Turn {
    pub(crate) index: usize,
    pub(crate) per_ray: usize,
}

impl Turn {
    /// The lanes of this turn for the rays of `range`.
    #[inline(always)]
    pub(crate) fn load<I: Isa>(self, isa: I, column: &[f32], range: &Range<usize>) -> I::V {
        if self.per_ray == 1 {
            return load(isa, column, range);
        }
        let mut lanes = [0.0; MOST_LANES];
        for (lane, ray) in lanes.iter_mut().zip(range.start..range.end) {
            *lane = column[ray * self.per_ray + self.index];
        }
        isa.load_padded(&lanes[..range.len()])
    }

    /// Writes them.
    #[inline(always)]
    pub(crate) fn store<V: Lanes>(self, value: V, column: &mut [f32], range: &Range<usize>) {
        if self.per_ray == 1 {
            return value.store_prefix(&mut column[range.start..range.end]);
        }
        let mut lanes = [0.0; MOST_LANES];
        value.store_prefix(&mut lanes[..range.len()]);
        for (lane, ray) in lanes.iter().zip(range.start..range.end) {
            column[ray * self.per_ray + self.index] = *lane;
        }
    }
}

/// Columns that a call writes.
pub(crate) trait Outputs: Sized + Send {
    /// Their first `k` values, and the rest.
    fn split_at(self, k: usize) -> (Self, Self);
}

impl Outputs for &mut [f32] {
    fn split_at(self, k: usize) -> (Self, Self) {
        self.split_at_mut(k)
    }
}

impl Outputs for Samples<'_> {
    fn split_at(self, k: usize) -> (Self, Self) {
        let (t, t_rest) = self.t.split_at_mut(k);
        let (pdf, pdf_rest) = self.pdf.split_at_mut(k);
        let (weight, weight_rest) = self.weight.map(|column| column.split_at_mut(k)).unzip();
        let (r, r_rest) = self.r.map(|column| column.split_at_mut(k)).unzip();
        (Self { t, pdf, weight, r }, Self { t: t_rest, pdf: pdf_rest, weight: weight_rest, r: r_rest })
    }
}
