//! Small calls from bytes: a head says how many rays there are, of what form, what is asked, on which backends, and from which
//! seed the values of a middling room come; what follows are values of any bits, and where they go.

use crate::batch::{Batch, Columns, FORMS};
use crate::promises::{Again, Choices};
use crate::room::{self, Random};
use airlight::{Backend, Emitter, Integral, Nodes, Precision, Sampler, Strategy};

/// A call.
pub(crate) struct Input {
    pub(crate) batch: Batch,
    pub(crate) sampler: Sampler,
    pub(crate) integral: Integral,
    pub(crate) again: Again,
    weights: Random,
    table: Vec<Emitter>,
}

/// Bytes of the head.
pub const HEAD: usize = 16;
/// Numbers of variates for each ray.
const PER_RAY: [usize; 8] = [1, 1, 1, 1, 2, 3, 7, 33];
/// Rays times variates, and rays times emitters to choose from, at most.
const MOST: usize = 99;

/// A value of any bits: the column and the ray that it goes to. Columns are those of rays, lights and fog in the order of
/// [`Columns`], `u`, `t`; what is beyond the end counts from the start again.
pub type Patch = [u8; 6];

impl Input {
    /// What `data` describes; bytes of the head that it lacks are 0.
    pub(crate) fn new(data: &[u8]) -> Self {
        let (given, rest) = data.split_at(HEAD.min(data.len()));
        let mut head = [0; HEAD];
        head[..given.len()].copy_from_slice(given);
        let [rays, per_ray, form, strategy, precision, nodes, again, cut, seed @ ..] = head.map(usize::from);
        let mut random = Random::new(seed.iter().fold(0, |seed, byte| seed << 8 | *byte as u64));

        // Few rays, now and then more than any group of lanes has, once none.
        let n = match rays {
            0..224 => 1 + (rays + 7) % 8,
            224..255 => rays - 224 + 9,
            _ => 0,
        };
        let per_ray = PER_RAY[per_ray % 8];
        let per_ray = if n * per_ray > MOST { 1 } else { per_ray };
        let mut columns = room::columns(&mut random, n, per_ray);
        let (patches, _) = rest.as_chunks();
        patches.iter().for_each(|patch| self::patch(&mut columns, patch));

        let sampler = Sampler::new(Strategy::ALL[strategy % Strategy::ALL.len()]);
        let precision = Precision::ALL[precision % Precision::ALL.len()];
        let table = columns.emitters();
        let weights = random.clone();
        Self {
            sampler: sampler.with_precision(precision).unwrap_or(sampler),
            integral: Integral::new(Nodes::ALL[nodes % Nodes::ALL.len()]).with_precision(precision),
            again: self::again(again, cut.checked_rem(n).unwrap_or(0)),
            weights,
            table,
            batch: columns.batch(form % FORMS, |n| random.below(n)),
        }
    }

    /// The emitters of the batch, in one of eight calls again and again, and weights, none of every fourth. As each ray asks
    /// every emitter, many rays have few.
    pub(crate) fn choices(&self) -> Choices {
        let mut random = self.weights.clone();
        let most = MOST / self.batch.len().max(1);
        let many = (random.below(8) == 0).then(|| 1 + random.below(most as u64) as usize);
        let count = many.unwrap_or(self.table.len().min(most));
        let table: Vec<Emitter> = self.table.iter().copied().cycle().take(count).collect();
        let weights = table.iter().map(|_| if random.below(4) == 0 { 0.0 } else { random.between(0.0, 9.0) }).collect();
        Choices { table, weights }
    }
}

/// One backend and the batch in two parts, or two backends that have to give the same bits.
fn again(number: usize, cut: usize) -> Again {
    let nth = |number: usize, is_fused: bool| {
        let backends = || Backend::available().filter(move |backend| backend.is_fused() || !is_fused);
        backends().nth(number.checked_rem(backends().count())?)
    };
    let half = number / 2;
    match (number % 2, nth(half, true), nth(half + 1, true)) {
        (1, Some(on), Some(other)) => Again::Beside { on, other },
        _ => Again::Cut { on: nth(half, false).unwrap_or(Backend::detect()), cut },
    }
}

/// Puts a value where it goes.
fn patch(columns: &mut Columns, &[column, ray, bits @ ..]: &Patch) {
    let Columns { rays, lights, fog, u, t } = columns;
    let (column, count) = (usize::from(column), rays.len() + lights.len() + fog.len() + 2);
    let column = rays.iter_mut().chain(lights).chain(fog).chain([u, t]).nth(column % count).expect("below the count");
    if let Some(place) = usize::from(ray).checked_rem(column.len()) {
        column[place] = f32::from_le_bytes(bits);
    }
}
