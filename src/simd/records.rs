//! The records that a pass over a block of lane groups leaves to the next pass: one for each group, on the stack.

use core::mem::MaybeUninit;

/// The largest number of lane groups of a block. Unoptimised builds keep every temporary in a place of its own: large blocks
/// would overflow the stack.
pub(crate) const GROUPS: usize = if cfg!(optimized) { 16 } else { 2 };

/// Storage for the records of a block of at most `N` groups. It is not initialised: writing zeros would cost a small batch more
/// than its samples.
pub(crate) struct Records<T, const N: usize = GROUPS> {
    places: [MaybeUninit<T>; N],
    /// The number of records written.
    count: usize,
}

/// Storage for records, of any capacity.
pub(crate) trait Room<T> {
    /// The capacity.
    const SIZE: usize;

    fn new() -> Self;

    /// Writes the first `count` records with `make`, in order.
    fn fill(&mut self, count: usize, make: impl FnMut(usize) -> T) -> &mut [T];
}

impl<T: Copy, const N: usize> Room<T> for Records<T, N> {
    const SIZE: usize = N;

    #[cfg_attr(optimized, inline(always))]
    fn new() -> Self {
        Self { places: [const { MaybeUninit::uninit() }; N], count: 0 }
    }

    #[cfg_attr(optimized, inline(always))]
    fn fill(&mut self, count: usize, mut make: impl FnMut(usize) -> T) -> &mut [T] {
        let mut records = self.start();
        for index in 0..count {
            records.push(make(index));
        }
        records.done();
        self.written()
    }
}

impl<T: Copy, const N: usize> Records<T, N> {
    /// Starts with no records.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn start(&mut self) -> Started<'_, T> {
        Started { places: &mut self.places, count: 0, written: &mut self.count }
    }

    /// The records written last.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn written(&mut self) -> &mut [T] {
        let records = &mut self.places[..self.count];
        // SAFETY: `Started` has written each of them, and `MaybeUninit<T>` lies in memory as `T` does.
        unsafe { &mut *(core::ptr::from_mut(records) as *mut [T]) }
    }
}

/// Records being written.
pub(crate) struct Started<'r, T> {
    places: &'r mut [MaybeUninit<T>],
    count: usize,
    written: &'r mut usize,
}

impl<T: Copy> Started<'_, T> {
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn push(&mut self, record: T) {
        self.places[self.count].write(record);
        self.count += 1;
    }

    /// Ends the writing.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn done(self) {
        *self.written = self.count;
    }
}
