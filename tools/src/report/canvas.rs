//! What figures are drawn on: two axes, and lines, areas, markers and names by their quantities.

use super::drawing::{Drawing, FINE};
use super::labels::{Area, beside};
use super::palette::{self, AREA, Colour, GRID, GROUND, INK, QUIET};
use super::scale::Scale;
use airlight::{Precision, Strategy};
use anyhow::{Result, anyhow};
use plotters::chart::{ChartBuilder, ChartContext, LabelAreaPosition};
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, EmptyElement, PathElement, Polygon, Text};
use plotters::prelude::{Cartesian2d, SVGBackend};
use plotters::series::{AreaSeries, DashedLineSeries};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, IntoFont, RGBColor, ShapeStyle, TRANSPARENT, TextStyle};
use std::iter::once;

/// As narrow as a telephone, so that letters need not shrink there.
const WIDTH: i32 = 520 * FINE;
const LETTERS: i32 = 16 * FINE;
/// The width of a letter, of its height.
const LETTER: f64 = 0.53;
const ROW: i32 = 23 * FINE;
const MARKER: i32 = 15 * FINE;
const LEFT: i32 = 76 * FINE;
const BELOW: i32 = 54 * FINE;
const MARGIN: i32 = 12 * FINE;
/// Room for half of a label at the end of an axis.
const RIGHT: i32 = 18 * FINE;
/// The backend writes letters smaller than they are asked for, by this.
const BACKEND: f64 = 1.24;

/// A drawing in the making.
pub(super) struct Canvas<'a> {
    root: DrawingArea<SVGBackend<'a>, Shift>,
    chart: ChartContext<'a, SVGBackend<'a>, Cartesian2d<Scale, Scale>>,
    x: Scale,
    y: Scale,
    /// Where there are words already.
    taken: Vec<Area>,
    /// Where the legend begins.
    legend: i32,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) enum Line {
    Solid,
    Bold,
    Dashed,
}

/// Has `draw` draw between two axes, `height` high, with `rows` of a legend below.
pub(super) fn draw(
    name: &str,
    title: &str,
    (height, rows): (i32, i32),
    (x, y): (Scale, Scale),
    draw: impl FnOnce(&mut Canvas<'_>) -> Result<()>,
) -> Result<Drawing> {
    let (plot, whole) = (height * FINE, height * FINE + rows * ROW);
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (WIDTH as u32, whole as u32)).into_drawing_area();
        let (upper, _) = root.split_vertically(plot);
        let mut builder = ChartBuilder::on(&upper);
        builder
            .margin(MARGIN)
            .margin_right(RIGHT)
            .set_label_area_size(LabelAreaPosition::Left, LEFT)
            .set_label_area_size(LabelAreaPosition::Bottom, if x.title.is_empty() { BELOW / 2 } else { BELOW });
        let mut chart = builder.build_cartesian_2d(x.clone(), y.clone()).map_err(failed)?;
        chart
            .configure_mesh()
            .x_desc(&x.title)
            .y_desc(&y.title)
            .label_style(letters(INK))
            .axis_desc_style(letters(INK))
            .axis_style(stroke(QUIET, FINE))
            .bold_line_style(stroke(GRID, FINE))
            .light_line_style(TRANSPARENT)
            .draw()
            .map_err(failed)?;
        let mut canvas = Canvas { root, chart, x, y, taken: Vec::new(), legend: plot };
        draw(&mut canvas)?;
        canvas.root.present().map_err(failed)?;
    }
    // The elements alone, without the tags around them.
    let content = svg.split_once('>').map_or("", |(_, content)| content).trim().trim_end_matches("</svg>");
    let edge = format!("stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"", GROUND.hex(), 5 * FINE);
    let content = content.replace("<text ", &format!("<text paint-order=\"stroke\" {edge} "));
    Ok(Drawing { name: name.to_owned(), title: title.to_owned(), size: (WIDTH, whole), content })
}

fn failed(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow!("cannot draw: {error}")
}

fn letters(colour: Colour) -> TextStyle<'static> {
    let style = TextStyle::from(("sans-serif", f64::from(LETTERS) * BACKEND).into_font());
    TextStyle { color: colour.rgb().to_backend_color(), ..style }
}

fn stroke(colour: Colour, width: i32) -> ShapeStyle {
    colour.rgb().stroke_width(width as u32)
}

/// How long a text is about.
fn length(text: &str) -> i32 {
    (LETTER * f64::from(LETTERS) * text.chars().count() as f64) as i32
}

impl Canvas<'_> {
    fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.x.at(x), self.y.at(y))
    }

    /// A line through points, as far as it is between the axes.
    pub(super) fn line(&mut self, points: impl Iterator<Item = (f64, f64)>, colour: Colour, line: Line) -> Result<()> {
        let places: Vec<(f64, f64)> = points.map(|point| self.place(point)).collect();
        for run in clip(&places, [self.x.from, self.x.to, self.y.from, self.y.to]) {
            let style = match line {
                Line::Solid => stroke(colour, 2 * FINE),
                Line::Bold => stroke(colour, 3 * FINE),
                Line::Dashed => stroke(colour, 3 * FINE / 2),
            };
            match line {
                Line::Solid | Line::Bold => {
                    self.chart.draw_series(once(PathElement::new(run, style))).map_err(failed)?
                }
                Line::Dashed => self
                    .chart
                    .draw_series(DashedLineSeries::new(run, 6 * FINE as u32, 5 * FINE as u32, style))
                    .map_err(failed)?,
            };
        }
        Ok(())
    }

    /// The area below a curve.
    pub(super) fn area(&mut self, points: impl Iterator<Item = (f64, f64)>) -> Result<()> {
        let top = self.y.to;
        let places: Vec<(f64, f64)> = points.map(|point| self.place(point)).map(|(x, y)| (x, y.min(top))).collect();
        self.chart.draw_series(AreaSeries::new(places, 0.0, AREA.rgb())).map_err(failed)?;
        Ok(())
    }

    /// A strategy's marker; names keep off it.
    pub(super) fn marker(&mut self, strategy: Strategy, point: (f64, f64)) -> Result<()> {
        self.marker_of(strategy, Precision::Exact, point)
    }

    /// The same, hollow in fast precision.
    pub(super) fn marker_of(&mut self, strategy: Strategy, precision: Precision, point: (f64, f64)) -> Result<()> {
        let corners = palette::marker(strategy, MARKER);
        let edge: Vec<(i32, i32)> = corners.iter().chain(corners.first()).copied().collect();
        let fill: RGBColor = palette::fill(strategy, precision).rgb();
        let marker = EmptyElement::at(self.place(point))
            + Polygon::new(corners, fill.filled())
            + PathElement::new(edge, stroke(palette::colour(strategy), 2 * FINE));
        self.chart.draw_series(once(marker)).map_err(failed)?;
        let ((x, y), half) = (self.chart.backend_coord(&self.place(point)), MARKER / 2);
        self.taken.push(Area([x - half, y - half, x + half, y + half]));
        Ok(())
    }

    /// A marker of what is no strategy.
    pub(super) fn spot(&mut self, point: (f64, f64), colour: Colour) -> Result<()> {
        let spot = Circle::new((0, 0), MARKER / 3, colour.rgb().filled());
        self.chart.draw_series(once(EmptyElement::at(self.place(point)) + spot)).map_err(failed)?;
        Ok(())
    }

    /// A text above a point, which is at its left or its right end; none if it is not between the axes.
    pub(super) fn say(&mut self, text: &str, point: (f64, f64), end: HPos) -> Result<()> {
        let (x, y) = self.place(point);
        if !((self.x.from..=self.x.to).contains(&x) && (self.y.from..=self.y.to).contains(&y)) {
            return Ok(());
        }
        let (x, y) = self.chart.backend_coord(&(x, y));
        let left = if matches!(end, HPos::Left) { x } else { x - length(text) };
        self.taken.push(Area([left, y - LETTERS, left + length(text), y]));
        self.write(text, (x, y - FINE), QUIET, Pos::new(end, VPos::Bottom))
    }

    /// No name goes on the upright line between two points.
    pub(super) fn keep_off(&mut self, point: (f64, f64), end: f64) {
        let (x, y) = self.chart.backend_coord(&self.place(point));
        let (_, top) = self.chart.backend_coord(&self.place((point.0, end)));
        self.taken.push(Area([x - 2 * FINE, top, x + 2 * FINE, y]));
    }

    /// Names beside their points, off each other and off what has been said.
    pub(super) fn names(&mut self, names: &[(&str, (f64, f64))]) -> Result<()> {
        let sized = |&(name, point): &(&str, (f64, f64))| {
            (self.chart.backend_coord(&self.place(point)), (length(name), LETTERS * 7 / 8))
        };
        let points: Vec<_> = names.iter().map(sized).collect();
        let (xs, ys) = self.chart.plotting_area().get_pixel_range();
        let areas = beside(&points, Area([xs.start, ys.start, xs.end, ys.end]), MARKER / 2, &self.taken);
        for ((name, _), Area([left, top, right, bottom])) in names.iter().zip(areas) {
            let middle = (i32::midpoint(left, right), i32::midpoint(top, bottom));
            self.write(name, middle, INK, Pos::new(HPos::Center, VPos::Center))?;
        }
        Ok(())
    }

    /// Strategies with their markers, in two columns below the axes.
    pub(super) fn legend(&mut self, entries: &[(Strategy, String)]) -> Result<()> {
        let rows = entries.len().div_ceil(2);
        for (i, (strategy, text)) in entries.iter().enumerate() {
            let x = MARGIN + (i / rows) as i32 * (WIDTH / 2) + MARKER;
            let y = self.legend + (i % rows) as i32 * ROW + ROW / 2;
            let colour = palette::colour(*strategy);
            let corners = palette::marker(*strategy, MARKER).into_iter().map(|(dx, dy)| (x + dx, y + dy));
            self.root.draw(&Polygon::new(corners.collect::<Vec<_>>(), colour.rgb().filled())).map_err(failed)?;
            self.write(text, (x + MARKER, y), INK, Pos::new(HPos::Left, VPos::Center))?;
        }
        Ok(())
    }

    fn write(&self, text: &str, at: (i32, i32), colour: Colour, anchor: Pos) -> Result<()> {
        self.root.draw(&Text::new(text.to_owned(), at, letters(colour).pos(anchor))).map_err(failed)
    }
}

/// The parts of a path that are inside `[left, right, bottom, top]`.
fn clip(path: &[(f64, f64)], [left, right, bottom, top]: [f64; 4]) -> Vec<Vec<(f64, f64)>> {
    let mut runs: Vec<Vec<(f64, f64)>> = Vec::new();
    for ends in path.windows(2) {
        let [(x, y), (to_x, to_y)] = [ends[0], ends[1]];
        let (dx, dy) = (to_x - x, to_y - y);
        let (mut first, mut last) = (0.0f64, 1.0f64);
        for (step, room) in [(-dx, x - left), (dx, right - x), (-dy, y - bottom), (dy, top - y)] {
            if step == 0.0 {
                last = if room < 0.0 { -1.0 } else { last };
            } else if step < 0.0 {
                first = first.max(room / step);
            } else {
                last = last.min(room / step);
            }
        }
        // Also without what is no number.
        if !(dx.is_finite() && dy.is_finite() && first <= last) {
            continue;
        }
        let at = |share: f64| (x + share * dx, y + share * dy);
        match runs.last_mut() {
            Some(run) if first == 0.0 && run.last() == Some(&(x, y)) => run.push(at(last)),
            _ => runs.push(vec![at(first), at(last)]),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_cut_at_the_frame() {
        let frame = [0.0, 10.0, 0.0, 10.0];
        assert_eq!(clip(&[(1.0, 1.0), (2.0, 2.0), (3.0, 1.0)], frame), [[(1.0, 1.0), (2.0, 2.0), (3.0, 1.0)]]);
        let over_the_top = clip(&[(0.0, 5.0), (5.0, 15.0), (10.0, 5.0)], frame);
        assert_eq!(over_the_top, [[(0.0, 5.0), (2.5, 10.0)], [(7.5, 10.0), (10.0, 5.0)]]);
        assert!(clip(&[(1.0, f64::NAN), (2.0, 2.0)], frame).is_empty());
        assert!(clip(&[(1.0, 20.0), (2.0, 20.0)], frame).is_empty());
    }
}
