//! Batches from bytes: a head says how many rays there are, of what form and from which seed the values of a middling room
//! come; what follows are values of any bits, and where they go.

use crate::batch::{Batch, Columns, FORMS, push};
use crate::promises::Choices;
use crate::variates;
use airlight::{Integral, Nodes, Precision, Sampler, Strategy};

/// A call.
pub(crate) struct Input {
    pub(crate) batch: Batch,
    pub(crate) sampler: Sampler,
    pub(crate) integral: Integral,
    pub(crate) choices: Choices,
    /// The ray before which the batch is cut.
    pub(crate) cut: usize,
}

/// More rays than one thread takes.
const MANY: usize = 4100;
/// Numbers of variates for each ray.
const PER_RAY: [usize; 8] = [1, 1, 1, 1, 2, 3, 7, 33];

/// A value of any bits: the column and the ray that it goes to.
type Patch<'d> = &'d [u8; 6];

impl Input {
    /// What `data` describes; none without a head.
    pub(crate) fn new(data: &[u8]) -> Option<Self> {
        let (&head, rest) = data.split_first_chunk::<16>()?;
        let [rays, per_ray, form, strategy, precision, nodes, cut, seed @ ..] = head.map(usize::from);
        let mut random = Random { seed: seed.iter().fold(0, |seed, byte| seed << 8 | *byte as u64), index: 0 };

        let n = if rays == 255 { MANY } else { rays % 80 };
        let per_ray = if n == MANY { 1 } else { PER_RAY[per_ray % 8] };
        let mut columns = room(&mut random, n, per_ray);
        let (patches, _) = rest.as_chunks();
        patches.iter().for_each(|patch| self::patch(&mut columns, patch));

        let strategy = Strategy::ALL[strategy % Strategy::ALL.len()];
        let precision = Precision::ALL[precision % Precision::ALL.len()];
        let sampler = Sampler::new(strategy);
        let emitters = columns.emitters();
        let weights = emitters.iter().map(|_| if random.below(4) == 0 { 0.0 } else { random.between(0.0, 9.0) });
        let choices = Choices { weights: weights.collect(), table: emitters };
        Some(Self {
            sampler: sampler.with_precision(precision).unwrap_or(sampler),
            integral: Integral::new(Nodes::ALL[nodes % Nodes::ALL.len()]).with_precision(precision),
            choices,
            cut: if n == 0 { 0 } else { cut % n },
            batch: columns.batch(form % FORMS, |n| random.below(n)),
        })
    }
}

/// Random numbers by counter.
struct Random {
    seed: u64,
    index: u64,
}

impl Random {
    fn bits(&mut self) -> u64 {
        self.index += 1;
        variates::bits(self.seed, self.index)
    }

    fn below(&mut self, n: u64) -> u64 {
        (self.bits() >> 8) % n
    }

    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * (self.bits() >> 40) as f32 * 2f32.powi(-24)
    }

    fn point(&mut self, whole: bool) -> [f32; 3] {
        [(); 3].map(|()| self.between(-5.0, 5.0)).map(|x| if whole { x.round() } else { x })
    }

    fn unit(&mut self, whole: bool) -> [f32; 3] {
        let v = self.point(false);
        if whole {
            let axis = self.below(3) as usize;
            return [0, 1, 2].map(|k| if k == axis { 1f32.copysign(v[k]) } else { 0.0 });
        }
        let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
        v.map(|x| x / length)
    }
}

/// Those of a middling room.
fn room(random: &mut Random, n: usize, per_ray: usize) -> Columns {
    let mut columns = Columns {
        u: (0..n * per_ray).map(|_| random.between(0.0, 1.0)).collect(),
        t: (0..n * per_ray).map(|_| random.between(0.0, 20.0)).collect(),
        ..Columns::default()
    };
    for _ in 0..n {
        // Whole coordinates and axes, where things meet exactly.
        let whole = random.below(4) == 0;
        let t_min = if random.below(2) == 0 { 0.0 } else { random.between(0.0, 3.0) };
        let t_max = if random.below(4) == 0 { f32::INFINITY } else { t_min + random.between(0.0, 20.0) };
        let [[ox, oy, oz], [px, py, pz]] = [(); 2].map(|()| random.point(whole));
        let [[dx, dy, dz], mut normal] = [(); 2].map(|()| random.unit(whole));
        let mut cosines = [-1.0; 2];
        match random.below(3) {
            0 => normal = [0.0; 3],
            1 => cosines = [random.between(0.0, 1.0), 1.0],
            _ => {}
        }
        let [nx, ny, nz] = normal;
        let [a, s] = [(); 2].map(|()| [(); 4].map(|()| random.between(0.0, 1.0)));
        let g = random.between(-1.0, 1.0);
        push(&mut columns.rays, [ox, oy, oz, dx, dy, dz, t_min, t_max]);
        push(&mut columns.lights, [px, py, pz, nx, ny, nz, cosines[0], cosines[1]]);
        push(&mut columns.fog, [a[0], a[1], a[2], a[3], s[0], s[1], s[2], s[3], g]);
    }
    columns
}

/// Puts a value where it goes.
fn patch(columns: &mut Columns, &[column, ray, bits @ ..]: Patch<'_>) {
    let Columns { rays, lights, fog, u, t } = columns;
    let mut columns: Vec<&mut Vec<f32>> = rays.iter_mut().chain(lights).chain(fog).chain([u, t]).collect();
    let count = columns.len();
    let column = &mut columns[usize::from(column) % count];
    if let Some(place) = usize::from(ray).checked_rem(column.len()) {
        column[place] = f32::from_le_bytes(bits);
    }
}
