//! The bits of results, as they were: a change of bits fails here. If it is meant, it is marked **values** in the changelog,
//! and `tests/golden/bits.txt` takes the lines that this test prints.
//!
//! A line is the hash of everything that a sampler gives for one batch (`tests/dependent`): `fused` on backends with fused
//! multiply-add, of which all give the same bits, `plain` on others.

#[allow(dead_code, unreachable_pub, reason = "it is a crate of its own")]
#[path = "dependent/src/lib.rs"]
mod dependent;

use airlight_tools::backends::distinct;
use airlight_tools::samplers;
use dependent::{Columns, everything};

#[test]
fn bits_are_what_they_were() {
    let columns = Columns::new();
    let mut lines = Vec::new();
    for backend in distinct() {
        let rounding = if backend.is_fused() { "fused" } else { "plain" };
        for sampler in samplers::all().map(|sampler| sampler.with_backend(backend)) {
            let hash = everything(&columns, &sampler).unwrap();
            lines.push(format!("{rounding} {} {} {hash:016x}", sampler.strategy(), sampler.precision()));
        }
    }
    let golden: Vec<&str> = include_str!("golden/bits.txt").lines().collect();
    let changed: Vec<&String> = lines.iter().filter(|line| !golden.contains(&line.as_str())).collect();
    assert!(changed.is_empty(), "{} of {} lines differ:\n{}", changed.len(), lines.len(), lines.join("\n"));
}
