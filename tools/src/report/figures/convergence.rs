//! Error of the radiance against time.

use super::{Figure, counted, names};
use crate::report::canvas::{self, Line};
use crate::report::findings::Findings;
use crate::report::palette::{self, QUIET};
use crate::report::scale::{Scale, around, times};
use airlight::Strategy;
use anyhow::Result;
use plotters::style::text_anchor::HPos;

/// Time that is looked at \[s\].
const TIME: (f64, f64) = (1e-3, 1e2);
/// Where the markers are \[s\].
const MARKED: [f64; 2] = [1e-2, 1e1];

pub(super) fn figure(findings: &Findings<'_>) -> Result<Figure> {
    let sample = &findings.measured.sample;
    // The relative error after one second: it falls as the root of the time.
    let after_one = |strategy: Strategy| {
        let row = sample.results.iter().find(|row| row.strategy == strategy.name())?;
        let seconds = row.rays as f64 / (1e6 * row.msamples_per_s);
        let error = row.radiance_stderr? / row.radiance? * seconds.sqrt();
        (error > 0.0).then_some(error)
    };
    let errors: Vec<(Strategy, f64)> =
        Strategy::ALL.iter().filter_map(|&strategy| Some((strategy, after_one(strategy)?))).collect();
    let at = |error: f64, time: f64| error / time.sqrt();
    let resampled = &findings.measured.resampled;
    let of_resampling = resampled.error_after_one_second();
    let all = errors.iter().map(|&(_, error)| error).chain(of_resampling);
    let ends = all.flat_map(|error| [at(error, TIME.0), at(error, TIME.1)]);
    let (lowest, highest) = around(ends, 1.5);
    let x = Scale::decades("time in the sampler [s]", TIME);
    let y = Scale::decades("relative error of the radiance", (lowest, highest));
    let drawing = canvas::draw("figure-5", "Error of the radiance against time", (400, 5), (x, y), |canvas| {
        for &(strategy, error) in &errors {
            let line = [TIME.0, TIME.1].map(|time| (time, at(error, time)));
            canvas.line(line.into_iter(), palette::colour(strategy), palette::line(strategy))?;
            for time in MARKED {
                canvas.marker(strategy, (time, at(error, time)))?;
            }
        }
        if let Some(error) = of_resampling {
            let line = [TIME.0, TIME.1].map(|time| (time, at(error, time)));
            canvas.line(line.into_iter(), QUIET, Line::Dashed)?;
            canvas.say(
                &format!("dashed without markers: {}", resampled.name()),
                (0.9 * TIME.1, 0.5 * highest),
                HPos::Right,
            )?;
        }
        canvas.legend(&names())
    })?;
    let best = errors.iter().min_by(|a, b| a.1.total_cmp(&b.1));
    let theirs = errors.iter().find(|(strategy, _)| *strategy == Strategy::EquiAngular);
    let told = best.zip(theirs).map_or(String::new(), |((best, ours), (other, theirs))| {
        let times = times((theirs / ours).powi(2));
        format!("{best} comes to any error in the least time: {other} needs {times} times as much. ")
    });
    Ok(Figure {
        title: "Error of the radiance against time",
        caption: format!(
            "{told}Root-mean-square error of the mean radiance of the wavefront {}, {}; lines of slope -1/2 from \
             the standard errors and times of {} samples each, in {} precision. Dashed without markers is the {}, one of which is chosen in \
             proportion to f/p.",
            sample.wavefront,
            counted(sample.threads),
            sample.rays,
            findings.precision,
            resampled.name()
        ),
        drawings: vec![drawing],
    })
}
