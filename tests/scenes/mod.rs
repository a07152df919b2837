//! Random rays, emitters and media: as columns for the sampler, one by one for the oracle.

#![allow(dead_code, reason = "every test file uses its own part")]

use airlight::oracle::Scene;
use airlight::{Counts, Emitter, Emitters, Media, Medium, Ray, Rays, Sampler, Samples};
use glam::Vec3;
use std::fmt;
use std::ops::Range;

/// A counter-based generator: the numbers of a seed are the hashes of 1, 2, 3, ...
pub(crate) struct Random {
    seed: u64,
    counter: u64,
}

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self { seed, counter: 0 }
    }

    /// 64 random bits, by the finaliser of SplitMix64.
    pub(crate) fn bits(&mut self) -> u64 {
        self.counter += 1;
        let z = self.seed.wrapping_add(self.counter.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A multiple of 2^-24 in `[0, 1)`.
    pub(crate) fn uniform(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / 16_777_216.0
    }

    pub(crate) fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.uniform()
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    pub(crate) fn unit(&mut self) -> Vec3 {
        let (z, phi) = (self.between(-1.0, 1.0), self.between(0.0, std::f32::consts::TAU));
        let s = (1.0 - z * z).sqrt();
        Vec3::new(s * phi.cos(), s * phi.sin(), z)
    }

    /// A point in the cube of side 10 around the origin.
    pub(crate) fn point(&mut self) -> Vec3 {
        Vec3::new(self.between(-5.0, 5.0), self.between(-5.0, 5.0), self.between(-5.0, 5.0))
    }

    /// A case of a middling room: `h` of metres, rays of metres or without end, any emitter, thin and dense media.
    pub(crate) fn case(&mut self) -> Case {
        let t_min = [0.0, self.between(0.0, 3.0)][self.below(2)];
        let length = [self.between(1.0, 20.0), f32::INFINITY][self.below(2)];
        let ray = Ray::new(self.point(), self.unit(), t_min, t_min + length).unwrap();
        let (position, normal) = (self.point(), self.unit());
        let emitter = match self.below(2) {
            0 => Emitter::point(position),
            _ => Emitter::point_normal(position, normal),
        };
        let (mu_t, albedo) = ([0.01, 0.2, 3.0][self.below(3)], self.between(0.1, 1.0));
        let g = [0.0, 0.9, -0.6][self.below(3)];
        let medium = Medium::new((1.0 - albedo) * mu_t, albedo * mu_t, g);
        Case { ray, emitter: emitter.unwrap(), medium: medium.unwrap() }
    }

    /// The same, or with a spot in place of the emitter: any axis, half-angles of 2 to 90 degrees, edges from hard to soft.
    pub(crate) fn case_or_spot(&mut self) -> Case {
        let case = self.case();
        if self.below(2) == 0 { case } else { Case { emitter: self.spot(), ..case } }
    }

    /// A spot of that room.
    pub(crate) fn spot(&mut self) -> Emitter {
        let outer = self.between(2.0, 90.0).to_radians().cos().max(0.0);
        let inner = (outer + (1.0 - outer) * [0.0, self.uniform(), 1.0][self.below(3)]).min(1.0);
        Emitter::spot(self.point(), self.unit(), outer, inner).unwrap()
    }
}

/// One ray, one emitter, one medium.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub(crate) ray: Ray,
    pub(crate) emitter: Emitter,
    pub(crate) medium: Medium,
}

impl Case {
    pub(crate) fn oracle(&self) -> Scene {
        Scene::new(&self.ray, &self.emitter, &self.medium)
    }
}

/// The columns of a call, in the order of [`Columns::FIELDS`]; the last one is what is given: variates or distances. The
/// cosines of an emitter without a cone are -1.
#[derive(Clone)]
pub(crate) struct Columns(pub(crate) [Vec<f32>; 20]);

impl Columns {
    pub(crate) const FIELDS: [&str; 20] = [
        "rays.origin[0]",
        "rays.origin[1]",
        "rays.origin[2]",
        "rays.direction[0]",
        "rays.direction[1]",
        "rays.direction[2]",
        "rays.t_min",
        "rays.t_max",
        "emitters.position[0]",
        "emitters.position[1]",
        "emitters.position[2]",
        "emitters.normal[0]",
        "emitters.normal[1]",
        "emitters.normal[2]",
        "media.mu_a",
        "media.mu_s",
        "media.g",
        "emitters.cos_outer",
        "emitters.cos_inner",
        "u",
    ];
    pub(crate) const CONES: [usize; 2] = [17, 18];
    pub(crate) const GIVEN: usize = 19;

    /// The index of a field.
    pub(crate) fn index(field: &str) -> usize {
        Self::FIELDS.iter().position(|f| *f == field).unwrap()
    }

    pub(crate) fn new(rows: impl IntoIterator<Item = (Case, f32)>) -> Self {
        let mut columns = Self(Default::default());
        for (case, given) in rows {
            columns.push(&case, given);
        }
        columns
    }

    /// `n` random cases, each with a random variate.
    pub(crate) fn random(random: &mut Random, n: usize) -> Self {
        Self::new((0..n).map(|_| (random.case(), random.uniform())))
    }

    /// The same with spots among the emitters.
    pub(crate) fn with_spots(random: &mut Random, n: usize) -> Self {
        Self::new((0..n).map(|_| (random.case_or_spot(), random.uniform())))
    }

    /// One case with many variates or distances.
    pub(crate) fn repeat(case: &Case, given: Vec<f32>) -> Self {
        let mut one = Self::new([(*case, 0.0)]);
        for column in &mut one.0 {
            *column = vec![column[0]; given.len()];
        }
        one.0[Self::GIVEN] = given;
        one
    }

    fn push(&mut self, case: &Case, given: f32) {
        let Case { ray, emitter, medium } = case;
        let cone = emitter.cone();
        let normal = emitter.normal().or(cone.map(|cone| cone.axis())).unwrap_or_default();
        let row = [ray.origin(), ray.direction()].into_iter().flatten();
        let row = row.chain([ray.t_min(), ray.t_max()]);
        let row = row.chain(emitter.position()).chain(normal);
        let row = row.chain([medium.mu_a(), medium.mu_s(), medium.g()]);
        let cosines = cone.map_or([-1.0; 2], |cone| [cone.cos_outer(), cone.cos_inner()]);
        let row = row.chain(cosines).chain([given]);
        for (column, value) in self.0.iter_mut().zip(row) {
            column.push(value);
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.0[0].len()
    }

    /// The rows `order`, in that order.
    pub(crate) fn gather(&self, order: &[usize]) -> Self {
        Self(std::array::from_fn(|k| order.iter().map(|&i| self.0[k][i]).collect()))
    }

    pub(crate) fn given(&self) -> &[f32] {
        &self.0[Self::GIVEN]
    }

    pub(crate) fn rays(&self, range: Range<usize>) -> Rays<'_> {
        Rays::new(self.three(0, &range), self.three(3, &range), &self.0[6][range.clone()], &self.0[7][range])
    }

    /// In columns without cones where none of the range has one.
    pub(crate) fn emitters(&self, range: Range<usize>) -> Emitters<'_> {
        let (position, axis) = (self.three(8, &range), self.three(11, &range));
        let [cos_outer, cos_inner] = Self::CONES.map(|k| &self.0[k][range.clone()]);
        if cos_outer.iter().chain(cos_inner).all(|cosine| *cosine == -1.0) {
            Emitters::each(position, axis)
        } else {
            Emitters::each_spot(position, axis, cos_outer, cos_inner)
        }
    }

    pub(crate) fn media(&self, range: Range<usize>) -> Media<'_> {
        let [mu_a, mu_s, g] = self.three(14, &range);
        Media::each(mu_a, mu_s, g)
    }

    fn three(&self, first: usize, range: &Range<usize>) -> [&[f32]; 3] {
        [0, 1, 2].map(|k| &self.0[first + k][range.clone()])
    }

    /// The samples of all rows, their last column as variates.
    pub(crate) fn sample(&self, sampler: &Sampler) -> Drawn {
        self.sample_range(sampler, 0..self.len())
    }

    pub(crate) fn sample_range(&self, sampler: &Sampler, range: Range<usize>) -> Drawn {
        let mut drawn = Drawn::new(range.len());
        let (rays, u) = (self.rays(range.clone()), &self.given()[range.clone()]);
        let (emitters, media) = (self.emitters(range.clone()), self.media(range));
        drawn.counts = sampler.sample(&rays, &emitters, &media, u, &mut drawn.samples()).unwrap();
        drawn
    }

    /// The densities of all rows, their last column as distances.
    pub(crate) fn pdf(&self, sampler: &Sampler) -> Vec<f32> {
        let (all, mut pdf) = (0..self.len(), vec![f32::NAN; self.len()]);
        let (rays, emitters, media) = (self.rays(all.clone()), self.emitters(all.clone()), self.media(all));
        sampler.pdf(&rays, &emitters, &media, self.given(), &mut pdf).unwrap();
        pdf
    }

    /// The integrands of all rows, their last column as distances.
    pub(crate) fn evaluate(&self, sampler: &Sampler) -> Vec<f32> {
        let (all, mut integrand) = (0..self.len(), vec![f32::NAN; self.len()]);
        let (rays, emitters, media) = (self.rays(all.clone()), self.emitters(all.clone()), self.media(all));
        sampler.evaluate(&rays, &emitters, &media, self.given(), &mut integrand).unwrap();
        integrand
    }
}

/// What a call wrote, and what it returned.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Drawn {
    pub(crate) t: Vec<f32>,
    pub(crate) pdf: Vec<f32>,
    pub(crate) weight: Vec<f32>,
    pub(crate) r: Vec<f32>,
    pub(crate) counts: Counts,
}

impl Drawn {
    /// Outputs that hold what no call writes.
    pub(crate) fn new(n: usize) -> Self {
        let column = || vec![f32::NAN; n];
        Self { t: column(), pdf: column(), weight: column(), r: column(), counts: Counts::default() }
    }

    pub(crate) fn samples(&mut self) -> Samples<'_> {
        Samples::new(&mut self.t, &mut self.pdf).weight(&mut self.weight).r(&mut self.r)
    }

    /// `t`, `pdf`, `weight` and `r` of a ray.
    pub(crate) fn row(&self, i: usize) -> [f32; 4] {
        [self.t[i], self.pdf[i], self.weight[i], self.r[i]]
    }

    /// The same to the bit.
    pub(crate) fn bits(&self, i: usize) -> [u32; 4] {
        self.row(i).map(f32::to_bits)
    }
}

/// The columns of one row, as a failure shows them.
pub(crate) struct Row<'a>(pub(crate) &'a Columns, pub(crate) usize);

impl fmt::Display for Row<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (name, column) in Columns::FIELDS.iter().zip(&self.0.0) {
            let value = column[self.1];
            write!(f, "\n  {name} = {value:e} ({:#010x})", value.to_bits())?;
        }
        Ok(())
    }
}

/// The distance from `t` to the next larger value.
pub(crate) fn ulp(t: f32) -> f64 {
    f64::from(t.abs().next_up()) - f64::from(t.abs())
}
