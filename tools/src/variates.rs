//! Uniform variates by counter: each is a hash of a seed and an index, so no result depends on who draws it when.

/// Fills `u` with the variates number `first`, `first + 1`, ... of `seed`: multiples of 2^-24 in `[0, 1)`.
pub fn fill(seed: u64, first: u64, u: &mut [f32]) {
    for (index, u) in (first..).zip(u) {
        *u = uniform(bits(seed, index));
    }
}

/// The random bits number `index` of `seed`.
#[must_use]
pub fn bits(seed: u64, index: u64) -> u64 {
    mix(mix(seed ^ GOLDEN).wrapping_add(index.wrapping_mul(GOLDEN)))
}

/// The odd number nearest to 2^64 divided by the golden ratio: the step of SplitMix64.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// SplitMix64's output function (Steele, Lea and Flood 2014, with Stafford's constants).
fn mix(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The top 24 bits, which an f32 holds exactly; more would round up to 1.
fn uniform(bits: u64) -> f32 {
    (bits >> 40) as f32 * 2f32.powi(-24)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draw(seed: u64, first: u64, count: usize) -> Vec<f32> {
        let mut u = vec![f32::NAN; count];
        fill(seed, first, &mut u);
        u
    }

    #[test]
    fn the_ends_are_zero_and_just_below_one() {
        assert_eq!(uniform(0), 0.0);
        assert_eq!(uniform(u64::MAX), 1.0f32.next_down());
    }

    #[test]
    fn a_variate_depends_on_its_index_alone() {
        let whole = draw(7, 0, 1000);
        assert_eq!(whole[300..], draw(7, 300, 700));
        assert_ne!(whole, draw(8, 0, 1000));
    }

    #[test]
    fn they_are_uniform_and_successive_ones_are_independent() {
        const CELLS: usize = 16;
        const COUNT: usize = 1 << 18;
        let cell = |u: f32| (u * CELLS as f32) as usize;
        for seed in 0..4 {
            let mut hits = [[0u32; CELLS]; CELLS];
            for pair in draw(seed, 0, 2 * COUNT).chunks_exact(2) {
                hits[cell(pair[0])][cell(pair[1])] += 1;
            }
            let expected = COUNT as f64 / (CELLS * CELLS) as f64;
            let chi2: f64 = hits.iter().flatten().map(|&n| (f64::from(n) - expected).powi(2) / expected).sum();
            // 255 degrees of freedom: 4 standard deviations either way.
            assert!((chi2 - 255.0).abs() < 4.0 * 510f64.sqrt(), "seed {seed}: chi2 {chi2}");
        }
    }
}
