//! The figures, a file each.

mod accuracy;
mod convergence;
mod densities;
mod efficiency;
mod integral;
mod throughput;

use super::drawing::Drawing;
use super::findings::Findings;
use airlight::Strategy;
use anyhow::Result;

/// Ticks of the time of a sample \[ns\].
const TIMES: [f64; 10] = [2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0];

/// One or more drawings and what to see in them.
pub(super) struct Figure {
    pub(super) title: &'static str,
    pub(super) caption: String,
    pub(super) drawings: Vec<Drawing>,
}

/// All of them.
pub(super) fn all(findings: &Findings<'_>) -> Result<Vec<Figure>> {
    Ok(vec![
        efficiency::figure(findings)?,
        accuracy::figure(findings)?,
        densities::figure()?,
        throughput::figure(findings)?,
        convergence::figure(findings)?,
        integral::figure(findings)?,
    ])
}

/// The legend of lines.
fn names() -> Vec<(Strategy, String)> {
    Strategy::ALL.iter().map(|&strategy| (strategy, strategy.name().to_owned())).collect()
}
