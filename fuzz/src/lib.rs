//! What is fuzzed, as functions of bytes: calls on batches that the bytes describe, and the reader of wavefronts. A function
//! that returns has found nothing.
//!
//! ```sh
//! cargo +nightly fuzz run sample      # one target, with cargo-fuzz
//! cargo test --release                # all of them on random bytes, without it
//! ```

#[path = "../../tools/src/batch.rs"]
mod batch;
mod input;
#[allow(dead_code, reason = "of the command")]
#[path = "../../tools/src/npy.rs"]
mod npy;
#[path = "../../tools/src/promises.rs"]
mod promises;
#[allow(dead_code, reason = "of the command")]
#[path = "../../tools/src/variates.rs"]
mod variates;
#[allow(dead_code, reason = "of the command")]
#[path = "../../tools/src/wavefront.rs"]
mod wavefront;

use input::Input;
use promises::Kept;
use wavefront::Wavefront;

/// `Sampler::sample` on the batch that `data` describes.
///
/// # Panics
/// If a promise is broken.
pub fn sample(data: &[u8]) {
    Input::new(data).map(|input| held(input.batch.hold_sample(&input.sampler, input.cut)));
}

/// `Sampler::pdf`, `cdf` and `evaluate`.
///
/// # Panics
/// If a promise is broken.
pub fn densities(data: &[u8]) {
    Input::new(data).map(|input| held(input.batch.hold_densities(&input.sampler, input.cut)));
}

/// `Integral::radiance` and `choose`.
///
/// # Panics
/// If a promise is broken.
pub fn radiance(data: &[u8]) {
    Input::new(data).map(|input| {
        held(input.batch.hold_radiance(&input.integral, input.cut));
        held(input.batch.hold_choose(&input.integral, &input.choices, input.cut))
    });
}

/// The reader of `airlight sample`: of `data` as an archive, and as a column.
pub fn npz(data: &[u8]) {
    let column = npy::decode(data);
    if let Ok(column) = column {
        // What is written is read again.
        let again = npy::decode(&npy::encode(&column.values)).expect("a column that was encoded");
        let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&again.values), bits(&column.values));
    }
    if let Ok(wavefront) = Wavefront::decode("fuzz".to_owned(), data) {
        for i in 0..wavefront.len() {
            let _ = (wavefront.ray(i), wavefront.variate(i));
        }
    }
}

fn held(kept: Kept) -> usize {
    kept.unwrap_or_else(|broken| panic!("{broken}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{SystemTime, UNIX_EPOCH};

    /// `AIRLIGHT_FUZZ` inputs for each target, of `AIRLIGHT_SEED`; unless told otherwise a few, of another seed every time.
    #[test]
    fn random_bytes_break_nothing() {
        let number = |name: &str| std::env::var(name).ok().and_then(|number| number.parse().ok());
        let now = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_nanos() as u64);
        let seed = number("AIRLIGHT_SEED").unwrap_or_else(now);
        let inputs = number("AIRLIGHT_FUZZ").unwrap_or(if cfg!(miri) { 3 } else { 2000 });
        println!("AIRLIGHT_SEED={seed} AIRLIGHT_FUZZ={inputs}");
        for input in 0..inputs {
            let bits = |index: u64| variates::bits(seed, input << 16 | index);
            let length = bits(0) % 256;
            let data: Vec<u8> = (1..=length).map(|index| bits(index) as u8).collect();
            [sample, densities, radiance, npz].iter().for_each(|target| target(&data));
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
