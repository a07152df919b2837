//! The native part of the Python package `airlight`.
//!
//! `output` has new arrays, `columns` numbers out of Python objects, `scene` emitters and media, `batch` what a call reads, and
//! `calls` the functions. What users see is documented in `python/airlight`.

mod batch;
mod calls;
mod columns;
mod error;
mod output;
mod scene;

#[pyo3::pymodule]
mod _airlight {
    #[pymodule_export]
    use super::calls::{cdf, choose, evaluate, forked, pdf, radiance, sample};
    #[pymodule_export]
    use super::scene::{Emitter, Emitters, Media, Medium};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("version", env!("CARGO_PKG_VERSION"))?;
        module.add("backend", airlight::Backend::detect().name())
    }
}
