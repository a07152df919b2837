//! Time per sample against relative variance.

use super::{Figure, TIMES};
use crate::report::canvas::{self, Canvas, Line};
use crate::report::drawing::Drawing;
use crate::report::findings::{Finding, Findings};
use crate::report::palette::{self, QUIET};
use crate::report::scale::{Scale, around, short, times};
use airlight::Strategy;
use anyhow::Result;

/// A strategy's point: time, variance.
type Point = (Strategy, (f64, f64));

pub(super) fn figure(findings: &Findings<'_>) -> Result<Figure> {
    let points = |variance: fn(&Finding) -> f64| -> Vec<Point> {
        let point = |finding: &Finding| (finding.strategy, (finding.ns_per_sample, variance(finding)));
        findings.of_one().map(point).filter(|(_, (x, y))| *x > 0.0 && *y > 0.0 && y.is_finite()).collect()
    };
    let canonical = points(|finding| finding.variance_canonical);
    let broad = points(|finding| finding.variance_broad);
    let scenes = findings.measured.canonical.0.first().map_or(0, |row| row.scenes);
    let best = findings.of_one().max_by(|a, b| a.efficiency.total_cmp(&b.efficiency));
    let best = best.map_or(String::new(), |best| {
        let than = times(best.efficiency);
        format!(
            "{} gets the same error in the least time, {than} times as efficiently as equi-angular: ",
            best.strategy
        )
    });
    let whiskers: Vec<(Point, f64)> =
        broad.iter().copied().zip(findings.of_one().map(|finding| finding.variance_broad_p90)).collect();
    Ok(Figure {
        title: "What a sample costs and what it is worth",
        caption: format!(
            "{best}along a dashed line 1/(V time) is the same, in multiples of that of equi-angular; the grey line joins \
             those that no other beats in both. In the first drawing V is the mean over {scenes} canonical scenes of each of four \
             kinds; in the second the median over the broad set, with a line up to what a tenth of it exceeds. Times are \
             those in {} precision.",
            findings.precision
        ),
        drawings: vec![
            drawing(
                "figure-1-canonical",
                "Time per sample against mean relative variance, canonical scenes",
                "mean V, canonical scenes",
                &canonical,
                &[],
            )?,
            drawing(
                "figure-1-broad",
                "Time per sample against median relative variance, broad set",
                "median V, broad set",
                &broad,
                &whiskers,
            )?,
        ],
    })
}

fn drawing(name: &str, title: &str, axis: &str, points: &[Point], whiskers: &[(Point, f64)]) -> Result<Drawing> {
    let x = Scale::logarithmic("time of a sample [ns]", around(points.iter().map(|(_, (x, _))| *x), 1.6), &TIMES);
    let (low, high) = around(points.iter().map(|(_, (_, y))| *y), 4.0);
    let highest = whiskers.iter().map(|(_, worst)| *worst).filter(|worst| worst.is_finite()).fold(high, f64::max);
    // A few scenes are as bad as can be: the line then leaves the figure.
    let y = Scale::decades(axis, (low, highest.min(1e3 * high)));
    canvas::draw(name, title, (430, 0), (x, y), |canvas| {
        if let Some((_, (time, variance))) = points.iter().find(|(strategy, _)| *strategy == Strategy::EquiAngular) {
            isolines(canvas, time * variance, points)?;
        }
        canvas.line(front(points).into_iter(), QUIET, Line::Bold)?;
        for &((strategy, (x, y)), worst) in whiskers {
            canvas.line([(x, y), (x, worst)].into_iter(), palette::colour(strategy), Line::Solid)?;
            canvas.keep_off((x, y), worst);
        }
        for &(strategy, point) in points {
            canvas.marker(strategy, point)?;
        }
        canvas.names(&points.iter().map(|(strategy, point)| (strategy.name(), *point)).collect::<Vec<_>>())
    })
}

/// Lines along which time and variance have the same product: powers of ten of that of equi-angular.
fn isolines(canvas: &mut Canvas<'_>, one: f64, points: &[Point]) -> Result<()> {
    let (fast, _) = around(points.iter().map(|(_, (x, _))| *x), 1.6);
    let (_, slow) = around(points.iter().map(|(_, (x, _))| *x), 1.6);
    let least = points.iter().map(|(_, (x, y))| x * y).fold(f64::INFINITY, f64::min);
    for power in 0..=(one / least).log10().ceil().max(0.0) as i32 {
        let (multiple, product) = (10f64.powi(power), one / 10f64.powi(power));
        canvas.line([(fast, product / fast), (slow, product / slow)].into_iter(), QUIET, Line::Dashed)?;
        if power % 2 == 0 {
            canvas.say(&format!("{}x", short(multiple)), (slow * 0.98, product / slow))?;
        }
    }
    Ok(())
}

/// The points of which none other has both less time and less variance.
fn front(points: &[Point]) -> Vec<(f64, f64)> {
    let beaten = |(x, y): (f64, f64)| points.iter().any(|&(_, (a, b))| a <= x && b <= y && (a, b) != (x, y));
    let mut front: Vec<(f64, f64)> = points.iter().map(|&(_, point)| point).filter(|&point| !beaten(point)).collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    front
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_has_those_that_none_beats() {
        let points = [(1.0, 9.0), (2.0, 3.0), (3.0, 4.0), (4.0, 1.0)].map(|point| (Strategy::EquiAngular, point));
        assert_eq!(front(&points), [(1.0, 9.0), (2.0, 3.0), (4.0, 1.0)]);
    }
}
