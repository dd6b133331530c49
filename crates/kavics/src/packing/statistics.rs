//! What a pack turned out to be: realised sieve curve, packing fraction.

use std::f64::consts::PI;

use crate::assembly::Grain;
use crate::geometry::Vector;
use crate::ids::PerGrain;
use crate::packing::Mass;

/// Realised sieve curve: the share of the mass of all grains in those up to each `diameter`.
///
/// P(d) = Σ dᵖ over the grains with 2·R ≤ d, by the sum over all; p as [`Mass`] says.
pub fn sieve_curve(grains: &PerGrain<Grain>, diameter: &[f64], mass: Mass) -> Vec<f64> {
    let share = |limit: f64| {
        let (mut passing, mut total) = (0.0, 0.0);
        for grain in grains.values() {
            let own = mass.of(2.0 * grain.radius);
            total += own;
            if 2.0 * grain.radius <= limit {
                passing += own;
            }
        }
        passing / total
    };
    diameter.iter().map(|&limit| share(limit)).collect()
}

/// Packing fraction: the area of the discs within a rectangle by the area of the rectangle. Discs are cut exactly.
pub fn packing_fraction(grains: &PerGrain<Grain>, lower_left: Vector, upper_right: Vector) -> f64 {
    let solid: f64 = grains
        .values()
        .iter()
        .map(|grain| {
            let from = lower_left - grain.centre;
            let to = upper_right - grain.centre;
            let corner = |x, y| area_beyond(x, y, grain.radius);
            corner(from.x, from.y) - corner(to.x, from.y) - corner(from.x, to.y)
                + corner(to.x, to.y)
        })
        .sum();
    let size = upper_right - lower_left;
    solid / (size.x * size.y)
}

/// Area of the disc x² + y² ≤ r² to the right of x = a and above y = b.
fn area_beyond(a: f64, b: f64, r: f64) -> f64 {
    let right = segment(a, r);
    let above = segment(b, r);
    if a * a + b * b < r * r {
        return 0.5 * (right + above) - 0.25 * PI * r * r + a * b;
    }
    match (a < 0.0, b < 0.0) {
        (false, false) => 0.0,
        (true, false) => above,
        (false, true) => right,
        (true, true) => (right + above - PI * r * r).max(0.0),
    }
}

/// Area of the disc of radius r beyond a line at distance a from its centre: r²·acos(a/r) − a·√(r² − a²).
fn segment(a: f64, r: f64) -> f64 {
    if a >= r {
        0.0
    } else if a <= -r {
        PI * r * r
    } else {
        r * r * libm::acos(a / r) - a * (r * r - a * a).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn discs(discs: &[[f64; 3]]) -> PerGrain<Grain> {
        let grain = |&[x, y, radius]: &[f64; 3]| Grain {
            centre: Vector::new(x, y),
            radius,
        };
        discs.iter().map(grain).collect()
    }

    #[test]
    fn a_disc_is_cut_by_the_window() {
        let disc = discs(&[[0.0, 0.0, 1.0]]);
        let fraction = |a: [f64; 2], b: [f64; 2]| {
            packing_fraction(&disc, Vector::new(a[0], a[1]), Vector::new(b[0], b[1]))
        };
        // Whole, half, quarter of a disc, a square inside it, nothing.
        assert!((fraction([-1.0, -1.0], [1.0, 1.0]) - PI / 4.0).abs() < 1e-15);
        assert!((fraction([0.0, -2.0], [2.0, 2.0]) - PI / 16.0).abs() < 1e-15);
        assert!((fraction([0.0, 0.0], [1.0, 1.0]) - PI / 4.0).abs() < 1e-15);
        assert!((fraction([-0.5, -0.5], [0.5, 0.5]) - 1.0).abs() < 1e-15);
        assert!(fraction([0.8, 0.8], [2.0, 2.0]).abs() < 1e-15);
    }

    #[test]
    fn the_realised_curve_counts_mass() {
        let three = discs(&[[0.0, 0.0, 1.0], [3.0, 0.0, 1.0], [9.0, 0.0, 2.0]]);
        // Masses 1, 1, 4 of 6 (discs) and 1, 1, 8 of 10 (spheres).
        let disc = sieve_curve(&three, &[1.0, 2.0, 4.0], Mass::Disc);
        assert_eq!(disc, [0.0, 2.0 / 6.0, 1.0]);
        let sphere = sieve_curve(&three, &[1.0, 2.0, 4.0], Mass::Sphere);
        assert_eq!(sphere, [0.0, 0.2, 1.0]);
    }
}
