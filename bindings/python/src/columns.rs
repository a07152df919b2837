//! Columns of numbers, from what Python passes: scalars, arrays, and what numpy makes arrays of.

use numpy::prelude::*;
use numpy::{Element, PyArray1, PyArray2, PyArrayDyn, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyFloat, PyInt, PyTuple};
use std::fmt::{self, Display};
use std::ops::Range;

/// What an array may hold: `f32`, or `u32` for an index.
pub(crate) trait Number: Element + Copy {
    /// The function of `airlight._arrays` that converts to it.
    const CONVERT: &'static str;

    /// The scalar that `value` is, if it is a plain Python number.
    fn plain(value: &Bound<'_, PyAny>) -> Option<Self>;

    /// The array that `value` is but for the width of its numbers: what numpy would do takes longer for few of them.
    fn narrowed<'py>(value: &Bound<'py, PyAny>) -> Option<Bound<'py, PyArrayDyn<Self>>>;
}

impl Number for f32 {
    const CONVERT: &'static str = "floats";

    fn plain(value: &Bound<'_, PyAny>) -> Option<Self> {
        let is_plain = value.is_exact_instance_of::<PyFloat>() || value.is_exact_instance_of::<PyInt>();
        is_plain.then(|| value.extract::<f64>().ok()).flatten().map(|value| value as Self)
    }

    fn narrowed<'py>(value: &Bound<'py, PyAny>) -> Option<Bound<'py, PyArrayDyn<Self>>> {
        let wide = in_order::<f64>(value)?.try_readonly().ok()?;
        Some(PyArrayDyn::from_owned_array(value.py(), wide.as_array().mapv(|number| number as Self)))
    }
}

impl Number for u32 {
    const CONVERT: &'static str = "indices";

    fn plain(_: &Bound<'_, PyAny>) -> Option<Self> {
        None
    }

    fn narrowed<'py>(_: &Bound<'py, PyAny>) -> Option<Bound<'py, PyArrayDyn<Self>>> {
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

/// `value` itself, if it is an array of such numbers, next to each other in row-major order.
fn in_order<'a, 'py, T: Element>(value: &'a Bound<'py, PyAny>) -> Option<&'a Bound<'py, PyArrayDyn<T>>> {
    value.cast::<PyArrayDyn<T>>().ok().filter(|array| array.is_c_contiguous() && array.is_aligned())
}

/// An array of any shape, its values next to each other in row-major order: `value` itself where it is one.
pub(crate) fn array<'py, T: Number>(field: Field, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    if let Some(array) = in_order(value).cloned().or_else(|| T::narrowed(value)) {
        return Ok(array);
    }
    static ARRAYS: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let py = value.py();
    let arrays = ARRAYS.get_or_try_init(py, || py.import("airlight._arrays").map(Bound::unbind))?;
    Ok(arrays.bind(py).call_method1(T::CONVERT, (field.to_string(), value))?.cast_into()?)
}

/// One value for all rays, or one for each: of an array of one dimension, or a column of one of two.
pub(crate) enum Column<T> {
    One(T),
    Many(Py<PyArray1<T>>),
    Component(Py<PyArray2<T>>, usize),
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
            Self::Component(array, _) => Some(array.bind(py).shape()[0]),
        }
    }

    /// The same column once more.
    pub(crate) fn clone_ref(&self, py: Python<'_>) -> Self {
        match self {
            Self::One(value) => Self::One(*value),
            Self::Many(array) => Self::Many(array.clone_ref(py)),
            Self::Component(array, k) => Self::Component(array.clone_ref(py), *k),
        }
    }

    /// Its values, to be repeated until they are `count`.
    pub(crate) fn values<'py>(&self, py: Python<'py>, count: usize) -> PyResult<Values<'py, T>> {
        let values = match self {
            Self::One(value) => Values::One(*value),
            Self::Many(array) if array.bind(py).len() == count => Values::Many(array.bind(py).try_readonly()?),
            Self::Many(array) => Values::Repeated(array.bind(py).try_readonly()?),
            Self::Component(array, k) => {
                let array = array.bind(py).try_readonly()?;
                // One row is that of all rays.
                match (array.shape()[0], array.as_slice()?.get(*k)) {
                    (1, Some(value)) => Values::One(*value),
                    _ => Values::Component(array, *k),
                }
            }
        };
        Ok(values)
    }

    /// A copy of its values, repeated until they are `count`.
    pub(crate) fn to_vec(&self, py: Python<'_>, count: usize) -> PyResult<Vec<T>> {
        Ok(self.values(py, count)?.part(&(0..count), &mut Vec::new()).to_vec())
    }
}

/// The values of a column for every ray, while the call borrows them.
pub(crate) enum Values<'py, T: Element> {
    One(T),
    Many(PyReadonlyArray1<'py, T>),
    Repeated(PyReadonlyArray1<'py, T>),
    Component(PyReadonlyArray2<'py, T>, usize),
}

impl<T: Number> Values<'_, T> {
    /// Whether they lie as the library takes them.
    pub(crate) fn are_in_place(&self) -> bool {
        matches!(self, Self::Many(_))
    }

    /// Those of a part of the rays: where they lie, or in `place`, which is for this column alone. Fewer if the array is no
    /// longer what was passed.
    pub(crate) fn part<'s>(&'s self, range: &Range<usize>, place: &'s mut Vec<T>) -> &'s [T] {
        match self {
            Self::Many(array) => {
                return array.as_slice().ok().and_then(|all| all.get(range.clone())).unwrap_or_default();
            }
            // Place has this value and no other.
            Self::One(value) => place.resize(range.len(), *value),
            Self::Repeated(array) => {
                let all = array.as_slice().unwrap_or_default();
                let start = range.start.checked_rem(all.len()).unwrap_or(0);
                place.clear();
                place.extend(all.iter().cycle().skip(start).take(range.len()));
            }
            Self::Component(array, k) => {
                let (all, width) = (array.as_slice().unwrap_or_default(), array.shape()[1]);
                let rows = all.get(range.start * width..range.end * width).unwrap_or_default();
                place.clear();
                place.extend(rows.iter().skip(*k).step_by(width));
            }
        }
        place
    }
}

/// A part of several columns; `places` are for these columns alone.
pub(crate) fn parts<'s>(
    columns: &'s [Values<'_, f32>],
    range: &Range<usize>,
    places: &'s mut Vec<Vec<f32>>,
) -> Vec<&'s [f32]> {
    places.resize_with(columns.len(), Vec::new);
    columns.iter().zip(places).map(|(column, place)| column.part(range, place)).collect()
}

const VECTOR: &str = "(3,), (n, 3) or a tuple of three columns";

/// Three columns: `components`, or those of an array of shape (n, 3), or (3,) for all rays.
pub(crate) fn vector(field: &'static str, value: &Bound<'_, PyAny>) -> PyResult<[Column<f32>; 3]> {
    if let Some([x, y, z]) = components(field, value)? {
        let column = |k, value| Column::new(Field(field, Some(k)), value);
        return Ok([column(0, &x)?, column(1, &y)?, column(2, &z)?]);
    }
    let array = array::<f32>(field.into(), value)?;
    match *array.shape() {
        [3] => {
            let [x, y, z] = array.extract()?;
            Ok([Column::One(x), Column::One(y), Column::One(z)])
        }
        [_, 3] => {
            let array: Py<PyArray2<f32>> = array.cast_into()?.unbind();
            Ok([0, 1, 2].map(|k| Column::Component(array.clone_ref(value.py()), k)))
        }
        ref shape => Err(unlike(field.into(), shape, VECTOR)),
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

/// A column for each channel: a tuple of them, an array of shape (n, channels), or one column for all channels.
pub(crate) fn channels(field: &'static str, value: &Bound<'_, PyAny>) -> PyResult<Vec<Column<f32>>> {
    if let Ok(columns) = value.cast::<PyTuple>() {
        let column = |(c, value)| Column::new(Field(field, Some(c)), &value);
        return columns.iter().enumerate().map(column).collect();
    }
    if f32::plain(value).is_some() {
        return Ok(vec![Column::new(field, value)?]);
    }
    let array = array::<f32>(field.into(), value)?;
    match *array.shape() {
        [_, channels] => {
            let array: Py<PyArray2<f32>> = array.cast_into()?.unbind();
            Ok((0..channels).map(|k| Column::Component(array.clone_ref(value.py()), k)).collect())
        }
        _ => Ok(vec![Column::new(field, &array)?]),
    }
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
