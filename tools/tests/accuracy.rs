//! `airlight accuracy` as it is met from outside, and what its bounds say of each precision.

use airlight::{Precision, Strategy};
use airlight_tools::backends::distinct;
use airlight_tools::bounds::bounds;
use airlight_tools::errors::Errors;
use airlight_tools::families::Family;
use airlight_tools::samplers;
use serde_json::Value;
use std::process::{Command, Output};

fn accuracy(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_airlight")).arg("accuracy").args(arguments).output().unwrap()
}

/// The rows of a run on few generic rays that must succeed.
fn rows(arguments: &[&str]) -> Vec<Value> {
    let output = accuracy(&[&["--rays", "2048", "--family", "generic", "--json", "-"], arguments].concat());
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), &*stderr), (Some(0), ""), "{arguments:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Strategy and precision of every row.
fn measured(rows: &[Value]) -> Vec<(&str, &str)> {
    rows.iter().map(|row| (row["strategy"].as_str().unwrap(), row["precision"].as_str().unwrap())).collect()
}

/// Those of every backend that there must be, of these precisions.
fn expected(precisions: &[Precision]) -> Vec<(&'static str, &'static str)> {
    let of = samplers::all().filter(|sampler| precisions.contains(&sampler.precision()));
    let once: Vec<_> = of.map(|sampler| (sampler.strategy().name(), sampler.precision().name())).collect();
    once.repeat(distinct().count())
}

#[test]
fn every_strategy_is_measured_in_every_precision_that_it_has() {
    let rows = rows(&[]);
    assert_eq!(measured(&rows), expected(Precision::ALL));
    for row in &rows {
        assert!(row["cdf_p999"].is_f64() && row["misjudged"].is_u64() && row["misjudged_light"].is_f64(), "{row}");
    }
}

#[test]
fn strategies_without_the_precision_are_left_out() {
    assert_eq!(measured(&rows(&["--precision", "fast"])), expected(&[Precision::Fast]));
    let taylor = rows(&["--strategy", "taylor-phase"]);
    assert_eq!(measured(&taylor), vec![("taylor-phase", "exact"); distinct().count()]);
}

#[test]
fn a_refused_argument_is_named() {
    for (arguments, expected) in [
        (&["--strategy", "taylor-phase", "--precision", "fast"][..], "the strategy taylor-phase has no fast precision"),
        (&["--precision", "double"], "no precision is called 'double'; there are exact, fast"),
    ] {
        let output = accuracy(arguments);
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}: {told}");
        assert!(told.starts_with("error: ") && told.lines().count() == 1 && told.contains(expected), "{told}");
    }
}

#[test]
fn the_table_names_the_precision() {
    let output = accuracy(&["--rays", "512", "--family", "generic", "--strategy", "equi-angular"]);
    let table = String::from_utf8(output.stdout).unwrap();
    for precision in Precision::ALL {
        assert!(
            table.lines().any(|line| line.starts_with(&format!("generic, equi-angular, {precision}, "))),
            "{table}"
        );
    }
}

/// Whether some errors of a sampler on generic rays keep the bounds on rays that are judged wrongly.
fn may_misjudge(precision: Precision, errors: &Errors) -> bool {
    let bounds = bounds(Strategy::PointNormal, precision, Family::Generic);
    let mut of_these = bounds.iter().filter(|bound| bound.figure.starts_with("misjudged")).peekable();
    assert!(of_these.peek().is_some(), "{precision}");
    of_these.all(|bound| bound.holds(errors))
}

#[test]
fn fast_may_misjudge_rays_with_next_to_no_light_and_exact_none() {
    let errors = |misjudged_light| Errors { misjudged: 3, misjudged_light, ..Errors::default() };
    assert!(may_misjudge(Precision::Fast, &errors(5e-6)));
    assert!(!may_misjudge(Precision::Fast, &errors(2e-5)));
    assert!(!may_misjudge(Precision::Exact, &errors(0.0)));
}

#[test]
fn on_every_family_either_precision_is_finite_and_in_range() {
    for &precision in Precision::ALL {
        for family in Family::ALL {
            let bounds = bounds(Strategy::EquiAngular, precision, family);
            for wrong in [Errors { nonfinite: 1, ..Errors::default() }, Errors { out_of_range: 1, ..Errors::default() }]
            {
                let broken: Vec<&str> = bounds
                    .iter()
                    .filter(|bound| (bound.read)(&wrong) > bound.limit)
                    .map(|bound| bound.figure)
                    .collect();
                assert_eq!(broken.len(), 1, "{precision}, {}: {broken:?}", family.name());
            }
        }
    }
}
