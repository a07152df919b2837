//! Whatever the valid scene: what comes out is finite and in range, every ray is counted once and rightly, a lit ray has
//! a sample, and one ray alone gives the bits that it gives in a batch.

mod scenes;

use airlight::{Emitter, Medium, Ray, Sampler};
use glam::Vec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use scenes::{Case, Columns, Row, ulp};

/// A failure prints the smallest batch that fails; the seed is fixed.
fn config() -> ProptestConfig {
    ProptestConfig { cases: 16384, failure_persistence: None, rng_seed: RngSeed::Fixed(3), ..ProptestConfig::default() }
}

/// Ten to a power from `range`.
fn decades(range: std::ops::Range<f32>) -> impl Strategy<Value = f32> {
    range.prop_map(|e| 10f32.powf(e))
}

/// A vector of length 1, give or take what is tolerated.
fn unit() -> impl Strategy<Value = Vec3> {
    let length = prop_oneof![3 => Just(1.0f32), 1 => 0.9992f32..1.0008];
    let direction = (-1f32..=1.0, 0f32..std::f32::consts::TAU).prop_map(|(z, phi)| {
        let s = (1.0 - z * z).sqrt();
        Vec3::new(s * phi.cos(), s * phi.sin(), z)
    });
    let axis = prop::sample::select(vec![Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z]);
    (prop_oneof![3 => direction, 1 => axis], length).prop_map(|(v, length)| v * length)
}

fn medium() -> impl Strategy<Value = Medium> {
    let mu_t = prop_oneof![4 => decades(-6.0..3.0), 1 => Just(0.0f32), 1 => decades(-38.0..-6.0)];
    let albedo = prop_oneof![3 => 0f32..=1.0, 1 => Just(0.0f32), 1 => Just(1.0f32)];
    let g = prop_oneof![
        4 => -1f32..=1.0,
        1 => prop::sample::select(vec![0.0f32, -0.0, 1e-8, -1e-8, 0.999, -0.999, 1.0, -1.0]),
    ];
    (mu_t, albedo, g).prop_map(|(mu_t, albedo, g)| Medium::new((1.0 - albedo) * mu_t, albedo * mu_t, g).unwrap())
}

/// `h` from 1 um to 1 km or 0, the emitter anywhere along the ray or far behind it, an interval of any length.
fn case() -> impl Strategy<Value = Case> {
    let h = prop_oneof![6 => decades(-6.0..3.0), 1 => Just(0.0f32)];
    let along = prop_oneof![3 => -10f32..10.0, 1 => -1e4f32..1e4, 1 => Just(0.0f32)];
    let origin =
        prop_oneof![2 => Just(Vec3::ZERO), 2 => [-10f32..10.0, -10f32..10.0, -10f32..10.0].prop_map(Vec3::from)];
    let t_min = prop_oneof![3 => Just(0.0f32), 2 => 0f32..10.0, 1 => decades(1.0..6.0)];
    let length =
        prop_oneof![4 => decades(-3.0..4.0), 1 => decades(-9.0..-3.0), 2 => Just(f32::INFINITY), 1 => Just(0.0f32)];
    let place = (origin, unit(), unit(), h, along, t_min, length);
    let normal = prop_oneof![1 => Just(None), 2 => unit().prop_map(Some)];
    (place, normal, medium()).prop_filter_map("the normal is out of tolerance", |(place, normal, medium)| {
        let (origin, direction, side, h, along, t_min, length) = place;
        let ray = Ray::new(origin, direction, t_min, t_min + length).ok()?;
        let aside = direction.cross(side).normalize_or_zero() * h;
        let position = origin + along * direction + aside;
        let emitter = match normal {
            None => Emitter::point(position),
            Some(normal) => Emitter::point_normal(position, normal),
        };
        Some(Case { ray, emitter: emitter.ok()?, medium })
    })
}

fn variate() -> impl Strategy<Value = f32> {
    let least = 2f32.powi(-24);
    prop_oneof![4 => 0f32..=1.0, 1 => prop::sample::select(vec![0.0, least, 0.5, 1.0 - least, 1.0])]
}

/// Whether a ray has a sample, by the oracle; `None` where f32 may see it either way: an interval that subtends some
/// 1e-30 rad, is 1e-36 of `r^2` or has 1e-25 of the light, and one so dark that a rounding of `N` decides.
fn is_lit(case: &Case) -> Option<bool> {
    let scene = case.oracle();
    let Some((t_a, t_b)) = scene.lit() else {
        let (t_min, t_max) = scene.interval();
        let n = |t: f64| scene.alpha() * scene.h() / scene.r(t) + scene.beta() * (t - scene.t_h()) / scene.r(t);
        let brightest = n(t_min).max(n(t_max));
        return (t_min == t_max || brightest < -1e-15).then_some(false);
    };
    let (length, angle, r_squared) = (t_b - t_a, scene.angle(t_a, t_b), scene.r(t_a) * scene.r(t_b));
    let n = scene.cosine(t_a).max(scene.cosine(t_b));
    let bright = n > 1e-15 && angle * n > 1e-24;
    (bright && length > 1e-17 && angle > 1e-28 && length > 1e-35 * r_squared).then_some(true)
}

/// Whether a density is less than f32 can hold as near to `t` as rounding moves it: far out, or where the light ends.
fn may_vanish(case: &Case, strategy: airlight::Strategy, t: f32, r: f32) -> bool {
    let (scene, reach) = (case.oracle(), 2.0 * ulp(t.max(r)));
    [-1.0, 0.0, 1.0].into_iter().any(|k| scene.pdf(strategy, f64::from(t) + k * reach) < 1e-37)
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn samples_are_in_range(rows in prop::collection::vec((case(), variate()), 1..20)) {
        let columns = Columns::new(rows.clone());
        for &strategy in airlight::Strategy::ALL {
            let sampler = Sampler::new(strategy);
            let drawn = columns.sample(&sampler);
            let counts = drawn.counts;
            prop_assert_eq!(counts.sampled + counts.empty + counts.invalid, rows.len());
            prop_assert_eq!(counts.invalid, 0);
            prop_assert!(counts.bisected <= counts.sampled);

            let mut sampled = 0;
            for (i, (case, u)) in rows.iter().enumerate() {
                let row @ [t, pdf, weight, r] = drawn.row(i);
                let place = || format!("{strategy}: {row:?} of{}", Row(&columns, i));
                prop_assert!(row.iter().all(|x| x.is_finite() && *x >= 0.0), "{}", place());
                let one = sampler.sample_one(&case.ray, &case.emitter, &case.medium, *u);
                if let Some(lit) = is_lit(case) {
                    prop_assert_eq!(one.is_some(), lit, "{}", place());
                }
                match one {
                    Some(one) => {
                        prop_assert!(pdf > 0.0 || may_vanish(case, strategy, t, r), "{}", place());
                        sampled += 1;
                        prop_assert!((case.ray.t_min()..=case.ray.t_max()).contains(&t), "{}", place());
                        prop_assert!(r > 0.0, "{}", place());
                        let bits = [one.t, one.pdf, one.weight, one.r].map(f32::to_bits);
                        prop_assert_eq!(bits, drawn.bits(i), "alone {:?}, {}", one, place());
                    }
                    None => prop_assert_eq!([t, pdf, weight, r], [0.0; 4], "{}", place()),
                }
            }
            prop_assert_eq!(sampled, counts.sampled, "{}", strategy);
        }
    }

    #[test]
    fn densities_and_integrands_are_in_range(
        rows in prop::collection::vec((case(), prop_oneof![decades(-9.0..18.0), 0f32..20.0, Just(0f32)]), 1..20),
    ) {
        let columns = Columns::new(rows.clone());
        for &strategy in airlight::Strategy::ALL {
            let sampler = Sampler::new(strategy);
            let (pdf, integrand) = (columns.pdf(&sampler), columns.evaluate(&sampler));
            for (i, (case, t)) in rows.iter().enumerate() {
                let row = [pdf[i], integrand[i]];
                let place = || format!("{strategy}: {row:?} of{}", Row(&columns, i));
                prop_assert!(row.iter().all(|x| x.is_finite() && *x >= 0.0), "{}", place());
                if !(case.ray.t_min()..=case.ray.t_max()).contains(t) {
                    prop_assert_eq!(row, [0.0; 2], "{}", place());
                }
                let one = [
                    sampler.pdf_one(&case.ray, &case.emitter, &case.medium, *t),
                    sampler.evaluate_one(&case.ray, &case.emitter, &case.medium, *t),
                ];
                prop_assert_eq!(row.map(f32::to_bits), one.map(f32::to_bits), "alone {:?}, {}", one, place());
            }
        }
    }
}
