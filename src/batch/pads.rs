//! Columns for one lane group, made of fewer rays than it has lanes.

use super::{Emitters, Inputs, Media, Rays};
use crate::simd::MOST_LANES;

/// As many values as the lanes of every backend need, or more.
pub(crate) type Pad = [f32; MOST_LANES];

const NOTHING: Pad = [0.0; MOST_LANES];

/// What copies of the columns of a few rays are made in.
pub(crate) struct Pads {
    rays: [Pad; 8],
    emitters: Option<[Pad; 6]>,
    media: Option<[Pad; 3]>,
}

impl Pads {
    /// Nothing yet.
    #[inline]
    pub(crate) fn new() -> Self {
        Self { rays: [NOTHING; 8], emitters: None, media: None }
    }

    /// A lane group of so many lanes: the rays of `inputs` one after the other, then the first one again.
    pub(crate) fn of_rays<'a>(&'a mut self, inputs: &Inputs<'a>, lanes: usize) -> Inputs<'a> {
        self.fill(inputs, lanes, |pad, column| {
            pad.fill(column[0]);
            pad[..column.len()].copy_from_slice(column);
        })
    }

    /// The one ray of `inputs` in all of so many lanes.
    pub(crate) fn of_one_ray<'a>(&'a mut self, inputs: &Inputs<'a>, lanes: usize) -> Inputs<'a> {
        self.fill(inputs, lanes, |pad, column| pad.fill(column[0]))
    }

    fn fill<'a>(&'a mut self, inputs: &Inputs<'a>, lanes: usize, write: impl Fn(&mut Pad, &[f32])) -> Inputs<'a> {
        let Rays { origin: [ox, oy, oz], direction: [dx, dy, dz], t_min, t_max } = inputs.rays;
        let [ox, oy, oz, dx, dy, dz, t_min, t_max] =
            filled(&mut self.rays, [ox, oy, oz, dx, dy, dz, t_min, t_max], lanes, &write);
        let emitters = match inputs.emitters {
            Emitters::Each { position: [px, py, pz], normal: [nx, ny, nz] } => {
                let pads = self.emitters.insert([NOTHING; 6]);
                let [px, py, pz, nx, ny, nz] = filled(pads, [px, py, pz, nx, ny, nz], lanes, &write);
                Emitters::Each { position: [px, py, pz], normal: [nx, ny, nz] }
            }
            one @ Emitters::One(_) => one,
        };
        let media = match inputs.media {
            Media::Each { mu_a, mu_s, g } => {
                let [mu_a, mu_s, g] = filled(self.media.insert([NOTHING; 3]), [mu_a, mu_s, g], lanes, &write);
                Media::Each { mu_a, mu_s, g }
            }
            one @ Media::One(_) => one,
        };
        Inputs {
            rays: Rays { origin: [ox, oy, oz], direction: [dx, dy, dz], t_min, t_max },
            emitters,
            media,
            ..*inputs
        }
    }
}

/// The first lanes of the pads, after `write` has written the columns to them.
#[inline]
fn filled<'a, const K: usize>(
    pads: &'a mut [Pad; K],
    columns: [&[f32]; K],
    lanes: usize,
    write: impl Fn(&mut Pad, &[f32]),
) -> [&'a [f32]; K] {
    for (pad, column) in pads.iter_mut().zip(columns) {
        write(pad, column);
    }
    pads.each_ref().map(|pad| &pad[..lanes])
}

/// The first values of a column, and zeros if there are fewer.
#[inline]
pub(crate) fn first_values(column: &[f32]) -> Pad {
    let mut pad = NOTHING;
    pad[..column.len()].copy_from_slice(column);
    pad
}
