//! No call crashes or writes where it must not, whatever its structs hold, as long as its pointers are to memory.
//!
//!     AIRLIGHT_FUZZ=1000000 AIRLIGHT_SEED=7 cargo test --release --test fuzz      so many calls, of that seed

#[path = "host/structs.rs"]
mod structs;

use airlight_c::*;
use structs::{Dice, Structs};

/// Floats of the memory that columns lie in.
const FLOATS: usize = 1 << 16;

struct Random(fastrand::Rng);

impl Dice for Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0.u64(..n)
    }
}

#[test]
fn any_structs_give_a_status() {
    let number = |name| std::env::var(name).ok().map(|text| text.parse::<u64>().unwrap());
    let seed = number("AIRLIGHT_SEED").unwrap_or_else(|| fastrand::u64(..));
    let calls = number("AIRLIGHT_FUZZ").unwrap_or(100_000);
    println!("AIRLIGHT_SEED={seed} AIRLIGHT_FUZZ={calls}");
    let mut structs = Structs::new(Random(fastrand::Rng::with_seed(seed)), FLOATS);
    let mut found = [0_u64; 11];
    for i in 0..calls {
        if i % 256 == 0 {
            structs.fill();
        }
        found[structs.call() as usize] += 1;
    }
    println!("statuses: {found:?}");
    let common = [
        airlight_status::Ok,
        airlight_status::Null,
        airlight_status::StructSize,
        airlight_status::Overlap,
        airlight_status::Channels,
    ];
    assert!(common.iter().all(|&status| found[status as usize] > calls / 1000), "{found:?} of seed {seed}");
}
