//! The errors of malformed calls.

use crate::Strategy;
use std::fmt;

/// The reason why a call was refused. No output was written.
///
/// Only a *call* can be malformed: by columns of different lengths, a table without entries, a parameter of the whole batch that is
/// out of range, or a feature that does not exist. A single bad ray is no error: it gets pdf 0 and weight 0, and is counted in
/// [`Counts`](crate::Counts).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// Media of a table, or output columns, have another number of channels than the other media of the call.
    #[non_exhaustive]
    Channels {
        /// The table or the columns, such as `samples.weights`.
        field: &'static str,
        /// The entry of the table; `None` for columns.
        index: Option<usize>,
        /// The number of its channels.
        channels: usize,
        /// The number of channels of the media.
        expected: usize,
    },
    /// A table has no entry.
    #[non_exhaustive]
    Empty {
        /// The table, such as `emitters.table`.
        field: &'static str,
    },
    /// A column has another length than the rest of the batch.
    #[non_exhaustive]
    Length {
        /// The column, such as `rays.t_max`.
        field: &'static str,
        /// Its length.
        length: usize,
        /// The length of the batch, which is that of `rays.origin[0]` (`u` and `t` may have a multiple of it); for an output, the
        /// length of `u` or `t`.
        expected: usize,
    },
    /// The call asks for a feature that does not exist.
    #[non_exhaustive]
    Unavailable {
        /// The feature, such as `fast precision`.
        field: &'static str,
        /// The strategy that does not have it.
        strategy: Strategy,
    },
    /// A parameter is out of its range.
    #[non_exhaustive]
    Value {
        /// The parameter, such as `g`.
        field: &'static str,
        /// The offending value.
        value: f32,
        /// The range, in words.
        expected: &'static str,
    },
}

impl Error {
    /// `Ok` if `holds`, else an [`Error::Value`].
    pub(crate) fn unless(holds: bool, field: &'static str, value: f32, expected: &'static str) -> Result<(), Self> {
        if holds { Ok(()) } else { Err(Self::Value { field, value, expected }) }
    }

    /// `Ok` if `length` is `expected`, else an [`Error::Length`].
    pub(crate) fn unless_length(field: &'static str, length: usize, expected: usize) -> Result<(), Self> {
        if length == expected { Ok(()) } else { Err(Self::Length { field, length, expected }) }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Channels { field, index, channels, expected } => {
                let entry = index.map_or(String::new(), |index| format!("[{index}]"));
                let plural = if *channels == 1 { "" } else { "s" };
                write!(f, "{field}{entry} has {channels} channel{plural}, expected {expected}")
            }
            Self::Empty { field } => write!(f, "{field} is empty"),
            Self::Length { field, length, expected } => {
                write!(f, "{field} has {length} elements, expected {expected}")
            }
            Self::Unavailable { field, strategy } => write!(f, "the strategy {strategy} has no {field}"),
            Self::Value { field, value, expected } => write!(f, "{field} is {value}, expected {expected}"),
        }
    }
}

impl std::error::Error for Error {}
