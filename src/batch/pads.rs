//! Columns for one lane group, made of fewer rays than it has lanes.

use super::media::Kind;
use super::source::Source;
use super::{Emitters, Inputs, Media, Rays, emitters, media};
use crate::simd::MOST_LANES;

/// As many values as the lanes of every backend need, or more.
pub(crate) type Pad = [f32; MOST_LANES];

const NOTHING: Pad = [0.0; MOST_LANES];

/// What copies of the columns of a few rays are made in.
pub(crate) struct Pads {
    rays: [Pad; 8],
    emitters: SourcePads<{ emitters::COLUMNS }>,
    cones: SourcePads<{ emitters::CONE_COLUMNS }>,
    media: SourcePads<{ media::COLUMNS }>,
    channels: SourcePads<{ media::CHANNEL_COLUMNS }>,
}

impl Pads {
    /// Nothing yet.
    #[inline]
    pub(crate) fn new() -> Self {
        let (emitters, cones) = (SourcePads::new(), SourcePads::new());
        Self { rays: [NOTHING; 8], emitters, cones, media: SourcePads::new(), channels: SourcePads::new() }
    }

    /// A lane group of so many lanes: the rays of `inputs` one after the other, then the first one again.
    pub(crate) fn of_rays<'a>(&'a mut self, inputs: &Inputs<'a>, lanes: usize) -> Inputs<'a> {
        let Rays { origin: [ox, oy, oz], direction: [dx, dy, dz], t_min, t_max } = inputs.rays;
        let [ox, oy, oz, dx, dy, dz, t_min, t_max] =
            filled(&mut self.rays, [ox, oy, oz, dx, dy, dz, t_min, t_max], lanes);
        Inputs {
            rays: Rays { origin: [ox, oy, oz], direction: [dx, dy, dz], t_min, t_max },
            emitters: Emitters {
                points: self.emitters.fill(inputs.emitters.points, lanes),
                cones: inputs.emitters.cones.map(|cones| self.cones.fill(cones, lanes)),
            },
            media: Media(match inputs.media.0 {
                Kind::Grey(source) => Kind::Grey(self.media.fill(source, lanes)),
                Kind::Coloured { source, channels } => {
                    Kind::Coloured { source: self.channels.fill(source, lanes), channels }
                }
            }),
            ..*inputs
        }
    }
}

/// Those of emitters or media.
struct SourcePads<const K: usize> {
    columns: Option<[Pad; K]>,
    index: Option<[u32; MOST_LANES]>,
}

impl<const K: usize> SourcePads<K> {
    #[inline]
    fn new() -> Self {
        Self { columns: None, index: None }
    }

    fn fill<'a, T: Copy>(&'a mut self, source: Source<'a, T, K>, lanes: usize) -> Source<'a, T, K> {
        match source {
            Source::One(one) => Source::One(one),
            Source::Each(columns) => Source::Each(filled(self.columns.insert([NOTHING; K]), columns, lanes)),
            Source::Table { table, index } => {
                let pad = self.index.insert([0; MOST_LANES]);
                fill(pad, index);
                Source::Table { table, index: &pad[..lanes] }
            }
        }
    }
}

/// The first lanes of the pads, filled from the columns.
#[inline]
fn filled<'a, const K: usize>(pads: &'a mut [Pad; K], columns: [&[f32]; K], lanes: usize) -> [&'a [f32]; K] {
    for (pad, column) in pads.iter_mut().zip(columns) {
        fill(pad, column);
    }
    pads.each_ref().map(|pad| &pad[..lanes])
}

/// The values of a column, then the first one again.
#[inline]
fn fill<T: Copy>(pad: &mut [T; MOST_LANES], column: &[T]) {
    pad.fill(column[0]);
    if column.len() > 1 {
        pad[..column.len()].copy_from_slice(column);
    }
}

/// The first values of a column, and zeros if there are fewer.
#[inline]
pub(crate) fn first_values(column: &[f32]) -> Pad {
    let mut pad = NOTHING;
    pad[..column.len()].copy_from_slice(column);
    pad
}
