//! Axes: from a quantity to its place, and where the ticks are.

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

/// An axis, logarithmic or not.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    pub(super) title: String,
    logarithmic: bool,
    /// What stands at the places 0, 1, 2 and so on, if not numbers.
    names: Vec<String>,
    /// Its ends, as places.
    pub(super) from: f64,
    pub(super) to: f64,
    ticks: Vec<f64>,
}

impl Scale {
    /// A logarithmic axis with ticks at powers of ten.
    pub(super) fn decades(title: &str, (from, to): (f64, f64)) -> Self {
        let (from, to) = (from.log10(), to.log10());
        let every = (((to - from) / 7.0).ceil() as i32).max(1);
        let ticks = (from.ceil() as i32..=to.floor() as i32).filter(|power| power % every == 0);
        Self {
            title: title.to_owned(),
            logarithmic: true,
            names: Vec::new(),
            from,
            to,
            ticks: ticks.map(f64::from).collect(),
        }
    }

    /// A logarithmic axis with these ticks, as far as they are on it.
    pub(super) fn logarithmic(title: &str, (from, to): (f64, f64), ticks: &[f64]) -> Self {
        let ticks = ticks.iter().filter(|tick| (from..=to).contains(tick)).map(|tick| tick.log10());
        Self {
            title: title.to_owned(),
            logarithmic: true,
            names: Vec::new(),
            from: from.log10(),
            to: to.log10(),
            ticks: ticks.collect(),
        }
    }

    /// A linear one.
    pub(super) fn linear(title: &str, (from, to): (f64, f64), ticks: &[f64]) -> Self {
        Self { title: title.to_owned(), logarithmic: false, names: Vec::new(), from, to, ticks: ticks.to_vec() }
    }

    /// One of names.
    pub(super) fn named(title: &str, names: &[String]) -> Self {
        let ticks = (0..names.len()).map(|i| i as f64).collect();
        let to = names.len() as f64 - 0.5;
        Self { title: title.to_owned(), logarithmic: false, names: names.to_vec(), from: -0.5, to, ticks }
    }

    /// Where a quantity is.
    pub(super) fn at(&self, value: f64) -> f64 {
        if self.logarithmic { value.log10() } else { value }
    }

    /// The quantity at a tick.
    fn tick(&self, place: f64) -> String {
        if let Some(name) = self.names.get(place.max(0.0) as usize) {
            return name.clone();
        }
        short(if self.logarithmic { 10f64.powf(place) } else { place })
    }
}

/// Over places.
impl Ranged for Scale {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, place: &f64, (from, to): (i32, i32)) -> i32 {
        from + (f64::from(to - from) * (place - self.from) / (self.to - self.from)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks.clone()
    }

    fn range(&self) -> Range<f64> {
        self.from..self.to
    }
}

impl ValueFormatter<f64> for Scale {
    fn format(place: &f64) -> String {
        short(*place)
    }

    fn format_ext(&self, place: &f64) -> String {
        self.tick(*place)
    }
}

/// A number as it is read most easily: 0.5, 20, 64Ki, 16Mi, 1e-6.
pub(super) fn short(value: f64) -> String {
    let power_of_two = (value.log2() - value.log2().round()).abs() < 1e-9;
    match value {
        0.0 => "0".to_owned(),
        _ if power_of_two && value > 1e6 => format!("{:.0}Mi", value / 1_048_576.0),
        _ if power_of_two && value > 1e3 => format!("{:.0}Ki", value / 1024.0),
        _ if (0.0099..9999.0).contains(&value.abs()) => {
            let rounded = (value * 1000.0).round() / 1000.0;
            format!("{rounded}")
        }
        _ => format!("{value:.0e}"),
    }
}

/// How many times one thing is another, in few digits.
pub(super) fn times(ratio: f64) -> String {
    match ratio {
        _ if ratio < 9.95 => format!("{ratio:.1}"),
        _ if ratio < 9999.5 => format!("{ratio:.0}"),
        _ => format!("{ratio:.1e}"),
    }
}

/// The ends of an axis around some quantities, with room beside them.
pub(super) fn around(values: impl Iterator<Item = f64>, room: f64) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), v| (low.min(v), high.max(v)));
    (low / room, high * room)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let told = [0.0, 0.5, 20.0, 4096.0, 16_777_216.0, 1e-6, 1e5].map(short);
        assert_eq!(told, ["0", "0.5", "20", "4Ki", "16Mi", "1e-6", "1e5"]);
    }

    #[test]
    fn ticks_are_on_the_axis() {
        let scale = Scale::decades("", (3e-7, 2.0));
        assert_eq!(scale.ticks, [-6.0, -5.0, -4.0, -3.0, -2.0, -1.0, 0.0]);
        assert_eq!(scale.tick(-6.0), "1e-6");
    }
}
