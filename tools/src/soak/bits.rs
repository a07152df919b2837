//! Rounds of `--bits`: rays of random bits, whatever two backends make of them, as fast as can be.

use super::Tried;
use airlight::{Backend, Integral, Nodes, Precision, Sampler};
use airlight_tools::batch::Columns;
use airlight_tools::promises::Again;
use airlight_tools::room::Random;
use airlight_tools::samplers;

/// Rays of a batch, all with another call than those of the next one.
const RAYS: usize = 1 << 12;
/// Batches of a round.
const BATCHES: u64 = 4;
/// Columns of all that a batch has: of rays, emitters and media, variates and distances.
const COLUMNS: usize = 27;
/// Forms of columns, for one channel in three of four: emitters with a normal, and spots.
const FORMS: [usize; 8] = [10, 11, 10, 11, 10, 11, 26, 43];

/// Tries a round.
pub(super) fn run(random: &mut Random) -> Result<Tried, String> {
    let backends: Vec<Backend> = Backend::available().collect();
    let fused: Vec<Backend> = backends.iter().copied().filter(|backend| backend.is_fused()).collect();
    let mut results = 0;
    for _ in 0..BATCHES {
        let columns = columns(random);
        let batch = columns.batch(FORMS[random.below(8) as usize], |n| n);
        let again = match fused[..] {
            [on, other, ..] if random.below(8) > 0 => Again::Beside { on, other },
            _ => Again::Cut {
                on: backends[random.below(backends.len() as u64) as usize],
                cut: random.below(RAYS as u64) as usize,
            },
        };
        let all: Vec<Sampler> = samplers::all().collect();
        let sampler = &all[random.below(all.len() as u64) as usize];
        results += match random.below(4) {
            0 | 1 => batch.hold_sample(sampler, again),
            2 => batch.hold_densities(sampler, again),
            _ => {
                let nodes = Nodes::ALL[random.below(Nodes::ALL.len() as u64) as usize];
                let precision = Precision::ALL[random.below(Precision::ALL.len() as u64) as usize];
                batch.hold_radiance(&Integral::new(nodes).with_precision(precision), again)
            }
        }?;
    }
    Ok(Tried { rays: RAYS * BATCHES as usize, results, compared: 0 })
}

/// Of every fourth ray all bits are random, of another all but direction and normal; the rest has a middling value in the place
/// of each of them now and then. Else hardly a ray would be one.
fn columns(random: &mut Random) -> Columns {
    // Bit k: the value of column k is any.
    const DIRECTIONS: u32 = 0b111 << 3 | 0b111 << 11;
    let wild: Vec<u32> = (0..RAYS)
        .map(|_| {
            let bits = random.bits();
            let (one, other) = (bits as u32, (bits >> 32) as u32);
            match bits >> 62 {
                0 => u32::MAX,
                1 => !DIRECTIONS,
                2 => one & !DIRECTIONS,
                _ => one & other & !DIRECTIONS,
            }
        })
        .collect();
    let units: [[f32; 3]; 64] = [(); 64].map(|()| random.unit(false));
    let mut columns: [Vec<f32>; COLUMNS] = [(); COLUMNS].map(|()| Vec::with_capacity(RAYS));
    for (k, column) in columns.iter_mut().enumerate() {
        let mut of_two = 0;
        column.extend(wild.iter().enumerate().map(|(i, wild)| {
            of_two = if i % 2 == 0 { random.bits() } else { of_two >> 32 };
            let bits = of_two as u32;
            // In [0, 1).
            let uniform = f32::from_bits(0x3f80_0000 | bits >> 9) - 1.0;
            let any = f32::from_bits(bits);
            let middling = match k {
                0..3 | 8..11 => 10.0 * uniform - 5.0,
                3..6 => units[i % 64][k - 3],
                11..14 => units[i / 64 % 64][k - 11],
                6 => uniform,
                7 => 1.0 + 9.0 * uniform,
                14 => 0.5 * uniform,
                15 => 0.5 + 0.5 * uniform,
                24 => 2.0 * uniform - 1.0,
                26 => 10.0 * uniform,
                _ => uniform,
            };
            // Positive bits where others would end the ray.
            let any = if matches!(k, 6 | 7 | 16..24) { any.abs() } else { any };
            if wild >> k & 1 == 1 { any } else { middling }
        }));
    }
    let mut columns = columns.into_iter();
    let mut next = || columns.next().expect("as many as there are");
    Columns {
        rays: [(); 8].map(|()| next()),
        lights: [(); 8].map(|()| next()),
        fog: [(); 9].map(|()| next()),
        u: next(),
        t: next(),
    }
}
