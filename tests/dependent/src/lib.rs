//! Everything that can be asked of airlight, on little stack.

use airlight::{Emitter, Emitters, Integral, Media, Medium, Nodes, Ray, Rays, Sampler, Samples};

/// The README's example is a test of the documentation.
#[doc = include_str!("../../../README.md")]
pub struct Readme;

/// More than a chunk of rays, so that threads are used, and no multiple of any number of lanes.
const RAYS: usize = 20_003;
const VARIATES: usize = 3;
/// A few rays, whose variates fill the lanes.
const FEW: [(usize, usize); 3] = [(1, 5000), (5, 33), (40, 7)];

/// Columns of random rays, a few of them bad.
pub struct Columns([Vec<f32>; 18]);

impl Default for Columns {
    fn default() -> Self {
        Self::new()
    }
}

impl Columns {
    /// The same ones at every call.
    #[must_use]
    pub fn new() -> Self {
        let mut state = 1u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / 16_777_216.0
        };
        let mut columns = Self([(); 18].map(|()| Vec::new()));
        for i in 0..RAYS {
            let mut point = || [(); 3].map(|()| uniform() * 10.0 - 5.0);
            let (origin, direction, position, normal) = (point(), unit(point()), point(), unit(point()));
            let normal = if i % 7 == 0 { [0.0; 3] } else { normal };
            let direction = if i % 501 == 0 { [f32::NAN; 3] } else { direction };
            let (t_min, length) = (uniform(), 9.0 * uniform());
            let t_max = if i % 11 == 0 { f32::INFINITY } else { t_min + length };
            let medium = [uniform(), uniform(), 2.0 * uniform() - 1.0];
            let row = [origin, direction, position, normal]
                .into_iter()
                .flatten()
                .chain([t_min, t_max])
                .chain(medium)
                .chain([uniform()]);
            for (column, value) in columns.0.iter_mut().zip(row) {
                column.push(value);
            }
        }
        columns
    }

    fn three(&self, first: usize, rays: usize) -> [&[f32]; 3] {
        [0, 1, 2].map(|k| &self.0[first + k][..rays])
    }

    fn rays(&self, rays: usize) -> Rays<'_> {
        let [t_min, t_max] = [12, 13].map(|k| &self.0[k][..rays]);
        Rays::new(self.three(0, rays), self.three(3, rays), t_min, t_max)
    }

    fn emitters(&self, rays: usize) -> Emitters<'_> {
        Emitters::each(self.three(6, rays), self.three(9, rays))
    }

    fn media(&self, rays: usize) -> Media<'_> {
        let [mu_a, mu_s, g] = self.three(14, rays);
        Media::each(mu_a, mu_s, g)
    }

    /// A variate for each ray, or several.
    fn variates(&self, count: usize) -> Vec<f32> {
        self.0[17].iter().cycle().take(count).copied().collect()
    }
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
    v.map(|x| x / length)
}

/// A hash of bits, FNV-1a.
struct Hash(u64);

impl Hash {
    fn add(&mut self, values: &[f32]) {
        for byte in values.iter().flat_map(|value| value.to_bits().to_le_bytes()) {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

/// The hash of all that a sampler gives, and of the integrals on its backend: samples with and without weights, of one and of several variates,
/// densities, distribution functions, integrands, radiances, and one ray by itself.
///
/// # Errors
/// None: the columns have one length.
pub fn everything(columns: &Columns, sampler: &Sampler) -> Result<u64, airlight::Error> {
    let mut hash = Hash(0xcbf2_9ce4_8422_2325);
    for (rays, per_ray) in [(RAYS, 1), (RAYS, VARIATES)].into_iter().chain(FEW) {
        let u = columns.variates(rays * per_ray);
        let (emitters, media) = (columns.emitters(rays), columns.media(rays));
        let rays = columns.rays(rays);
        let [mut t, mut pdf, mut weight, mut r] = [(); 4].map(|()| vec![0.0; u.len()]);
        let mut samples = Samples::new(&mut t, &mut pdf);
        let counts = sampler.sample(&rays, &emitters, &media, &u, &mut samples)?;
        hash.add(&t);
        hash.add(&pdf);
        let mut samples = Samples::new(&mut t, &mut pdf).weight(&mut weight).r(&mut r);
        let again = sampler.sample(&rays, &emitters, &media, &u, &mut samples)?;
        assert_eq!(counts, again);
        for column in [&t, &pdf, &weight, &r] {
            hash.add(column);
        }
        let mut out = vec![0.0; u.len()];
        sampler.pdf(&rays, &emitters, &media, &t, &mut out)?;
        hash.add(&out);
        sampler.cdf(&rays, &emitters, &media, &t, &mut out)?;
        hash.add(&out);
        sampler.evaluate(&rays, &emitters, &media, &t, &mut out)?;
        hash.add(&out);
        for &nodes in Nodes::ALL {
            let mut out = vec![0.0; u.len() / per_ray];
            Integral::new(nodes).with_backend(sampler.backend()).radiance(&rays, &emitters, &media, &mut out)?;
            hash.add(&out);
        }
    }
    hash.add(&one(sampler)?);
    Ok(hash.0)
}

/// One ray by itself: `t`, `pdf`, weight, `r`, the density and the integrand.
///
/// # Errors
/// None.
pub fn one(sampler: &Sampler) -> Result<[f32; 6], airlight::Error> {
    let ray = Ray::new([0.0; 3], [0.0, 0.0, 1.0], 0.0, 4.0)?;
    let lamp = Emitter::point_normal([0.0, 1.0, 3.0], [0.0, -1.0, 0.0])?;
    let fog = Medium::new(0.01, 0.1, 0.6)?;
    let sample = sampler.sample_one(&ray, &lamp, &fog, 0.25).expect("a lit ray");
    let pdf = sampler.pdf_one(&ray, &lamp, &fog, sample.t);
    let integrand = sampler.evaluate_one(&ray, &lamp, &fog, sample.t);
    Ok([sample.t, sample.pdf, sample.weight, sample.r, pdf, integrand])
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::Strategy;

    /// Threads of tests have a quarter of the main thread's stack.
    #[test]
    fn one_ray_of_every_strategy() {
        for &strategy in Strategy::ALL {
            let [t, pdf, weight, r, pdf_at_t, integrand] = one(&Sampler::new(strategy)).unwrap();
            assert!(0.0 < t && t < 4.0 && pdf > 0.0 && r >= 1.0, "{strategy}");
            assert!((pdf_at_t / pdf - 1.0).abs() < 1e-5, "{strategy}: {pdf_at_t} is not {pdf}");
            assert!((weight * pdf / integrand - 1.0).abs() < 1e-5, "{strategy}: {weight} {pdf} {integrand}");
        }
    }
}
