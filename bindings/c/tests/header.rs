//! The committed header is the one that cbindgen makes of the source.
//!
//!     AIRLIGHT_HEADER=write cargo test --test header      writes it

use std::{env, fs};

const HEADER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/include/airlight.h");

#[test]
fn the_header_is_current() {
    let mut made = Vec::new();
    cbindgen::generate(env!("CARGO_MANIFEST_DIR")).unwrap().write(&mut made);
    let made = String::from_utf8(made).unwrap();
    if env::var_os("AIRLIGHT_HEADER").is_some_and(|what| what == "write") {
        fs::write(HEADER, &made).unwrap();
    }
    let committed = fs::read_to_string(HEADER).unwrap_or_default();
    let differ = made.lines().zip(committed.lines()).position(|(a, b)| a != b);
    assert!(
        made == committed,
        "include/airlight.h is not current, see line {differ:?}; tests/header.rs says how to write it"
    );
}
