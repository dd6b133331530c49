//! A curve with axes, as inline SVG without scripts.

use std::fmt::Write;

use crate::number::{show, tick};

const WIDTH: f64 = 400.0;
const HEIGHT: f64 = 260.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 44.0;

/// Above this many points a series is a line alone.
const MARKED: usize = 25;

/// One line of a plot.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
    /// Colour, one of eight.
    pub(crate) colour: usize,
    pub(crate) dashed: bool,
}

/// Lines over one horizontal axis.
#[derive(Clone, Debug)]
pub(crate) struct Plot<'a> {
    pub(crate) x_label: &'a str,
    pub(crate) y_label: &'a str,
    pub(crate) series: &'a [Series],
}

/// A linear axis with ticks at round numbers.
#[derive(Clone, Copy, Debug)]
struct Axis {
    low: f64,
    high: f64,
    step: f64,
}

impl Axis {
    /// The axis over `values`, with about `count` ticks.
    fn over(values: impl Iterator<Item = f64> + Clone, count: f64) -> Self {
        let finite = values.filter(|value| value.is_finite());
        let mut low = finite.clone().fold(f64::INFINITY, f64::min);
        let mut high = finite.fold(f64::NEG_INFINITY, f64::max);
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        // What is near zero by comparison starts at zero, so that sizes can be compared.
        if low > 0.0 && low < 0.5 * high {
            low = 0.0;
        } else if high < 0.0 && high > 0.5 * low {
            high = 0.0;
        }
        // Rounding is no curve.
        let least = 1e-9 * low.abs().max(high.abs());
        if high - low <= least {
            let half = if high == 0.0 { 0.5 } else { 0.1 * high.abs() };
            (low, high) = (low - half, high + half);
        }
        let step = round_step((high - low) / count);
        Self {
            low: (low / step).floor() * step,
            high: (high / step).ceil() * step,
            step,
        }
    }

    fn ticks(self) -> impl Iterator<Item = f64> {
        let count = ((self.high - self.low) / self.step).round() as usize;
        (0..=count).map(move |tick| {
            let value = self.low + tick as f64 * self.step;
            if value.abs() < 1e-9 * self.step {
                0.0
            } else {
                value
            }
        })
    }

    fn share(self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }
}

/// 1, 2 or 5 times a power of ten, at least `rough`.
pub(crate) fn round_step(rough: f64) -> f64 {
    let power = 10f64.powf(rough.log10().floor());
    let factor = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|factor| factor * power >= rough * (1.0 - 1e-9))
        .unwrap_or(10.0);
    factor * power
}

struct Frame {
    x: Axis,
    y: Axis,
}

impl Frame {
    fn left(&self, x: f64) -> f64 {
        LEFT + self.x.share(x) * (WIDTH - LEFT - RIGHT)
    }

    fn top(&self, y: f64) -> f64 {
        HEIGHT - BOTTOM - self.y.share(y) * (HEIGHT - TOP - BOTTOM)
    }
}

/// The plot as an SVG element.
pub(crate) fn draw(plot: &Plot<'_>) -> String {
    let points = || plot.series.iter().flat_map(|series| &series.points);
    let frame = Frame {
        x: Axis::over(points().map(|point| point.0), 5.0),
        y: Axis::over(points().map(|point| point.1), 5.0),
    };
    let mut svg = format!(
        "<svg class=\"plot\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{} over {}\">",
        escape(plot.y_label),
        escape(plot.x_label)
    );
    draw_axes(&mut svg, &frame, plot);
    for (order, series) in plot.series.iter().enumerate() {
        // Lines on top are thinner, so that those under them still show.
        let width = (3.0 - 0.45 * order as f64).max(1.2);
        draw_series(&mut svg, &frame, series, width);
    }
    svg.push_str("</svg>");
    svg
}

fn draw_axes(svg: &mut String, frame: &Frame, plot: &Plot<'_>) {
    let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
    for y in frame.y.ticks() {
        let at = frame.top(y);
        let class = if y == 0.0 { "zero" } else { "grid" };
        let label = tick(y, frame.y.step);
        let _ = write!(
            svg,
            "<path class=\"{class}\" d=\"M{LEFT} {at:.1}H{right}\"/>\
             <text class=\"tick\" text-anchor=\"end\" x=\"{}\" y=\"{:.1}\">{label}</text>",
            LEFT - 7.0,
            at + 3.5
        );
    }
    for x in frame.x.ticks() {
        let at = frame.left(x);
        let label = tick(x, frame.x.step);
        let _ = write!(
            svg,
            "<path class=\"mark\" d=\"M{at:.1} {bottom}v5\"/>\
             <text class=\"tick\" text-anchor=\"middle\" x=\"{at:.1}\" y=\"{}\">{label}</text>",
            bottom + 17.0
        );
    }
    let middle = f64::midpoint(LEFT, right);
    let _ = write!(
        svg,
        "<path class=\"mark\" d=\"M{LEFT} {bottom}H{right}\"/>\
         <text class=\"label\" text-anchor=\"middle\" x=\"{middle}\" y=\"{}\">{}</text>\
         <text class=\"label\" text-anchor=\"middle\" transform=\"translate(12 {}) rotate(-90)\">{}</text>",
        HEIGHT - 8.0,
        escape(plot.x_label),
        f64::midpoint(TOP, bottom),
        escape(plot.y_label)
    );
}

fn draw_series(svg: &mut String, frame: &Frame, series: &Series, width: f64) {
    let mut path = String::new();
    let mut pen = 'M';
    for &(x, y) in &series.points {
        if x.is_finite() && y.is_finite() {
            let _ = write!(path, "{pen}{:.1} {:.1}", frame.left(x), frame.top(y));
            pen = 'L';
        } else {
            pen = 'M';
        }
    }
    let dash = if series.dashed { " dash" } else { "" };
    let colour = series.colour;
    let _ = write!(
        svg,
        "<path class=\"line c{colour}{dash}\" stroke-width=\"{width:.2}\" d=\"{path}\"/>"
    );
    if series.points.len() > MARKED {
        return;
    }
    for &(x, y) in &series.points {
        if x.is_finite() && y.is_finite() {
            let _ = write!(
                svg,
                "<circle class=\"point c{colour}\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"2.6\">\
                 <title>{}: {} at {}</title></circle>",
                frame.left(x),
                frame.top(y),
                escape(&series.name),
                show(y),
                show(x)
            );
        }
    }
}

/// Text that may stand in HTML.
pub(crate) fn escape(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::{Axis, round_step};

    #[test]
    fn ticks_stand_at_round_numbers() {
        let axis = Axis::over([0.0, 0.37].into_iter(), 5.0);
        let ticks: Vec<f64> = axis.ticks().collect();
        assert_eq!(ticks.len(), 5);
        assert!((axis.high - 0.4).abs() < 1e-12);
        assert!((round_step(0.074) - 0.1).abs() < 1e-15);
    }

    #[test]
    fn a_constant_has_an_axis_around_it() {
        let axis = Axis::over([3.0, 3.0].into_iter(), 5.0);
        assert!(axis.low < 3.0 && axis.high > 3.0);
    }
}
