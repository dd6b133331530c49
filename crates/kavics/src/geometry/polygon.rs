//! Convex polygons that are cut by lines, and the part of a disc within one.

use std::f64::consts::PI;

use crate::geometry::{Container, HalfPlane, Vector};

/// A bounded convex polygon, which may be empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygon {
    /// Its corners, counter-clockwise.
    corners: Vec<Vector>,
}

impl From<&Container> for Polygon {
    fn from(container: &Container) -> Self {
        Self::new(container.corners())
    }
}

impl Polygon {
    /// The convex polygon with these corners, counter-clockwise.
    pub fn new(corners: &[Vector]) -> Self {
        Self {
            corners: corners.to_vec(),
        }
    }

    /// The part of it within a half-plane.
    #[must_use]
    pub fn cut(&self, plane: HalfPlane) -> Self {
        let mut corners = Vec::with_capacity(self.corners.len() + 1);
        for (a, b) in self.edges() {
            let (inside, after) = (plane.distance(a), plane.distance(b));
            if inside >= 0.0 {
                corners.push(a);
            }
            if inside * after < 0.0 {
                corners.push(a + (b - a) * (inside / (inside - after)));
            }
        }
        Self { corners }
    }

    /// The part of it from one height y to another, `[length]`.
    #[must_use]
    pub fn between_heights(&self, from: f64, to: f64) -> Self {
        self.between(Vector::new(0.0, 1.0), from, to)
    }

    /// The part of it from one x to another, `[length]`.
    #[must_use]
    pub fn between_widths(&self, from: f64, to: f64) -> Self {
        self.between(Vector::new(1.0, 0.0), from, to)
    }

    fn between(&self, axis: Vector, from: f64, to: f64) -> Self {
        let level = |at: f64, outward: Vector| HalfPlane {
            point: axis * at,
            outward,
        };
        self.cut(level(from, -axis)).cut(level(to, axis))
    }

    /// Area, `[length²]`.
    pub fn area(&self) -> f64 {
        let Some(&origin) = self.corners.first() else {
            return 0.0;
        };
        let twice = |(a, b): (Vector, Vector)| (a - origin).cross(b - origin);
        0.5 * self.edges().map(twice).sum::<f64>()
    }

    /// Lowest and highest y; none of an empty polygon, `[length]`.
    pub fn heights(&self) -> Option<[f64; 2]> {
        extent(self.corners.iter().map(|corner| corner.y))
    }

    /// Smallest and largest x; none of an empty polygon, `[length]`.
    pub fn widths(&self) -> Option<[f64; 2]> {
        extent(self.corners.iter().map(|corner| corner.x))
    }

    /// Area of the part of a disc within it, `[length²]`.
    ///
    /// Along each edge the boundary of that part turns about the centre on the edge itself or on the circle:
    /// triangles where the edge lies in the disc, sectors where it does not, both with the sign of the turn.
    pub fn disc_area(&self, centre: Vector, radius: f64) -> f64 {
        let along = |(a, b): (Vector, Vector)| swept(a - centre, b - centre, radius);
        self.edges().map(along).sum()
    }

    /// Distance of a point from the nearest edge's line, positive inside; infinite without an edge, `[length]`.
    fn depth(&self, point: Vector) -> f64 {
        let distance = |(a, b): (Vector, Vector)| (b - a).cross(point - a) / (b - a).length();
        let distances = self.edges().map(distance);
        // A corner met twice is an edge without direction, which min leaves out.
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Area of the parts of many discs within it, `[length²]`; those clear of its edges are not cut.
    pub fn area_of_discs(&self, discs: impl Iterator<Item = (Vector, f64)>) -> f64 {
        if self.corners.is_empty() {
            return 0.0;
        }
        let part = |(centre, radius): (Vector, f64)| match self.depth(centre) {
            depth if depth >= radius => PI * radius * radius,
            depth if depth <= -radius => 0.0,
            _ => self.disc_area(centre, radius),
        };
        discs.map(part).sum()
    }

    fn edges(&self) -> impl Iterator<Item = (Vector, Vector)> + Clone {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().copied().zip(next.copied())
    }
}

fn extent(values: impl Iterator<Item = f64> + Clone) -> Option<[f64; 2]> {
    Some([values.clone().reduce(f64::min)?, values.reduce(f64::max)?])
}

/// Area that the ray from the centre of a disc sweeps within the disc as its end goes from `a` to `b`.
fn swept(a: Vector, b: Vector, radius: f64) -> f64 {
    let edge = b - a;
    let squared = edge.length_squared();
    if squared == 0.0 {
        return 0.0;
    }
    let foot = -a.dot(edge) / squared;
    let distance = a.cross(edge) / squared.sqrt();
    let half_chord = ((radius - distance) * (radius + distance)).max(0.0) / squared;
    let [enters, leaves] =
        [-1.0, 1.0].map(|sign| (foot + sign * half_chord.sqrt()).clamp(0.0, 1.0));
    let (p, q) = (a + edge * enters, a + edge * leaves);
    sector(a, p, radius) + 0.5 * p.cross(q) + sector(q, b, radius)
}

/// Area of the sector between the directions of `a` and `b`, with the sign of the turn.
fn sector(a: Vector, b: Vector, radius: f64) -> f64 {
    0.5 * radius * radius * libm::atan2(a.cross(b), a.dot(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn polygon(corners: &[[f64; 2]]) -> Polygon {
        let corners: Vec<Vector> = corners.iter().map(|c| Vector::new(c[0], c[1])).collect();
        Polygon::new(&corners)
    }

    fn square() -> Polygon {
        polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    }

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-14
    }

    #[test]
    fn a_square_is_cut_along_its_diagonal() {
        let below = HalfPlane {
            point: Vector::new(0.0, 0.0),
            outward: Vector::new(-1.0, 1.0) * 0.5_f64.sqrt(),
        };
        let half = square().cut(below);
        assert_eq!(half.area(), 2.0);
        assert_eq!(half.heights(), Some([0.0, 2.0]));
        assert_eq!(square().between_heights(0.5, 1.0).area(), 1.0);
        assert_eq!(square().between_heights(3.0, 4.0), Polygon::default());
        assert_eq!(Polygon::default().area(), 0.0);
    }

    #[test]
    fn a_disc_is_cut_by_edges_and_corners() {
        let area = |x, y, r| square().disc_area(Vector::new(x, y), r);
        // Inside, on an edge, at a corner, around all of it, clear of it, touching from outside.
        assert!(near(area(1.0, 1.0, 1.0), PI));
        assert!(near(area(1.0, 0.0, 1.0), PI / 2.0));
        assert!(near(area(0.0, 0.0, 1.0), PI / 4.0));
        assert!(near(area(1.0, 1.0, 9.0), 4.0));
        assert!(near(area(5.0, 5.0, 1.0), 0.0));
        assert!(near(area(3.0, 1.0, 1.0), 0.0));
        // A cap of height ½ of the unit disc: π/3 − √3/4.
        let cap = PI / 3.0 - 3.0_f64.sqrt() / 4.0;
        assert!(near(area(1.0, -0.5, 1.0), cap));
    }

    proptest! {
        #[test]
        fn the_parts_on_both_sides_of_a_cut_are_the_disc(
            x in -1.0..3.0_f64, y in -1.0..3.0_f64, radius in 0.01..2.0_f64, height in 0.0..2.0_f64,
        ) {
            let area = |part: Polygon| part.area_of_discs([(Vector::new(x, y), radius)].into_iter());
            let parts = area(square().between_heights(0.0, height))
                + area(square().between_heights(height, 2.0));
            prop_assert!((parts - area(square())).abs() < 1e-13);
            let far = polygon(&[[-9.0, -9.0], [9.0, -9.0], [0.0, 19.0]]);
            prop_assert!((area(far) - PI * radius * radius).abs() < 1e-13);
        }
    }
}
