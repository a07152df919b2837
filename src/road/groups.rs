//! The lane groups of a chunk, one after the other, and what becomes of their values.

use crate::batch::{Counts, Inputs, Turn};
use crate::geometry::Geometry;
use crate::integrand::MediumLanes;
use crate::simd::{Isa, Lanes, MOST_LANES};

/// A lane group before its density is chosen.
pub(super) struct Group<I: Isa> {
    pub(super) geometry: Geometry<I>,
    pub(super) medium: MediumLanes<I>,
    /// Which one of the chunk it is.
    pub(super) index: usize,
}

impl<I: Isa> Group<I> {
    /// Which lanes are rays with a medium.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn valid(&self) -> I::Mask {
        self.geometry.valid & self.medium.valid
    }
}

/// What became of the values of at most one chunk, summed in the lanes: whole numbers that f32 can count.
pub(super) struct Tally<I: Isa> {
    valid: I::V,
    sampled: I::V,
    bisected: I::V,
    /// What a value counts: 1 in the lanes that count, 0 in others.
    one: I::V,
    /// How many values there were.
    values: usize,
    /// How many of them a turn has.
    per_turn: usize,
}

impl<I: Isa> Tally<I> {
    #[cfg_attr(optimized, inline(always))]
    fn new(isa: I, inputs: &Inputs<'_>) -> Self {
        let counted = inputs.counted(I::V::N);
        let mut ones = [0.0; MOST_LANES];
        for lane in &mut ones[counted.clone()] {
            *lane = 1.0;
        }
        let (zero, one) = (isa.splat(0.0), isa.load(&I::groups(&ones)[0]));
        Self { valid: zero, sampled: zero, bisected: zero, one, values: 0, per_turn: counted.len() }
    }

    /// One more value for each lane: `valid` with what was given, `lit` for the density, and `bisected`.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn add(&mut self, isa: I, valid: I::Mask, lit: I::Mask, bisected: I::Mask) {
        let (one, zero) = (self.one, isa.splat(0.0));
        let sampled = valid & lit;
        self.valid = self.valid + I::V::select(valid, one, zero);
        self.sampled = self.sampled + I::V::select(sampled, one, zero);
        self.bisected = self.bisected + I::V::select(bisected & sampled, one, zero);
        self.values += self.per_turn;
    }

    #[cfg_attr(optimized, inline(always))]
    fn counts(self, isa: I) -> Counts {
        let valid = sum_of_lanes(isa, self.valid);
        let sampled = sum_of_lanes(isa, self.sampled);
        let bisected = sum_of_lanes(isa, self.bisected);
        Counts { sampled, empty: valid - sampled, invalid: self.values - valid, bisected }
    }
}

/// The sum of whole numbers, which f32 holds.
#[cfg_attr(optimized, inline(always))]
fn sum_of_lanes<I: Isa>(isa: I, lanes: I::V) -> usize {
    let mut values = [0.0f32; MOST_LANES];
    isa.store(lanes, &mut I::groups_mut(&mut values)[0]);
    // Halves on halves: in a row every sum waits for the one before.
    let mut width = I::V::N / 2;
    while width > 0 {
        let mut i = 0;
        while i < width {
            values[i] += values[i + width];
            i += 1;
        }
        width /= 2;
    }
    values[0] as usize
}

/// The lane groups of a chunk, each visited once.
#[cfg_attr(optimized, inline(always))]
pub(super) fn for_each_group<I: Isa>(
    isa: I,
    inputs: &Inputs<'_>,
    mut visit: impl FnMut(Group<I>, &mut Tally<I>),
) -> Counts {
    let mut tally = Tally::new(isa, inputs);
    let rays = inputs.ray_groups::<I>();
    let (mut emitter, mut medium) = (inputs.emitters.lanes(isa, 0), inputs.media.lanes(isa, 0));
    for index in 0..rays.count() {
        if index > 0 {
            inputs.emitters.renew(isa, index, &mut emitter);
            inputs.media.renew(isa, index, &mut medium);
        }
        let geometry = Geometry::new(isa, &rays.lanes(isa, index), &emitter);
        visit(Group { geometry, medium, index }, &mut tally);
    }
    tally.counts(isa)
}

/// What is given for a lane group, turn by turn.
#[cfg_attr(optimized, inline(always))]
pub(super) fn for_each_turn<I: Isa>(
    isa: I,
    inputs: &Inputs<'_>,
    group: usize,
    tally: &mut Tally<I>,
    mut visit: impl FnMut(Turn, I::V, &mut Tally<I>),
) {
    for index in 0..inputs.per_ray {
        let turn = inputs.turn(group, index);
        visit(turn, turn.load(isa, inputs.given), tally);
    }
}
