//! Refused calls, in the terms of Python.

use airlight::Error;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::fmt::Display;

/// The `ValueError` of a call that the library refuses. Lengths are never its reason: the columns that it gets agree.
pub(crate) fn refused(error: Error) -> PyErr {
    let argument = match error {
        Error::Unavailable { .. } => "precision: ",
        Error::Channels { .. } => "medium: ",
        _ => "",
    };
    PyValueError::new_err(format!("{argument}{error}"))
}

/// The `ValueError` of an argument.
pub(crate) fn bad(argument: &str, reason: impl Display) -> PyErr {
    PyValueError::new_err(format!("{argument}: {reason}"))
}
