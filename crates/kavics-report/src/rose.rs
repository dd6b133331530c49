//! The rose of contact normals with the ellipse of their fabric tensor, as inline SVG.
//!
//! The area of a sector is in proportion to its share of the contacts, so its radius is the square root of the density
//! over that of isotropic contacts, √(2πE). To first order in the deviator d the first harmonic of the density,
//! 2πE = 1 + 2d·cos 2θ, has then the radius 1 + d·cos 2θ, which is that of the ellipse whose half axes are twice the
//! principal values of the fabric tensor, 1 ± d.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;

use kavics::measure::{Rose, SymmetricTensor};

use crate::plot::{HEIGHT, WIDTH};

/// Radius of the largest sector.
const RADIUS: f64 = 100.0;

/// From the largest sector to the degrees, and to their middle.
const GAP: f64 = 5.0;
const LETTERS: f64 = 15.0;

/// Directions that are named, in degrees.
const NAMED: [i32; 12] = [0, 30, 60, 90, 120, 150, 180, 210, 240, 270, 300, 330];

/// The rose with the fabric tensor of the same contacts.
pub(crate) fn draw(rose: &Rose, fabric: SymmetricTensor) -> String {
    let radii: Vec<f64> = rose.density().iter().map(|e| (TAU * e).sqrt()).collect();
    let half_axes = fabric.eigenvalues().map(|value| 2.0 * value);
    let largest = radii.iter().copied().fold(half_axes[0].max(1.0), f64::max);
    let unit = RADIUS / largest;
    let mut svg = format!(
        "<svg class=\"plot\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" \
         aria-label=\"rose of contact normals\"><g transform=\"translate({} {})\">",
        0.5 * WIDTH,
        0.5 * HEIGHT
    );
    draw_directions(&mut svg);
    for (class, radius) in radii.iter().enumerate() {
        let middle = class as f64 * rose.width();
        if *radius == 0.0 {
            continue;
        }
        for middle in [middle, middle + PI] {
            draw_sector(&mut svg, middle, rose.width(), radius * unit);
        }
    }
    let degrees = -fabric.principal_direction().to_degrees();
    let [larger, smaller] = half_axes.map(|half_axis| half_axis * unit);
    let _ = write!(
        svg,
        "<circle class=\"line c7 dash\" stroke-width=\"1.3\" r=\"{unit:.1}\"/>\
         <g class=\"line c1\" stroke-width=\"2\" transform=\"rotate({degrees:.2})\">\
         <ellipse rx=\"{larger:.2}\" ry=\"{smaller:.2}\"/>\
         <path stroke-width=\"1\" d=\"M-{larger:.2} 0H{larger:.2}M0-{smaller:.2}V{smaller:.2}\"/></g></g></svg>"
    );
    svg
}

/// Rays and their degrees.
fn draw_directions(svg: &mut String) {
    for degrees in NAMED {
        let (x, y) = at(f64::from(degrees).to_radians(), 1.0);
        let (ray, name) = (RADIUS + GAP, RADIUS + LETTERS);
        let _ = write!(
            svg,
            "<path class=\"grid\" d=\"M0 0L{:.1} {:.1}\"/>\
             <text class=\"tick\" text-anchor=\"middle\" x=\"{:.1}\" y=\"{:.1}\">{degrees}°</text>",
            ray * x,
            ray * y,
            name * x,
            name * y + 4.0
        );
    }
}

fn draw_sector(svg: &mut String, middle: f64, width: f64, radius: f64) {
    let (from, to) = (
        at(middle - 0.5 * width, radius),
        at(middle + 0.5 * width, radius),
    );
    let _ = write!(
        svg,
        "<path class=\"filled sector\" d=\"M0 0L{:.2} {:.2}A{radius:.2} {radius:.2} 0 0 0 {:.2} {:.2}Z\"/>",
        from.0, from.1, to.0, to.1
    );
}

/// The point at an angle and a distance from the middle, downwards as pictures are.
fn at(angle: f64, radius: f64) -> (f64, f64) {
    (radius * angle.cos(), -radius * angle.sin())
}
