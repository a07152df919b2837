//! The search for the scenes on which the product densities do worst.

use super::{Args, CLIMBS, PRODUCTS};
use crate::progress;
use airlight::Precision;
use airlight_tools::adversary::{Worst, climb};
use airlight_tools::contender::Contender;
use anyhow::Result;
use rayon::prelude::*;
use serde::Serialize;
use std::fmt;

/// Within which `|g|` it searches.
const LARGEST_G: [f32; 2] = [0.9, 0.99];

/// A row per limit of `|g|` and density.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub(super) struct Worsts(Vec<Row>);

/// The worst that was found; lengths in units of `h`.
#[derive(Debug, Serialize)]
struct Row {
    strategy: &'static str,
    /// That of quadrature in f64.
    precision: &'static str,
    largest_g: f32,
    climbs: usize,
    #[serde(flatten)]
    worst: Option<Worst>,
}

/// Climbs from random scenes, as many as asked for.
pub(super) fn search(args: &Args) -> Result<Worsts> {
    let contenders = args.contenders(PRODUCTS.map(Contender::Strategy).into());
    let climbs = args.scenes.unwrap_or(CLIMBS);
    let progress = progress::bar(climbs.saturating_mul(contenders.len() * LARGEST_G.len()))?;
    let mut rows = Vec::new();
    for largest_g in LARGEST_G {
        for &contender in &contenders {
            progress.set_message(format!("|g| <= {largest_g} {}", contender.name()));
            let worst = (0..climbs as u64).into_par_iter().filter_map(|index| {
                let worst = climb(contender, largest_g, args.seed, index);
                progress.inc(1);
                worst
            });
            let worst = worst.max_by(|a, b| a.variance.total_cmp(&b.variance));
            let (strategy, precision) = (Contender::name(contender), Precision::Exact.name());
            rows.push(Row { strategy, precision, largest_g, climbs, worst });
        }
    }
    progress.finish_and_clear();
    Ok(Worsts(rows))
}

impl fmt::Display for Worsts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for row in &self.0 {
            write!(f, "|g| <= {:<4}  {:12}  {}  ", row.largest_g, row.strategy, row.precision)?;
            match &row.worst {
                Some(Worst { variance, place }) => writeln!(f, "{variance:.3e}  at {place}")?,
                None => writeln!(f, "nothing is lit")?,
            }
        }
        writeln!(f, "\nthe largest relative variance of a sample that was found, and its scene")?;
        writeln!(
            f,
            "h: distance from the emitter to the line of the ray; t_h: distance along the ray of the point nearest to the emitter"
        )?;
        writeln!(
            f,
            "beta, alpha: components of the emitter's normal along the ray, and from the emitter towards the ray"
        )
    }
}
