//! The errors of the f32 kernels against the f64 oracle, for one sampler on one family.

use crate::families::{CHANNELS, Case, Columns, Family};
use airlight::oracle::{Coloured, Scene};
use airlight::{Emitter, Ray, Sampler, Samples, Strategy};
use glam::Vec3;
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;
use std::ops::Deref;

/// Rays that are sampled in one call.
const BATCH: usize = 1 << 14;
/// Weights and floors are measured once in this many rays, as they need the oracle's inverse many times.
const WEIGHED: usize = 16;
/// What counts as vanishing: a density below this share of its mean over the interval, `1/(t_b - t_a)`, and an N below
/// this value. There errors are in ulp of that share, or of the integrand with this N; those of a weight count by the
/// density over that share.
const VANISHING: f64 = 1e-3;
/// The change of `u` that the errors of `r` and of the weight allow for: what the CDF is promised to.
const VARIATE: f64 = 1.0 / (1 << 20) as f64;
/// The least share of the mass that the point-normal density leaves between an end, where it may vanish, and a sample.
const OFF_THE_MASS: f64 = 1e-12;
/// Geometry in f64 may move a point by this share of the distances in it.
const GEOMETRY: f64 = 8.0 * f64::EPSILON;
/// By this share the ends of the lit interval, which are kept as two f32, may be off.
const ENDS: f64 = 1.0 / (1u64 << 44) as f64;
/// The least `h`, of the distance to the emitter, that f64 geometry leaves all digits of f32.
const NEAREST: f64 = 1e-7;
/// The `h` of an emitter that is the ray's origin, rounded to f32: the kernels have 5e-8 more \[m\].
const LEAST_H: f64 = 1.000_001e-18;
/// The least falloff of a spot that f32 can tell from none.
const LEAST_FALLOFF: f64 = 1e-25;
/// The change of the CDF by half an ulp of `t` up to which `t` resolves it.
const RESOLVED: f64 = 1.0 / (1 << 18) as f64;
/// What is left of `u` at either end.
const OFF_THE_ENDS: f64 = f64::EPSILON / 2.0;
/// Optical depth up to which the integrand and the weight are compared.
const DEPTH: f64 = 30.0;
/// Values below this are too near to the end of f32's range to be compared.
const TINY: f64 = 1e-30;
/// The smallest radiance that f32 has with all digits, and a little room.
const LEAST_RADIANCE: f64 = 1e-37;

/// Kinds of errors that are listed.
const KINDS: usize = 13;

/// The errors of one strategy on one family; the lists ascend.
#[derive(Clone, Debug, Default)]
pub struct Errors {
    /// Rays in all.
    pub rays: usize,
    /// Rays with a sample.
    pub sampled: usize,
    /// `|CDF(t) - u|`.
    pub cdf: Vec<f64>,
    /// The same where `t` resolves it: half an ulp of `t` changes the CDF by 2^-18 at most.
    pub cdf_resolved: Vec<f64>,
    /// `cdf` of exact arithmetic that is rounded to f32 once, on every 16th ray.
    pub cdf_floor: Vec<f64>,
    /// How far `u` is from the CDFs of all distances that round to `t`: what `cdf` has beyond one rounding.
    pub cdf_beyond_t: Vec<f64>,
    /// `Sampler::cdf` at the returned `t` against the CDF there.
    pub cdf_at_t: Vec<f64>,
    /// The distance from the nearer end of the interval against that of the exact inverse, in ulp of it and beyond one
    /// rounding of `t`; of the densities with a closed form over the angle.
    pub offset: Vec<f64>,
    /// `offset` of exact arithmetic on geometry that is rounded to f32 once, on every 16th ray; `h` as for
    /// `integrand`.
    pub offset_floor: Vec<f64>,
    /// The pdf at the returned `t`, in ulp.
    pub pdf: Vec<f64>,
    /// `pdf` of exact arithmetic on geometry that is rounded to f32 once, on the same rays.
    pub pdf_floor: Vec<f64>,
    /// The distance `r` against those of all that rounds to `t`, or against those of the variates within 2^-20 of `u`,
    /// in ulp.
    pub r: Vec<f64>,
    /// The integrand at the returned `t`, in ulp, where `h` is at least 1e-7 of the distance to the emitter.
    pub integrand: Vec<f64>,
    /// The same where it is less.
    pub integrand_near: Vec<f64>,
    /// The weight against that of the exact inverse, relative, beyond what 2^-20 of `u` change it; or against that of
    /// the returned `t`.
    pub weight: Vec<f64>,
    /// Rays for which something is NaN or infinite.
    pub nonfinite: usize,
    /// Rays with a distance outside `[t_min, t_max]`, or something negative.
    pub out_of_range: usize,
    /// Rays sampled although nothing is lit, or not sampled although something is.
    pub misjudged: usize,
    /// The most light of one of these, relative to that of an emitter that faces the ray squarely.
    pub misjudged_light: f64,
    /// Rays that fell back to bisection.
    pub bisected: usize,
    /// The case of the largest error of each list, in their order.
    pub worst: [Option<(f64, Case)>; KINDS],
}

impl Errors {
    /// Measures `rays` cases of a family; `step` is told how many more are done.
    #[must_use]
    pub fn measure(sampler: &Sampler, family: Family, rays: usize, seed: u64, step: impl Fn(usize)) -> Self {
        let mut errors = Self::default();
        for first in (0..rays).step_by(BATCH) {
            let count = BATCH.min(rays - first);
            let cases: Vec<Case> =
                (first..first + count).into_par_iter().map(|i| family.case(seed, i as u64)).collect();
            errors.add(sampler, &cases);
            step(count);
        }
        for list in errors.lists_mut() {
            list.par_sort_unstable_by(f64::total_cmp);
        }
        errors
    }

    /// The lists and their names, as in JSON.
    #[must_use]
    pub fn lists(&self) -> [(&'static str, &[f64]); KINDS] {
        [
            ("cdf", &self.cdf),
            ("cdf_resolved", &self.cdf_resolved),
            ("cdf_floor", &self.cdf_floor),
            ("cdf_beyond_t", &self.cdf_beyond_t),
            ("cdf_at_t", &self.cdf_at_t),
            ("offset", &self.offset),
            ("offset_floor", &self.offset_floor),
            ("pdf", &self.pdf),
            ("pdf_floor", &self.pdf_floor),
            ("r", &self.r),
            ("integrand", &self.integrand),
            ("integrand_near", &self.integrand_near),
            ("weight", &self.weight),
        ]
    }

    fn lists_mut(&mut self) -> [&mut Vec<f64>; KINDS] {
        let Self {
            cdf,
            cdf_resolved,
            cdf_floor,
            cdf_beyond_t,
            cdf_at_t,
            offset,
            offset_floor,
            pdf,
            pdf_floor,
            r,
            integrand,
            integrand_near,
            weight,
            ..
        } = self;
        [
            cdf,
            cdf_resolved,
            cdf_floor,
            cdf_beyond_t,
            cdf_at_t,
            offset,
            offset_floor,
            pdf,
            pdf_floor,
            r,
            integrand,
            integrand_near,
            weight,
        ]
    }

    fn add(&mut self, sampler: &Sampler, cases: &[Case]) {
        let outcomes = Outcomes::new(sampler, cases);
        self.bisected += outcomes.bisected;
        let rows: Vec<Row> = cases
            .par_iter()
            .enumerate()
            .map(|(i, case)| Row::new(sampler.strategy(), case, &outcomes.get(i), i % WEIGHED == 0))
            .collect();
        for (row, case) in rows.iter().zip(cases) {
            self.rays += 1;
            self.sampled += usize::from(row.sampled);
            self.nonfinite += usize::from(row.nonfinite);
            self.out_of_range += usize::from(row.out_of_range);
            self.misjudged += usize::from(row.misjudged.is_some());
            self.misjudged_light = self.misjudged_light.max(row.misjudged.unwrap_or(0.0));
            // An error that is no number is as bad as can be.
            let errors = row.errors.map(|error| error.map(|error| if error.is_nan() { f64::INFINITY } else { error }));
            for (list, error) in self.lists_mut().into_iter().zip(errors) {
                list.extend(error);
            }
            for (worst, error) in self.worst.iter_mut().zip(errors) {
                if let Some(error) = error
                    && worst.is_none_or(|(so_far, _)| error > so_far)
                {
                    *worst = Some((error, *case));
                }
            }
        }
    }
}

/// What the kernels made of some cases.
struct Outcomes {
    t: Vec<f32>,
    pdf: Vec<f32>,
    weight: Vec<f32>,
    r: Vec<f32>,
    /// `Sampler::pdf`, `Sampler::cdf` and `Sampler::evaluate` at `t`.
    pdf_at_t: Vec<f32>,
    cdf_at_t: Vec<f32>,
    integrand: Vec<f32>,
    bisected: usize,
}

/// And of one.
struct Outcome {
    t: f32,
    pdf: f32,
    weight: f32,
    r: f32,
    pdf_at_t: f32,
    cdf_at_t: f32,
    integrand: f32,
}

impl Outcomes {
    fn new(sampler: &Sampler, cases: &[Case]) -> Self {
        const EQUAL: &str = "all columns have one length";
        let columns = Columns::new(cases);
        let (rays, emitters, coloured) = (columns.rays(), columns.emitters(), columns.coloured_media());
        let media = coloured.unwrap_or(columns.media());
        let column = || vec![f32::NAN; cases.len()];
        let [mut t, mut pdf, mut r, mut pdf_at_t, mut cdf_at_t] = [(); 5].map(|()| column());
        let [mut weights, mut integrands] = [(); 2].map(|()| [(); CHANNELS].map(|()| column()));
        let samples = Samples::new(&mut t, &mut pdf).r(&mut r);
        let mut samples = match coloured {
            Some(_) => samples.weights(weights.each_mut().map(Vec::as_mut_slice)),
            None => samples.weight(&mut weights[0]),
        };
        let counts = sampler.sample(&rays, &emitters, &media, &columns.u, &mut samples).expect(EQUAL);
        sampler.pdf(&rays, &emitters, &media, &t, &mut pdf_at_t).expect(EQUAL);
        sampler.cdf(&rays, &emitters, &media, &t, &mut cdf_at_t).expect(EQUAL);
        let evaluated = match coloured {
            Some(_) => {
                let integrands = integrands.each_mut().map(Vec::as_mut_slice);
                sampler.evaluate_coloured(&rays, &emitters, &media, &t, integrands)
            }
            None => sampler.evaluate(&rays, &emitters, &media, &t, &mut integrands[0]),
        };
        evaluated.expect(EQUAL);
        let of_case = |columns: [Vec<f32>; CHANNELS]| {
            cases.iter().enumerate().map(|(i, case)| columns[case.channel()][i]).collect()
        };
        let (weight, integrand) = (of_case(weights), of_case(integrands));
        Self { t, pdf, weight, r, pdf_at_t, cdf_at_t, integrand, bisected: counts.bisected }
    }

    fn get(&self, i: usize) -> Outcome {
        Outcome {
            t: self.t[i],
            pdf: self.pdf[i],
            weight: self.weight[i],
            r: self.r[i],
            pdf_at_t: self.pdf_at_t[i],
            cdf_at_t: self.cdf_at_t[i],
            integrand: self.integrand[i],
        }
    }
}

/// The errors of one ray.
struct Row {
    sampled: bool,
    nonfinite: bool,
    out_of_range: bool,
    /// The light of a ray that is judged wrongly.
    misjudged: Option<f64>,
    /// In the order of the lists of [`Errors`].
    errors: [Option<f64>; KINDS],
}

impl Row {
    fn new(strategy: Strategy, case: &Case, outcome: &Outcome, weigh: bool) -> Self {
        let Outcome { t, pdf, weight, r, pdf_at_t, cdf_at_t, integrand } = *outcome;
        let all = [t, pdf, weight, r, pdf_at_t, cdf_at_t, integrand];
        let parts = case.parts().ok().filter(|_| (0.0..=1.0).contains(&case.u));
        let scene = parts.as_ref().and_then(|_| Truth::new(case));
        let lit = scene.as_ref().and_then(|scene| scene.lit());
        let sampled = pdf > 0.0;
        let grazes = match (&scene, &parts) {
            (Some(scene), Some((ray, emitter, _))) => grazes_a_cone(scene, ray, emitter),
            _ => false,
        };
        let judged = sampled == lit.is_some()
            || scene.as_ref().is_some_and(|scene| beyond_f32(scene))
            || grazes
            || case.is_extreme();
        let mut row = Self {
            sampled,
            nonfinite: all.iter().any(|x| !x.is_finite()),
            out_of_range: all.iter().any(|&x| x < 0.0),
            misjudged: (!judged).then(|| scene.as_ref().map_or(1.0, |scene| relative_light(scene))),
            errors: [None; KINDS],
        };
        let (Some(scene), Some((ray, emitter, _)), Some(_), true, false) =
            (scene, parts, lit, sampled, case.is_extreme())
        else {
            return row;
        };
        // A product density sees no light to follow, and does without it.
        if most_falloff(&scene, strategy) < LEAST_FALLOFF {
            return row;
        }
        let (t_min, t_max) = scene.interval();
        row.out_of_range |= !(t_min..=t_max).contains(&f64::from(t));
        let u = f64::from(case.u);
        let cdf = (scene.cdf(strategy, t.into()) - u).abs();
        let rounding = Rounding::new(&scene, sharpest_edge(&scene, &ray, &emitter), t);
        let cdfs = rounding.ends.map(|t| scene.cdf(strategy, t));
        let off = rounding.moved * (ENDS / GEOMETRY);
        let moved = [f64::from(t) - off, f64::from(t) + off];
        // A plane where N = 0 is known much better: what is close to it counts little.
        let edge = if emitter.cone().is_some() { rounding.moved } else { 0.0 };
        let integrand = integrand_error(&scene, t.into(), edge, integrand.into());
        let near = scene.h() < NEAREST * rounding.scale || scene.h() <= LEAST_H;
        row.errors = [
            Some(cdf),
            (cdfs[1] - cdfs[0] <= 2.0 * RESOLVED).then_some(cdf),
            weigh.then(|| cdf_floor(&scene, strategy, u)),
            Some(beyond(cdfs, u)),
            Some(beyond(moved.map(|t| scene.cdf(strategy, t)), cdf_at_t.into())),
            offset_error(&scene, strategy, rounding.ends, u),
            (weigh && !near).then(|| offset_floor(&scene, strategy, rounding.moved, u)).flatten(),
            pdf_error(&scene, strategy, t.into(), edge, pdf_at_t.into()),
            (weigh && !near).then(|| pdf_floor(&scene, strategy, t.into())).flatten(),
            Some(r_error(&scene, strategy, &rounding, u, r.into())),
            integrand.filter(|_| !near),
            integrand.filter(|_| near),
            weigh.then(|| weight_error(&scene, strategy, &rounding, u, weight.into())).flatten(),
        ];
        row
    }
}

/// What a ray is held against: the channel under test, with the density that it shares with the others.
struct Truth {
    channel: Scene,
    all: Coloured,
}

impl Truth {
    fn new(case: &Case) -> Option<Self> {
        let all = case.coloured().ok()?;
        Some(Self { channel: all.channels()[case.channel()], all })
    }

    fn cdf(&self, strategy: Strategy, t: f64) -> f64 {
        self.all.cdf(strategy, t)
    }

    fn pdf(&self, strategy: Strategy, t: f64) -> f64 {
        self.all.pdf(strategy, t)
    }

    fn draw(&self, strategy: Strategy, u: f64) -> f64 {
        self.all.draw(strategy, u)
    }
}

/// All but the density is that of the channel.
impl Deref for Truth {
    type Target = Scene;

    fn deref(&self) -> &Scene {
        &self.channel
    }
}

/// All that rounds to a `t`.
struct Rounding {
    /// Its ends, and a little more for the rounding of the geometry to f64.
    ends: [f64; 2],
    /// How much more.
    moved: f64,
    /// The largest distance that the point has from something.
    scale: f64,
}

impl Rounding {
    /// `sine` is that of the least angle at which the ray meets an end of the light.
    fn new(scene: &Scene, sine: f64, t: f32) -> Self {
        let scale = f64::from(t).max(scene.r(t.into())).max(scene.t_h().abs());
        let moved = GEOMETRY * scale / sine;
        let [low, high] = [t.next_down(), t.next_up()].map(|next| 0.5 * (f64::from(t) + f64::from(next)));
        Self { ends: [low - moved, high + moved], moved, scale }
    }
}

/// The sine of the least angle at which the ray enters or leaves the light, 1 if it does neither: with the plane where `N = 0`
/// it is `beta`, with the cone of a spot `(c t'/r - beta)/sin phi`.
fn sharpest_edge(scene: &Scene, ray: &Ray, emitter: &Emitter) -> f64 {
    let (interval, Some(lit)) = (scene.interval(), scene.lit()) else { return 1.0 };
    let Some(cone) = emitter.cone() else { return if lit == interval { 1.0 } else { scene.beta().abs() } };
    let ([_, beta], c) = (axis_cosines(scene, ray, emitter, cone.axis()), f64::from(cone.cos_outer()));
    let sine = |t: f64| (c * ((t - scene.t_h()) / scene.r(t)) - beta).abs() / (1.0 - c * c).max(1e-18).sqrt();
    let at = |end: f64, clipped: bool| if clipped { sine(end).min(1.0) } else { 1.0 };
    at(lit.0, lit.0 > interval.0).min(at(lit.1, lit.1 < interval.1))
}

/// Whether the ray runs so exactly across the axis of a spot that no direction of it has a cosine which f32 can square, or
/// what is lit of it is a rounding in f64.
#[must_use]
pub fn grazes_a_cone(scene: &Scene, ray: &Ray, emitter: &Emitter) -> bool {
    emitter.cone().is_some_and(|cone| {
        let across = axis_cosines(scene, ray, emitter, cone.axis()).into_iter().all(|x| x.abs() < 1e-18);
        let sine = sharpest_edge(scene, ray, emitter);
        across || scene.lit().is_some_and(|(a, b)| b - a <= GEOMETRY * a.max(scene.r(a)).max(scene.t_h().abs()) / sine)
    })
}

/// `alpha` and `beta` of an axis.
fn axis_cosines(scene: &Scene, ray: &Ray, emitter: &Emitter, axis: [f32; 3]) -> [f64; 2] {
    let [o, d, y, a] = [ray.origin(), ray.direction(), emitter.position(), axis].map(|v| Vec3::from(v).as_dvec3());
    let (a, d) = (a.normalize(), d.normalize());
    [a.dot(o - y + scene.t_h() * d) / scene.h(), a.dot(d)]
}

/// The error of the exact inverse, rounded.
fn cdf_floor(scene: &Truth, strategy: Strategy, u: f64) -> f64 {
    let t = scene.draw(strategy, u) as f32;
    (scene.cdf(strategy, t.into()) - u).abs()
}

/// The scene with what geometry in f64 hands on, rounded to f32: `h`, and the least `t'` of both ends and the point at `t`.
fn rounded(scene: &Scene, t: f64) -> Scene {
    let (t_a, t_b) = scene.lit().unwrap_or(scene.interval());
    let t_prime = |t: f64| t - scene.t_h();
    let nearest = [t_a, t_b, t].into_iter().fold(t, |a, b| if t_prime(a).abs() < t_prime(b).abs() { a } else { b });
    scene.with_foot((scene.h() as f32).into(), nearest - f64::from(t_prime(nearest) as f32))
}

fn offset_floor(scene: &Truth, strategy: Strategy, moved: f64, u: f64) -> Option<f64> {
    let t = rounded(scene, scene.draw(strategy, u)).draw(strategy, u);
    offset_error(scene, strategy, [t - moved, t + moved], u)
}

/// None of a coloured medium.
fn pdf_floor(scene: &Truth, strategy: Strategy, t: f64) -> Option<f64> {
    let [_] = scene.all.channels() else { return None };
    pdf_error(scene, strategy, t, 0.0, rounded(scene, t).pdf(strategy, t))
}

/// `ends` are those of what may be meant by the distance that is compared.
fn offset_error(scene: &Truth, strategy: Strategy, ends: [f64; 2], u: f64) -> Option<f64> {
    let comparable = match strategy {
        Strategy::EquiAngular => true,
        Strategy::PointNormal => (OFF_THE_MASS..=1.0 - OFF_THE_MASS).contains(&u),
        _ => false,
    };
    let (t_a, t_b) = scene.lit().filter(|_| comparable)?;
    let exact = scene.draw(strategy, u);
    let offset = (exact - t_a).min(t_b - exact);
    Some(beyond(ends, exact) / ulp(offset))
}

/// The edges of a cone may be moved by `edge`.
fn pdf_error(scene: &Truth, strategy: Strategy, t: f64, edge: f64, pdf: f64) -> Option<f64> {
    let (t_a, t_b) = support(scene, strategy)?;
    let exact = scene.pdf(strategy, t);
    let size = exact.max(VANISHING / (t_b - t_a));
    let around = [(t - edge).max(t_a), (t + edge).min(t_b)].map(|t| scene.pdf(strategy, t));
    let may_be_outside = edge > 0.0 && (t - edge < t_a || t_b < t + edge);
    let low = if may_be_outside { 0.0 } else { around[0].min(around[1]) };
    // Outside for rounding alone.
    (t_a..=t_b).contains(&t).then(|| beyond([low.min(exact), around[0].max(around[1]).max(exact)], pdf) / ulp(size))
}

/// The distances that are sampled.
fn support(scene: &Scene, strategy: Strategy) -> Option<(f64, f64)> {
    if strategy == Strategy::Transmittance { Some(scene.interval()) } else { scene.lit() }
}

/// As for the weight: where `t` cannot tell, `r` is that of a variate near `u`.
fn r_error(scene: &Truth, strategy: Strategy, rounding: &Rounding, u: f64, r: f64) -> f64 {
    let outside = |ends: [f64; 2]| {
        let [low, high] = ends.map(|t| t - scene.t_h());
        // The middle one of these and 0 is the nearest.
        let nearest = low.max(0.0).max(-high);
        beyond([nearest, low.abs().max(high.abs())].map(|t_prime| scene.h().hypot(t_prime)), r) / ulp(r)
    };
    let of_t = outside(rounding.ends);
    // The inverse is dear, and few need it.
    if of_t <= 4.0 {
        return of_t;
    }
    outside([u - VARIATE, u + VARIATE].map(|u| scene.draw(strategy, u))).min(of_t)
}

/// As for the pdf.
fn integrand_error(scene: &Scene, t: f64, edge: f64, integrand: f64) -> Option<f64> {
    let exact = scene.integrand(t);
    let size = exact * (VANISHING / (scene.cosine(t) * scene.falloff(t))).max(1.0);
    let comparable = depth(scene, t) < DEPTH && exact > TINY && size < 1.0 / TINY;
    let [low, high] = [t - edge, t + edge].map(|t| scene.falloff(t));
    let exact_at = |falloff: f64| exact * (falloff / scene.falloff(t));
    let ends = [exact_at(low.min(high)).min(exact), exact_at(low.max(high)).max(exact)];
    comparable.then(|| beyond(ends, integrand) / ulp(size))
}

/// As for `r`: the weight is that of what rounds to `t`, or of a variate near `u`.
fn weight_error(scene: &Truth, strategy: Strategy, rounding: &Rounding, u: f64, weight: f64) -> Option<f64> {
    let at = |t: f64| scene.integrand(t) / scene.pdf(strategy, t);
    // At an end where the density vanishes the weight is a limit, and no number.
    let inverse = |u: f64| scene.draw(strategy, u.clamp(OFF_THE_ENDS, 1.0 - OFF_THE_ENDS));
    let t = inverse(u);
    let exact = at(t);
    let comparable = depth(scene, t) < DEPTH && exact > TINY && scene.cosine(t) * scene.falloff(t) > VANISHING;
    let outside = |ends: [f64; 2]| {
        let [low, high] = ends.map(at);
        beyond([exact.min(low).min(high), exact.max(low).max(high)], weight)
    };
    let of_u = outside([u - VARIATE, u + VARIATE].map(inverse));
    // A quotient by the pdf, so that what vanishing does to the one it does to the other.
    let (t_a, t_b) = support(scene, strategy)?;
    let share = (scene.pdf(strategy, t) * (t_b - t_a) / VANISHING).min(1.0);
    comparable.then(|| share * outside(rounding.ends).min(of_u) / exact.max(weight))
}

fn depth(scene: &Scene, t: f64) -> f64 {
    scene.mu_t() * (t - scene.interval().0 + scene.r(t))
}

/// How far `x` is outside an interval; not a number where one of them is none.
fn beyond([low, high]: [f64; 2], x: f64) -> f64 {
    if low <= x && x <= high { 0.0 } else { if x < low { low - x } else { x - high } }
}

/// Whether f32 has all digits of the radiance, and of the transmittance to the start of the lit part, which the integral has
/// as a factor.
#[must_use]
pub fn is_comparable(scene: &Scene, radiance: f64) -> bool {
    let start = scene.lit().map_or(0.0, |(t_a, _)| scene.transmittance(t_a));
    radiance > LEAST_RADIANCE && start > TINY && !beyond_f32(scene)
}

/// Whether the lit interval is so short that it may as well count as empty, as [`airlight::Counts::empty`] says.
#[must_use]
pub fn beyond_f32(scene: &Scene) -> bool {
    scene.lit().is_none_or(|(a, b)| {
        let angle = scene.angle(a, b);
        let light = most_light(scene, a, b);
        b - a < 1.01e-18 || angle < 1.01e-30 || b - a < 1.01e-36 * scene.r(a) * scene.r(b) || light < 1.01e-25
    })
}

/// The integral of N, or of the falloff of a spot, over the angle from `a` to `b`, at most; it is no less than a small share of this.
fn most_light(scene: &Scene, a: f64, b: f64) -> f64 {
    let angle = scene.angle(a, b);
    // Beyond a right angle what is bright may lie between the ends.
    let bright = if angle > FRAC_PI_2 { scene.alpha().hypot(scene.beta()) } else { 0.0 };
    angle * (scene.cosine(a) + scene.cosine(b)).max(bright) * most_falloff(scene, Strategy::EquiAngular)
}

/// The largest falloff of a spot in seven places where a strategy samples; 1 of other emitters.
fn most_falloff(scene: &Scene, strategy: Strategy) -> f64 {
    let within = |k: u32| scene.falloff(scene.draw(strategy, f64::from(k) / 8.0));
    (1..8).map(within).fold(0.0, f64::max)
}

/// The light of a ray over that from an emitter which faces all of it squarely (N = 1), at most; 1 where that is more.
/// Of a dark ray, by how much N falls short of 0.
fn relative_light(scene: &Scene) -> f64 {
    let (t_min, t_max) = scene.interval();
    let signed_cosine = |t: f64| (scene.alpha() * scene.h() + scene.beta() * (t - scene.t_h())) / scene.r(t);
    let light = match scene.lit() {
        Some((a, b)) => most_light(scene, a, b) / scene.angle(t_min, t_max),
        // Dark by the normal: without one every interval that is not empty is lit.
        None if t_min < t_max => -signed_cosine(t_min).max(signed_cosine(t_max)),
        None => 1.0,
    };
    if light < 1.0 { light } else { 1.0 }
}

/// The distance from `x > 0` to the next larger f32.
fn ulp(x: f64) -> f64 {
    let x = (x as f32).max(f32::MIN_POSITIVE);
    f64::from(x.next_up()) - f64::from(x)
}

/// The value that a share `p` of an ascending list does not exceed; NaN for an empty one.
#[must_use]
pub fn quantile(ascending: &[f64], p: f64) -> f64 {
    let last = ascending.len().saturating_sub(1);
    ascending.get((p * last as f64).ceil() as usize).copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::Medium;

    /// The light of a ray along x up to `t_max`, of an emitter beside its middle.
    fn light(t_max: f32, normal: Vec3) -> f64 {
        let ray = Ray::new(Vec3::ZERO, Vec3::X, 0.0, t_max).unwrap();
        let emitter = Emitter::point_normal(Vec3::new(0.5, 1.0, 0.0), normal).unwrap();
        relative_light(&Scene::new(&ray, &emitter, &Medium::new(0.1, 0.1, 0.0).unwrap()))
    }

    #[test]
    fn the_light_of_a_ray_is_told_relative_to_an_emitter_that_faces_it_squarely() {
        assert_eq!(light(1.0, Vec3::NEG_Y), 1.0);
        // N is 1e-6 h/r, and the bound at most twice its mean.
        let grazing = light(1.0, Vec3::new(0.0, -1e-6, 1.0));
        assert!((0.89e-6..=2e-6).contains(&grazing), "{grazing:e}");
        // Lit in the last tenth alone, 0.083 of an angle of 0.93, with N up to 8.9e-4.
        let sliver = light(1.0, Vec3::new(1e-2, 4e-3, 1.0));
        assert!((7e-5..9e-5).contains(&sliver), "{sliver:e}");
    }

    #[test]
    fn of_a_dark_ray_it_is_what_it_falls_short_of_light() {
        let below = light(1.0, Vec3::new(0.0, 1e-6, 1.0));
        assert!((0.89e-6..0.9e-6).contains(&below), "{below:e}");
        assert!(light(1.0, Vec3::Y) > 0.8);
        // Nothing of a ray without length can be lit.
        assert_eq!(light(0.0, Vec3::NEG_Y), 1.0);
    }
}
