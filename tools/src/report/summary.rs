//! The table of the page.

use super::findings::Finding;
use super::palette;
use super::scale::times;
use std::fmt::Write;

/// A row per strategy and precision; a dash is a figure that nothing was found of.
pub(super) fn table(findings: &[Finding]) -> String {
    let mut rows = String::new();
    for finding in findings {
        let Finding {
            strategy,
            precision,
            ns_per_sample,
            variance_canonical,
            variance_broad,
            efficiency,
            cdf_p999,
            ..
        } = finding;
        let corners = palette::marker(*strategy, 16).into_iter().map(|(x, y)| format!("{x},{y}"));
        let corners = corners.collect::<Vec<_>>().join(" ");
        let colour = palette::colour(*strategy).hex();
        let fill = palette::fill(*strategy, *precision).hex();
        let of =
            |figure: f64, text: &dyn Fn(f64) -> String| if figure.is_nan() { "-".to_owned() } else { text(figure) };
        let time = of(*ns_per_sample, &|time| format!("{time:.1}"));
        let [canonical, broad, error] =
            [variance_canonical, variance_broad, cdf_p999].map(|figure| of(*figure, &|figure| format!("{figure:.1e}")));
        let efficiency = of(*efficiency, &times);
        let _ = writeln!(
            rows,
            "<tr><th scope=\"row\"><svg class=\"key\" viewBox=\"-9 -9 18 18\" aria-hidden=\"true\"><polygon \
             points=\"{corners}\" fill=\"{fill}\" stroke=\"{colour}\"/></svg> {strategy}</th><td>{precision}</td><td>{time}</td>\
             <td>{canonical}</td><td>{broad}</td><td>{efficiency}</td><td>{error}</td></tr>"
        );
    }
    rows
}
