//! A convex container: the half-planes it is the intersection of.

use std::cmp::Ordering;

use crate::geometry::Vector;

/// A half-plane: all points behind a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfPlane {
    /// A point on the line.
    pub point: Vector,
    /// Unit normal that leaves the half-plane.
    pub outward: Vector,
}

impl HalfPlane {
    /// Distance of a point from the line, positive inside.
    pub fn distance(&self, point: Vector) -> f64 {
        (self.point - point).dot(self.outward)
    }
}

/// A bounded convex polygon as the intersection of half-planes, each of which bears a side.
#[derive(Clone, Debug)]
pub struct Container {
    /// The sides as they were given.
    pub(super) sides: Vec<HalfPlane>,
    /// Their numbers, counter-clockwise.
    pub(super) around: Vec<u32>,
    /// The corner where each side of `around` starts.
    pub(super) corners: Vec<Vector>,
}

impl Container {
    /// The container with these sides, in any order.
    pub fn new(sides: &[HalfPlane]) -> Self {
        let mut around: Vec<u32> = (0..sides.len() as u32).collect();
        around.sort_by(|&a, &b| by_angle(sides[a as usize].outward, sides[b as usize].outward));
        let corner = |k: usize| {
            let before = around[(k + around.len() - 1) % around.len()];
            meeting(sides[before as usize], sides[around[k] as usize])
        };
        let corners = (0..around.len()).map(corner).collect();
        Self {
            sides: sides.to_vec(),
            around,
            corners,
        }
    }

    /// The convex polygon with these corners, counter-clockwise; side k runs from corner k to the next.
    ///
    /// Three corners at least, none on the line through its neighbours: the scene checks it.
    pub fn polygon(corners: &[Vector]) -> Self {
        let next = corners.iter().cycle().skip(1);
        let side = |(&start, &end): (&Vector, &Vector)| HalfPlane {
            point: start,
            outward: -(end - start).quarter_turn() * (1.0 / (end - start).length()),
        };
        Self::new(&corners.iter().zip(next).map(side).collect::<Vec<_>>())
    }

    /// The sides as they were given.
    pub fn sides(&self) -> &[HalfPlane] {
        &self.sides
    }

    /// The corners, counter-clockwise.
    pub fn corners(&self) -> &[Vector] {
        &self.corners
    }

    /// Area, `[length²]`.
    pub fn area(&self) -> f64 {
        let (origin, next) = (self.corners[0], self.corners.iter().cycle().skip(1));
        let pairs = self.corners.iter().zip(next);
        let twice: f64 = pairs.map(|(&a, &b)| (a - origin).cross(b - origin)).sum();
        0.5 * twice
    }

    /// Distance of a point from the nearest side, positive inside, `[length]`.
    pub fn depth(&self, point: Vector) -> f64 {
        let distances = self.sides.iter().map(|side| side.distance(point));
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Largest extent along an axis, `[length]`.
    pub fn size(&self) -> f64 {
        let (low, high) = super::spatial_order::extent(self.corners.iter().copied());
        (high.x - low.x).max(high.y - low.y)
    }

    /// The power of two just below the size: as unit of length it is exact, and no product can overflow.
    pub fn unit(&self) -> f64 {
        let unit = f64::from_bits(self.size().to_bits() & (0x7ff << 52));
        if unit.is_normal() { unit } else { 1.0 }
    }

    /// The middle of the extents.
    pub(super) fn middle(&self) -> Vector {
        let (low, high) = super::spatial_order::extent(self.corners.iter().copied());
        (low + high) * 0.5
    }

    /// The same container with every length times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let scaled = |side: &HalfPlane| HalfPlane {
            point: side.point * factor,
            outward: side.outward,
        };
        Self::new(&self.sides.iter().map(scaled).collect::<Vec<_>>())
    }
}

/// Order of directions counter-clockwise from the positive x axis.
fn by_angle(a: Vector, b: Vector) -> Ordering {
    let lower_half = |v: Vector| v.y < 0.0 || (v.y == 0.0 && v.x < 0.0);
    lower_half(a)
        .cmp(&lower_half(b))
        .then_with(|| 0.0_f64.total_cmp(&(a.cross(b) + 0.0)))
}

/// The point where the lines of two half-planes meet.
fn meeting(a: HalfPlane, b: HalfPlane) -> Vector {
    let offset = (b.point - a.point).dot(b.outward);
    let along = a.outward.quarter_turn();
    a.point + along * (offset / along.dot(b.outward))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_has_half_the_area_of_its_square() {
        let corners = [(1.0, 1.0), (3.0, 1.0), (1.0, 3.0)].map(|(x, y)| Vector::new(x, y));
        let triangle = Container::polygon(&corners);
        assert_eq!(triangle.area(), 2.0);
        assert_eq!(triangle.sides()[0].outward, Vector::new(0.0, -1.0));
        assert_eq!(triangle.depth(Vector::new(1.25, 2.0)), 0.25);
        assert_eq!(triangle.depth(Vector::new(0.0, 2.0)), -1.0);
    }

    #[test]
    fn a_box_is_put_in_order() {
        let side = |x, y, nx, ny| HalfPlane {
            point: Vector::new(x, y),
            outward: Vector::new(nx, ny),
        };
        let container = Container::new(&[
            side(0.0, 0.0, -1.0, 0.0),
            side(4.0, 0.0, 1.0, 0.0),
            side(0.0, 0.0, 0.0, -1.0),
            side(0.0, 3.0, 0.0, 1.0),
        ]);
        assert_eq!(container.around, [1, 3, 0, 2]);
        assert_eq!(container.corners[0], Vector::new(4.0, 0.0));
        assert_eq!(container.corners[2], Vector::new(0.0, 3.0));
        assert_eq!(container.size(), 4.0);
        assert_eq!(container.middle(), Vector::new(2.0, 1.5));
    }
}
