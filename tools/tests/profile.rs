//! `airlight profile`, as it is met from outside. No time is a promise: what is checked is what is measured at all.

use airlight::{Backend, Strategy};
use serde_json::Value;
use std::process::{Command, Output};

fn profile(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_airlight")).arg("profile").args(arguments).output().unwrap()
}

/// The rows of a run that must succeed and say nothing on standard error.
fn rows(arguments: &[&str]) -> Vec<Value> {
    let output = profile(&[arguments, &["--json", "-"]].concat());
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), &*stderr), (Some(0), ""), "{arguments:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn is_positive(value: &Value) -> bool {
    value.as_f64().is_some_and(|value| value > 0.0)
}

#[test]
fn every_strategy_is_measured_on_every_backend_and_number_of_threads() {
    let rows = rows(&["--rays", "64", "--rays", "71", "--threads", "1", "--threads", "2", "--rounds", "1"]);
    for strategy in Strategy::ALL {
        for backend in Backend::available() {
            for threads in [1, 2] {
                for rays in [64, 71] {
                    let whole = |row: &&Value| {
                        row["strategy"] == strategy.name()
                            && row["backend"] == backend.name()
                            && row["threads"] == threads
                            && row["rays"] == rays
                            && row["samples_per_ray"] == 1
                            && row["stage"] == "total"
                            && row["against"].is_null()
                    };
                    let [row] = rows.iter().filter(whole).collect::<Vec<_>>()[..] else {
                        panic!("{strategy}, {}, {threads} threads, {rays} rays", backend.name());
                    };
                    let keys = ["ns_per_sample", "msamples_per_s", "min", "max", "share"];
                    assert!(keys.iter().all(|&key| is_positive(&row[key])), "{row}");
                    assert!(["fma", "division", "stream"].iter().any(|limit| row["bound_by"] == *limit), "{row}");
                }
            }
        }
    }
}

#[test]
fn stages_add_up_to_the_whole() {
    let rows = rows(&["--rays", "64", "--threads", "1", "--rounds", "1", "--strategy", "product-3"]);
    for backend in Backend::available() {
        let time = |stage: &str| {
            let of_stage =
                |row: &&Value| row["stage"] == stage && row["backend"] == backend.name() && row["samples_per_ray"] == 1;
            rows.iter().find(of_stage).unwrap()["ns_per_sample"].as_f64().unwrap()
        };
        let sum: f64 = ["geometry", "set-up", "inversion", "output"].map(time).iter().sum();
        let total = time("total");
        assert!((sum - total).abs() < 1e-9 * total, "{}: {sum} and {total}", backend.name());
        assert!(time("with-weight") > 0.0);
    }
}

#[test]
fn limits_and_ratios_are_rows_of_the_same_list() {
    let rows = rows(&["--rays", "64", "--threads", "1", "--rounds", "2", "--backend", "portable"]);
    for limit in ["fma", "division", "read", "write", "stream"] {
        let of_limit = |row: &&Value| row["limit"] == limit && row["strategy"].is_null();
        let [row] = rows.iter().filter(of_limit).collect::<Vec<_>>()[..] else { panic!("{limit}") };
        assert!(is_positive(&row["ns_per_sample"]), "{row}");
    }
    let ratio = |strategy: &str, against: &str, samples_per_ray: usize| {
        let of_both = |row: &&Value| {
            row["strategy"] == strategy && row["against"] == against && row["samples_per_ray"] == samples_per_ray
        };
        let row = rows.iter().find(of_both).unwrap_or_else(|| panic!("{strategy} against {against}"));
        assert!(row["ns_per_sample"].is_null(), "{row}");
        row["ratio"].as_f64().unwrap()
    };
    // With itself.
    assert_eq!(ratio("product-9", "portable", 1), 1.0);
    assert_eq!(ratio("product-9", "one thread", 1), 1.0);
    assert_eq!(ratio("equi-angular", "equi-angular", 1), 1.0);
    // The set-up is shared by 8 samples.
    assert!(ratio("product-9", "equi-angular", 8) > 0.0);
}

#[test]
fn calls_of_few_rays_are_measured_on_one_thread_with_the_fastest_backend() {
    let strategies = ["equi-angular", "product-3"];
    let rows = rows(&[
        "--quick",
        "--rays",
        "64",
        "--threads",
        "2",
        "--rounds",
        "1",
        "--strategy",
        "equi-angular",
        "--strategy",
        "product-3",
    ]);
    let calls: Vec<&Value> = rows.iter().filter(|row| !row["ns_per_call"].is_null()).collect();
    let measured =
        |row: &&Value| (row["strategy"].to_string(), row["stage"].to_string(), row["rays"].as_u64().unwrap());
    let expected = strategies.iter().flat_map(|strategy| {
        let of = |stage: &str, rays| (format!("\"{strategy}\""), format!("\"{stage}\""), rays);
        [of("one", 1)].into_iter().chain([1, 8, 33, 64, 1000].map(|rays| of("call", rays)))
    });
    assert_eq!(calls.iter().map(measured).collect::<Vec<_>>(), expected.collect::<Vec<_>>());
    let fastest = Backend::available().next().unwrap().name();
    for row in calls {
        assert_eq!(
            (&row["threads"], &row["backend"], &row["samples_per_ray"]),
            (&1.into(), &fastest.into(), &1.into())
        );
        let (call, sample) = (row["ns_per_call"].as_f64().unwrap(), row["ns_per_sample"].as_f64().unwrap());
        let rays = row["rays"].as_f64().unwrap();
        assert!(sample > 0.0 && (call / (sample * rays) - 1.0).abs() < 1e-9, "{row}");
    }
}

#[test]
fn many_variates_of_few_rays_are_measured_unless_it_is_to_be_quick() {
    let many = |options: &[&str]| {
        let all = ["--rays", "64", "--threads", "1", "--threads", "2", "--rounds", "1"];
        let mut rows = rows(&[&all[..], options].concat());
        rows.retain(|row| row["samples_per_ray"].as_u64().unwrap() > 8);
        rows
    };
    let measured = many(&["--strategy", "product-9"]);
    let shape = |row: &Value| ["threads", "rays", "samples_per_ray"].map(|key| row[key].as_u64().unwrap());
    let shapes = [[1, 1, 4_194_304], [1, 131_072, 32], [2, 1, 4_194_304], [2, 131_072, 32]];
    assert_eq!(measured.iter().map(shape).collect::<Vec<_>>(), shapes);
    for row in &measured {
        assert_eq!((&row["strategy"], &row["stage"]), (&"product-9".into(), &"total".into()), "{row}");
        assert!(is_positive(&row["ns_per_sample"]), "{row}");
    }
    assert!(many(&["--strategy", "product-9", "--quick"]).is_empty());
    assert!(many(&["--strategy", "product-5"]).is_empty());
}

#[test]
fn a_table_fits_a_terminal() {
    let strategies = ["--strategy", "taylor-transmittance", "--strategy", "product-9"];
    let output = profile(&[&["--rays", "64", "--rounds", "1"], &strategies[..]].concat());
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(table.lines().all(|line| line.chars().count() <= 100), "{table}");
    for title in [
        "limits of arithmetic",
        "limits of memory",
        "time of a sample",
        "stages",
        "time of a call",
        "few rays, many variates",
        "times as fast as portable",
    ] {
        // A title, a table of a head and a row at least, a legend.
        let lines: Vec<&str> = table.lines().skip_while(|line| !line.starts_with(title)).collect();
        let end = lines.iter().position(|line| line.is_empty()).unwrap_or(0);
        assert!(
            end >= 4 && lines[end - 1].split_whitespace().any(|word| word.chars().all(char::is_alphabetic)),
            "{title}: {table}"
        );
    }
}

#[test]
fn a_refused_argument_is_named() {
    for (arguments, expected) in [
        (&["--rays", "0"][..], "--rays <RAYS>': expected a whole number of at least 1"),
        (&["--rays", "268435457"], "--rays <RAYS>': expected at most 268435456 rays"),
        (&["--threads", "0"], "--threads <N>': expected a whole number of at least 1"),
        (&["--rounds", "0"], "--rounds <ROUNDS>': expected a whole number of at least 1"),
        (&["--strategy", "best"], "no strategy is called 'best'; there are transmittance"),
        (&["--backend", "best"], "this machine has no backend of that name; it has "),
        (&["--peers", "no/such/library.so"], "cannot load no/such/library.so"),
    ] {
        let output = profile(arguments);
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}: {told}");
        assert!(told.starts_with("error: ") && told.lines().count() == 1, "{arguments:?}: {told}");
        assert!(told.contains(expected), "{told}");
    }
}
