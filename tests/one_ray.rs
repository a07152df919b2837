//! Calls with one ray give the bits of a batch of it; in a coloured medium the distances of its channels, and the light of the mean.

mod scenes;

use airlight::{Emitters, Integral, Media, Medium, Nodes, Rays, Sample, Samples};
use airlight_tools::backends::distinct;
use airlight_tools::samplers;
use core::slice::from_ref;
use scenes::Random;

const SEED: u64 = 21;

#[test]
fn one_ray_is_a_batch_of_one() {
    let mut random = Random::new(SEED);
    let (mut lit, mut dark) = (0, 0);
    for i in 0..16 {
        let case = random.case_or_spot();
        let grey = case.medium;
        let rgb = Medium::coloured([grey.mu_a(), 0.1, 0.3], [grey.mu_s(), 0.0, 0.2], grey.g()).unwrap();
        let medium = if i % 2 == 0 { grey } else { rgb };
        let (origin, direction) = (case.ray.origin(), case.ray.direction());
        let (t_min, t_max) = (case.ray.t_min(), case.ray.t_max());
        let rays = Rays::new(
            origin.each_ref().map(from_ref),
            direction.each_ref().map(from_ref),
            from_ref(&t_min),
            from_ref(&t_max),
        );
        let (emitters, media, mean) = (Emitters::one(case.emitter), Media::one(medium), Media::one(medium.mean()));
        let (u, given) = (random.uniform(), t_min + random.between(0.0, 5.0));
        for sampler in distinct().flat_map(|backend| samplers::all().map(move |sampler| sampler.with_backend(backend)))
        {
            let place = format!("{sampler:?}, seed {SEED}, {case:?}, {medium:?}");
            let [mut t, mut pdf, mut r, mut density, mut cdf, mut f, mut radiance] = [[f32::NAN]; 7];
            let mut samples = Samples::new(&mut t, &mut pdf).r(&mut r);
            let counts = sampler.sample(&rays, &emitters, &media, &[u], &mut samples).unwrap();
            let alone = sampler.sample_one(&case.ray, &case.emitter, &medium, u);
            assert_eq!(alone.is_some(), counts.sampled == 1, "{place}");
            lit += counts.sampled;
            dark += counts.empty;
            if let Some(Sample { t: t_alone, pdf: pdf_alone, weight, r: r_alone, .. }) = alone {
                assert_eq!([t_alone, pdf_alone, r_alone], [t[0], pdf[0], r[0]], "{place}");
                let at_t = f64::from(sampler.evaluate_one(&case.ray, &case.emitter, &medium, t_alone));
                let error = f64::from(weight) * f64::from(pdf_alone) - at_t;
                assert!(error.abs() <= 1e-3 * at_t, "{place}: {weight} {pdf_alone} is not {at_t}");
            }

            sampler.pdf(&rays, &emitters, &media, &[given], &mut density).unwrap();
            sampler.cdf(&rays, &emitters, &media, &[given], &mut cdf).unwrap();
            sampler.evaluate(&rays, &emitters, &mean, &[given], &mut f).unwrap();
            let integral =
                Integral::new(Nodes::Six).with_precision(sampler.precision()).with_backend(sampler.backend());
            integral.radiance(&rays, &emitters, &mean, &mut radiance).unwrap();
            let alone = [
                sampler.pdf_one(&case.ray, &case.emitter, &medium, given),
                sampler.cdf_one(&case.ray, &case.emitter, &medium, given),
                sampler.evaluate_one(&case.ray, &case.emitter, &medium, given),
                integral.radiance_one(&case.ray, &case.emitter, &medium),
            ];
            assert_eq!(alone, [density[0], cdf[0], f[0], radiance[0]], "{place}");
        }
    }
    assert!(lit > 100 && dark > 20, "{lit} rays are lit, {dark} dark");
}
