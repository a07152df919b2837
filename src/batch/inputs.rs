//! The inputs of a call, and the parts into which it is cut.

use super::runs::Order;
use super::{Emitters, Media, RayGroups, Rays, Run, Turn};
use crate::Error;
use crate::scene::{Emitter, Medium};
use crate::simd::Isa;
use core::ops::Range;

/// The input columns of a call: the batch, and for each ray some numbers (variates or distances) next to each other.
#[derive(Clone, Copy)]
pub(crate) struct Inputs<'a> {
    pub(crate) rays: Rays<'a>,
    pub(crate) emitters: Emitters<'a>,
    pub(crate) media: Media<'a>,
    /// The numbers of all rays; empty if the task takes none.
    pub(crate) given: &'a [f32],
    /// The number of numbers, and of output values, of each ray.
    pub(crate) per_ray: usize,
    pub(super) order: Order,
    /// Whether columns are prefetched.
    pub(crate) prefetch: bool,
    /// The lanes that are counted: from the first to before the second; `None` means all.
    pub(super) counted: Option<[usize; 2]>,
}

/// The least number of rays that are prefetched: their columns do not stay in a cache of 16 MiB. In a smaller batch prefetches
/// take more time than they save.
const FAR: usize = (1 << 18) + 1;

impl<'a> Inputs<'a> {
    /// The inputs without numbers, if every column has the same length.
    pub(crate) fn new(rays: &Rays<'a>, emitters: &Emitters<'a>, media: &Media<'a>) -> Result<Self, Error> {
        let (rays, emitters, media) = (*rays, *emitters, *media);
        let (order, prefetch) = (Order::ByTurn, rays.len() >= FAR);
        let inputs = Self { rays, emitters, media, given: &[], per_ray: 1, order, prefetch, counted: None };
        const O: [&str; 3] = ["rays.origin[0]", "rays.origin[1]", "rays.origin[2]"];
        const D: [&str; 3] = ["rays.direction[0]", "rays.direction[1]", "rays.direction[2]"];
        for k in 0..3 {
            inputs.check(O[k], rays.origin[k])?;
            inputs.check(D[k], rays.direction[k])?;
        }
        inputs.check("rays.t_min", rays.t_min)?;
        inputs.check("rays.t_max", rays.t_max)?;
        emitters.check(inputs.len())?;
        media.check(inputs.len())?;
        Ok(inputs)
    }

    /// The same for rays that are to be combined with every emitter of a table; the first one stands in.
    pub(crate) fn with_table(rays: &Rays<'a>, table: &[Emitter], media: &Media<'a>) -> Result<Self, Error> {
        let [first, ..] = table else { return Err(Error::Empty { field: "table" }) };
        Self::new(rays, &Emitters::one(*first), media)
    }

    /// One ray.
    pub(crate) fn one(rays: Rays<'a>, emitter: Emitter, medium: Medium, given: &'a [f32]) -> Self {
        let (emitters, media) = (Emitters::one(emitter), Media::one(medium));
        Self { rays, emitters, media, given, per_ray: 1, order: Order::ByTurn, prefetch: false, counted: None }
    }

    /// The same with the numbers `given`, if their length is that of the batch or a multiple; errors call them `name`.
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
        Error::unless_length(field, column.len(), self.len())
    }

    /// `Ok` if `column` has the length of the numbers given.
    pub(crate) fn check_given(&self, field: &'static str, column: &[f32]) -> Result<(), Error> {
        Error::unless_length(field, column.len(), self.given.len())
    }

    /// `Ok` if there are as many output columns as the media have channels; errors call them `field`.
    pub(crate) fn check_channels(&self, field: &'static str, channels: usize) -> Result<(), Error> {
        let expected = self.media.channels();
        let error = Error::Channels { field, index: None, channels, expected };
        if channels == expected { Ok(()) } else { Err(error) }
    }

    pub(crate) fn len(&self) -> usize {
        self.rays.len()
    }

    /// The number of output values.
    pub(crate) fn values(&self) -> usize {
        self.len() * self.per_ray
    }

    /// Only the rays of `range`.
    pub(crate) fn slice(&self, range: Range<usize>) -> Self {
        let given = self.given.get(range.start * self.per_ray..range.end * self.per_ray).unwrap_or_default();
        let emitters = self.emitters.part(range.clone());
        let media = self.media.part(range.clone());
        Self { rays: self.rays.part(range), emitters, media, given, ..*self }
    }

    /// The same rays with other emitters.
    pub(crate) fn lit_by<'b>(&self, emitters: Emitters<'b>) -> Inputs<'b>
    where
        'a: 'b,
    {
        Inputs { emitters, ..*self }
    }

    /// Only the numbers of `range`, of one ray.
    pub(crate) fn of_one_ray(&self, range: Range<usize>) -> Self {
        let per_ray = range.len();
        Self { given: self.given.get(range).unwrap_or_default(), per_ray, ..*self }
    }

    /// The same rays with other numbers, those of a turn next to each other.
    pub(crate) fn by_turn(&self, given: &'a [f32], per_ray: usize) -> Self {
        Self { given, per_ray, order: Order::ByTurn, ..*self }
    }

    /// The same, where only `lanes` are counted.
    pub(crate) fn counting(self, lanes: Range<usize>) -> Self {
        Self { counted: Some([lanes.start, lanes.end]), ..self }
    }

    /// The lanes that are counted, of a group of `lanes` lanes.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn counted(&self, lanes: usize) -> Range<usize> {
        let [start, end] = self.counted.unwrap_or([0, lanes]);
        start..end.min(lanes)
    }

    /// A run of turns of a block with the first group `first`, with `lanes` lanes per group.
    pub(crate) fn run<'r>(&self, turns: &'r [Turn], first: usize, lanes: usize) -> Run<'r> {
        Run { turns, first, lanes, per_ray: self.per_ray, order: self.order }
    }

    /// The rays in lane groups.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn ray_groups<I: Isa>(&self) -> RayGroups<'a, I> {
        self.rays.groups()
    }
}
