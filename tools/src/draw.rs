//! Random numbers by counter: no case depends on who draws it when.

use glam::Vec3;
use std::f32::consts::PI;

/// 2^-24.
pub(crate) const EPS: f32 = f32::EPSILON / 2.0;

/// Random numbers of one case: a hash of seed, family and index, then a SplitMix64 sequence from there.
pub(crate) struct Draw(u64);

impl Draw {
    pub(crate) fn new(seed: u64, family: u64, index: u64) -> Self {
        let mut draw = Self(seed.wrapping_mul(0xd134_2543_de82_ef95) ^ family.wrapping_shl(56));
        let key = draw.next();
        Self(key ^ index.wrapping_mul(0x9e6c_63d0_76cc_4955))
    }

    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    pub(crate) fn pick(&mut self, values: &[f32]) -> f32 {
        values[self.below(values.len() as u64) as usize]
    }

    /// A multiple of 2^-24 in `[0, 1)`.
    pub(crate) fn uniform(&mut self) -> f32 {
        (self.next() >> 40) as f32 * EPS
    }

    pub(crate) fn between(&mut self, a: f32, b: f32) -> f32 {
        a + (b - a) * self.uniform()
    }

    pub(crate) fn log_between(&mut self, a: f32, b: f32) -> f32 {
        self.between(a.ln(), b.ln()).exp()
    }

    pub(crate) fn direction(&mut self) -> Vec3 {
        let z = self.between(-1.0, 1.0);
        let (sin, cos) = self.between(-PI, PI).sin_cos();
        let s = (1.0 - z * z).sqrt();
        Vec3::new(s * cos, s * sin, z).normalize()
    }
}
