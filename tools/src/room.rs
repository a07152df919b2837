//! Batches of a middling room, with hard values among them: whole coordinates, where things meet exactly, and powers of two
//! far from 1. They are the same on every platform: no elementary function makes them.

use crate::batch::{Columns, push};
use crate::variates;

/// Random numbers by counter.
#[derive(Clone, Debug)]
pub struct Random {
    seed: u64,
    index: u64,
}

impl Random {
    /// Those of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { seed, index: 0 }
    }

    /// The next random bits.
    pub fn bits(&mut self) -> u64 {
        self.index += 1;
        variates::bits(self.seed, self.index)
    }

    /// One of `0, ..., n - 1`.
    pub fn below(&mut self, n: u64) -> u64 {
        (self.bits() >> 8) % n
    }

    /// From `low` to `high`.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * (self.bits() >> 40) as f32 * 2f32.powi(-24)
    }

    /// One of `values`.
    pub fn pick(&mut self, values: &[f32]) -> f32 {
        values[self.below(values.len() as u64) as usize]
    }

    /// 1, or now and then another power of two.
    fn scale(&mut self) -> f32 {
        if self.below(8) == 0 { 2f32.powi(self.below(41) as i32 - 20) } else { 1.0 }
    }

    fn point(&mut self, whole: bool) -> [f32; 3] {
        [(); 3].map(|()| self.between(-5.0, 5.0)).map(|x| if whole { x.round() } else { x })
    }

    /// A vector of length 1, along an axis if `whole`.
    pub fn unit(&mut self, whole: bool) -> [f32; 3] {
        let v = self.point(false);
        if whole {
            let axis = self.below(3) as usize;
            return [0, 1, 2].map(|k| if k == axis { 1f32.copysign(v[k]) } else { 0.0 });
        }
        let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
        v.map(|x| x / length)
    }
}

/// So many rays of the room, with so many variates each.
#[must_use]
pub fn columns(random: &mut Random, n: usize, per_ray: usize) -> Columns {
    let mut columns = Columns::default();
    for _ in 0..n {
        let whole = random.below(4) == 0;
        let size = random.scale();
        let t_min = if random.below(2) == 0 { 0.0 } else { size * random.between(0.0, 3.0) };
        let t_max = if random.below(4) == 0 { f32::INFINITY } else { t_min + size * random.between(0.0, 20.0) };
        let [[ox, oy, oz], [px, py, pz]] = [(); 2].map(|()| random.point(whole).map(|x| size * x));
        let [[dx, dy, dz], mut normal] = [(); 2].map(|()| random.unit(whole));
        let mut cosines = [-1.0; 2];
        match random.below(3) {
            0 => normal = [0.0; 3],
            1 => cosines = [random.between(0.0, 1.0), 1.0],
            _ => {}
        }
        let [nx, ny, nz] = normal;
        let thick = random.scale() / size;
        let [a, s] = [(); 2].map(|()| [(); 4].map(|()| thick * random.between(0.0, 1.0)));
        let g = match random.below(8) {
            0 => random.pick(&[1.0, -1.0]) * (1.0 - 2f32.powi(-(random.below(25) as i32))),
            1 => 0.0,
            _ => random.between(-1.0, 1.0),
        };
        push(&mut columns.rays, [ox, oy, oz, dx, dy, dz, t_min, t_max]);
        push(&mut columns.lights, [px, py, pz, nx, ny, nz, cosines[0], cosines[1]]);
        push(&mut columns.fog, [a[0], a[1], a[2], a[3], s[0], s[1], s[2], s[3], g]);
        columns.u.extend((0..per_ray).map(|_| random.between(0.0, 1.0)));
        columns.t.extend((0..per_ray).map(|_| t_min + size * random.between(-0.5, 20.0)));
    }
    columns
}

/// Puts a hard value, or any bits, in the place of one of `per` values.
pub fn spoil(columns: &mut Columns, random: &mut Random, per: u64) {
    const HARD: [f32; 12] =
        [0.0, -0.0, 1.0, -1.0, 0.5, 1e-30, 1e-40, 1e30, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
    let Columns { rays, lights, fog, u, t } = columns;
    for value in rays.iter_mut().chain(lights).chain(fog).chain([u, t]).flatten() {
        if random.below(per) == 0 {
            *value = if random.below(2) == 0 { random.pick(&HARD) } else { f32::from_bits(random.bits() as u32) };
        }
    }
}
