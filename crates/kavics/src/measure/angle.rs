//! Angles between directions, many of them.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::geometry::Vector;

/// Arctangents are tabled at this many steps from 0 to 1.
const STEPS: usize = 32;

/// Angles by a table of arctangents: to rounding what libm gives, in a fraction of the time as nothing branches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Angles {
    arctangents: [f64; STEPS + 1],
}

impl Angles {
    pub fn new() -> Self {
        Self {
            arctangents: std::array::from_fn(|k| libm::atan(k as f64 / STEPS as f64)),
        }
    }

    /// Angle from one direction to another, counter-clockwise, in (0, 2π].
    pub fn between(&self, from: Vector, to: Vector) -> f64 {
        let (sine, cosine) = (from.cross(to), from.dot(to));
        let octant = self.octant(sine.abs().min(cosine.abs()), sine.abs().max(cosine.abs()));
        let quadrant = if sine.abs() > cosine.abs() {
            FRAC_PI_2 - octant
        } else {
            octant
        };
        let half = if cosine < 0.0 {
            PI - quadrant
        } else {
            quadrant
        };
        if sine > 0.0 { half } else { TAU - half }
    }

    /// arctan(y/x) for 0 ≤ y ≤ x: with c the nearest step, arctan c + arctan u, u = (y − c·x)/(x + c·y).
    fn octant(&self, y: f64, x: f64) -> f64 {
        let nearest = (STEPS as f64 * (y / x) + 0.5) as u32;
        let c = f64::from(nearest) / STEPS as f64;
        let u = (y - c * x) / (x + c * y);
        // |u| < 1/(2·STEPS), so that the next term of the series is below rounding.
        let square = u * u;
        let series = 1.0 - square * (1.0 / 3.0 - square * (1.0 / 5.0 - square * (1.0 / 7.0)));
        self.arctangents[(nearest as usize).min(STEPS)] + u * series
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_counted_counter_clockwise_up_to_a_whole_turn() {
        let angles = Angles::new();
        let (right, up) = (Vector::new(2.0, 0.0), Vector::new(0.0, 3.0));
        assert_eq!(angles.between(right, up), FRAC_PI_2);
        assert_eq!(angles.between(up, right), TAU - FRAC_PI_2);
        assert_eq!(angles.between(right, -right), PI);
        assert_eq!(angles.between(up, up), TAU);
    }

    #[test]
    fn angles_are_those_of_the_arctangent_to_rounding() {
        let angles = Angles::new();
        for k in 1..=3000 {
            let angle = TAU * f64::from(k) / 3000.0;
            let along = Vector::new(libm::cos(angle), libm::sin(angle));
            let found = angles.between(Vector::new(1.7, 0.0), along);
            let exact = libm::atan2(along.y, along.x);
            let exact = if exact > 0.0 { exact } else { exact + TAU };
            assert!(
                (found - exact).abs() <= 4.0 * f64::EPSILON * exact,
                "{angle}"
            );
        }
    }
}
