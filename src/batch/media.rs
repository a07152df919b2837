//! The medium of each ray.

use super::source::{Entry, RowGroups, Rows, Source};
use crate::Error;
use crate::integrand::MediumLanes;
use crate::scene::Medium;
use crate::simd::Isa;

/// The medium of each ray: [one](Self::one) for the batch, one per ray as [columns](Self::each), or a
/// [table](Self::table) with an index per ray.
#[derive(Clone, Copy, Debug)]
pub struct Media<'a>(pub(crate) Source<'a, Medium, COLUMNS>);

impl<'a> Media<'a> {
    /// One for the whole batch.
    ///
    /// ```
    /// # use airlight::{Media, Medium};
    /// let fog = Media::one(Medium::new(0.01, 0.1, 0.6)?);
    /// # Ok::<(), airlight::Error>(())
    /// ```
    #[must_use]
    pub fn one(medium: Medium) -> Self {
        Self(Source::One(medium))
    }

    /// One per ray, as columns of the batch's length, with the values of [`Medium::new`]: absorption and scattering
    /// coefficients \[1/m\], mean cosines \[1\].
    ///
    /// ```
    /// # use airlight::Media;
    /// let (mu_a, mu_s, g) = ([0.01, 0.0], [0.1, 0.3], [0.6, -0.2]);
    /// let air = Media::each(&mu_a, &mu_s, &g);
    /// ```
    #[must_use]
    #[doc(alias = "sigma_a")]
    #[doc(alias = "sigma_s")]
    pub fn each(mu_a: &'a [f32], mu_s: &'a [f32], g: &'a [f32]) -> Self {
        Self(Source::Each([mu_a, mu_s, g]))
    }

    /// `table[index[i]]` for ray `i`: `index` has the batch's length, `table` has any length but 0. An index out of range
    /// makes its ray invalid.
    ///
    /// ```
    /// # use airlight::{Media, Medium};
    /// let air_and_smoke = [Medium::new(0.0, 0.02, 0.9)?, Medium::new(1.0, 0.4, 0.0)?];
    /// let of_rays = Media::table(&air_and_smoke, &[0, 0, 1]);
    /// # Ok::<(), airlight::Error>(())
    /// ```
    #[must_use]
    pub fn table(table: &'a [Medium], index: &'a [u32]) -> Self {
        Self(Source::Table { table, index })
    }

    /// `Ok` if there is one for each of so many rays.
    pub(super) fn check(&self, rays: usize) -> Result<(), Error> {
        let coloured = match self.0 {
            Source::One(medium) => medium.channels() > 1,
            Source::Table { table, .. } => table.iter().any(|medium| medium.channels() > 1),
            Source::Each(_) => false,
        };
        if coloured {
            return Err(Error::Unavailable { field: "coloured media", strategy: None });
        }
        self.0.check(rays)
    }
}

/// Columns of a medium: `mu_a`, `mu_s` and `g`.
pub(super) const COLUMNS: usize = 3;

/// The media of some rays.
pub(crate) type MediumRows<'r> = Rows<'r, COLUMNS>;

/// The same in lane groups.
pub(crate) type MediumGroups<'r, I> = RowGroups<'r, I, COLUMNS>;

impl Entry<COLUMNS> for Medium {
    const COLUMNS: [&'static str; COLUMNS] = ["media.mu_a", "media.mu_s", "media.g"];
    const TABLE: &'static str = "media.table";
    const INDEX: &'static str = "media.index";

    #[inline]
    fn row(&self) -> [f32; COLUMNS] {
        [self.mu_a(), self.mu_s(), self.g()]
    }
}

impl<I: Isa> MediumGroups<'_, I> {
    /// The media of lane group `index`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn media(&self, isa: I, index: usize) -> MediumLanes<I> {
        let [mu_a, mu_s, g] = self.lanes(isa, index);
        MediumLanes::new(isa, mu_a, mu_s, g)
    }

    /// Loads the media of lane group `index` if they differ from ray to ray.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn renew(&self, isa: I, index: usize, lanes: &mut MediumLanes<I>) {
        if self.differ() {
            *lanes = self.media(isa, index);
        }
    }
}
