//! The blocks of a chunk: a few lane groups that go through the stations together, each station a short pass over them.
//!
//! A pass reads the records of the one before and writes its own; they stay in the nearest caches. The passes are
//!
//! 1. geometry, the same for all densities: the lit interval, then the foot of the perpendicular, and hard lanes in f64;
//! 2. set-up, inversion and output of a density, in one pass for one variate per ray, else in one each;
//! 3. weights, the same for all densities.

use crate::Precision;
use crate::batch::{Counts, Gathered, Inputs, MOST_RAYS, Rows, Run, Turn};
use crate::density::{Density, Kind, SetUp};
use crate::geometry::{Clipped, Cosine, Foot, Geometry, clip, find_foot, in_f64, pick, unknown};
use crate::simd::{GROUPS, Isa, Lanes, MOST_LANES, Records, Room, none};
use core::ops::Range;

/// The first turn of every group of a block.
static ONE_TURN: [Turn; GROUPS] = {
    let mut turns = [Turn { record: 0, index: 0 }; GROUPS];
    let mut record = 0;
    while record < GROUPS {
        turns[record].record = record;
        record += 1;
    }
    turns
};

/// Some lane groups of a chunk, located.
pub(super) struct Block<'b, I: Isa> {
    /// The chunk.
    pub(super) inputs: &'b Inputs<'b>,
    /// Which ones of the chunk they are.
    pub(super) groups: Range<usize>,
    /// Their media.
    pub(super) media: Rows<'b, 3>,
    clipped: &'b [Clipped<I>],
    cosines: &'b [Cosine<I>],
    feet: &'b [Foot<I>],
}

impl<I: Isa> Block<'_, I> {
    /// The one turn of every group, where a ray has one value.
    pub(super) fn one_turn(&self) -> Run<'static> {
        self.inputs.run(&ONE_TURN[..self.groups.len()], self.groups.start, I::V::N)
    }

    /// The geometries, for a pass.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn geometries(&self) -> Geometries<'_, I> {
        // Equal lengths remove bounds checks.
        let count = self.groups.len();
        Geometries { clipped: &self.clipped[..count], cosines: &self.cosines[..count], feet: &self.feet[..count] }
    }
}

/// Those of the lane groups of a block.
pub(super) struct Geometries<'b, I: Isa> {
    clipped: &'b [Clipped<I>],
    cosines: &'b [Cosine<I>],
    feet: &'b [Foot<I>],
}

impl<I: Isa> Geometries<'_, I> {
    /// That of a record.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn get(&self, record: usize) -> Geometry<'_, I> {
        Geometry { lit: &self.clipped[record].lit, cosine: &self.cosines[record], foot: &self.feet[record] }
    }
}

/// What a task wants of the geometry.
#[derive(Clone, Copy)]
pub(super) struct Wanted {
    pub(super) precision: Precision,
    /// Whether it asks for the emitter's cosine.
    pub(super) cosine: bool,
    /// How many records of its density fit.
    pub(super) records: usize,
}

/// The blocks of a chunk, each visited once, cut where the records of the density are large.
pub(super) fn for_each_block<I: Isa>(
    isa: I,
    inputs: &Inputs<'_>,
    wanted: Wanted,
    mut visit: impl FnMut(&Block<'_, I>),
) {
    let (at_once, count) = ((MOST_RAYS / I::V::N).clamp(1, GROUPS), inputs.len() / I::V::N);
    let each = inputs.emitters.0.differs();
    let locate = match wanted.precision {
        // What the rounding of a product leaves is known by a fused addition alone.
        _ if !I::FUSED => in_double,
        Precision::Fast => match (wanted.cosine, each) {
            (false, false) => in_single::<I, false, false, false>,
            (false, true) => in_single::<I, false, false, true>,
            (true, false) => in_single::<I, false, true, false>,
            (true, true) => in_single::<I, false, true, true>,
        },
        Precision::Exact => match (wanted.cosine, each) {
            (false, false) => in_single::<I, true, false, false>,
            (false, true) => in_single::<I, true, false, true>,
            (true, false) => in_single::<I, true, true, false>,
            (true, true) => in_single::<I, true, true, true>,
        },
    };
    let mut places = Places { clipped: Records::new(), cosines: Records::new(), feet: Records::new() };
    let mut no_cosines: Records<Cosine<I>> = Records::new();
    let no_cosines: &[Cosine<I>] = if wanted.cosine {
        &[]
    } else {
        isa.vectorize::<Foot<I>, _>(
            #[cfg_attr(optimized, inline(always))]
            || {
                let none = Cosine::none(isa);
                no_cosines.fill(at_once.min(count), |_| none)
            },
        )
    };
    let (mut emitters, mut media) = (Gathered::new(), Gathered::new());
    for start in (0..count).step_by(at_once) {
        let groups = start..count.min(start + at_once);
        let rays = groups.start * I::V::N..groups.end * I::V::N;
        let emitters = inputs.emitters.0.rows(rays.clone(), &mut emitters);
        let media = inputs.media.0.rows(rays, &mut media);
        let (clipped, cosines, feet) = locate(isa, inputs, emitters, groups.clone(), &mut places);
        let cosines = if wanted.cosine { cosines } else { no_cosines };
        for part in (0..groups.len()).step_by(wanted.records) {
            let part = part..groups.len().min(part + wanted.records);
            visit(&Block {
                inputs,
                groups: groups.start + part.start..groups.start + part.end,
                media: media.part(part.start * I::V::N..part.end * I::V::N),
                clipped: &clipped[part.clone()],
                cosines: &cosines[part.clone()],
                feet: &feet[part],
            });
        }
    }
}

/// Place for the records of a block's geometry.
struct Places<I: Isa> {
    clipped: Records<Clipped<I>>,
    cosines: Records<Cosine<I>>,
    feet: Records<Foot<I>>,
}

/// The turns of a block, at most as many at a time as there is place for records.
pub(super) fn for_each_run<I: Isa>(block: &Block<'_, I>, mut visit: impl FnMut(Run<'_>)) {
    let Block { inputs, groups, .. } = block;
    let mut turns = [Turn::default(); GROUPS];
    let mut count = 0;
    for record in 0..groups.len() {
        for index in 0..inputs.per_ray {
            if count == GROUPS {
                visit(inputs.run(&turns, groups.start, I::V::N));
                count = 0;
            }
            turns[count] = Turn { record, index };
            count += 1;
        }
    }
    visit(inputs.run(&turns[..count], groups.start, I::V::N));
}

/// What became of the values of a chunk, summed in the lanes: whole numbers that f32 can count.
pub(super) struct Tally<I: Isa> {
    valid: I::V,
    sampled: I::V,
    bisected: I::V,
    /// What a value counts: 1 in the lanes that count, 0 in others.
    one: I::V,
}

impl<I: Isa> Tally<I> {
    pub(super) fn new(isa: I, inputs: &Inputs<'_>) -> Self {
        let mut ones = [0.0; MOST_LANES];
        ones[inputs.counted(I::V::N)].fill(1.0);
        isa.vectorize::<Foot<I>, _>(
            #[cfg_attr(optimized, inline(always))]
            || {
                let (zero, one) = (isa.splat(0.0), isa.load(&I::groups(&ones)[0]));
                Self { valid: zero, sampled: zero, bisected: zero, one }
            },
        )
    }

    /// One more value for each lane: `valid` with what was given, of these `sampled`, and of these `bisected`.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn add(&mut self, valid: I::Mask, sampled: I::Mask, bisected: I::Mask) {
        self.valid = self.valid + I::V::only(valid, self.one);
        self.sampled = self.sampled + I::V::only(sampled, self.one);
        self.bisected = self.bisected + I::V::only(bisected & sampled, self.one);
    }

    pub(super) fn counts(self, isa: I, inputs: &Inputs<'_>) -> Counts {
        let mut sums = [[0.0; MOST_LANES]; 3];
        isa.vectorize::<Foot<I>, _>(
            #[cfg_attr(optimized, inline(always))]
            || {
                let [valid, sampled, bisected] = &mut sums;
                isa.store(self.valid, &mut I::groups_mut(valid)[0]);
                isa.store(self.sampled, &mut I::groups_mut(sampled)[0]);
                isa.store(self.bisected, &mut I::groups_mut(bisected)[0]);
            },
        );
        let [valid, sampled, bisected] = sums.map(|lanes| lanes.iter().sum::<f32>() as usize);
        let values = inputs.len() / I::V::N * inputs.per_ray * inputs.counted(I::V::N).len();
        Counts { sampled, empty: valid - sampled, invalid: values - valid, bisected }
    }
}

/// The records of some groups; no cosines where none are wanted.
type Located<'r, I> = (&'r [Clipped<I>], &'r [Cosine<I>], &'r [Foot<I>]);

/// Those in f32, hard lanes again in f64.
fn in_single<'r, I: Isa, const EXACT: bool, const COSINE: bool, const EACH: bool>(
    isa: I,
    inputs: &Inputs<'_>,
    emitters: Rows<'_, 6>,
    groups: Range<usize>,
    places: &'r mut Places<I>,
) -> Located<'r, I> {
    let start = groups.start;
    let (clipped, cosines, feet, hard) = isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = inputs.ray_groups::<I>();
            let mut emitter = emitters.emitters(isa, 0);
            let (mut clipped, mut cosines) = (places.clipped.start(), places.cosines.start());
            let mut feet = places.feet.start();
            let mut valid = !none(isa);
            for group in groups.clone() {
                rays.prefetch(isa, group, AHEAD);
                if EACH {
                    emitter = emitters.emitters(isa, group - start);
                }
                let ray = rays.lanes(isa, group);
                let (of_clipped, of_cosine) = clip::<I, EXACT, COSINE>(isa, &ray, &emitter);
                clipped.push(of_clipped);
                if COSINE {
                    cosines.push(of_cosine);
                }
                if !EXACT {
                    let foot = find_foot::<I, EXACT, COSINE>(isa, &ray, &emitter, &of_clipped, of_cosine.beta);
                    valid = valid & foot.valid;
                    feet.push(foot);
                }
            }
            let (clipped, cosines) = (clipped.done(), cosines.done());
            // Apart: the two together do not fit the registers.
            if EXACT {
                for (index, group) in groups.enumerate() {
                    if EACH {
                        emitter = emitters.emitters(isa, index);
                    }
                    let (ray, of_clipped) = (rays.lanes(isa, group), &clipped[index]);
                    let beta = if COSINE { cosines[index].beta } else { isa.splat(0.0) };
                    let foot = find_foot::<I, EXACT, COSINE>(isa, &ray, &emitter, of_clipped, beta);
                    valid = valid & foot.valid;
                    feet.push(foot);
                }
            }
            (clipped, cosines, feet.done(), I::V::bits(!valid) != 0)
        },
    );
    if hard {
        rescue::<I, COSINE>(isa, inputs, emitters, start, clipped, cosines, feet);
    }
    (clipped, cosines, feet)
}

/// Rays, variates, `t` and `pdf` are prefetched so many lane groups before they are read or written.
pub(super) const AHEAD: usize = 2 * GROUPS;

/// Hard lanes in f64: those that are not valid in f32.
#[cold]
fn rescue<I: Isa, const COSINE: bool>(
    isa: I,
    inputs: &Inputs<'_>,
    emitters: Rows<'_, 6>,
    start: usize,
    clipped: &mut [Clipped<I>],
    cosines: &mut [Cosine<I>],
    feet: &mut [Foot<I>],
) {
    isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = inputs.ray_groups::<I>();
            let no_cosine = Cosine::none(isa);
            let mut emitter = emitters.emitters(isa, 0);
            for (record, (Clipped { lit, .. }, foot)) in clipped.iter_mut().zip(feet).enumerate() {
                let hard = !foot.valid;
                if I::V::bits(hard) != 0 {
                    let group = start + record;
                    if emitters.differs() {
                        emitter = emitters.emitters(isa, record);
                    }
                    let exact = in_f64(isa, &rays.lanes(isa, group), &emitter);
                    let cosine = if COSINE { &cosines[record] } else { &no_cosine };
                    let (of_lit, of_cosine, of_foot) = pick(hard, &exact, Geometry { lit, cosine, foot });
                    (*lit, *foot) = (of_lit, of_foot);
                    if COSINE {
                        cosines[record] = of_cosine;
                    }
                }
            }
        },
    );
}

/// All lanes in f64, as if all of them were hard.
fn in_double<'r, I: Isa>(
    isa: I,
    inputs: &Inputs<'_>,
    emitters: Rows<'_, 6>,
    groups: Range<usize>,
    places: &'r mut Places<I>,
) -> Located<'r, I> {
    let count = groups.len();
    let (clipped, cosines, feet) = isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let (clip, foot) = unknown(isa);
            let cosine = Cosine::none(isa);
            (
                places.clipped.fill(count, |_| clip),
                places.cosines.fill(count, |_| cosine),
                places.feet.fill(count, |_| foot),
            )
        },
    );
    rescue::<I, true>(isa, inputs, emitters, groups.start, clipped, cosines, feet);
    (clipped, cosines, feet)
}

/// Place for the set-ups of a block.
pub(super) type SetUps<I, D> = <<D as Kind>::On<I> as Density<I>>::SetUps;

/// The densities of a block.
pub(super) fn set_up<'r, I: Isa, Home, D: Density<I>>(
    isa: I,
    block: &Block<'_, I>,
    records: &'r mut D::SetUps,
) -> &'r [SetUp<I, D>] {
    isa.vectorize::<Home, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = block.inputs.ray_groups::<I>();
            let mut medium = block.media.media(isa, 0);
            let geometries = block.geometries();
            records.fill(
                block.groups.len(),
                #[cfg_attr(optimized, inline(always))]
                |record| {
                    let group = block.groups.start + record;
                    block.media.renew(isa, record, &mut medium);
                    let geometry = geometries.get(record);
                    SetUp::new(isa, &rays.lanes(isa, group), geometry, &medium)
                },
            )
        },
    )
}
