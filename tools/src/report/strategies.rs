//! The plot on the documentation's page of each strategy: its density beside the integrand, in thin air and in dense fog.
//!
//! They stand inline in pages of light and dark themes: ink is `currentColor`, and the line has a colour for both.

use super::examples::{self, Example, brief, normalised};
use crate::output::Target;
use airlight::{Sampler, Strategy};
use anyhow::{Context, Result};
use std::fmt::Write;
use std::fs;
use std::path::Path;

const PANELS: [(Example, &str); 2] =
    [(examples::THIN_AWAY, "thin air: mu_s 0.02 /m, g 0"), (examples::DENSE_AWAY, "dense fog: mu_s 1.5 /m, g 0.85")];
/// Line of the density, on light and on dark ground.
const LINE: &str = "#D55E00";
/// Points of a curve.
const POINTS: u32 = 100;

/// Units of the page: of the whole, of a panel, of its axes' left, top, width and height.
const WIDTH: u32 = 540;
const HEIGHT: u32 = 204;
const PANEL: u32 = 270;
const AXES: [u32; 4] = [32, 30, 220, 120];
/// Units of a curve for one of the page: its coordinates are whole numbers.
const FINE: f64 = 10.0;

/// Writes a file for each strategy, named after it.
pub(super) fn write(folder: &Path) -> Result<()> {
    fs::create_dir_all(folder).with_context(|| format!("cannot write {}", folder.display()))?;
    for &strategy in Strategy::ALL {
        Target::file(&folder.join(format!("{strategy}.svg")))?.write(drawing(strategy)?.as_bytes())?;
    }
    Ok(())
}

fn drawing(strategy: Strategy) -> Result<String> {
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
         style=\"max-width:100%;height:auto\" role=\"img\" aria-label=\"The density of {strategy} beside the integrand\" \
         font-family=\"sans-serif\" font-size=\"15\" fill=\"currentColor\">\n"
    );
    for (left, (example, title)) in (0..).step_by(PANEL as usize).zip(&PANELS) {
        panel(&mut svg, left, strategy, example, title)?;
    }
    let [left, ..] = AXES;
    let y = HEIGHT - 6;
    let _ = write!(
        svg,
        "<rect x=\"{left}\" y=\"{}\" width=\"22\" height=\"12\" opacity=\".25\"/><text x=\"{}\" y=\"{y}\">integrand</text>\n\
         <path d=\"M{} {}h22\" stroke=\"{LINE}\" stroke-width=\"3\"/><text x=\"{}\" y=\"{y}\">{strategy}</text>\n</svg>\n",
        y - 11,
        left + 28,
        left + 110,
        y - 5,
        left + 138
    );
    Ok(svg)
}

/// Axes, the integrand as an area, the density as a line, its relative variance.
fn panel(svg: &mut String, panel: u32, strategy: Strategy, example: &Example, title: &str) -> Result<()> {
    let (ray, emitter, medium) = example.inputs()?;
    let (scene, sampler) = (example.scene()?, Sampler::new(strategy));
    let integrand = normalised(&scene);
    let (t_min, t_max) = scene.interval();
    let t = |i: u32| t_min + (t_max - t_min) * f64::from(i) / f64::from(POINTS);
    let top = 1.25 * (0..=POINTS).map(|i| integrand(t(i))).fold(0.0, f64::max);

    let [left, above, width, height] = AXES;
    let (left, below) = (panel + left, above + height);
    let place = |i: u32, density: f64| {
        let across = f64::from(width) * f64::from(i) / f64::from(POINTS);
        // What is above the frame is not shown, however far.
        let down = f64::from(height) * (1.0 - density.min(2.0 * top) / top);
        ((FINE * across).round() as i32, (FINE * down).round() as i32)
    };
    let curve = |density: &dyn Fn(f64) -> f64| path((0..=POINTS).map(|i| place(i, density(t(i)))));
    let density = |t: f64| f64::from(sampler.pdf_one(&ray, &emitter, &medium, t as f32));
    let (right, bottom) = (FINE * f64::from(width), FINE * f64::from(height));
    let variance = scene.relative_variance(strategy).filter(|variance| variance.is_finite());
    let variance = variance.map_or("no bound".to_owned(), brief);

    let _ = write!(
        svg,
        "<text x=\"{left}\" y=\"18\">{title}</text>\n\
         <svg x=\"{left}\" y=\"{above}\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {right} {bottom}\">\n\
         <path d=\"{}V{bottom}H0z\" opacity=\".25\"/>\n\
         <path d=\"{}\" fill=\"none\" stroke=\"{LINE}\" stroke-width=\"25\" stroke-linejoin=\"round\"/></svg>\n\
         <text x=\"{}\" y=\"{}\" text-anchor=\"end\">V = {variance}</text>\n",
        curve(&integrand),
        curve(&density),
        left + width,
        above + 16,
    );
    let mut axes = format!("M{left} {above}V{below}h{width}");
    let every = if top > 1.25 { 1.0 } else { 0.5 };
    for density in (0..).map(|i| every * f64::from(i)).take_while(|density| *density < top) {
        let y = f64::from(below) - f64::from(height) * density / top;
        let _ = write!(axes, "M{left} {y:.0}h-4");
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{:.0}\" text-anchor=\"end\">{density}</text>", left - 7, y + 5.0);
    }
    for metres in 0..=4 {
        let x = left + width * metres / 4;
        let _ = write!(axes, "M{x} {below}v4");
        let unit = if metres == 4 { "&#160;m" } else { "" };
        let _ = writeln!(svg, "<text x=\"{x}\" y=\"{}\" text-anchor=\"middle\">{metres}{unit}</text>", below + 20);
    }
    let _ = writeln!(svg, "<path d=\"{axes}\" fill=\"none\" stroke=\"currentColor\" opacity=\".6\"/>");
    Ok(())
}

/// A line through points, each told by its distance from the last.
fn path(points: impl Iterator<Item = (i32, i32)>) -> String {
    let mut path = String::new();
    let mut last = None;
    for (x, y) in points {
        let _ = match last {
            None => write!(path, "M{x} {y}l"),
            Some((from_x, from_y)) => write!(path, "{} {} ", x - from_x, y - from_y),
        };
        last = Some((x, y));
    }
    path.trim_end().to_owned()
}
