//! What a malformed call returns.

use crate::Strategy;
use std::fmt;

/// Why a call was refused. Nothing was written to any output.
///
/// Only the *call* can be malformed: lengths that differ, a table without entries, a parameter that holds for the whole batch
/// and is out of range, or something that there is not. A single bad ray is not an error: it gets pdf 0 and weight 0 and is counted in [`Counts`](crate::Counts).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// Media, or the columns that are written for them, have another number of channels than the rest of the call.
    #[non_exhaustive]
    Channels {
        /// The table or the columns, such as `samples.weights`.
        field: &'static str,
        /// Which entry of the table.
        index: Option<usize>,
        /// How many it has.
        channels: usize,
        /// How many the media have.
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
        /// The column, as it is named in the call, such as `rays.t_max`.
        field: &'static str,
        /// Its length.
        length: usize,
        /// The length of the batch, which is that of `rays.origin[0]` (or a multiple of it, for `u` and `t`), or that of
        /// what was given for it.
        expected: usize,
    },
    /// There is no such thing.
    #[non_exhaustive]
    Unavailable {
        /// What was asked for, such as `fast precision`.
        field: &'static str,
        /// The strategy that does not have it; `None` if none has.
        strategy: Option<Strategy>,
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
            Self::Unavailable { field, strategy: Some(strategy) } => {
                write!(f, "the strategy {strategy} has no {field}")
            }
            Self::Unavailable { field, strategy: None } => write!(f, "there are no kernels for {field}"),
            Self::Value { field, value, expected } => write!(f, "{field} is {value}, expected {expected}"),
        }
    }
}

impl std::error::Error for Error {}
