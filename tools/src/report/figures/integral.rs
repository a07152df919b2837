//! Time per ray against the error of the integral without a sample.

use super::{Figure, TIMES};
use crate::integral::Row;
use crate::report::canvas::{self, Line};
use crate::report::findings::Findings;
use crate::report::palette::{INK, QUIET};
use crate::report::scale::{Scale, around, short};
use anyhow::Result;

/// Our rule and the plain ones, by their names in JSON and in the figure.
const RULES: [(&str, &str); 4] = [
    ("airlight", "airlight"),
    ("gauss-in-angle", "Gauss in the angle"),
    ("steps-in-angle", "angle"),
    ("steps-in-t", "t"),
];

/// Time of a ray, median and 99th percentile of the error, and a name.
struct Point {
    time: f64,
    median: f64,
    p99: f64,
    name: String,
}

fn points(rows: &[Row], (rule, name): (&str, &str)) -> Vec<Point> {
    let of_rule = rows.iter().filter(|row| row.rule == rule).enumerate();
    let point = |(i, row): (usize, &Row)| {
        // The others are joined with the first by a line.
        let name = if i == 0 { format!("{name}, {}", row.nodes) } else { row.nodes.to_string() };
        Some(Point { time: row.ns_per_ray, median: row.median?, p99: row.p99?, name })
    };
    of_rule.filter_map(point).filter(|point| point.median > 0.0).collect()
}

pub(super) fn figure(findings: &Findings<'_>) -> Result<Figure> {
    let rows = &findings.measured.integral.0;
    let rules = RULES.map(|rule| points(rows, rule));
    let all = || rules.iter().flatten();
    let x = Scale::logarithmic("time of a ray [ns]", around(all().map(|point| point.time), 2.4), &TIMES);
    // In f64 medians are far below what f32 has digits for: their lines leave the figure.
    let errors = all().map(|point| point.p99).chain(rules[0].iter().map(|point| point.median));
    let y = Scale::decades("relative error", around(errors, 4.0));
    let title = "Time per ray against the error of the integral";
    let drawing = canvas::draw("figure-6", title, (430, 0), (x, y), |canvas| {
        for (rule, points) in rules.iter().enumerate() {
            let (colour, line) = if rule == 0 { (INK, Line::Bold) } else { (QUIET, Line::Dashed) };
            canvas.line(points.iter().map(|point| (point.time, point.p99)), colour, line)?;
            for point in points {
                canvas.line([point.median, point.p99].map(|y| (point.time, y)).into_iter(), colour, Line::Solid)?;
                canvas.keep_off((point.time, point.median), point.p99);
                canvas.spot((point.time, point.p99), colour)?;
            }
        }
        canvas.names(&all().map(|point| (&*point.name, (point.time, point.p99))).collect::<Vec<_>>())
    })?;
    let eight = rows.iter().find(|row| (row.rule, row.nodes) == ("airlight", 8));
    let told = eight.and_then(|row| {
        let (median, p99, time) = (short(row.median?), short(row.p99?), row.ns_per_ray);
        Some(format!(
            "With 8 nodes half of the rays have an error below {median} and 99 % below {p99}, in {time:.0} ns. "
        ))
    });
    let (set, compared) = rows.first().map_or(("", 0), |row| (row.set, row.compared));
    Ok(Figure {
        title: "The integral without a sample",
        caption: format!(
            "{}Relative errors against quadrature in f64 on {compared} scenes of the set {set}: a dot at what 99 % do not \
             exceed, and a line down to the median; the numbers are evaluations of the integrand. airlight is \
             Integral on one thread, geometry included; angle and t are equal steps in the angle and along the ray. The plain \
             rules are scalar code in f64 without the geometry: their times compare only with each other.",
            told.unwrap_or_default()
        ),
        drawings: vec![drawing],
    })
}
