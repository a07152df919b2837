//! `airlight report` as it is met from outside: one run, whose files the tests look at.

mod peer_library;

use airlight_tools::samplers;
use roxmltree::{Document, ParsingOptions};
use serde_json::Value;
use std::fs;
use std::io::Cursor;
use std::path::PathBuf;
use std::process::{Command, Output};
use std::sync::LazyLock;
use tempfile::TempDir;

/// Figures whose lines and points are those of the strategies.
const FIGURES: [&str; 9] = [
    "figure-1",
    "figure-2",
    "figure-3-thin",
    "figure-3-normal",
    "figure-3-dense",
    "figure-3-all",
    "figure-4-threads-1",
    "figure-4-backends",
    "figure-5",
];

/// All figures.
fn drawings() -> impl Iterator<Item = &'static str> {
    FIGURES.into_iter().chain(["figure-6"])
}

const DATA: [&str; 8] =
    ["accuracy", "integral", "profile", "resampling", "sample", "summary", "variance-broad", "variance-canonical"];

/// A folder with a report of few scenes and rays.
static REPORT: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = TempDir::new().unwrap();
    let sizes = ["--quick", "--scenes", "20", "--rays", "4096", "--samples", "131072", "--rounds", "1"];
    let batches = ["--batch", "4096", "--batch", "8192"];
    let out = folder.path().join("new/folder");
    let library = peer_library::build(folder.path());
    let peers = ["--peers", &library];
    let output = report(&[&["--out", out.to_str().unwrap()], &sizes[..], &batches, &peers].concat());
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), output.stdout.len()), (Some(0), 0), "{told}");
    assert!(told.trim().ends_with("index.html"), "{told}");
    folder
});

fn report(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_airlight")).arg("report").args(arguments).output().unwrap()
}

fn file(name: &str) -> PathBuf {
    REPORT.path().join("new/folder").join(name)
}

fn text(name: &str) -> String {
    fs::read_to_string(file(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn json(name: &str) -> Vec<Value> {
    serde_json::from_str(&text(name)).unwrap()
}

fn parse(markup: &str) -> Document<'_> {
    Document::parse_with_options(markup, ParsingOptions { allow_dtd: true, ..ParsingOptions::default() }).unwrap()
}

/// How many filled polygons of a colour there are.
fn marks(document: &Document<'_>, colour: &str) -> usize {
    let filled = |node: &roxmltree::Node<'_, '_>| {
        node.has_tag_name(("http://www.w3.org/2000/svg", "polygon")) && node.attribute("fill") == Some(colour)
    };
    document.descendants().filter(filled).count()
}

/// The names of every strategy in every precision that it has.
fn samplers() -> impl Iterator<Item = [&'static str; 2]> {
    samplers::all().map(|sampler| [sampler.strategy().name(), sampler.precision().name()])
}

#[test]
fn rows_with_a_strategy_say_its_precision() {
    let names = |row: &Value| Some([row["strategy"].as_str()?.to_owned(), row["precision"].as_str()?.to_owned()]);
    let both: Vec<_> = samplers().map(|names| names.map(str::to_owned)).collect();
    assert_eq!(json("summary.json").iter().filter_map(names).collect::<Vec<_>>(), both);
    for file in ["accuracy.json", "profile.json"] {
        let found: Vec<_> = json(file).iter().filter_map(names).collect();
        assert!(both.iter().all(|pair| found.contains(pair)), "{file}");
    }
    let sample: Value = serde_json::from_str(&text("sample.json")).unwrap();
    let exact = |rows: &[Value]| rows.iter().all(|row| row["precision"] == "exact");
    assert!(exact(sample["results"].as_array().unwrap()) && exact(&json("variance-broad.json")));
}

#[test]
fn figure_1_has_both_precisions_and_the_peers() {
    let svg = text("figure-1.svg");
    let document = parse(&svg);
    // In both of its parts.
    let fast = samplers().filter(|[_, precision]| *precision == "fast").count();
    assert_eq!(marks(&document, "#FFFFFF"), 2 * fast);
    let exact = json("summary.json").iter().filter(|row| row["precision"] == "exact").cloned().collect::<Vec<_>>();
    assert!(exact.iter().all(|row| marks(&document, row["colour"].as_str().unwrap()) == 2));
    let peers = ["equi-angular", "point-normal", "taylor-4", "taylor-8"];
    for peer in peers {
        assert!(
            document.descendants().any(|node| node.text().is_some_and(|text| text.trim() == format!("peer {peer}"))),
            "{peer}"
        );
    }
    assert_eq!(document.descendants().filter(|node| node.tag_name().name() == "circle").count(), peers.len());
}

#[test]
fn figure_6_has_every_rule_of_the_integral() {
    let rows = json("integral.json");
    let svg = text("figure-6.svg");
    let document = parse(&svg);
    assert_eq!(document.descendants().filter(|node| node.tag_name().name() == "circle").count(), rows.len());
    let said: Vec<&str> = document.descendants().filter_map(|node| node.text()).map(str::trim).collect();
    for name in ["airlight, 4", "Gauss in the angle, 4", "12", "angle, 64", "t, 64"] {
        assert!(said.contains(&name), "{name}: {said:?}");
    }
}

#[test]
fn figure_5_has_the_resampled_candidates() {
    let resampled: Value = serde_json::from_str(&text("resampling.json")).unwrap();
    let sample: Value = serde_json::from_str(&text("sample.json")).unwrap();
    let radiance = |row: &Value| ["radiance", "radiance_stderr"].map(|key| row[key].as_f64().unwrap());
    let ([ours, error], equi_angular) = (radiance(&resampled), &sample["results"][1]);
    let [theirs, their_error] = radiance(equi_angular);
    assert_eq!(equi_angular["strategy"], "equi-angular");
    assert!((ours - theirs).abs() < 5.0 * error.hypot(their_error), "{ours} +- {error}, {theirs} +- {their_error}");
    // The mean of eight has a root of eight less error.
    assert!((their_error / error / 8f64.sqrt() - 1.0).abs() < 0.2, "{error}, {their_error}");
    assert!(text("figure-5.svg").contains("resampling of 8 equi-angular candidates"));
}

#[test]
fn every_figure_has_a_mark_for_every_strategy() {
    let summary = json("summary.json");
    assert_eq!(summary.len(), samplers().count());
    for name in FIGURES {
        let svg = text(&format!("{name}.svg"));
        let document = parse(&svg);
        for row in &summary {
            let colour = row["colour"].as_str().unwrap();
            // Of lines, the mark in the legend alone would be one that is not there.
            let least = if name == "figure-2" { 1 } else { 2 };
            assert!(marks(&document, colour) >= least, "{name}: {}", row["strategy"]);
        }
    }
}

#[test]
fn the_summary_is_what_the_measurements_say() {
    let (profile, accuracy, canonical) = (json("profile.json"), json("accuracy.json"), json("variance-canonical.json"));
    let summary = json("summary.json");
    let number = |value: &Value| value.as_f64().unwrap_or_else(|| panic!("{value} is no number"));
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs();
    let cost = |row: &Value| number(&row["variance_canonical"]) * number(&row["ns_per_sample"]);
    let equi_angular = summary.iter().find(|row| row["strategy"] == "equi-angular").map(cost).unwrap();
    for row in &summary {
        let name = &row["strategy"];
        let of = |other: &&Value| other["strategy"] == *name;
        let of_both = |other: &&Value| of(other) && other["precision"] == row["precision"];
        let means: Vec<f64> = canonical.iter().filter(of).map(|row| number(&row["mean"])).collect();
        assert_eq!(means.len(), 4, "{name}");
        assert!(close(number(&row["variance_canonical"]), means.iter().sum::<f64>() / 4.0), "{row}");
        assert!(profile.iter().any(|time| of_both(&time) && time["ns_per_sample"] == row["ns_per_sample"]), "{row}");
        assert!(accuracy.iter().any(|errors| of_both(&errors) && errors["cdf_p999"] == row["cdf_p999"]), "{row}");
        assert!(close(number(&row["efficiency"]), equi_angular / cost(row)), "{row}");
    }
}

#[test]
fn the_page_is_well_formed_and_has_all_within_itself() {
    let page = text("index.html");
    let document = parse(&page);
    for node in document.descendants() {
        let name = node.tag_name().name();
        assert!(!["script", "link", "img", "iframe", "object"].contains(&name), "{name}");
        for attribute in node.attributes().filter(|attribute| ["src", "href", "data"].contains(&attribute.name())) {
            assert!(file(attribute.value()).is_file(), "{}", attribute.value());
        }
    }
    // The names of the languages are no addresses.
    let rest =
        page.replace("xmlns=\"http://www.w3.org/1999/xhtml\"", "").replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    for outside in ["http:", "https:", "url(", "@import", "{{", "NaN"] {
        assert!(!rest.contains(outside), "{outside}");
    }
    let count = |name: &str| document.descendants().filter(|node| node.tag_name().name() == name).count();
    assert_eq!((count("figure"), count("figcaption")), (6, 6));
    for [strategy, precision] in samplers() {
        let fast = if precision == "fast" { ", fast" } else { "" };
        assert!(page.contains(&format!("</svg> {strategy}{fast}<small>")), "{strategy}{fast}");
    }
}

#[test]
fn every_drawing_is_there_as_svg_and_png() {
    for name in drawings() {
        let png = fs::read(file(&format!("{name}.png"))).unwrap();
        let reader = png::Decoder::new(Cursor::new(png)).read_info().unwrap();
        assert_eq!(reader.info().width, 1040, "{name}");
        let svg = text(&format!("{name}.svg"));
        let document = parse(&svg);
        assert_eq!(document.root_element().attribute("width"), Some("520"), "{name}");
        assert!(text("index.html").contains(&format!("{name}.svg")), "{name}");
    }
    for name in DATA {
        assert!(!text(&format!("{name}.json")).is_empty());
    }
}

#[test]
fn letters_are_large_enough_for_a_telephone() {
    // The page leaves 366 of its 390 pixels to a drawing.
    for name in drawings() {
        let svg = text(&format!("{name}.svg"));
        let document = parse(&svg);
        let units: f64 =
            document.root_element().attribute("viewBox").unwrap().split(' ').nth(2).unwrap().parse().unwrap();
        for size in document.descendants().filter_map(|node| node.attribute("font-size")) {
            let pixels = size.parse::<f64>().unwrap() * 366.0 / units;
            assert!(pixels >= 11.0, "{name}: {pixels}");
        }
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_told_at_once() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    for out in [file.join("below"), file.clone(), PathBuf::from("/proc/report")] {
        let output = report(&["--out", out.to_str().unwrap()]);
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{told}");
        assert!(told.starts_with(&format!("error: cannot write {}", out.display())), "{told}");
        assert_eq!(told.lines().count(), 1, "{told}");
    }
}
