//! What every call promises for any bits, held against one batch: numbers are finite and in range, counts add up, and bits are
//! those of the ray alone, on any backend with fused multiply-add and however the batch is cut.

use crate::batch::Batch;
use crate::variates;
use airlight::{Backend, Counts, Emitter, Error, Integral, Sampler, Samples, Threads};
use std::ops::Range;

/// Emitters to choose from, and a weight for each.
#[derive(Clone, Debug)]
pub struct Choices {
    /// The emitters.
    pub table: Vec<Emitter>,
    /// As many weights.
    pub weights: Vec<f32>,
}

/// What became of the promises: how many values were looked at, or which promise is broken and where.
pub type Kept = Result<usize, String>;

/// What has to give the same bits as the batch on a backend.
#[derive(Clone, Copy, Debug)]
pub enum Again {
    /// Every backend with fused multiply-add; and on each backend, on one thread, the two parts of the batch cut at a ray.
    Everywhere {
        /// The first ray of the second part.
        cut: usize,
    },
    /// The two parts on the same backend.
    Cut {
        /// It.
        on: Backend,
        /// The first ray of the second part.
        cut: usize,
    },
    /// Another backend; both have fused multiply-add.
    Beside {
        /// The one.
        on: Backend,
        /// The other.
        other: Backend,
    },
}

impl Batch {
    /// Holds the promises of `sample` against it.
    ///
    /// # Errors
    /// Which promise is broken.
    pub fn hold_sample(&self, sampler: &Sampler, again: Again) -> Kept {
        let held = self.hold(again, |backend, threads, range| {
            self.sampled(&sampler.with_backend(backend).with_threads(threads), range)
        });
        held.map_err(|broken| format!("sample by {} {}, {broken}", sampler.strategy(), sampler.precision()))
    }

    /// Holds those of `pdf`, `cdf` and `evaluate` against it, at its distances.
    ///
    /// # Errors
    /// Which promise is broken.
    pub fn hold_densities(&self, sampler: &Sampler, again: Again) -> Kept {
        let held = self.hold(again, |backend, threads, range| {
            self.densities(&sampler.with_backend(backend).with_threads(threads), range)
        });
        held.map_err(|broken| format!("densities of {} {}, {broken}", sampler.strategy(), sampler.precision()))
    }

    /// Holds those of `radiance` against it.
    ///
    /// # Errors
    /// Which promise is broken.
    pub fn hold_radiance(&self, integral: &Integral, again: Again) -> Kept {
        let held = self.hold(again, |backend, threads, range| {
            self.radiances(&integral.with_backend(backend).with_threads(threads), range)
        });
        held.map_err(|broken| format!("radiance by {} nodes, {}, {broken}", integral.nodes(), integral.precision()))
    }

    /// Holds those of `choose` against it, with the first variate of each ray.
    ///
    /// # Errors
    /// Which promise is broken.
    pub fn hold_choose(&self, integral: &Integral, choices: &Choices, again: Again) -> Kept {
        let held = self.hold(again, |backend, threads, range| {
            self.chosen(&integral.with_backend(backend).with_threads(threads), choices, range)
        });
        held.map_err(|broken| format!("choose by {} nodes, {}, {broken}", integral.nodes(), integral.precision()))
    }

    fn hold(&self, again: Again, call: impl Fn(Backend, Threads, Range<usize>) -> Outcome) -> Kept {
        let n = self.len();
        let whole = |on: Backend, threads| {
            let whole = call(on, threads, 0..n);
            whole.check(self).map_err(|what| format!("{}: {what}", on.name()))?;
            Ok::<_, String>(whole)
        };
        let cut_at = |on: Backend, cut: usize, whole: &Outcome| {
            let cut = cut.min(n);
            let parts = [0..cut, cut..n].map(|range| call(on, Threads::Caller, range));
            let same = Outcome::joined(parts).same_as(whole);
            same.map_err(|what| format!("{}: cut at ray {cut}: {what}", on.name()))
        };
        let beside = |on: Backend, whole: &Outcome, other: Backend, reference: &Outcome| {
            let same = whole.same_as(reference);
            same.map_err(|what| format!("{}: beside {}: {what}", on.name(), other.name()))
        };
        match again {
            Again::Everywhere { cut } => {
                let (mut looked_at, mut fused) = (0, None);
                for on in Backend::available() {
                    let whole = whole(on, Threads::Pool)?;
                    looked_at += whole.values();
                    cut_at(on, cut, &whole)?;
                    if on.is_fused() {
                        let (first, reference) = fused.get_or_insert((on, whole.clone()));
                        beside(on, &whole, *first, reference)?;
                    }
                }
                Ok(looked_at)
            }
            Again::Cut { on, cut } => {
                let whole = whole(on, Threads::Caller)?;
                cut_at(on, cut, &whole)?;
                Ok(whole.values())
            }
            Again::Beside { on, other } => {
                let whole = whole(on, Threads::Caller)?;
                beside(on, &whole, other, &call(other, Threads::Caller, 0..n))?;
                Ok(whole.values())
            }
        }
    }

    /// A hash of all that a sampler gives for the batch.
    #[must_use]
    pub fn hash_of_sampler(&self, sampler: &Sampler) -> u64 {
        let all = 0..self.len();
        [self.sampled(sampler, all.clone()), self.densities(sampler, all)].iter().fold(0, Outcome::hash)
    }

    /// A hash of all that an integral gives for the batch.
    #[must_use]
    pub fn hash_of_integral(&self, integral: &Integral, choices: &Choices) -> u64 {
        let all = 0..self.len();
        [self.radiances(integral, all.clone()), self.chosen(integral, choices, all)].iter().fold(0, Outcome::hash)
    }

    fn sampled(&self, sampler: &Sampler, range: Range<usize>) -> Outcome {
        let (rays, emitters, media) = (self.rays(&range), self.emitters(&range), self.media(&range));
        let u = self.given(&self.u, &range);
        let [mut t, mut pdf, mut r] = [(); 3].map(|()| vec![f32::NAN; u.len()]);
        let mut weights = vec![vec![f32::NAN; u.len()]; self.channels()];
        let mut samples = Samples::new(&mut t, &mut pdf).r(&mut r);
        for (place, weight) in samples.weights.iter_mut().zip(&mut weights) {
            *place = Some(weight);
        }
        let counts = vec![sampler.sample(&rays, &emitters, &media, u, &mut samples)];
        let columns = [("t", t), ("pdf", pdf), ("r", r)].map(|(name, values)| Column::new(name, values));
        let weights = weights.into_iter().map(|weight| Column::new("weight", weight));
        Outcome { columns: columns.into_iter().chain(weights).collect(), counts, per_ray: self.per_ray() }
    }

    fn densities(&self, sampler: &Sampler, range: Range<usize>) -> Outcome {
        let (rays, emitters, media) = (self.rays(&range), self.emitters(&range), self.media(&range));
        let t = self.given(&self.t, &range);
        let [mut pdf, mut cdf] = [(); 2].map(|()| vec![f32::NAN; t.len()]);
        let mut integrands = vec![vec![f32::NAN; t.len()]; self.channels()];
        let counts = vec![
            sampler.pdf(&rays, &emitters, &media, t, &mut pdf),
            sampler.cdf(&rays, &emitters, &media, t, &mut cdf),
            match &mut integrands[..] {
                [a] => sampler.evaluate(&rays, &emitters, &media, t, a),
                [a, b, c] => sampler.evaluate_coloured(&rays, &emitters, &media, t, [a, b, c]),
                [a, b, c, d] => sampler.evaluate_coloured(&rays, &emitters, &media, t, [a, b, c, d]),
                _ => unreachable!("media have 1, 3 or 4 channels"),
            },
        ];
        let columns = [Column::new("pdf", pdf), Column { most: 1.0, ..Column::new("cdf", cdf) }];
        let integrands = integrands.into_iter().map(|values| Column::new("integrand", values));
        Outcome { columns: columns.into_iter().chain(integrands).collect(), counts, per_ray: self.per_ray() }
    }

    fn radiances(&self, integral: &Integral, range: Range<usize>) -> Outcome {
        let (rays, emitters, media) = (self.rays(&range), self.emitters(&range), self.media(&range));
        let mut radiances = vec![vec![f32::NAN; range.len()]; self.channels()];
        let counts = match &mut radiances[..] {
            [a] => integral.radiance(&rays, &emitters, &media, a),
            [a, b, c] => integral.radiance_coloured(&rays, &emitters, &media, [a, b, c]),
            [a, b, c, d] => integral.radiance_coloured(&rays, &emitters, &media, [a, b, c, d]),
            _ => unreachable!("media have 1, 3 or 4 channels"),
        };
        let columns = radiances.into_iter().map(|values| Column::new("radiance", values));
        Outcome { columns: columns.collect(), counts: vec![counts], per_ray: 1 }
    }

    fn chosen(&self, integral: &Integral, choices: &Choices, range: Range<usize>) -> Outcome {
        let (rays, media, k) = (self.rays(&range), self.media(&range), self.per_ray());
        let u: Vec<f32> = range.clone().map(|ray| self.u[ray * k]).collect();
        let Choices { table, weights } = choices;
        let (mut index, mut probability) = (vec![u32::MAX; u.len()], vec![f32::NAN; u.len()]);
        let counts = integral.choose(&rays, table, weights, &media, &u, &mut index, &mut probability);
        // Up to 2^24 they are whole numbers of f32.
        let index = index.into_iter().map(|index| index as f32).collect();
        let last = table.len().saturating_sub(1) as f32;
        let columns = [("index", last, index), ("probability", 1.0, probability)];
        let columns = columns.map(|(name, most, values)| Column { name, most, values });
        Outcome { columns: columns.into(), counts: vec![counts], per_ray: 1 }
    }
}

/// What was written to one column.
#[derive(Clone, Debug)]
struct Column {
    name: &'static str,
    /// Values are from 0 to this one.
    most: f32,
    values: Vec<f32>,
}

impl Column {
    fn new(name: &'static str, values: Vec<f32>) -> Self {
        Self { name, most: f32::MAX, values }
    }
}

/// What some calls made of some rays.
#[derive(Clone, Debug)]
struct Outcome {
    columns: Vec<Column>,
    counts: Vec<Result<Counts, Error>>,
    per_ray: usize,
}

impl Outcome {
    fn values(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }

    /// That of two parts as one.
    fn joined([mut first, second]: [Self; 2]) -> Self {
        for (column, more) in first.columns.iter_mut().zip(second.columns) {
            column.values.extend(more.values);
        }
        for (counts, more) in first.counts.iter_mut().zip(second.counts) {
            *counts = (*counts).and_then(|counts| Ok(counts + more?));
        }
        first
    }

    /// Refused calls write nothing, others numbers in range.
    fn check(&self, batch: &Batch) -> Result<(), String> {
        for counts in &self.counts {
            let counts = counts.as_ref().map_err(|error| format!("the call was refused: {error}"))?;
            let all = counts.sampled + counts.empty + counts.invalid;
            if all != self.values() || counts.bisected > counts.sampled {
                return Err(format!("{counts:?} of {} values", self.values()));
            }
        }
        for Column { name, most, values } in &self.columns {
            if let Some(i) = values.iter().position(|value| !(0.0..=*most).contains(value)) {
                return Err(format!("{name} is {}, {}", values[i], self.place(i)));
            }
        }
        self.check_samples(batch)
    }

    /// A ray with a sample has it in its interval.
    fn check_samples(&self, batch: &Batch) -> Result<(), String> {
        let [Column { name: "t", values: t, .. }, Column { values: pdf, .. }, ..] = &self.columns[..] else {
            return Ok(());
        };
        let mut sampled = 0;
        for (i, (&t, &pdf)) in t.iter().zip(pdf).enumerate() {
            let [t_min, t_max] = [6, 7].map(|k| batch.rays[k][i / self.per_ray]);
            if pdf > 0.0 && !(t_min..=t_max).contains(&t) {
                return Err(format!("t is {t}, not in [{t_min}, {t_max}], {}", self.place(i)));
            }
            sampled += usize::from(pdf > 0.0);
        }
        let counts = self.counts[0].as_ref().map_or(0, |counts| counts.sampled);
        if sampled <= counts { Ok(()) } else { Err(format!("{counts} samples are counted, {sampled} written")) }
    }

    /// That of its bits and counts, after `hash`.
    fn hash(hash: u64, outcome: &Self) -> u64 {
        let values = outcome.columns.iter().flat_map(|column| &column.values);
        let counts = outcome.counts.iter().map(|counts| counts.unwrap_or_default());
        let counts = counts.flat_map(|c| [c.sampled, c.empty, c.invalid, c.bisected]);
        let numbers = values.map(|value| value.to_bits().into()).chain(counts.map(|count| count as u64));
        numbers.fold(hash, variates::bits)
    }

    /// Equal bits and equal counts.
    fn same_as(&self, other: &Self) -> Result<(), String> {
        for (a, b) in self.columns.iter().zip(&other.columns) {
            let differ = |(a, b): (&f32, &f32)| a.to_bits() != b.to_bits();
            if let Some(i) = a.values.iter().zip(&b.values).position(differ) {
                return Err(format!("{} is {:?}, not {:?}, {}", a.name, a.values[i], b.values[i], self.place(i)));
            }
        }
        let same = self.counts == other.counts;
        if same { Ok(()) } else { Err(format!("counts are {:?}, not {:?}", self.counts, other.counts)) }
    }

    fn place(&self, i: usize) -> String {
        format!("ray {}, variate {}", i / self.per_ray, i % self.per_ray)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batch::{Columns, Fog, Lights};
    use airlight::{Medium, Strategy};

    /// What a call with one invalid ray may have made of it, with some values of `cdf`.
    fn outcome(values: &[f32]) -> Outcome {
        let batch = Batch {
            rays: [(); 8].map(|()| vec![f32::NAN; values.len()]),
            lights: Lights::One(Emitter::point([0.0; 3]).unwrap()),
            fog: Fog::One(Medium::new(0.1, 0.1, 0.0).unwrap()),
            u: vec![0.5; values.len()],
            t: vec![0.5; values.len()],
        };
        let mut outcome = batch.densities(&Sampler::new(Strategy::EquiAngular), 0..values.len());
        outcome.check(&batch).unwrap();
        outcome.columns[1].values = values.to_vec();
        outcome
    }

    fn checked(outcome: &Outcome) -> Result<(), String> {
        let batch = Columns::default().batch(0, |_| 0);
        outcome.check(&batch)
    }

    #[test]
    fn numbers_out_of_range_are_found() {
        assert_eq!(checked(&outcome(&[0.0, 1.0])), Ok(()));
        for bad in [f32::NAN, -f32::from_bits(1), 1f32.next_up(), f32::INFINITY] {
            assert_eq!(checked(&outcome(&[0.0, bad])), Err(format!("cdf is {bad}, ray 1, variate 0")));
        }
    }

    #[test]
    fn counts_that_do_not_add_up_are_found() {
        let mut two = outcome(&[0.0; 2]);
        two.counts = outcome(&[0.0; 3]).counts;
        assert!(checked(&two).unwrap_err().ends_with("of 2 values"));
        assert!(two.same_as(&outcome(&[0.0; 2])).unwrap_err().starts_with("counts are"));
    }

    #[test]
    fn other_bits_are_found() {
        let (one, other) = (outcome(&[0.25, 0.0]), outcome(&[0.25, -0.0]));
        assert_eq!(one.same_as(&one), Ok(()));
        assert_eq!(other.same_as(&one), Err("cdf is -0.0, not 0.0, ray 1, variate 0".to_owned()));
        let parts = [outcome(&[0.25]), outcome(&[0.0])];
        assert_eq!(Outcome::joined(parts).same_as(&one), Ok(()));
    }
}
