//! The choice of an emitter of a table for each ray, in proportion to its share of the light.
//!
//! Equations of `docs/mathematics.md`, section 10, with the integrals `L_i` of `integral/rule.rs`:
//!
//! ```text
//! P_i = w_i L_i / Sum_j w_j L_j                                                        (10.1)
//! i: the last emitter with w_i L_i > 0 before which the sum is below u Sum_j w_j L_j   (10.2)
//! ```
//!
//! For a block of rays, `sum` adds the shares `w_i L_i` of all emitters in 32 slots, `search` finds the slot by (10.2), `refine`
//! finds the emitter within the slot if a slot has several, and `write` writes (10.1).
//!
//! The slots keep the choice increasing with `u`. A reservoir would need none, but it takes new bits of the variate at every
//! emitter, which f32 does not have, and its choice does not increase with `u`.

use super::blocks::{for_each_block, groups_at_once};
use super::radiance::{Integrated, Quadrature, for_each_radiance, of_integral};
use super::tally::Tally;
use super::{Out, Task};
use crate::batch::{Choices, Counts, Emitters, Inputs, MOST_RAYS, Rows};
use crate::integral::rule::Rule;
use crate::scene::Emitter;
use crate::simd::{GROUPS, Isa, Kernel, Lanes, Machine, Number, Records, Room, none};
use crate::{Nodes, Precision};
use core::marker::PhantomData;

/// The number of slots of a ray: the sums of a block then stay in a core's cache.
const SLOTS: usize = 32;

/// The emitters, their weights, and the rule of the integral.
#[derive(Clone, Copy)]
pub(crate) struct Lights<'t> {
    pub(crate) quadrature: Quadrature,
    pub(crate) table: &'t [Emitter],
    /// One weight per emitter.
    pub(crate) weights: &'t [f32],
    pub(crate) has_spots: bool,
}

/// Chooses one of the [`Lights`].
pub(crate) struct Choose<'t>(PhantomData<&'t ()>);

impl<'t> Task for Choose<'t> {
    type Method = Lights<'t>;
    type Out = Choices;

    fn run(machine: impl Machine, lights: Lights<'t>, inputs: &Inputs<'_>, out: Out<'_, Self>) -> Counts {
        match lights.quadrature.nodes {
            Nodes::Four => machine.run(OnGroups::<4> { lights, inputs, out }),
            Nodes::Six => machine.run(OnGroups::<6> { lights, inputs, out }),
            Nodes::Eight => machine.run(OnGroups::<8> { lights, inputs, out }),
            Nodes::Twelve => machine.run(OnGroups::<12> { lights, inputs, out }),
        }
    }
}

/// The kernel for a number of nodes.
struct OnGroups<'a, 't, const K: usize> {
    lights: Lights<'t>,
    inputs: &'a Inputs<'a>,
    out: (&'a mut [u32], &'a mut [f32]),
}

impl<const K: usize> Kernel for OnGroups<'_, '_, K> {
    type Output = Counts;

    fn run<I: Isa>(self, isa: I) -> Counts {
        let Self { lights, inputs, out: (index, probability) } = self;
        let mut tally = Tally::new::<I>(inputs);
        let (mut sums, mut searches) = (Records::new(), Records::new());
        let at_once = groups_at_once::<I>() * I::V::N;
        for start in (0..inputs.len()).step_by(at_once) {
            let rays = start..inputs.len().min(start + at_once);
            let (index, probability) = (&mut index[rays.clone()], &mut probability[rays.clone()]);
            let block = OfBlock::<K> { lights, inputs: &inputs.slice(rays) };
            block.sum(isa, &mut sums);
            block.search(isa, sums.written(), &mut searches);
            if block.per_slot() > 1 {
                block.refine(isa, sums.written(), searches.written(), index, probability);
            }
            block.write(isa, searches.written(), index, probability, &mut tally);
        }
        tally.counts::<I>(inputs)
    }
}

/// The sums of all slots of all lane groups of a block, slot by slot.
type Sums<I> = Records<<I as Isa>::Double, { SLOTS * GROUPS }>;

/// The state of the search of a lane group.
#[derive(Clone, Copy)]
struct Search<I: Isa> {
    /// The sum of all shares; NaN for an invalid ray.
    total: I::V,
    /// `u` times `total`; NaN if `u` is not in `[0, 1]`.
    target: I::V,
    /// The sum of the shares offered so far.
    before: I::Double,
    /// The number taken last, and its share; the share is 0 if none was taken.
    taken: I::V,
    share: I::V,
}

impl<I: Isa> Search<I> {
    /// (10.2): offers the next number. It is taken if its share is not 0 and the sum before it is below the target.
    #[cfg_attr(optimized, inline(always))]
    fn offer(&mut self, isa: I, number: I::V, share: I::Double) {
        let zero = isa.splat(0.0);
        let rounded = I::V::narrow(share);
        let open = self.share.le(zero) | I::V::narrow(self.before).lt(self.target);
        let takes = zero.lt(rounded) & open;
        self.taken = I::V::select(takes, number, self.taken);
        self.share = I::V::select(takes, rounded, self.share);
        self.before = self.before + share;
    }
}

/// The rays of a block, or fewer.
struct OfBlock<'b, 't, const K: usize> {
    lights: Lights<'t>,
    inputs: &'b Inputs<'b>,
}

impl<const K: usize> OfBlock<'_, '_, K> {
    /// The number of emitters of a slot.
    fn per_slot(&self) -> usize {
        self.lights.table.len().div_ceil(SLOTS)
    }

    fn groups<I: Isa>(&self) -> usize {
        self.inputs.len() / I::V::N
    }

    /// Sums the shares in slots.
    fn sum<I: Isa>(&self, isa: I, sums: &mut Sums<I>) {
        let (groups, slots) = (self.groups::<I>(), self.lights.table.len().div_ceil(self.per_slot()));
        isa.vectorize::<Rule<K>, _>(
            #[cfg_attr(optimized, inline(always))]
            || {
                let zero = isa.splat_double(0.0);
                sums.fill(slots * groups, |_| zero);
            },
        );
        for (i, (emitter, weight)) in self.lights.table.iter().zip(self.lights.weights).enumerate() {
            let slot = i / self.per_slot();
            let sums = &mut sums.written()[slot * groups..][..groups];
            self.for_each_share(
                isa,
                Emitters::one(*emitter),
                Rows::One([*weight]),
                #[cfg_attr(optimized, inline(always))]
                |record, share: I::V| sums[record] = sums[record] + share.widen(),
            );
        }
    }

    /// Calls `visit` with the share of one emitter for each ray.
    fn for_each_share<I: Isa>(
        &self,
        isa: I,
        emitters: Emitters<'_>,
        weights: Rows<'_, 1>,
        mut visit: impl FnMut(usize, I::V),
    ) {
        // The bound keeps the sum of all shares finite.
        let most = f32::MAX / (2 * self.lights.table.len()) as f32;
        for_each_block(isa, &self.inputs.lit_by(emitters), of_integral(self.precision()), |block| {
            isa.vectorize::<Rule<K>, _>(
                #[cfg_attr(optimized, inline(always))]
                || {
                    let (weights, nan) = (weights.groups(isa), isa.splat(f32::NAN));
                    for_each_radiance::<I, K>(
                        isa,
                        block,
                        block.media.means,
                        #[cfg_attr(optimized, inline(always))]
                        |record, Integrated { radiance, valid, .. }| {
                            let [weight] = weights.lanes(isa, record);
                            visit(record, I::V::select(valid, (weight * radiance).min(isa.splat(most)), nan));
                        },
                    );
                },
            );
        });
    }

    fn precision(&self) -> Precision {
        self.lights.quadrature.precision
    }

    /// Finds the slots.
    fn search<I: Isa>(&self, isa: I, sums: &[I::Double], searches: &mut Records<Search<I>>) {
        let (groups, u) = (self.groups::<I>(), I::groups(self.inputs.given));
        isa.vectorize::<Rule<K>, _>(
            #[cfg_attr(optimized, inline(always))]
            || {
                let (zero, one, nan) = (isa.splat(0.0), isa.splat(1.0), isa.splat(f32::NAN));
                searches.fill(
                    groups,
                    #[cfg_attr(optimized, inline(always))]
                    |record| {
                        let mut total = isa.splat_double(0.0);
                        for of_slot in sums.chunks_exact(groups) {
                            total = total + of_slot[record];
                        }
                        let (u, total) = (isa.load(&u[record]), I::V::narrow(total));
                        let target = I::V::select(zero.le(u) & u.le(one), u * total, nan);
                        let before = isa.splat_double(0.0);
                        let mut search = Search { total, target, before, taken: zero, share: zero };
                        let mut slot = zero;
                        for of_slot in sums.chunks_exact(groups) {
                            search.offer(isa, slot, of_slot[record]);
                            slot = slot + one;
                        }
                        search
                    },
                );
            },
        );
    }

    /// Finds the emitters within the slots. The outputs serve as storage for their numbers and weights.
    fn refine<I: Isa>(
        &self,
        isa: I,
        sums: &[I::Double],
        searches: &mut [Search<I>],
        index: &mut [u32],
        weights: &mut [f32],
    ) {
        let (groups, per_slot) = (self.groups::<I>(), self.per_slot());
        isa.vectorize::<Rule<K>, _>(
            #[cfg_attr(optimized, inline(always))]
            || {
                let (zero, one) = (isa.splat(0.0), isa.splat(1.0));
                let places = I::groups_mut(weights);
                for ((record, search), place) in searches.iter_mut().enumerate().zip(places) {
                    // The sum of the slots before the one taken.
                    (search.before, search.share) = (isa.splat_double(0.0), zero);
                    let mut slot = zero;
                    for of_slot in sums.chunks_exact(groups) {
                        let counts = I::V::only(slot.lt(search.taken), one).widen();
                        search.before = counts.mul_add(of_slot[record], search.before);
                        slot = slot + one;
                    }
                    isa.store(search.taken, place);
                }
            },
        );
        for (index, slot) in index.iter_mut().zip(&*weights) {
            *index = (*slot as usize * per_slot) as u32;
        }
        for offset in 0..per_slot {
            // Emitters beyond the table have the weight 0, and are never taken.
            for (weight, index) in weights.iter_mut().zip(&*index) {
                *weight = self.lights.weights.get(*index as usize).copied().unwrap_or(0.0);
            }
            let number = isa.splat(offset as f32);
            self.for_each_share(
                isa,
                Emitters::entries(self.lights.table, index, self.lights.has_spots),
                Rows::Each([weights]),
                #[cfg_attr(optimized, inline(always))]
                |record, share: I::V| {
                    let search = &mut searches[record];
                    let share = I::V::only(share.eq(share), share);
                    search.offer(isa, number, share.widen());
                },
            );
            index.iter_mut().for_each(|index| *index += 1);
        }
        // Back to the first emitter of each slot: the search has the offset from it.
        index.iter_mut().for_each(|index| *index -= per_slot as u32);
    }

    /// Writes index and probability (10.1).
    fn write<I: Isa>(
        &self,
        isa: I,
        searches: &[Search<I>],
        index: &mut [u32],
        probability: &mut [f32],
        tally: &mut Tally,
    ) {
        let mut taken = [0.0; MOST_RAYS];
        isa.vectorize::<Rule<K>, _>(
            #[cfg_attr(optimized, inline(always))]
            || {
                let (zero, least) = (isa.splat(0.0), isa.splat(f32::MIN_POSITIVE));
                let places = I::groups_mut(probability).iter_mut().zip(I::groups_mut(&mut taken));
                for (search, (probability, taken)) in searches.iter().zip(places) {
                    let valid = search.target.eq(search.target);
                    let sampled = valid & zero.lt(search.total);
                    isa.store(I::V::only(sampled, (search.share / search.total).max(least)), probability);
                    isa.store(I::V::only(sampled, search.taken), taken);
                    tally.add::<I>(valid, sampled, none(isa));
                }
            },
        );
        let several = self.per_slot() > 1;
        for ((index, probability), taken) in index.iter_mut().zip(probability).zip(taken) {
            let first = if several && *probability > 0.0 { *index } else { 0 };
            *index = first + taken as u32;
        }
    }
}
