//! The header is clean C and C++, and programs that are linked with the static library run: the examples, and tests that
//! only a program in C or C++ can make.
//!
//! Takes `cc`, `c++` and `valgrind` from the PATH (`CC` and `CXX` name other compilers). What is missing is skipped, and
//! `tools/check-bindings.sh` says so.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

const WARNINGS: [&str; 4] = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"];
const SYSTEM: &[&str] = if cfg!(target_os = "linux") { &["-lpthread", "-lm", "-ldl"] } else { &[] };

#[derive(Clone, Copy)]
enum Language {
    C,
    Cpp,
}

impl Language {
    /// Its compiler, if there is one.
    fn compiler(self) -> Option<String> {
        let (variable, usual) = match self {
            Self::C => ("CC", "cc"),
            Self::Cpp => ("CXX", "c++"),
        };
        let compiler = env::var(variable).unwrap_or_else(|_| usual.to_owned());
        is_there(&compiler).then_some(compiler)
    }
}

/// Whether a program can be run.
fn is_there(program: &str) -> bool {
    let is_there = Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success());
    if !is_there {
        println!("skipped: there is no {program}");
    }
    is_there
}

/// A file of this package.
fn file(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The static library, which cargo puts beside the tests or above them.
fn library() -> PathBuf {
    let test = env::current_exe().unwrap();
    let mut folders = test.ancestors().skip(1).take(2).map(|folder| folder.join("libairlight_c.a"));
    folders.find(|library| library.exists()).expect("the static library is built with the tests")
}

/// What a command has written, if it succeeds.
fn succeed(command: &mut Command) -> String {
    let Output { status, stdout, stderr } = command.output().unwrap();
    let text = [stdout, stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
    assert!(status.success(), "{command:?}: {status}\n{text}");
    text
}

/// Builds a program; `None` without a compiler.
fn build(language: Language, source: &str, flags: &[&str], folder: &TempDir) -> Option<PathBuf> {
    let source = file(source);
    let program = folder.path().join(source.file_stem().unwrap());
    let mut command = Command::new(language.compiler()?);
    command.args(WARNINGS).args(flags).arg("-O2").arg("-I").arg(file("include")).arg(source);
    succeed(command.arg("-o").arg(&program).arg(library()).args(SYSTEM));
    Some(program)
}

/// Has a compiler read a source; nothing is built.
fn check(language: Language, source: PathBuf, flags: &[&str]) {
    if let Some(compiler) = language.compiler() {
        let mut command = Command::new(compiler);
        command.args(WARNINGS).args(flags).arg("-fsyntax-only").arg("-I").arg(file("include"));
        succeed(command.arg(source));
    }
}

/// The first code of a language in a document, as a file.
fn code(document: &str, language: &str, folder: &TempDir) -> PathBuf {
    let text = std::fs::read_to_string(file(document)).unwrap();
    let (_, code) = text.split_once(&format!("```{language}\n")).unwrap();
    let source = folder.path().join(format!("code-{language}.{language}"));
    std::fs::write(&source, code.split_once("```").unwrap().0).unwrap();
    source
}

/// Runs a program with less work under valgrind, if that is there: no error, and nothing is lost.
///
/// It does not know AVX-512 and says to programs that this CPU has none.
fn check_memory(program: &Path, arguments: &[&str]) {
    if is_there("valgrind") {
        let mut command = Command::new("valgrind");
        command.args([
            "--quiet",
            "--error-exitcode=99",
            "--leak-check=full",
            "--errors-for-leak-kinds=definite,indirect",
        ]);
        succeed(command.arg(program).args(arguments));
    }
}

#[test]
fn the_headers_are_clean() {
    let folder = TempDir::new().unwrap();
    let include = |header: &str, extension: &str| {
        let source = folder.path().join(format!("{}.{extension}", header.replace('.', "-")));
        std::fs::write(&source, format!("#include \"{header}\"\n#include \"{header}\"\n")).unwrap();
        source
    };
    for standard in ["-std=c99", "-std=c11", "-std=c17"] {
        check(Language::C, include("airlight.h", "c"), &[standard]);
    }
    for standard in ["-std=c++11", "-std=c++17"] {
        check(Language::Cpp, include("airlight.h", "cpp"), &[standard]);
    }
    check(Language::Cpp, include("airlight.hpp", "cpp"), &["-std=c++17", "-fno-exceptions", "-fno-rtti"]);
    check(Language::Cpp, include("airlight.hpp", "cpp"), &["-std=c++20", "-DAIRLIGHT_EXCEPTIONS"]);
}

#[test]
fn a_wavefront_in_c_has_the_right_means() {
    let folder = TempDir::new().unwrap();
    if let Some(program) = build(Language::C, "examples/wavefront.c", &["-std=c99"], &folder) {
        let text = succeed(&mut Command::new(&program));
        println!("{text}");
        assert!(
            text.contains("65536 rays") && text.contains("equal bits in columns: yes, by two threads: yes"),
            "{text}"
        );
        check_memory(&program, &["1500"]);
    }
}

#[test]
fn a_renderer_in_cpp_draws_the_fog() {
    let folder = TempDir::new().unwrap();
    if let Some(program) = build(Language::Cpp, "examples/pathtrace.cpp", &["-std=c++17", "-fno-exceptions"], &folder) {
        let picture = folder.path().join("fog.ppm");
        println!("{}", succeed(Command::new(&program).arg(&picture)));
        let picture = std::fs::read(&picture).unwrap();
        let pixels = picture.strip_prefix(b"P6\n256 256\n255\n").unwrap();
        assert_eq!(pixels.len(), 256 * 256 * 3);
        let at = |x: usize, y: usize| <[u8; 3]>::try_from(&pixels[(y * 256 + x) * 3..][..3]).unwrap();
        // The lamp's glow, the red wall, the green wall, and the shadow on the floor beside light.
        let (glow, left, right, shadow, floor) = (at(128, 45), at(8, 128), at(247, 128), at(150, 240), at(60, 235));
        // The fog in the cone scatters blue most; outside of it nothing does.
        let (fog, dark) = (at(128, 85), at(30, 20));
        assert!(fog[2] > fog[0] + 5 && dark == [0; 3], "{fog:?} {dark:?}");
        assert!(glow[0] > 240 && left[0] > left[1] + 20 && right[1] > right[0] + 20, "{glow:?} {left:?} {right:?}");
        assert!(shadow[0] + 20 < floor[0], "{shadow:?} {floor:?}");
        check_memory(&program, &[folder.path().join("small.ppm").to_str().unwrap(), "40"]);
    }
}

#[test]
fn the_cpp_header_makes_every_call() {
    let folder = TempDir::new().unwrap();
    if let Some(program) = build(Language::Cpp, "tests/hpp.cpp", &["-std=c++17"], &folder) {
        assert_eq!(succeed(&mut Command::new(&program)), "good\n");
    }
}

#[test]
fn no_environment_changes_a_bit_or_is_changed() {
    let folder = TempDir::new().unwrap();
    if cfg!(not(any(target_arch = "x86_64", target_arch = "aarch64"))) {
        return println!("skipped: the environment is the host's on this architecture");
    }
    if let Some(program) = build(Language::C, "tests/environment.c", &["-std=c99"], &folder) {
        let text = succeed(&mut Command::new(&program));
        assert!(text.starts_with("0 failures"), "{text}");
    }
}

#[test]
fn the_programs_of_the_readme_run() {
    let folder = TempDir::new().unwrap();
    for (language, name, flags) in [(Language::C, "c", "-std=c99"), (Language::Cpp, "cpp", "-std=c++17")] {
        let source = code("README.md", name, &folder);
        if let Some(program) = build(language, source.to_str().unwrap(), &[flags], &folder) {
            let text = succeed(&mut Command::new(&program));
            assert!(text.starts_with("t 1.") && !text.contains("weight 0\n"), "{text}");
        }
    }
}

#[test]
fn the_code_of_the_documents_compiles() {
    let folder = TempDir::new().unwrap();
    // Strides that are not given are 0.
    let flags = ["-std=c99", "-Wno-missing-field-initializers"];
    check(Language::C, code("../../docs/embedding.md", "c", &folder), &flags);
}
