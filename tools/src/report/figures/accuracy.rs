//! Time per sample against numerical error.

use super::{Figure, TIMES, names};
use crate::report::canvas::{self, Line};
use crate::report::findings::{Finding, Findings, Other};
use crate::report::palette::QUIET;
use crate::report::scale::{Scale, around};
use airlight::Precision;
use anyhow::Result;

/// The same figure of exact arithmetic and of others, as the README has it: measured once, on such rays.
const PUBLISHED: [(&str, f64); 4] = [
    ("exact arithmetic rounded once:", 2.0e-6),
    ("others, taylor-transmittance:", 2e-1),
    ("others, point-normal:", 1e-2),
    ("others, equi-angular:", 2e-5),
];

pub(super) fn figure(findings: &Findings<'_>) -> Result<Figure> {
    let ours: Vec<&Finding> = findings.all.iter().filter(|of| of.ns_per_sample > 0.0 && of.cdf_p999 > 0.0).collect();
    let others: Vec<Other> = findings.others();
    // Peers that were measured stand for what was published.
    let published = if others.is_empty() { &PUBLISHED[..] } else { &PUBLISHED[..1] };
    let times = ours.iter().map(|of| of.ns_per_sample).chain(others.iter().map(|other| other.ns_per_sample));
    let (fast, slow) = around(times, 1.6);
    let (low, _) = around(ours.iter().map(|of| of.cdf_p999), 8.0);
    let both = Precision::ALL.iter().all(|&precision| ours.iter().any(|of| of.precision == precision));
    let told = if both { "; filled: exact, hollow: fast" } else { "" };
    let x = Scale::logarithmic(&format!("time of a sample [ns]{told}"), (fast, slow), &TIMES);
    let y = Scale::decades("error of the CDF at p99.9", (low, 1.0));
    let drawing = canvas::draw("figure-2", "Time per sample against numerical error", (400, 5), (x, y), |canvas| {
        for (text, error) in published {
            canvas.line([(fast, *error), (slow, *error)].into_iter(), QUIET, Line::Dashed)?;
            // Where the markers are, below the line.
            let below = if *error < 1e-5 { 6.0 } else { 1.0 };
            canvas.say(&format!("{text} {error:.0e}"), (slow * 0.98, error / below))?;
        }
        for of in &ours {
            canvas.marker_of(of.strategy, of.precision, (of.ns_per_sample, of.cdf_p999))?;
        }
        let point = |other: &Other| (other.ns_per_sample, other.cdf_p999);
        for other in &others {
            canvas.spot(point(other), QUIET)?;
        }
        canvas.names(&others.iter().map(|other| (&*other.name, point(other))).collect::<Vec<_>>())?;
        canvas.legend(&names())
    })?;
    let worst = |precision| {
        let of_precision = ours.iter().filter(|of| of.precision == precision);
        let worst = of_precision.max_by(|a, b| a.cdf_p999.total_cmp(&b.cdf_p999));
        worst.map_or(String::new(), |of| {
            format!(", {:.1e} at most in {precision} precision ({})", of.cdf_p999, of.strategy)
        })
    };
    let dashed = if others.is_empty() {
        "Dashed are the published figures of other f32 implementations and of exact arithmetic, measured once and not \
         by this run."
    } else {
        "Grey are kernels of others of the same width, on rays in the same box; dashed is exact arithmetic, measured once \
         and not by this run."
    };
    Ok(Figure {
        title: "Time and numerical error",
        caption: format!(
            "0.1 % of generic rays have a larger |CDF(t) - u| than is shown{}. {dashed}",
            Precision::ALL.iter().map(|&precision| worst(precision)).collect::<String>()
        ),
        drawings: vec![drawing],
    })
}
