//! Borrowed columns of a batch: rays, emitters, media in, samples out, and how they are split.

use crate::Error;
use crate::geometry::{EmitterLanes, RayLanes};
use crate::integrand::MediumLanes;
use crate::scene::{Emitter, Medium};
use crate::simd::{Isa, Lanes, MOST_LANES};
use core::ops::Range;

mod pads;
mod runs;

pub(crate) use pads::{Pad, Pads, first_values};
use runs::Order;
pub(crate) use runs::{Run, Turn};

/// A batch of rays as a structure of arrays; every column has the length of the batch and any alignment.
///
/// The values mean what they mean in [`Ray::new`](crate::Ray::new). A ray whose values are out of range there is
/// *invalid*: it is counted, and what is written for it is zero. (Lengths of directions and normals are held to the
/// tolerance by their squares, with a slack of 1e-6.)
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
        /// Unit normals, x, y, z; the normal (0, 0, 0) stands for a point emitter. Within the tolerance the length of a
        /// normal scales the cosine.
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
    /// Distances along the rays, in `[t_min, t_max]`, 0 where there is no sample \[m\].
    pub t: &'a mut [f32],
    /// Probability densities over distance \[1/m\]; one below f32's range is 0.
    pub pdf: &'a mut [f32],
    /// `mu_s T rho N / (r^2 pdf)`: the one-sample estimate of the ray's single-scattered radiance per unit of the
    /// emitter's intensity \[1/m^2\], with `1/r^2` cancelled analytically and `T` counted from `t_min`.
    ///
    /// `T` takes the whole leg from the sample to the emitter to lie in the medium. If the length `outside` \[m\] of it does
    /// not, as with a lamp outside the fog, `weight * exp(mu_t * outside)` is the unbiased estimate. A transmittance below
    /// f32's range, at an optical depth above 87, makes the weight 0: there is nothing to correct then.
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
    /// Valid rays without one: `t_min = t_max`, or no point of the ray is lit, or less than f32 can say anything about: an
    /// interval shorter than 1e-18 m; for all densities but the transmittance also one shorter than about 1e-36 of `r^2`,
    /// or that subtends about 1e-30 rad; for those with the cosine 1e-25 of the light; or, it may be, a ray that meets the
    /// emitter's plane at an angle below 1e-30 rad.
    pub empty: usize,
    /// Rays with a value that is NaN or out of range.
    pub invalid: usize,
    /// Sampled rays whose iteration fell back to bisection at least once, or took more than 8 steps.
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
    /// Empty if the task takes no numbers.
    pub(crate) given: &'a [f32],
    /// How many of them each ray has; the same number of values is written for it.
    pub(crate) per_ray: usize,
    order: Order,
    /// The lanes that count, from the first to before the second; `None`: all lanes.
    counted: Option<[usize; 2]>,
}

impl<'a> Inputs<'a> {
    /// The inputs, if every column has the same length; nothing is given yet.
    pub(crate) fn new(rays: &Rays<'a>, emitters: &Emitters<'a>, media: &Media<'a>) -> Result<Self, Error> {
        let (rays, emitters, media) = (*rays, *emitters, *media);
        let inputs = Self { rays, emitters, media, given: &[], per_ray: 1, order: Order::ByTurn, counted: None };
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
        if let Emitters::Each { position, normal } = &emitters {
            for k in 0..3 {
                inputs.check(P[k], position[k])?;
                inputs.check(N[k], normal[k])?;
            }
        }
        if let Media::Each { mu_a, mu_s, g } = &media {
            inputs.check("media.mu_a", mu_a)?;
            inputs.check("media.mu_s", mu_s)?;
            inputs.check("media.g", g)?;
        }
        Ok(inputs)
    }

    /// One ray.
    pub(crate) fn one(rays: Rays<'a>, emitter: Emitter, medium: Medium, given: &'a [f32]) -> Self {
        let (emitters, media) = (Emitters::One(emitter), Media::One(medium));
        Self { rays, emitters, media, given, per_ray: 1, order: Order::ByTurn, counted: None }
    }

    /// The same with `given`, if its length is that of the batch or a multiple; `name` is what it is called.
    pub(crate) fn with(self, given: &'a [f32], name: &'static str) -> Result<Self, Error> {
        let (length, expected) = (given.len(), self.len());
        let per_ray = length.checked_div(expected).unwrap_or(1);
        if length == per_ray * expected && per_ray > 0 {
            let order = if per_ray == 1 { Order::ByTurn } else { Order::ByLane };
            Ok(Self { given, per_ray, order, ..self })
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

    /// How many values are written for them.
    pub(crate) fn values(&self) -> usize {
        self.len() * self.per_ray
    }

    /// The rays of `range` alone.
    pub(crate) fn slice(&self, range: Range<usize>) -> Self {
        let given = self.given.get(range.start * self.per_ray..range.end * self.per_ray).unwrap_or_default();
        Self { given, ..self.with_columns(|column| &column[range.clone()]) }
    }

    /// The rays from `start` on.
    pub(crate) fn from(&self, start: usize) -> Self {
        let given = self.given.get(start * self.per_ray..).unwrap_or_default();
        Self { given, ..self.with_columns(|column| &column[start..]) }
    }

    /// The values of `range` alone, of one ray.
    pub(crate) fn of_one_ray(&self, range: Range<usize>) -> Self {
        let per_ray = range.len();
        Self { given: self.given.get(range).unwrap_or_default(), per_ray, ..*self }
    }

    /// The same rays with other values, those of a turn next to each other.
    pub(crate) fn by_turn(&self, given: &'a [f32], per_ray: usize) -> Self {
        Self { given, per_ray, order: Order::ByTurn, ..*self }
    }

    /// The same with some lanes that count.
    pub(crate) fn counting(self, lanes: Range<usize>) -> Self {
        Self { counted: Some([lanes.start, lanes.end]), ..self }
    }

    /// Which ones of so many lanes count.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn counted(&self, lanes: usize) -> Range<usize> {
        let [start, end] = self.counted.unwrap_or([0, lanes]);
        start..end.min(lanes)
    }

    /// Some turns that follow each other, of a block whose first group is given, with so many lanes.
    pub(crate) fn run<'r>(&self, turns: &'r [Turn], first: usize, lanes: usize) -> Run<'r> {
        Run { turns, first, lanes, per_ray: self.per_ray, order: self.order }
    }

    /// The same with other columns of rays, emitters and media.
    fn with_columns<'b>(&self, mut other: impl FnMut(&'a [f32]) -> &'b [f32]) -> Inputs<'b>
    where
        'a: 'b,
    {
        Inputs {
            rays: Rays {
                origin: self.rays.origin.map(&mut other),
                direction: self.rays.direction.map(&mut other),
                t_min: other(self.rays.t_min),
                t_max: other(self.rays.t_max),
            },
            emitters: match self.emitters {
                Emitters::One(emitter) => Emitters::One(emitter),
                Emitters::Each { position, normal } => {
                    Emitters::Each { position: position.map(&mut other), normal: normal.map(&mut other) }
                }
            },
            media: match self.media {
                Media::One(medium) => Media::One(medium),
                Media::Each { mu_a, mu_s, g } => Media::Each { mu_a: other(mu_a), mu_s: other(mu_s), g: other(g) },
            },
            given: self.given,
            per_ray: self.per_ray,
            order: self.order,
            counted: self.counted,
        }
    }

    /// The rays in lane groups.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn ray_groups<I: Isa>(&self) -> RayGroups<'a, I> {
        let count = self.len() / I::V::N;
        let [ox, oy, oz] = self.rays.origin;
        let [dx, dy, dz] = self.rays.direction;
        let Rays { t_min, t_max, .. } = self.rays;
        RayGroups {
            origin: [cut::<I>(ox, count), cut::<I>(oy, count), cut::<I>(oz, count)],
            direction: [cut::<I>(dx, count), cut::<I>(dy, count), cut::<I>(dz, count)],
            t_min: cut::<I>(t_min, count),
            t_max: cut::<I>(t_max, count),
        }
    }
}

/// Columns of rays cut into lane groups, all of them as many.
pub(crate) struct RayGroups<'a, I: Isa> {
    origin: [&'a [I::Group]; 3],
    direction: [&'a [I::Group]; 3],
    t_min: &'a [I::Group],
    t_max: &'a [I::Group],
}

impl<I: Isa> RayGroups<'_, I> {
    /// Has the rays fetched that lie so many groups after these.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn prefetch(&self, isa: I, index: usize, ahead: usize) {
        let ([ox, oy, oz], [dx, dy, dz]) = (&self.origin, &self.direction);
        for column in [ox, oy, oz, dx, dy, dz, &self.t_min, &self.t_max] {
            isa.prefetch(&column[index], ahead);
        }
    }

    /// The rays of one group.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn lanes(&self, isa: I, index: usize) -> RayLanes<I> {
        RayLanes {
            origin: load(isa, &self.origin, index),
            direction: load(isa, &self.direction, index),
            t_min: isa.load(&self.t_min[index]),
            t_max: isa.load(&self.t_max[index]),
        }
    }
}

/// The first `count` groups of a column.
#[cfg_attr(optimized, inline(always))]
fn cut<I: Isa>(column: &[f32], count: usize) -> &[I::Group] {
    &I::groups(column)[..count]
}

/// One group of each column.
#[cfg_attr(optimized, inline(always))]
fn load<I: Isa>(isa: I, [x, y, z]: &[&[I::Group]; 3], index: usize) -> [I::V; 3] {
    [isa.load(&x[index]), isa.load(&y[index]), isa.load(&z[index])]
}

impl Emitters<'_> {
    /// The emitters of lane group `index`; those of the whole batch where there is one.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn lanes<I: Isa>(&self, isa: I, index: usize) -> EmitterLanes<I> {
        match self {
            Self::One(emitter) => {
                let [px, py, pz] = emitter.position().to_array();
                let [nx, ny, nz] = emitter.normal().unwrap_or_default().to_array();
                let position = [isa.splat(px), isa.splat(py), isa.splat(pz)];
                EmitterLanes::new(isa, position, [isa.splat(nx), isa.splat(ny), isa.splat(nz)])
            }
            Self::Each { position: [px, py, pz], normal: [nx, ny, nz] } => {
                let position = load(isa, &[I::groups(px), I::groups(py), I::groups(pz)], index);
                let normal = load(isa, &[I::groups(nx), I::groups(ny), I::groups(nz)], index);
                EmitterLanes::new(isa, position, normal)
            }
        }
    }
}

impl Media<'_> {
    /// The media of lane group `index`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn lanes<I: Isa>(&self, isa: I, index: usize) -> MediumLanes<I> {
        match self {
            Self::One(m) => MediumLanes::new(isa, isa.splat(m.mu_a()), isa.splat(m.mu_s()), isa.splat(m.g())),
            Self::Each { mu_a, mu_s, g } => {
                let [mu_a, mu_s, g] = load(isa, &[I::groups(mu_a), I::groups(mu_s), I::groups(g)], index);
                MediumLanes::new(isa, mu_a, mu_s, g)
            }
        }
    }

    /// Those of another group than that of `lanes`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn renew<I: Isa>(&self, isa: I, index: usize, lanes: &mut MediumLanes<I>) {
        if let Self::Each { .. } = self {
            *lanes = self.lanes(isa, index);
        }
    }
}

/// The columns that a call writes, wherever they are.
pub(crate) trait Outputs {
    type At<'a>: Send;

    /// Their first `k` values, and the rest.
    fn split_at<'a>(out: Self::At<'a>, k: usize) -> (Self::At<'a>, Self::At<'a>);

    /// Those of `range`, borrowed.
    fn part<'b>(out: &'b mut Self::At<'_>, range: Range<usize>) -> Self::At<'b>;

    /// Has `write` write the values of a run, which for it lie next to each other.
    fn of_run<R>(out: &mut Self::At<'_>, run: Run<'_>, write: impl FnOnce(Self::At<'_>) -> R) -> R;

    /// Has `write` write to pads, and takes from there as many values as there are.
    fn by_pads<R>(out: Self::At<'_>, write: impl FnOnce(Self::At<'_>) -> R) -> R;
}

/// One column.
pub(crate) struct Column;

impl Outputs for Column {
    type At<'a> = &'a mut [f32];

    fn split_at<'a>(out: Self::At<'a>, k: usize) -> (Self::At<'a>, Self::At<'a>) {
        out.split_at_mut(k)
    }

    fn part<'b>(out: &'b mut Self::At<'_>, range: Range<usize>) -> Self::At<'b> {
        &mut out[range]
    }

    fn of_run<R>(out: &mut Self::At<'_>, run: Run<'_>, write: impl FnOnce(&mut [f32]) -> R) -> R {
        match run.together() {
            Some(range) => write(&mut out[range]),
            None => run.scatter(out, write),
        }
    }

    fn by_pads<R>(out: &mut [f32], write: impl FnOnce(&mut [f32]) -> R) -> R {
        let mut pad: Pad = [0.0; MOST_LANES];
        let result = write(&mut pad);
        out.copy_from_slice(&pad[..out.len()]);
        result
    }
}

/// Those of [`Samples`].
pub(crate) struct OfSamples;

impl Outputs for OfSamples {
    type At<'a> = Samples<'a>;

    fn split_at<'a>(out: Self::At<'a>, k: usize) -> (Self::At<'a>, Self::At<'a>) {
        let (t, t_rest) = out.t.split_at_mut(k);
        let (pdf, pdf_rest) = out.pdf.split_at_mut(k);
        let (weight, weight_rest) = out.weight.map(|column| column.split_at_mut(k)).unzip();
        let (r, r_rest) = out.r.map(|column| column.split_at_mut(k)).unzip();
        (Samples { t, pdf, weight, r }, Samples { t: t_rest, pdf: pdf_rest, weight: weight_rest, r: r_rest })
    }

    fn part<'b>(out: &'b mut Samples<'_>, range: Range<usize>) -> Samples<'b> {
        Samples {
            t: &mut out.t[range.clone()],
            pdf: &mut out.pdf[range.clone()],
            weight: out.weight.as_mut().map(|column| &mut column[range.clone()]),
            r: out.r.as_mut().map(|column| &mut column[range]),
        }
    }

    fn of_run<R>(out: &mut Samples<'_>, run: Run<'_>, write: impl FnOnce(Samples<'_>) -> R) -> R {
        if let Some(range) = run.together() {
            return write(Self::part(out, range));
        }
        let Samples { t, pdf, weight, r } = out;
        run.scatter(t, |t| {
            run.scatter(pdf, |pdf| {
                optional(run, weight, |weight| optional(run, r, |r| write(Samples { t, pdf, weight, r })))
            })
        })
    }

    fn by_pads<R>(out: Samples<'_>, write: impl FnOnce(Samples<'_>) -> R) -> R {
        let Samples { t, pdf, weight, r } = out;
        Column::by_pads(t, |t| {
            Column::by_pads(pdf, |pdf| {
                let (mut weight_pad, mut r_pad): (Pad, Pad) = ([0.0; MOST_LANES], [0.0; MOST_LANES]);
                let result = write(Samples {
                    t,
                    pdf,
                    weight: weight.as_ref().map(|_| &mut weight_pad[..]),
                    r: r.as_ref().map(|_| &mut r_pad[..]),
                });
                for (column, pad) in [(weight, weight_pad), (r, r_pad)] {
                    if let Some(column) = column {
                        column.copy_from_slice(&pad[..column.len()]);
                    }
                }
                result
            })
        })
    }
}

/// The values of a run of a column, if there is one.
fn optional<R>(run: Run<'_>, column: &mut Option<&mut [f32]>, write: impl FnOnce(Option<&mut [f32]>) -> R) -> R {
    match column {
        Some(column) => run.scatter(column, |column| write(Some(column))),
        None => write(None),
    }
}
