//! Prints a hash of everything that airlight computes, a line for each backend, strategy and precision, all of it on
//! threads with little stack. The lines of a backend are the same in every profile.

use airlight::{Backend, Precision, Sampler, Strategy};
use dependent::{Columns, everything};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let columns = &Columns::new();
    for backend in Backend::available() {
        let samplers = Strategy::ALL.iter().flat_map(|&strategy| {
            let sampler = Sampler::new(strategy).with_backend(backend);
            Precision::ALL.iter().filter_map(move |&precision| sampler.with_precision(precision).ok())
        });
        for sampler in samplers {
            let hash = on_little_stack(|| everything(columns, &sampler))??;
            println!("{} {} {} {hash:016x}", backend.name(), sampler.strategy(), sampler.precision());
        }
    }
    Ok(())
}

#[cfg(not(target_family = "wasm"))]
fn on_little_stack<R: Send>(work: impl FnOnce() -> R + Send) -> Result<R, Box<dyn Error>> {
    /// A thirty-second of what a main thread usually has.
    const STACK: usize = 256 << 10;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).stack_size(STACK).build()?;
    Ok(pool.install(work))
}

/// There are no threads: a batch stays on the only one.
#[cfg(target_family = "wasm")]
fn on_little_stack<R>(work: impl FnOnce() -> R) -> Result<R, Box<dyn Error>> {
    Ok(work())
}
