//! `airlight integral` as it is met from outside, and what its figures must be.

use serde_json::Value;
use std::process::{Command, Output};

const KEYS: [&str; 10] =
    ["compared", "max", "median", "nodes", "ns_per_ray", "p99", "precision", "rule", "scenes", "set"];
const RULES: [(&str, u64); 10] = [
    ("airlight", 4),
    ("airlight", 6),
    ("airlight", 8),
    ("airlight", 12),
    ("steps-in-angle", 64),
    ("steps-in-t", 64),
    ("gauss-in-angle", 4),
    ("gauss-in-angle", 6),
    ("gauss-in-angle", 8),
    ("gauss-in-angle", 12),
];

fn integral(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_airlight")).arg("integral").args(arguments).output().unwrap()
}

fn rows(arguments: &[&str]) -> Vec<Value> {
    let output = integral(&[arguments, &["--json", "-"]].concat());
    assert_eq!((output.status.code(), &*output.stderr), (Some(0), &[][..]), "{arguments:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn json_has_a_row_for_every_set_and_rule() {
    let rows = rows(&["--scenes", "200", "--seed", "7"]);
    let expected = ["generic", "broad", "dense"].into_iter().flat_map(|set| RULES.map(|rule| (set, rule)));
    let found = rows
        .iter()
        .map(|row| (row["set"].as_str().unwrap(), (row["rule"].as_str().unwrap(), row["nodes"].as_u64().unwrap())));
    assert!(found.eq(expected), "{rows:#?}");
    for row in &rows {
        assert_eq!(row.as_object().unwrap().keys().collect::<Vec<_>>(), KEYS);
        assert_eq!(row["scenes"], 200);
        assert!(row["compared"].as_u64().unwrap() > 100 && row["ns_per_ray"].as_f64().unwrap() > 0.0, "{row}");
    }
}

/// Of every channel of a coloured medium, by all rules.
#[test]
fn every_channel_is_compared() {
    let rows = rows(&["--set", "colour-strong", "--scenes", "200", "--seed", "7"]);
    assert_eq!(rows.len(), RULES.len());
    for row in &rows {
        assert_eq!((&row["scenes"], &row["compared"]), (&Value::from(200), &Value::from(600)), "{row}");
    }
    let median = |i: usize| rows[i]["median"].as_f64().unwrap();
    assert!(median(3) < 1e-6 && median(2) < 1e-6 && median(9) < 1e-2, "{rows:#?}");
}

/// Median and 99th percentile; no plain rule of as many nodes has them on all sets.
#[test]
fn errors_are_as_promised() {
    const PROMISED: [(&str, [[f64; 2]; 4]); 2] = [
        ("generic", [[1e-4, 8e-3], [1e-6, 1e-4], [4e-7, 3e-6], [4e-7, 2e-6]]),
        ("broad", [[1e-3, 5e-2], [1e-5, 3e-3], [1e-6, 1e-3], [4e-7, 3e-4]]),
    ];
    for seed in ["1", "2"] {
        for (set, promised) in PROMISED {
            let rows = rows(&["--set", set, "--scenes", "4000", "--seed", seed]);
            for (row, [median, p99]) in rows.iter().zip(promised) {
                let at_most = |key: &str, limit: f64| assert!(row[key].as_f64().unwrap() <= limit, "{key}: {row}");
                at_most("median", median);
                at_most("p99", p99);
            }
        }
    }
}

#[test]
fn the_table_explains_itself() {
    let output = integral(&["--set", "tame", "--scenes", "50", "--precision", "fast"]);
    let table = String::from_utf8(output.stdout).unwrap();
    for (rule, _) in RULES {
        assert!(table.lines().any(|line| line.starts_with(rule)), "{rule} is not in\n{table}");
    }
    assert!(table.contains(" fast "), "{table}");
    for legend in ["errors: ", "nodes: ", "airlight: ", "f64: "] {
        assert!(table.lines().any(|line| line.starts_with(legend)), "{legend} is not in\n{table}");
    }
}

#[test]
fn a_refused_argument_is_named() {
    for (arguments, told) in [
        (
            ["--set", "narrow"],
            "no set is called 'narrow'; there are generic, broad, dense, tame, spot, colour, colour-strong and canonical",
        ),
        (["--scenes", "0"], "at least 1"),
        (["--precision", "exacter"], "no precision is called 'exacter'"),
    ] {
        let output = integral(&arguments);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{stderr}");
        assert!(stderr.contains(told) && stderr.lines().count() == 1, "{stderr}");
    }
}
