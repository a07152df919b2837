//! The blocks of a chunk: a few lane groups, with short passes over all of them.
//!
//! A pass reads the records of the pass before and writes its own; they stay in the nearest caches. The passes are
//!
//! 1. geometry, the part that is needed: the lit interval and the foot of the perpendicular, hard lanes in f64, spots in f64, and
//!    what the foot lacks for a path in f64;
//! 2. set-up, inversion and output of a density, a pass each: the shorter a pass, the more groups are in flight at a time. The Taylor
//!    densities, whose set-ups do not fit the nearest cache, take one pass if each ray has one variate;
//! 3. weights, the same for all densities.

use super::locate::{Geometries, Places, fill_placeholders, in_cones, locate, refine_feet};
use crate::Precision;
use crate::batch::{
    ChannelGroups, ConePlace, EmitterPlace, Inputs, MOST_RAYS, MediaPlace, MediaRows, MediumGroups, RayGroups, Run,
    Turn,
};
use crate::density::{Density, Kind, SetUp};
use crate::geometry::Extent;
use crate::integrand::MediumLanes;
use crate::simd::{GROUPS, Isa, Lanes, Records, Room};
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
    pub(super) precision: Precision,
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
    let mut places = Places::new();
    let mut located_cones = Records::new();
    fill_placeholders(isa, wanted.extent, at_once.min(count), &mut places);
    let locate = locate::<I>(wanted.extent, wanted.precision, inputs.emitters.points.differs());
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
        if wanted.extent == Extent::Path && wanted.precision.is_exact::<I>() {
            refine_feet(isa, inputs, emitters, groups.start, &mut places);
        }
        let geometries = places.geometries(located_cones.written());
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
                precision: wanted.precision,
                geometries: geometries.part(part),
            });
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

/// Storage for the set-ups of a block.
pub(super) type SetUps<I, D> = <<D as Kind>::On<I> as Density<I>>::SetUps;

/// Sets up the densities of a block.
pub(super) fn set_up<'r, I: Isa, Home, D: Density<I>>(
    isa: I,
    block: &Block<'_, I>,
    records: &'r mut D::SetUps,
) -> &'r [SetUp<I, D>] {
    if D::HAS_FAST_SET_UP && !block.precision.is_exact::<I>() {
        set_up_in::<I, Home, D, false>(isa, block, records)
    } else {
        set_up_in::<I, Home, D, true>(isa, block, records)
    }
}

fn set_up_in<'r, I: Isa, Home, D: Density<I>, const EXACT: bool>(
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
                |record| for_set_up.set_up(isa, if EXACT { Precision::Exact } else { Precision::Fast }, record),
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
    pub(super) fn set_up<D: Density<I>>(&mut self, isa: I, precision: Precision, record: usize) -> SetUp<I, D> {
        self.media.renew(isa, record, &mut self.medium);
        let ray = self.rays.lanes(isa, self.first + record);
        let channels = ChannelGroups::lanes(self.channels.as_ref(), isa, record);
        SetUp::new(isa, precision, &ray, self.geometries.get(record), &self.medium, channels.as_ref())
    }
}
