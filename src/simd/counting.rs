//! One lane that counts its arithmetic.

use super::{Double, Isa, Lanes, Number};
use crate::limits::Operations;
use core::cell::Cell;
use core::ops::{Add, Div, Mul, Neg, Sub};

thread_local! {
    static COUNT: Cell<Operations> = const { Cell::new(NONE) };
}

const NONE: Operations = Operations { multiply_adds: 0, additions: 0, divisions: 0 };

fn count(operations: Operations) {
    COUNT.set(COUNT.get() + operations);
}

/// Needs no CPU check, and is slow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counting(());

impl Counting {
    /// What `work` needs, all of it on this thread.
    pub(crate) fn count<R>(work: impl FnOnce(Self) -> R) -> Operations {
        COUNT.set(NONE);
        work(Self(()));
        COUNT.get()
    }
}

/// A number of one lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counted<T>(T);

/// How many places it takes in a register.
trait Size {
    const SIZE: usize;
}

impl Size for f32 {
    const SIZE: usize = 1;
}

impl Size for f64 {
    const SIZE: usize = 2;
}

macro_rules! operators {
    ($($Op:ident $op:ident $kind:ident),*) => {$(
        impl<T: Size + $Op<Output = T>> $Op for Counted<T> {
            type Output = Self;
            fn $op(self, o: Self) -> Self {
                count(Operations { $kind: T::SIZE, ..NONE });
                Self(self.0.$op(o.0))
            }
        }
    )*};
}
operators!(Add add additions, Sub sub additions, Mul mul additions, Div div divisions);

impl<T: Neg<Output = T>> Neg for Counted<T> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<T: Size + Number> Number for Counted<T> {
    fn mul_add(self, m: Self, a: Self) -> Self {
        count(Operations { multiply_adds: T::SIZE, ..NONE });
        Self(self.0.mul_add(m.0, a.0))
    }
}

impl Isa for Counting {
    type V = Counted<f32>;
    type Mask = bool;
    type Double = Counted<f64>;
    type Group = f32;

    fn splat(self, x: f32) -> Counted<f32> {
        Counted(x)
    }
    fn splat_double(self, x: f64) -> Counted<f64> {
        Counted(x)
    }
    fn groups(column: &[f32]) -> &[f32] {
        column
    }
    fn groups_mut(column: &mut [f32]) -> &mut [f32] {
        column
    }
    fn load(self, group: &f32) -> Counted<f32> {
        Counted(*group)
    }
    fn store(self, lanes: Counted<f32>, group: &mut f32) {
        *group = lanes.0;
    }
}

impl Lanes for Counted<f32> {
    type Mask = bool;
    type Double = Counted<f64>;
    const N: usize = 1;

    fn sqrt(self) -> Self {
        count(Operations { divisions: 1, ..NONE });
        Self(Lanes::sqrt(self.0))
    }
    fn abs(self) -> Self {
        Self(Lanes::abs(self.0))
    }
    fn min(self, o: Self) -> Self {
        Self(Lanes::min(self.0, o.0))
    }
    fn max(self, o: Self) -> Self {
        Self(Lanes::max(self.0, o.0))
    }
    fn lt(self, o: Self) -> bool {
        self.0 < o.0
    }
    fn le(self, o: Self) -> bool {
        self.0 <= o.0
    }
    fn eq(self, o: Self) -> bool {
        self.0 == o.0
    }
    fn select(m: bool, yes: Self, no: Self) -> Self {
        if m { yes } else { no }
    }
    fn bits(m: bool) -> u32 {
        m.into()
    }
    fn pow2(self) -> Self {
        Self(self.0.pow2())
    }
    fn split(self) -> (Self, Self) {
        let (m, e) = self.0.split();
        (Self(m), Self(e))
    }
    fn widen(self) -> Counted<f64> {
        Counted(self.0.widen())
    }
    fn narrow(d: Counted<f64>) -> Self {
        Self(f32::narrow(d.0))
    }
}

impl Double for Counted<f64> {
    fn min(self, o: Self) -> Self {
        Self(Double::min(self.0, o.0))
    }
    fn max(self, o: Self) -> Self {
        Self(Double::max(self.0, o.0))
    }
}
