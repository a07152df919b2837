//! What a call reads and writes.

use crate::columns::{Column, Length, Number, Values, array, parts, unlike, vector};
use crate::error::refused;
use crate::scene::{OfEmitter, OfMedium, Place};
use airlight::{Counts, Emitters, Error, Media, Rays};
use numpy::prelude::*;
use pyo3::prelude::*;
use std::ops::Range;

/// Origin, direction, `t_min`, `t_max`, emitter and medium, as they are passed.
pub(crate) type Scene<'py> = [Bound<'py, PyAny>; 6];

/// The rays of a call, with the emitter and the medium of each.
pub(crate) struct Batch<'a> {
    /// x, y, z of origin and direction, `t_min` and `t_max`.
    rays: [Column<f32>; 8],
    emitter: OfEmitter<'a>,
    medium: OfMedium<'a>,
}

impl<'a> Batch<'a> {
    pub(crate) fn new([origin, direction, t_min, t_max, emitter, medium]: &Scene<'a>) -> PyResult<Self> {
        let emitter = OfEmitter::new(emitter)?;
        let medium = OfMedium::new(medium)?;
        let ([ox, oy, oz], [dx, dy, dz]) = (vector("origin", origin)?, vector("direction", direction)?);
        let (t_min, t_max) = (Column::new("t_min", t_min)?, Column::new("t_max", t_max)?);
        Ok(Self { rays: [ox, oy, oz, dx, dy, dz, t_min, t_max], emitter, medium })
    }

    /// The length that its columns agree on.
    pub(crate) fn length(&self, py: Python<'_>) -> PyResult<Length> {
        const O: &str = "origin";
        const D: &str = "direction";
        let mut length = Length::default();
        for (field, column) in [O, O, O, D, D, D, "t_min", "t_max"].into_iter().zip(&self.rays) {
            length.agree(field, column.length(py))?;
        }
        self.emitter.source().agree(py, &mut length)?;
        self.medium.source().agree(py, &mut length)?;
        Ok(length)
    }

    /// How many channels its media have.
    pub(crate) fn channels(&self) -> usize {
        self.medium.source().channels()
    }

    /// How its values lie, with such numbers for each ray if there are any.
    pub(crate) fn layout(&self, py: Python<'_>, given: Option<&Given>) -> PyResult<Layout> {
        let mut length = self.length(py)?;
        let mut per_ray = None;
        if let Some(given) = given {
            per_ray = given.per_ray;
            length.agree(given.field, given.column.length(py).map(|values| values / per_ray.unwrap_or(1)))?;
        }
        let rays = length.rays();
        let shape = per_ray.map_or_else(|| length.shape(), |per_ray| vec![rays, per_ray]);
        Ok(Layout { rays, per_ray: per_ray.unwrap_or(1), shape })
    }

    /// Makes the call, part by part, with the rays, emitters and media of a part, what is given for them, and where their
    /// values are in the batch; other threads of Python run meanwhile.
    pub(crate) fn run(
        &self,
        py: Python<'_>,
        layout: &Layout,
        given: Option<&Given>,
        mut call: impl FnMut(&Rays<'_>, &Emitters<'_>, &Media<'_>, &[f32], Range<usize>) -> Result<Counts, Error> + Send,
    ) -> PyResult<Counts> {
        let (rays, per_ray) = (layout.rays, layout.per_ray);
        let columns = self.rays.iter().map(|column| column.values(py, rays)).collect::<PyResult<Vec<_>>>()?;
        let emitters = self.emitter.source().spread(py, rays)?;
        let media = self.medium.source().spread(py, rays)?;
        let given = given.map(|given| given.column.values(py, rays * per_ray)).transpose()?;
        let are_in_place =
            columns.iter().chain(&given).all(Values::are_in_place) && emitters.are_in_place() && media.are_in_place();

        let mut places = (Vec::new(), Place::default(), Place::default(), Vec::new());
        let mut counts = Counts::default();
        let part = if are_in_place { MOST_RAYS } else { MOST_CONVERTED };
        for start in (0..rays.max(1)).step_by(part) {
            let range = start..rays.min(start + part);
            let part = parts(&columns, &range, &mut places.0);
            let &[ox, oy, oz, dx, dy, dz, t_min, t_max] = &part[..] else { unreachable!("as Batch::new made them") };
            let rays = Rays::new([ox, oy, oz], [dx, dy, dz], t_min, t_max);
            let (emitters, media) = (emitters.part(&range, &mut places.1), media.part(&range, &mut places.2));
            let (emitters, media) = (emitters.emitters(), media.media());
            let values = range.start * per_ray..range.end * per_ray;
            let given = given.as_ref().map(|given| given.part(&values, &mut places.3)).unwrap_or_default();
            counts = counts + py.detach(|| call(&rays, &emitters, &media, given, values)).map_err(refused)?;
            // A Ctrl-C that came meanwhile.
            py.check_signals()?;
        }
        Ok(counts)
    }
}

/// The most rays of a part: not many seconds' work.
const MOST_RAYS: usize = 1 << 22;

/// The same where columns are converted or repeated, which stay in the cache this way: enough for some dozens of threads.
const MOST_CONVERTED: usize = 1 << 17;

/// Numbers for each ray, variates or distances: one, or `per_ray` of them next to each other.
pub(crate) struct Given {
    field: &'static str,
    column: Column<f32>,
    per_ray: Option<usize>,
}

impl Given {
    /// Those of an array of shape (), (n,) or (n, k).
    pub(crate) fn new(field: &'static str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Some(number) = f32::plain(value) {
            return Ok(Self { field, column: Column::One(number), per_ray: None });
        }
        let array = array::<f32>(field.into(), value)?;
        let (column, per_ray) = match *array.shape() {
            [] | [_] => (Column::new(field, &array)?, None),
            [_, per_ray] if per_ray > 0 => (Column::Many(array.reshape([array.len()])?.unbind()), Some(per_ray)),
            ref shape => return Err(unlike(field.into(), shape, "(), (n,) or (n, k) with k > 0")),
        };
        Ok(Self { field, column, per_ray })
    }

    /// The same of shape () or (n,).
    pub(crate) fn one_each(field: &'static str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        Ok(Self { field, column: Column::new(field, value)?, per_ray: None })
    }
}

/// How the values of a call lie.
pub(crate) struct Layout {
    rays: usize,
    per_ray: usize,
    /// The shape of what is written.
    pub(crate) shape: Vec<usize>,
}
