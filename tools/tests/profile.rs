//! `airlight profile`, as it is met from outside. No time is a promise: what is checked is what is measured at all.

mod peer_library;

use airlight::{Backend, Precision, Strategy};
use airlight_tools::samplers;
use serde_json::Value;
use std::process::{Command, Output};
use tempfile::TempDir;

fn profile(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_airlight")).arg("profile").args(arguments).output().unwrap()
}

/// The names of every strategy in every precision that it has.
fn samplers() -> impl Iterator<Item = [&'static str; 2]> {
    samplers::all().map(|sampler| [sampler.strategy().name(), sampler.precision().name()])
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
fn every_strategy_is_measured_in_every_precision_on_every_backend_and_number_of_threads() {
    let rows = rows(&["--rays", "64", "--rays", "71", "--threads", "1", "--threads", "2", "--rounds", "1"]);
    for row in &rows {
        let names = [&row["strategy"], &row["precision"]].map(|name| name.as_str().unwrap_or(""));
        let is_sampler = samplers().any(|sampler| names == sampler);
        assert!(is_sampler || names == ["", ""] || !row["nodes"].is_null(), "{row}");
    }
    for [strategy, precision] in samplers() {
        for backend in Backend::available() {
            for threads in [1, 2] {
                for rays in [64, 71] {
                    let whole = |row: &&Value| {
                        row["strategy"] == strategy
                            && row["precision"] == precision
                            && row["backend"] == backend.name()
                            && row["threads"] == threads
                            && row["rays"] == rays
                            && row["samples_per_ray"] == 1
                            && row["stage"] == "total"
                            && row["against"].is_null()
                    };
                    let [row] = rows.iter().filter(whole).collect::<Vec<_>>()[..] else {
                        panic!("{strategy}, {precision}, {}, {threads} threads, {rays} rays", backend.name());
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
    let rows = rows(&["--rays", "64", "--threads", "1", "--rounds", "1", "--strategy", "point-normal"]);
    let pairs = Backend::available().flat_map(|backend| Precision::ALL.iter().map(move |of| (backend, of.name())));
    for (backend, precision) in pairs {
        let time = |stage: &str| {
            let of_stage = |row: &&Value| {
                (row["stage"] == stage && row["backend"] == backend.name())
                    && (row["samples_per_ray"] == 1 && row["precision"] == precision)
            };
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
    // Fast against exact.
    let fast: Vec<&Value> = rows.iter().filter(|row| row["against"] == "exact").collect();
    let both = samplers().filter(|[_, precision]| *precision == "fast").count();
    assert_eq!(fast.len(), both);
    assert!(fast.iter().all(|row| row["precision"] == "fast" && is_positive(&row["ratio"])), "{fast:?}");
    // The set-up is shared by 8 samples.
    assert!(ratio("product-9", "equi-angular", 8) > 0.0);
}

#[test]
fn calls_of_few_rays_are_measured_on_one_thread_with_the_fastest_backend() {
    let strategies = ["equi-angular", "point-normal"];
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
        "point-normal",
    ]);
    let calls: Vec<&Value> = rows.iter().filter(|row| !row["ns_per_call"].is_null()).collect();
    let measured = |row: &&Value| {
        let names = ["strategy", "precision", "stage"].map(|key| row[key].as_str().unwrap().to_owned());
        (names, row["rays"].as_u64().unwrap())
    };
    let pairs = strategies.iter().flat_map(|strategy| Precision::ALL.iter().map(move |of| (strategy, of.name())));
    let expected = pairs.flat_map(|(strategy, precision)| {
        let of = |stage: &str, rays| ([*strategy, precision, stage].map(str::to_owned), rays);
        [of("one", 1)].into_iter().chain([1, 8, 33, 64, 1000].map(|rays| of("call", rays))).collect::<Vec<_>>()
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
    let shape = |row: &&Value| ["threads", "rays", "samples_per_ray"].map(|key| row[key].as_u64().unwrap());
    let shapes = [[1, 1, 4_194_304], [1, 131_072, 32], [2, 1, 4_194_304], [2, 131_072, 32]];
    for precision in Precision::ALL.iter().filter(|of| Strategy::Product9.has_precision(**of)) {
        let of_precision = measured.iter().filter(|row| row["precision"] == precision.name());
        // A ratio is one of times.
        let times = of_precision.filter(|row| row["against"].is_null());
        assert_eq!(times.map(|row| shape(&row)).collect::<Vec<_>>(), shapes, "{precision}");
    }
    for row in &measured {
        assert_eq!((&row["strategy"], &row["stage"]), (&"product-9".into(), &"total".into()), "{row}");
        assert!(is_positive(&row["ns_per_sample"]), "{row}");
    }
    assert!(many(&["--strategy", "product-9", "--quick"]).is_empty());
    assert!(many(&["--strategy", "product-5"]).is_empty());
}

#[test]
fn peers_are_compared_with_the_backend_of_their_width() {
    let folder = TempDir::new().unwrap();
    let library = peer_library::build(folder.path());
    let backends: Vec<&str> = Backend::available().map(Backend::name).take(2).collect();
    let peers: Vec<String> = backends.iter().map(|backend| format!("{backend}={library}")).collect();
    let mut options = vec!["--rays", "64", "--threads", "1", "--rounds", "1", "--strategy", "equi-angular"];
    backends.iter().zip(&peers).for_each(|(backend, peers)| options.extend(["--backend", backend, "--peers", peers]));
    let rows = rows(&options);
    for backend in backends {
        let is_total = |row: &&Value| row["stage"] == "total" && row["samples_per_ray"] == 1;
        let of_backend: Vec<&Value> = rows.iter().filter(|row| row["backend"] == backend).filter(is_total).collect();
        let times = |row: &&&Value| row["against"].is_null();
        let peers: Vec<_> = of_backend.iter().filter(times).filter(|row| !row["peer"].is_null()).collect();
        assert_eq!(peers.len(), 4, "{backend}");
        for row in peers {
            assert!(row["strategy"].is_null() && row["precision"].is_null(), "{row}");
            // Distances that know no emitter.
            assert!((0.1..=1.0).contains(&row["cdf_p999"].as_f64().unwrap()), "{row}");
        }
        let time = |key: &str, precision: Value| {
            let of = |row: &&&Value| row[key] == "equi-angular" && row["precision"] == precision;
            of_backend.iter().filter(times).find(of).unwrap()["ns_per_sample"].as_f64().unwrap()
        };
        for precision in Precision::ALL {
            let of = |row: &&&Value| row["against"] == "peer" && row["precision"] == precision.name();
            let ratio = of_backend.iter().find(of).unwrap()["ratio"].as_f64().unwrap();
            let expected = time("peer", Value::Null) / time("strategy", precision.name().into());
            assert!((ratio / expected - 1.0).abs() < 1e-9, "{backend}, {precision}: {ratio} is not {expected}");
        }
    }
}

#[test]
fn a_library_without_a_width_has_that_of_the_fastest_backend() {
    let folder = TempDir::new().unwrap();
    let library = peer_library::build(folder.path());
    let options = ["--quick", "--rays", "64", "--threads", "1", "--rounds", "1", "--strategy", "equi-angular"];
    let rows = rows(&[&options[..], &["--peers", &library]].concat());
    let fastest = Backend::available().next().unwrap().name();
    let peers: Vec<&Value> = rows.iter().filter(|row| !row["peer"].is_null()).collect();
    assert!(!peers.is_empty() && peers.iter().all(|row| row["backend"] == fastest), "{peers:?}");
}

#[test]
fn instructions_are_counted_in_every_precision_where_there_is_valgrind() {
    let output = profile(&["--instructions", "--strategy", "equi-angular", "--json", "-"]);
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{told}");
    if told.starts_with("valgrind is missing") {
        return;
    }
    let rows: Vec<Value> = serde_json::from_slice(&output.stdout).unwrap();
    let names: Vec<&str> = rows.iter().map(|row| row["precision"].as_str().unwrap()).collect();
    assert_eq!(names, ["exact", "fast"]);
    assert!(rows.iter().all(|row| is_positive(&row["instructions_per_ray"])), "{rows:?}");
}

#[test]
fn the_integral_is_measured_by_nodes_and_the_choice_by_it() {
    let rows = rows(&["--rays", "64", "--threads", "1", "--rounds", "1", "--strategy", "equi-angular"]);
    let of_integral: Vec<&Value> = rows.iter().filter(|row| !row["nodes"].is_null()).collect();
    let told = |row: &&Value| {
        let names = ["precision", "backend", "stage"].map(|key| row[key].as_str().unwrap().to_owned());
        (names, row["nodes"].as_u64().unwrap(), row["emitters"].as_u64())
    };
    let mut expected = Vec::new();
    for backend in Backend::available() {
        for precision in Precision::ALL {
            let names = |stage: &str| [precision.name(), backend.name(), stage].map(str::to_owned);
            expected.extend([4, 6, 8, 12].map(|nodes| (names("radiance"), nodes, None)));
            expected.push((names("choose"), 4, Some(32)));
        }
    }
    assert_eq!(of_integral.iter().map(told).collect::<Vec<_>>(), expected);
    assert!(of_integral.iter().all(|row| is_positive(&row["ns_per_sample"])), "{of_integral:?}");
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
        "the integral, 1 thread",
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
        (&["--precision", "double"], "no precision is called 'double'; there are exact, fast"),
        (&["--strategy", "taylor-phase", "--precision", "fast"], "the strategy taylor-phase has no fast precision"),
        (&["--peers", "no/such/library.so"], "cannot load no/such/library.so"),
        (&["--peers", "portable=no/such/library.so"], "cannot load no/such/library.so"),
        (&["--peers", "a=b/library.so"], "--peers <[BACKEND=]LIBRARY.so>': this machine has no backend of that name"),
        (&["--peers", "a/b=c/library.so"], "cannot load a/b=c/library.so"),
        (&["--backend", "scalar", "--peers", "portable=x.so"], "--peers portable=x.so: the backend portable is not"),
    ] {
        let output = profile(arguments);
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}: {told}");
        assert!(told.starts_with("error: ") && told.lines().count() == 1, "{arguments:?}: {told}");
        assert!(told.contains(expected), "{told}");
    }
}
