//! The figures, a file each.

mod accuracy;
mod convergence;
mod densities;
mod integral;
mod noise;
mod overview;
mod throughput;

use super::drawing::Drawing;
use super::findings::Findings;
use airlight::{Precision, Strategy};
use anyhow::Result;

/// Ticks of the time of a sample \[ns\].
const TIMES: [f64; 10] = [2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0];

/// One or more drawings and what to see in them.
pub(super) struct Figure {
    pub(super) title: &'static str,
    pub(super) caption: String,
    pub(super) drawings: Vec<Drawing>,
}

/// A sampler's time and what is shown against it.
#[derive(Clone, Copy, Debug)]
struct Point {
    strategy: Strategy,
    precision: Precision,
    place: (f64, f64),
}

/// All of them: that of the first screen, then the others.
pub(super) fn all(findings: &Findings<'_>) -> Result<Vec<Figure>> {
    Ok(vec![
        overview::figure(findings)?,
        noise::figure(findings)?,
        densities::figure()?,
        throughput::figure(findings)?,
        convergence::figure(findings)?,
        integral::figure(findings)?,
    ])
}

/// One thread, two threads.
fn counted(threads: usize) -> String {
    format!("{threads} {}", if threads == 1 { "thread" } else { "threads" })
}

/// The legend of lines.
fn names() -> Vec<(Strategy, String)> {
    Strategy::ALL.iter().map(|&strategy| (strategy, strategy.name().to_owned())).collect()
}
