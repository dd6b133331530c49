//! A curve with axes, as inline SVG without scripts.

use std::fmt::Write;

use crate::axis::Axis;
use crate::number::show;

pub(crate) const WIDTH: f64 = 400.0;
pub(crate) const HEIGHT: f64 = 260.0;
pub(crate) const LEFT: f64 = 74.0;
pub(crate) const RIGHT: f64 = 24.0;
pub(crate) const TOP: f64 = 12.0;
pub(crate) const BOTTOM: f64 = 44.0;

/// Above this many points a series is a line alone.
const MARKED: usize = 25;

/// Above so many a line may be jagged, and is thin.
const JAGGED: usize = 200;

/// One line of a plot.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
    /// Colour, one of eight.
    pub(crate) colour: usize,
    pub(crate) dashed: bool,
    /// Whether its points are marked where they are few.
    pub(crate) marked: bool,
}

/// Lines over one horizontal axis.
#[derive(Clone, Debug)]
pub(crate) struct Plot<'a> {
    pub(crate) x_label: &'a str,
    pub(crate) y_label: &'a str,
    /// Whether the horizontal axis is one of sizes, logarithmic where they are spread widely.
    pub(crate) sizes: bool,
    /// About how many numbers the vertical axis has.
    pub(crate) heights: f64,
    pub(crate) series: &'a [Series],
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
        height(&self.y, y)
    }
}

/// The plot as an SVG element.
pub(crate) fn draw(plot: &Plot<'_>) -> String {
    let points = || plot.series.iter().flat_map(|series| &series.points);
    let x = points().map(|point| point.0);
    let frame = Frame {
        x: if plot.sizes {
            Axis::over_sizes(x, 5.0)
        } else {
            Axis::over(x, 5.0)
        },
        y: Axis::over(points().map(|point| point.1), plot.heights),
    };
    let mut svg = start(plot.x_label, plot.y_label);
    draw_heights(&mut svg, &frame.y);
    draw_abscissas(&mut svg, &frame);
    draw_labels(&mut svg, plot.x_label, plot.y_label);
    for (order, series) in plot.series.iter().enumerate() {
        // Lines on top are thinner, so that those under them still show.
        let width = (3.0 - 0.45 * order as f64).max(1.2);
        let width = if series.points.len() > JAGGED {
            1.2
        } else {
            width
        };
        draw_series(&mut svg, &frame, series, width);
    }
    svg.push_str("</svg>");
    svg
}

/// The start of the element of a plot.
pub(crate) fn start(x_label: &str, y_label: &str) -> String {
    format!(
        "<svg class=\"plot\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{} over {}\">",
        escape(y_label),
        escape(x_label)
    )
}

/// Lines across the plot with the numbers of the vertical axis.
pub(crate) fn draw_heights(svg: &mut String, axis: &Axis) {
    for tick in axis.ticks() {
        let at = height(axis, tick.value);
        let class = if tick.value == 0.0 { "zero" } else { "grid" };
        let _ = write!(
            svg,
            "<path class=\"{class}\" d=\"M{LEFT} {at:.1}H{}\"/>\
             <text class=\"tick\" text-anchor=\"end\" x=\"{}\" y=\"{:.1}\">{}</text>",
            WIDTH - RIGHT,
            LEFT - 7.0,
            at + 3.5,
            tick.label
        );
    }
}

/// Where a value of the vertical axis stands.
pub(crate) fn height(axis: &Axis, value: f64) -> f64 {
    HEIGHT - BOTTOM - axis.share(value) * (HEIGHT - TOP - BOTTOM)
}

fn draw_abscissas(svg: &mut String, frame: &Frame) {
    for tick in frame.x.ticks() {
        draw_abscissa(svg, frame.left(tick.value), &tick.label, "v5");
    }
}

/// A number of the horizontal axis, with a mark.
pub(crate) fn draw_abscissa(svg: &mut String, at: f64, label: &str, mark: &str) {
    let bottom = HEIGHT - BOTTOM;
    let _ = write!(
        svg,
        "<path class=\"mark\" d=\"M{at:.1} {bottom}{mark}\"/>\
         <text class=\"tick\" text-anchor=\"middle\" x=\"{at:.1}\" y=\"{}\">{label}</text>",
        bottom + 17.0
    );
}

/// The horizontal axis, and what both axes show.
pub(crate) fn draw_labels(svg: &mut String, x_label: &str, y_label: &str) {
    let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
    let middle = f64::midpoint(LEFT, right);
    let _ = write!(
        svg,
        "<path class=\"mark\" d=\"M{LEFT} {bottom}H{right}\"/>\
         <text class=\"label\" text-anchor=\"middle\" x=\"{middle}\" y=\"{}\">{}</text>\
         <text class=\"label\" text-anchor=\"middle\" transform=\"translate(12 {}) rotate(-90)\">{}</text>",
        HEIGHT - 8.0,
        escape(x_label),
        f64::midpoint(TOP, bottom),
        escape(y_label)
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
    if !series.marked || series.points.len() > MARKED {
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
