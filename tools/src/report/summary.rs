//! The first screen: what the measurements say in a few sentences, and the table.

use super::findings::{Finding, Findings};
use super::palette;
use super::scale::times;
use airlight::{Precision, Strategy};
use std::fmt::Write;

/// When to take a strategy.
fn use_of(strategy: Strategy, precision: Precision) -> &'static str {
    match (precision, strategy) {
        (Precision::Fast, _) => "where the sampler shows in a profile",
        (_, Strategy::Transmittance) => "second density, for MIS",
        (_, Strategy::EquiAngular) => "thin media, emitters without a normal",
        (_, Strategy::PointNormal) => "thin media, surfaces that emit",
        (_, Strategy::TaylorTransmittance | Strategy::TaylorPhase) => "to compare with the paper",
        (_, Strategy::Product3) => "seldom",
        (_, Strategy::Product5) => "the default",
        (_, Strategy::Product9) => "several samples per ray",
        (_, Strategy::Product17) => "many samples per ray, no shadows",
        _ => "",
    }
}

/// Which strategy, how fast, how noisy; how wrong, in which precision.
pub(super) fn answer(findings: &Findings<'_>) -> String {
    let mut answer = String::new();
    let default = findings.all.iter().find(|of| of.strategy == Strategy::default());
    if let Some(Finding { strategy, ns_per_sample, variance_canonical, efficiency, .. }) = default {
        let _ = write!(
            answer,
            "Take {strategy}, the default: {ns_per_sample:.1} ns a sample, relative variance V {variance_canonical:.1e}, {} times \
             the efficiency of equi-angular. ",
            times(*efficiency)
        );
    }
    let worst = |precision| {
        let errors = findings.all.iter().filter(move |of| of.precision == precision).map(|of| of.cdf_p999);
        errors.fold(f64::NAN, f64::max)
    };
    let [exact, fast] = [Precision::Exact, Precision::Fast].map(worst);
    if exact.is_finite() {
        let _ = write!(answer, "In exact precision |CDF(t) - u| is below {exact:.1e} for 99.9 % of ordinary rays. ");
    }
    let gains = findings.all.iter().filter(|of| of.precision == Precision::Fast).filter_map(|fast| {
        let exact = |of: &&Finding| (of.strategy, of.precision) == (fast.strategy, Precision::Exact);
        Some(findings.all.iter().find(exact)?.ns_per_sample / fast.ns_per_sample)
    });
    let gains: Vec<f64> = gains.filter(|gain| gain.is_finite()).collect();
    if let Some((least, most)) = gains.iter().copied().reduce(f64::min).zip(gains.iter().copied().reduce(f64::max)) {
        let (least, most) = (times(least), times(most));
        let gain = if least == most { most } else { format!("{least} to {most}") };
        let _ = write!(
            answer,
            "Fast precision, where a strategy has it, is {gain} times as fast; there it is below {fast:.1e}."
        );
    }
    answer
}

/// A row per strategy and precision; a dash is a figure that nothing was found of.
pub(super) fn table(findings: &[Finding]) -> String {
    findings.iter().map(row).collect()
}

fn row(finding: &Finding) -> String {
    let Finding { strategy, precision, ns_per_sample, variance_canonical, efficiency, cdf_p999, .. } = finding;
    let corners = palette::marker(*strategy, 16).into_iter().map(|(x, y)| format!("{x},{y}"));
    let corners = corners.collect::<Vec<_>>().join(" ");
    let colour = palette::colour(*strategy).hex();
    let fill = palette::fill(*strategy, *precision).hex();
    let of = |figure: f64, text: &dyn Fn(f64) -> String| if figure.is_nan() { "-".to_owned() } else { text(figure) };
    let few = |figure: f64| if figure < 0.095 { format!("{figure:.1e}") } else { format!("{figure:.2}") };
    // Most are of exact precision.
    let fast = if *precision == Precision::Fast { ", fast" } else { "" };
    let time = of(*ns_per_sample, &|time| format!("{time:.1}"));
    let [variance, error] = [variance_canonical, cdf_p999].map(|figure| of(*figure, &few));
    let efficiency = of(*efficiency, &times);
    let default = if *strategy == Strategy::default() { " class=\"default\"" } else { "" };
    format!(
        "<tr{default}><th scope=\"row\"><svg class=\"key\" viewBox=\"-9 -9 18 18\" aria-hidden=\"true\"><polygon \
         points=\"{corners}\" fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"2\"/></svg> {strategy}{fast}<small>{}</small></th>\
         <td>{time}</td><td>{variance}</td><td>{efficiency}</td><td>{error}</td></tr>\n",
        use_of(*strategy, *precision)
    )
}
