//! Says whether this build is optimised: `cfg(optimized)`. Prepares the images of the documentation.
//!
//! Kernels are inlined whole where it is. At opt-level 0 a function that holds its callees keeps each of their temporaries
//! in a place of its own, and one frame of a kernel would be larger than a stack.

use std::path::Path;
use std::{env, fs, io};

/// The images of the pages that rustdoc shows: the name of the link, the file, its type.
const IMAGES: [(&str, &str, &str); 3] = [
    ("render", "docs/render.png", "image/png"),
    ("figure-1", "docs/figure-1.svg", "image/svg+xml"),
    ("figure-3", "docs/figure-3.svg", "image/svg+xml"),
];

fn main() -> io::Result<()> {
    println!("cargo::rustc-check-cfg=cfg(optimized)");
    println!("cargo::rerun-if-changed=build.rs");
    if env::var("OPT_LEVEL").is_ok_and(|level| level != "0") {
        println!("cargo::rustc-cfg=optimized");
    }
    images()
}

/// Writes `images.md`: definitions of links to the images, the images in them. rustdoc copies no files, so that a path would
/// lead nowhere. An image that is missing is left out: nothing but the documentation needs it.
fn images() -> io::Result<()> {
    let mut definitions = String::new();
    for (name, file, kind) in IMAGES {
        println!("cargo::rerun-if-changed={file}");
        if let Ok(image) = fs::read(file) {
            definitions += &format!("[{name}]: data:{kind};base64,{}\n", base64(&image));
        }
    }
    let out = env::var_os("OUT_DIR").ok_or(io::ErrorKind::NotFound)?;
    fs::write(Path::new(&out).join("images.md"), definitions)
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let group = |three: &[u8]| {
        let bits = (0..3).fold(0, |bits, i| bits << 8 | usize::from(three.get(i).copied().unwrap_or(0)));
        let digit = |i| if i > three.len() { '=' } else { char::from(DIGITS[bits >> (18 - 6 * i) & 63]) };
        [0, 1, 2, 3].map(digit)
    };
    bytes.chunks(3).flat_map(group).collect()
}
