//! Loads distributed along a side of the box, as loads on the grains seen first from it.
//!
//! In: the parts of the side and the grain that each belongs to. Out: the resultant on each grain.

use std::collections::BTreeMap;

use crate::assembly::{Grain, Side};
use crate::equilibrium::Load;
use crate::ids::{GrainId, PerGrain};

/// Loads on the grains that a linearly distributed load on a `side` makes, in the order of the ids.
///
/// A part (grain, a, b) gives a grain the side from a to b, measured from its start. `normal` and `shear` are the
/// values at the start and the end of the side `[force/length]`, positive along the outward normal n and along the
/// side's direction e. With m = (a + b)/2, h = b − a, length L and the grain's centre at c along the side:
///
/// ```math
/// q(s) = q_0 + (q_1 - q_0)\,s/L, \qquad
/// \int_a^b q\,ds = h\,q(m), \qquad
/// \int_a^b q\,(s - c)\,ds = h\,q(m)\,(m - c) + \frac{q_1 - q_0}{L}\,\frac{h^3}{12}
/// ```
///
/// The normal load has its moment about the centre, e × n times the second integral; the shear load acts through it.
pub fn edge_loads(
    grains: &PerGrain<Grain>,
    parts: &[(GrainId, f64, f64)],
    side: &Side,
    normal: [f64; 2],
    shear: [f64; 2],
) -> Vec<(GrainId, Load)> {
    let along = (side.end - side.start) * (1.0 / side.length());
    let turn = along.cross(side.outward);
    let normal = Linear::new(normal, side.length());
    let shear = Linear::new(shear, side.length());
    let mut loads: BTreeMap<GrainId, Load> = BTreeMap::new();
    for &(grain, from, to) in parts {
        let centre = (grains[grain].centre - side.start).dot(along);
        let force = side.outward * normal.sum(from, to) + along * shear.sum(from, to);
        let load = loads.entry(grain).or_default();
        load.x += force.x;
        load.y += force.y;
        load.moment += turn * normal.first_moment(from, to, centre);
    }
    loads.into_iter().collect()
}

/// A linear distribution along a side.
struct Linear {
    start: f64,
    slope: f64,
}

impl Linear {
    fn new([start, end]: [f64; 2], length: f64) -> Self {
        let slope = (end - start) / length;
        Self { start, slope }
    }

    fn sum(&self, from: f64, to: f64) -> f64 {
        (to - from) * (self.start + self.slope * 0.5 * (from + to))
    }

    fn first_moment(&self, from: f64, to: f64, about: f64) -> f64 {
        let length = to - from;
        let arm = 0.5 * (from + to) - about;
        self.sum(from, to) * arm + self.slope * length * length * length / 12.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;

    const WIDTH: f64 = 7.0;
    const HEIGHT: f64 = 4.0;

    /// The sides of the box: left, right, bottom, top.
    fn sides() -> [Side; 4] {
        let side = |name: &str, start: [f64; 2], end: [f64; 2], outward: [f64; 2]| Side {
            name: name.to_owned(),
            start: Vector::new(start[0], start[1]),
            end: Vector::new(end[0], end[1]),
            outward: Vector::new(outward[0], outward[1]),
            present: false,
        };
        [
            side("left", [0.0, 0.0], [0.0, HEIGHT], [-1.0, 0.0]),
            side("right", [WIDTH, 0.0], [WIDTH, HEIGHT], [1.0, 0.0]),
            side("bottom", [0.0, 0.0], [WIDTH, 0.0], [0.0, -1.0]),
            side("top", [0.0, HEIGHT], [WIDTH, HEIGHT], [0.0, 1.0]),
        ]
    }

    fn grains(centres: &[[f64; 2]]) -> PerGrain<Grain> {
        let grain = |&[x, y]: &[f64; 2]| Grain {
            centre: Vector::new(x, y),
            radius: 1.0,
        };
        centres.iter().map(grain).collect()
    }

    fn close(one: f64, other: f64) -> bool {
        (one - other).abs() < 1e-12
    }

    /// ∫ q·sᵏ ds over [a, b], the k-th moment of the load about the start of the side.
    fn moment_of(q: [f64; 2], length: f64, [a, b]: [f64; 2], k: i32) -> f64 {
        let slope = (q[1] - q[0]) / length;
        let antiderivative = |s: f64| {
            q[0] * s.powi(k + 1) / f64::from(k + 1) + slope * s.powi(k + 2) / f64::from(k + 2)
        };
        antiderivative(b) - antiderivative(a)
    }

    #[test]
    fn force_and_moment_are_exact_over_the_covered_part_of_every_side() {
        let grains = grains(&[[1.2, 0.9], [3.1, 1.8], [5.0, 3.0]]);
        let (normal, shear) = ([-1.5, 0.7], [0.4, -2.0]);
        // The last part lies apart: between 2.6 and 3.0 no grain is met.
        let parts = [
            (GrainId(1), 0.3, 1.0),
            (GrainId(0), 1.0, 1.7),
            (GrainId(1), 1.7, 2.6),
            (GrainId(2), 3.0, 3.8),
        ];
        let covered = [[0.3, 2.6], [3.0, 3.8]];
        for side in sides() {
            let along = (side.end - side.start) * (1.0 / side.length());
            let of = |q, k| -> f64 {
                let whole = |part| moment_of(q, side.length(), part, k);
                covered.into_iter().map(whole).sum()
            };
            let (mut force, mut moment) = (Vector::default(), 0.0);
            let loads = edge_loads(&grains, &parts, &side, normal, shear);
            assert_eq!(loads.len(), 3);
            for (grain, load) in loads {
                force = force + Vector::new(load.x, load.y);
                moment += load.moment;
                // The normal load about the start of the side; shear does not count.
                let arm = (grains[grain].centre - side.start).dot(along);
                let normal_part = side.outward.dot(Vector::new(load.x, load.y));
                moment += arm * along.cross(side.outward) * normal_part;
            }
            let name = &side.name;
            assert!(close(force.dot(side.outward), of(normal, 0)), "{name}");
            assert!(close(force.dot(along), of(shear, 0)), "{name}");
            let turn = along.cross(side.outward);
            assert!(close(moment, turn * of(normal, 1)), "{name}");
        }
    }

    #[test]
    fn a_push_down_right_of_the_centre_turns_clockwise() {
        let [_, right, _, top] = sides();
        let grains = grains(&[[3.0, 2.0]]);
        let uniform =
            |side: &Side, part| edge_loads(&grains, &[part], side, [-2.0, -2.0], [0.0, 0.0])[0].1;
        // Force 2 at x = 3.5, arm ½ to the right; force 2 at y = 2.5, arm ½ upwards.
        let down = uniform(&top, (GrainId(0), 3.0, 4.0));
        assert_eq!((down.x, down.y, down.moment), (0.0, -2.0, -1.0));
        let left = uniform(&right, (GrainId(0), 2.0, 3.0));
        assert_eq!((left.x, left.y, left.moment), (-2.0, 0.0, 1.0));
    }

    #[test]
    fn shear_acts_through_the_centre() {
        let [_, _, _, top] = sides();
        let grains = grains(&[[3.0, 2.0]]);
        let parts = [(GrainId(0), 2.0, 4.0)];
        let load = edge_loads(&grains, &parts, &top, [0.0, 0.0], [1.0, 8.0])[0].1;
        // Value at x = 3: 1 + 7·3/7 = 4, over a length of 2.
        assert!(close(load.x, 8.0));
        assert_eq!((load.y, load.moment), (0.0, 0.0));
    }

    #[test]
    fn a_slope_turns_a_grain_that_is_loaded_evenly_on_both_sides() {
        let [_, _, _, top] = sides();
        let grains = grains(&[[3.0, 2.0]]);
        let parts = [(GrainId(0), 2.0, 4.0)];
        let load = edge_loads(&grains, &parts, &top, [0.0, 7.0], [0.0, 0.0])[0].1;
        // Slope 1 over a length h = 2: h³/12 = 2/3.
        assert!(close(load.moment, 2.0 / 3.0));
        assert!(close(load.y, 6.0));
    }
}
