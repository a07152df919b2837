//! Time per sample against numerical error.

use super::{Figure, TIMES, names};
use crate::report::canvas::{self, Line};
use crate::report::findings::Findings;
use crate::report::palette::QUIET;
use crate::report::scale::{Scale, around};
use airlight::Strategy;
use anyhow::Result;

/// The same figure of others, as the README has it: measured once, on such rays.
const PUBLISHED: [(&str, f64); 4] = [
    ("others, taylor-transmittance:", 2e-1),
    ("others, point-normal:", 1e-2),
    ("others, equi-angular:", 2e-5),
    ("exact arithmetic rounded once:", 2.0e-6),
];

pub(super) fn figure(findings: &Findings<'_>) -> Result<Figure> {
    let points: Vec<(Strategy, (f64, f64))> = findings
        .strategies
        .iter()
        .map(|finding| (finding.strategy, (finding.ns_per_sample, finding.cdf_p999)))
        .filter(|(_, (x, y))| *x > 0.0 && *y > 0.0)
        .collect();
    let (fast, slow) = around(points.iter().map(|(_, (x, _))| *x), 1.6);
    let (low, _) = around(points.iter().map(|(_, (_, y))| *y), 8.0);
    let x = Scale::logarithmic("time of a sample [ns]", (fast, slow), &TIMES);
    let y = Scale::decades("error of the CDF at p99.9", (low, 1.0));
    let worst = points.iter().max_by(|(_, a), (_, b)| a.1.total_cmp(&b.1));
    let worst = worst.map_or(String::new(), |(strategy, (_, error))| format!(" (at most {error:.1e}, {strategy})"));
    let drawing = canvas::draw("figure-2", "Time per sample against numerical error", (400, 5), (x, y), |canvas| {
        for (text, error) in PUBLISHED {
            canvas.line([(fast, error), (slow, error)].into_iter(), QUIET, Line::Dashed)?;
            // Where the markers are, below the line.
            let below = if error < 1e-5 { 6.0 } else { 1.0 };
            canvas.say(&format!("{text} {error:.0e}"), (slow * 0.98, error / below))?;
        }
        for &(strategy, point) in &points {
            canvas.marker(strategy, point)?;
        }
        canvas.legend(&names())
    })?;
    Ok(Figure {
        title: "Time and numerical error",
        caption: format!(
            "Every strategy is about as exact as f32 can be{worst}, however fast it is: 0.1 % of generic rays have a larger \
             |CDF(t) - u|. Dashed are the published figures of other f32 implementations and of exact arithmetic, \
             measured once and not by this run."
        ),
        drawings: vec![drawing],
    })
}
