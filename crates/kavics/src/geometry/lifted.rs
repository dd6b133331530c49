//! Discs lifted to the paraboloid, and the exact sign behind the power diagram.

use geogram_predicates::{Sign, orient_2d, orient_2dlifted};

use crate::geometry::Vector;
use crate::geometry::near_pairs::Disc;

/// Centres with the height h = |x − o|² − R² over each; the lower hull is the regular triangulation (Aurenhammer 1987).
#[derive(Debug)]
pub(super) struct Lifted<'a> {
    centres: &'a [Vector],
    heights: Vec<f64>,
    /// Bound on the rounding error of half a difference of two heights.
    pub(super) noise: f64,
}

impl<'a> Lifted<'a> {
    /// The discs, their centres once more, and the point o.
    pub(super) fn new(discs: &[Disc], centres: &'a [Vector], origin: Vector) -> Self {
        let mut largest = 0.0_f64;
        let height = |disc: &Disc| {
            let (far, own) = (
                (disc.centre - origin).length_squared(),
                disc.radius * disc.radius,
            );
            largest = largest.max(far + own);
            far - own
        };
        Self {
            centres,
            heights: discs.iter().map(height).collect(),
            noise: 8.0 * f64::EPSILON * largest,
        }
    }

    /// Whether `other` lies below the plane through the lifted discs `triangle` (counter-clockwise), so that it
    /// takes their radical centre from them; none where the three do not turn counter-clockwise.
    ///
    /// Exact for the heights as rounded. Ties fall as if each disc were larger by an infinitesimal that is of higher
    /// order for higher numbers (Edelsbrunner & Mücke 1990), so every cell that asks finds the same.
    pub(super) fn hides(&self, triangle: [u32; 3], other: u32) -> Option<bool> {
        let point = |i: u32| {
            let x = self.centres[i as usize];
            [x.x, x.y]
        };
        let height = |i: u32| self.heights[i as usize];
        let [a, b, c] = triangle;
        let (p, q, r, x) = (point(a), point(b), point(c), point(other));
        if !self.noise.is_finite() || orient_2d(&p, &q, &r) != Sign::Positive {
            return None;
        }
        let heights = [height(a), height(b), height(c), height(other)];
        match orient_2dlifted(&p, &q, &r, &x, heights) {
            Sign::Positive => Some(true),
            Sign::Negative => Some(false),
            Sign::Zero => Some(self.tie(triangle, other)),
        }
    }

    /// Whether three discs turn counter-clockwise; exact.
    pub(super) fn turns_left(&self, triangle: [u32; 3]) -> bool {
        let [p, q, r] = triangle.map(|i| {
            let x = self.centres[i as usize];
            [x.x, x.y]
        });
        orient_2d(&p, &q, &r) == Sign::Positive
    }

    fn tie(&self, triangle: [u32; 3], other: u32) -> bool {
        let point = |i: u32| {
            let x = self.centres[i as usize];
            [x.x, x.y]
        };
        let mut by_number = [0, 1, 2];
        by_number.sort_unstable_by_key(|&k| triangle[k]);
        for k in by_number {
            if other < triangle[k] {
                return true;
            }
            // Sign of the barycentric coordinate of `other` at this corner.
            let mut replaced = triangle;
            replaced[k] = other;
            let [p, q, r] = replaced.map(point);
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

    fn lifted<'a>(centres: &'a [Vector], radii: &[f64]) -> Lifted<'a> {
        let disc = |(&centre, &radius): (&Vector, &f64)| Disc {
            centre,
            radius,
            index: 0,
        };
        let discs: Vec<Disc> = centres.iter().zip(radii).map(disc).collect();
        Lifted::new(&discs, centres, Vector::new(1.0, 1.0))
    }

    #[test]
    fn a_large_disc_hides_and_a_small_one_does_not() {
        for (radius, hides) in [(1.1, true), (0.9, false)] {
            let lifted = lifted(&SQUARE, &[1.0, 1.0, 1.0, radius]);
            assert_eq!(lifted.hides([0, 1, 2], 3), Some(hides));
        }
    }

    #[test]
    fn four_equal_discs_of_a_square_have_one_diagonal() {
        let lifted = lifted(&SQUARE, &[1.0; 4]);
        let one = lifted.hides([0, 1, 2], 3).unwrap();
        assert_eq!(lifted.hides([1, 2, 0], 3), Some(one));
        assert_eq!(lifted.hides([0, 2, 3], 1), Some(one));
        assert_eq!(lifted.hides([0, 1, 3], 2), Some(!one));
        assert_eq!(lifted.hides([1, 2, 3], 0), Some(!one));
    }

    #[test]
    fn of_two_equal_discs_in_one_place_the_first_wins() {
        let centres = [SQUARE[0], SQUARE[1], SQUARE[2], SQUARE[1]];
        let lifted = lifted(&centres, &[1.0; 4]);
        assert_eq!(lifted.hides([0, 1, 2], 3), Some(false));
        assert_eq!(lifted.hides([0, 3, 2], 1), Some(true));
    }

    #[test]
    fn three_discs_in_a_row_have_no_radical_centre() {
        let lifted = lifted(&SQUARE, &[1.0; 4]);
        assert_eq!(lifted.hides([0, 2, 1], 3), None);
        assert_eq!(lifted.hides([0, 0, 1], 3), None);
    }
}
