//! The limits of the speed of a kernel: the operations it needs, and the rate at which a core executes them.

use crate::batch::{Emitters, Inputs, Media, OfSamples, Outputs, Rays, Samples};
use crate::road::{self, Task};
use crate::simd::counting::Counting;
use crate::simd::{Backend, Isa, Kernel, Lanes, Machine, Number};
use crate::{Error, Sampler};
use core::hint::black_box;
use core::ops::Add;

/// The arithmetic operations of one lane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Fused multiplications and additions; one in f64 counts as two.
    pub multiply_adds: usize,
    /// Single additions and multiplications.
    pub additions: usize,
    /// Divisions and square roots.
    pub divisions: usize,
}

impl Add for Operations {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self {
            multiply_adds: self.multiply_adds + o.multiply_adds,
            additions: self.additions + o.additions,
            divisions: self.divisions + o.divisions,
        }
    }
}

impl Sampler {
    /// The operations of [`sample`](Self::sample) for the whole batch, lane by lane; a group does more where a lane waits for
    /// others. Comparisons, selections and integer operations are not counted, nor are operations that no result depends on.
    ///
    /// # Errors
    /// As [`sample`](Self::sample).
    #[doc(hidden)]
    pub fn operations(
        &self,
        rays: &Rays<'_>,
        emitters: &Emitters<'_>,
        media: &Media<'_>,
        u: &[f32],
        samples: &mut Samples<'_>,
    ) -> Result<Operations, Error> {
        let inputs = Inputs::new(rays, emitters, media)?.with(u, "u")?;
        inputs.check_given("samples.t", samples.t)?;
        inputs.check_given("samples.pdf", samples.pdf)?;
        let mut needed = Operations::default();
        let mut rest = Samples::new(samples.t, samples.pdf);
        for start in (0..inputs.len()).step_by(AT_ONCE) {
            let few = inputs.slice(start..inputs.len().min(start + AT_ONCE));
            let (out, beyond) = OfSamples::split_at(rest, few.len() * few.per_ray);
            rest = beyond;
            needed = needed + Counting::count(|counting| road::Sample::run(counting, self.method(), &few, out));
        }
        Ok(needed)
    }
}

/// The number of rays whose operations are recorded before they are counted.
const AT_ONCE: usize = 256;

/// An execution unit that may limit a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// `x m + a`.
    MultiplyAdd,
    /// `1 / x`.
    Division,
}

impl Backend {
    /// Executes `steps` operations on each of `chains` (4, 8 or 12) independent lane groups; returns the number of operations of
    /// single lanes.
    #[doc(hidden)]
    pub fn strain(self, limit: Limit, chains: usize, steps: usize) -> usize {
        match chains {
            4 => self.run(Chains::<4> { limit, steps }),
            8 => self.run(Chains::<8> { limit, steps }),
            _ => self.run(Chains::<12> { limit, steps }),
        }
    }
}

/// Independent chains of one operation: enough of them hide its latency, too many do not fit the registers.
struct Chains<const N: usize> {
    limit: Limit,
    steps: usize,
}

impl<const N: usize> Kernel for Chains<N> {
    type Output = usize;

    fn run<I: Isa>(self, isa: I) -> usize {
        isa.vectorize::<Self, _>(
            #[cfg_attr(optimized, inline(always))]
            || self.chains(isa),
        )
    }
}

impl<const N: usize> Chains<N> {
    #[cfg_attr(optimized, inline(always))]
    fn chains<I: Isa>(&self, isa: I) -> usize {
        let (m, a, one) = (isa.splat(black_box(0.5)), isa.splat(black_box(0.75)), isa.splat(black_box(1.0)));
        let mut x = [isa.splat(black_box(1.25)); N];
        match self.limit {
            Limit::MultiplyAdd => {
                for _ in 0..self.steps {
                    for x in &mut x {
                        *x = x.mul_add(m, a);
                    }
                }
            }
            Limit::Division => {
                for _ in 0..self.steps {
                    for x in &mut x {
                        *x = one / *x;
                    }
                }
            }
        }
        for x in x {
            black_box(I::V::bits(x.lt(one)));
        }
        N * self.steps * I::V::N
    }
}
