//! What the density's own normalisation says of the integral.

use super::blocks::{Tally, Wanted, for_each_block, set_up};
use super::{Method, Task};
use crate::batch::{Column, Counts, Inputs};
use crate::density::{Density, SetUp};
use crate::geometry::Extent;
use crate::simd::{Isa, Kernel, Lanes, Machine, Room, none};
use crate::strategy::product::{Product, knots};
use crate::{Precision, Strategy};
use core::marker::PhantomData;

/// Product densities alone have one; the sampler refuses others.
pub(crate) struct Radiance;

impl Task for Radiance {
    type Out = Column;

    fn run(machine: impl Machine, method: Method, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
        let Method { strategy, precision } = method;
        match strategy {
            Strategy::Product3 => machine.run(OnGroups::<knots::three::Kind, 3>::new(precision, inputs, out)),
            Strategy::Product5 => machine.run(OnGroups::<knots::five::Kind, 5>::new(precision, inputs, out)),
            Strategy::Product9 => machine.run(OnGroups::<knots::nine::Kind, 9>::new(precision, inputs, out)),
            Strategy::Product17 => machine.run(OnGroups::<knots::seventeen::Kind, 17>::new(precision, inputs, out)),
            _ => Counts::default(),
        }
    }
}

/// Its kernel for a number of knots.
struct OnGroups<'a, D, const K: usize> {
    precision: Precision,
    inputs: &'a Inputs<'a>,
    out: &'a mut [f32],
    density: PhantomData<D>,
}

impl<'a, D, const K: usize> OnGroups<'a, D, K> {
    fn new(precision: Precision, inputs: &'a Inputs<'a>, out: &'a mut [f32]) -> Self {
        Self { precision, inputs, out, density: PhantomData }
    }
}

impl<D, const K: usize> Kernel for OnGroups<'_, D, K> {
    type Output = Counts;

    fn run<I: Isa>(self, isa: I) -> Counts {
        let Self { precision, inputs, out, .. } = self;
        let mut tally = Tally::new(isa, inputs);
        let mut set_ups = <Product<I, K> as Density<I>>::SetUps::new();
        let records = <Product<I, K> as Density<I>>::SetUps::SIZE;
        for_each_block(isa, inputs, Wanted { precision, extent: Extent::Cosine, records }, |block| {
            let set_ups = set_up::<I, D, Product<I, K>>(isa, block, &mut set_ups);
            isa.vectorize::<D, _>(
                #[cfg_attr(optimized, inline(always))]
                || {
                    let (rays, media) = (inputs.ray_groups::<I>(), block.media.groups(isa));
                    let mut medium = media.media(isa, 0);
                    let geometries = block.geometries();
                    let out = &mut I::groups_mut(out)[block.groups.clone()];
                    for (record, (set_up, out)) in set_ups.iter().zip(out).enumerate() {
                        let (group, geometry) = (block.groups.start + record, geometries.get(record));
                        media.renew(isa, record, &mut medium);
                        let SetUp { density, valid, lit } = set_up;
                        let radiance = density.radiance(isa, &rays.lanes(isa, group), geometry, &medium);
                        let value = I::V::only(*valid & *lit, radiance.min(isa.splat(f32::MAX)));
                        isa.store(value, out);
                        tally.add(*valid, *valid & *lit, none(isa));
                    }
                },
            );
        });
        tally.counts(isa, inputs)
    }
}
