//! What `airlight integral` found, as JSON and as a table.

use super::Rule;
use crate::table;
use airlight_tools::errors::quantile;
use airlight_tools::scenes::Set;
use serde::Serialize;
use std::fmt;

/// A row per set and rule.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub(crate) struct Figures(pub(crate) Vec<Row>);

/// The relative errors of one rule on one set; the names of the fields are the keys of the JSON, which others read.
#[derive(Debug, Serialize)]
pub(crate) struct Row {
    pub(crate) rule: &'static str,
    /// Evaluations of the integrand for a ray.
    pub(crate) nodes: usize,
    /// That of the geometry.
    precision: &'static str,
    pub(crate) set: &'static str,
    scenes: usize,
    /// Scenes of which f32 has the radiance with all digits.
    pub(crate) compared: usize,
    pub(crate) median: Option<f64>,
    pub(crate) p99: Option<f64>,
    max: Option<f64>,
    pub(crate) ns_per_ray: f64,
}

impl Row {
    pub(super) fn new(rule: &Rule, set: Set, scenes: usize, mut errors: Vec<f64>, ns_per_ray: f64) -> Self {
        let (rule, nodes, precision) = match rule {
            Rule::Integral(integral) => ("airlight", integral.nodes().count(), integral.precision().name()),
            Rule::Plain(plain) => (plain.name, plain.nodes(), "f64"),
        };
        errors.sort_by(f64::total_cmp);
        let [median, p99, max] = [0.5, 0.99, 1.0].map(|p| (!errors.is_empty()).then(|| quantile(&errors, p)));
        Self { rule, nodes, precision, set: set.name(), scenes, compared: errors.len(), median, p99, max, ns_per_ray }
    }
}

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, rows) in self.0.chunk_by(|a, b| a.set == b.set).enumerate() {
            let gap = if i == 0 { "" } else { "\n" };
            let Row { set, scenes, compared, .. } = rows[0];
            writeln!(f, "{gap}{set}, {compared} of {scenes} scenes: relative error of the radiance")?;
            let mut table = table::new(["rule", "precision", "nodes", "median", "p99", "max", "ns per ray"]);
            for row in rows {
                let told = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.1e}"));
                let [median, p99, max] = [row.median, row.p99, row.max].map(told);
                let names = [row.rule, row.precision].map(str::to_owned);
                let figures = [row.nodes.to_string(), median, p99, max, format!("{:.1}", row.ns_per_ray)];
                table.add_row(names.into_iter().chain(figures));
            }
            writeln!(f, "{}", table::text(&table))?;
        }
        writeln!(f, "\nerrors: relative to quadrature in f64, where f32 has all digits of the radiance")?;
        writeln!(f, "nodes: evaluations of the integrand per ray")?;
        writeln!(f, "airlight: the integral of the library; ns per ray: one thread, geometry included")?;
        writeln!(
            f,
            "steps-in-angle, steps-in-t: midpoints of equal steps; gauss-in-angle: Gauss and Legendre's rule in the angle"
        )?;
        writeln!(f, "f64: plain scalar code without the geometry; its times compare only with each other")
    }
}
