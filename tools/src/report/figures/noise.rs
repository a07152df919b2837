//! Time per sample against relative variance.

use super::{Figure, Point, TIMES};
use crate::report::canvas::{self, Canvas, Line};
use crate::report::drawing::Drawing;
use crate::report::findings::{Finding, Findings};
use crate::report::palette::{self, QUIET};
use crate::report::scale::{Scale, around, short};
use airlight::Strategy;
use anyhow::Result;
use plotters::style::text_anchor::HPos;

/// The points whose variance is known.
pub(super) fn points<'a>(
    findings: impl Iterator<Item = &'a Finding>,
    variance: fn(&Finding) -> f64,
) -> impl Iterator<Item = Point> {
    let point = move |finding: &Finding| Point {
        strategy: finding.strategy,
        precision: finding.precision,
        place: (finding.ns_per_sample, variance(finding)),
    };
    findings.map(point).filter(|Point { place: (x, y), .. }| *x > 0.0 && *y > 0.0 && y.is_finite())
}

/// The broad set, in one precision.
pub(super) fn figure(findings: &Findings<'_>) -> Result<Figure> {
    let points: Vec<Point> = points(findings.of_one(), |finding| finding.variance_broad).collect();
    let worst = findings.of_one().map(|finding| finding.variance_broad_p90);
    let whiskers: Vec<(Point, f64)> = points.iter().copied().zip(worst).collect();
    let (fast, slow) = around(points.iter().map(|point| point.place.0), 1.6);
    let title = "Time per sample against median noise, broad set of scenes";
    let axis = "median V, broad set";
    let x = Scale::logarithmic("time of a sample [ns]", (fast, slow), &TIMES);
    Ok(Figure {
        title: "The same on a broad set of scenes",
        caption: format!(
            "The median of the relative variance V over thin and dense media, near and far emitters, and all g; an upright \
             line leads to the V that a tenth of the scenes exceed. Times are those of {} precision.",
            findings.precision
        ),
        drawings: vec![drawing(("figure-2", title, axis), 430, (x, (fast, slow)), &points, &whiskers)?],
    })
}

/// A marker for each point, with the line of those that no other beats and the lines of equal efficiency.
pub(super) fn drawing(
    (name, title, axis): (&str, &str, &str),
    height: i32,
    (x, times): (Scale, (f64, f64)),
    points: &[Point],
    whiskers: &[(Point, f64)],
) -> Result<Drawing> {
    let (low, high) = around(points.iter().map(|point| point.place.1), 4.0);
    let highest = whiskers.iter().map(|(_, worst)| *worst).filter(|worst| worst.is_finite()).fold(high, f64::max);
    // A few scenes are as bad as can be: the line then leaves the figure.
    let y = Scale::decades(axis, (low, highest.min(1e3 * high)));
    canvas::draw(name, title, (height, 0), (x, y), |canvas| {
        if let Some(point) = points.iter().find(|point| point.strategy == Strategy::EquiAngular) {
            isolines(canvas, times, point.place.0 * point.place.1, points)?;
        }
        canvas.line(front(points).into_iter(), QUIET, Line::Bold)?;
        for &(Point { strategy, place: (x, y), .. }, worst) in whiskers {
            canvas.line([(x, y), (x, worst)].into_iter(), palette::colour(strategy), Line::Solid)?;
            canvas.keep_off((x, y), worst);
        }
        for point in points {
            canvas.marker_of(point.strategy, point.precision, point.place)?;
        }
        // Of two precisions the first has the name.
        let named = |&(i, point): &(usize, &Point)| points[..i].iter().all(|other| other.strategy != point.strategy);
        let names = points.iter().enumerate().filter(named);
        canvas.names(&names.map(|(_, point)| (point.strategy.name(), point.place)).collect::<Vec<_>>())
    })
}

/// Lines along which time and variance have the same product: powers of ten of that of equi-angular.
fn isolines(canvas: &mut Canvas<'_>, (fast, slow): (f64, f64), one: f64, points: &[Point]) -> Result<()> {
    let least = points.iter().map(|point| point.place.0 * point.place.1).fold(f64::INFINITY, f64::min);
    for power in 0..=(one / least).log10().ceil().max(0.0) as i32 {
        let (multiple, product) = (10f64.powi(power), one / 10f64.powi(power));
        canvas.line([(fast, product / fast), (slow, product / slow)].into_iter(), QUIET, Line::Dashed)?;
        if power % 2 == 0 {
            canvas.say(&format!("{}x", short(multiple)), (fast * 1.02, product / fast), HPos::Left)?;
        }
    }
    Ok(())
}

/// The points of which none other has both less time and less variance.
fn front(points: &[Point]) -> Vec<(f64, f64)> {
    let beaten =
        |(x, y): (f64, f64)| points.iter().any(|&Point { place: (a, b), .. }| a <= x && b <= y && (a, b) != (x, y));
    let mut front: Vec<(f64, f64)> = points.iter().map(|point| point.place).filter(|&point| !beaten(point)).collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    front
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::Precision;

    #[test]
    fn the_front_has_those_that_none_beats() {
        let points = [(1.0, 9.0), (2.0, 3.0), (3.0, 4.0), (4.0, 1.0)].map(|place| {
            let (strategy, precision) = (Strategy::EquiAngular, Precision::Exact);
            Point { strategy, precision, place }
        });
        assert_eq!(front(&points), [(1.0, 9.0), (2.0, 3.0), (4.0, 1.0)]);
    }
}
