//! What tests call the ABI with: a batch of random rays in the columns of a host.

#![allow(dead_code, unreachable_pub, reason = "each test takes what it needs")]

use airlight_c::*;
use core::ffi::CStr;

/// What lights the rays of a host, and what they are in.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    pub has_spots: bool,
    pub channels: usize,
}

/// Neither spots nor colours.
pub const PLAIN: Look = Look { has_spots: false, channels: 1 };

/// Every kind.
pub const LOOKS: [Look; 4] = [
    PLAIN,
    Look { has_spots: true, channels: 1 },
    Look { has_spots: false, channels: 3 },
    Look { has_spots: true, channels: 4 },
];

/// Rays, numbers of each, and what lights them.
#[derive(Clone)]
pub struct Host {
    pub origin: [Vec<f32>; 3],
    pub direction: [Vec<f32>; 3],
    pub t_min: Vec<f32>,
    pub t_max: Vec<f32>,
    pub position: [Vec<f32>; 3],
    pub normal: [Vec<f32>; 3],
    /// Cosines of the outer and the inner cone; -1 for a ray that no spot lights.
    pub cosines: [Vec<f32>; 2],
    pub mu_a: [Vec<f32>; 4],
    pub mu_s: [Vec<f32>; 4],
    pub g: Vec<f32>,
    /// Variates or distances, so many for each ray.
    pub u: Vec<f32>,
    pub index: Vec<u32>,
    pub emitters: Vec<airlight_emitter>,
    pub media: Vec<airlight_medium>,
    pub look: Look,
}

impl Host {
    /// Some rays of a seed, with so many variates each; every 17th is bad.
    pub fn new(look: Look, seed: u64, rays: usize, per_ray: usize) -> Self {
        let mut rng = fastrand::Rng::with_seed(seed);
        let mut host = Self {
            origin: Default::default(),
            direction: Default::default(),
            t_min: vec![],
            t_max: vec![],
            position: Default::default(),
            normal: Default::default(),
            cosines: Default::default(),
            mu_a: Default::default(),
            mu_s: Default::default(),
            g: vec![],
            u: (0..rays * per_ray).map(|_| rng.f32()).collect(),
            index: (0..rays).map(|_| rng.u32(0..3)).collect(),
            emitters: vec![],
            media: vec![],
            look,
        };
        for ray in 0..rays {
            let [direction, normal] = [unit(&mut rng), unit(&mut rng)];
            for k in 0..3 {
                host.origin[k].push(rng.f32() * 4.0 - 2.0);
                host.direction[k].push(direction[k]);
                host.position[k].push(rng.f32() * 4.0 - 2.0);
                host.normal[k].push(if ray % 3 == 0 { 0.0 } else { normal[k] });
            }
            host.t_min.push(rng.f32());
            host.t_max.push(if ray % 17 == 5 { f32::NAN } else { 1.0 + 4.0 * rng.f32() });
            let cos_outer = rng.f32() * 0.5;
            let cosines = if ray % 3 == 2 { [cos_outer, cos_outer + rng.f32() * 0.5] } else { [-1.0; 2] };
            host.cosines.iter_mut().zip(cosines).for_each(|(column, cosine)| column.push(cosine));
            for c in 0..4 {
                host.mu_a[c].push(rng.f32() * 0.1);
                host.mu_s[c].push(rng.f32() * 0.5);
            }
            host.g.push(rng.f32() * 1.6 - 0.8);
        }
        for kind in if look.has_spots { [2, 1, 0] } else { [0, 1, 1] } {
            let position = [0; 3].map(|_| rng.f32() * 4.0 - 2.0);
            host.emitters.push(airlight_emitter {
                kind,
                position,
                direction: unit(&mut rng),
                cos_outer: 0.1,
                cos_inner: 0.4,
            });
            let (mu_a, mu_s) = ([0; 4].map(|_| rng.f32() * 0.1), [0; 4].map(|_| rng.f32() * 0.5));
            host.media.push(airlight_medium { channels: look.channels as u32, mu_a, mu_s, g: rng.f32() - 0.5 });
        }
        host
    }

    pub fn rays(&self) -> usize {
        self.t_min.len()
    }

    /// All its columns with a float for each ray.
    pub fn columns(&self) -> Vec<&[f32]> {
        let of_three = self.origin.iter().chain(&self.direction).chain(&self.position).chain(&self.normal);
        let rest = [&self.t_min, &self.t_max, &self.g].into_iter().chain(&self.cosines);
        of_three.chain(rest).chain(&self.mu_a).chain(&self.mu_s).map(|column| &column[..]).collect()
    }
}

/// A random direction.
fn unit(rng: &mut fastrand::Rng) -> [f32; 3] {
    let z = rng.f32() * 2.0 - 1.0;
    let (sin, cos) = (rng.f32() * core::f32::consts::TAU).sin_cos();
    let radius = (1.0 - z * z).sqrt();
    [radius * cos, radius * sin, z]
}

/// How columns lie in memory: elements so many bytes apart, the first one so many bytes after an aligned address.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    pub stride: usize,
    pub offset: usize,
}

/// As slices.
pub const PACKED: Layout = Layout { stride: 0, offset: 0 };

/// Elements of a column, as a host has them.
pub struct Column {
    memory: Vec<u64>,
    layout: Layout,
    step: usize,
    width: usize,
}

impl Column {
    /// A column of `count` elements of so many numbers. What no number lies in is 0xaa.
    pub fn new(layout: Layout, count: usize, width: usize) -> Self {
        let step = if layout.stride == 0 { 4 * width } else { layout.stride };
        let bytes = layout.offset + step * count;
        Self { memory: vec![0xaaaa_aaaa_aaaa_aaaa; bytes.div_ceil(8) + 1], layout, step, width }
    }

    /// One with such numbers in it.
    pub fn of(layout: Layout, width: usize, numbers: &[u32]) -> Self {
        let mut column = Self::new(layout, numbers.len() / width, width);
        for (i, number) in numbers.iter().enumerate() {
            let to = column.first().wrapping_add(column.at(i)).cast::<u32>();
            // SAFETY: within the memory of the column.
            unsafe { to.write_unaligned(*number) };
        }
        column
    }

    /// The bits of so many numbers.
    pub fn bits(&mut self, count: usize) -> Vec<u32> {
        let first = self.first();
        // SAFETY: within the memory of the column.
        (0..count).map(|i| unsafe { first.wrapping_add(self.at(i)).cast::<u32>().read_unaligned() }).collect()
    }

    /// Whether nothing was written to it.
    pub fn is_untouched(&self) -> bool {
        self.memory.iter().all(|&word| word == 0xaaaa_aaaa_aaaa_aaaa)
    }

    fn at(&self, i: usize) -> usize {
        i / self.width * self.step + i % self.width * 4
    }

    fn first(&mut self) -> *mut u8 {
        self.memory.as_mut_ptr().cast::<u8>().wrapping_add(self.layout.offset)
    }

    pub fn input(&mut self) -> airlight_column {
        airlight_column { data: self.first().cast(), stride: self.layout.stride }
    }

    pub fn output(&mut self) -> airlight_output {
        airlight_output { data: self.first().cast(), stride: self.layout.stride }
    }

    pub fn indices(&mut self) -> airlight_index_column {
        airlight_index_column { data: self.first().cast(), stride: self.layout.stride }
    }

    pub fn index_output(&mut self) -> airlight_index_output {
        airlight_index_output { data: self.first().cast(), stride: self.layout.stride }
    }
}

/// The last message of this thread.
pub fn message() -> String {
    // SAFETY: a C string that lives until the next call that fails.
    unsafe { CStr::from_ptr(airlight_last_message()) }.to_str().unwrap().to_owned()
}

/// `Ok`, or the status with its message.
pub fn result(status: airlight_status) -> Result<(), (airlight_status, String)> {
    if status == airlight_status::Ok { Ok(()) } else { Err((status, message())) }
}
