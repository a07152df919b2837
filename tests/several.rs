//! Several samples of a ray are those of as many calls with one: the same bits, next to each other.

mod scenes;

use airlight::{Backend, Counts, Sampler, Samples, Strategy};
use airlight_tools::families::{Case, Columns, Family};
use scenes::Random;

/// Not a multiple of any lane group, and more than a chunk.
const RAYS: usize = 4099;

fn columns(rays: usize) -> Columns {
    let cases: Vec<Case> = (0..rays).map(|i| Family::ALL[i % Family::ALL.len()].case(6, i as u64)).collect();
    Columns::new(&cases)
}

fn sum(all: impl Iterator<Item = Counts>) -> Counts {
    all.fold(Counts::default(), |sum, counts| sum + counts)
}

#[test]
fn they_are_those_of_one_each() {
    // Many rays, and so few that they do not fill the lanes but with their variates.
    for (n, per_ray) in
        [(RAYS, 2), (RAYS, 3), (RAYS, 8), (1, 7), (1, 33), (1, 5000), (2, 1500), (5, 33), (31, 100), (33, 40), (37, 7)]
    {
        let columns = columns(n);
        let (rays, emitters, media) = (columns.rays(), columns.emitters(), columns.media());
        let mut random = Random::new(7);
        let u: Vec<f32> = (0..n * per_ray).map(|_| random.uniform()).collect();
        for &strategy in Strategy::ALL {
            let sampler = Sampler::new(strategy);
            let [mut t, mut pdf, mut weight, mut r, mut pdf_at, mut f] = [(); 6].map(|()| vec![f32::NAN; u.len()]);
            let mut samples = Samples::new(&mut t, &mut pdf).weight(&mut weight).r(&mut r);
            let counts = sampler.sample(&rays, &emitters, &media, &u, &mut samples).unwrap();
            sampler.pdf(&rays, &emitters, &media, &t, &mut pdf_at).unwrap();
            sampler.evaluate(&rays, &emitters, &media, &t, &mut f).unwrap();

            let one_each = sum((0..per_ray).map(|index| {
                let turn = |column: &[f32]| column.iter().skip(index).step_by(per_ray).copied().collect::<Vec<_>>();
                let [mut t_1, mut pdf_1, mut weight_1, mut r_1, mut pdf_at_1, mut f_1] =
                    [(); 6].map(|()| vec![f32::NAN; n]);
                let mut samples = Samples::new(&mut t_1, &mut pdf_1).weight(&mut weight_1).r(&mut r_1);
                let counts = sampler.sample(&rays, &emitters, &media, &turn(&u), &mut samples).unwrap();
                sampler.pdf(&rays, &emitters, &media, &t_1, &mut pdf_at_1).unwrap();
                sampler.evaluate(&rays, &emitters, &media, &t_1, &mut f_1).unwrap();
                for (several, one) in
                    [(&t, &t_1), (&pdf, &pdf_1), (&weight, &weight_1), (&r, &r_1), (&pdf_at, &pdf_at_1), (&f, &f_1)]
                {
                    let bits = |x: &[f32]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                    assert_eq!(bits(&turn(several)), bits(one), "{strategy}, {n} rays, {index} of {per_ray}, seed 7");
                }
                counts
            }));
            assert_eq!(counts, one_each, "{strategy}, {n} rays with {per_ray}");
        }
    }
}

/// A few rays, with so many variates that they do not fill the lanes or fill them again and again, on lane groups of every
/// width: as in a batch of one variate each that fills all lanes.
#[test]
fn few_rays_on_every_backend() {
    const SHAPES: [(usize, usize); 11] =
        [(1, 1), (1, 5), (1, 16), (1, 33), (2, 3), (7, 1), (9, 40), (20, 3), (33, 1), (35, 2), (40, 70)];
    for backend in Backend::available() {
        for (n, per_ray) in SHAPES {
            let values = n * per_ray;
            let case = |i: usize| Family::ALL[i % Family::ALL.len()].case(6, i as u64);
            let few: Vec<Case> = (0..n).map(case).collect();
            let mut many: Vec<Case> = (0..values.next_multiple_of(32)).map(|i| few[i / per_ray % n]).collect();
            let mut random = Random::new(9);
            many.iter_mut().for_each(|case| case.u = random.uniform());
            let (few, many) = (Columns::new(&few), Columns::new(&many));
            for strategy in [Strategy::EquiAngular, Strategy::TaylorPhase, Strategy::Product5] {
                let sampler = Sampler::new(strategy).with_backend(backend);
                let sample = |columns: &Columns, u: &[f32]| {
                    let [mut t, mut pdf] = [(); 2].map(|()| vec![f32::NAN; u.len()]);
                    let mut samples = Samples::new(&mut t, &mut pdf);
                    let (rays, emitters, media) = (columns.rays(), columns.emitters(), columns.media());
                    let counts = sampler.sample(&rays, &emitters, &media, u, &mut samples).unwrap();
                    (counts, [t, pdf].map(|column| column.iter().map(|x| x.to_bits()).collect::<Vec<_>>()))
                };
                let (counts, found) = sample(&few, &many.u[..values]);
                let (_, expected) = sample(&many, &many.u);
                let place = format!("{strategy}, {backend:?}, {n} rays with {per_ray}, seed 9");
                assert_eq!(found, expected.map(|column| column[..values].to_vec()), "{place}");
                assert_eq!(counts.sampled + counts.empty + counts.invalid, values, "{place}");
                let least = found[1].iter().filter(|pdf| **pdf > 0).count();
                assert!(counts.sampled >= least, "{place}: {counts:?}, {least} written");
            }
        }
    }
}

/// Nothing is lost where the variates of a ray are cut into chunks: more samples than f32 can count, an odd number of them.
#[test]
fn any_number_is_counted() {
    let [lit, dark, invalid] = [Some(true), Some(false), None].map(|kind| {
        let is_lit = |case: &Case| case.scene().ok().map(|scene| scene.lit().is_some());
        let cases = (0..).flat_map(|i| [Family::Generic, Family::Ray].map(|family| family.case(6, i)));
        cases.into_iter().find(|case| is_lit(case) == kind).unwrap()
    });
    let (sampled, per_ray) = (29, (1 << 24) / 29 + 1);
    assert!(sampled * per_ray > 1 << f32::MANTISSA_DIGITS && sampled * per_ray % 2 == 1);
    let columns = Columns::new(&[&[lit; 29][..], &[dark; 2], &[invalid]].concat());
    let u = vec![0.5; 32 * per_ray];
    let (mut t, mut pdf) = (vec![f32::NAN; u.len()], vec![f32::NAN; u.len()]);
    let mut samples = Samples::new(&mut t, &mut pdf);
    let (rays, emitters, media) = (columns.rays(), columns.emitters(), columns.media());
    let counts = Sampler::new(Strategy::EquiAngular).sample(&rays, &emitters, &media, &u, &mut samples).unwrap();
    let expected = [sampled * per_ray, 2 * per_ray, per_ray];
    assert_eq!([counts.sampled, counts.empty, counts.invalid], expected);
}

#[test]
fn no_part_of_a_ray_is_sampled() {
    let columns = columns(RAYS);
    let (rays, emitters, media) = (columns.rays(), columns.emitters(), columns.media());
    for length in [0, RAYS - 1, RAYS + 1, 2 * RAYS - 1] {
        let u = vec![0.5; length];
        let (mut t, mut pdf) = (vec![f32::NAN; length], vec![f32::NAN; length]);
        let mut samples = Samples::new(&mut t, &mut pdf);
        let result = Sampler::new(Strategy::EquiAngular).sample(&rays, &emitters, &media, &u, &mut samples);
        let said = result.unwrap_err().to_string();
        assert_eq!(said, format!("u has {length} elements, expected {RAYS}"));
    }
}
