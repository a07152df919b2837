//! All backends with a fused multiply-add give the same bits, whatever their width: on generic rays and on every family
//! of hard ones.

use airlight::{Backend, Counts, Integral, Nodes, Sampler, Samples, Strategy};
use airlight_tools::families::{Case, Columns, Family};
use std::fmt;

/// Per family; together 2^20 and more. Fewer on an emulated CPU, by the environment variable `AIRLIGHT_RAYS`.
const RAYS: u64 = 96_011;
const SEED: u64 = 301;

/// Columns by name as bits, and counts.
type Bits = (Vec<(&'static str, Vec<u32>)>, Vec<Counts>);

/// All that can be asked of a sampler.
fn bits(sampler: &Sampler, columns: &Columns) -> Bits {
    let (rays, emitters, media) = (columns.rays(), columns.emitters(), columns.media());
    let mut out = [(); 6].map(|()| vec![0.0f32; columns.u.len()]);
    let [t, pdf, weight, r, pdf_at_t, integrand] = &mut out;
    const EQUAL: &str = "all columns have one length";
    let mut samples = Samples::new(t, pdf).weight(weight).r(r);
    let sampled = sampler.sample(&rays, &emitters, &media, &columns.u, &mut samples).expect(EQUAL);
    let at_t = sampler.pdf(&rays, &emitters, &media, t, pdf_at_t).expect(EQUAL);
    sampler.evaluate(&rays, &emitters, &media, t, integrand).expect(EQUAL);
    let three: Vec<f32> = columns.u.iter().flat_map(|u| [0.25 * u, 0.5 * u, *u]).collect();
    let [mut t_of_three, mut pdf_of_three] = [(); 2].map(|()| vec![0.0f32; three.len()]);
    let mut samples = Samples::new(&mut t_of_three, &mut pdf_of_three);
    let three_sampled = sampler.sample(&rays, &emitters, &media, &three, &mut samples).expect(EQUAL);
    let names = ["t", "pdf", "weight", "r", "pdf at t", "integrand", "t of three", "pdf of three"];
    let columns = out.into_iter().chain([t_of_three, pdf_of_three]);
    let bits = columns.map(|column| column.into_iter().map(f32::to_bits).collect());
    (names.into_iter().zip(bits).collect(), vec![sampled, at_t, three_sampled])
}

fn radiance_bits(integral: &Integral, columns: &Columns) -> Bits {
    let mut radiance = vec![0.0f32; columns.u.len()];
    let (rays, emitters, media) = (columns.rays(), columns.emitters(), columns.media());
    let counts = integral.radiance(&rays, &emitters, &media, &mut radiance).expect("all columns have one length");
    (vec![("radiance", radiance.into_iter().map(f32::to_bits).collect())], vec![counts])
}

#[test]
fn fused_backends_give_the_same_bits() {
    let fused: Vec<Backend> = Backend::available().filter(|backend| backend.is_fused()).collect();
    println!("{:?}", fused.iter().map(|backend| backend.name()).collect::<Vec<_>>());
    let (first, others) = fused.split_first().expect("a fused backend");
    let wide = Backend::detect().name() != "portable";
    assert!(!wide || !others.is_empty(), "no backend was compared");
    let avx512 = Backend::detect().name() == "avx512";
    assert!(!avx512 || fused.iter().any(|backend| backend.name() == "avx2"), "AVX2 was not compared");
    let rays = std::env::var("AIRLIGHT_RAYS").map_or(RAYS, |n| n.parse().expect("a number of rays"));
    for family in Family::ALL {
        let cases: Vec<Case> = (0..rays).map(|i| family.case(SEED, i)).collect();
        let columns = Columns::new(&cases);
        let same = |what: &dyn fmt::Display, other: Backend, [expected, found]: [&Bits; 2]| {
            assert_eq!(expected.1, found.1, "{what}, {family:?}: {first:?} and {other:?}");
            for ((name, expected), (_, found)) in expected.0.iter().zip(&found.0) {
                if let Some(i) = (0..expected.len()).find(|&i| expected[i] != found[i]) {
                    let [a, b] = [expected[i], found[i]].map(f32::from_bits);
                    let case = cases[i * cases.len() / expected.len()];
                    panic!("{what}, {family:?}: {name} is {a:e} on {first:?} and {b:e} on {other:?}: {case:?}");
                }
            }
        };
        for &strategy in Strategy::ALL {
            let on = |backend| bits(&Sampler::new(strategy).with_backend(backend), &columns);
            let expected = on(*first);
            for &other in others {
                same(&strategy, other, [&expected, &on(other)]);
            }
        }
        for &nodes in Nodes::ALL {
            let on = |backend| radiance_bits(&Integral::new(nodes).with_backend(backend), &columns);
            let expected = on(*first);
            for &other in others {
                same(&format!("{nodes} nodes"), other, [&expected, &on(other)]);
            }
        }
    }
}
