//! What the density's own normalisation says of the integral.

use super::Task;
use super::groups::{Group, for_each_group};
use crate::Strategy;
use crate::batch::{Column, Counts, Inputs};
use crate::density::{Density, Kind};
use crate::simd::{Isa, Kernel, Lanes, Machine, none};
use crate::strategy::product::{Product, knots};
use core::marker::PhantomData;

/// Product densities alone have one; the sampler refuses others.
pub(crate) struct Radiance;

impl Task for Radiance {
    type Out = Column;

    fn run(machine: impl Machine, strategy: Strategy, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
        match strategy {
            Strategy::Product3 => machine.run(OnGroups::<knots::three::Kind, 3>::new(inputs, out)),
            Strategy::Product5 => machine.run(OnGroups::<knots::five::Kind, 5>::new(inputs, out)),
            Strategy::Product9 => machine.run(OnGroups::<knots::nine::Kind, 9>::new(inputs, out)),
            Strategy::Product17 => machine.run(OnGroups::<knots::seventeen::Kind, 17>::new(inputs, out)),
            _ => Counts::default(),
        }
    }
}

/// Its kernel for a number of knots.
struct OnGroups<'a, D, const K: usize> {
    inputs: &'a Inputs<'a>,
    out: &'a mut [f32],
    density: PhantomData<D>,
}

impl<'a, D, const K: usize> OnGroups<'a, D, K> {
    fn new(inputs: &'a Inputs<'a>, out: &'a mut [f32]) -> Self {
        Self { inputs, out, density: PhantomData }
    }
}

impl<D: Kind, const K: usize> Kernel for OnGroups<'_, D, K> {
    type Output = Counts;
    type Home = D;

    #[cfg_attr(optimized, inline(always))]
    fn run<I: Isa>(self, isa: I) -> Counts {
        let Self { inputs, out, .. } = self;
        let zero = isa.splat(0.0);
        for_each_group(
            isa,
            inputs,
            #[cfg_attr(optimized, inline(always))]
            |group, tally| {
                let Group { geometry, medium, index } = &group;
                let lit = Product::<I, K>::lit(isa, geometry);
                let sampled = group.valid() & lit;
                let radiance = Product::<I, K>::new(isa, geometry, medium).radiance(isa, geometry, medium);
                let value = I::V::select(sampled, radiance.min(isa.splat(f32::MAX)), zero);
                inputs.turn(*index, 0).store(isa, value, out);
                tally.add(isa, group.valid(), lit, none(isa));
            },
        )
    }
}
