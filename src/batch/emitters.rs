//! The emitter of each ray.

use super::source::{Entry, RowGroups, Rows, Source};
use crate::geometry::EmitterLanes;
use crate::scene::Emitter;
use crate::simd::Isa;

/// The emitter of each ray: [one](Self::one) for the batch, one per ray as [columns](Self::each), or a
/// [table](Self::table) with an index per ray.
#[derive(Clone, Copy, Debug)]
pub struct Emitters<'a>(pub(crate) Source<'a, Emitter, COLUMNS>);

impl<'a> Emitters<'a> {
    /// One for the whole batch.
    ///
    /// ```
    /// # use airlight::{Emitter, Emitters};
    /// let lamp = Emitters::one(Emitter::point([0.0, 1.0, 3.0])?);
    /// # Ok::<(), airlight::Error>(())
    /// ```
    #[must_use]
    pub fn one(emitter: Emitter) -> Self {
        Self(Source::One(emitter))
    }

    /// One per ray, as columns of the batch's length: positions (x, y, z \[m\]) and unit normals (x, y, z). The normal
    /// (0, 0, 0) stands for a point emitter. Within the tolerance the length of a normal scales the cosine.
    ///
    /// ```
    /// # use airlight::Emitters;
    /// let (x, y, z) = ([0.0, 1.0], [2.0, 2.0], [3.0, 3.0]);
    /// let (zero, down) = ([0.0; 2], [-1.0; 2]);
    /// let lamps = Emitters::each([&x, &y, &z], [&zero, &down, &zero]);
    /// ```
    #[must_use]
    pub fn each(position: [&'a [f32]; 3], normal: [&'a [f32]; 3]) -> Self {
        let ([px, py, pz], [nx, ny, nz]) = (position, normal);
        Self(Source::Each([px, py, pz, nx, ny, nz]))
    }

    /// `table[index[i]]` for ray `i`: `index` has the batch's length, `table` has any length but 0. An index out of range
    /// makes its ray invalid.
    ///
    /// A table of some dozens of emitters takes less time than columns, whose values come from farther away; `cargo bench
    /// --bench emitters` measures it. Every entry is looked at once per call, so that a short call should not bring a list of
    /// thousands.
    ///
    /// ```
    /// # use airlight::{Emitter, Emitters};
    /// let lamps = [Emitter::point([0.0, 1.0, 3.0])?, Emitter::point_normal([2.0, 1.0, 3.0], [0.0, -1.0, 0.0])?];
    /// let of_rays = Emitters::table(&lamps, &[1, 0, 0, 1]);
    /// # Ok::<(), airlight::Error>(())
    /// ```
    #[must_use]
    pub fn table(table: &'a [Emitter], index: &'a [u32]) -> Self {
        Self(Source::Table { table, index })
    }
}

/// Columns of an emitter: position and normal.
pub(super) const COLUMNS: usize = 6;

/// The emitters of some rays.
pub(crate) type EmitterRows<'r> = Rows<'r, COLUMNS>;

impl Entry<COLUMNS> for Emitter {
    const COLUMNS: [&'static str; COLUMNS] = [
        "emitters.position[0]",
        "emitters.position[1]",
        "emitters.position[2]",
        "emitters.normal[0]",
        "emitters.normal[1]",
        "emitters.normal[2]",
    ];
    const TABLE: &'static str = "emitters.table";
    const INDEX: &'static str = "emitters.index";
    const UNSUPPORTED: &'static str = "spots";

    fn is_supported(&self) -> bool {
        self.cone().is_none()
    }

    #[inline]
    fn row(&self) -> [f32; COLUMNS] {
        let ([px, py, pz], [nx, ny, nz]) = (self.position(), self.normal().unwrap_or_default());
        [px, py, pz, nx, ny, nz]
    }
}

impl<I: Isa> RowGroups<'_, I, COLUMNS> {
    /// The emitters of lane group `index`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn emitters(&self, isa: I, index: usize) -> EmitterLanes<I> {
        let [px, py, pz, nx, ny, nz] = self.lanes(isa, index);
        EmitterLanes::new(isa, [px, py, pz], [nx, ny, nz])
    }
}
