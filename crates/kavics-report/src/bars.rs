//! A histogram over 0, 1, 2, …, as inline SVG.

use std::fmt::Write;

use crate::axis::Axis;
use crate::plot::{LEFT, RIGHT, WIDTH, draw_abscissa, draw_heights, draw_labels, height, start};

/// Numbers along the axis, at most.
const NUMBERS: usize = 12;

/// Share of its place that a bar takes.
const BREADTH: f64 = 0.74;

/// The histogram: how many there are of 0, of 1, of 2, ….
pub(crate) fn draw(counts: &[usize], x_label: &str, y_label: &str) -> String {
    let heights = counts.iter().map(|&count| count as f64);
    let axis = Axis::over(heights.chain([0.0]), 5.0);
    let mut svg = start(x_label, y_label);
    draw_heights(&mut svg, &axis);
    let place = (WIDTH - LEFT - RIGHT) / counts.len().max(1) as f64;
    let numbered = counts.len().div_ceil(NUMBERS).max(1);
    for (value, &count) in counts.iter().enumerate() {
        let middle = LEFT + place * (value as f64 + 0.5);
        if value % numbered == 0 {
            draw_abscissa(&mut svg, middle, &value.to_string(), "");
        }
        if count == 0 {
            continue;
        }
        let top = height(&axis, count as f64);
        let _ = write!(
            svg,
            "<path class=\"filled\" d=\"M{:.1} {:.1}V{top:.1}h{:.1}V{1:.1}Z\"><title>{value}: {count}</title></path>",
            middle - 0.5 * BREADTH * place,
            height(&axis, 0.0),
            BREADTH * place
        );
    }
    draw_labels(&mut svg, x_label, y_label);
    svg.push_str("</svg>");
    svg
}
