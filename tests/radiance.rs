//! The product density's own estimate of a ray's radiance is as near to it as its documentation says.

use airlight::{Counts, Error, Sampler, Strategy};
use airlight_tools::errors::quantile;
use airlight_tools::families::{Case, Columns, Family};

const RAYS: usize = 1 << 13;

#[test]
fn the_estimate_is_near_the_radiance() {
    // Relative errors that half, and 99 % of the rays of the generic family stay below.
    for (strategy, median, p99) in [
        (Strategy::Product3, 0.05, 0.22),
        (Strategy::Product5, 0.002, 0.012),
        (Strategy::Product9, 0.0002, 0.002),
        (Strategy::Product17, 0.00002, 0.00013),
    ] {
        let cases: Vec<Case> = (0..RAYS).map(|i| Family::Generic.case(8, i as u64)).collect();
        let columns = Columns::new(&cases);
        let mut estimate = vec![f32::NAN; RAYS];
        let sampler = Sampler::new(strategy);
        let (rays, emitters, media) = (columns.rays(), columns.emitters(), columns.media());
        let counts = sampler.radiance(&rays, &emitters, &media, &mut estimate).unwrap();
        let mut errors = Vec::new();
        for (case, &estimate) in cases.iter().zip(&estimate) {
            match case.scene().unwrap().radiance() {
                radiance if radiance > 0.0 => errors.push((f64::from(estimate) / radiance - 1.0).abs()),
                _ => assert_eq!(estimate, 0.0),
            }
        }
        assert_eq!(counts.sampled, errors.len());
        errors.sort_unstable_by(f64::total_cmp);
        let [half, most] = [0.5, 0.99].map(|p| quantile(&errors, p));
        println!("{strategy}: {half:.1e} of {median:.1e}, {most:.1e} of {p99:.1e}");
        assert!(half <= median && most <= p99, "{strategy}: errors {half} and {most}");
    }
}

#[test]
fn any_number_of_rays() {
    let cases: Vec<Case> = (0..71).map(|i| Family::Generic.case(8, i)).collect();
    let sampler = Sampler::new(Strategy::Product5);
    let estimates = |cases: &[Case]| {
        let columns = Columns::new(cases);
        let mut estimate = vec![f32::NAN; cases.len()];
        let counts = sampler.radiance(&columns.rays(), &columns.emitters(), &columns.media(), &mut estimate).unwrap();
        assert_eq!(counts.sampled + counts.empty + counts.invalid, cases.len());
        estimate
    };
    let all = estimates(&cases);
    for n in 0..cases.len() {
        assert_eq!(estimates(&cases[..n]), all[..n], "{n} rays");
    }
}

#[test]
fn other_strategies_have_none() {
    let columns = Columns::new(&[]);
    for &strategy in Strategy::ALL {
        let result = Sampler::new(strategy).radiance(&columns.rays(), &columns.emitters(), &columns.media(), &mut []);
        let expected = Err(Error::Unavailable { field: "radiance", strategy });
        assert_eq!(result, if strategy.has_radiance() { Ok(Counts::default()) } else { expected });
    }
}
