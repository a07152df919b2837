//! The integral of the integrand along each ray.

use super::blocks::{Block, Wanted, for_each_block};
use super::tally::Tally;
use super::{Out, Task};
use crate::batch::{Columns, Counts, Inputs, MediumGroups, MediumRows};
use crate::geometry::Extent;
use crate::integral::rule::{Rule, Variable};
use crate::scene::MOST_CHANNELS;
use crate::simd::{GROUPS, Isa, Kernel, Lanes, Machine, Records, Room, none};
use crate::{Nodes, Precision};

/// The number of nodes, and the precision.
#[derive(Clone, Copy)]
pub(crate) struct Quadrature {
    pub(crate) nodes: Nodes,
    pub(crate) precision: Precision,
}

pub(crate) struct Radiance;

impl Task for Radiance {
    type Method = Quadrature;
    type Out = Columns<MOST_CHANNELS>;

    fn run(machine: impl Machine, method: Quadrature, inputs: &Inputs<'_>, out: Out<'_, Self>) -> Counts {
        let Quadrature { nodes, precision } = method;
        match nodes {
            Nodes::Four => machine.run(OnGroups::<4> { precision, inputs, out }),
            Nodes::Six => machine.run(OnGroups::<6> { precision, inputs, out }),
            Nodes::Eight => machine.run(OnGroups::<8> { precision, inputs, out }),
            Nodes::Twelve => machine.run(OnGroups::<12> { precision, inputs, out }),
        }
    }
}

/// The kernel for a number of nodes.
struct OnGroups<'a, const K: usize> {
    precision: Precision,
    inputs: &'a Inputs<'a>,
    out: Out<'a, Radiance>,
}

impl<const K: usize> Kernel for OnGroups<'_, K> {
    type Output = Counts;

    fn run<I: Isa>(self, isa: I) -> Counts {
        let Self { precision, inputs, mut out } = self;
        let mut tally = Tally::new::<I>(inputs);
        for_each_block(isa, inputs, of_integral(precision), |block| {
            isa.vectorize::<Rule<K>, _>(
                #[cfg_attr(optimized, inline(always))]
                || {
                    let columns = out.iter().flatten().count();
                    for (column, out) in out.iter_mut().flatten().enumerate() {
                        let out = &mut I::groups_mut(out)[block.groups.clone()];
                        for_each_radiance::<I, K>(
                            isa,
                            block,
                            block.media.of_output(column, columns),
                            #[cfg_attr(optimized, inline(always))]
                            |record, Integrated { radiance, valid, lit }| {
                                isa.store(radiance, &mut out[record]);
                                if column == 0 {
                                    tally.add::<I>(valid, lit, none(isa));
                                }
                            },
                        );
                    }
                },
            );
        });
        tally.counts::<I>(inputs)
    }
}

/// What an integral needs of the geometry.
pub(super) fn of_integral(precision: Precision) -> Wanted {
    Wanted { precision, extent: Extent::Path, records: GROUPS }
}

/// The integrals of a lane group.
pub(super) struct Integrated<I: Isa> {
    /// \[1/m^2\]; 0 in lanes that are not lit.
    pub(super) radiance: I::V,
    pub(super) valid: I::Mask,
    /// Which valid lanes are lit.
    pub(super) lit: I::Mask,
}

/// Calls `visit` with the integrals of each lane group of a block in some media: a pass for the variable, one for the
/// transmittance at its start, and one for the nodes.
#[cfg_attr(optimized, inline(always))]
pub(super) fn for_each_radiance<I: Isa, const K: usize>(
    isa: I,
    block: &Block<'_, I>,
    media: MediumRows<'_>,
    mut visit: impl FnMut(usize, Integrated<I>),
) {
    let media = media.groups(isa);
    let geometries = block.geometries();
    let mut medium = media.media(isa, 0);
    let (mut variables, mut starts) = (Records::<Variable<I>>::new(), Records::<I::V>::new());
    let variables = variables.fill(
        block.groups.len(),
        #[cfg_attr(optimized, inline(always))]
        |record| {
            media.renew(isa, record, &mut medium);
            Rule::<K>::variable(isa, geometries.get(record), &medium)
        },
    );
    let starts = if block.precision.is_exact::<I>() {
        fill_starts::<I, true>(isa, block, &media, variables, &mut starts)
    } else {
        fill_starts::<I, false>(isa, block, &media, variables, &mut starts)
    };
    for (record, (variable, start)) in variables.iter().zip(starts).enumerate() {
        let geometry = geometries.get(record);
        media.renew(isa, record, &mut medium);
        let valid = geometry.valid & medium.valid;
        let lit = valid & geometry.lit(isa);
        let radiance = Rule::<K>::radiance(isa, geometry, &medium, variable, *start);
        visit(record, Integrated { radiance: I::V::only(lit, radiance), valid, lit });
    }
}

/// The transmittances at the start of the lit parts.
#[cfg_attr(optimized, inline(always))]
fn fill_starts<'r, I: Isa, const EXACT: bool>(
    isa: I,
    block: &Block<'_, I>,
    media: &MediumGroups<'_, I>,
    variables: &[Variable<I>],
    starts: &'r mut Records<I::V>,
) -> &'r [I::V] {
    let (rays, geometries) = (block.inputs.ray_groups::<I>(), block.geometries());
    let mut medium = media.media(isa, 0);
    starts.fill(
        variables.len(),
        #[cfg_attr(optimized, inline(always))]
        |record| {
            media.renew(isa, record, &mut medium);
            let ray = rays.lanes(isa, block.groups.start + record);
            variables[record].start::<EXACT>(isa, &ray, geometries.get(record), &medium)
        },
    )
}
