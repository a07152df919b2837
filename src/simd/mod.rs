//! Lane groups: the vector operations that the kernels need, for each instruction set.
//!
//! A kernel is written once, generic over [`Isa`]; an instruction set is a thin binding of [`Lanes`] and [`Double`].
//!
//! Unit tests run no kernel of x86-64: they are built without these, which take most of the build time.

#[cfg(feature = "measure")]
pub(crate) mod counting;
pub(crate) mod math;
mod pair;
mod portable;
mod records;
#[cfg(feature = "measure")]
mod scalar;
#[cfg(all(target_arch = "x86_64", not(test)))]
mod two;
#[cfg(all(target_arch = "x86_64", not(test)))]
mod x86;

pub(crate) use portable::Portable;
pub(crate) use records::{GROUPS, Records, Room};

use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// The largest number of lanes of a lane group.
pub(crate) const MOST_LANES: usize = 32;

/// A group of lanes that can be added and multiplied.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// `self * m + a`; one rounding where the set has FMA, else two.
    fn mul_add(self, m: Self, a: Self) -> Self;
}

/// A group of `f32` lanes, one ray each.
///
/// Optimised builds inline every method, so that it has the target features of its caller. No method moves a value from one lane
/// to another: the result of a lane depends on that lane alone.
pub(crate) trait Lanes: Number + Div<Output = Self> {
    /// One truth value per lane.
    type Mask: Copy + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask> + Not<Output = Self::Mask>;
    /// The same number of lanes in double precision.
    type Double: Double;
    /// The number of lanes.
    const N: usize;

    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    /// The smaller one; either or NaN where a lane is NaN.
    fn min(self, o: Self) -> Self;
    /// The larger one; either or NaN where a lane is NaN.
    fn max(self, o: Self) -> Self;
    /// `lt`, `le` and `eq` are false where a lane is NaN.
    fn lt(self, o: Self) -> Self::Mask;
    fn le(self, o: Self) -> Self::Mask;
    fn eq(self, o: Self) -> Self::Mask;
    fn select(m: Self::Mask, yes: Self, no: Self) -> Self;
    /// `x` where the mask holds, else 0.
    fn only(m: Self::Mask, x: Self) -> Self;
    /// Bit `i` is the truth of lane `i`.
    fn bits(m: Self::Mask) -> u32;
    /// `2^self` for integral values in `[-126, 127]`; anything for others in `[-2^22, 2^22]`.
    fn pow2(self) -> Self;
    /// `(m, e)` with `self = m 2^e` and `m` in `[sqrt(1/2), sqrt(2))`, for positive normal values.
    fn split(self) -> (Self, Self);
    fn widen(self) -> Self::Double;
    /// Rounded to nearest.
    fn narrow(d: Self::Double) -> Self;

    /// The coefficients of the product of two polynomials, from degree 0 on; `R = P + Q - 1`.
    ///
    /// `P` sums are open at a time, so that `p` should be the shorter polynomial: all sums at once do not fit the registers.
    #[cfg_attr(optimized, inline(always))]
    fn multiply<const P: usize, const Q: usize, const R: usize>(p: &[Self; P], q: &[Self; Q]) -> [Self; R] {
        const { assert!(R + 1 == P + Q) };
        let mut open = *p;
        let mut product = [p[0]; R];
        let mut k = 0;
        while k < Q {
            let mut i = 0;
            while i < P {
                // The open sum of degree k + i; that of the highest degree is new.
                open[i] = if k == 0 || i == P - 1 { p[i] * q[k] } else { p[i].mul_add(q[k], open[i + 1]) };
                i += 1;
            }
            product[k] = open[0];
            k += 1;
        }
        let mut i = 1;
        while i < P {
            product[Q - 1 + i] = open[i];
            i += 1;
        }
        product
    }
}

/// The f64 companion of a lane group.
pub(crate) trait Double: Number {
    fn min(self, o: Self) -> Self;
    fn max(self, o: Self) -> Self;
}

/// A zero-sized proof that this CPU has an instruction set; it makes values of it.
pub(crate) trait Isa: Copy {
    type V: Lanes<Mask = Self::Mask, Double = Self::Double>;
    type Mask: Copy + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask> + Not<Output = Self::Mask>;
    type Double: Double;
    /// An array of as many values as there are lanes.
    type Group: Copy;
    /// Whether `mul_add` rounds once.
    const FUSED: bool;

    fn splat(self, x: f32) -> Self::V;
    fn splat_double(self, x: f64) -> Self::Double;
    /// A column cut into groups, without the rest that does not fill a group.
    fn groups(column: &[f32]) -> &[Self::Group];
    fn groups_mut(column: &mut [f32]) -> &mut [Self::Group];
    fn load(self, group: &Self::Group) -> Self::V;
    fn store(self, lanes: Self::V, group: &mut Self::Group);
    /// Prefetches the group `_ahead` groups after this one; does nothing without such an instruction.
    fn prefetch(self, _: &Self::Group, _ahead: usize) {}

    /// Runs `work` with the instructions of this set. Optimised builds inline the work and all that it calls. Its machine code
    /// belongs to the module of `Home`: compilers make one unit of a module, and compile several units at a time.
    fn vectorize<Home, R>(self, work: impl FnOnce() -> R) -> R;
}

/// The mask with no lane set.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn none<I: Isa>(isa: I) -> I::Mask {
    // Compilers recognise this form as a constant.
    let mask = isa.splat(1.0).lt(isa.splat(0.0));
    mask & !mask
}

/// Code that is written once and run by one of several instruction sets.
pub(crate) trait Kernel {
    type Output;
    /// Work on lanes goes through [`Isa::vectorize`].
    fn run<I: Isa>(self, isa: I) -> Self::Output;
}

/// A runner of kernels.
pub(crate) trait Machine: Copy {
    /// The number of lanes of a group.
    fn lanes(self) -> usize;
    fn run<K: Kernel>(self, kernel: K) -> K::Output;
}

/// An instruction set that this CPU has. Only [`available`](Self::available) and [`detect`](Self::detect) make one.
///
/// All backends that are [fused](Self::is_fused) give equal bits. On x86-64 one backend is not: `portable`, in a build that does
/// not enable FMA. Its bits differ; its errors are within the stated bounds.
#[derive(Clone, Copy, Debug)]
pub struct Backend(Kind);

#[derive(Clone, Copy, Debug)]
enum Kind {
    #[cfg(all(target_arch = "x86_64", not(test)))]
    Avx512(x86::Avx512),
    #[cfg(all(target_arch = "x86_64", not(test)))]
    Avx2(x86::Avx2),
    Portable,
    #[cfg(feature = "measure")]
    Scalar,
}

impl Backend {
    /// Every backend that this CPU can run, the fastest first.
    ///
    /// With the feature `measure`, `scalar` comes last: one lane, for comparison.
    pub fn available() -> impl Iterator<Item = Self> {
        [
            #[cfg(all(target_arch = "x86_64", not(test)))]
            x86::Avx512::detect().map(Kind::Avx512),
            #[cfg(all(target_arch = "x86_64", not(test)))]
            x86::Avx2::detect().map(Kind::Avx2),
            Some(Kind::Portable),
            #[cfg(feature = "measure")]
            Some(Kind::Scalar),
        ]
        .into_iter()
        .flatten()
        .map(Self)
    }

    /// The fastest backend that this CPU can run.
    #[must_use]
    pub fn detect() -> Self {
        Self::available().next().unwrap_or(Self(Kind::Portable))
    }

    /// The name on the command line and in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self.0 {
            #[cfg(all(target_arch = "x86_64", not(test)))]
            Kind::Avx512(_) => "avx512",
            #[cfg(all(target_arch = "x86_64", not(test)))]
            Kind::Avx2(_) => "avx2",
            Kind::Portable => "portable",
            #[cfg(feature = "measure")]
            Kind::Scalar => "scalar",
        }
    }

    /// Whether the backend has fused multiply-add. All backends that have it, on x86-64 and AArch64, give equal bits.
    #[must_use]
    pub fn is_fused(self) -> bool {
        match self.0 {
            Kind::Portable => Portable::FUSED,
            #[cfg(any(all(target_arch = "x86_64", not(test)), feature = "measure"))]
            _ => true,
        }
    }
}

impl Machine for Backend {
    fn lanes(self) -> usize {
        fn of<I: Isa>(_: I) -> usize {
            I::V::N
        }
        match self.0 {
            #[cfg(all(target_arch = "x86_64", not(test)))]
            Kind::Avx512(proof) => of(two::Two(proof)),
            #[cfg(all(target_arch = "x86_64", not(test)))]
            Kind::Avx2(proof) => of(two::Two(proof)),
            Kind::Portable => of(Portable),
            #[cfg(feature = "measure")]
            Kind::Scalar => of(scalar::Scalar),
        }
    }

    fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self.0 {
            #[cfg(all(target_arch = "x86_64", not(test)))]
            Kind::Avx512(proof) => kernel.run(two::Two(proof)),
            #[cfg(all(target_arch = "x86_64", not(test)))]
            Kind::Avx2(proof) => kernel.run(two::Two(proof)),
            Kind::Portable => kernel.run(Portable),
            #[cfg(feature = "measure")]
            Kind::Scalar => kernel.run(scalar::Scalar),
        }
    }
}
