//! The densities beside what they stand for, from the oracle.

use super::Figure;
use crate::report::canvas::{self, Line};
use crate::report::drawing::Drawing;
use crate::report::palette;
use crate::report::scale::Scale;
use airlight::oracle::Scene;
use airlight::{Emitter, Medium, Ray, Strategy};
use airlight_tools::contender::PRODUCTS;
use anyhow::{Context, Result};
use glam::Vec3;

/// Points of a curve.
const POINTS: usize = 400;

/// A ray from the origin along x, an emitter beside it.
struct Example {
    name: &'static str,
    title: &'static str,
    normal: Option<Vec3>,
    /// `mu_a`, `mu_s`, `g`.
    medium: (f32, f32, f32),
}

/// The emitter's place along the ray and beside it \[m\].
const EMITTER: (f32, f32) = (1.6, 0.5);
/// Length of the rays \[m\].
const LENGTH: f32 = 4.0;

const EXAMPLES: [Example; 4] = [
    Example { name: "figure-3-thin", title: "Thin air, a point emitter", normal: None, medium: (0.0, 0.02, 0.0) },
    Example {
        name: "figure-3-normal",
        title: "Thin air, an emitter that turns away",
        normal: Some(Vec3::new(0.8, -0.6, 0.0)),
        medium: (0.0, 0.02, 0.0),
    },
    Example { name: "figure-3-dense", title: "Dense fog, a point emitter", normal: None, medium: (0.0, 2.5, 0.0) },
    Example {
        name: "figure-3-all",
        title: "Dense, forward (g 0.85), turned away",
        normal: Some(Vec3::new(0.8, -0.6, 0.0)),
        medium: (0.0, 1.5, 0.85),
    },
];

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

impl Example {
    fn scene(&self) -> Result<Scene> {
        let (along, beside) = EMITTER;
        let place = Vec3::new(along, beside, 0.0);
        let emitter = self.normal.map_or_else(|| Emitter::point(place), |n| Emitter::point_normal(place, n))?;
        let (mu_a, mu_s, g) = self.medium;
        let ray = Ray::new(Vec3::ZERO, Vec3::X, 0.0, LENGTH)?;
        Ok(Scene::new(&ray, &emitter, &Medium::new(mu_a, mu_s, g)?))
    }
}

fn drawing(example: &Example) -> Result<Drawing> {
    let scene = example.scene()?;
    let radiance = scene.radiance();
    let (t_min, t_max) = scene.interval();
    let (t_a, t_b) = scene.lit().context("nothing is lit")?;
    let t = |i: usize| t_min + (t_max - t_min) * i as f64 / POINTS as f64;
    let integrand = |t: f64| if t < t_a || t > t_b { 0.0 } else { scene.integrand(t) / radiance };
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
            canvas.line((0..=POINTS).map(t).map(|t| (t, density(t))), palette::colour(strategy), Line::Solid)?;
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

/// A variance in few letters.
fn brief(variance: f64) -> String {
    if variance < 0.01 { format!("{:.0e}", variance.max(0.0)) } else { format!("{variance:.2}") }
}
