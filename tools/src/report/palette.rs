//! One colour and one marker per strategy in all figures: no two share both a hue and a shape.

use super::canvas::Line;
use airlight::{Precision, Strategy};
use airlight_tools::contender::PRODUCTS;
use plotters::style::RGBColor;

/// A colour on light and on dark ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct Colour {
    light: u32,
    dark: u32,
}

/// Text and axes.
pub(super) const INK: Colour = Colour { light: 0x1b1f24, dark: 0xe8eaed };
/// Limits, fronts and what is said about them.
pub(super) const QUIET: Colour = Colour { light: 0x5a6069, dark: 0xa9b0ba };
/// What letters are edged with, so that they are read on lines.
pub(super) const GROUND: Colour = Colour { light: 0xffffff, dark: 0x14171b };
/// Lines of the grid.
pub(super) const GRID: Colour = Colour { light: 0xdfe2e6, dark: 0x363b42 };
/// The integrand's area.
pub(super) const AREA: Colour = Colour { light: 0xd3d8de, dark: 0x444b54 };

/// Of the strategies, in their order; blue and green are those of the whole integrand.
const STRATEGIES: [Colour; 9] = [
    Colour { light: 0x70757c, dark: 0xb4bac2 },
    Colour { light: 0xb07800, dark: 0xe69f00 },
    Colour { light: 0xd55e00, dark: 0xff8438 },
    Colour { light: 0xc45a97, dark: 0xeaa3cb },
    Colour { light: 0x8a1c50, dark: 0xd9689f },
    Colour { light: 0x3a97d6, dark: 0x86cdf7 },
    Colour { light: 0x005f9e, dark: 0x4a9fe0 },
    Colour { light: 0x00916a, dark: 0x34c99c },
    Colour { light: 0x3d2c8d, dark: 0xa394f0 },
];

/// Corners of a marker, from its middle, in eighths of its height.
type Shape = &'static [(i32, i32)];

const SHAPES: [Shape; 9] = [
    // a cross
    &[(-4, -3), (-3, -4), (0, -1), (3, -4), (4, -3), (1, 0), (4, 3), (3, 4), (0, 1), (-3, 4), (-4, 3), (-1, 0)],
    // an octagon
    &[(-2, -4), (2, -4), (4, -2), (4, 2), (2, 4), (-2, 4), (-4, 2), (-4, -2)],
    // a square
    &[(-3, -3), (3, -3), (3, 3), (-3, 3)],
    // triangles, up and down
    &[(0, -4), (4, 3), (-4, 3)],
    &[(0, 4), (4, -3), (-4, -3)],
    // a diamond
    &[(0, -4), (4, 0), (0, 4), (-4, 0)],
    // a plus
    &[(-1, -4), (1, -4), (1, -1), (4, -1), (4, 1), (1, 1), (1, 4), (-1, 4), (-1, 1), (-4, 1), (-4, -1), (-1, -1)],
    // triangles to the right and to the left
    &[(4, 0), (-3, 4), (-3, -4)],
    &[(-4, 0), (3, 4), (3, -4)],
];

fn index(strategy: Strategy) -> usize {
    Strategy::ALL.iter().position(|&other| other == strategy).unwrap_or(0)
}

pub(super) fn colour(strategy: Strategy) -> Colour {
    STRATEGIES[index(strategy)]
}

/// How its line is drawn: the densities of the paper are dashed, those of the whole integrand bold.
pub(super) fn line(strategy: Strategy) -> Line {
    match strategy {
        Strategy::TaylorTransmittance | Strategy::TaylorPhase => Line::Dashed,
        _ if PRODUCTS.contains(&strategy) => Line::Bold,
        _ => Line::Solid,
    }
}

/// What its marker is filled with: its colour, in fast precision the ground.
pub(super) fn fill(strategy: Strategy, precision: Precision) -> Colour {
    if precision == Precision::Fast { GROUND } else { colour(strategy) }
}

/// The corners of the strategy's marker of a height.
pub(super) fn marker(strategy: Strategy, height: i32) -> Vec<(i32, i32)> {
    SHAPES[index(strategy)].iter().map(|&(x, y)| (x * height / 8, y * height / 8)).collect()
}

impl Colour {
    /// As drawings have it; what shows them may put the other one in its place.
    pub(super) fn rgb(self) -> RGBColor {
        let [_, r, g, b] = self.light.to_be_bytes();
        RGBColor(r, g, b)
    }

    /// As an attribute of SVG.
    pub(super) fn hex(self) -> String {
        format!("#{:06X}", self.light)
    }
}

/// The style sheet that gives drawings the dark colours where the reader wants them.
pub(super) fn dark_style() -> String {
    let all = [INK, QUIET, GROUND, GRID, AREA].into_iter().chain(STRATEGIES);
    let rules = all.map(|Colour { light, dark }| {
        format!("[fill=\"#{light:06X}\"]{{fill:#{dark:06X}}}[stroke=\"#{light:06X}\"]{{stroke:#{dark:06X}}}\n")
    });
    format!("@media screen and (prefers-color-scheme: dark) {{\n{}}}\n", rules.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_colours_are_the_same() {
        let all: Vec<Colour> = [INK, QUIET, GROUND, GRID, AREA].into_iter().chain(STRATEGIES).collect();
        for (i, a) in all.iter().enumerate() {
            assert!(all[..i].iter().all(|b| a.light != b.light && a.dark != b.dark), "{a:?}");
        }
        assert_eq!(STRATEGIES.len(), Strategy::ALL.len());
    }
}
