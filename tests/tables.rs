//! A table with an index per ray gives the bits of the same emitters and media in columns; an index out of range makes its
//! ray invalid and no other.

mod scenes;

use airlight::{Counts, Emitter, Emitters, Integral, Media, Medium, Nodes, Rays, Sampler, Strategy};
use airlight_tools::backends::distinct;
use airlight_tools::samplers;
use scenes::{Columns, Drawn, Random};

const SEED: u64 = 11;
const ENTRIES: usize = 7;

/// Rays whose emitters and media are those of a table, and the table.
struct Batch {
    columns: Columns,
    emitters: Vec<Emitter>,
    media: Vec<Medium>,
    emitter_of: Vec<u32>,
    medium_of: Vec<u32>,
}

impl Batch {
    fn new(rays: usize) -> Self {
        let mut random = Random::new(SEED);
        let entries: Vec<_> = (0..ENTRIES).map(|_| random.case_or_spot()).collect();
        let [emitter_of, medium_of] =
            [(); 2].map(|()| (0..rays).map(|_| random.below(ENTRIES) as u32).collect::<Vec<_>>());
        let rows = emitter_of.iter().zip(&medium_of).map(|(&emitter, &medium)| {
            let mut case = random.case();
            case.emitter = entries[emitter as usize].emitter;
            case.medium = entries[medium as usize].medium;
            (case, random.uniform())
        });
        let columns = Columns::new(rows.collect::<Vec<_>>());
        let emitters = entries.iter().map(|case| case.emitter).collect();
        let media = entries.iter().map(|case| case.medium).collect();
        Self { columns, emitters, media, emitter_of, medium_of }
    }

    fn rays(&self) -> Rays<'_> {
        self.columns.rays(0..self.columns.len())
    }

    fn emitters(&self) -> Emitters<'_> {
        Emitters::table(&self.emitters, &self.emitter_of)
    }

    fn media(&self) -> Media<'_> {
        Media::table(&self.media, &self.medium_of)
    }

    /// With `per_ray` variates for each ray.
    fn sample(&self, sampler: &Sampler, emitters: &Emitters<'_>, media: &Media<'_>, per_ray: usize) -> Drawn {
        let mut random = Random::new(SEED + 1);
        let u: Vec<f32> = (0..self.columns.len() * per_ray).map(|_| random.uniform()).collect();
        let mut drawn = Drawn::new(u.len());
        drawn.counts = sampler.sample(&self.rays(), emitters, media, &u, &mut drawn.samples()).unwrap();
        drawn
    }

    /// The bits of densities, distribution functions and integrands at `t`, and of the integrals.
    fn at(&self, sampler: &Sampler, emitters: &Emitters<'_>, media: &Media<'_>, t: &[f32]) -> Vec<u32> {
        let (rays, integral) = (self.rays(), Integral::new(Nodes::Four).with_backend(sampler.backend()));
        let [mut pdf, mut cdf, mut integrand] = [(); 3].map(|()| vec![f32::NAN; t.len()]);
        let mut radiance = vec![f32::NAN; rays.len()];
        sampler.pdf(&rays, emitters, media, t, &mut pdf).unwrap();
        sampler.cdf(&rays, emitters, media, t, &mut cdf).unwrap();
        sampler.evaluate(&rays, emitters, media, t, &mut integrand).unwrap();
        integral.radiance(&rays, emitters, media, &mut radiance).unwrap();
        [pdf, cdf, integrand, radiance].concat().into_iter().map(f32::to_bits).collect()
    }
}

#[test]
fn a_table_gives_the_bits_of_columns() {
    for (rays, per_ray) in [(5003, 1), (700, 3), (1, 1), (1, 40), (5, 1), (37, 2)] {
        let batch = Batch::new(rays);
        let columns = (batch.columns.emitters(0..rays), batch.columns.media(0..rays));
        for backend in distinct() {
            for sampler in samplers::all() {
                let sampler = sampler.with_backend(backend);
                let expected = batch.sample(&sampler, &columns.0, &columns.1, per_ray);
                for (emitters, media) in
                    [(batch.emitters(), batch.media()), (batch.emitters(), columns.1), (columns.0, batch.media())]
                {
                    let drawn = batch.sample(&sampler, &emitters, &media, per_ray);
                    let of = || format!("{}, {backend:?}, {rays} rays with {per_ray}, seed {SEED}", sampler.strategy());
                    assert_eq!(drawn.counts, expected.counts, "{}", of());
                    for i in 0..rays * per_ray {
                        assert_eq!(drawn.bits(i), expected.bits(i), "sample {i}: {}", of());
                    }
                    let t = &expected.t;
                    assert!(batch.at(&sampler, &emitters, &media, t) == batch.at(&sampler, &columns.0, &columns.1, t));
                }
            }
        }
    }
}

#[test]
fn an_index_out_of_range_makes_its_ray_invalid() {
    const RAYS: usize = 1000;
    for &strategy in Strategy::ALL {
        let (good, sampler) = (Batch::new(RAYS), Sampler::new(strategy));
        let expected = good.sample(&sampler, &good.emitters(), &good.media(), 1);
        let mut bad = Batch::new(RAYS);
        for (i, index) in [(3, ENTRIES as u32), (500, u32::MAX), (999, 1 << 31)] {
            bad.emitter_of[i] = index;
            bad.medium_of[i - 2] = index;
        }
        let spoilt = [1, 3, 498, 500, 997, 999];
        let drawn = bad.sample(&sampler, &bad.emitters(), &bad.media(), 1);
        for i in 0..RAYS {
            let expected = if spoilt.contains(&i) { [0; 4] } else { expected.bits(i) };
            assert_eq!(drawn.bits(i), expected, "ray {i}, {strategy}, seed {SEED}");
        }
        assert_eq!(drawn.counts.invalid, expected.counts.invalid + spoilt.len());
        let Counts { sampled, empty, invalid, .. } = drawn.counts;
        assert_eq!(sampled + empty + invalid, RAYS);
    }
}

#[test]
fn a_malformed_table_is_refused_by_name() {
    let batch = Batch::new(9);
    let (rays, u) = (batch.rays(), batch.columns.given());
    let said = |emitters: &Emitters<'_>, media: &Media<'_>| {
        let mut drawn = Drawn::new(9);
        let result = Sampler::new(Strategy::Product5).sample(&rays, emitters, media, u, &mut drawn.samples());
        assert!(drawn.t.iter().chain(&drawn.pdf).all(|x| x.is_nan()), "something was written");
        result.unwrap_err().to_string()
    };
    let (emitters, media) = (batch.emitters(), batch.media());
    assert_eq!(said(&Emitters::table(&[], &batch.emitter_of), &media), "emitters.table is empty");
    assert_eq!(said(&emitters, &Media::table(&[], &batch.medium_of)), "media.table is empty");
    let short = &batch.emitter_of[..8];
    assert_eq!(said(&Emitters::table(&batch.emitters, short), &media), "emitters.index has 8 elements, expected 9");
    assert_eq!(said(&emitters, &Media::table(&batch.media, short)), "media.index has 8 elements, expected 9");
}
