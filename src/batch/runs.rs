//! The values of a run of turns as columns of their own, wherever they lie in those of the caller.

use crate::simd::{GROUPS, MOST_LANES};
use core::ops::Range;

/// Number `index` of the values of every lane of a lane group, of which a block has the `record`.
#[derive(Clone, Copy, Default)]
pub(crate) struct Turn {
    pub(crate) record: usize,
    pub(crate) index: usize,
}

/// How the values of a lane group lie.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Order {
    /// Those of a lane next to each other.
    ByLane,
    /// Those of a turn next to each other, one for each lane.
    ByTurn,
}

/// As many values as a run of any backend has, or more.
pub(crate) struct RunPad([f32; GROUPS * MOST_LANES]);

impl RunPad {
    pub(super) fn new() -> Self {
        Self([0.0; GROUPS * MOST_LANES])
    }

    /// Place for the values of a run.
    pub(super) fn of(&mut self, run: Run<'_>) -> &mut [f32] {
        &mut self.0[..run.len()]
    }
}

/// Turns that follow each other.
#[derive(Clone, Copy)]
pub(crate) struct Run<'r> {
    pub(crate) turns: &'r [Turn],
    /// Of which group of the chunk the first record of the block is.
    pub(super) first: usize,
    pub(super) lanes: usize,
    pub(super) per_ray: usize,
    pub(super) order: Order,
}

impl Run<'_> {
    /// How many values it has.
    pub(crate) fn len(&self) -> usize {
        self.turns.len() * self.lanes
    }

    /// Where they are, if they lie next to each other.
    pub(super) fn together(&self) -> Option<Range<usize>> {
        let Turn { record, index } = self.turns[0];
        let start = ((self.first + record) * self.per_ray + index) * self.lanes;
        (self.order == Order::ByTurn).then_some(start..start + self.len())
    }

    /// Its values of `column`, if need be by way of `pad`.
    pub(crate) fn values<'c>(&self, column: &'c [f32], pad: &'c mut Option<RunPad>) -> &'c [f32] {
        if let Some(range) = self.together() {
            return &column[range];
        }
        let pad = pad.get_or_insert_with(RunPad::new);
        for (turn, lanes) in self.turns.iter().zip(pad.0.chunks_exact_mut(self.lanes)) {
            // Lanes beyond the rays find no values.
            let of_group = &column[(self.first + turn.record) * self.lanes * self.per_ray..];
            let mut at = turn.index;
            for lane in lanes {
                let Some(value) = of_group.get(at) else { break };
                *lane = *value;
                at += self.per_ray;
            }
        }
        &pad.0[..self.len()]
    }

    /// Has `write` write its values of `column`, which do not lie next to each other, to a pad.
    pub(super) fn scatter<R>(&self, column: &mut [f32], write: impl FnOnce(&mut [f32]) -> R) -> R {
        let mut pad = RunPad::new();
        let result = write(pad.of(*self));
        self.copy(&pad, column);
        result
    }

    /// Copies its values from a pad to a column where they do not lie next to each other.
    pub(super) fn copy(&self, pad: &RunPad, column: &mut [f32]) {
        for (turn, lanes) in self.turns.iter().zip(pad.0.chunks_exact(self.lanes)) {
            let of_group = &mut column[(self.first + turn.record) * self.lanes * self.per_ray..];
            let mut at = turn.index;
            for lane in lanes {
                let Some(value) = of_group.get_mut(at) else { break };
                *value = *lane;
                at += self.per_ray;
            }
        }
    }
}
