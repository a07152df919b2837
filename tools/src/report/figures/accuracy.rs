//! Time per sample against numerical error.

use crate::report::canvas::{self, Line};
use crate::report::drawing::Drawing;
use crate::report::findings::{Finding, Findings, Other};
use crate::report::palette::QUIET;
use crate::report::scale::{Scale, around};
use airlight::Precision;
use anyhow::Result;
use plotters::style::text_anchor::HPos;

/// The same figure of exact arithmetic and of other f32 implementations, as docs/accuracy.md has it: measured once, on such rays.
const PUBLISHED: [(&str, f64); 4] = [
    ("exact arithmetic rounded once:", 2.0e-6),
    ("others, taylor-transmittance:", 2e-1),
    ("others, point-normal:", 1e-2),
    ("others, equi-angular:", 2e-5),
];

fn ours<'a>(findings: &'a Findings<'_>) -> impl Iterator<Item = &'a Finding> {
    findings.all.iter().filter(|of| of.ns_per_sample > 0.0 && of.cdf_p999 > 0.0)
}

/// In every precision, with peers.
pub(super) fn drawing(findings: &Findings<'_>, height: i32, (x, (fast, slow)): (Scale, (f64, f64))) -> Result<Drawing> {
    let others: Vec<Other> = findings.others();
    // Peers that were measured stand for what was published.
    let published = if others.is_empty() { &PUBLISHED[..] } else { &PUBLISHED[..1] };
    let (low, _) = around(ours(findings).map(|of| of.cdf_p999), 8.0);
    let y = Scale::decades("error of the CDF, p99.9", (low, 1.0));
    canvas::draw("accuracy", "Time per sample against numerical error", (height, 0), (x, y), |canvas| {
        for (text, error) in published {
            canvas.line([(fast, *error), (slow, *error)].into_iter(), QUIET, Line::Dashed)?;
            // Where the markers are, below the line.
            let below = if *error < 1e-5 { 15.0 } else { 1.0 };
            canvas.say(&format!("{text} {error:.0e}"), (slow * 0.98, error / below), HPos::Right)?;
        }
        for of in ours(findings) {
            canvas.marker_of(of.strategy, of.precision, (of.ns_per_sample, of.cdf_p999))?;
        }
        let point = |other: &Other| (other.ns_per_sample, other.cdf_p999);
        for other in &others {
            canvas.spot(point(other), QUIET)?;
        }
        canvas.names(&others.iter().map(|other| (&*other.name, point(other))).collect::<Vec<_>>())
    })
}

/// What there is to see.
pub(super) fn caption(findings: &Findings<'_>) -> String {
    let worst = |precision: &Precision| {
        let of_precision = ours(findings).filter(|of| of.precision == *precision);
        let worst = of_precision.max_by(|a, b| a.cdf_p999.total_cmp(&b.cdf_p999))?;
        Some(format!("{:.1e} in {precision} precision ({})", worst.cdf_p999, worst.strategy))
    };
    let worst: Vec<String> = Precision::ALL.iter().filter_map(worst).collect();
    let others = if findings.others().is_empty() {
        "Dashed lines are the published errors of other f32 implementations, and that of exact arithmetic; this run did not \
         measure them."
    } else {
        "Grey dots are kernels of others, vectorised for the same width, on rays in the same box; 4 and 8 are the steps of their iterations. The dashed line is the error \
         of exact arithmetic, which this run did not measure."
    };
    format!("Below: the |CDF(t) - u| that 0.1 % of ordinary rays exceed, at most {}. {others}", worst.join(" and "))
}
