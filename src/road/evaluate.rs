//! The integrand at given distances, which is the same for all densities.

use super::blocks::{Block, Wanted, for_each_block, for_each_run};
use super::tally::Tally;
use super::{Method, Out, Task};
use crate::Precision;
use crate::batch::{Columns, Counts, Inputs, OfRuns, Turn};
use crate::geometry::Extent;
use crate::integrand::{Factors, MediumLanes};
use crate::scene::MOST_CHANNELS;
use crate::simd::{GROUPS, Isa, Kernel, Lanes, Machine, none};

pub(crate) struct Evaluate;

impl Task for Evaluate {
    type Method = Method;
    type Out = Columns<MOST_CHANNELS>;

    fn run(machine: impl Machine, method: Method, inputs: &Inputs<'_>, out: Out<'_, Self>) -> Counts {
        machine.run(OnGroups { precision: method.precision, inputs, out })
    }
}

/// The kernel.
struct OnGroups<'a> {
    precision: Precision,
    inputs: &'a Inputs<'a>,
    out: Out<'a, Evaluate>,
}

impl Kernel for OnGroups<'_> {
    type Output = Counts;

    fn run<I: Isa>(self, isa: I) -> Counts {
        let Self { precision, inputs, mut out } = self;
        let (mut tally, mut pad) = (Tally::new::<I>(inputs), None);
        for_each_block(isa, inputs, Wanted { precision, extent: Extent::Path, records: GROUPS }, |block| {
            for_each_run(block, |run| {
                let t = run.values(inputs.given, &mut pad);
                Columns::of_run(&mut out, run, |out| integrands(isa, block, run.turns, t, out, &mut tally));
            });
        });
        tally.counts::<I>(inputs)
    }
}

/// Computes the integrands of some turns at the distances `t`, for every channel.
fn integrands<I: Isa>(
    isa: I,
    block: &Block<'_, I>,
    turns: &[Turn],
    t: &[f32],
    mut out: Out<'_, Evaluate>,
    tally: &mut Tally,
) {
    isa.vectorize::<MediumLanes<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let (rays, geometries) = (block.inputs.ray_groups::<I>(), block.geometries());
            let columns = out.iter().flatten().count();
            for (column, out) in out.iter_mut().flatten().enumerate() {
                let media = block.media.of_output(column, columns).groups(isa);
                let mut medium = media.media(isa, 0);
                for ((turn, t), out) in turns.iter().zip(I::groups(t)).zip(I::groups_mut(out)) {
                    let group = block.groups.start + turn.record;
                    media.renew(isa, turn.record, &mut medium);
                    let (ray, geometry) = (rays.lanes(isa, group), geometries.get(turn.record));
                    let t = isa.load(t);
                    let (valid, faced) = (geometry.valid & medium.valid & t.eq(t), geometry.faced(isa));
                    let inside = valid & faced & ray.t_min.le(t) & t.le(ray.end(isa));
                    let point = geometry.point_at_distance(isa, t);
                    let factors = Factors::new::<true>(isa, &ray, geometry, &medium, &point);
                    let (mut f, imprecise) = factors.over(isa, point.r * point.r);
                    let hard = imprecise & inside;
                    if I::V::bits(hard) != 0 {
                        let one = isa.splat(1.0);
                        f = I::V::select(hard, factors.in_f64(one / point.r, one), f);
                    }
                    isa.store(I::V::only(inside, f.min(isa.splat(f32::MAX))), out);
                    if column == 0 {
                        tally.add::<I>(valid, valid & faced, none(isa));
                    }
                }
            }
        },
    );
}
