//! One lane that records its arithmetic, and counts the operations that a result or a branch depends on.
//!
//! Other operations are not counted, as the compiler removes them.

use super::{Double, Isa, Kernel, Lanes, Machine, Number};
use crate::limits::Operations;
use core::cell::RefCell;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

thread_local! {
    static TAPE: RefCell<Tape> = const { RefCell::new(Tape { steps: Vec::new(), wanted: Vec::new() }) };
}

const NONE: Operations = Operations { multiply_adds: 0, additions: 0, divisions: 0 };

/// The step on the tape that made a value: 1 for the first step, 0 for a constant.
type Place = usize;

/// The recorded steps.
struct Tape {
    steps: Vec<Step>,
    /// Values that were written to memory or decided a branch.
    wanted: Vec<Place>,
}

/// One operation, and the places of its operands.
struct Step {
    operations: Operations,
    operands: [Place; 3],
}

/// Records a step; an operation on constants is a constant.
// Not inlined: kernels are inlined as a whole, and compilers cannot handle this in all of their places.
#[inline(never)]
fn step(operations: Operations, operands: [Place; 3]) -> Place {
    if operands == [0; 3] {
        return 0;
    }
    TAPE.with_borrow_mut(|tape| {
        tape.steps.push(Step { operations, operands });
        tape.steps.len()
    })
}

/// Records a value that comes from memory.
#[inline(never)]
fn given() -> Place {
    TAPE.with_borrow_mut(|tape| {
        tape.steps.push(Step::SEEN);
        tape.steps.len()
    })
}

#[inline(never)]
fn want(place: Place) {
    TAPE.with_borrow_mut(|tape| tape.wanted.push(place));
}

impl Tape {
    /// The operations that wanted values depend on.
    fn needed(&mut self) -> Operations {
        let mut sum = NONE;
        while let Some(place) = self.wanted.pop() {
            let Some(index) = place.checked_sub(1) else { continue };
            // A step that was counted has no operands and no operations left.
            let Step { operations, operands } = std::mem::replace(&mut self.steps[index], Step::SEEN);
            sum = sum + operations;
            self.wanted.extend(operands);
        }
        self.steps.clear();
        sum
    }
}

impl Step {
    const SEEN: Self = Self { operations: NONE, operands: [0; 3] };
}

/// Needs no CPU check, and is slow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counting(());

impl Counting {
    /// The operations of `work`, which must run on this thread.
    pub(crate) fn count<R>(work: impl FnOnce(Self) -> R) -> Operations {
        work(Self(()));
        TAPE.with_borrow_mut(Tape::needed)
    }
}

impl Machine for Counting {
    fn lanes(self) -> usize {
        <Self as Isa>::V::N
    }

    fn run<K: Kernel>(self, kernel: K) -> K::Output {
        kernel.run(self)
    }
}

/// A number of one lane, and its step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counted<T>(T, Place);

/// The mask of one lane, and its step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Truth(bool, Place);

/// The number of f32 places that a value takes in a register.
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
                Self(self.0.$op(o.0), step(Operations { $kind: T::SIZE, ..NONE }, [self.1, o.1, 0]))
            }
        }
    )*};
}
operators!(Add add additions, Sub sub additions, Mul mul additions, Div div divisions);

macro_rules! truths {
    ($($Op:ident $op:ident),*) => {$(
        impl $Op for Truth {
            type Output = Self;
            fn $op(self, o: Self) -> Self {
                Self(self.0.$op(o.0), step(NONE, [self.1, o.1, 0]))
            }
        }
    )*};
}
truths!(BitAnd bitand, BitOr bitor);

impl Not for Truth {
    type Output = Self;
    fn not(self) -> Self {
        Self(!self.0, self.1)
    }
}

impl<T: Neg<Output = T>> Neg for Counted<T> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0, self.1)
    }
}

impl<T: Size + Number> Number for Counted<T> {
    fn mul_add(self, m: Self, a: Self) -> Self {
        let operations = Operations { multiply_adds: T::SIZE, ..NONE };
        Self(self.0.mul_add(m.0, a.0), step(operations, [self.1, m.1, a.1]))
    }
}

impl Isa for Counting {
    type V = Counted<f32>;
    type Mask = Truth;
    type Double = Counted<f64>;
    type Group = f32;
    const FUSED: bool = true;

    fn splat(self, x: f32) -> Counted<f32> {
        Counted(x, 0)
    }
    fn splat_double(self, x: f64) -> Counted<f64> {
        Counted(x, 0)
    }
    fn groups(column: &[f32]) -> &[f32] {
        column
    }
    fn groups_mut(column: &mut [f32]) -> &mut [f32] {
        column
    }
    fn load(self, group: &f32) -> Counted<f32> {
        Counted(*group, given())
    }
    fn store(self, lanes: Counted<f32>, group: &mut f32) {
        want(lanes.1);
        *group = lanes.0;
    }
    fn vectorize<Home, R>(self, work: impl FnOnce() -> R) -> R {
        work()
    }
}

impl Lanes for Counted<f32> {
    type Mask = Truth;
    type Double = Counted<f64>;
    const N: usize = 1;

    fn sqrt(self) -> Self {
        Self(Lanes::sqrt(self.0), step(Operations { divisions: 1, ..NONE }, [self.1, 0, 0]))
    }
    fn abs(self) -> Self {
        Self(Lanes::abs(self.0), self.1)
    }
    fn min(self, o: Self) -> Self {
        Self(Lanes::min(self.0, o.0), step(NONE, [self.1, o.1, 0]))
    }
    fn max(self, o: Self) -> Self {
        Self(Lanes::max(self.0, o.0), step(NONE, [self.1, o.1, 0]))
    }
    fn lt(self, o: Self) -> Truth {
        Truth(self.0 < o.0, step(NONE, [self.1, o.1, 0]))
    }
    fn le(self, o: Self) -> Truth {
        Truth(self.0 <= o.0, step(NONE, [self.1, o.1, 0]))
    }
    fn eq(self, o: Self) -> Truth {
        Truth(self.0 == o.0, step(NONE, [self.1, o.1, 0]))
    }
    // Both are computed, whichever is taken.
    fn select(m: Truth, yes: Self, no: Self) -> Self {
        Self(if m.0 { yes.0 } else { no.0 }, step(NONE, [m.1, yes.1, no.1]))
    }
    fn only(m: Truth, x: Self) -> Self {
        Self(if m.0 { x.0 } else { 0.0 }, step(NONE, [m.1, x.1, 0]))
    }
    fn bits(m: Truth) -> u32 {
        want(m.1);
        m.0.into()
    }
    fn pow2(self) -> Self {
        Self(self.0.pow2(), self.1)
    }
    fn split(self) -> (Self, Self) {
        let (m, e) = self.0.split();
        (Self(m, self.1), Self(e, self.1))
    }
    fn widen(self) -> Counted<f64> {
        Counted(self.0.widen(), self.1)
    }
    fn narrow(d: Counted<f64>) -> Self {
        Self(f32::narrow(d.0), d.1)
    }
}

impl Double for Counted<f64> {
    fn min(self, o: Self) -> Self {
        Self(Double::min(self.0, o.0), step(NONE, [self.1, o.1, 0]))
    }
    fn max(self, o: Self) -> Self {
        Self(Double::max(self.0, o.0), step(NONE, [self.1, o.1, 0]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_nothing_depends_on_does_not_count() {
        let needed = Counting::count(|isa| {
            let (x, y) = (isa.load(&2.0), isa.load(&3.0));
            let idle = x / y;
            let (sum, product) = (x + y, x.widen() * y.widen());
            let constant = isa.splat(2.0) / isa.splat(3.0);
            // A selection needs both, and the comparison what it compares.
            let taken = Counted::select(sum.lt(y.sqrt()), idle * constant, Counted::narrow(product));
            let _ = taken / y;
            isa.store(x.mul_add(y, constant), &mut 0.0);
            Counted::bits(taken.eq(x));
        });
        assert_eq!(needed, Operations { multiply_adds: 1, additions: 4, divisions: 2 });
        assert_eq!(Counting::count(|_| ()), NONE);
    }
}
