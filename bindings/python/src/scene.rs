//! Emitters and media: one, one per ray in columns, or a table with an index per ray.

use crate::columns::{Column, Length, Values, channels, parts, point, vector};
use crate::error::refused;
use airlight::{Emitter as OneEmitter, Medium as OneMedium};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::ops::Range;

/// A point that lights the medium.
///
/// position: (3,), where it is [m].
/// normal: (3,), of unit length: a piece of a surface, which shines to the side of its normal with the cosine;
///     None: alike in all directions.
///
/// `Emitter.spot` makes one that shines into a cone.
#[pyclass(frozen, eq, module = "airlight")]
#[derive(PartialEq)]
pub(crate) struct Emitter(pub(crate) OneEmitter);

#[pymethods]
impl Emitter {
    #[new]
    #[pyo3(signature = (position, normal = None))]
    fn new(position: &Bound<'_, PyAny>, normal: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let position = point("position", position)?;
        let emitter = match normal {
            None => OneEmitter::point(position),
            Some(normal) => OneEmitter::point_normal(position, point("normal", normal)?),
        };
        emitter.map(Self).map_err(refused)
    }

    /// A point that shines into the cone around the unit vector `axis`.
    ///
    /// position: (3,) [m].
    /// axis: (3,), of unit length, where it shines to.
    /// cos_outer: the cosine of the angle from the axis beyond which it is dark, 0 or more.
    /// cos_inner: the cosine of the angle up to which the intensity is full, from `cos_outer` to 1.
    ///
    /// In between the intensity falls off as `s^2 (3 - 2 s)`, with `s` linear in the cosine.
    #[staticmethod]
    fn spot(position: &Bound<'_, PyAny>, axis: &Bound<'_, PyAny>, cos_outer: f32, cos_inner: f32) -> PyResult<Self> {
        let (position, axis) = (point("position", position)?, point("axis", axis)?);
        OneEmitter::spot(position, axis, cos_outer, cos_inner).map(Self).map_err(refused)
    }

    /// Where it is [m].
    #[getter]
    fn position(&self) -> (f32, f32, f32) {
        self.0.position().into()
    }

    /// Its unit normal, if it has one.
    #[getter]
    fn normal(&self) -> Option<(f32, f32, f32)> {
        self.0.normal().map(Into::into)
    }

    /// Where it shines to and the cosines of its outer and inner angle, if it is a spot.
    #[getter]
    fn cone(&self) -> Option<((f32, f32, f32), f32, f32)> {
        self.0.cone().map(|cone| (cone.axis().into(), cone.cos_outer(), cone.cos_inner()))
    }

    fn __repr__(&self) -> String {
        let position = self.position();
        match (self.normal(), self.cone()) {
            (_, Some((axis, outer, inner))) => format!("Emitter.spot({position:?}, {axis:?}, {outer:?}, {inner:?})"),
            (Some(normal), None) => format!("Emitter({position:?}, {normal:?})"),
            (None, None) => format!("Emitter({position:?})"),
        }
    }
}

/// A homogeneous medium with the Henyey-Greenstein phase function.
///
/// mu_a, mu_s: absorption and scattering coefficient [1/m], a number each; or three or four, one for each channel of a
///     colour.
/// g: mean cosine of the scattering angle, from -1 to 1; g > 0 scatters forward.
#[pyclass(frozen, eq, module = "airlight")]
#[derive(PartialEq)]
pub(crate) struct Medium(OneMedium);

#[pymethods]
impl Medium {
    #[new]
    fn new(mu_a: &Bound<'_, PyAny>, mu_s: &Bound<'_, PyAny>, g: f32) -> PyResult<Self> {
        let py = mu_a.py();
        let (of_a, of_s) = (Column::new("mu_a", mu_a)?, Column::new("mu_s", mu_s)?);
        let count = check_channels(of_a.length(py).unwrap_or(1), of_s.length(py).unwrap_or(1))?;
        let (mu_a, mu_s) = (of_a.to_vec(py, count)?, of_s.to_vec(py, count)?);
        let medium = match (&mu_a[..], &mu_s[..]) {
            (&[a], &[s]) => OneMedium::new(a, s, g),
            (&[a0, a1, a2], &[s0, s1, s2]) => OneMedium::coloured([a0, a1, a2], [s0, s1, s2], g),
            (&[a0, a1, a2, a3], &[s0, s1, s2, s3]) => OneMedium::coloured([a0, a1, a2, a3], [s0, s1, s2, s3], g),
            _ => unreachable!("1, 3 or 4 channels"),
        };
        medium.map(Self).map_err(refused)
    }

    /// Absorption coefficient [1/m]; a tuple with one for each channel if the medium has several.
    #[getter]
    fn mu_a<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.by_channel(OneMedium::mu_a))
    }

    /// Scattering coefficient [1/m]; a tuple with one for each channel if the medium has several.
    #[getter]
    fn mu_s<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.by_channel(OneMedium::mu_s))
    }

    /// Mean cosine of the scattering angle.
    #[getter]
    fn g(&self) -> f32 {
        self.0.g()
    }

    /// How many channels it has.
    #[getter]
    fn channels(&self) -> usize {
        self.0.channels()
    }

    fn __repr__(&self) -> String {
        let (mu_a, mu_s) = (self.by_channel(OneMedium::mu_a), self.by_channel(OneMedium::mu_s));
        match (&mu_a[..], &mu_s[..]) {
            ([mu_a], [mu_s]) => format!("Medium({mu_a:?}, {mu_s:?}, {:?})", self.g()),
            _ => format!("Medium({mu_a:?}, {mu_s:?}, {:?})", self.g()),
        }
    }
}

impl Medium {
    fn by_channel(&self, of: impl Fn(&OneMedium) -> f32) -> Vec<f32> {
        (0..).map_while(|c| self.0.channel(c)).map(|medium| of(&medium)).collect()
    }
}

/// How many channels there are with so many of `mu_a` and of `mu_s`, of which one stands for all.
fn check_channels(of_a: usize, of_s: usize) -> PyResult<usize> {
    let count = if of_a == 1 { of_s } else { of_a };
    for (field, length) in [("mu_a", of_a), ("mu_s", of_s)] {
        if length != 1 && (length != count || !matches!(count, 3 | 4)) {
            let error = format!("{field} has {length} channels, expected 1, 3 or 4, and mu_a and mu_s as many");
            return Err(PyValueError::new_err(error));
        }
    }
    Ok(count)
}

/// A number, or a tuple of several.
fn plain<'py>(py: Python<'py>, values: &[f32]) -> PyResult<Bound<'py, PyAny>> {
    match *values {
        [value] => Ok(value.into_pyobject(py)?.into_any()),
        _ => Ok(PyTuple::new(py, values)?.into_any()),
    }
}

/// An emitter for each ray: `Emitters.each` from columns, `Emitters.table` from a list with an index per ray.
#[pyclass(frozen, module = "airlight")]
pub(crate) struct Emitters(PerRay<OneEmitter>);

#[pymethods]
impl Emitters {
    /// One for each ray.
    ///
    /// position: (n, 3) or a tuple of three columns [m].
    /// normal: the same, of unit length; (0, 0, 0) where the emitter has none. None: none has one.
    ///
    /// float32 columns in a tuple are not copied.
    #[staticmethod]
    #[pyo3(signature = (position, normal = None))]
    fn each(position: &Bound<'_, PyAny>, normal: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let position = vector("position", position)?.map(|column| ("emitter.position", column));
        let none = || [(); 3].map(|()| Column::One(0.0));
        let normal = normal.map_or_else(|| Ok(none()), |normal| vector("normal", normal))?;
        let normal = normal.map(|column| ("emitter.normal", column));
        Ok(Self(PerRay::Each(position.into_iter().chain(normal).collect())))
    }

    /// One for each ray, spots among them.
    ///
    /// position, axis: (n, 3) or a tuple of three columns, as those of Emitter.spot.
    /// cos_outer, cos_inner: (n,), or one number; both -1 where the emitter is no spot, and its axis a normal.
    #[staticmethod]
    fn each_spot(
        position: &Bound<'_, PyAny>,
        axis: &Bound<'_, PyAny>,
        cos_outer: &Bound<'_, PyAny>,
        cos_inner: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let position = vector("position", position)?.map(|column| ("emitter.position", column));
        let axis = vector("axis", axis)?.map(|column| ("emitter.axis", column));
        let outer = ("emitter.cos_outer", Column::new("cos_outer", cos_outer)?);
        let inner = ("emitter.cos_inner", Column::new("cos_inner", cos_inner)?);
        Ok(Self(PerRay::Each(position.into_iter().chain(axis).chain([outer, inner]).collect())))
    }

    /// `table[index[i]]` for ray i.
    ///
    /// table: a list of Emitter.
    /// index: (n,), integers; one out of range makes its ray invalid.
    #[staticmethod]
    fn table(table: Vec<PyRef<'_, Emitter>>, index: &Bound<'_, PyAny>) -> PyResult<Self> {
        PerRay::table(table.iter().map(|emitter| emitter.0).collect(), "emitter.index", index).map(Self)
    }
}

/// A medium for each ray: `Media.each` from columns, `Media.table` from a list with an index per ray.
#[pyclass(frozen, module = "airlight")]
pub(crate) struct Media(PerRay<OneMedium>);

#[pymethods]
impl Media {
    /// One for each ray.
    ///
    /// mu_a, mu_s: (n,), absorption and scattering coefficients [1/m]; or (n, c), or a tuple of c columns, of as many
    ///     channels, 3 or 4.
    /// g: (n,), mean cosines.
    ///
    /// Each may be one number for all rays. float32 columns are not copied.
    #[staticmethod]
    fn each(mu_a: &Bound<'_, PyAny>, mu_s: &Bound<'_, PyAny>, g: &Bound<'_, PyAny>) -> PyResult<Self> {
        let py = g.py();
        let (of_a, of_s) = (channels("mu_a", mu_a)?, channels("mu_s", mu_s)?);
        let count = check_channels(of_a.len(), of_s.len())?;
        let of_a = (0..count).map(|c| ("medium.mu_a", of_a[c.min(of_a.len() - 1)].clone_ref(py)));
        let of_s = (0..count).map(|c| ("medium.mu_s", of_s[c.min(of_s.len() - 1)].clone_ref(py)));
        let g = ("medium.g", Column::new("g", g)?);
        Ok(Self(PerRay::Each(of_a.chain(of_s).chain([g]).collect())))
    }

    /// `table[index[i]]` for ray i.
    ///
    /// table: a list of Medium.
    /// index: (n,), integers; one out of range makes its ray invalid.
    #[staticmethod]
    fn table(table: Vec<PyRef<'_, Medium>>, index: &Bound<'_, PyAny>) -> PyResult<Self> {
        PerRay::table(table.iter().map(|medium| medium.0).collect(), "medium.index", index).map(Self)
    }
}

/// A thing for each ray: its numbers in columns, or a table and an index; with what these are called in a call.
pub(crate) enum PerRay<T> {
    Each(Vec<(&'static str, Column<f32>)>),
    Table { table: Vec<T>, name: &'static str, index: Column<u32> },
}

impl<T> PerRay<T> {
    fn table(table: Vec<T>, name: &'static str, index: &Bound<'_, PyAny>) -> PyResult<Self> {
        if table.is_empty() {
            return Err(PyValueError::new_err("table is empty"));
        }
        Ok(Self::Table { table, name, index: Column::new("index", index)? })
    }
}

/// The argument `emitter` of a call.
pub(crate) enum OfEmitter<'py> {
    One(PyRef<'py, Emitter>),
    PerRay(PyRef<'py, Emitters>),
}

impl<'py> OfEmitter<'py> {
    pub(crate) fn new(value: &Bound<'py, PyAny>) -> PyResult<Self> {
        match (value.extract(), value.extract()) {
            (Ok(one), _) => Ok(Self::One(one)),
            (_, Ok(many)) => Ok(Self::PerRay(many)),
            _ => Err(PyTypeError::new_err(format!("emitter is {}, expected Emitter or Emitters", value.get_type()))),
        }
    }

    pub(crate) fn source(&self) -> Source<'_, OneEmitter> {
        match self {
            Self::One(one) => Source::One(one.0),
            Self::PerRay(many) => Source::PerRay(&many.0),
        }
    }
}

/// The argument `medium` of a call.
pub(crate) enum OfMedium<'py> {
    One(PyRef<'py, Medium>),
    PerRay(PyRef<'py, Media>),
}

impl<'py> OfMedium<'py> {
    pub(crate) fn new(value: &Bound<'py, PyAny>) -> PyResult<Self> {
        match (value.extract(), value.extract()) {
            (Ok(one), _) => Ok(Self::One(one)),
            (_, Ok(many)) => Ok(Self::PerRay(many)),
            _ => Err(PyTypeError::new_err(format!("medium is {}, expected Medium or Media", value.get_type()))),
        }
    }

    pub(crate) fn source(&self) -> Source<'_, OneMedium> {
        match self {
            Self::One(one) => Source::One(one.0),
            Self::PerRay(many) => Source::PerRay(&many.0),
        }
    }
}

/// Where each ray's emitter or medium comes from.
pub(crate) enum Source<'a, T> {
    One(T),
    PerRay(&'a PerRay<T>),
}

impl Source<'_, OneMedium> {
    /// How many channels they have.
    pub(crate) fn channels(&self) -> usize {
        match self {
            Self::One(one) => one.channels(),
            Self::PerRay(PerRay::Each(columns)) => (columns.len() - 1) / 2,
            Self::PerRay(PerRay::Table { table, .. }) => table.iter().map(OneMedium::channels).max().unwrap_or(1),
        }
    }
}

impl<'a, T: Copy> Source<'a, T> {
    /// Has its columns agree with the others on the length of the batch.
    pub(crate) fn agree(&self, py: Python<'_>, length: &mut Length) -> PyResult<()> {
        match self {
            Self::One(_) => Ok(()),
            Self::PerRay(PerRay::Each(columns)) => {
                columns.iter().try_for_each(|(name, column)| length.agree(name, column.length(py)))
            }
            Self::PerRay(PerRay::Table { name, index, .. }) => length.agree(name, index.length(py)),
        }
    }

    /// Its values for so many rays.
    pub(crate) fn spread<'py>(&self, py: Python<'py>, rays: usize) -> PyResult<Spread<'a, 'py, T>> {
        Ok(match *self {
            Self::One(one) => Spread::One(one),
            Self::PerRay(PerRay::Each(columns)) => {
                Spread::Each(columns.iter().map(|(_, column)| column.values(py, rays)).collect::<PyResult<_>>()?)
            }
            Self::PerRay(PerRay::Table { table, index, .. }) => Spread::Table(table, index.values(py, rays)?),
        })
    }
}

/// The emitters or media of so many rays.
pub(crate) enum Spread<'a, 'py, T> {
    One(T),
    Each(Vec<Values<'py, f32>>),
    Table(&'a [T], Values<'py, u32>),
}

/// Those of a part of the rays.
pub(crate) enum Part<'s, T> {
    One(T),
    Each(Vec<&'s [f32]>),
    Table(&'s [T], &'s [u32]),
}

/// Room for them.
#[derive(Default)]
pub(crate) struct Place {
    columns: Vec<Vec<f32>>,
    index: Vec<u32>,
}

impl<T: Copy> Spread<'_, '_, T> {
    /// Whether they lie as the library takes them.
    pub(crate) fn are_in_place(&self) -> bool {
        match self {
            Self::One(_) => true,
            Self::Each(columns) => columns.iter().all(Values::are_in_place),
            Self::Table(_, index) => index.are_in_place(),
        }
    }

    /// Those of a part of the rays.
    pub(crate) fn part<'s>(&'s self, range: &Range<usize>, place: &'s mut Place) -> Part<'s, T> {
        match self {
            Self::One(one) => Part::One(*one),
            Self::Each(columns) => Part::Each(parts(columns, range, &mut place.columns)),
            Self::Table(table, index) => Part::Table(table, index.part(range, &mut place.index)),
        }
    }
}

impl Part<'_, OneEmitter> {
    pub(crate) fn emitters(&self) -> airlight::Emitters<'_> {
        match self {
            Self::One(one) => airlight::Emitters::one(*one),
            Self::Each(columns) => match columns[..] {
                [px, py, pz, nx, ny, nz] => airlight::Emitters::each([px, py, pz], [nx, ny, nz]),
                [px, py, pz, ax, ay, az, outer, inner] => {
                    airlight::Emitters::each_spot([px, py, pz], [ax, ay, az], outer, inner)
                }
                _ => unreachable!("as Emitters.each and each_spot made them"),
            },
            Self::Table(table, index) => airlight::Emitters::table(table, index),
        }
    }
}

impl Part<'_, OneMedium> {
    pub(crate) fn media(&self) -> airlight::Media<'_> {
        match self {
            Self::One(one) => airlight::Media::one(*one),
            Self::Each(columns) => match columns[..] {
                [mu_a, mu_s, g] => airlight::Media::each(mu_a, mu_s, g),
                [a0, a1, a2, s0, s1, s2, g] => airlight::Media::each_coloured([a0, a1, a2], [s0, s1, s2], g),
                [a0, a1, a2, a3, s0, s1, s2, s3, g] => {
                    airlight::Media::each_coloured([a0, a1, a2, a3], [s0, s1, s2, s3], g)
                }
                _ => unreachable!("as Media.each made them"),
            },
            Self::Table(table, index) => airlight::Media::table(table, index),
        }
    }
}
