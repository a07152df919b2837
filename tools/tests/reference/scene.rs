//! The geometry, the integrand and the radiance.

use super::number::{Big, abs, big, dot, exp, pi};
use super::quadrature::{gauss_legendre, rule};
use airlight::FARTHEST;
use airlight_tools::families::{Case, Columns};
use std::array::from_fn;
use std::sync::LazyLock;

#[derive(Clone)]
pub(crate) struct Scene {
    pub(super) t_min: Big,
    pub(super) t_max: Big,
    pub(crate) h: Big,
    pub(crate) t_h: Big,
    /// `alpha h` and `beta`.
    pub(super) normal: Option<[Big; 2]>,
    mu_s: Big,
    pub(super) mu_t: Big,
    pub(super) g: Big,
}

impl Scene {
    /// Of a valid case.
    pub(crate) fn new(case: &Case) -> Self {
        let columns = Columns::new(&[*case]);
        let rays = columns.rays();
        let (position, normal, [mu_a, mu_s, g]) = (columns.position(), columns.normal(), columns.medium());
        let vector = |columns: [&[f32]; 3]| columns.map(|column| big(column[0].into()));
        let (d, x, y) = (vector(rays.direction), vector(rays.origin), vector(position));
        let w: [Big; 3] = from_fn(|k| &x[k] - &y[k]);
        let length = dot(&d, &d).sqrt();
        let d = d.map(|c| c / &length);
        let t_h = -dot(&w, &d);
        let foot: [Big; 3] = from_fn(|k| &w[k] + &t_h * &d[k]);
        let t_min = big(rays.t_min[0].into());
        let farthest = abs(t_h.clone()).max(abs(&t_min - &t_h));
        let h = dot(&foot, &foot).sqrt().max(big(1e-18)).max(big(1e-9) * farthest);
        let n = vector(normal);
        let normal = normal.iter().any(|n| n[0] != 0.0).then(|| [dot(&n, &foot), dot(&n, &d)]);
        Self {
            t_min,
            t_max: big(rays.t_max[0].min(FARTHEST).into()),
            h,
            t_h,
            normal,
            mu_s: big(mu_s[0].into()),
            mu_t: big((mu_a[0] + mu_s[0]).into()),
            g: big(g[0].into()),
        }
    }

    /// The same with the emitter `delta` further along the ray.
    pub(crate) fn with_emitter_moved(&self, delta: &Big) -> Self {
        Self { t_h: &self.t_h + delta, ..self.clone() }
    }

    /// The same with `N = 0` a `delta` further along the ray.
    pub(crate) fn with_horizon_moved(&self, delta: &Big) -> Self {
        let normal = self.normal.clone().map(|[alpha_h, beta]| [alpha_h - &beta * delta, beta]);
        Self { normal, ..self.clone() }
    }

    /// Where `N > 0`.
    pub(crate) fn lit(&self) -> Option<[Big; 2]> {
        let (mut t_a, mut t_b) = (self.t_min.clone(), self.t_max.clone());
        if let Some([alpha_h, beta]) = &self.normal {
            let zero = big(0.0);
            if *beta == zero && *alpha_h <= zero {
                return None;
            } else if *beta > zero {
                t_a = t_a.max(&self.t_h - alpha_h / beta);
            } else if *beta < zero {
                t_b = t_b.min(&self.t_h - alpha_h / beta);
            }
        }
        (t_a < t_b).then_some([t_a, t_b])
    }

    pub(super) fn r(&self, t: &Big) -> Big {
        let t_prime = t - &self.t_h;
        (&self.h * &self.h + &t_prime * &t_prime).sqrt()
    }

    /// `mu_s T rho N / r^2`
    pub(crate) fn integrand(&self, t: &Big) -> Big {
        let (r, t_prime) = (self.r(t), t - &self.t_h);
        let transmittance = exp(&(-&self.mu_t * (t - &self.t_min + &r)));
        let one = big(1.0);
        let s = &one + &self.g * &self.g + big(2.0) * &self.g * &t_prime / &r;
        let rho = (one - &self.g * &self.g) / (big(4.0) * pi() * &s * s.sqrt());
        let n = self.normal.as_ref().map_or(big(1.0), |[alpha_h, beta]| (alpha_h + beta * t_prime) / &r);
        &self.mu_s * transmittance * rho * n / (&r * &r)
    }

    /// The integral over `p = (t' + r)/h`, where `t = t_h + h (p - 1/p)/2` and `T` falls as `exp(-mu_t h p)`.
    ///
    /// All other singularities are on the imaginary axis: panels from `p` to at most `4 p` keep away from them.
    pub(crate) fn radiance(&self, [t_a, t_b]: &[Big; 2]) -> Big {
        static RULE: LazyLock<Vec<(Big, Big)>> = LazyLock::new(rule);
        let p = |t: &Big| (t - &self.t_h + self.r(t)) / &self.h;
        let m = &self.mu_t * &self.h;
        let (first, last) = (p(t_a), p(t_b));
        let (mut start, mut sum) = (first.clone(), big(0.0));
        // exp(-64) of the light is left out.
        while start < last && &m * (&start - &first) < big(64.0) {
            let mut end = last.clone().min(big(4.0) * &start);
            if m > big(0.0) {
                end = end.min(&start + big(8.0) / &m);
            }
            sum += gauss_legendre(&RULE, &start, &end, |p| {
                let inverse = big(1.0) / p;
                let t = &self.t_h + &self.h * (p - &inverse) / big(2.0);
                self.integrand(&t) * &self.h * (big(1.0) + &inverse * &inverse) / big(2.0)
            });
            start = end;
        }
        sum
    }
}
