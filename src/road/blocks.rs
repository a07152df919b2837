//! The blocks of a chunk: a few lane groups, with short passes over all of them.
//!
//! A pass reads the records of the pass before and writes its own; they stay in the nearest caches. The passes are
//!
//! 1. geometry, the part that is needed: the lit interval, then the foot of the perpendicular, hard lanes in f64, and spots in f64;
//! 2. set-up, inversion and output of a density, a pass each: the shorter a pass, the more groups are in flight at a time. They are
//!    one pass where set-ups are too large for the nearest cache, if none is used twice;
//! 3. weights, the same for all densities.

use crate::Precision;
use crate::batch::{
    ChannelGroups, ConePlace, ConeRows, Counts, EmitterPlace, EmitterRows, Inputs, MOST_RAYS, MediaPlace, MediaRows,
    MediumGroups, RayGroups, Run, Turn,
};
use crate::density::{Density, Kind, SetUp};
use crate::geometry::{Cone, Cosine, Extent, Foot, Geometry, Lit, clip, find_foot, in_cone, in_f64, pick};
use crate::integrand::MediumLanes;
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

/// Some lane groups of a chunk, with their geometry.
pub(super) struct Block<'b, I: Isa> {
    /// The chunk.
    pub(super) inputs: &'b Inputs<'b>,
    /// The numbers of the groups in the chunk.
    pub(super) groups: Range<usize>,
    /// The media of the groups.
    pub(super) media: MediaRows<'b>,
    lits: &'b [Lit<I>],
    cosines: &'b [Cosine<I>],
    feet: &'b [Foot<I>],
    /// Empty if there are no spots.
    cones: &'b [Cone<I>],
}

impl<I: Isa> Block<'_, I> {
    /// The only turn of every group, if a ray has one value.
    pub(super) fn one_turn(&self) -> Run<'static> {
        self.inputs.run(&ONE_TURN[..self.groups.len()], self.groups.start, I::V::N)
    }

    /// The channels of coloured media.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn channels(&self, isa: I) -> Option<ChannelGroups<'_, I>> {
        let channels = self.media.channels.as_ref()?;
        Some(channels.groups(isa))
    }

    /// The geometries, for a pass.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn geometries(&self) -> Geometries<'_, I> {
        // Equal lengths remove bounds checks.
        let count = self.groups.len();
        let (lits, cosines, feet) = (&self.lits[..count], &self.cosines[..count], &self.feet[..count]);
        Geometries { lits, cosines, feet, cones: self.cones }
    }
}

/// The geometries of a block.
pub(super) struct Geometries<'b, I: Isa> {
    lits: &'b [Lit<I>],
    cosines: &'b [Cosine<I>],
    feet: &'b [Foot<I>],
    cones: &'b [Cone<I>],
}

impl<I: Isa> Geometries<'_, I> {
    /// The geometry of a record.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn get(&self, record: usize) -> Geometry<'_, I> {
        let (lit, cosine, foot) = (&self.lits[record], &self.cosines[record], &self.feet[record]);
        Geometry { lit, cosine, foot, cone: self.cones.get(record) }
    }
}

/// What a task needs of the geometry.
#[derive(Clone, Copy)]
pub(super) struct Wanted {
    pub(super) precision: Precision,
    pub(super) extent: Extent,
    /// The largest number of set-ups at a time.
    pub(super) records: usize,
}

/// The number of lane groups of a block, unless the chunk ends.
pub(super) fn groups_at_once<I: Isa>() -> usize {
    (MOST_RAYS / I::V::N).clamp(1, GROUPS)
}

/// Calls `visit` for each block of a chunk; blocks are cut where the records of the density are large.
pub(super) fn for_each_block<I: Isa>(
    isa: I,
    inputs: &Inputs<'_>,
    wanted: Wanted,
    mut visit: impl FnMut(&Block<'_, I>),
) {
    let (at_once, count) = (groups_at_once::<I>(), inputs.len() / I::V::N);
    let each = inputs.emitters.points.differs();
    let mut places = Places::new();
    isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            // Placeholders for what is not needed.
            if wanted.extent == Extent::Lit {
                let none = Foot::none(isa);
                places.feet.fill(at_once.min(count), |_| none);
            }
            if wanted.extent != Extent::Cosine {
                let none = Cosine::none(isa);
                places.cosines.fill(at_once.min(count), |_| none);
            }
        },
    );
    let locate = match (wanted.extent, wanted.precision) {
        // The f32 geometry needs the remainder of a product, which only a fused multiply-add gives.
        (Extent::Lit, _) if !I::FUSED => in_double::<I, false, false>,
        (Extent::Foot, _) if !I::FUSED => in_double::<I, true, false>,
        (Extent::Cosine, _) if !I::FUSED => in_double::<I, true, true>,
        (Extent::Lit, _) if each => in_single::<I, true, false, false, true>,
        (Extent::Lit, _) => in_single::<I, true, false, false, false>,
        (Extent::Foot, Precision::Fast) if each => in_single::<I, false, true, false, true>,
        (Extent::Foot, Precision::Fast) => in_single::<I, false, true, false, false>,
        (Extent::Foot, Precision::Exact) if each => in_single::<I, true, true, false, true>,
        (Extent::Foot, Precision::Exact) => in_single::<I, true, true, false, false>,
        (Extent::Cosine, Precision::Fast) if each => in_single::<I, false, true, true, true>,
        (Extent::Cosine, Precision::Fast) => in_single::<I, false, true, true, false>,
        (Extent::Cosine, Precision::Exact) if each => in_single::<I, true, true, true, true>,
        (Extent::Cosine, Precision::Exact) => in_single::<I, true, true, true, false>,
    };
    // Apart: an unoptimised build has a tuple of them on the stack twice.
    let mut emitters = EmitterPlace::new();
    let mut cones = ConePlace::new();
    let mut media = MediaPlace::new();
    for start in (0..count).step_by(at_once) {
        let groups = start..count.min(start + at_once);
        let rays = groups.start * I::V::N..groups.end * I::V::N;
        let emitters = inputs.emitters.points.rows(rays.clone(), &mut emitters);
        let cones = inputs.emitters.cones.map(|source| source.rows(rays.clone(), &mut cones));
        let media = inputs.media.rows(rays, &mut media);
        locate(isa, inputs, emitters, groups.clone(), &mut places);
        if let Some(cones) = cones {
            in_cones(isa, inputs, emitters, cones, groups.start, &mut places);
        }
        let (lits, cosines, feet) = (places.lits.written(), places.cosines.written(), places.feet.written());
        let cones = places.cones.written();
        for part in (0..groups.len()).step_by(wanted.records) {
            let part = part..groups.len().min(part + wanted.records);
            visit(&Block {
                inputs,
                groups: groups.start + part.start..groups.start + part.end,
                media: media.part(part.start * I::V::N..part.end * I::V::N),
                lits: &lits[part.clone()],
                cosines: &cosines[part.clone()],
                feet: &feet[part.clone()],
                cones: cones.get(part).unwrap_or_default(),
            });
        }
    }
}

/// Storage for the records of a block's geometry.
struct Places<I: Isa> {
    lits: Records<Lit<I>>,
    /// `|d| - 1`.
    excesses: Records<I::V>,
    cosines: Records<Cosine<I>>,
    feet: Records<Foot<I>>,
    cones: Records<Cone<I>>,
}

impl<I: Isa> Places<I> {
    #[cfg_attr(optimized, inline(always))]
    fn new() -> Self {
        Self {
            lits: Records::new(),
            excesses: Records::new(),
            cosines: Records::new(),
            feet: Records::new(),
            cones: Records::new(),
        }
    }
}

/// Calls `visit` for runs of the turns of a block, each at most as long as there is storage for records.
pub(super) fn for_each_run<I: Isa>(block: &Block<'_, I>, mut visit: impl FnMut(Run<'_>)) {
    let Block { inputs, groups, .. } = block;
    if inputs.per_ray == 1 {
        return visit(block.one_turn());
    }
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

/// The counts of a chunk, summed in the lanes: whole numbers that f32 can hold.
#[derive(Clone, Copy)]
pub(super) struct Tally<I: Isa> {
    valid: I::V,
    sampled: I::V,
    bisected: I::V,
    /// The weight of a value: 1 in lanes that are counted, 0 in others.
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

    /// Adds a value for each lane: whether it is `valid`, and if so `sampled`, and if so `bisected`.
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

/// The number of lane groups by which rays, variates, `t` and `pdf` are prefetched before they are read or written.
pub(super) const AHEAD: usize = 2 * GROUPS;

/// Computes the geometry of some groups in f32, and of their hard lanes in f64.
fn in_single<I: Isa, const EXACT: bool, const FOOT: bool, const COSINE: bool, const DIFFER: bool>(
    isa: I,
    inputs: &Inputs<'_>,
    emitters: EmitterRows<'_>,
    groups: Range<usize>,
    places: &mut Places<I>,
) {
    // Whether all lanes are easy, and whether any is.
    let [mut every, any] = isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = inputs.ray_groups::<I>();
            let emitters = emitters.groups(isa);
            let mut emitter = emitters.emitters(isa, 0);
            let (mut lits, mut excesses) = (places.lits.start(), places.excesses.start());
            let mut cosines = places.cosines.start();
            let (mut every, mut any) = (!none(isa), none(isa));
            for group in groups.clone() {
                if inputs.prefetch {
                    rays.prefetch(isa, group, AHEAD);
                }
                if DIFFER {
                    emitter = emitters.emitters(isa, group - groups.start);
                }
                let ray = rays.lanes(isa, group);
                let (lit, excess, cosine) = clip::<I, EXACT, FOOT, COSINE>(isa, &ray, &emitter);
                (every, any) = (every & lit.valid, any | lit.valid);
                lits.push(lit);
                if COSINE {
                    cosines.push(cosine);
                }
                if FOOT {
                    excesses.push(excess);
                }
            }
            lits.done();
            excesses.done();
            if COSINE {
                cosines.done();
            }
            [I::V::bits(!every) == 0, I::V::bits(any) != 0]
        },
    );
    if !any {
        return in_double::<I, FOOT, COSINE>(isa, inputs, emitters, groups, places);
    }
    // A pass of its own: both together do not fit the registers.
    if FOOT {
        every = find_feet::<I, EXACT, COSINE, DIFFER>(isa, inputs, emitters, groups.start, places);
    }
    if !every {
        rescue::<I, FOOT, COSINE>(isa, inputs, emitters, groups.start, places);
    }
}

/// Computes the feet of the perpendiculars after the lit intervals; returns whether all lanes are easy.
fn find_feet<I: Isa, const EXACT: bool, const COSINE: bool, const DIFFER: bool>(
    isa: I,
    inputs: &Inputs<'_>,
    emitters: EmitterRows<'_>,
    start: usize,
    places: &mut Places<I>,
) -> bool {
    isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = inputs.ray_groups::<I>();
            let emitters = emitters.groups(isa);
            let mut emitter = emitters.emitters(isa, 0);
            let lits = places.lits.written();
            let (excesses, cosines) =
                (&places.excesses.written()[..lits.len()], &places.cosines.written()[..lits.len()]);
            let mut feet = places.feet.start();
            let mut every = !none(isa);
            for (record, lit) in lits.iter_mut().enumerate() {
                if DIFFER {
                    emitter = emitters.emitters(isa, record);
                }
                let (ray, excess, cosine) = (rays.lanes(isa, start + record), excesses[record], &cosines[record]);
                let foot;
                (foot, lit.valid) = find_foot::<I, EXACT, COSINE>(isa, &ray, &emitter, lit, excess, cosine);
                every = every & lit.valid;
                feet.push(foot);
            }
            feet.done();
            I::V::bits(!every) == 0
        },
    )
}

/// Computes hard lanes, those that are not valid in f32, in f64.
#[cold]
fn rescue<I: Isa, const FOOT: bool, const COSINE: bool>(
    isa: I,
    inputs: &Inputs<'_>,
    emitters: EmitterRows<'_>,
    start: usize,
    places: &mut Places<I>,
) {
    isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = inputs.ray_groups::<I>();
            let emitters = emitters.groups(isa);
            let mut emitter = emitters.emitters(isa, 0);
            let (lits, cosines, feet) = (places.lits.written(), places.cosines.written(), places.feet.written());
            for (record, ((lit, cosine), foot)) in lits.iter_mut().zip(cosines).zip(feet).enumerate() {
                let hard = !lit.valid;
                if I::V::bits(hard) != 0 {
                    let group = start + record;
                    if emitters.differ() {
                        emitter = emitters.emitters(isa, record);
                    }
                    let exact = in_f64(isa, &rays.lanes(isa, group), &emitter);
                    let (of_lit, of_cosine, of_foot) = pick(hard, &exact, Geometry { lit, cosine, foot, cone: None });
                    *lit = of_lit;
                    if COSINE {
                        *cosine = of_cosine;
                    }
                    if FOOT {
                        *foot = of_foot;
                    }
                }
            }
        },
    );
}

/// Computes the geometry of some groups in f64.
fn in_double<I: Isa, const FOOT: bool, const COSINE: bool>(
    isa: I,
    inputs: &Inputs<'_>,
    emitters: EmitterRows<'_>,
    groups: Range<usize>,
    places: &mut Places<I>,
) {
    isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = inputs.ray_groups::<I>();
            let emitters = emitters.groups(isa);
            let (mut emitter, start) = (emitters.emitters(isa, 0), groups.start);
            let (mut lits, mut cosines, mut feet) = (places.lits.start(), places.cosines.start(), places.feet.start());
            for group in groups {
                if inputs.prefetch {
                    rays.prefetch(isa, group, AHEAD);
                }
                if emitters.differ() {
                    emitter = emitters.emitters(isa, group - start);
                }
                let (lit, cosine, foot) = in_f64(isa, &rays.lanes(isa, group), &emitter);
                lits.push(lit);
                if COSINE {
                    cosines.push(cosine);
                }
                if FOOT {
                    feet.push(foot);
                }
            }
            lits.done();
            if COSINE {
                cosines.done();
            }
            if FOOT {
                feet.done();
            }
        },
    );
}

/// The geometry of spots in f64, in place of what the lanes of spots have.
fn in_cones<I: Isa>(
    isa: I,
    inputs: &Inputs<'_>,
    emitters: EmitterRows<'_>,
    cones: ConeRows<'_>,
    start: usize,
    places: &mut Places<I>,
) {
    isa.vectorize::<Cone<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = inputs.ray_groups::<I>();
            let (emitters, cones) = (emitters.groups(isa), cones.groups(isa));
            let (lits, cosines, feet) = (places.lits.written(), places.cosines.written(), places.feet.written());
            let mut located = places.cones.start();
            for (record, ((lit, cosine), foot)) in lits.iter_mut().zip(cosines).zip(feet).enumerate() {
                let ray = rays.lanes(isa, start + record);
                let (exact, cone) = in_cone(isa, &ray, &emitters.spots(isa, &cones, record));
                (*lit, *cosine, *foot) = pick(cone.is_spot, &exact, Geometry { lit, cosine, foot, cone: None });
                located.push(cone);
            }
            located.done();
        },
    );
}

/// Storage for the set-ups of a block.
pub(super) type SetUps<I, D> = <<D as Kind>::On<I> as Density<I>>::SetUps;

/// Sets up the densities of a block.
pub(super) fn set_up<'r, I: Isa, Home, D: Density<I>>(
    isa: I,
    block: &Block<'_, I>,
    records: &'r mut D::SetUps,
) -> &'r [SetUp<I, D>] {
    isa.vectorize::<Home, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let mut for_set_up = ForSetUp::new(isa, block);
            records.fill(
                block.groups.len(),
                #[cfg_attr(optimized, inline(always))]
                |record| for_set_up.set_up(isa, record),
            )
        },
    )
}

/// What the set-ups of a block need, for a pass.
pub(super) struct ForSetUp<'b, I: Isa> {
    first: usize,
    rays: RayGroups<'b, I>,
    media: MediumGroups<'b, I>,
    medium: MediumLanes<I>,
    channels: Option<ChannelGroups<'b, I>>,
    geometries: Geometries<'b, I>,
}

impl<'b, I: Isa> ForSetUp<'b, I> {
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn new(isa: I, block: &'b Block<'b, I>) -> Self {
        let media = block.media.means.groups(isa);
        Self {
            first: block.groups.start,
            rays: block.inputs.ray_groups(),
            medium: media.media(isa, 0),
            media,
            channels: block.channels(isa),
            geometries: block.geometries(),
        }
    }

    /// Sets up the density of a record.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn set_up<D: Density<I>>(&mut self, isa: I, record: usize) -> SetUp<I, D> {
        self.media.renew(isa, record, &mut self.medium);
        let ray = self.rays.lanes(isa, self.first + record);
        let channels = ChannelGroups::lanes(self.channels.as_ref(), isa, record);
        SetUp::new(isa, &ray, self.geometries.get(record), &self.medium, channels.as_ref())
    }
}
