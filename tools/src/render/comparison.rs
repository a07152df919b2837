//! `--compare`: every strategy with the same budget, beside a picture with far more samples.

use super::exposure::{Budget, Exposure, STEPS};
use super::figures::{Job, Run};
use super::{Args, sheet};
use crate::{arguments, progress, table};
use airlight::{Sampler, Strategy};
use airlight_tools::renderer::Settings;
use airlight_tools::renderer::film::Film;
use airlight_tools::renderer::picture::Picture;
use airlight_tools::renderer::scene::Scene;
use airlight_tools::renderer::shadow::Shadows;
use anyhow::Result;
use serde::Serialize;
use std::fmt;

/// What the efficiencies are relative to.
const BASELINE: Strategy = Strategy::EquiAngular;
/// What the reference is rendered with.
const REFERENCE: Strategy = Strategy::Product17;

/// All strategies on a scene.
#[derive(Debug, Serialize)]
pub(super) struct Comparison {
    #[serde(flatten)]
    job: Job,
    reference_passes: u64,
    results: Vec<Row>,
}

/// One of them; none where the error is not beyond that of the reference.
#[derive(Debug, Serialize)]
struct Row {
    #[serde(flatten)]
    run: Run,
    airlight_rmse: Option<f64>,
    /// `1/(MSE time)` relative to equi-angular with the first estimate of shadows.
    airlight_efficiency: Option<f64>,
    picture_rmse: Option<f64>,
    picture_efficiency: Option<f64>,
}

/// The figures, and the pictures side by side.
pub(super) fn compare(args: &Args, scene: &Scene) -> Result<(Comparison, Picture)> {
    let contestants = contestants(args)?;
    let progress = progress::bar((contestants.len() + 2) * STEPS)?;
    progress.set_message("reference");
    // Its seeds are its own: shared random numbers would be shared errors.
    let half = |half: u64| {
        let seed = args.seed.wrapping_add(half << 62);
        let settings = Settings { mis: false, seed, ..args.settings(Sampler::new(REFERENCE), Shadows::Plain) };
        Exposure::new(scene, args.size, &settings, Budget::Passes(args.reference.div_ceil(2) as u64))
    };
    let mut halves = [half(1), half(2)];
    Exposure::complete(&mut halves, &progress)?;
    let reference = halves.map(|half| half.film);

    progress.set_message("strategies in turn");
    let exposure = |settings: &Settings| Exposure::new(scene, args.size, settings, args.budget());
    let mut exposures: Vec<Exposure<'_>> = contestants.iter().map(exposure).collect();
    Exposure::complete(&mut exposures, &progress)?;
    progress.finish_and_clear();

    let baseline = contestants.iter().position(|settings| is_baseline(&settings.sampler));
    let airlight = Errors::new(&reference, &exposures, baseline, Film::airlight);
    let picture = Errors::new(&reference, &exposures, baseline, Film::total);
    let row = |(i, (settings, exposure))| Row {
        run: Run::new(settings, exposure),
        airlight_rmse: airlight.rmse(i),
        airlight_efficiency: airlight.efficiency(i),
        picture_rmse: picture.rmse(i),
        picture_efficiency: picture.efficiency(i),
    };
    let results = contestants.iter().zip(&exposures).enumerate().map(row).collect();
    let reference_passes = reference.iter().map(Film::passes).sum();
    let mut pictures = vec![("reference".to_owned(), mean_picture(&reference))];
    let picture = |(settings, e): (&Settings, &Exposure<'_>)| (name(settings), e.film.picture());
    pictures.extend(contestants.iter().zip(&exposures).map(picture));
    let comparison = Comparison { job: args.job(), reference_passes, results };
    Ok((comparison, sheet::lay_out(&pictures, 1.0 / scene.exposure)))
}

/// Every sampler with each estimate of shadows that was asked for.
fn contestants(args: &Args) -> Result<Vec<Settings>> {
    let samplers = samplers(args)?;
    let shadows = if args.shadows.is_empty() { &[Shadows::Plain][..] } else { &args.shadows };
    let settings = |&sampler: &Sampler| shadows.iter().map(move |&shadows| args.settings(sampler, shadows));
    Ok(samplers.iter().flat_map(settings).collect())
}

/// What a picture is called: the strategy, and the estimate of shadows if it is not the plain one.
fn name(settings: &Settings) -> String {
    let strategy = settings.sampler.strategy();
    match settings.shadows {
        Shadows::Plain => strategy.to_string(),
        shadows @ Shadows::Ratio => format!("{strategy} {shadows}"),
    }
}

/// Those asked for, or all; the baseline is among them.
fn samplers(args: &Args) -> Result<Vec<Sampler>> {
    let mut samplers = arguments::samplers(&args.strategy, &[args.precision])?;
    if !samplers.iter().any(is_baseline) {
        samplers.insert(0, Sampler::new(BASELINE).with_precision(args.precision)?);
    }
    Ok(samplers)
}

fn is_baseline(sampler: &Sampler) -> bool {
    sampler.strategy() == BASELINE
}

/// The mean of both halves of the reference.
fn mean_picture(halves: &[Film]) -> Picture {
    let mut picture = Picture::black(halves[0].size());
    for half in halves {
        for (sum, value) in picture.rgb.iter_mut().flatten().zip(half.picture().rgb.iter().flatten()) {
            *sum += value / halves.len() as f32;
        }
    }
    picture
}

/// Mean squared errors and times.
struct Errors {
    rows: Vec<(Option<f64>, f64)>,
    baseline: Option<f64>,
}

impl Errors {
    fn new(
        reference: &[Film],
        exposures: &[Exposure<'_>],
        baseline: Option<usize>,
        mean: impl Fn(&Film) -> Vec<[f64; 3]>,
    ) -> Self {
        let [first, second] = [0, 1].map(|half| mean(&reference[half]));
        let middle: Vec<[f64; 3]> =
            first.iter().zip(&second).map(|(a, b)| std::array::from_fn(|c| 0.5 * (a[c] + b[c]))).collect();
        // The error of the mean of two halves is half their difference; what it adds to all others is taken off them.
        let of_reference = 0.25 * mean_squared(&first, &second);
        let row = |exposure: &Exposure<'_>| {
            let error = mean_squared(&mean(&exposure.film), &middle) - of_reference;
            (Some(error).filter(|error| *error > 0.0), exposure.elapsed.as_secs_f64())
        };
        let rows: Vec<_> = exposures.iter().map(row).collect();
        let mut errors = Self { rows, baseline: None };
        errors.baseline = baseline.and_then(|i| errors.cost(i));
        errors
    }

    fn rmse(&self, i: usize) -> Option<f64> {
        self.rows[i].0.map(f64::sqrt)
    }

    fn cost(&self, i: usize) -> Option<f64> {
        self.rows[i].0.map(|error| error * self.rows[i].1)
    }

    fn efficiency(&self, i: usize) -> Option<f64> {
        Some(self.baseline? / self.cost(i)?)
    }
}

fn mean_squared(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let squares = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).powi(2));
    squares.sum::<f64>() / (3 * a.len()) as f64
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.job)?;
        writeln!(f, "reference: {} passes with {REFERENCE}\n", self.reference_passes)?;

        let mut table = table::new([
            "strategy",
            "precision",
            "shadows",
            "passes",
            "s",
            "Msamples/s",
            "in airlight",
            "RMSE airlight",
            "efficiency",
            "RMSE picture",
            "efficiency",
        ]);
        for row in &self.results {
            let error = |rmse: Option<f64>| rmse.map_or("-".to_owned(), |rmse| format!("{rmse:.2e}"));
            let efficiency = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.2}"));
            table.add_row([
                row.run.strategy.to_owned(),
                row.run.precision.to_owned(),
                row.run.shadows.to_owned(),
                row.run.passes.to_string(),
                format!("{:.2}", row.run.seconds),
                format!("{:.2}", row.run.msamples_per_s),
                format!("{:.0} %", 100.0 * row.run.airlight_share),
                error(row.airlight_rmse),
                efficiency(row.airlight_efficiency),
                error(row.picture_rmse),
                efficiency(row.picture_efficiency),
            ]);
        }
        writeln!(f, "{}", table::text(&table))?;
        writeln!(
            f,
            "\nefficiency: 1/(MSE time) relative to {BASELINE}, its first row; shadows and edges are part of the error"
        )
    }
}
