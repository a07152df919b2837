//! The densities beside what they stand for, from the oracle.

use super::Figure;
use crate::report::canvas;
use crate::report::drawing::Drawing;
use crate::report::examples::{self, Example, brief, normalised};
use crate::report::palette;
use crate::report::scale::Scale;
use airlight::Strategy;
use airlight_tools::contender::PRODUCTS;
use anyhow::Result;

/// Points of a curve.
const POINTS: usize = 200;

const EXAMPLES: [Example; 4] = [examples::THIN, examples::THIN_AWAY, examples::DENSE, examples::DENSE_AWAY];

pub(super) fn figure() -> Result<Figure> {
    let drawings = EXAMPLES.iter().map(drawing).collect::<Result<Vec<_>>>()?;
    let last = EXAMPLES[EXAMPLES.len() - 1].scene()?;
    let variance = |strategy| last.relative_variance(strategy).unwrap_or(f64::NAN);
    let others = Strategy::ALL.iter().copied().filter(|strategy| !PRODUCTS.contains(strategy));
    let least = |strategies: &mut dyn Iterator<Item = Strategy>| {
        strategies.min_by(|&a, &b| variance(a).total_cmp(&variance(b)))
    };
    let told = least(&mut others.into_iter()).zip(PRODUCTS.first()).map_or(String::new(), |(other, &product)| {
        format!(
            "In the last scene the best of the others, {other}, has a relative variance of {:.2}, and {product} one of {:.3}. ",
            variance(other),
            variance(product)
        )
    });
    Ok(Figure {
        title: "What is sampled, and in proportion to what",
        caption: format!(
            "Grey is the integrand, normalised: the nearer a density follows it, the smaller the relative variance V. \
             {told}The emitter is 0.5 m beside the ray, at 1.6 m."
        ),
        drawings,
    })
}

fn drawing(example: &Example) -> Result<Drawing> {
    let scene = example.scene()?;
    let integrand = normalised(&scene);
    let (t_min, t_max) = scene.interval();
    let t = |i: usize| t_min + (t_max - t_min) * i as f64 / POINTS as f64;
    let peak = (0..=POINTS).map(|i| integrand(t(i))).fold(0.0, f64::max);
    let x = Scale::linear("t [m]", (t_min, t_max), &[0.0, 1.0, 2.0, 3.0, 4.0]);
    let every = if peak > 2.0 { 1.0 } else { 0.5 };
    let top = 1.25 * peak;
    let y = Scale::linear(
        "density [1/m]",
        (0.0, top),
        &(0..).map(|i| every * f64::from(i)).take_while(|y| *y <= top).collect::<Vec<_>>(),
    );
    canvas::draw(example.name, example.title, (300, 5), (x, y), |canvas| {
        canvas.area((0..=POINTS).map(t).map(|t| (t, integrand(t))))?;
        let mut legend = Vec::new();
        for (place, &strategy) in Strategy::ALL.iter().enumerate() {
            let density = |t: f64| scene.pdf(strategy, t);
            canvas.line(
                (0..=POINTS).map(t).map(|t| (t, density(t))),
                palette::colour(strategy),
                palette::line(strategy),
            )?;
            // Markers apart from each other, where lines run together.
            let spots = (0..5).map(|spot| t((9 * spot + place + 1) * POINTS / 46));
            for t in spots.filter(|&t| density(t) > 0.0 && density(t) < top) {
                canvas.marker(strategy, (t, density(t)))?;
            }
            let variance = scene.relative_variance(strategy).unwrap_or(f64::NAN);
            legend.push((strategy, format!("{strategy}, V {}", brief(variance))));
        }
        canvas.legend(&legend)
    })
}
