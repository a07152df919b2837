//! Batches of hard rays, where something vanishes or is very large: emitters next to the ray, light that grazes it, cones as narrow
//! as cosines can be, peaks of the phase function, lengths and media of all powers of two. They are the same on every platform: no
//! elementary function makes them.

use crate::batch::{Columns, push};
use crate::room::Random;
use glam::Vec3;

/// So many rays, with so many variates each.
#[must_use]
pub fn columns(random: &mut Random, n: usize, per_ray: usize) -> Columns {
    let mut columns = Columns::default();
    for _ in 0..n {
        let axes = random.below(3) == 0;
        let metre = if random.below(4) == 0 { power(random, 55) } else { 1.0 };
        let origin = metre * if random.below(2) == 0 { Vec3::ZERO } else { 5.0 * Vec3::from(random.unit(axes)) };
        let unit = Vec3::from(random.unit(axes));
        let across = unit.cross(random.unit(axes).into()).normalize_or(unit.any_orthonormal_vector());
        let d = stretched(random, unit);

        let t_min = if random.below(2) == 0 { 0.0 } else { metre * random.between(0.0, 3.0) };
        let t_max = match random.below(8) {
            0 => f32::INFINITY,
            1 => random.pick(&[t_min, t_min.next_up(), t_min.next_down()]),
            _ => t_min + metre * 10.0 * small(random),
        };
        // Places along the ray, its ends and places beyond them included.
        let length = t_max.min(t_min + 100.0 * metre) - t_min;
        let place = |random: &mut Random| {
            let share = random.between(0.0, 1.0);
            t_min + length * random.pick(&[0.0, 1.0, 0.5, -0.5, 1.5, share, share, share])
        };
        let aside = if random.below(16) == 0 { 0.0 } else { metre * 5.0 * small(random) };
        let far = if random.below(8) == 0 { power(random, 56) } else { 1.0 };
        let position = origin + far * (place(random) * d + aside * across);

        let towards = (origin + place(random) * d - position).normalize_or(unit);
        let axis = match random.below(6) {
            0 => Vec3::ZERO,
            1 => Vec3::from(random.unit(axes)),
            2 => random.pick(&[1.0, -1.0]) * unit,
            // The emitter's plane meets the ray at that place, or is next to the ray.
            3 => random.pick(&[1.0, -1.0]) * (unit - towards.dot(unit) * towards).normalize_or(unit),
            4 => (random.pick(&[1.0, -1.0]) * across + small(random) * unit).normalize(),
            _ => (towards + small(random) * across).normalize(),
        };
        let has_cone = axis != Vec3::ZERO && random.below(2) == 0;
        let cosines = if has_cone { cone(random, [axis.dot(unit), axis.dot(towards)]) } else { [-1.0; 2] };
        let axis = stretched(random, axis);

        let thick = [power(random, 40), 5.0, 0.5, 0.1][random.below(4) as usize] / metre;
        let [a, s] = [(); 2].map(|()| [(); 4].map(|()| if random.below(8) == 0 { 0.0 } else { thick * small(random) }));
        let g = random.pick(&[1.0, -1.0]) * (1.0 - small(random));
        push(&mut columns.rays, [origin.x, origin.y, origin.z, d.x, d.y, d.z, t_min, t_max]);
        push(&mut columns.lights, [position.x, position.y, position.z, axis.x, axis.y, axis.z, cosines[0], cosines[1]]);
        push(&mut columns.fog, [a[0], a[1], a[2], a[3], s[0], s[1], s[2], s[3], g]);
        for _ in 0..per_ray {
            let u = random.between(0.0, 1.0);
            columns.u.push(random.pick(&[0.0, 1e-7, 1e-30, 1f32.next_down(), 1.0, u, u, u, u, u, u, u]));
            columns.t.push(place(random));
        }
    }
    columns
}

/// The vector, in half of all cases with a length that is not quite 1.
fn stretched(random: &mut Random, unit: Vec3) -> Vec3 {
    let excess = random.pick(&[1e-3, -1e-3, 1e-5, -1e-5, 0.0, 0.0, 0.0, 0.0]) * small(random);
    (1.0 + excess) * unit
}

/// A power of two, from `2^-most` to `2^most`.
fn power(random: &mut Random, most: u64) -> f32 {
    2f32.powi(random.below(2 * most + 1) as i32 - most as i32)
}

/// Between 0 and 1, in half of all cases far below 1.
fn small(random: &mut Random) -> f32 {
    let x = random.between(0.0, 1.0);
    if random.below(2) == 0 { x } else { x * 2f32.powi(-(random.below(80) as i32)) }
}

/// The cosines of a cone, given those of the angles between its axis and the ray, and a place of the ray: of a ray along its side, of
/// one that meets it there, of a narrow one, of a half space or of any; with an edge from hard to soft.
fn cone(random: &mut Random, of_ray: [f32; 2]) -> [f32; 2] {
    let [along, there] = of_ray.map(|cosine| cosine.abs().min(1.0));
    let any = random.between(0.0, 1.0);
    let narrow = 1.0 - small(random);
    let outer = random.pick(&[along, there, there, narrow, narrow, 0.0, any]);
    let soft = outer + (1.0 - outer) * small(random);
    [outer, random.pick(&[outer, soft, soft, 1.0])]
}
