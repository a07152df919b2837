//! Where a column lies in memory.

use crate::abi::airlight_status;
use crate::status::{Failure, Result};
use std::fmt;

/// What a column is called in a message: a field of a struct, or an element of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Name(pub(crate) &'static str, pub(crate) Option<usize>);

impl From<&'static str> for Name {
    fn from(field: &'static str) -> Self {
        Self(field, None)
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self(field, None) => f.write_str(field),
            Self(field, Some(index)) => write!(f, "{field}[{index}]"),
        }
    }
}

/// The bytes of a column: `count` elements of `element` bytes, one every `stride` bytes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub(crate) name: Name,
    first: usize,
    pub(crate) stride: usize,
    element: usize,
    count: usize,
}

impl Span {
    /// Elements of `width` numbers of `size` bytes from the address `first` on; stride 0: next to each other.
    pub(crate) fn new(name: Name, first: usize, stride: usize, [count, width, size]: [usize; 3]) -> Result<Self> {
        let too_long =
            || Failure::new(airlight_status::Length, format!("{name} has too many elements for memory: {count}"));
        let element = width.checked_mul(size).ok_or_else(too_long)?;
        if stride != 0 && stride < element {
            let message = format!("{name}.stride is {stride}, expected 0 or at least {element}");
            return Err(Failure::new(airlight_status::Stride, message));
        }
        let span = Self { name, first, stride: stride.max(element), element, count };
        let fits =
            span.length().is_some_and(|length| length <= isize::MAX as usize && first.checked_add(length).is_some());
        if fits { Ok(span) } else { Err(too_long()) }
    }

    /// Bytes from the first one to after the last one.
    fn length(&self) -> Option<usize> {
        match self.count {
            0 => Some(0),
            count => self.stride.checked_mul(count - 1)?.checked_add(self.element),
        }
    }

    /// Whether its numbers lie next to each other, so aligned that they are a slice.
    pub(crate) fn is_slice(&self, alignment: usize) -> bool {
        self.stride == self.element && self.first.is_multiple_of(alignment)
    }

    /// Whether a byte may belong to both. Elements of columns with one stride, as in a queue of structs, are told apart.
    pub(crate) fn may_overlap(&self, other: &Self) -> bool {
        let end = |span: &Self| span.first + span.length().unwrap_or(0);
        if self.first >= end(other) || other.first >= end(self) {
            return false;
        }
        let [low, high] = if self.first < other.first { [self, other] } else { [other, self] };
        let offset = (high.first - low.first) % low.stride;
        low.stride != high.stride || offset < low.element || offset + high.element > low.stride
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A column of floats at an address, one every so many bytes.
    fn span(first: usize, stride: usize, count: usize) -> Span {
        Span::new("c".into(), first, stride, [count, 1, 4]).unwrap()
    }

    #[test]
    fn elements_of_structs_are_told_apart() {
        let t = span(1000, 48, 100);
        assert!(!t.may_overlap(&span(1004, 48, 100)));
        assert!(!t.may_overlap(&span(996, 48, 100)));
        assert!(!t.may_overlap(&span(1004 + 3 * 48, 48, 10)));
        assert!(t.may_overlap(&t));
        assert!(t.may_overlap(&span(1003, 48, 100)));
        assert!(t.may_overlap(&span(997, 48, 100)));
        assert!(t.may_overlap(&span(1048 + 47, 48, 10)));
        assert!(!t.may_overlap(&span(1000 + 4800, 48, 100)));
        assert!(!span(1000, 0, 100).may_overlap(&span(1400, 0, 100)));
        assert!(span(1000, 0, 100).may_overlap(&span(1399, 0, 100)));
        assert!(!t.may_overlap(&span(1000, 48, 0)));
    }

    #[test]
    fn what_does_not_fit_into_memory_is_refused() {
        for (first, stride, counts) in [
            (1000, 0, [usize::MAX, 1, 4]),
            (1000, 0, [2, usize::MAX, 4]),
            (1000, usize::MAX, [3, 1, 4]),
            (usize::MAX - 6, 0, [2, 1, 4]),
            (1000, 3, [2, 1, 4]),
            (1000, 7, [2, 2, 4]),
        ] {
            assert!(Span::new("c".into(), first, stride, counts).is_err(), "{first} {stride} {counts:?}");
        }
    }
}
