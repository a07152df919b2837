//! The table of the page.

use super::findings::Finding;
use super::palette;
use super::scale::times;
use std::fmt::Write;

/// A row per strategy.
pub(super) fn table(findings: &[Finding]) -> String {
    let mut rows = String::new();
    for finding in findings {
        let Finding { strategy, ns_per_sample, variance_canonical, variance_broad, efficiency, cdf_p999, .. } = finding;
        let corners = palette::marker(*strategy, 16).into_iter().map(|(x, y)| format!("{x},{y}"));
        let corners = corners.collect::<Vec<_>>().join(" ");
        let colour = palette::colour(*strategy).hex();
        let efficiency = times(*efficiency);
        let _ = writeln!(
            rows,
            "<tr><th scope=\"row\"><svg class=\"key\" viewBox=\"-9 -9 18 18\" aria-hidden=\"true\"><polygon \
             points=\"{corners}\" fill=\"{colour}\"/></svg> {strategy}</th><td>{ns_per_sample:.1}</td>\
             <td>{variance_canonical:.1e}</td><td>{variance_broad:.1e}</td><td>{efficiency}</td><td>{cdf_p999:.1e}</td></tr>"
        );
    }
    rows
}
