//! Prints a hash of everything that airlight computes, a line for each backend, strategy and precision, all of it on
//! threads with little stack. The lines of a backend are the same in every profile.

use airlight::{Backend, Precision, Sampler, Strategy};
use dependent::{Columns, everything};
use std::thread;

/// A thirty-second of what a main thread usually has.
const STACK: usize = 256 << 10;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    rayon::ThreadPoolBuilder::new().num_threads(2).stack_size(STACK).build_global()?;
    let columns = &Columns::new();
    for backend in Backend::available() {
        let samplers = Strategy::ALL.iter().flat_map(|&strategy| {
            let sampler = Sampler::new(strategy).with_backend(backend);
            Precision::ALL.iter().filter_map(move |&precision| sampler.with_precision(precision).ok())
        });
        for sampler in samplers {
            let hash = thread::scope(|scope| {
                let work = move || everything(columns, &sampler);
                let thread = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, work)?;
                Ok::<_, std::io::Error>(thread.join().expect("no panic"))
            })??;
            println!("{} {} {} {hash:016x}", backend.name(), sampler.strategy(), sampler.precision());
        }
    }
    Ok(())
}
