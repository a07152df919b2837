//! The medium of each ray.

use super::source::{Entry, Gathered, RowGroups, Rows, Source, row_of};
use crate::Error;
use crate::integrand::{ChannelLanes, MediumLanes};
use crate::scene::{Colour, MOST_CHANNELS, Medium};
use crate::simd::Isa;
use core::ops::Range;

/// The medium of each ray: [one](Self::one) for the batch, one per ray as [columns](Self::each), or a
/// [table](Self::table) with an index per ray. All media of a call have the same number of channels.
#[derive(Clone, Copy, Debug)]
pub struct Media<'a>(pub(super) Kind<'a>);

/// Grey media, or coloured ones.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind<'a> {
    Grey(Source<'a, Medium, COLUMNS>),
    Coloured { source: Source<'a, Medium, CHANNEL_COLUMNS>, channels: usize },
}

impl<'a> Media<'a> {
    /// One medium for the whole batch.
    ///
    /// ```
    /// # use airlight::{Media, Medium};
    /// let fog = Media::one(Medium::new(0.01, 0.1, 0.6)?);
    /// let smoke = Media::one(Medium::coloured([0.2, 0.3, 0.5], [0.4, 0.4, 0.3], 0.8)?);
    /// # Ok::<(), airlight::Error>(())
    /// ```
    #[must_use]
    pub fn one(medium: Medium) -> Self {
        Self(match medium.channels() {
            1 => Kind::Grey(Source::One(medium)),
            channels => Kind::Coloured { source: Source::One(medium), channels },
        })
    }

    /// One medium per ray, as columns of the batch's length, with the values of [`Medium::new`]: absorption and scattering
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
        Self(Kind::Grey(Source::Each([mu_a, mu_s, g])))
    }

    /// One medium of 3 or 4 channels per ray, as columns of the batch's length, with the values of [`Medium::coloured`]: absorption
    /// and scattering coefficients of each channel \[1/m\], mean cosines \[1\]. With one channel it is [`each`](Self::each). With any
    /// other number of channels, calls return [`Error::Value`].
    ///
    /// ```
    /// # use airlight::Media;
    /// let (red, green, blue, g) = ([0.1, 0.3], [0.2, 0.3], [0.4, 0.3], [0.6, -0.2]);
    /// let air = Media::each_coloured([&[0.0; 2]; 3], [&red, &green, &blue], &g);
    /// ```
    #[must_use]
    pub fn each_coloured<const C: usize>(mu_a: [&'a [f32]; C], mu_s: [&'a [f32]; C], g: &'a [f32]) -> Self {
        if let ([mu_a], [mu_s]) = (&mu_a[..], &mu_s[..]) {
            return Self::each(mu_a, mu_s, g);
        }
        // Columns beyond the channels are never read; the first channel fills them.
        let padded = |columns: [&'a [f32]; C]| [0, 1, 2, 3].map(|c| columns.get(c).or(columns.first()).copied());
        let ([a0, a1, a2, a3], [s0, s1, s2, s3]) = (padded(mu_a), padded(mu_s));
        let columns = [a0, a1, a2, a3, s0, s1, s2, s3, Some(g)].map(Option::unwrap_or_default);
        Self(Kind::Coloured { source: Source::Each(columns), channels: C })
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
        let channels = table.iter().map(Medium::channels).max().unwrap_or(1);
        Self(match channels {
            1 => Kind::Grey(Source::Table { table, index }),
            channels => Kind::Coloured { source: Source::Table { table, index }, channels },
        })
    }

    /// The number of channels.
    pub(crate) fn channels(&self) -> usize {
        match self.0 {
            Kind::Grey(_) => 1,
            Kind::Coloured { channels, .. } => channels,
        }
    }

    /// `Ok` if there is a medium for each of `rays` rays, and all have the same number of channels.
    pub(super) fn check(&self, rays: usize) -> Result<(), Error> {
        match &self.0 {
            Kind::Grey(source) => source.check(rays),
            Kind::Coloured { source, channels } => {
                let channels = *channels;
                Error::unless(matches!(channels, 3 | 4), "channels", channels as f32, "1, 3 or 4")?;
                source.check(rays)?;
                let Source::Table { table, .. } = source else { return Ok(()) };
                let differs = |medium: &Medium| medium.channels() != channels;
                table.iter().position(differs).map_or(Ok(()), |index| {
                    let field = <Medium as Entry<COLUMNS>>::TABLE;
                    Err(Error::Channels {
                        field,
                        index: Some(index),
                        channels: table[index].channels(),
                        expected: channels,
                    })
                })
            }
        }
    }

    /// The media of the rays of `range`.
    pub(super) fn part(&self, range: Range<usize>) -> Self {
        Self(match self.0 {
            Kind::Grey(source) => Kind::Grey(source.part(range)),
            Kind::Coloured { source, channels } => Kind::Coloured { source: source.part(range), channels },
        })
    }

    /// The media of the rays of `range`, at most [`MOST_RAYS`](super::MOST_RAYS) of them, gathered in `place` if need be.
    pub(crate) fn rows<'r>(&self, range: Range<usize>, place: &'r mut MediaPlace) -> MediaRows<'r>
    where
        'a: 'r,
    {
        match &self.0 {
            Kind::Grey(source) => MediaRows { means: source.rows(range, place), channels: None },
            Kind::Coloured { source, channels } => {
                let (rays, count) = (range.len(), *channels);
                let rows = match source {
                    Source::One(medium) => Rows::One(with_means(&medium.row(), count)),
                    Source::Each(columns) => {
                        let row = |ray: usize| columns.map(|column| column[range.start + ray]);
                        Rows::Each(place.fill(rays, |ray| with_means(&row(ray), count)))
                    }
                    Source::Table { table, index } => {
                        let row = |ray: usize| row_of(table, index[range.start + ray]);
                        Rows::Each(place.fill(rays, |ray| with_means(&row(ray), count)))
                    }
                };
                MediaRows { means: rows.select([MEAN_A, MEAN_S, G]), channels: Some(ChannelRows { rows, count }) }
            }
        }
    }
}

/// The number of columns of grey media: `mu_a`, `mu_s` and `g`.
pub(super) const COLUMNS: usize = 3;
/// The number of columns of coloured media: `mu_a` of all channels, `mu_s` of all channels, and `g`.
pub(super) const CHANNEL_COLUMNS: usize = 2 * MOST_CHANNELS + 1;
/// The number of columns of coloured media with the means of `mu_a` and of `mu_s`.
const WITH_MEANS: usize = CHANNEL_COLUMNS + 2;
/// Indices of these columns.
const G: usize = CHANNEL_COLUMNS - 1;
const MEAN_A: usize = CHANNEL_COLUMNS;
const MEAN_S: usize = CHANNEL_COLUMNS + 1;

/// Storage for the media of a block.
pub(crate) type MediaPlace = Gathered<WITH_MEANS>;

/// The numbers with the means; all are NaN where one of them is not valid.
fn with_means(row: &[f32; CHANNEL_COLUMNS], channels: usize) -> [f32; WITH_MEANS] {
    let [a0, a1, a2, a3, s0, s1, s2, s3, g] = *row;
    let (mu_a, mu_s) = ([a0, a1, a2, a3], [s0, s1, s2, s3]);
    let is_medium = |c: usize| mu_a[c] >= 0.0 && mu_s[c] >= 0.0 && mu_a[c] + mu_s[c] <= f32::MAX;
    if !(0..channels).all(is_medium) {
        return [f32::NAN; WITH_MEANS];
    }
    let (mean_a, mean_s) = Colour::new(&mu_a[..channels], &mu_s[..channels]).mean();
    [a0, a1, a2, a3, s0, s1, s2, s3, g, mean_a, mean_s]
}

/// The media of some rays.
#[derive(Clone, Copy)]
pub(crate) struct MediaRows<'r> {
    /// Grey media, or the means of coloured media.
    pub(crate) means: MediumRows<'r>,
    /// The channels of coloured media.
    pub(crate) channels: Option<ChannelRows<'r>>,
}

impl<'r> MediaRows<'r> {
    /// The media of the rays of `range`.
    pub(crate) fn part(&self, range: Range<usize>) -> Self {
        let channels =
            self.channels.map(|ChannelRows { rows, count }| ChannelRows { rows: rows.part(range.clone()), count });
        Self { means: self.means.part(range), channels }
    }

    /// The media of an output column: those of its channel if there are several columns, else the means.
    pub(crate) fn of_output(&self, column: usize, columns: usize) -> MediumRows<'r> {
        match &self.channels {
            Some(channels) if columns > 1 => channels.channel(column),
            _ => self.means,
        }
    }
}

/// The channels of coloured media.
#[derive(Clone, Copy)]
pub(crate) struct ChannelRows<'r> {
    rows: Rows<'r, WITH_MEANS>,
    count: usize,
}

impl<'r> ChannelRows<'r> {
    fn channel(&self, c: usize) -> MediumRows<'r> {
        self.rows.select([c, MOST_CHANNELS + c, G])
    }

    /// The channels in lane groups.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn groups<I: Isa>(&self, isa: I) -> ChannelGroups<'r, I> {
        ChannelGroups { groups: self.rows.groups(isa), count: self.count }
    }
}

/// The same in lane groups.
pub(crate) struct ChannelGroups<'r, I: Isa> {
    groups: RowGroups<'r, I, WITH_MEANS>,
    count: usize,
}

impl<I: Isa> ChannelGroups<'_, I> {
    /// The channels of lane group `index`, if media are coloured.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn lanes(coloured: Option<&Self>, isa: I, index: usize) -> Option<ChannelLanes<I>> {
        let Self { groups, count } = coloured?;
        let [a0, a1, a2, a3, s0, s1, s2, s3, ..] = groups.lanes(isa, index);
        Some(ChannelLanes { mu_t: [a0 + s0, a1 + s1, a2 + s2, a3 + s3], mu_s: [s0, s1, s2, s3], count: *count })
    }
}

/// Grey media of some rays.
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

impl Entry<CHANNEL_COLUMNS> for Medium {
    const COLUMNS: [&'static str; CHANNEL_COLUMNS] = [
        "media.mu_a[0]",
        "media.mu_a[1]",
        "media.mu_a[2]",
        "media.mu_a[3]",
        "media.mu_s[0]",
        "media.mu_s[1]",
        "media.mu_s[2]",
        "media.mu_s[3]",
        "media.g",
    ];
    const TABLE: &'static str = <Self as Entry<COLUMNS>>::TABLE;
    const INDEX: &'static str = <Self as Entry<COLUMNS>>::INDEX;

    #[inline]
    fn row(&self) -> [f32; CHANNEL_COLUMNS] {
        let ([a0, a1, a2, a3], [s0, s1, s2, s3]) = self.coefficients();
        [a0, a1, a2, a3, s0, s1, s2, s3, self.g()]
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
