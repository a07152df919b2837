//! What is sampled where speed is measured.

use crate::column::Column;
use crate::draw::Draw;
use airlight::{Counts, Emitter, Emitters, Error, Media, Medium, Rays, Sampler, Samples};
use glam::Vec3;

/// The emitter's position and normal.
pub const EMITTER: [Vec3; 2] = [Vec3::ZERO, Vec3::new(0.6, 0.64, -0.48)];
/// `mu_a`, `mu_s` and `g` of the medium.
pub const MEDIUM: [f32; 3] = [0.5, 0.2, 0.6];

/// Rays in a box of side 10 around the one emitter, 1 to 20 long, in all directions, and a variate for each.
#[derive(Debug)]
pub struct Workload {
    /// Origin and direction, `t_min`, `t_max`, `u`.
    inputs: [Column; 9],
    /// `t`, `pdf`, `weight`, `r`.
    outputs: [Column; 4],
}

/// Which columns are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// `t` and `pdf`.
    Densities,
    /// `weight` and `r` as well.
    Weights,
}

/// A call's arguments, out of a workload.
#[derive(Debug)]
pub struct Call<'a> {
    /// The first rays.
    pub rays: Rays<'a>,
    /// The emitter of all of them.
    pub emitters: Emitters<'static>,
    /// And the medium.
    pub media: Media<'static>,
    /// As many variates for each ray as were asked for.
    pub u: &'a [f32],
    /// Where samples are written.
    pub samples: Samples<'a>,
}

impl Workload {
    /// Up to `n` rays.
    #[must_use]
    pub fn new(n: usize) -> Self {
        let mut draw = Draw::new(0, 71, 0);
        let mut inputs: [Column; 9] = std::array::from_fn(|index| Column::new(index, n));
        for i in 0..n {
            let origin = [(); 3].map(|()| draw.between(-5.0, 5.0));
            let [ox, oy, oz] = origin;
            let [dx, dy, dz] = draw.direction().to_array();
            let row = [ox, oy, oz, dx, dy, dz, 0.0, draw.between(1.0, 20.0), draw.uniform()];
            for (column, value) in inputs.iter_mut().zip(row) {
                column.of_mut(n)[i] = value;
            }
        }
        let outputs = std::array::from_fn(|index| Column::new(inputs.len() + index, n));
        Self { inputs, outputs }
    }

    /// A call that draws `per_ray` samples for each of `rays` rays.
    ///
    /// # Panics
    /// If that is more than there are.
    #[must_use]
    pub fn call(&mut self, rays: usize, per_ray: usize, wanted: Wanted) -> Call<'_> {
        let samples = rays * per_ray;
        let [ox, oy, oz, dx, dy, dz, t_min, t_max, _] = self.inputs.each_ref().map(|column| column.of(rays));
        let [t, pdf, weight, r] = self.outputs.each_mut().map(|column| column.of_mut(samples));
        let all = wanted == Wanted::Weights;
        let [position, normal] = EMITTER;
        let [mu_a, mu_s, g] = MEDIUM;
        Call {
            rays: Rays { origin: [ox, oy, oz], direction: [dx, dy, dz], t_min, t_max },
            emitters: Emitters::One(Emitter::point_normal(position, normal).expect("a unit normal")),
            media: Media::One(Medium::new(mu_a, mu_s, g).expect("a medium")),
            u: self.inputs[8].of(samples),
            samples: Samples { t, pdf, weight: all.then_some(weight), r: all.then_some(r) },
        }
    }
}

impl Call<'_> {
    /// Draws the samples.
    ///
    /// # Errors
    /// As [`Sampler::sample`], none as it comes from a workload.
    pub fn sample(&mut self, sampler: &Sampler) -> Result<Counts, Error> {
        sampler.sample(&self.rays, &self.emitters, &self.media, self.u, &mut self.samples)
    }
}
