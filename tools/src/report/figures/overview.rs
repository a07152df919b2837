//! Time per sample against noise and against numerical error, on one axis of time.

use super::{Figure, Point, TIMES, accuracy, noise};
use crate::report::drawing::Drawing;
use crate::report::findings::Findings;
use crate::report::scale::{Scale, around};
use airlight::Precision;
use anyhow::Result;

/// Of the two parts.
const HEIGHTS: [i32; 2] = [320, 320];

pub(super) fn figure(findings: &Findings<'_>) -> Result<Figure> {
    let points: Vec<Point> = noise::points(findings.all.iter(), |finding| finding.variance_canonical).collect();
    let others = findings.others();
    let times = points.iter().map(|point| point.place.0).chain(others.iter().map(|other| other.ns_per_sample));
    let range = around(times, 1.6);
    let both = Precision::ALL.iter().all(|&precision| points.iter().any(|point| point.precision == precision));
    let told = if both { "; filled: exact, hollow: fast" } else { "" };
    let x = |title: &str| (Scale::logarithmic(title, range, &TIMES), range);
    let [above, below] = HEIGHTS;
    let names = ("noise", "Time per sample against noise", "noise: mean V, canonical");
    let parts = [
        noise::drawing(names, above, x(""), &points, &[])?,
        accuracy::drawing(findings, below, x(&format!("time of a sample [ns]{told}")))?,
    ];
    let scenes = findings.measured.canonical.0.first().map_or(0, |row| row.scenes);
    Ok(Figure {
        title: "Time of a sample against noise and numerical error",
        caption: format!(
            "Above: the relative variance V of a sample, the mean over {scenes} canonical scenes of each of four kinds. Along a \
             dashed line 1/(V time) is the same, in multiples of that of equi-angular; the grey line joins the samplers that \
             no other beats in both time and V. {}",
            accuracy::caption(findings)
        ),
        drawings: vec![Drawing::stacked("figure-1", "Time of a sample against noise and numerical error", &parts)],
    })
}
