//! The built command, as it is met from outside.

use airlight::{Emitter, Emitters, Media, Medium, Precision, Ray, Rays, Sampler, Samples, Strategy};
use serde_json::Value;
use std::fs;
use std::io::{Cursor, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

const COLUMNS: [&str; 15] =
    ["ox", "oy", "oz", "dx", "dy", "dz", "t_min", "t_max", "ex", "ey", "ez", "nx", "ny", "nz", "u"];
const KEYS: [&str; 17] = [
    "bisected",
    "cdf_max",
    "cdf_p999",
    "check_estimate",
    "check_quadrature",
    "check_rays",
    "check_stderr",
    "check_z",
    "empty",
    "invalid",
    "msamples_per_s",
    "precision",
    "radiance",
    "radiance_stderr",
    "rays",
    "sampled",
    "strategy",
];

fn airlight(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_airlight")).args(arguments).output().unwrap()
}

/// Standard output of a run that must succeed and say nothing on standard error.
fn succeed(arguments: &[&str]) -> String {
    let output = airlight(arguments);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), &*stderr), (Some(0), ""), "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Standard output of a run that must succeed, and what it says on standard error.
fn succeed_with_a_word(arguments: &[&str]) -> (String, String) {
    let output = airlight(arguments);
    let [stdout, stderr] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {stderr}");
    (stdout, stderr)
}

/// The one line on standard error of a run that must fail and say nothing on standard output.
fn fail(arguments: &[&str]) -> String {
    let output = airlight(arguments);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}: {stderr}");
    assert!(stderr.starts_with("error: ") && stderr.lines().count() == 1, "{arguments:?}: {stderr}");
    stderr
}

fn names(folder: &Path) -> Vec<String> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

/// An .npz file in the making: a dtype, a shape and the data of each column.
#[derive(Clone)]
struct Npz(Vec<(String, String, String, Vec<u8>)>);

impl Npz {
    /// Eight rays above a row of lamps; the last one is invalid.
    fn wavefront() -> Self {
        const RAYS: usize = 8;
        let column = |name| {
            let value = |i: usize| match name {
                "dx" if i == RAYS - 1 => f32::NAN,
                "dx" => 1.0,
                "t_max" => 3.0,
                "ex" => i as f32 * 0.25,
                "ey" => 1.0,
                "ny" if i % 2 == 1 => -1.0,
                "u" => (i as f32 + 0.5) / RAYS as f32,
                _ => 0.0,
            };
            (0..RAYS).map(value).collect::<Vec<_>>()
        };
        Self(vec![]).with_all(&COLUMNS.map(|name| (name, column(name))))
    }

    fn with_all(self, columns: &[(&str, Vec<f32>)]) -> Self {
        columns.iter().fold(self, |npz, (name, values)| {
            let data: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            npz.with(name, "'<f4'", &format!("({},)", values.len()), &data)
        })
    }

    /// With `name` added or put in place of what was called so.
    fn with(mut self, name: &str, dtype: &str, shape: &str, data: &[u8]) -> Self {
        let column = (name.to_owned(), dtype.to_owned(), shape.to_owned(), data.to_owned());
        match self.0.iter_mut().find(|column| column.0 == name) {
            Some(present) => *present = column,
            None => self.0.push(column),
        }
        self
    }

    fn without(mut self, name: &str) -> Self {
        self.0.retain(|column| column.0 != name);
        self
    }

    fn bytes(&self, compression: zip::CompressionMethod) -> Vec<u8> {
        let options = zip::write::SimpleFileOptions::default().compression_method(compression);
        let mut zip = zip::ZipWriter::new(Cursor::new(vec![]));
        for (name, dtype, shape, data) in &self.0 {
            let header = format!("{{'descr': {dtype}, 'fortran_order': False, 'shape': {shape}, }}\n");
            zip.start_file(format!("{name}.npy"), options).unwrap();
            zip.write_all(b"\x93NUMPY\x01\x00").unwrap();
            zip.write_all(&u16::try_from(header.len()).unwrap().to_le_bytes()).unwrap();
            zip.write_all(header.as_bytes()).unwrap();
            zip.write_all(data).unwrap();
        }
        zip.finish().unwrap().into_inner()
    }

    fn stored(&self) -> Vec<u8> {
        self.bytes(zip::CompressionMethod::Stored)
    }

    /// The values of one of its columns.
    fn column(&self, name: &str) -> Vec<f32> {
        floats(&self.0.iter().find(|column| column.0 == name).unwrap().3)
    }
}

fn floats(data: &[u8]) -> Vec<f32> {
    data.as_chunks().0.iter().map(|&value| f32::from_le_bytes(value)).collect()
}

/// A column of an .npz file and the dtype and shape that its header states.
fn read(npz: &Path, name: &str) -> (String, Vec<f32>) {
    let mut zip = zip::ZipArchive::new(fs::File::open(npz).unwrap()).unwrap();
    let mut file = vec![];
    zip.by_name(&format!("{name}.npy")).unwrap().read_to_end(&mut file).unwrap();
    let start = 10 + usize::from(u16::from_le_bytes([file[8], file[9]]));
    assert_eq!((&file[..8], start % 64), (&b"\x93NUMPY\x01\x00"[..], 0));
    (String::from_utf8(file[10..start].to_vec()).unwrap(), floats(&file[start..]))
}

/// A folder with a file in it, as arguments want them.
fn folder_with(name: &str, bytes: &[u8]) -> (TempDir, String) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    (folder, path.into_os_string().into_string().unwrap())
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn a_small_run_ends_with_a_table_that_agrees_with_quadrature() {
    let table = succeed(&["sample", "--rays", "131072", "--check", "256"]);
    for &strategy in Strategy::ALL {
        let rows: Vec<Vec<&str>> = table
            .lines()
            .map(|line| line.split_whitespace().collect::<Vec<_>>())
            .filter(|row| row.first() == Some(&strategy.name()))
            .collect();
        let [speed, radiance] = &rows[..] else { panic!("{strategy} has not two rows in\n{table}") };
        assert_eq!([speed[1], radiance[1]], ["exact"; 2], "{table}");
        assert!(speed[2].parse::<f64>().unwrap() > 0.0, "{table}");
        assert_eq!(speed[3..6].iter().map(|count| count.parse::<u64>().unwrap()).sum::<u64>(), 131_072, "{table}");
        assert_eq!(speed[5], "0", "{table}");
        let z: f64 = radiance[7].parse().unwrap();
        assert!(z.abs() < 5.0, "{table}");
        assert!(radiance[9].parse::<f64>().unwrap() < 1e-3, "{table}");
    }
}

#[test]
fn json_on_standard_output_stands_alone() {
    let text = succeed(&["sample", "--rays", "131072", "--check", "64", "--seed", "3", "--json", "-"]);
    let figures: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(figures["rays"], 131_072);
    assert_eq!(figures["seed"], 3);
    assert_eq!(figures["wavefront_rays"], 65_536);
    let results = figures["results"].as_array().unwrap();
    let strategies: Vec<_> = results.iter().map(|row| row["strategy"].as_str().unwrap()).collect();
    assert_eq!(strategies, Strategy::ALL.iter().map(|strategy| strategy.name()).collect::<Vec<_>>());
    for row in results {
        let mut keys: Vec<_> = row.as_object().unwrap().keys().collect();
        keys.sort();
        assert_eq!(keys, KEYS);
        assert_eq!(row["precision"], "exact");
        assert_eq!(row["check_rays"], 64);
        assert!(row["radiance"].as_f64().unwrap() > 0.0);
        assert!(row["radiance_stderr"].as_f64().unwrap() > 0.0);
    }
}

/// Each as the only channel of its medium, and the JSON says which one it is.
#[test]
fn a_coloured_medium_has_a_radiance_in_every_channel() {
    let run = |medium: &str| {
        let arguments = ["sample", "--rays", "131072", "--check", "256", "--strategy", "product-5", "--json", "-"];
        let figures: Value = serde_json::from_str(&succeed(&[&arguments[..], &["--medium", medium]].concat())).unwrap();
        figures
    };
    let figures = run("0.1,0.2:0.3:0,0.6");
    let rows = figures["results"].as_array().unwrap();
    let (mu_a, mu_s) = (&figures["medium"]["mu_a"], &figures["medium"]["mu_s"]);
    assert_eq!((mu_a.as_array().unwrap().len(), mu_s.as_array().unwrap().len()), (3, 3), "{figures}");
    assert_eq!(rows.iter().map(|row| row["channel"].as_u64().unwrap()).collect::<Vec<_>>(), [0, 1, 2]);
    for (row, grey) in rows.iter().zip(["0.1,0.2,0.6", "0.1,0.3,0.6"]) {
        let grey = &run(grey)["results"][0];
        let of = |row: &Value, key: &str| row[key].as_f64().unwrap();
        assert!((of(row, "check_quadrature") / of(grey, "check_quadrature") - 1.0).abs() < 1e-12, "{row}, {grey}");
        let error = of(row, "radiance_stderr").hypot(of(grey, "radiance_stderr"));
        assert!((of(row, "radiance") - of(grey, "radiance")).abs() < 5.0 * error, "{row}, {grey}");
        assert!(of(row, "check_z").abs() < 5.0 && of(row, "cdf_p999") < 1e-3, "{row}");
    }
    assert_eq!((&rows[2]["radiance"], &rows[2]["check_z"]), (&Value::from(0.0), &Value::Null));
    let table = succeed(&["sample", "--rays", "8", "--medium", "0.1,1:2:3:4,0", "--strategy", "product-9"]);
    assert!(table.contains("mu_s 1:2:3:4 /m") && table.contains("product-9[3]"), "{table}");
}

#[test]
fn the_output_of_a_coloured_medium_has_weights_of_every_channel() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("samples.npz");
    let arguments = ["sample", "--strategy", "product-5", "--rays", "1000", "--check", "0", "--medium", "0.1,0:1:2,0"];
    succeed(&[&arguments[..], &["--output", text(&file)]].concat());
    let weights = ["weight_0", "weight_1", "weight_2"].map(|name| read(&file, name).1.iter().sum::<f32>());
    assert!(weights[0] == 0.0 && weights[1] > 0.0 && weights[2] > 0.0, "{weights:?}");
}

#[test]
fn strategies_without_fast_precision_are_left_out_or_refused() {
    let arguments = ["sample", "--rays", "8", "--check", "0", "--precision", "fast"];
    let figures: Value = serde_json::from_str(&succeed(&[&arguments[..], &["--json", "-"]].concat())).unwrap();
    let sampled = |row: &Value| [&row["strategy"], &row["precision"]].map(|name| name.as_str().unwrap().to_owned());
    let fast = Strategy::ALL.iter().filter(|strategy| strategy.has_precision(Precision::Fast));
    assert_eq!(
        figures["results"].as_array().unwrap().iter().map(sampled).collect::<Vec<_>>(),
        fast.map(|strategy| [strategy.name(), "fast"].map(str::to_owned)).collect::<Vec<_>>()
    );
    let told = fail(&[&arguments[..], &["--strategy", "taylor-phase"]].concat());
    assert_eq!(told, "error: the strategy taylor-phase has no fast precision\n");
}

#[test]
fn json_in_a_file_comes_with_the_table() {
    let folder = TempDir::new().unwrap();
    let json = folder.path().join("figures.json");
    let table = succeed(&["sample", "--rays", "1000", "--check", "10", "--json", text(&json)]);
    assert!(table.starts_with("cornell"), "{table}");
    let figures: Value = serde_json::from_slice(&fs::read(&json).unwrap()).unwrap();
    // A single repetition has no spread to estimate.
    let row = &figures["results"][0];
    assert!(row["radiance"].is_f64() && row["radiance_stderr"].is_null() && row["check_z"].is_f64(), "{row}");
    assert_eq!(names(folder.path()), ["figures.json"]);
}

#[test]
fn figures_depend_on_the_seed_and_not_on_the_threads() {
    let figures = |seed, threads| {
        let arguments = ["sample", "--rays", "150000", "--check", "50", "--json", "-", "--seed", seed];
        let text = succeed(&[&arguments[..], &["--threads", threads]].concat());
        let mut figures: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(figures["threads"].to_string(), threads);
        for row in figures["results"].as_array_mut().unwrap() {
            row["msamples_per_s"] = Value::Null;
        }
        figures["results"].take()
    };
    assert_eq!(figures("1", "1"), figures("1", "2"));
    assert_ne!(figures("1", "1"), figures("2", "1"));
}

#[test]
fn the_output_is_the_first_repetition_for_any_number_of_threads() {
    let folder = TempDir::new().unwrap();
    let files = ["1", "2"].map(|threads| {
        let file = folder.path().join(threads);
        let arguments = ["sample", "--strategy", "point-normal", "--rays", "100000", "--threads", threads];
        succeed(&[&arguments[..], &["--check", "0", "--output", text(&file)]].concat());
        assert_eq!(read(&file, "weight").1.len(), 65_536);
        fs::read(file).unwrap()
    });
    assert!(files[0] == files[1], "the files differ");
}

#[test]
fn the_output_holds_the_samples_in_the_wavefronts_order() {
    let npz = Npz::wavefront();
    let (folder, wavefront) = folder_with("w.npz", &npz.bytes(zip::CompressionMethod::Deflated));
    let output = folder.path().join("samples.npz");
    let arguments = ["sample", &wavefront, "--strategy", "equi-angular", "--medium", "0.2,0.5,-0.3", "--rays", "30"];
    succeed(&[&arguments[..], &["--output", text(&output)]].concat());

    let columns: Vec<Vec<f32>> = COLUMNS.iter().map(|name| npz.column(name)).collect();
    let xyz = |first: usize| [0, 1, 2].map(|axis| &columns[first + axis][..]);
    let [mut t, mut pdf, mut weight] = [0, 1, 2].map(|_| vec![f32::NAN; 8]);
    let counts = Sampler::new(Strategy::EquiAngular)
        .sample(
            &Rays::new(xyz(0), xyz(3), &columns[6], &columns[7]),
            &Emitters::each(xyz(8), xyz(11)),
            &Media::one(Medium::new(0.2, 0.5, -0.3).unwrap()),
            &columns[14],
            &mut Samples::new(&mut t, &mut pdf).weight(&mut weight),
        )
        .unwrap();
    assert_eq!((counts.sampled, counts.invalid), (7, 1));
    for (name, expected) in [("t", t), ("pdf", pdf), ("weight", weight)] {
        let (header, values) = read(&output, name);
        assert_eq!(header.trim_end(), "{'descr': '<f4', 'fortran_order': False, 'shape': (8,), }");
        assert_eq!(values, expected, "{name}");
        assert_eq!(values[7], 0.0, "{name} of the invalid ray");
    }
    let mut folder = names(folder.path());
    folder.sort();
    assert_eq!(folder, ["samples.npz", "w.npz"]);
}

/// The wavefront with cones for every other of its lamps.
fn with_cones() -> Npz {
    let column = |cosine: f32| (0..8).map(|i| if i % 2 == 1 { cosine } else { -1.0 }).collect::<Vec<_>>();
    Npz::wavefront().with_all(&[("cos_outer", column(0.5)), ("cos_inner", column(0.75))])
}

#[test]
fn columns_of_cosines_make_spots() {
    let npz = with_cones();
    let (folder, wavefront) = folder_with("w.npz", &npz.stored());
    let output = folder.path().join("samples.npz");
    let arguments = ["sample", &wavefront, "--strategy", "product-5", "--medium", "0.2,0.5,-0.3", "--rays", "8"];
    let json = succeed(&[&arguments[..], &["--output", text(&output), "--json", "-"]].concat());
    let weights = read(&output, "weight").1;
    for (i, &weight) in weights[..7].iter().enumerate() {
        let column = |name| npz.column(name)[i];
        let ray = Ray::new([0.0; 3], [1.0, 0.0, 0.0], 0.0, 3.0).unwrap();
        let position = [column("ex"), 1.0, 0.0];
        let emitter =
            if i % 2 == 1 { Emitter::spot(position, [0.0, -1.0, 0.0], 0.5, 0.75) } else { Emitter::point(position) };
        let medium = Medium::new(0.2, 0.5, -0.3).unwrap();
        let sample = Sampler::new(Strategy::Product5).sample_one(&ray, &emitter.unwrap(), &medium, column("u"));
        assert_eq!(weight.to_bits(), sample.unwrap().weight.to_bits(), "ray {i}");
    }
    let row = &serde_json::from_str::<Value>(&json).unwrap()["results"][0];
    assert_eq!((&row["sampled"], &row["invalid"], &row["check_rays"]), (&7.into(), &1.into(), &7.into()), "{row}");
    assert!(row["check_z"].as_f64().unwrap().abs() < 5.0, "{row}");

    for (missing, told) in
        [("cos_outer", "column 'cos_outer': is missing"), ("cos_inner", "column 'cos_inner': is missing")]
    {
        let (_folder, wavefront) = folder_with("bad.npz", &npz.clone().without(missing).stored());
        assert!(fail(&["sample", &wavefront, "--rays", "8"]).contains(told), "{missing}");
    }
    // A cone of half of the cosines is none.
    let (_folder, wavefront) = folder_with("w.npz", &npz.with_all(&[("cos_inner", vec![-1.0; 8])]).stored());
    let figures: Value = serde_json::from_str(&succeed(&["sample", &wavefront, "--rays", "8", "--json", "-"])).unwrap();
    let reason = "cos_inner is -1, expected cos_outer <= cos_inner <= 1";
    assert_eq!(figures["invalid_rays"], serde_json::json!({ "count": 4, "first": 1, "reason": reason }));
}

#[test]
fn a_bad_wavefront_is_refused_by_name_and_nothing_is_written() {
    let good = Npz::wavefront();
    let stored = good.stored();
    let corrupt = {
        let mut file = stored.clone();
        let at = file.windows(4).position(|bytes| bytes == 3f32.to_le_bytes()).unwrap();
        file[at] ^= 1;
        file
    };
    // The method stands in the header of every file and in the directory.
    let compressed = |method| {
        let mut file = stored.clone();
        for at in 0..file.len() {
            match &file[at..] {
                [b'P', b'K', 3, 4, ..] => file[at + 8] = method,
                [b'P', b'K', 1, 2, ..] => file[at + 10] = method,
                _ => {}
            }
        }
        file
    };
    // "ol.npy" becomes a second "oz.npy".
    let twice = {
        let mut file = good.clone().with_all(&[("ol", vec![0.0; 8])]).stored();
        while let Some(at) = file.windows(6).position(|bytes| bytes == b"ol.npy") {
            file[at + 1] = b'z';
        }
        file
    };
    let values = |column: &str, dtype, shape, bytes| good.clone().with(column, dtype, shape, &vec![0; bytes]).stored();
    let empty = COLUMNS.iter().fold(good.clone(), |npz, name| npz.with(name, "'<f4'", "(0,)", &[])).stored();
    let cases = [
        ("missing column", good.clone().without("nz").stored(), "column 'nz': is missing"),
        ("length", values("ey", "'<f4'", "(7,)", 28), "column 'ey' has 7 values, column 'ox' has 8"),
        (
            "float128",
            values("t_max", "'<f16'", "(8,)", 128),
            "column 't_max': dtype is float128 ('<f16'), expected float",
        ),
        ("int32", values("u", "'<i4'", "(8,)", 32), "column 'u': dtype is int32 ('<i4'), expected float16, float32 or"),
        ("bool", values("u", "'|b1'", "(8,)", 8), "column 'u': dtype is bool ('|b1')"),
        ("structured", values("u", "[('x', '<f4')]", "(8,)", 32), "column 'u': dtype is structured ([('x', '<f4')])"),
        ("big-endian", values("dz", "'>i2'", "(8,)", 16), "column 'dz': dtype is big-endian int16 ('>i2')"),
        (
            "column vector",
            values("dz", "'<f4'", "(8, 1)", 32),
            "'dz': has shape (8, 1), expected one dimension: ravel it",
        ),
        (
            "two dimensions",
            values("dz", "'<f8'", "(4, 2)", 64),
            "'dz': has shape (4, 2), expected one dimension: ravel it",
        ),
        ("no dimension", values("dz", "'<f4'", "()", 4), "column 'dz': has shape (), expected one dimension: ravel it"),
        ("short", values("oz", "'<f4'", "(8,)", 31), "column 'oz': holds 31 bytes of data, expected 8 values of 4"),
        ("long", values("oz", "'<f4'", "(8,)", 36), "column 'oz': holds 36 bytes of data, expected 8 values of 4"),
        (
            "short float64",
            values("oz", "'<f8'", "(8,)", 32),
            "column 'oz': holds 32 bytes of data, expected 8 values of 8",
        ),
        ("huge", values("oz", "'<f4'", "(99999999999999999999,)", 32), "column 'oz': the .npy header"),
        ("truncated", stored[..stored.len() / 2].to_vec(), "not a complete .npz file"),
        ("corrupt", corrupt, "column 't_max': the data are corrupt"),
        ("bzip2", compressed(12), "column 'ox': the compression Bzip2 is not supported, expected Stored or Deflated"),
        ("lzma", compressed(14), "column 'ox': the compression Lzma is not supported, expected Stored or Deflated"),
        ("twice", twice, "column 'oz': is there more than once"),
        ("text", b"ox oy oz\n".to_vec(), "not a complete .npz file"),
        ("nothing", vec![], "not a complete .npz file"),
        ("empty", empty, "the wavefront is empty"),
    ];
    // The original is no such case.
    let (_kept, path) = folder_with("good.npz", &stored);
    succeed(&["sample", &path, "--rays", "8"]);
    for (case, bytes, expected) in cases {
        let (folder, wavefront) = folder_with("bad.npz", &bytes);
        let [output, json] = ["out.npz", "out.json"].map(|name| folder.path().join(name));
        let arguments = ["sample", &wavefront, "--strategy", "equi-angular", "--rays", "8"];
        let told = fail(&[&arguments[..], &["--output", text(&output), "--json", text(&json)]].concat());
        assert!(told.contains(expected) && told.contains(&wavefront), "{case}: {told}");
        assert_eq!(names(folder.path()), ["bad.npz"], "{case}");
    }
}

/// The radiance that `sample` finds of a wavefront, and what it says on standard error.
fn told_of(npz: &Npz) -> (String, String) {
    let (_folder, wavefront) = folder_with("w.npz", &npz.stored());
    let arguments = ["sample", &wavefront, "--strategy", "point-normal", "--rays", "8", "--json", "-"];
    let (json, told) = succeed_with_a_word(&arguments);
    let figures: Value = serde_json::from_str(&json).unwrap();
    (figures["results"][0]["radiance"].to_string(), told.replace(&wavefront, "w.npz"))
}

#[test]
fn columns_of_other_floats_are_converted_and_named_in_one_line() {
    let npz = Npz::wavefront();
    let (expected, told) = told_of(&npz);
    assert_eq!(told, "");
    // All values but those of u are whole quarters, or NaN.
    let double = |npz: Npz, name: &str| {
        let data: Vec<u8> = npz.column(name).iter().flat_map(|&value| f64::from(value).to_le_bytes()).collect();
        npz.with(name, "'<f8'", "(8L,)", &data)
    };
    let swapped: Vec<u8> = npz.column("u").iter().flat_map(|value| value.to_be_bytes()).collect();
    let native: Vec<u8> = npz.column("ny").iter().flat_map(|value| value.to_ne_bytes()).collect();
    // 1 in half precision.
    let half = [0x3c, 0].repeat(8);
    let npz = COLUMNS[..8].iter().fold(npz, |npz, name| double(npz, name));
    let npz = npz.with("u", "'>f4'", "(8,)", &swapped).with("ny", "'f4'", "(8,)", &native);
    let (radiance, told) = told_of(&npz.with("ey", "'>f2'", "(8,)", &half));
    assert_eq!(radiance, expected);
    assert_eq!(
        told,
        "w.npz: converted to float32: ox, oy, oz, dx, dy, dz, t_min, t_max from float64 ('<f8'); ey from big-endian \
         float16 ('>f2'); u from big-endian float32 ('>f4')\n"
    );
}

#[test]
fn a_float64_beyond_f32_makes_its_ray_invalid() {
    let data: Vec<u8> = (0..8).flat_map(|i| if i == 2 { 1e300f64 } else { 0.0 }.to_le_bytes()).collect();
    let (_folder, wavefront) = folder_with("w.npz", &Npz::wavefront().with("oy", "'<f8'", "(8,)", &data).stored());
    let (json, _) = succeed_with_a_word(&["sample", &wavefront, "--rays", "8", "--json", "-"]);
    let figures: Value = serde_json::from_str(&json).unwrap();
    let invalid = &figures["invalid_rays"];
    assert_eq!((&invalid["count"], &invalid["first"]), (&Value::from(2), &Value::from(2)), "{invalid}");
    assert_eq!(invalid["reason"], "origin is inf, expected coordinates of at most 1e18 in size");
}

/// A wavefront, all of whose rays are valid but for what is done to columns of some of them.
fn with_faults(faults: &[(&str, usize, f32)]) -> Npz {
    let npz = Npz::wavefront().with_all(&[("dx", vec![1.0; 8])]);
    faults.iter().fold(npz, |npz, &(name, ray, value)| {
        let mut column = npz.column(name);
        column[ray] = value;
        npz.with_all(&[(name, column)])
    })
}

#[test]
fn invalid_rays_are_counted_and_the_first_one_is_told_with_its_reason() {
    for (fault, reason) in [
        (("dx", 2.0), "direction is 2, expected length 1 within 1e-3"),
        (("dx", f32::NAN), "direction is NaN, expected length 1 within 1e-3"),
        (("t_min", 4.0), "t_max is 3, expected t_min <= t_max"),
        (("t_min", -1.0), "t_min is -1, expected 0 <= t_min <= 1e18"),
        (("ex", f32::INFINITY), "position is inf, expected coordinates of at most 1e18 in size"),
        (("nz", 3.0), "normal is 3, expected length 1 within 1e-3"),
        (("u", 1.5), "u is 1.5, expected 0 <= u <= 1"),
        (("u", -0.25), "u is -0.25, expected 0 <= u <= 1"),
        (("u", f32::NAN), "u is NaN, expected 0 <= u <= 1"),
    ] {
        let (name, value) = fault;
        let (_folder, wavefront) = folder_with("w.npz", &with_faults(&[(name, 4, value), (name, 6, value)]).stored());
        let arguments = ["sample", &wavefront, "--strategy", "equi-angular", "--rays", "8"];
        let table = succeed(&arguments);
        let line = format!("2 of 8 rays are invalid, the first is ray 4: {reason}");
        assert!(table.lines().any(|told| told == line), "{line}: {table}");

        let figures: Value = serde_json::from_str(&succeed(&[&arguments[..], &["--json", "-"]].concat())).unwrap();
        assert_eq!(figures["invalid_rays"], serde_json::json!({ "count": 2, "first": 4, "reason": reason }));
        let row = &figures["results"][0];
        assert_eq!((&row["sampled"], &row["invalid"], &row["check_rays"]), (&6.into(), &2.into(), &6.into()), "{row}");
        // Of the valid ones the estimate agrees.
        assert!(row["check_z"].as_f64().unwrap().abs() < 5.0, "{row}");
    }
}

#[test]
fn of_a_valid_wavefront_no_ray_is_told_invalid() {
    // A ray of no length is valid.
    let (_folder, wavefront) = folder_with("w.npz", &with_faults(&[("t_max", 3, 0.0)]).stored());
    assert!(!succeed(&["sample", &wavefront, "--rays", "8"]).contains("rays are invalid"));
    let figures: Value = serde_json::from_str(&succeed(&["sample", &wavefront, "--rays", "8", "--json", "-"])).unwrap();
    assert!(figures["invalid_rays"].is_null() && figures.as_object().unwrap().contains_key("invalid_rays"));
    let row = &figures["results"][1];
    assert_eq!((&row["strategy"], &row["empty"], &row["invalid"]), (&"equi-angular".into(), &1.into(), &0.into()));
}

#[test]
fn a_wavefront_without_a_valid_ray_is_refused_with_the_reason() {
    let (_folder, wavefront) = folder_with("w.npz", &with_faults(&[]).with_all(&[("dz", vec![2.0; 8])]).stored());
    let reason = "none of 8 rays is valid, the first is ray 0: direction is 2.236068, expected length 1 within 1e-3";
    for arguments in
        [&["sample", &wavefront][..], &["sample", &wavefront, "--json", "-"], &["variance", "--set", &wavefront]]
    {
        let told = fail(arguments);
        assert_eq!(told, format!("error: {wavefront}: {reason}\n"), "{arguments:?}");
    }
    // Nor is one of which no ray that is to be sampled is valid.
    let faults = [("dx", 0, 2.0), ("dx", 1, 0.0)];
    let (_folder, wavefront) = folder_with("w.npz", &with_faults(&faults).stored());
    let told = fail(&["sample", &wavefront, "--rays", "2"]);
    assert!(told.contains("none of 2 rays is valid, the first is ray 0: direction is 2,"), "{told}");
    succeed(&["sample", &wavefront, "--rays", "3"]);
}

#[test]
fn variances_are_of_the_valid_rays_and_the_others_are_told() {
    // A bad variate is none of a scene.
    let faults = [("dx", 5, 2.0), ("t_min", 6, -1.0), ("u", 1, 7.0)];
    let (_folder, wavefront) = folder_with("w.npz", &with_faults(&faults).stored());
    let arguments = ["variance", "--set", &wavefront, "--strategy", "equi-angular", "--json", "-"];
    let (json, told) = succeed_with_a_word(&arguments);
    let reason = "direction is 2, expected length 1 within 1e-3";
    assert_eq!(told, format!("{wavefront}: 2 of 8 rays are invalid, the first is ray 5: {reason}\n"));
    let rows: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(rows[0]["scenes"], 6);
}

#[test]
fn where_there_is_no_light_there_is_no_z_and_no_minus_zero() {
    // Empty rays; a medium that does not scatter.
    let empty = with_faults(&[]).with_all(&[("t_max", vec![0.0; 8])]);
    for (npz, medium) in [(empty, "0.1,0.3,0.6"), (with_faults(&[]), "0.1,0,0.6")] {
        let (_folder, wavefront) = folder_with("w.npz", &npz.stored());
        let arguments = ["sample", &wavefront, "--rays", "16", "--medium", medium];
        let table = succeed(&arguments);
        for &strategy in Strategy::ALL {
            let radiance = table.lines().filter(|line| line.starts_with(&format!("{strategy} "))).nth(1).unwrap();
            let cells: Vec<&str> = radiance.split_whitespace().collect();
            assert_eq!(cells[2..8], ["0.00000e0", "0.0e0", "0.00000e0", "0.0e0", "0.00000e0", "-"], "{table}");
        }
        let json = succeed(&[&arguments[..], &["--json", "-"]].concat());
        assert!(!json.contains("-0.0"), "{json}");
    }
}

#[test]
fn a_table_says_what_its_columns_are() {
    let table = succeed(&["sample", "--rays", "1000", "--check", "10"]);
    for word in
        ["sampled: ", "empty: ", "invalid: ", "bisected: ", "radiance: ", "estimate: ", "+-: ", "quadrature: ", "CDF: "]
    {
        assert!(table.lines().any(|line| line.contains(word) && line.contains(": ")), "{word}: {table}");
    }
    assert!(table.contains("on 10 of the rays"), "{table}");
}

#[test]
fn a_missing_wavefront_is_refused_by_name() {
    let folder = TempDir::new().unwrap();
    let missing = folder.path().join("missing.npz");
    assert!(fail(&["sample", text(&missing)]).contains(text(&missing)));
    assert!(fail(&["sample", text(folder.path())]).contains(text(folder.path())));
}

#[test]
fn an_unwritable_output_is_refused_by_name() {
    let folder = TempDir::new().unwrap();
    let mut refused = vec![folder.path().to_owned(), folder.path().join("no/such/folder/out")];
    if cfg!(target_os = "linux") {
        refused.push(PathBuf::from("/dev/full"));
    }
    for path in refused {
        for option in ["--output", "--json"] {
            let arguments = ["sample", "--rays", "10", "--strategy", "equi-angular", option, text(&path)];
            let told = fail(&arguments);
            assert!(told.contains("cannot write") && told.contains(text(&path)), "{told}");
        }
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn what_was_there_stays_when_the_run_fails() {
    let (folder, output) = folder_with("out.npz", b"precious");
    fail(&["sample", "no-such-wavefront.npz", "--strategy", "equi-angular", "--output", &output]);
    assert_eq!(fs::read(&output).unwrap(), b"precious");
    assert_eq!(names(folder.path()), ["out.npz"]);
}

#[test]
fn a_refused_argument_is_named() {
    let folder = TempDir::new().unwrap();
    let output = folder.path().join("out.npz");
    for (arguments, expected) in [
        (&["--rays", "0"][..], "--rays <RAYS>': expected a whole number of at least 1"),
        (&["--rays", "many"], "--rays <RAYS>': expected a whole number of at least 1"),
        (&["--threads", "0"], "--threads <N>': expected a whole number of at least 1"),
        (&["--medium", "0.1,0.3"], "--medium <MU_A,MU_S,G>': expected three numbers"),
        (&["--medium", "a,b,c"], "--medium <MU_A,MU_S,G>': expected three numbers"),
        (&["--medium", "-1,0.3,0"], "mu_a is -1, expected a finite value >= 0"),
        (&["--medium", "0.1:0.2,0.3,0"], "expected three numbers"),
        (&["--medium", "0.1,0.2,0:0:0"], "expected three numbers"),
        (&["--medium", "1:2:3,1:2:3:4,0"], "a coefficient has 3 channels, expected 4"),
        (&["--medium", "1,0:-1:2,0"], "mu_s is -1, expected a finite value >= 0"),
        (&["--medium", "0.1,nan,0"], "mu_s is NaN, expected a finite value >= 0"),
        (&["--medium", "0.1,0.3,1.5"], "g is 1.5, expected -1 <= g <= 1"),
        (&["--strategy", "best"], "no strategy is called 'best'; there are transmittance"),
        (&["--precision", "best"], "no precision is called 'best'; there are exact, fast"),
        (&[], "--output takes exactly one --strategy"),
        (&["--strategy", "equi-angular", "--strategy", "point-normal"], "--output takes exactly one --strategy"),
    ] {
        let told = fail(&[&["sample", "--output", text(&output)], arguments].concat());
        assert!(told.contains(expected), "{told}");
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn a_reader_who_has_seen_enough_is_no_failure() {
    let mut run = Command::new(env!("CARGO_BIN_EXE_airlight"))
        .args(["sample", "--rays", "1000", "--check", "0"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(run.stdout.take());
    let output = run.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), &*stderr), (Some(0), ""));
}
