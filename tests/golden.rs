//! The bits of results, as they were: a change of bits fails here. If it is meant, it is marked **values** in the changelog,
//! and the file in `tests/golden` takes the lines that this test prints.
//!
//! `bits.txt`: a line is the hash of everything that a sampler gives for one large batch (`tests/dependent`); `forms.txt`: of all
//! that a sampler or an integral gives for small batches of hard values in every form that a call takes (`airlight_tools::room`);
//! `hard.txt`: for small batches of hard rays (`airlight_tools::hard`).
//! `fused` are backends with fused multiply-add, of which all give the same bits, `plain` the others.

#[allow(dead_code, unreachable_pub, reason = "it is a crate of its own")]
#[path = "dependent/src/lib.rs"]
mod dependent;

use airlight::{Backend, Integral, Nodes, Precision};
use airlight_tools::backends::distinct;
use airlight_tools::batch::{Batch, Columns, FORMS};
use airlight_tools::hard;
use airlight_tools::promises::Choices;
use airlight_tools::room::{self, Random};
use airlight_tools::samplers;
use dependent::everything;

fn rounding(backend: Backend) -> &'static str {
    if backend.is_fused() { "fused" } else { "plain" }
}

fn unchanged(lines: &[String], golden: &str) {
    let golden: Vec<&str> = golden.lines().collect();
    let changed = lines.iter().filter(|line| !golden.contains(&line.as_str())).count();
    assert_eq!(changed, 0, "{changed} of {} lines differ:\n{}", lines.len(), lines.join("\n"));
}

#[test]
fn bits_of_a_large_batch_are_what_they_were() {
    let columns = dependent::Columns::new();
    let mut lines = Vec::new();
    for backend in distinct() {
        for sampler in samplers::all().map(|sampler| sampler.with_backend(backend)) {
            let hash = everything(&columns, &sampler).unwrap();
            lines.push(format!("{} {} {} {hash:016x}", rounding(backend), sampler.strategy(), sampler.precision()));
        }
    }
    unchanged(&lines, include_str!("golden/bits.txt"));
}

/// A batch in a form, and at most so many emitters to choose from.
fn in_form(mut columns: Columns, form: usize, most: usize, random: &mut Random) -> (Batch, Choices) {
    room::spoil(&mut columns, random, 128);
    let table: Vec<_> = columns.emitters().into_iter().take(most).collect();
    let weights = table.iter().map(|_| random.pick(&[0.0, 0.5, 3.0])).collect();
    (columns.batch(form, |n| random.below(n)), Choices { table, weights })
}

/// The hashes of all that samplers and integrals give for the batches.
fn hashes(batches: &[(Batch, Choices)]) -> Vec<String> {
    let mut lines = Vec::new();
    for backend in distinct() {
        let mut add = |name: String, hash: &dyn Fn(&(Batch, Choices)) -> u64| {
            let hash = batches.iter().map(hash).fold(0, |sum: u64, hash| sum.rotate_left(1) ^ hash);
            lines.push(format!("{} {name} {hash:016x}", rounding(backend)));
        };
        for sampler in samplers::all().map(|sampler| sampler.with_backend(backend)) {
            let name = format!("{} {}", sampler.strategy(), sampler.precision());
            add(name, &|(batch, _)| batch.hash_of_sampler(&sampler));
        }
        for (&nodes, &precision) in Nodes::ALL.iter().flat_map(|nodes| Precision::ALL.iter().map(move |p| (nodes, p))) {
            let integral = Integral::new(nodes).with_precision(precision).with_backend(backend);
            add(format!("{nodes} nodes {precision}"), &|(batch, choices)| batch.hash_of_integral(&integral, choices));
        }
    }
    lines
}

#[test]
fn bits_of_every_form_are_what_they_were() {
    let batch = |form: usize| {
        let mut random = Random::new(form as u64);
        let (n, per_ray) = (1 + random.below(70) as usize, [1, 1, 2, 7][form % 4]);
        in_form(room::columns(&mut random, n, per_ray), form, 5, &mut random)
    };
    let batches: Vec<_> = (0..FORMS).map(batch).collect();
    unchanged(&hashes(&batches), include_str!("golden/forms.txt"));
}

/// Columns of emitters with cones and without, in columns of media with one channel, three and four. Of so many emitters to choose
/// from, several share a slot of the search.
#[test]
fn bits_of_hard_rays_are_what_they_were() {
    let batch = |index: usize| {
        let mut random = Random::new(1000 + index as u64);
        let form = [10, 11, 10, 11, 26, 42][index % 6];
        let most = if index.is_multiple_of(8) { 70 } else { 5 };
        in_form(hard::columns(&mut random, 64, 1), form, most, &mut random)
    };
    let batches: Vec<_> = (0..48).map(batch).collect();
    unchanged(&hashes(&batches), include_str!("golden/hard.txt"));
}
