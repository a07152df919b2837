//! The geometry of a block: passes that compute the lit intervals, the feet of the perpendiculars and the cosines, in f32 where that is
//! enough, and their records.

use super::AHEAD;
use crate::Precision;
use crate::batch::{ConeRows, EmitterRows, Inputs};
use crate::geometry::{
    Cone, Cosine, Extent, Foot, Geometry, Lit, Located, Refined, Rests, in_cone, in_f32, in_f64, refine,
};
use crate::simd::{Isa, Lanes, Records, Room, none};
use core::ops::Range;

/// The geometries of a block.
#[derive(Clone, Copy)]
pub(super) struct Geometries<'b, I: Isa> {
    lits: &'b [Lit<I>],
    rests: &'b [Rests<I>],
    cosines: &'b [Cosine<I>],
    feet: &'b [Foot<I>],
    refined: &'b [Refined<I>],
    alphas: &'b [I::V],
    valid: &'b [I::Mask],
    /// Empty if there are no spots.
    cones: &'b [Cone<I>],
}

impl<I: Isa> Geometries<'_, I> {
    /// The geometry of a record.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn get(&self, record: usize) -> Geometry<'_, I> {
        Geometry {
            lit: &self.lits[record],
            rests: &self.rests[record],
            cosine: &self.cosines[record],
            foot: &self.feet[record],
            refined: &self.refined[record],
            alpha_h: self.alphas[record],
            valid: self.valid[record],
            cone: self.cones.get(record),
        }
    }
}

impl<'b, I: Isa> Geometries<'b, I> {
    /// Those of some records.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn part(&self, range: Range<usize>) -> Self {
        Self {
            lits: &self.lits[range.clone()],
            rests: &self.rests[range.clone()],
            cosines: &self.cosines[range.clone()],
            feet: &self.feet[range.clone()],
            refined: &self.refined[range.clone()],
            alphas: &self.alphas[range.clone()],
            valid: &self.valid[range.clone()],
            cones: self.cones.get(range).unwrap_or_default(),
        }
    }
}

/// Storage for the records of a block's geometry.
pub(super) struct Places<I: Isa> {
    lits: Records<Lit<I>>,
    rests: Records<Rests<I>>,
    /// Whether lanes in f64 may have left rests that differ from 0.
    has_rests: bool,
    cosines: Records<Cosine<I>>,
    feet: Records<Foot<I>>,
    refined: Records<Refined<I>>,
    alphas: Records<I::V>,
    valid: Records<I::Mask>,
}

impl<I: Isa> Places<I> {
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn new() -> Self {
        Self {
            lits: Records::new(),
            rests: Records::new(),
            has_rests: false,
            cosines: Records::new(),
            feet: Records::new(),
            refined: Records::new(),
            alphas: Records::new(),
            valid: Records::new(),
        }
    }

    /// Replaces a record by `located`, the parts that are computed.
    #[cfg_attr(optimized, inline(always))]
    fn replace<const FOOT: bool, const COSINE: bool>(&mut self, record: usize, located: &Located<I>) {
        self.lits.written()[record] = located.lit;
        self.valid.written()[record] = located.valid;
        if FOOT {
            self.rests.written()[record] = located.rests;
            self.has_rests = true;
            self.feet.written()[record] = located.foot;
        }
        if COSINE {
            self.cosines.written()[record] = located.cosine;
            self.alphas.written()[record] = located.alpha_h;
        }
    }

    /// The records, with those of the cones of spots.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn geometries<'p>(&'p mut self, cones: &'p [Cone<I>]) -> Geometries<'p, I> {
        Geometries {
            lits: self.lits.written(),
            rests: self.rests.written(),
            cosines: self.cosines.written(),
            feet: self.feet.written(),
            refined: self.refined.written(),
            alphas: self.alphas.written(),
            valid: self.valid.written(),
            cones,
        }
    }
}

/// Sets the first `count` rests to 0.
fn clear_rests<I: Isa>(isa: I, count: usize, places: &mut Places<I>) {
    isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let none = Rests::none(isa);
            places.rests.fill(count, |_| none);
            places.has_rests = false;
        },
    );
}

/// Writes the first `most` records of what is not computed for `extent`, or not for every block.
pub(super) fn fill_placeholders<I: Isa>(isa: I, extent: Extent, most: usize, places: &mut Places<I>) {
    isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            if extent == Extent::Lit {
                let none = Foot::none(isa);
                places.feet.fill(most, |_| none);
            }
            let none = Refined::none(isa);
            places.refined.fill(most, |_| none);
            if extent < Extent::Cosine {
                let (none, zero) = (Cosine::none(isa), isa.splat(0.0));
                places.cosines.fill(most, |_| none);
                places.alphas.fill(most, |_| zero);
            }
        },
    );
    clear_rests(isa, most, places);
}

/// A pass, or several, over the lane groups of a block.
type Locate<I> = fn(I, &Inputs<'_>, EmitterRows<'_>, Range<usize>, &mut Places<I>);

/// What computes the geometry of emitters that are no spots; `each` if they differ from ray to ray.
pub(super) fn locate<I: Isa>(extent: Extent, precision: Precision, each: bool) -> Locate<I> {
    match (extent, precision) {
        // The f32 geometry needs the remainder of a product, which only a fused multiply-add gives.
        (Extent::Lit, _) if !I::FUSED => in_double::<I, false, false>,
        (Extent::Foot, _) if !I::FUSED => in_double::<I, true, false>,
        (Extent::Cosine | Extent::Path, _) if !I::FUSED => in_double::<I, true, true>,
        (Extent::Lit, _) if each => in_single::<I, true, false, false, true>,
        (Extent::Lit, _) => in_single::<I, true, false, false, false>,
        (Extent::Foot, Precision::Fast) if each => in_single::<I, false, true, false, true>,
        (Extent::Foot, Precision::Fast) => in_single::<I, false, true, false, false>,
        (Extent::Foot, Precision::Exact) if each => in_single::<I, true, true, false, true>,
        (Extent::Foot, Precision::Exact) => in_single::<I, true, true, false, false>,
        (Extent::Cosine | Extent::Path, Precision::Fast) if each => in_single::<I, false, true, true, true>,
        (Extent::Cosine | Extent::Path, Precision::Fast) => in_single::<I, false, true, true, false>,
        (Extent::Cosine | Extent::Path, Precision::Exact) if each => in_single::<I, true, true, true, true>,
        (Extent::Cosine | Extent::Path, Precision::Exact) => in_single::<I, true, true, true, false>,
    }
}

/// Computes the geometry of some groups in f32, and of their hard lanes in f64.
fn in_single<I: Isa, const EXACT: bool, const FOOT: bool, const COSINE: bool, const DIFFER: bool>(
    isa: I,
    inputs: &Inputs<'_>,
    emitters: EmitterRows<'_>,
    groups: Range<usize>,
    places: &mut Places<I>,
) {
    // Without `EXACT` lanes in f32 have no rests; those of the block before may have some.
    if FOOT && !EXACT && places.has_rests {
        clear_rests(isa, groups.len(), places);
    }
    // Whether all lanes are easy, and whether any is.
    let [every, any] = isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = inputs.ray_groups::<I>();
            let emitters = emitters.groups(isa);
            let mut emitter = emitters.emitters(isa, 0);
            let (mut lits, mut rests) = (places.lits.start(), places.rests.start());
            let (mut cosines, mut valid) = (places.cosines.start(), places.valid.start());
            let (mut every, mut any) = (!none(isa), none(isa));
            let (mut feet, mut alphas) = (places.feet.start(), places.alphas.start());
            for group in groups.clone() {
                if inputs.prefetch {
                    rays.prefetch(isa, group, AHEAD);
                }
                if DIFFER {
                    emitter = emitters.emitters(isa, group - groups.start);
                }
                let located = in_f32::<I, EXACT, FOOT, COSINE>(isa, &rays.lanes(isa, group), &emitter);
                (every, any) = (every & located.valid, any | located.valid);
                lits.push(located.lit);
                valid.push(located.valid);
                if FOOT && EXACT {
                    rests.push(located.rests);
                }
                if FOOT {
                    feet.push(located.foot);
                }
                if COSINE {
                    cosines.push(located.cosine);
                    alphas.push(located.alpha_h);
                }
            }
            lits.done();
            valid.done();
            if FOOT && EXACT {
                rests.done();
            }
            if FOOT {
                feet.done();
            }
            if COSINE {
                cosines.done();
                alphas.done();
            }
            [I::V::bits(!every) == 0, I::V::bits(any) != 0]
        },
    );
    if !any {
        return in_double::<I, FOOT, COSINE>(isa, inputs, emitters, groups, places);
    }
    if !every {
        rescue::<I, FOOT, COSINE>(isa, inputs, emitters, groups.start, places);
    }
}

/// Computes hard lanes, those that are not valid in f32, in f64.
#[cold]
fn rescue<I: Isa, const FOOT: bool, const COSINE: bool>(
    isa: I,
    inputs: &Inputs<'_>,
    emitters: EmitterRows<'_>,
    start: usize,
    places: &mut Places<I>,
) {
    isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = inputs.ray_groups::<I>();
            let emitters = emitters.groups(isa);
            let mut emitter = emitters.emitters(isa, 0);
            for record in 0..places.lits.written().len() {
                let hard = !places.valid.written()[record];
                if I::V::bits(hard) != 0 {
                    if emitters.differ() {
                        emitter = emitters.emitters(isa, record);
                    }
                    let exact = in_f64(isa, &rays.lanes(isa, start + record), &emitter);
                    let located = exact.or(hard, places.geometries(&[]).get(record));
                    places.replace::<FOOT, COSINE>(record, &located);
                }
            }
        },
    );
}

/// Computes the geometry of some groups in f64.
fn in_double<I: Isa, const FOOT: bool, const COSINE: bool>(
    isa: I,
    inputs: &Inputs<'_>,
    emitters: EmitterRows<'_>,
    groups: Range<usize>,
    places: &mut Places<I>,
) {
    isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = inputs.ray_groups::<I>();
            let emitters = emitters.groups(isa);
            let (mut emitter, start) = (emitters.emitters(isa, 0), groups.start);
            let (mut lits, mut rests, mut valid) = (places.lits.start(), places.rests.start(), places.valid.start());
            let (mut cosines, mut alphas) = (places.cosines.start(), places.alphas.start());
            let mut feet = places.feet.start();
            for group in groups {
                if inputs.prefetch {
                    rays.prefetch(isa, group, AHEAD);
                }
                if emitters.differ() {
                    emitter = emitters.emitters(isa, group - start);
                }
                let located = in_f64(isa, &rays.lanes(isa, group), &emitter);
                lits.push(located.lit);
                valid.push(located.valid);
                if FOOT {
                    rests.push(located.rests);
                    feet.push(located.foot);
                }
                if COSINE {
                    cosines.push(located.cosine);
                    alphas.push(located.alpha_h);
                }
            }
            lits.done();
            valid.done();
            if FOOT {
                rests.done();
                feet.done();
                places.has_rests = true;
            }
            if COSINE {
                cosines.done();
                alphas.done();
            }
        },
    );
}

/// Computes what the feet of a block lack for paths. It comes after hard lanes and spots, which change the feet.
pub(super) fn refine_feet<I: Isa>(
    isa: I,
    inputs: &Inputs<'_>,
    emitters: EmitterRows<'_>,
    start: usize,
    places: &mut Places<I>,
) {
    isa.vectorize::<Foot<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = inputs.ray_groups::<I>();
            let emitters = emitters.groups(isa);
            let mut emitter = emitters.emitters(isa, 0);
            let feet = places.feet.written();
            places.refined.fill(
                feet.len(),
                #[cfg_attr(optimized, inline(always))]
                |record| {
                    if emitters.differ() {
                        emitter = emitters.emitters(isa, record);
                    }
                    refine(isa, &rays.lanes(isa, start + record), &emitter, &feet[record])
                },
            );
        },
    );
}

/// The geometry of spots in f64, in place of what the lanes of spots have.
pub(super) fn in_cones<I: Isa>(
    isa: I,
    inputs: &Inputs<'_>,
    emitters: EmitterRows<'_>,
    cones: ConeRows<'_>,
    start: usize,
    places: &mut Places<I>,
    located_cones: &mut Records<Cone<I>>,
) {
    isa.vectorize::<Cone<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let rays = inputs.ray_groups::<I>();
            let (emitters, cones) = (emitters.groups(isa), cones.groups(isa));
            let mut located = located_cones.start();
            for record in 0..places.lits.written().len() {
                let ray = rays.lanes(isa, start + record);
                let (exact, cone) = in_cone(isa, &ray, &emitters.spots(isa, &cones, record));
                let exact = exact.or(cone.is_spot, places.geometries(&[]).get(record));
                places.replace::<true, true>(record, &exact);
                located.push(cone);
            }
            located.done();
        },
    );
}
