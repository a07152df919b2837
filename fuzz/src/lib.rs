//! What is fuzzed, as functions of bytes: calls on batches that the bytes describe, the calls of the C ABI, and the reader of
//! wavefronts. A function that returns has found nothing.
//!
//! ```sh
//! tools/fuzz.sh sample 600            # one target for ten minutes, with cargo-fuzz
//! cargo test --release                # all of them on the seeds and on random bytes, without it
//! cargo run --example seeds           # makes the seeds anew
//! ```

// What the reader of wavefronts takes from the library of the tools is here as well.
extern crate self as airlight_tools;

#[path = "../../tools/src/batch.rs"]
mod batch;
#[path = "../../tools/src/draw.rs"]
mod draw;
#[allow(dead_code, missing_docs, reason = "of the tools")]
#[path = "../../tools/src/families.rs"]
pub mod families;
pub mod files;
mod input;
#[allow(dead_code, reason = "of the command")]
#[path = "../../tools/src/npy.rs"]
mod npy;
#[allow(dead_code, reason = "of the command")]
#[path = "../../tools/src/promises.rs"]
mod promises;
#[allow(dead_code, reason = "of the command")]
#[path = "../../tools/src/room.rs"]
mod room;
#[path = "../../bindings/c/tests/host/structs.rs"]
mod structs;
#[allow(dead_code, reason = "of the command")]
#[path = "../../tools/src/variates.rs"]
mod variates;
#[allow(dead_code, reason = "of the command")]
#[path = "../../tools/src/wavefront.rs"]
mod wavefront;

pub use input::{HEAD, Patch};

use input::Input;
use promises::Kept;
use structs::{Dice, Structs};
use wavefront::Wavefront;
use zip::CompressionMethod;

/// A target.
pub type Target = fn(&[u8]);

/// Every target, by name.
pub const TARGETS: [(&str, Target); 6] =
    [("sample", sample), ("densities", densities), ("radiance", radiance), ("choose", choose), ("c", c), ("npz", npz)];

/// `Sampler::sample` on the batch that `data` describes.
///
/// # Panics
/// If a promise is broken.
pub fn sample(data: &[u8]) {
    let input = Input::new(data);
    held(input.batch.hold_sample(&input.sampler, input.again));
}

/// `Sampler::pdf`, `cdf` and `evaluate`.
///
/// # Panics
/// If a promise is broken.
pub fn densities(data: &[u8]) {
    let input = Input::new(data);
    held(input.batch.hold_densities(&input.sampler, input.again));
}

/// `Integral::radiance`.
///
/// # Panics
/// If a promise is broken.
pub fn radiance(data: &[u8]) {
    let input = Input::new(data);
    held(input.batch.hold_radiance(&input.integral, input.again));
}

/// `Integral::choose`.
///
/// # Panics
/// If a promise is broken.
pub fn choose(data: &[u8]) {
    let input = Input::new(data);
    held(input.batch.hold_choose(&input.integral, &input.choices(), input.again));
}

/// A call of the C ABI with the structs that `data` says.
///
/// # Panics
/// If a call panics or writes beside its columns.
pub fn c(data: &[u8]) {
    if !NAKED {
        Structs::new(Bytes(data), FLOATS).call();
    }
}

/// Miri knows no naked functions, as the entries of the C ABI are where there is one.
const NAKED: bool = cfg!(all(miri, any(target_arch = "x86_64", target_arch = "aarch64")));

/// Floats of the memory in which the columns of the C ABI lie.
const FLOATS: usize = 1 << 11;

/// Decisions by the next bytes; the first way where there are no more.
struct Bytes<'d>(&'d [u8]);

impl Dice for Bytes<'_> {
    fn below(&mut self, n: u64) -> u64 {
        let bytes = match n {
            0..=0x100 => 1,
            0x101..=0x1_0000 => 2,
            0x1_0001..=0x1_0000_0000 => 4,
            _ => 8,
        };
        let (now, later) = self.0.split_at(bytes.min(self.0.len()));
        self.0 = later;
        now.iter().fold(0, |number: u64, byte| number << 8 | u64::from(*byte)) % n
    }
}

/// The reader of `airlight sample`: of `data` as an archive, as a column, and as every column of an archive.
///
/// # Panics
/// If the reader panics, does not read what was written, or reads an archive otherwise than its columns.
pub fn npz(data: &[u8]) {
    read(data);
    if let Ok(column) = npy::decode(data) {
        // What is written is read again.
        let again = npy::decode(&npy::encode(&column.values)).expect("a column that was encoded");
        let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&again.values), bits(&column.values));
        let archive = files::npz(data, CompressionMethod::Stored).expect("an archive in memory");
        assert_eq!(read(&archive), column.values.len());
    }
}

/// How many rays the archive has; none if it is refused.
fn read(archive: &[u8]) -> usize {
    Wavefront::decode("fuzz".to_owned(), archive).map_or(0, |wavefront| {
        for i in 0..wavefront.len() {
            let _ = (wavefront.ray(i), wavefront.variate(i));
        }
        wavefront.len()
    })
}

fn held(kept: Kept) -> usize {
    kept.unwrap_or_else(|broken| panic!("{broken}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;
    use std::time::{SystemTime, UNIX_EPOCH};

    /// `AIRLIGHT_FUZZ` inputs for each target, of `AIRLIGHT_SEED`; unless told otherwise a few, of another seed every time.
    #[test]
    fn random_bytes_break_nothing() {
        let number = |name: &str| std::env::var(name).ok().and_then(|number| number.parse().ok());
        let now = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_nanos() as u64);
        let seed = number("AIRLIGHT_SEED").unwrap_or_else(now);
        let inputs = number("AIRLIGHT_FUZZ").unwrap_or(if cfg!(miri) { 3 } else { 20_000 });
        println!("AIRLIGHT_SEED={seed} AIRLIGHT_FUZZ={inputs}");
        for input in 0..inputs {
            let bits = |index: u64| variates::bits(seed, input << 16 | index);
            let length = bits(0) % 256;
            let data: Vec<u8> = (1..=length).map(|index| bits(index) as u8).collect();
            TARGETS.iter().for_each(|(_, target)| target(&data));
        }
    }

    /// The hard cases of `airlight accuracy`, with every strategy and number of nodes, on every backend.
    #[test]
    fn the_seeds_break_nothing() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("seeds");
        let mut seeds: Vec<_> = folder.read_dir().unwrap().map(|seed| seed.unwrap().path()).collect();
        seeds.sort();
        assert!(seeds.len() > 50, "{} seeds", seeds.len());
        for seed in seeds.into_iter().step_by(if cfg!(miri) { 40 } else { 1 }) {
            let mut data = std::fs::read(&seed).unwrap();
            println!("{}", seed.display());
            let (strategies, again) = if cfg!(miri) { ((0..18).step_by(13), 0..1) } else { ((0..18).step_by(1), 0..6) };
            for (strategy, again) in strategies.flat_map(|strategy| again.clone().map(move |again| (strategy, again))) {
                (data[3], data[4], data[5], data[6]) = (strategy / 2, strategy % 2, strategy, again);
                TARGETS[..4].iter().for_each(|(_, target)| target(&data));
            }
        }
    }

    #[test]
    fn the_files_are_read() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("files");
        for file in folder.read_dir().unwrap().map(|file| file.unwrap().path()) {
            let data = std::fs::read(&file).unwrap();
            let archive =
                if data.starts_with(b"PK") { data } else { files::npz(&data, CompressionMethod::Deflated).unwrap() };
            assert_eq!(read(&archive), 2, "{}", file.display());
            npz(&archive);
        }
    }

    /// Bytes of a wavefront with one of them changed, or cut off.
    #[test]
    fn damaged_archives_break_nothing() {
        const CORNELL: &[u8] = include_bytes!("../../tools/data/cornell.npz");
        let (head, tail) = (256, 4096);
        for place in (0..head).chain(CORNELL.len() - tail..CORNELL.len()).step_by(if cfg!(miri) { 1000 } else { 7 }) {
            let mut file = CORNELL.to_vec();
            file[place] ^= 1 << (place % 8);
            npz(&file);
            npz(&CORNELL[..place]);
        }
    }
}
