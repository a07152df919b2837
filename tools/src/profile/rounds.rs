//! Contestants measured in turn, round by round: what changes in the machine changes for all of them.

use anyhow::Result;
use serde::Serialize;

/// Times of one contestant, a round each \[ns\].
#[derive(Clone, Debug)]
pub(crate) struct Times(Vec<f64>);

/// The median of some figures, and between which they lie.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Spread {
    pub(crate) median: f64,
    pub(crate) min: f64,
    pub(crate) max: f64,
}

/// Measures every contestant in every round; a first one, which warms up, does not count.
pub(crate) fn take_turns<C>(
    contestants: Vec<C>,
    rounds: usize,
    mut time: impl FnMut(&C) -> Result<f64>,
) -> Result<Vec<(C, Times)>> {
    let mut measured: Vec<_> = contestants.into_iter().map(|contestant| (contestant, Times(Vec::new()))).collect();
    for round in 0..=rounds {
        for (contestant, times) in &mut measured {
            let time = time(contestant)?;
            if round > 0 {
                times.0.push(time);
            }
        }
    }
    Ok(measured)
}

impl Times {
    pub(crate) fn spread(&self) -> Spread {
        let mut ascending = self.0.clone();
        ascending.sort_by(f64::total_cmp);
        let n = ascending.len();
        let median = 0.5 * (ascending[(n - 1) / 2] + ascending[n / 2]);
        Spread { median, min: ascending[0], max: ascending[n - 1] }
    }

    /// Round by round.
    pub(super) fn over(&self, other: &Self) -> Self {
        self.with(other, |a, b| a / b)
    }

    /// Round by round.
    pub(super) fn minus(&self, other: &Self) -> Self {
        self.with(other, |a, b| a - b)
    }

    fn with(&self, other: &Self, of: impl Fn(f64, f64) -> f64) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(&a, &b)| of(a, b)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contestants_take_turns_and_the_first_round_does_not_count() {
        let mut turns = Vec::new();
        let measured = take_turns(vec!['a', 'b'], 2, |&contestant| {
            turns.push(contestant);
            Ok(turns.len() as f64)
        });
        let [(_, a), (_, b)] = measured.unwrap().try_into().unwrap();
        assert_eq!((a.0, b.0), (vec![3.0, 5.0], vec![4.0, 6.0]));
        assert_eq!(turns, ['a', 'b', 'a', 'b', 'a', 'b']);
    }

    #[test]
    fn ratios_are_taken_round_by_round() {
        // The second round was three times as slow, for both.
        let (a, b) = (Times(vec![2.0, 6.0, 3.0]), Times(vec![1.0, 3.0, 1.0]));
        let Spread { median, min, max } = a.over(&b).spread();
        assert_eq!([median, min, max], [2.0, 2.0, 3.0]);
        assert_eq!(Times(vec![4.0, 1.0, 2.0, 9.0]).spread().median, 3.0);
    }
}
