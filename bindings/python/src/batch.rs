//! What a call reads and writes.

use crate::columns::{Column, Length, Number, Values, all_values, array, unlike, vector};
use crate::error::refused;
use crate::scene::{OfEmitter, OfMedium};
use airlight::{Counts, Emitters, Error, Media, Rays};
use numpy::prelude::*;
use pyo3::prelude::*;

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

    /// How many rays there are with these numbers, and the shape of what is written for them.
    pub(crate) fn shape_with(&self, py: Python<'_>, given: &Given) -> PyResult<(usize, Vec<usize>)> {
        let mut length = self.length(py)?;
        given.agree(py, &mut length)?;
        Ok((length.rays(), given.per_ray.map_or_else(|| length.shape(), |per_ray| vec![length.rays(), per_ray])))
    }

    /// Makes the call with the columns of so many rays, while other threads of Python run.
    pub(crate) fn run(
        &self,
        py: Python<'_>,
        rays: usize,
        call: impl FnOnce(&Rays<'_>, &Emitters<'_>, &Media<'_>) -> Result<Counts, Error> + Send,
    ) -> PyResult<Counts> {
        let columns = all_values(py, &self.rays, rays)?;
        let [ox, oy, oz, dx, dy, dz, t_min, t_max] = columns.each_ref().map(|column| &**column);
        let emitters = self.emitter.source().spread(py, rays)?;
        let media = self.medium.source().spread(py, rays)?;

        let rays = Rays::new([ox, oy, oz], [dx, dy, dz], t_min, t_max);
        let (emitters, media) = (emitters.emitters(), media.media());
        let counts = py.detach(|| call(&rays, &emitters, &media)).map_err(refused)?;
        // A Ctrl-C that came meanwhile.
        py.check_signals()?;
        Ok(counts)
    }
}

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

    fn agree(&self, py: Python<'_>, length: &mut Length) -> PyResult<()> {
        length.agree(self.field, self.column.length(py).map(|values| values / self.per_ray.unwrap_or(1)))
    }

    /// As many as that shape has.
    pub(crate) fn values<'py>(&self, py: Python<'py>, shape: &[usize]) -> PyResult<Values<'py, f32>> {
        self.column.values(py, shape.iter().product())
    }
}
