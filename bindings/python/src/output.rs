//! New arrays, which calls write.

use numpy::prelude::*;
use numpy::{Element, PyArrayDyn, PyReadwriteArrayDyn};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PySlice, PyTuple};
use std::array::from_fn;

/// Some arrays of one shape, in one block of memory: of several blocks, which allocators give back to the system when they
/// are freed, the pages would take as long as the samples.
pub(crate) struct Output<'py, T: Element>(PyReadwriteArrayDyn<'py, T>);

impl<'py, T: Element> Output<'py, T> {
    /// So many arrays, of which nothing is written yet.
    pub(crate) fn new(py: Python<'py>, count: usize, shape: &[usize]) -> PyResult<Self> {
        static EMPTY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        let empty = EMPTY.import(py, "numpy", "empty")?;
        let shape = PyTuple::new(py, [&[count], shape].concat())?;
        let block = empty.call1((shape, numpy::dtype::<T>(py)))?;
        Ok(Self(block.cast_into::<PyArrayDyn<T>>()?.try_readwrite()?))
    }

    /// The values of the `N` arrays.
    pub(crate) fn slices<const N: usize>(&mut self) -> PyResult<[&mut [T]; N]> {
        let length: usize = self.0.shape().iter().skip(1).product();
        let mut slices = self.0.as_slice_mut()?.chunks_exact_mut(length.max(1));
        Ok(from_fn(|_| slices.next().unwrap_or_default()))
    }

    /// So many arrays as one, with an axis more, the last; without that one if they are one.
    pub(crate) fn channels(&self, first: usize, count: usize) -> PyResult<Bound<'py, PyAny>> {
        if count == 1 {
            return self.array(first);
        }
        let py = self.0.py();
        let arrays = self.0.get_item(PySlice::new(py, first as isize, (first + count) as isize, 1))?;
        let axes = (1..self.0.ndim()).chain([0]);
        arrays.call_method1("transpose", PyTuple::new(py, axes.collect::<Vec<_>>())?)
    }

    /// Array number `index`; a scalar if the shape is ().
    pub(crate) fn array(&self, index: usize) -> PyResult<Bound<'py, PyAny>> {
        self.0.get_item(index)
    }
}
