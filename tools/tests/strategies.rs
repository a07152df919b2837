//! The plots on the documentation's page of `Strategy`.

use airlight::Strategy;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// The repository.
fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

fn committed(strategy: Strategy) -> String {
    fs::read_to_string(root().join(format!("docs/strategies/{strategy}.svg"))).unwrap()
}

/// The whole numbers of a drawing's paths, and all that is around the paths.
fn parts(drawing: &str) -> (Vec<i32>, Vec<&str>) {
    let (mut numbers, mut rest) = (Vec::new(), Vec::new());
    for (i, piece) in drawing.split("<path d=\"").enumerate() {
        let (path, after) = if i == 0 { ("", piece) } else { piece.split_once('"').unwrap() };
        numbers.extend(path.split(|c: char| !(c.is_ascii_digit() || c == '-')).filter_map(|n| n.parse::<i32>().ok()));
        rest.push(after);
    }
    (numbers, rest)
}

#[test]
fn plots_are_what_the_command_draws() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("new/folder");
    let mut command = Command::new(env!("CARGO_BIN_EXE_airlight"));
    let output = command.args(["report", "--strategies", out.to_str().unwrap()]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for &strategy in Strategy::ALL {
        let drawn = fs::read_to_string(out.join(format!("{strategy}.svg"))).unwrap();
        let committed = committed(strategy);
        let ((numbers, rest), (committed_numbers, committed_rest)) = (parts(&drawn), parts(&committed));
        // Backends without fused multiply-add may round a coordinate to the next tenth of a pixel.
        assert_eq!((rest, numbers.len()), (committed_rest, committed_numbers.len()), "{strategy}");
        for (drawn, committed) in numbers.iter().zip(&committed_numbers) {
            assert!((drawn - committed).abs() <= 1, "{strategy}: {numbers:?}");
        }
    }
}

#[test]
fn plots_are_small_well_formed_and_follow_the_theme_of_their_page() {
    for &strategy in Strategy::ALL {
        let svg = committed(strategy);
        assert!(svg.len() < 6000, "{strategy}: {} bytes", svg.len());
        // Markdown ends a block of markup at an empty line.
        assert!(!svg.contains("\n\n"), "{strategy}");
        let document = roxmltree::Document::parse(&svg).unwrap();
        assert_eq!(document.root_element().attribute("fill"), Some("currentColor"), "{strategy}");
    }
}

#[test]
fn every_strategy_shows_its_plot() {
    let source = fs::read_to_string(root().join("src/strategy/mod.rs")).unwrap();
    let shown = source.split("docs/strategies/").skip(1).filter_map(|rest| rest.split_once(".svg\")]"));
    let names = Strategy::ALL.iter().map(|strategy| strategy.name());
    assert_eq!(shown.map(|(name, _)| name).collect::<Vec<_>>(), names.collect::<Vec<_>>());
}
