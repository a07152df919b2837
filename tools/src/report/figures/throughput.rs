//! Throughput by size of batch, threads and backend, beside the limits of the machine.

use super::{Figure, counted, names};
use crate::profile::Row;
use crate::report::canvas::{self, Line};
use crate::report::drawing::Drawing;
use crate::report::findings::Findings;
use crate::report::palette::{self, QUIET};
use crate::report::scale::{Scale, around};
use airlight::{Backend, Strategy};
use anyhow::Result;
use plotters::style::text_anchor::HPos;

const SPEEDS: [f64; 12] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0];
const TITLE: &str = "million samples / s";

pub(super) fn figure(findings: &Findings<'_>) -> Result<Figure> {
    let rows = &findings.measured.profile.0;
    let mut threads: Vec<usize> = rows.iter().map(|row| row.subject.threads).collect();
    threads.sort_unstable();
    threads.dedup();
    let mut drawings = threads.iter().map(|&threads| by_batch(findings, threads)).collect::<Result<Vec<_>>>()?;
    drawings.push(by_backend(findings)?);
    let nearest = findings
        .times(findings.precision, 1)
        .filter(|row| row.subject.backend == Some(findings.backend.name()) && row.subject.rays == Some(findings.batch))
        .max_by(|a, b| a.share.unwrap_or(0.0).total_cmp(&b.share.unwrap_or(0.0)));
    let nearest = nearest.map_or(String::new(), |row| {
        let (strategy, share) = (row.subject.strategy.unwrap_or_default(), 100.0 * row.share.unwrap_or(0.0));
        let limit = match row.bound_by {
            Some("fma") => "its multiply-adds",
            Some("division") => "its divisions",
            _ => "its columns",
        };
        format!(
            "{strategy} comes nearest to what the machine allows: {limit} alone would take {share:.0} % of its time. "
        )
    });
    Ok(Figure {
        title: "Throughput and the limits of the machine",
        caption: format!(
            "{nearest}The dashed line without markers is memory: reading and writing the columns of the samples and nothing else. The \
             last drawing is of one thread and batches of {} rays; at its right is what arithmetic alone would \
             allow the fastest backend, {}. All are in {} precision.",
            findings.batch,
            findings.backend.name(),
            findings.precision
        ),
        drawings,
    })
}

/// Every strategy with the fastest backend.
fn by_batch(findings: &Findings<'_>, threads: usize) -> Result<Drawing> {
    let point = |row: &Row| Some((row.subject.rays? as f64, row.msamples_per_s?));
    let of = |strategy: Strategy| -> Vec<(f64, f64)> {
        let rows = findings
            .times(findings.precision, threads)
            .filter(|row| row.subject.backend == Some(findings.backend.name()));
        ascending(rows.filter(|row| row.subject.strategy == Some(strategy.name())).filter_map(point))
    };
    let stream = |row: &&Row| row.subject.limit == Some("stream") && row.subject.threads == threads;
    let memory = ascending(findings.measured.profile.0.iter().filter(stream).filter_map(point));
    let points = || Strategy::ALL.iter().flat_map(|&strategy| of(strategy)).chain(memory.clone());
    let sizes: Vec<f64> = memory.iter().map(|(rays, _)| *rays).collect();
    let x = Scale::logarithmic("rays of a batch", around(sizes.iter().copied(), 1.7), &sizes);
    let y = Scale::logarithmic(TITLE, around(points().map(|(_, speed)| speed), 1.5), &SPEEDS);
    let title = format!("Throughput by size of the batch, {}", counted(threads));
    canvas::draw(&format!("figure-4-threads-{threads}"), &title, (340, 5), (x, y), |canvas| {
        canvas.line(memory.iter().copied(), QUIET, Line::Dashed)?;
        if let Some(&last) = memory.last() {
            canvas.say("memory", last, HPos::Right)?;
        }
        for &strategy in Strategy::ALL {
            canvas.line(of(strategy).into_iter(), palette::colour(strategy), palette::line(strategy))?;
            for point in of(strategy) {
                canvas.marker(strategy, point)?;
            }
        }
        canvas.legend(&names())
    })
}

/// Every backend, one thread.
fn by_backend(findings: &Findings<'_>) -> Result<Drawing> {
    let mut backends: Vec<Backend> = Backend::available().collect();
    let time = |strategy, backend| findings.time((strategy, findings.precision), backend, findings.batch);
    backends.retain(|&backend| time(Strategy::EquiAngular, backend).is_some());
    let speed =
        |&backend: &Backend| time(Strategy::EquiAngular, backend).and_then(|row| row.msamples_per_s).unwrap_or(0.0);
    backends.sort_by(|a, b| speed(a).total_cmp(&speed(b)));
    let fastest = backends.len();
    let limit = |strategy: Strategy| {
        let row = time(strategy, findings.backend)?;
        Some(row.msamples_per_s? / row.share?)
    };
    let speeds = |strategy: Strategy| -> Vec<(f64, f64)> {
        let speed = |(i, &backend)| Some((i as f64, time(strategy, backend)?.msamples_per_s?));
        backends.iter().enumerate().filter_map(speed).collect()
    };
    let all =
        Strategy::ALL.iter().flat_map(|&strategy| speeds(strategy).into_iter().map(|(_, y)| y).chain(limit(strategy)));
    let y = Scale::logarithmic(TITLE, around(all, 1.5), &SPEEDS);
    let mut ticks: Vec<String> = backends.iter().map(|backend| backend.name().to_owned()).collect();
    ticks.push("limit".to_owned());
    let x = Scale::named("", &ticks);
    canvas::draw("figure-4-backends", "Throughput by backend, one thread", (340, 5), (x, y), |canvas| {
        for &strategy in Strategy::ALL {
            let points = speeds(strategy);
            canvas.line(points.iter().copied(), palette::colour(strategy), Line::Solid)?;
            if let Some((last, limit)) = points.last().copied().zip(limit(strategy)) {
                let end = (fastest as f64, limit);
                canvas.line([last, end].into_iter(), palette::colour(strategy), Line::Dashed)?;
                canvas.marker(strategy, end)?;
            }
            for point in points {
                canvas.marker(strategy, point)?;
            }
        }
        canvas.legend(&names())
    })
}

fn ascending(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = points.collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}
