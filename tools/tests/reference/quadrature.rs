//! Gauss and Legendre's rule, its nodes by Newton's method.

use super::number::{Big, big};
use std::f64::consts::PI;

const NODES: usize = 20;

/// The integral of `f` from `a` to `b`: exact for polynomials up to degree 39.
pub(super) fn gauss_legendre(rule: &[(Big, Big)], a: &Big, b: &Big, f: impl Fn(&Big) -> Big) -> Big {
    let (middle, half) = ((a + b) / big(2.0), (b - a) / big(2.0));
    rule.iter().fold(big(0.0), |sum, (x, weight)| sum + weight * f(&(&middle + &half * x))) * half
}

/// The nodes and weights on \[-1, 1\].
pub(super) fn rule() -> Vec<(Big, Big)> {
    let node = |i: usize| {
        let mut x = big((PI * (i as f64 + 0.75) / (NODES as f64 + 0.5)).cos());
        for _ in 0..7 {
            let (p, slope) = legendre(&x);
            x -= p / slope;
        }
        let (_, slope) = legendre(&x);
        let weight = big(2.0) / ((big(1.0) - &x * &x) * &slope * &slope);
        (x, weight)
    };
    (0..NODES).map(node).collect()
}

/// Legendre's polynomial and its derivative.
fn legendre(x: &Big) -> (Big, Big) {
    let (mut before, mut p) = (big(1.0), x.clone());
    for n in 1..NODES {
        let next = (big((2 * n + 1) as f64) * x * &p - big(n as f64) * before) / big((n + 1) as f64);
        (before, p) = (p, next);
    }
    let slope = big(NODES as f64) * (before - x * &p) / (big(1.0) - x * x);
    (p, slope)
}
