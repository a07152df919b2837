//! Instructions per ray, as callgrind counts them: to the last one, on any machine, whatever else it does.

use super::work::{Contestant, Kernel, Work};
use crate::table;
use airlight::{Backend, Sampler};
use airlight_tools::threads;
use airlight_tools::workload::{Wanted, Workload};
use anyhow::{Context, Result, ensure};
use serde::Serialize;
use std::env;
use std::fmt;
use std::process::Command;

/// Rays of a batch, a multiple of any number of lanes.
const RAYS: usize = 4096;
/// Batches of the two runs: what starting up takes is in both.
const BATCHES: [usize; 2] = [1, 5];
/// Valgrind knows no AVX-512.
const UNKNOWN: &str = "avx512";

/// A row per backend, strategy and precision.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub(super) struct Figures(Vec<Row>);

/// The names of the fields are the keys of the JSON, which others read.
#[derive(Debug, Serialize)]
struct Row {
    strategy: &'static str,
    precision: &'static str,
    backend: &'static str,
    instructions_per_ray: f64,
}

/// Counts, on the fastest backend that valgrind knows unless told otherwise; none without valgrind.
pub(super) fn count(samplers: &[Sampler], backends: &[Backend]) -> Result<Option<Figures>> {
    if Command::new("valgrind").arg("--version").output().is_err() {
        eprintln!("valgrind is missing: no instructions are counted");
        return Ok(None);
    }
    ensure!(backends.iter().all(|backend| backend.name() != UNKNOWN), "valgrind knows no {UNKNOWN}");
    let fastest = Backend::available().find(|backend| backend.name() != UNKNOWN);
    let backends = if backends.is_empty() { fastest.as_slice() } else { backends };
    let mut rows = Vec::new();
    for backend in backends {
        for sampler in samplers {
            let [few, many] = BATCHES.map(|batches| instructions(sampler, *backend, batches));
            let rays = RAYS * (BATCHES[1] - BATCHES[0]);
            let instructions_per_ray = (many? - few?) as f64 / rays as f64;
            let (strategy, precision) = (sampler.strategy().name(), sampler.precision().name());
            rows.push(Row { strategy, precision, backend: backend.name(), instructions_per_ray });
        }
    }
    Ok(Some(Figures(rows)))
}

/// Those of a run of this command that does nothing but [`sample`].
fn instructions(sampler: &Sampler, backend: Backend, batches: usize) -> Result<i64> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(env::current_exe()?)
        .args(["profile", "--strategy", sampler.strategy().name(), "--precision", sampler.precision().name()])
        .args(["--backend", backend.name()])
        .args(["--batches", &batches.to_string()])
        .output()?;
    let told = String::from_utf8_lossy(&output.stderr);
    let collected = told.lines().find_map(|line| line.split_once("Collected : ")?.1.trim().parse().ok());
    collected.filter(|_| output.status.success()).with_context(|| format!("valgrind failed:\n{told}"))
}

/// Draws a sample for each ray of this many batches.
pub(super) fn sample(samplers: &[Sampler], backends: &[Backend], batches: usize) -> Result<()> {
    let mut workload = Workload::new(RAYS);
    let pool = threads::pool(1).context("cannot start a thread")?;
    for sampler in samplers {
        for &backend in backends {
            let kernel = Kernel::new(sampler, backend);
            let work = Work::Sample { kernel, per_ray: 1, wanted: Wanted::Densities };
            let contestant = Contestant { work, samples: RAYS, pool: &pool };
            let mut task = contestant.task(&mut workload);
            (0..batches).try_for_each(|_| task())?;
        }
    }
    Ok(())
}

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = table::new(["strategy", "precision", "backend", "instructions/ray"]);
        for row in &self.0 {
            let cells = [row.strategy, row.precision, row.backend].map(str::to_owned);
            table.add_row(cells.into_iter().chain([format!("{:.1}", row.instructions_per_ray)]));
        }
        writeln!(f, "{}", table::text(&table))
    }
}
