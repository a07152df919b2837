//! Columns of numbers, from what Python passes: scalars, arrays, and what numpy makes arrays of.

use crate::output::Output;
use numpy::prelude::*;
use numpy::{Element, PyArray1, PyArrayDyn, PyReadonlyArray1, PyUntypedArray};
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyFloat, PyInt, PyTuple};
use std::fmt::{self, Display};
use std::ops::Deref;

/// What an array may hold: `f32`, or `u32` for an index.
pub(crate) trait Number: Element + Copy {
    /// The function of `airlight._arrays` that converts to it.
    const CONVERT: &'static str;

    /// The scalar that `value` is, if it is a plain Python number.
    fn plain(value: &Bound<'_, PyAny>) -> Option<Self>;
}

impl Number for f32 {
    const CONVERT: &'static str = "floats";

    fn plain(value: &Bound<'_, PyAny>) -> Option<Self> {
        let is_plain = value.is_exact_instance_of::<PyFloat>() || value.is_exact_instance_of::<PyInt>();
        is_plain.then(|| value.extract::<f64>().ok()).flatten().map(|value| value as Self)
    }
}

impl Number for u32 {
    const CONVERT: &'static str = "indices";

    fn plain(_: &Bound<'_, PyAny>) -> Option<Self> {
        None
    }
}

/// What an argument is called: its name, and which one of a tuple.
#[derive(Clone, Copy)]
pub(crate) struct Field(&'static str, Option<usize>);

impl From<&'static str> for Field {
    fn from(name: &'static str) -> Self {
        Self(name, None)
    }
}

impl Display for Field {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self(name, None) => f.write_str(name),
            Self(name, Some(k)) => write!(f, "{name}[{k}]"),
        }
    }
}

/// An array of any shape, its values next to each other in row-major order: `value` itself where it is one.
pub(crate) fn array<'py, T: Number>(field: Field, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    if let Ok(array) = value.cast::<PyArrayDyn<T>>()
        && array.is_c_contiguous()
        && array.is_aligned()
    {
        return Ok(array.clone());
    }
    static ARRAYS: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let py = value.py();
    let arrays = ARRAYS.get_or_try_init(py, || py.import("airlight._arrays").map(Bound::unbind))?;
    Ok(arrays.bind(py).call_method1(T::CONVERT, (field.to_string(), value))?.cast_into()?)
}

/// One value for all rays, or one for each.
pub(crate) enum Column<T> {
    One(T),
    Many(Py<PyArray1<T>>),
}

impl<T: Number> Column<T> {
    /// A column from a number or from an array of one dimension, of which nothing is copied if it holds `T` already.
    pub(crate) fn new(field: impl Into<Field>, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let field = field.into();
        if let Some(number) = T::plain(value) {
            return Ok(Self::One(number));
        }
        let array = array::<T>(field, value)?;
        match array.shape() {
            [] => Ok(Self::One(array.try_readonly()?.as_slice()?[0])),
            [_] => Ok(Self::Many(array.cast_into()?.unbind())),
            shape => Err(unlike(field, shape, "() or (n,)")),
        }
    }

    /// How many values it has; `None` if one for all rays.
    pub(crate) fn length(&self, py: Python<'_>) -> Option<usize> {
        match self {
            Self::One(_) => None,
            Self::Many(array) => Some(array.bind(py).len()),
        }
    }

    /// Its values, repeated until they are `count`.
    pub(crate) fn values<'py>(&self, py: Python<'py>, count: usize) -> PyResult<Values<'py, T>> {
        let array = match self {
            Self::One(value) => return Ok(Values::Owned(repeated(&[*value], count)?)),
            Self::Many(array) => array.bind(py).try_readonly()?,
        };
        // An array that was kept may have been resized, or its flags changed.
        match array.as_slice() {
            Ok(values) if values.len() == count => Ok(Values::Borrowed(array)),
            Ok(values) if !values.is_empty() => Ok(Values::Owned(repeated(values, count)?)),
            _ => Err(PyValueError::new_err("an array has changed since it was passed")),
        }
    }
}

/// The values of several columns.
pub(crate) fn all_values<'py, const K: usize>(
    py: Python<'py>,
    columns: &[Column<f32>; K],
    count: usize,
) -> PyResult<[Values<'py, f32>; K]> {
    let values = columns.iter().map(|column| column.values(py, count)).collect::<PyResult<Vec<_>>>()?;
    Ok(values.try_into().unwrap_or_else(|_| unreachable!("as many as columns")))
}

/// `values` over and over, `count` numbers in all.
fn repeated<T: Copy>(values: &[T], count: usize) -> PyResult<Vec<T>> {
    let mut all = Vec::new();
    all.try_reserve_exact(count).map_err(|error| PyMemoryError::new_err(error.to_string()))?;
    match values {
        [value] => all.resize(count, *value),
        _ => all.extend(values.iter().cycle().take(count)),
    }
    Ok(all)
}

/// The values of a column for every ray.
pub(crate) enum Values<'py, T: Element> {
    Borrowed(PyReadonlyArray1<'py, T>),
    Owned(Vec<T>),
}

impl<T: Element> Deref for Values<'_, T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        match self {
            Self::Borrowed(array) => array.as_slice().unwrap_or_default(),
            Self::Owned(values) => values,
        }
    }
}

const VECTOR: &str = "(3,), (n, 3) or a tuple of three columns";

/// Three columns: `components`, or those of an array of shape (n, 3), or (3,) for all rays.
pub(crate) fn vector(field: &'static str, value: &Bound<'_, PyAny>) -> PyResult<[Column<f32>; 3]> {
    if let Some([x, y, z]) = components(field, value)? {
        let column = |k, value| Column::new(Field(field, Some(k)), value);
        return Ok([column(0, &x)?, column(1, &y)?, column(2, &z)?]);
    }
    let array = array::<f32>(field.into(), value)?;
    let values = array.try_readonly()?;
    let rows = values.as_slice()?.as_chunks::<3>().0;
    match (array.shape(), rows) {
        ([3], [row]) => Ok(row.map(Column::One)),
        ([n, 3], rows) => columns_of(value.py(), rows, *n),
        (shape, _) => Err(unlike(field.into(), shape, VECTOR)),
    }
}

/// The three of a tuple, or x, y and z of an object that has them, as the vectors of Dr.Jit do.
fn components<'py>(field: &str, value: &Bound<'py, PyAny>) -> PyResult<Option<[Bound<'py, PyAny>; 3]>> {
    if let Ok(tuple) = value.cast::<PyTuple>() {
        let length = tuple.len();
        let unlike = |_| PyValueError::new_err(format!("{field} is a tuple of {length}, expected {VECTOR}"));
        return tuple.extract().map(Some).map_err(unlike);
    }
    if value.is_instance_of::<PyUntypedArray>() {
        return Ok(None);
    }
    let [x, y, z] = [value.getattr_opt("x")?, value.getattr_opt("y")?, value.getattr_opt("z")?];
    Ok(x.zip(y).zip(z).map(|((x, y), z)| [x, y, z]))
}

/// The columns of `n` rows.
fn columns_of(py: Python<'_>, rows: &[[f32; 3]], n: usize) -> PyResult<[Column<f32>; 3]> {
    let mut columns = Output::new(py, 3, &[n])?;
    let [x, y, z] = columns.slices()?;
    for (((x, y), z), row) in x.iter_mut().zip(y).zip(z).zip(rows) {
        [*x, *y, *z] = *row;
    }
    let column = |k| PyResult::Ok(Column::Many(columns.array(k)?.cast_into()?.unbind()));
    Ok([column(0)?, column(1)?, column(2)?])
}

/// A point or a direction: a vector for all rays.
pub(crate) fn point(field: &'static str, value: &Bound<'_, PyAny>) -> PyResult<[f32; 3]> {
    match vector(field, value)? {
        [Column::One(x), Column::One(y), Column::One(z)] => Ok([x, y, z]),
        _ => Err(PyValueError::new_err(format!("{field} is more than one vector, expected shape (3,)"))),
    }
}

/// The error of an argument of the wrong shape.
pub(crate) fn unlike(field: Field, shape: &[usize], expected: &str) -> PyErr {
    let lengths = shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
    let comma = if shape.len() == 1 { "," } else { "" };
    PyValueError::new_err(format!("{field} has shape ({lengths}{comma}), expected {expected}"))
}

/// How many rays there are, as columns of one value give way to longer ones.
#[derive(Default)]
pub(crate) struct Length(Option<(usize, &'static str)>);

impl Length {
    /// Takes a column into account, with its length if it has one.
    pub(crate) fn agree(&mut self, field: &'static str, length: Option<usize>) -> PyResult<()> {
        match (self.0, length) {
            (None | Some((1, _)), Some(length)) => self.0 = Some((length, field)),
            (Some((rays, first)), Some(length)) if length != rays && length != 1 => {
                return Err(PyValueError::new_err(format!("{field} is of {length} rays, but {first} is of {rays}")));
            }
            _ => {}
        }
        Ok(())
    }

    /// How many rays they are.
    pub(crate) fn rays(&self) -> usize {
        self.0.map_or(1, |(rays, _)| rays)
    }

    /// The shape of an array with a value for each: that of a scalar if all columns are scalars.
    pub(crate) fn shape(&self) -> Vec<usize> {
        self.0.iter().map(|(rays, _)| *rays).collect()
    }
}
