//! The emitter of each ray.

use super::source::{Entry, Gathered, RowGroups, Rows, Source};
use crate::Error;
use crate::geometry::{EmitterLanes, SpotLanes};
use crate::scene::Emitter;
use crate::simd::Isa;
use core::ops::Range;

/// The emitter of each ray: [one](Self::one) for the batch, one per ray as [columns](Self::each), or a
/// [table](Self::table) with an index per ray.
#[derive(Clone, Copy, Debug)]
pub struct Emitters<'a> {
    /// Positions and normals, or axes.
    pub(crate) points: Source<'a, Emitter, COLUMNS>,
    /// The cones, if there are spots.
    pub(crate) cones: Option<Source<'a, Emitter, CONE_COLUMNS>>,
}

impl<'a> Emitters<'a> {
    /// One emitter for the whole batch.
    ///
    /// ```
    /// # use airlight::{Emitter, Emitters};
    /// let lamp = Emitters::one(Emitter::point([0.0, 1.0, 3.0])?);
    /// # Ok::<(), airlight::Error>(())
    /// ```
    #[must_use]
    pub fn one(emitter: Emitter) -> Self {
        Self { points: Source::One(emitter), cones: emitter.cone().map(|_| Source::One(emitter)) }
    }

    /// One emitter per ray, as columns of the batch's length: positions (x, y, z \[m\]) and unit normals (x, y, z). The normal
    /// (0, 0, 0) means a point emitter. The length of a normal scales the cosine.
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
        Self { points: Source::Each([px, py, pz, nx, ny, nz]), cones: None }
    }

    /// One emitter per ray, spots among them, as columns of the batch's length: positions (x, y, z \[m\]), unit vectors along the
    /// axes (x, y, z), and the cosines of [`Emitter::spot`]. Two cosines of -1 mean an emitter that is no spot: its axis is then a
    /// normal, as in [`each`](Self::each).
    ///
    /// ```
    /// # use airlight::Emitters;
    /// let (x, y, z) = ([0.0, 1.0], [2.0, 2.0], [3.0, 3.0]);
    /// let (zero, down) = ([0.0; 2], [-1.0; 2]);
    /// // A spot of a half-angle of 60 degrees, and a surface.
    /// let lamps = Emitters::each_spot([&x, &y, &z], [&zero, &down, &zero], &[0.5, -1.0], &[0.6, -1.0]);
    /// ```
    #[must_use]
    pub fn each_spot(
        position: [&'a [f32]; 3],
        axis: [&'a [f32]; 3],
        cos_outer: &'a [f32],
        cos_inner: &'a [f32],
    ) -> Self {
        Self { cones: Some(Source::Each([cos_outer, cos_inner])), ..Self::each(position, axis) }
    }

    /// `table[index[i]]` for ray `i`: `index` has the batch's length, `table` has any length but 0. An index out of range
    /// makes its ray invalid.
    ///
    /// A table of some dozens of emitters takes less time than columns, as it stays in the cache (`cargo bench --bench emitters`).
    /// Every call reads each entry once: a short call should not have a table of thousands.
    ///
    /// ```
    /// # use airlight::{Emitter, Emitters};
    /// let lamps = [Emitter::point([0.0, 1.0, 3.0])?, Emitter::point_normal([2.0, 1.0, 3.0], [0.0, -1.0, 0.0])?];
    /// let of_rays = Emitters::table(&lamps, &[1, 0, 0, 1]);
    /// # Ok::<(), airlight::Error>(())
    /// ```
    #[must_use]
    pub fn table(table: &'a [Emitter], index: &'a [u32]) -> Self {
        Self::entries(table, index, Self::have_spots(table))
    }

    /// Whether there are spots in a table.
    pub(crate) fn have_spots(table: &[Emitter]) -> bool {
        table.iter().any(|emitter| emitter.cone().is_some())
    }

    /// A table of which it is known whether it has spots.
    pub(crate) fn entries(table: &'a [Emitter], index: &'a [u32], has_spots: bool) -> Self {
        Self { points: Source::Table { table, index }, cones: has_spots.then_some(Source::Table { table, index }) }
    }

    /// The emitters of the rays of `range`.
    pub(super) fn part(&self, range: Range<usize>) -> Self {
        Self { points: self.points.part(range.clone()), cones: self.cones.map(|cones| cones.part(range)) }
    }

    /// `Ok` if there is an emitter for each of `rays` rays.
    pub(super) fn check(&self, rays: usize) -> Result<(), Error> {
        self.points.check(rays)?;
        self.cones.map_or(Ok(()), |cones| cones.check(rays))
    }
}

/// The number of columns of emitters: position and normal, or axis.
pub(super) const COLUMNS: usize = 6;
/// The number of columns of cones.
pub(super) const CONE_COLUMNS: usize = 2;

/// The emitters of some rays.
pub(crate) type EmitterRows<'r> = Rows<'r, COLUMNS>;
/// The cones of some rays.
pub(crate) type ConeRows<'r> = Rows<'r, CONE_COLUMNS>;

/// Storage for the emitters of a block.
pub(crate) type EmitterPlace = Gathered<COLUMNS>;
/// Storage for their cones.
pub(crate) type ConePlace = Gathered<CONE_COLUMNS>;

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

    #[inline]
    fn row(&self) -> [f32; COLUMNS] {
        let axis = self.cone().map(|cone| cone.axis());
        let ([px, py, pz], [nx, ny, nz]) = (self.position(), self.normal().or(axis).unwrap_or_default());
        [px, py, pz, nx, ny, nz]
    }
}

impl Entry<CONE_COLUMNS> for Emitter {
    const COLUMNS: [&'static str; CONE_COLUMNS] = ["emitters.cos_outer", "emitters.cos_inner"];
    const TABLE: &'static str = <Self as Entry<COLUMNS>>::TABLE;
    const INDEX: &'static str = <Self as Entry<COLUMNS>>::INDEX;

    #[inline]
    fn row(&self) -> [f32; CONE_COLUMNS] {
        self.cone().map_or([-1.0; CONE_COLUMNS], |cone| [cone.cos_outer(), cone.cos_inner()])
    }
}

impl<I: Isa> RowGroups<'_, I, COLUMNS> {
    /// The emitters of lane group `index`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn emitters(&self, isa: I, index: usize) -> EmitterLanes<I> {
        let [px, py, pz, nx, ny, nz] = self.lanes(isa, index);
        EmitterLanes::new(isa, [px, py, pz], [nx, ny, nz])
    }

    /// The same with their cones.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn spots(&self, isa: I, cones: &RowGroups<'_, I, CONE_COLUMNS>, index: usize) -> SpotLanes<I> {
        let [px, py, pz, ax, ay, az] = self.lanes(isa, index);
        let [cos_outer, cos_inner] = cones.lanes(isa, index);
        SpotLanes { position: [px, py, pz], axis: [ax, ay, az], cos_outer, cos_inner }
    }
}
