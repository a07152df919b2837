//! What is sampled where speed is measured.

use crate::column::Column;
use crate::draw::Draw;
use airlight::{Counts, Emitter, Emitters, Error, Media, Medium, Ray, Rays, Sampler, Samples};
use glam::Vec3;

/// The emitter's position and normal.
pub const EMITTER: [Vec3; 2] = [Vec3::ZERO, Vec3::new(0.6, 0.64, -0.48)];
/// `mu_a`, `mu_s` and `g` of the medium.
pub const MEDIUM: [f32; 3] = [0.5, 0.2, 0.6];

/// Rays in a box of side 10 around the one emitter, 1 to 20 long, in all directions, and variates for them.
#[derive(Debug)]
pub struct Workload {
    /// Origin and direction, `t_min`, `t_max`.
    rays: [Column; 8],
    u: Column,
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

/// The emitter of all rays.
#[must_use]
pub fn emitter() -> Emitter {
    let [position, normal] = EMITTER;
    Emitter::point_normal(position, normal).expect("a unit normal")
}

/// The medium of all rays.
#[must_use]
pub fn medium() -> Medium {
    let [mu_a, mu_s, g] = MEDIUM;
    Medium::new(mu_a, mu_s, g).expect("a medium")
}

/// Emitters in the same box, for a choice among them.
#[must_use]
pub fn emitters(count: usize) -> Vec<Emitter> {
    let mut draw = Draw::new(0, 72, 0);
    let mut emitter = || {
        let position = [(); 3].map(|()| draw.between(-5.0, 5.0));
        Emitter::point_normal(position, draw.direction()).expect("a unit normal")
    };
    (0..count).map(|_| emitter()).collect()
}

impl Workload {
    /// Up to `n` rays, and a variate for each.
    #[must_use]
    pub fn new(n: usize) -> Self {
        Self::with_variates(n, n)
    }

    /// Up to `n` rays, and up to `samples` variates and samples, which are no fewer.
    #[must_use]
    pub fn with_variates(n: usize, samples: usize) -> Self {
        let samples = samples.max(n);
        let mut draw = Draw::new(0, 71, 0);
        let mut rays: [Column; 8] = std::array::from_fn(|index| Column::new(index, n));
        let mut u = Column::new(rays.len(), samples);
        for i in 0..n {
            let origin = [(); 3].map(|()| draw.between(-5.0, 5.0));
            let [ox, oy, oz] = origin;
            let [dx, dy, dz] = draw.direction().to_array();
            let row = [ox, oy, oz, dx, dy, dz, 0.0, draw.between(1.0, 20.0)];
            for (column, value) in rays.iter_mut().zip(row) {
                column.of_mut(n)[i] = value;
            }
            u.of_mut(n)[i] = draw.uniform();
        }
        u.of_mut(samples)[n..].fill_with(|| draw.uniform());
        let outputs = std::array::from_fn(|index| Column::new(rays.len() + 1 + index, samples));
        Self { rays, u, outputs }
    }

    /// A call that draws `per_ray` samples for each of `rays` rays.
    ///
    /// # Panics
    /// If that is more than there are.
    #[must_use]
    pub fn call(&mut self, rays: usize, per_ray: usize, wanted: Wanted) -> Call<'_> {
        let samples = rays * per_ray;
        let [ox, oy, oz, dx, dy, dz, t_min, t_max] = self.rays.each_ref().map(|column| column.of(rays));
        let [t, pdf, weight, r] = self.outputs.each_mut().map(|column| column.of_mut(samples));
        let all = wanted == Wanted::Weights;
        let densities = Samples::new(t, pdf);
        Call {
            rays: Rays::new([ox, oy, oz], [dx, dy, dz], t_min, t_max),
            emitters: Emitters::one(emitter()),
            media: Media::one(medium()),
            u: self.u.of(samples),
            samples: if all { densities.weight(weight).r(r) } else { densities },
        }
    }

    /// The first `n` rays one by one, each with its variate.
    ///
    /// # Panics
    /// If that is more than there are.
    #[must_use]
    pub fn one_by_one(&self, n: usize) -> Vec<(Ray, f32)> {
        let ray = |i: usize| {
            let [ox, oy, oz, dx, dy, dz, t_min, t_max] = self.rays.each_ref().map(|column| column.of(n)[i]);
            let ray = Ray::new(Vec3::new(ox, oy, oz), Vec3::new(dx, dy, dz), t_min, t_max);
            (ray.expect("a unit direction"), self.u.of(n)[i])
        };
        (0..n).map(ray).collect()
    }
}

impl Call<'_> {
    /// The call for `count` rays from the one with the index `first` on, of a call with one sample for each; it writes `t`
    /// and `pdf`.
    ///
    /// # Panics
    /// If there are not so many.
    pub fn part(&mut self, first: usize, count: usize) -> Call<'_> {
        let range = first..first + count;
        let Rays { origin, direction, t_min, t_max, .. } = self.rays;
        let [origin, direction] = [origin, direction].map(|columns| columns.map(|column| &column[range.clone()]));
        let Samples { t, pdf, .. } = &mut self.samples;
        Call {
            rays: Rays::new(origin, direction, &t_min[range.clone()], &t_max[range.clone()]),
            emitters: self.emitters,
            media: self.media,
            u: &self.u[range.clone()],
            samples: Samples::new(&mut t[range.clone()], &mut pdf[range.clone()]),
        }
    }

    /// Draws the samples.
    ///
    /// # Errors
    /// As [`Sampler::sample`], none as it comes from a workload.
    pub fn sample(&mut self, sampler: &Sampler) -> Result<Counts, Error> {
        sampler.sample(&self.rays, &self.emitters, &self.media, self.u, &mut self.samples)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::Strategy;

    #[test]
    fn variates_beyond_those_of_the_rays_change_none_of_these() {
        let (mut few, mut many) = (Workload::new(100), Workload::with_variates(100, 300));
        let (few, many_each) = (few.call(100, 1, Wanted::Densities), many.call(100, 1, Wanted::Densities));
        assert_eq!((few.u, few.rays.t_max), (many_each.u, many_each.rays.t_max));
        let u = many.call(100, 3, Wanted::Densities).u.to_vec();
        assert!(u.len() == 300 && u.iter().all(|u| (0.0..1.0).contains(u)));
        // Drawn, not left at 0.
        assert!(u[100..].iter().filter(|u| **u > 0.5).count() > 60);
    }

    #[test]
    fn calls_of_parts_and_single_rays_draw_what_the_whole_does() {
        const RAYS: usize = 99;
        let sampler = Sampler::new(Strategy::Product9);
        let mut workload = Workload::new(RAYS);
        let single: Vec<(f32, f32)> = workload
            .one_by_one(RAYS)
            .into_iter()
            .map(|(ray, u)| sampler.sample_one(&ray, &emitter(), &medium(), u).map_or((0.0, 0.0), |s| (s.t, s.pdf)))
            .collect();
        let mut call = workload.call(RAYS, 1, Wanted::Densities);
        call.sample(&sampler).unwrap();
        let whole: Vec<(f32, f32)> = call.samples.t.iter().copied().zip(call.samples.pdf.iter().copied()).collect();
        assert_eq!(whole, single);
        call.samples.t.fill(f32::NAN);
        for first in (0..RAYS).step_by(33) {
            call.part(first, 33).sample(&sampler).unwrap();
        }
        assert!(call.samples.t.iter().zip(&whole).all(|(t, (expected, _))| t == expected));
    }
}
