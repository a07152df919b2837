//! The values of a run of turns as contiguous columns, wherever they lie in the columns of the caller.

use crate::simd::{GROUPS, MOST_LANES};
use core::ops::Range;

/// Value number `index` of every lane of a lane group; the group has the number `record` in its block.
#[derive(Clone, Copy, Default)]
pub(crate) struct Turn {
    pub(crate) record: usize,
    pub(crate) index: usize,
}

/// The order of the values of a lane group.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Order {
    /// The values of a lane lie next to each other.
    ByLane,
    /// The values of a turn, one for each lane, lie next to each other.
    ByTurn,
}

/// Storage for the values of a run of any backend.
pub(crate) struct RunPad([f32; GROUPS * MOST_LANES]);

impl RunPad {
    pub(super) fn new() -> Self {
        Self([0.0; GROUPS * MOST_LANES])
    }

    /// The part for the values of a run.
    pub(super) fn of(&mut self, run: Run<'_>) -> &mut [f32] {
        &mut self.0[..run.len()]
    }
}

/// A run: turns that follow each other.
#[derive(Clone, Copy)]
pub(crate) struct Run<'r> {
    pub(crate) turns: &'r [Turn],
    /// The number in the chunk of the first group of the block.
    pub(super) first: usize,
    pub(super) lanes: usize,
    pub(super) per_ray: usize,
    pub(super) order: Order,
}

impl Run<'_> {
    /// The number of its values.
    pub(crate) fn len(&self) -> usize {
        self.turns.len() * self.lanes
    }

    /// The range of its values in a column, if they lie next to each other.
    pub(super) fn together(&self) -> Option<Range<usize>> {
        let Turn { record, index } = self.turns[0];
        let start = ((self.first + record) * self.per_ray + index) * self.lanes;
        (self.order == Order::ByTurn).then_some(start..start + self.len())
    }

    /// Its values in `column`, copied to `pad` if they do not lie next to each other.
    pub(crate) fn values<'c>(&self, column: &'c [f32], pad: &'c mut Option<RunPad>) -> &'c [f32] {
        if let Some(range) = self.together() {
            return &column[range];
        }
        let pad = pad.get_or_insert_with(RunPad::new);
        for (turn, lanes) in self.turns.iter().zip(pad.0.chunks_exact_mut(self.lanes)) {
            // Lanes beyond the rays have no values.
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

    /// Calls `write` with a pad, and copies that to its values in `column`, which do not lie next to each other.
    pub(super) fn scatter<R>(&self, column: &mut [f32], write: impl FnOnce(&mut [f32]) -> R) -> R {
        let mut pad = RunPad::new();
        let result = write(pad.of(*self));
        self.copy(&pad, column);
        result
    }

    /// Copies a pad to its values in a column, which do not lie next to each other.
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
