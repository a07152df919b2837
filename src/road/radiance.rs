//! The integral of the integrand along each ray.

use super::Task;
use super::blocks::{Tally, Wanted, for_each_block};
use crate::batch::{Column, Counts, Inputs};
use crate::geometry::Extent;
use crate::integral::rule::Rule;
use crate::simd::{GROUPS, Isa, Kernel, Lanes, Machine, none};
use crate::{Nodes, Precision};

/// By how many nodes, and on geometry of which precision.
#[derive(Clone, Copy)]
pub(crate) struct Quadrature {
    pub(crate) nodes: Nodes,
    pub(crate) precision: Precision,
}

pub(crate) struct Radiance;

impl Task for Radiance {
    type Method = Quadrature;
    type Out = Column;

    fn run(machine: impl Machine, method: Quadrature, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
        let Quadrature { nodes, precision } = method;
        match nodes {
            Nodes::Four => machine.run(OnGroups::<4> { precision, inputs, out }),
            Nodes::Six => machine.run(OnGroups::<6> { precision, inputs, out }),
            Nodes::Eight => machine.run(OnGroups::<8> { precision, inputs, out }),
            Nodes::Twelve => machine.run(OnGroups::<12> { precision, inputs, out }),
        }
    }
}

/// Its kernel for a number of nodes.
struct OnGroups<'a, const K: usize> {
    precision: Precision,
    inputs: &'a Inputs<'a>,
    out: &'a mut [f32],
}

impl<const K: usize> Kernel for OnGroups<'_, K> {
    type Output = Counts;

    fn run<I: Isa>(self, isa: I) -> Counts {
        let Self { precision, inputs, out } = self;
        let mut tally = Tally::new(isa, inputs);
        for_each_block(isa, inputs, Wanted { precision, extent: Extent::Cosine, records: GROUPS }, |block| {
            isa.vectorize::<Rule<K>, _>(
                #[cfg_attr(optimized, inline(always))]
                || {
                    let (rays, media) = (inputs.ray_groups::<I>(), block.media.groups(isa));
                    let mut medium = media.media(isa, 0);
                    let geometries = block.geometries();
                    let out = &mut I::groups_mut(out)[block.groups.clone()];
                    for (record, out) in out.iter_mut().enumerate() {
                        let (group, geometry) = (block.groups.start + record, geometries.get(record));
                        media.renew(isa, record, &mut medium);
                        let (valid, lit) = (geometry.lit.valid & medium.valid, geometry.lit(isa));
                        let radiance = Rule::<K>::radiance(isa, &rays.lanes(isa, group), geometry, &medium);
                        isa.store(I::V::only(valid & lit, radiance.min(isa.splat(f32::MAX))), out);
                        tally.add(valid, valid & lit, none(isa));
                    }
                },
            );
        });
        tally.counts(isa, inputs)
    }
}
