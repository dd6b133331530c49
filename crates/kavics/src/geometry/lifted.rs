//! Discs lifted to the paraboloid, and the exact sign behind the power diagram.

use geogram_predicates::{Sign, orient_2d, orient_2dlifted};
use rayon::prelude::*;

use crate::geometry::Vector;
use crate::geometry::near_pairs::Disc;

/// Centres with the height h = |x − o|² − R² over each; the lower hull is the regular triangulation (Aurenhammer 1987).
#[derive(Debug)]
pub(super) struct Lifted<'a> {
    discs: &'a [Disc],
    /// The point o.
    origin: Vector,
    /// Bound on the rounding error of half a difference of two heights.
    pub(super) noise: f64,
}

impl<'a> Lifted<'a> {
    /// The discs, each known by its place, and the point o.
    pub(super) fn new(discs: &'a [Disc], origin: Vector) -> Self {
        let sizes = discs.par_iter().map(|disc| {
            let far = (disc.centre - origin).length_squared();
            far + disc.radius * disc.radius
        });
        Self {
            discs,
            origin,
            noise: 8.0 * f64::EPSILON * sizes.reduce(|| 0.0, f64::max),
        }
    }

    fn point(&self, disc: u32) -> [f64; 2] {
        let x = self.discs[disc as usize].centre;
        [x.x, x.y]
    }

    fn height(&self, disc: u32) -> f64 {
        let Disc { centre, radius, .. } = self.discs[disc as usize];
        (centre - self.origin).length_squared() - radius * radius
    }

    /// Whether `other` lies below the plane through the lifted discs `triangle` (counter-clockwise), so that it
    /// takes their radical centre from them; none where the three do not turn counter-clockwise.
    ///
    /// Exact for the heights as rounded. Ties fall as if each disc were larger by an infinitesimal that is of higher
    /// order for higher numbers (Edelsbrunner & Mücke 1990), so every cell that asks finds the same.
    pub(super) fn hides(&self, triangle: [u32; 3], other: u32) -> Option<bool> {
        let [a, b, c, other_point] =
            [triangle[0], triangle[1], triangle[2], other].map(|i| self.point(i));
        if !self.noise.is_finite() || orient_2d(&a, &b, &c) != Sign::Positive {
            return None;
        }
        let heights = [triangle[0], triangle[1], triangle[2], other].map(|i| self.height(i));
        match orient_2dlifted(&a, &b, &c, &other_point, heights) {
            Sign::Positive => Some(true),
            Sign::Negative => Some(false),
            Sign::Zero => Some(self.tie(triangle, other)),
        }
    }

    /// Whether three discs turn counter-clockwise; exact.
    pub(super) fn turns_left(&self, triangle: [u32; 3]) -> bool {
        let [p, q, r] = triangle.map(|i| self.point(i));
        orient_2d(&p, &q, &r) == Sign::Positive
    }

    fn tie(&self, triangle: [u32; 3], other: u32) -> bool {
        let mut by_number = [0, 1, 2];
        by_number.sort_unstable_by_key(|&k| triangle[k]);
        for k in by_number {
            if other < triangle[k] {
                return true;
            }
            // Sign of the barycentric coordinate of `other` at this corner.
            let mut replaced = triangle;
            replaced[k] = other;
            let [p, q, r] = replaced.map(|i| self.point(i));
            match orient_2d(&p, &q, &r) {
                Sign::Positive => return false,
                Sign::Negative => return true,
                Sign::Zero => {}
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Vector; 4] = [
        Vector::new(0.0, 0.0),
        Vector::new(2.0, 0.0),
        Vector::new(2.0, 2.0),
        Vector::new(0.0, 2.0),
    ];

    fn discs(centres: &[Vector], radii: &[f64]) -> Vec<Disc> {
        let disc = |((&centre, &radius), index): ((&Vector, &f64), u32)| Disc {
            centre,
            radius,
            index,
        };
        centres.iter().zip(radii).zip(0..).map(disc).collect()
    }

    fn lifted(discs: &[Disc]) -> Lifted<'_> {
        Lifted::new(discs, Vector::new(1.0, 1.0))
    }

    #[test]
    fn a_large_disc_hides_and_a_small_one_does_not() {
        for (radius, hides) in [(1.1, true), (0.9, false)] {
            let discs = discs(&SQUARE, &[1.0, 1.0, 1.0, radius]);
            let lifted = lifted(&discs);
            assert_eq!(lifted.hides([0, 1, 2], 3), Some(hides));
        }
    }

    #[test]
    fn four_equal_discs_of_a_square_have_one_diagonal() {
        let discs = discs(&SQUARE, &[1.0; 4]);
        let lifted = lifted(&discs);
        let one = lifted.hides([0, 1, 2], 3).unwrap();
        assert_eq!(lifted.hides([1, 2, 0], 3), Some(one));
        assert_eq!(lifted.hides([0, 2, 3], 1), Some(one));
        assert_eq!(lifted.hides([0, 1, 3], 2), Some(!one));
        assert_eq!(lifted.hides([1, 2, 3], 0), Some(!one));
    }

    #[test]
    fn of_two_equal_discs_in_one_place_the_first_wins() {
        let centres = [SQUARE[0], SQUARE[1], SQUARE[2], SQUARE[1]];
        let discs = discs(&centres, &[1.0; 4]);
        let lifted = lifted(&discs);
        assert_eq!(lifted.hides([0, 1, 2], 3), Some(false));
        assert_eq!(lifted.hides([0, 3, 2], 1), Some(true));
    }

    #[test]
    fn three_discs_in_a_row_have_no_radical_centre() {
        let discs = discs(&SQUARE, &[1.0; 4]);
        let lifted = lifted(&discs);
        assert_eq!(lifted.hides([0, 2, 1], 3), None);
        assert_eq!(lifted.hides([0, 0, 1], 3), None);
    }
}
