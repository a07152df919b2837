//! Integrals of functions of one variable: Gauss and Legendre's rule, and the same rule on adaptively halved intervals.

/// The largest number of pieces of [`integrate`].
const MOST_PIECES: usize = 4096;

/// The positive nodes and their weights on \[-1, 1\] of the rule with 16 nodes; the negative ones mirror them.
const GAUSS_LEGENDRE: [(f64, f64); 8] = [
    (0.095_012_509_837_637_44, 0.189_450_610_455_068_5),
    (0.281_603_550_779_258_9, 0.182_603_415_044_923_58),
    (0.458_016_777_657_227_37, 0.169_156_519_395_002_54),
    (0.617_876_244_402_643_8, 0.149_595_988_816_576_74),
    (0.755_404_408_355_003, 0.124_628_971_255_533_88),
    (0.865_631_202_387_831_8, 0.095_158_511_682_492_79),
    (0.944_575_023_073_232_6, 0.062_253_523_938_647_894),
    (0.989_400_934_991_649_9, 0.027_152_459_411_754_096),
];

/// The integral of `f` from `a` to `b` by 16 evaluations, exact for polynomials up to degree 31.
pub fn gauss_legendre(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let sum: f64 = GAUSS_LEGENDRE.iter().map(|&(x, w)| w * (f(middle - half * x) + f(middle + half * x))).sum();
    half * sum
}

/// The integral of `f` over the finite interval from `a` to `b`.
///
/// The piece on which the rule and its two halves disagree most is halved until the sum of all disagreements is at most
/// `relative_tolerance` times the integral. The result is the sum of the halves, which is far more exact than that.
/// The rule can miss a feature much narrower than a sixteenth of the interval: give such an `f` in pieces to
/// [`integrate_pieces`].
pub fn integrate(f: impl Fn(f64) -> f64, a: f64, b: f64, relative_tolerance: f64) -> f64 {
    integrate_pieces(f, &[a, b], relative_tolerance)
}

/// As [`integrate`], from the first to the last of `ends`, starting with the pieces between neighbouring ends.
pub fn integrate_pieces(f: impl Fn(f64) -> f64, ends: &[f64], relative_tolerance: f64) -> f64 {
    let mut pieces: Vec<Piece> =
        ends.windows(2).map(|w| Piece::new(&f, w[0], w[1], gauss_legendre(&f, w[0], w[1]))).collect();
    loop {
        let integral: f64 = pieces.iter().map(Piece::integral).sum();
        let error: f64 = pieces.iter().map(Piece::error).sum();
        // Not `error > ...`: the loop must also end if the integral is NaN.
        let unsettled = error > relative_tolerance * integral.abs();
        if !unsettled || pieces.len() >= MOST_PIECES {
            return integral;
        }
        let worst = (0..pieces.len()).max_by(|&i, &j| pieces[i].error().total_cmp(&pieces[j].error())).unwrap_or(0);
        let Piece { a, b, halves: [left, right], .. } = pieces.swap_remove(worst);
        let middle = 0.5 * (a + b);
        pieces.push(Piece::new(&f, a, middle, left));
        pieces.push(Piece::new(&f, middle, b, right));
    }
}

/// A part of the interval, integrated as one and as two halves.
struct Piece {
    a: f64,
    b: f64,
    whole: f64,
    halves: [f64; 2],
}

impl Piece {
    fn new(f: impl Fn(f64) -> f64, a: f64, b: f64, whole: f64) -> Self {
        let middle = 0.5 * (a + b);
        Self { a, b, whole, halves: [gauss_legendre(&f, a, middle), gauss_legendre(&f, middle, b)] }
    }

    fn integral(&self) -> f64 {
        self.halves[0] + self.halves[1]
    }

    fn error(&self) -> f64 {
        (self.whole - self.integral()).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{LN_2, PI};

    fn assert_close(value: f64, expected: f64, relative: f64) {
        assert!((value - expected).abs() <= relative * expected.abs(), "{value} is not {expected} within {relative}");
    }

    #[test]
    fn the_rule_is_exact_up_to_degree_31_and_not_beyond() {
        for degree in 0..=31 {
            assert_close(gauss_legendre(|x| x.powi(degree), 0.0, 1.0), 1.0 / f64::from(degree + 1), 1e-15);
        }
        let error = gauss_legendre(|x| x.powi(32), -1.0, 1.0) - 2.0 / 33.0;
        assert!(error.abs() > 1e-10, "{error}");
    }

    #[test]
    fn known_integrals() {
        assert_close(integrate(f64::exp, 0.0, 1.0, 1e-14), 1f64.exp_m1(), 1e-15);
        assert_close(integrate(|x| 1.0 / x, 1.0, 2.0, 1e-14), LN_2, 1e-15);
        assert_close(integrate(|x| 4.0 / (1.0 + x * x), 0.0, 1.0, 1e-14), PI, 1e-15);
        assert_close(integrate(f64::sin, PI, 0.0, 1e-14), -2.0, 1e-15);
    }

    #[test]
    fn narrow_peaks_kinks_and_roots() {
        let peak = |x: f64| 1.0 / (1e-6 + (x - 0.3).powi(2));
        assert_close(integrate(peak, 0.0, 1.0, 1e-12), 1e3 * (700f64.atan() + 300f64.atan()), 1e-12);
        assert_close(integrate(|x| (x - 0.3).abs(), 0.0, 1.0, 1e-12), 0.29, 1e-12);
        assert_close(integrate(f64::sqrt, 0.0, 1.0, 1e-12), 2.0 / 3.0, 1e-12);
        assert_close(integrate_pieces(|x| (-(x * x)).exp(), &[-1e3, -10.0, 10.0, 1e3], 1e-12), PI.sqrt(), 1e-12);
    }

    #[test]
    fn nothing_hangs() {
        assert_eq!(integrate(|_| 0.0, 0.0, 1.0, 1e-12), 0.0);
        assert!(integrate(|_| f64::NAN, 0.0, 1.0, 1e-12).is_nan());
        assert!(integrate(f64::sqrt, 0.0, 1.0, 0.0).is_finite());
    }
}
