//! The blocks of a chunk: a few lane groups, with short passes over all of them.
//!
//! A pass reads the records of the pass before and writes its own; they stay in the nearest caches. The passes are
//!
//! 1. geometry, the part that is needed: the lit interval, then the foot of the perpendicular (`Fast` has both in one pass), hard
//!    lanes in f64, and spots in f64;
//! 2. set-up, inversion and output of a density, a pass each: the shorter a pass, the more groups are in flight at a time. The Taylor
//!    densities, whose set-ups do not fit the nearest cache, take one pass if each ray has one variate;
//! 3. weights, the same for all densities.

use crate::Precision;
use crate::batch::{
    ChannelGroups, ConePlace, ConeRows, Counts, EmitterPlace, EmitterRows, Inputs, MOST_RAYS, MediaPlace, MediaRows,
    MediumGroups, RayGroups, Run, Turn,
};
use crate::density::{Density, Kind, SetUp};
use crate::geometry::{
    Clipped, Cone, Cosine, Extent, Foot, FoundFoot, Geometry, Lit, Located, Rests, clip, find_foot, in_cone, in_f64,
};
use crate::integrand::MediumLanes;
use crate::simd::{GROUPS, Isa, Lanes, Records, Room, none};
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
    pub(super) media: &'b MediaRows<'b>,
    geometries: Geometries<'b, I>,
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
        self.geometries.part(0..self.groups.len())
    }
}

/// The geometries of a block.
#[derive(Clone, Copy)]
pub(super) struct Geometries<'b, I: Isa> {
    lits: &'b [Lit<I>],
    rests: &'b [Rests<I>],
    cosines: &'b [Cosine<I>],
    feet: &'b [Foot<I>],
    alphas: &'b [I::V],
    valid: &'b [I::Mask],
    /// Empty if there are no spots.
    cones: &'b [Cone<I>],
}

impl<I: Isa> Geometries<'_, I> {
    /// The geometry of a record.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn get(&self, record: usize) -> Geometry<'_, I> {
        Geometry {
            lit: &self.lits[record],
            rests: &self.rests[record],
            cosine: &self.cosines[record],
            foot: &self.feet[record],
            alpha_h: self.alphas[record],
            valid: self.valid[record],
            cone: self.cones.get(record),
        }
    }
}

impl<'b, I: Isa> Geometries<'b, I> {
    #[cfg_attr(optimized, inline(always))]
    fn part(&self, range: Range<usize>) -> Self {
        Self {
            lits: &self.lits[range.clone()],
            rests: &self.rests[range.clone()],
            cosines: &self.cosines[range.clone()],
            feet: &self.feet[range.clone()],
            alphas: &self.alphas[range.clone()],
            valid: &self.valid[range.clone()],
            cones: self.cones.get(range).unwrap_or_default(),
        }
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
    let mut located_cones = Records::new();
    isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            // Placeholders for what is not needed.
            let most = at_once.min(count);
            if wanted.extent == Extent::Lit {
                let none = Foot::none(isa);
                places.feet.fill(most, |_| none);
            }
            if wanted.extent != Extent::Cosine {
                let (none, zero) = (Cosine::none(isa), isa.splat(0.0));
                places.cosines.fill(most, |_| none);
                places.alphas.fill(most, |_| zero);
            }
        },
    );
    clear_rests(isa, at_once.min(count), &mut places);
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
        let rows = inputs.media.rows(rays, &mut media);
        locate(isa, inputs, emitters, groups.clone(), &mut places);
        if let Some(cones) = cones {
            in_cones(isa, inputs, emitters, cones, groups.start, &mut places, &mut located_cones);
        }
        let geometries = Geometries { cones: located_cones.written(), ..places.geometries() };
        for part in (0..groups.len()).step_by(wanted.records) {
            let part = part..groups.len().min(part + wanted.records);
            let of_part;
            // Rows of all columns of coloured media are long to copy.
            let media = if part.len() == groups.len() {
                &rows
            } else {
                of_part = rows.part(part.start * I::V::N..part.end * I::V::N);
                &of_part
            };
            visit(&Block {
                inputs,
                groups: groups.start + part.start..groups.start + part.end,
                media,
                geometries: geometries.part(part),
            });
        }
    }
}

/// Storage for the records of a block's geometry.
struct Places<I: Isa> {
    lits: Records<Lit<I>>,
    rests: Records<Rests<I>>,
    /// Whether lanes in f64 may have left rests that differ from 0.
    has_rests: bool,
    /// `|d| - 1`.
    excesses: Records<I::V>,
    cosines: Records<Cosine<I>>,
    feet: Records<Foot<I>>,
    alphas: Records<I::V>,
    valid: Records<I::Mask>,
}

impl<I: Isa> Places<I> {
    #[cfg_attr(optimized, inline(always))]
    fn new() -> Self {
        Self {
            lits: Records::new(),
            rests: Records::new(),
            has_rests: false,
            excesses: Records::new(),
            cosines: Records::new(),
            feet: Records::new(),
            alphas: Records::new(),
            valid: Records::new(),
        }
    }

    /// Replaces a record by `located`, the parts that are computed.
    #[cfg_attr(optimized, inline(always))]
    fn replace<const FOOT: bool, const COSINE: bool>(&mut self, record: usize, located: &Located<I>) {
        self.lits.written()[record] = located.lit;
        self.valid.written()[record] = located.valid;
        if FOOT {
            self.rests.written()[record] = located.rests;
            self.has_rests = true;
            self.feet.written()[record] = located.foot;
        }
        if COSINE {
            self.cosines.written()[record] = located.cosine;
            self.alphas.written()[record] = located.alpha_h;
        }
    }

    #[cfg_attr(optimized, inline(always))]
    fn geometries(&mut self) -> Geometries<'_, I> {
        Geometries {
            lits: self.lits.written(),
            rests: self.rests.written(),
            cosines: self.cosines.written(),
            feet: self.feet.written(),
            alphas: self.alphas.written(),
            valid: self.valid.written(),
            cones: &[],
        }
    }
}

/// Sets the first `count` rests to 0.
fn clear_rests<I: Isa>(isa: I, count: usize, places: &mut Places<I>) {
    isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let none = Rests::none(isa);
            places.rests.fill(count, |_| none);
            places.has_rests = false;
        },
    );
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

/// The counts of a chunk.
#[derive(Clone, Copy)]
pub(super) struct Tally {
    valid: usize,
    sampled: usize,
    bisected: usize,
    /// The lanes that are counted, a bit each.
    lanes: u32,
}

impl Tally {
    pub(super) fn new<I: Isa>(inputs: &Inputs<'_>) -> Self {
        let lanes = inputs.counted(I::V::N).fold(0, |lanes, lane| lanes | 1 << lane);
        Self { valid: 0, sampled: 0, bisected: 0, lanes }
    }

    /// Adds a value for each lane: whether it is `valid`, and if so `sampled`, and if so `bisected`.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn add<I: Isa>(&mut self, valid: I::Mask, sampled: I::Mask, bisected: I::Mask) {
        // In scalar registers, which kernels use little.
        self.valid += (I::V::bits(valid) & self.lanes).count_ones() as usize;
        self.sampled += (I::V::bits(sampled) & self.lanes).count_ones() as usize;
        self.bisected += (I::V::bits(bisected & sampled) & self.lanes).count_ones() as usize;
    }

    pub(super) fn counts<I: Isa>(self, inputs: &Inputs<'_>) -> Counts {
        let Self { valid, sampled, bisected, .. } = self;
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
    // Without `EXACT` lanes in f32 have no rests; those of the block before may have some.
    if FOOT && !EXACT && places.has_rests {
        clear_rests(isa, groups.len(), places);
    }
    // Whether all lanes are easy, and whether any is.
    let [mut every, any] = isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = inputs.ray_groups::<I>();
            let emitters = emitters.groups(isa);
            let mut emitter = emitters.emitters(isa, 0);
            let (mut lits, mut rests, mut excesses) =
                (places.lits.start(), places.rests.start(), places.excesses.start());
            let (mut cosines, mut valid) = (places.cosines.start(), places.valid.start());
            let (mut every, mut any) = (!none(isa), none(isa));
            let (mut feet, mut alphas) = (places.feet.start(), places.alphas.start());
            for group in groups.clone() {
                if inputs.prefetch {
                    rays.prefetch(isa, group, AHEAD);
                }
                if DIFFER {
                    emitter = emitters.emitters(isa, group - groups.start);
                }
                let ray = rays.lanes(isa, group);
                let mut clipped = clip::<I, EXACT, FOOT, COSINE>(isa, &ray, &emitter);
                if FOOT && !EXACT {
                    let FoundFoot { foot, alpha_h, easy, .. } =
                        find_foot::<I, EXACT, COSINE>(isa, &ray, &emitter, &clipped);
                    clipped.easy = easy;
                    feet.push(foot);
                    if COSINE {
                        alphas.push(alpha_h);
                    }
                }
                (every, any) = (every & clipped.easy, any | clipped.easy);
                lits.push(clipped.lit);
                if FOOT && EXACT {
                    rests.push(clipped.rests);
                    excesses.push(clipped.excess);
                }
                if COSINE {
                    cosines.push(clipped.cosine);
                }
                valid.push(clipped.easy);
            }
            lits.done();
            if FOOT && EXACT {
                rests.done();
                excesses.done();
            } else if FOOT {
                feet.done();
                if COSINE {
                    alphas.done();
                }
            }
            if COSINE {
                cosines.done();
            }
            valid.done();
            [I::V::bits(!every) == 0, I::V::bits(any) != 0]
        },
    );
    if !any {
        return in_double::<I, FOOT, COSINE>(isa, inputs, emitters, groups, places);
    }
    // A pass of its own: exact intervals and feet together do not fit the registers.
    if FOOT && EXACT {
        every = find_feet::<I, COSINE, DIFFER>(isa, inputs, emitters, groups.start, places);
    }
    if !every {
        rescue::<I, FOOT, COSINE>(isa, inputs, emitters, groups.start, places);
    }
}

/// Computes the feet of the perpendiculars of exact precision after the lit intervals; returns whether all lanes are easy.
fn find_feet<I: Isa, const COSINE: bool, const DIFFER: bool>(
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
            // Equal lengths remove bounds checks.
            let count = lits.len();
            let (rests, valid) = (&mut places.rests.written()[..count], &mut places.valid.written()[..count]);
            let (excesses, cosines) = (&places.excesses.written()[..count], &places.cosines.written()[..count]);
            let (mut feet, mut alphas) = (places.feet.start(), places.alphas.start());
            let mut every = !none(isa);
            for record in 0..count {
                if DIFFER {
                    emitter = emitters.emitters(isa, record);
                }
                let ray = rays.lanes(isa, start + record);
                let clipped = Clipped {
                    lit: lits[record],
                    rests: rests[record],
                    excess: excesses[record],
                    q: isa.splat(0.0),
                    cosine: cosines[record],
                    easy: valid[record],
                };
                let FoundFoot { foot, h_squared_rest, alpha_h, easy } =
                    find_foot::<I, true, COSINE>(isa, &ray, &emitter, &clipped);
                (every, valid[record]) = (every & easy, easy);
                rests[record].h_squared = h_squared_rest;
                feet.push(foot);
                if COSINE {
                    alphas.push(alpha_h);
                }
            }
            if COSINE {
                alphas.done();
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
            for record in 0..places.lits.written().len() {
                let hard = !places.valid.written()[record];
                if I::V::bits(hard) != 0 {
                    if emitters.differ() {
                        emitter = emitters.emitters(isa, record);
                    }
                    let exact = in_f64(isa, &rays.lanes(isa, start + record), &emitter);
                    let located = exact.or(hard, places.geometries().get(record));
                    places.replace::<FOOT, COSINE>(record, &located);
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
            let (mut lits, mut rests, mut valid) = (places.lits.start(), places.rests.start(), places.valid.start());
            let (mut cosines, mut alphas) = (places.cosines.start(), places.alphas.start());
            let mut feet = places.feet.start();
            for group in groups {
                if inputs.prefetch {
                    rays.prefetch(isa, group, AHEAD);
                }
                if emitters.differ() {
                    emitter = emitters.emitters(isa, group - start);
                }
                let located = in_f64(isa, &rays.lanes(isa, group), &emitter);
                lits.push(located.lit);
                valid.push(located.valid);
                if FOOT {
                    rests.push(located.rests);
                    feet.push(located.foot);
                }
                if COSINE {
                    cosines.push(located.cosine);
                    alphas.push(located.alpha_h);
                }
            }
            lits.done();
            valid.done();
            if FOOT {
                rests.done();
                feet.done();
                places.has_rests = true;
            }
            if COSINE {
                cosines.done();
                alphas.done();
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
    located_cones: &mut Records<Cone<I>>,
) {
    isa.vectorize::<Cone<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = inputs.ray_groups::<I>();
            let (emitters, cones) = (emitters.groups(isa), cones.groups(isa));
            let mut located = located_cones.start();
            for record in 0..places.lits.written().len() {
                let ray = rays.lanes(isa, start + record);
                let (exact, cone) = in_cone(isa, &ray, &emitters.spots(isa, &cones, record));
                let exact = exact.or(cone.is_spot, places.geometries().get(record));
                places.replace::<true, true>(record, &exact);
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
