//! The figures as tables.

use super::super::SHARED;
use super::super::subject::{CALL, CHOOSE, ONE, RADIANCE, Subject, TOTAL};
use super::{Figures, Row};
use crate::table;
use comfy_table::Table;
use std::fmt;

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(rows) = self;
        let all_threads = distinct(rows.iter().map(|row| Some(row.subject.threads)));
        for &threads in &all_threads {
            let of_these: Vec<&Row> = rows.iter().filter(|row| row.subject.threads == threads).collect();
            let counted = counted(threads);
            section(f, &format!("limits of arithmetic, {counted} [1e9/s]"), &limits(&of_these), OF_LIMITS)?;
            let title = format!("limits of memory, by rays per batch, {counted} [GB/s]");
            section(f, &title, &memory(&of_these), OF_MEMORY)?;
            let title = format!("time of a sample, by rays per batch, {counted} [ns]");
            section(f, &title, &times(&of_these), OF_TIMES)?;
        }
        let times = |row: &&Row| row.ratio.is_none() && row.subject.strategy.is_some();
        let staged: Vec<&Row> = rows.iter().filter(times).collect();
        let largest = staged.iter().filter(|row| is_stage(&row.subject)).filter_map(|row| row.subject.rays).max();
        if let Some(rays) = largest {
            for backend in distinct(staged.iter().map(|row| row.subject.backend)) {
                let title = format!("stages of a sample, 1 thread, {backend}, batches of {rays} [ns]");
                section(f, &title, &stages(&staged, backend, rays), OF_STAGES)?;
            }
        }
        let fastest = rows.iter().find(|row| row.ns_per_call.is_some()).and_then(|row| row.subject.backend);
        let title = format!("time of a call, by its rays, 1 thread, {} [ns]", fastest.unwrap_or("-"));
        section(f, &title, &calls(&staged), OF_CALLS)?;
        section(f, "few rays, many variates: time of a sample [ns]", &many_variates(&staged), OF_MANY_VARIATES)?;
        section(f, "the integral, 1 thread [ns]", &integrals(rows), OF_INTEGRALS)?;
        section(f, "errors of peers", &errors(rows), OF_ERRORS)?;
        self.comparisons(f)?;
        writeln!(f, "all figures are medians over the rounds")
    }
}

const OF_LIMITS: &str = "f32 operations per second: all lanes of the vectors, all threads";
const OF_MEMORY: &str = "read: the columns that a sample reads; write: t and pdf; stream: both
a number at the head of a column: rays per batch";
const OF_TIMES: &str = "a sample writes t and pdf; a number at the head of a column: rays per batch
+- %: largest deviation of a round from the median; Msamples/s: the best of the row
limit: the limit of the machine that is nearest; %: the share of the time that it alone would take";
const OF_STAGES: &str = "a stage: a run that stops at its end, less a run that stops at its start. Such runs write to
memory what the whole kernel keeps in registers, so stages are approximate
total: t and pdf; weight: also weight and r; 8 per ray: a sample where 8 share the set-up of a ray";
const OF_CALLS: &str = "a number at the head of a column: rays of one call of Sampler::sample, which writes t and pdf
one: one call of Sampler::sample_one, which also has weight and r";
const OF_MANY_VARIATES: &str = "one call writes t and pdf for all variates of all rays";
const OF_INTEGRALS: &str = "N nodes: Integral::radiance, per ray
choose: Integral::choose among 32 emitters with 4 nodes, per ray and emitter";
const OF_ERRORS: &str = "0.1 % of rays have a larger |CDF(t) - u|; airlight accuracy measures ours";
const OF_PORTABLE: &str = "time with the portable backend, divided by the time with the backend of the column";
const OF_THREADS: &str = "time with one thread, divided by the time with several
a number at the head of a column: samples per batch";
const OF_COSTS: &str = "time, divided by that of equi-angular in the same precision with one sample per ray
a number at the head of a column: samples per batch";
const OF_OTHERS: &str = "A : B is the time of B divided by the time of A, so that A is faster above 1
a number at the head of a column: samples per batch";

fn counted(threads: usize) -> String {
    format!("{threads} {}", if threads == 1 { "thread" } else { "threads" })
}

impl Figures {
    /// Ratios, of the fastest backend where they are not about backends.
    fn comparisons(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let against = |other: &'static str| self.0.iter().filter(move |row| row.against == Some(other));
        let fastest = self.0.iter().find_map(|row| row.subject.backend);
        let of_fastest = |row: &&Row| row.subject.backend == fastest;
        let alone = |row: &&Row| row.subject.threads == 1;

        let to_portable: Vec<&Row> = against("portable").filter(alone).collect();
        // The slower backends are measured on small batches alone.
        let backends = |rays| to_portable.iter().filter(|row| row.subject.rays == Some(rays)).count();
        let sizes = distinct(to_portable.iter().map(|row| row.subject.rays));
        if let Some(rays) = sizes.into_iter().max_by_key(|&rays| (backends(rays), rays)) {
            let rows: Vec<&Row> = to_portable.iter().copied().filter(|row| row.subject.rays == Some(rays)).collect();
            let title = format!("times as fast as portable, 1 thread, batches of {rays}");
            section(f, &title, &by_backend(&rows), OF_PORTABLE)?;
        }
        let of_threads = against("one thread").filter(of_fastest).filter(|row| row.subject.threads > 1);
        section(
            f,
            "times as fast as with one thread",
            &ratios(&of_threads.collect::<Vec<_>>(), |row| {
                format!("{}, {} threads", row.subject.strategy.unwrap_or("-"), row.subject.threads)
            }),
            OF_THREADS,
        )?;
        let costs = against("equi-angular").filter(of_fastest).filter(alone);
        section(
            f,
            "times the cost of equi-angular, 1 thread",
            &ratios(&costs.collect::<Vec<_>>(), |row| {
                let strategy = row.subject.strategy.unwrap_or("-");
                match row.subject.samples_per_ray {
                    1 => strategy.to_owned(),
                    several => format!("{strategy}, {several} per ray"),
                }
            }),
            OF_COSTS,
        )?;
        let with_peers = against("peer").map(|row| row.subject.backend);
        for backend in distinct([fastest].into_iter().chain(with_peers)) {
            let others = ["peer", "taylor-transmittance", "exact"].into_iter().flat_map(against).filter(alone);
            let of_backend = others.filter(|row| row.subject.backend == Some(backend));
            let title = format!("times as fast as others, 1 thread, {backend}");
            section(f, &title, &ratios(&of_backend.collect::<Vec<_>>(), against_other), OF_OTHERS)?;
        }
        Ok(())
    }
}

/// What is compared with a peer or another kernel of ours, and that.
fn against_other(row: &Row) -> String {
    let strategy = row.subject.strategy.unwrap_or("-");
    match (row.subject.peer, row.against) {
        (Some(peer), _) => format!("{strategy} : peer {peer}"),
        (None, other) => format!("{strategy} : {}", other.unwrap_or("-")),
    }
}

/// A table with its title and a legend, if there is anything in it.
fn section(f: &mut fmt::Formatter<'_>, title: &str, table: &Table, legend: &str) -> fmt::Result {
    if table.row_count() == 0 {
        return Ok(());
    }
    writeln!(f, "{title}\n{}\n{legend}\n", table::text(table))
}

fn is_stage(subject: &Subject) -> bool {
    !matches!(subject.stage, None | Some(TOTAL | "with-weight")) && !subject.is_call()
}

/// Those that there are, in the order in which they come.
fn distinct<T: PartialEq>(values: impl Iterator<Item = Option<T>>) -> Vec<T> {
    let mut distinct = Vec::new();
    for value in values.flatten() {
        if !distinct.contains(&value) {
            distinct.push(value);
        }
    }
    distinct
}

/// A table with a column for each size of batches, after the `first` and before the `last`.
fn by_size(first: &[&str], sizes: &[usize], last: &[&str]) -> Table {
    let first = first.iter().map(ToString::to_string);
    let last = last.iter().map(ToString::to_string);
    table::new(first.chain(sizes.iter().map(ToString::to_string)).chain(last))
}

fn cell(figure: Option<f64>) -> String {
    match figure {
        None => "-".to_owned(),
        Some(figure) if figure.abs() < 10.0 => format!("{figure:.2}"),
        Some(figure) => format!("{figure:.1}"),
    }
}

fn limits(rows: &[&Row]) -> Table {
    let mut table = table::new(["backend", "multiply-adds", "divisions"]);
    let arithmetic = || rows.iter().filter(|row| row.subject.limit.is_some() && row.subject.rays.is_none());
    for backend in distinct(arithmetic().map(|row| row.subject.backend)) {
        let rate = |limit| {
            let row = arithmetic().find(|row| row.subject.backend == Some(backend) && row.subject.limit == Some(limit));
            cell(row.and_then(|row| row.ns_per_sample).map(f64::recip))
        };
        table.add_row([backend.to_owned(), rate("fma"), rate("division")]);
    }
    table
}

fn memory(rows: &[&Row]) -> Table {
    let memory = || rows.iter().filter(|row| row.gb_per_s.is_some());
    let sizes = distinct(memory().map(|row| row.subject.rays));
    let mut table = by_size(&["columns"], &sizes, &[]);
    for limit in distinct(memory().map(|row| row.subject.limit)) {
        let rate = |&rays: &usize| {
            let row = memory().find(|row| row.subject.limit == Some(limit) && row.subject.rays == Some(rays));
            cell(row.and_then(|row| row.gb_per_s))
        };
        table.add_row([limit.to_owned()].into_iter().chain(sizes.iter().map(rate)));
    }
    table
}

/// Kernels that write `t` and `pdf`, ours and those of peers.
fn times(rows: &[&Row]) -> Table {
    let whole = |row: &&&Row| {
        row.ns_per_sample.is_some() && row.subject.stage == Some(TOTAL) && row.subject.samples_per_ray == 1
    };
    let whole = || rows.iter().filter(whole);
    let sizes = distinct(whole().map(|row| row.subject.rays));
    let mut table = by_size(&["strategy", "precision", "backend"], &sizes, &["+- %", "Msamples/s", "limit", "%"]);
    let kernel = |row: &Row| Subject { rays: None, ..row.subject };
    for wanted in distinct(whole().map(|row| Some(kernel(row)))) {
        let of_kernel: Vec<&&Row> = whole().filter(|row| kernel(row) == wanted).collect();
        let time = |&rays: &usize| {
            cell(of_kernel.iter().find(|row| row.subject.rays == Some(rays)).and_then(|row| row.ns_per_sample))
        };
        let best = of_kernel.iter().max_by(|a, b| a.msamples_per_s.partial_cmp(&b.msamples_per_s).expect("no NaN"));
        let deviation = of_kernel.iter().filter_map(|row| Some(100.0 * row.deviation(row.ns_per_sample?)));
        let names = [wanted.strategy.or(wanted.peer), wanted.precision.or(Some("peer")), wanted.backend];
        let last = [
            format!("{:.0}", deviation.fold(0.0, f64::max)),
            cell(best.and_then(|row| row.msamples_per_s)),
            best.and_then(|row| row.bound_by).unwrap_or("-").to_owned(),
            best.and_then(|row| row.share).map_or("-".to_owned(), |share| format!("{:.0}", 100.0 * share)),
        ];
        let names = names.map(|name| name.unwrap_or("-").to_owned());
        table.add_row(names.into_iter().chain(sizes.iter().map(time)).chain(last));
    }
    table
}

fn stages(rows: &[&Row], backend: &str, rays: usize) -> Table {
    let stages = ["geometry", "set-up", "inversion", "output", TOTAL, "with-weight"];
    let heads = ["strategy", "precision", "geometry", "set-up", "inversion", "output", "total", "weight", "8 per ray"];
    let mut table = table::new(heads);
    let kernel = |row: &Row| Some((row.subject.strategy?, row.subject.precision?));
    let of_backend = || rows.iter().filter(|row| row.subject.threads == 1 && row.subject.backend == Some(backend));
    for wanted in distinct(of_backend().map(|row| kernel(row))) {
        let of_kernel = || of_backend().filter(|row| kernel(row) == Some(wanted));
        let time = |stage| {
            let alone = |row: &&&Row| row.subject.samples_per_ray == 1 && row.subject.rays == Some(rays);
            of_kernel().filter(alone).find(|row| row.subject.stage == Some(stage)).and_then(|row| row.ns_per_sample)
        };
        if time(stages[0]).is_none() {
            continue;
        }
        let together = |row: &&&Row| {
            let Subject { rays: of, samples_per_ray, .. } = row.subject;
            samples_per_ray > 1 && of == Some(rays / samples_per_ray)
        };
        let together = of_kernel().find(together).and_then(|row| row.ns_per_sample);
        let names = [wanted.0, wanted.1].map(str::to_owned);
        table.add_row(names.into_iter().chain(stages.map(|stage| cell(time(stage)))).chain([cell(together)]));
    }
    table
}

/// The integral by nodes, and a choice by it.
fn integrals(rows: &[Row]) -> Table {
    let of_integral = || rows.iter().filter(|row| row.subject.nodes.is_some());
    let nodes = distinct(of_integral().map(|row| row.subject.nodes));
    let heads = nodes.iter().map(|nodes| format!("{nodes} nodes"));
    let names = ["precision", "backend"].map(str::to_owned);
    let mut table = table::new(names.into_iter().chain(heads).chain(["choose".to_owned()]));
    let kernel = |row: &Row| Some((row.subject.precision?, row.subject.backend?));
    for (precision, backend) in distinct(of_integral().map(kernel)) {
        let of_kernel = || of_integral().filter(|row| kernel(row) == Some((precision, backend)));
        let radiance = |nodes: &usize| {
            let of_nodes = |row: &&Row| (row.subject.stage, row.subject.nodes) == (Some(RADIANCE), Some(*nodes));
            cell(of_kernel().find(of_nodes).and_then(|row| row.ns_per_sample))
        };
        let choice = of_kernel().find(|row| row.subject.stage == Some(CHOOSE));
        let choice = choice.and_then(|row| Some(row.ns_per_sample? / row.subject.emitters? as f64));
        let names = [precision, backend].map(str::to_owned);
        table.add_row(names.into_iter().chain(nodes.iter().map(radiance)).chain([cell(choice)]));
    }
    table
}

/// Whole calls of few rays.
fn calls(rows: &[&Row]) -> Table {
    let calls = || rows.iter().filter(|row| row.ns_per_call.is_some());
    let sizes = distinct(calls().filter(|row| row.subject.stage == Some(CALL)).map(|row| row.subject.rays));
    let mut table = by_size(&["strategy", "precision", "one"], &sizes, &[]);
    let sampler = |row: &Row| Some((row.subject.strategy?, row.subject.precision?));
    for wanted in distinct(calls().map(|row| sampler(row))) {
        let time = |stage, rays| {
            let of = |row: &&&Row| {
                let Subject { stage: part, rays: with, .. } = row.subject;
                (sampler(row), part, with) == (Some(wanted), Some(stage), Some(rays))
            };
            cell(calls().find(of).and_then(|row| row.ns_per_call))
        };
        let times = sizes.iter().map(|&rays| time(CALL, rays));
        let names = [wanted.0, wanted.1].map(str::to_owned);
        table.add_row(names.into_iter().chain([time(ONE, 1)]).chain(times));
    }
    table
}

/// Samples of which so many are of one ray that these share more than its set-up.
fn many_variates(rows: &[&Row]) -> Table {
    let many = || rows.iter().filter(|row| row.subject.samples_per_ray > SHARED);
    let all_threads = distinct(many().map(|row| Some(row.subject.threads)));
    let heads = ["strategy", "precision", "rays x variates"].map(str::to_owned).into_iter();
    let mut table = table::new(heads.chain(all_threads.iter().map(|&threads| counted(threads))));
    let shape = |row: &Row| {
        let Subject { strategy, precision, rays, samples_per_ray, .. } = row.subject;
        Some((strategy?, precision?, rays?, samples_per_ray))
    };
    for wanted in distinct(many().map(|row| shape(row))) {
        let time = |&threads: &usize| {
            let of = |row: &&&Row| shape(row) == Some(wanted) && row.subject.threads == threads;
            cell(many().find(of).and_then(|row| row.ns_per_sample))
        };
        let (strategy, precision, rays, per_ray) = wanted;
        let names = [strategy.to_owned(), precision.to_owned(), format!("{rays} x {per_ray}")];
        table.add_row(names.into_iter().chain(all_threads.iter().map(time)));
    }
    table
}

/// What 0.1 % of rays exceed, of the peers.
fn errors(rows: &[Row]) -> Table {
    let mut table = table::new(["peer", "backend", "CDF p99.9"]);
    let told = |row: &Row| Some((row.subject.peer?, row.subject.backend?, row.cdf_p999?));
    for (peer, backend, error) in distinct(rows.iter().map(told)) {
        table.add_row([peer.to_owned(), backend.to_owned(), format!("{error:.1e}")]);
    }
    table
}

/// Ratios of a sampler on each backend.
fn by_backend(rows: &[&Row]) -> Table {
    let backends = distinct(rows.iter().map(|row| row.subject.backend));
    let mut table = table::new(["strategy", "precision"].into_iter().chain(backends.iter().copied()));
    let sampler = |row: &Row| Some((row.subject.strategy?, row.subject.precision?));
    for wanted in distinct(rows.iter().map(|row| sampler(row))) {
        let ratio = |&backend: &&str| {
            let of = |row: &&&Row| sampler(row) == Some(wanted) && row.subject.backend == Some(backend);
            cell(rows.iter().find(of).and_then(|row| row.ratio))
        };
        let names = [wanted.0, wanted.1].map(str::to_owned);
        table.add_row(names.into_iter().chain(backends.iter().map(ratio)));
    }
    table
}

/// Ratios by the number of samples, a row for each name and precision.
fn ratios(rows: &[&Row], name: impl Fn(&Row) -> String) -> Table {
    let samples = |row: &Row| Some(row.subject.rays? * row.subject.samples_per_ray);
    let sizes = distinct(rows.iter().map(|row| samples(row)));
    let mut table = by_size(&["strategy", "precision"], &sizes, &["+- %"]);
    let names = |row: &Row| [name(row), row.subject.precision.unwrap_or("-").to_owned()];
    for wanted in distinct(rows.iter().map(|row| Some(names(row)))) {
        let named: Vec<&&Row> = rows.iter().filter(|row| names(row) == wanted).collect();
        let ratio = |&size: &usize| cell(named.iter().find(|row| samples(row) == Some(size)).and_then(|row| row.ratio));
        let deviation = named.iter().filter_map(|row| Some(100.0 * row.deviation(row.ratio?))).fold(0.0, f64::max);
        let cells = sizes.iter().map(ratio).chain([format!("{deviation:.0}")]);
        table.add_row(wanted.clone().into_iter().chain(cells));
    }
    table
}

impl Row {
    /// How far the farthest round is from the median, in units of it.
    fn deviation(&self, median: f64) -> f64 {
        (self.max - median).max(median - self.min) / median
    }
}
