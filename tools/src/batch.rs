//! A batch that owns its columns, in any of the forms that a call takes.

use airlight::{Emitter, Emitters, Media, Medium, Rays};
use std::ops::Range;

/// A batch that owns its columns, whose values may have any bits.
#[derive(Clone, Debug)]
pub struct Batch {
    /// Origin, direction, `t_min`, `t_max`.
    pub rays: [Vec<f32>; 8],
    /// Their emitters.
    pub lights: Lights,
    /// Their media.
    pub fog: Fog,
    /// Variates, as many for each ray.
    pub u: Vec<f32>,
    /// Distances at which densities are asked for, as many as variates.
    pub t: Vec<f32>,
}

/// The emitters of a batch.
#[derive(Clone, Debug)]
pub enum Lights {
    /// One for all rays.
    One(Emitter),
    /// Position and normal.
    Each([Vec<f32>; 6]),
    /// Position, axis, `cos_outer`, `cos_inner`.
    EachSpot([Vec<f32>; 8]),
    /// A list, and an index into it per ray.
    Table(Vec<Emitter>, Vec<u32>),
}

/// The media of a batch.
#[derive(Clone, Debug)]
pub enum Fog {
    /// One for all rays.
    One(Medium),
    /// `mu_a`, `mu_s` and `g`.
    Each([Vec<f32>; 3]),
    /// `mu_a` of three channels, `mu_s` of three channels, and `g`.
    Each3([Vec<f32>; 7]),
    /// The same of four channels.
    Each4([Vec<f32>; 9]),
    /// A list of media with as many channels, and an index into it per ray.
    Table(Vec<Medium>, Vec<u32>),
}

impl Batch {
    /// How many rays it has.
    pub(crate) fn len(&self) -> usize {
        self.rays[0].len()
    }

    /// Variates of each ray.
    pub(crate) fn per_ray(&self) -> usize {
        self.u.len().checked_div(self.len()).unwrap_or(1)
    }

    /// Those of the rays of `range`, of a column with as many values for each ray as there are variates.
    pub(crate) fn given<'a>(&self, column: &'a [f32], range: &Range<usize>) -> &'a [f32] {
        &column[range.start * self.per_ray()..range.end * self.per_ray()]
    }

    /// The rays of `range`.
    pub(crate) fn rays(&self, range: &Range<usize>) -> Rays<'_> {
        let [ox, oy, oz, dx, dy, dz, t_min, t_max] = parts(&self.rays, range);
        Rays::new([ox, oy, oz], [dx, dy, dz], t_min, t_max)
    }

    /// Their emitters.
    pub(crate) fn emitters(&self, range: &Range<usize>) -> Emitters<'_> {
        match &self.lights {
            Lights::One(emitter) => Emitters::one(*emitter),
            Lights::Each(columns) => {
                let [px, py, pz, nx, ny, nz] = parts(columns, range);
                Emitters::each([px, py, pz], [nx, ny, nz])
            }
            Lights::EachSpot(columns) => {
                let [px, py, pz, ax, ay, az, outer, inner] = parts(columns, range);
                Emitters::each_spot([px, py, pz], [ax, ay, az], outer, inner)
            }
            Lights::Table(table, index) => Emitters::table(table, &index[range.clone()]),
        }
    }

    /// Their media.
    pub(crate) fn media(&self, range: &Range<usize>) -> Media<'_> {
        match &self.fog {
            Fog::One(medium) => Media::one(*medium),
            Fog::Each(columns) => {
                let [mu_a, mu_s, g] = parts(columns, range);
                Media::each(mu_a, mu_s, g)
            }
            Fog::Each3(columns) => {
                let [a0, a1, a2, s0, s1, s2, g] = parts(columns, range);
                Media::each_coloured([a0, a1, a2], [s0, s1, s2], g)
            }
            Fog::Each4(columns) => {
                let [a0, a1, a2, a3, s0, s1, s2, s3, g] = parts(columns, range);
                Media::each_coloured([a0, a1, a2, a3], [s0, s1, s2, s3], g)
            }
            Fog::Table(table, index) => Media::table(table, &index[range.clone()]),
        }
    }

    /// How many channels the media have.
    pub(crate) fn channels(&self) -> usize {
        match &self.fog {
            Fog::One(medium) => medium.channels(),
            Fog::Each(_) => 1,
            Fog::Each3(_) => 3,
            Fog::Each4(_) => 4,
            Fog::Table(table, _) => table.iter().map(Medium::channels).max().unwrap_or(1),
        }
    }
}

fn parts<'a, const N: usize>(columns: &'a [Vec<f32>; N], range: &Range<usize>) -> [&'a [f32]; N] {
    columns.each_ref().map(|column| &column[range.clone()])
}

/// Everything that a batch may have, as columns.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    /// Origin, direction, `t_min`, `t_max`.
    pub rays: [Vec<f32>; 8],
    /// Position, normal or axis, cosines.
    pub lights: [Vec<f32>; 8],
    /// `mu_a` and `mu_s` of four channels, `g`.
    pub fog: [Vec<f32>; 9],
    /// Variates, as many for each ray.
    pub u: Vec<f32>,
    /// Distances at which densities are asked for, as many as variates.
    pub t: Vec<f32>,
}

impl Columns {
    /// Those that are some, at most 70; at least one.
    #[must_use]
    pub fn emitters(&self) -> Vec<Emitter> {
        let emitter = |i: usize| {
            let [px, py, pz, nx, ny, nz, outer, inner] = self.lights.each_ref().map(|column| column[i]);
            let (position, normal) = ([px, py, pz], [nx, ny, nz]);
            let spot = Emitter::spot(position, normal, outer, inner);
            spot.or(Emitter::point_normal(position, normal)).or(Emitter::point(position)).ok()
        };
        let some: Vec<Emitter> = (0..self.lights[0].len()).filter_map(emitter).take(70).collect();
        if some.is_empty() { Emitter::point([0.0; 3]).into_iter().collect() } else { some }
    }

    /// The valid media among them, of this many channels; at least one.
    fn media(&self, channels: usize) -> Vec<Medium> {
        let of = |values: [f32; 9]| {
            let [a0, a1, a2, a3, s0, s1, s2, s3, g] = values;
            match channels {
                1 => Medium::new(a0, s0, g),
                3 => Medium::coloured([a0, a1, a2], [s0, s1, s2], g),
                _ => Medium::coloured([a0, a1, a2, a3], [s0, s1, s2, s3], g),
            }
        };
        let medium = |i: usize| of(self.fog.each_ref().map(|column| column[i])).ok();
        let some: Vec<Medium> = (0..self.fog[0].len()).filter_map(medium).collect();
        if some.is_empty() { of([0.1; 9]).into_iter().collect() } else { some }
    }

    /// The batch, with emitters and media in one of the [`FORMS`]; `index` draws one below its argument.
    #[must_use]
    pub fn batch(self, form: usize, mut index: impl FnMut(u64) -> u64) -> Batch {
        let [of_lights, of_fog, of_channels] = [form % 4, form / 4 % 4, form / 16 % 3];
        let n = self.rays[0].len();
        // One beyond the end of the table, now and then.
        let mut index = |length: usize| (0..n).map(|_| index(length as u64 + 1) as u32).collect();
        let (emitters, channels) = (self.emitters(), [1, 3, 4][of_channels]);
        let media = self.media(channels);
        let lights = match of_lights {
            0 => Lights::One(emitters[0]),
            1 => Lights::Table(emitters.clone(), index(emitters.len())),
            2 => Lights::EachSpot(self.lights),
            _ => {
                let [px, py, pz, nx, ny, nz, _, _] = self.lights;
                Lights::Each([px, py, pz, nx, ny, nz])
            }
        };
        let [a0, a1, a2, a3, s0, s1, s2, s3, g] = self.fog;
        let fog = match (of_fog, channels) {
            (0, _) => Fog::One(media[0]),
            (1, _) => Fog::Table(media.clone(), index(media.len())),
            (_, 1) => Fog::Each([a0, s0, g]),
            (_, 3) => Fog::Each3([a0, a1, a2, s0, s1, s2, g]),
            _ => Fog::Each4([a0, a1, a2, a3, s0, s1, s2, s3, g]),
        };
        Batch { rays: self.rays, lights, fog, u: self.u, t: self.t }
    }
}

/// How many forms a batch has.
pub const FORMS: usize = 4 * 4 * 3;

/// Adds a row to columns.
pub fn push<const N: usize>(columns: &mut [Vec<f32>; N], row: [f32; N]) {
    for (column, value) in columns.iter_mut().zip(row) {
        column.push(value);
    }
}
