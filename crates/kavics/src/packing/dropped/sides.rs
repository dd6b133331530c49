//! The sides of a container as a falling grain meets them: lines that its centre keeps a radius away from.

use crate::geometry::{Container, HalfPlane, Vector};
use crate::ids::SideId;
use crate::packing::random::Stream;
use crate::packing::{PackingError, Shape, Support, check_box};

/// Where grains come from.
enum Opening {
    /// From above, onto the whole of a width.
    Sky { width: f64 },
    /// From the upper sides of the polygon with these corners.
    Polygon(Vec<Vector>),
}

/// The sides of a container.
pub(super) struct Sides {
    lines: Vec<HalfPlane>,
    opening: Opening,
}

impl Sides {
    /// The sides of a container for grains up to `largest`.
    ///
    /// # Errors
    /// A width that is not positive, a grain that does not fit.
    pub(super) fn new(shape: &Shape, largest: f64) -> Result<Self, PackingError> {
        let diameter = 2.0 * largest;
        let sides = match shape {
            &Shape::Box { width } => {
                check_box(width)?;
                if diameter > width {
                    return Err(PackingError::BoxTooNarrow { diameter, width });
                }
                Self::of_box(width)
            }
            Shape::Polygon(container) => Self::of_polygon(container),
        };
        if sides.range(largest).is_none() {
            return Err(PackingError::ContainerTooNarrow { diameter });
        }
        Ok(sides)
    }

    fn of_box(width: f64) -> Self {
        let line = |x, outward: (f64, f64)| HalfPlane {
            point: Vector::new(x, 0.0),
            outward: Vector::new(outward.0, outward.1),
        };
        Self {
            lines: vec![
                line(0.0, (-1.0, 0.0)),
                line(width, (1.0, 0.0)),
                line(0.0, (0.0, -1.0)),
            ],
            opening: Opening::Sky { width },
        }
    }

    fn of_polygon(container: &Container) -> Self {
        Self {
            lines: container.sides().to_vec(),
            opening: Opening::Polygon(container.corners().to_vec()),
        }
    }

    /// The name of a side as a support.
    pub(super) fn support(&self, side: usize) -> Support {
        match (&self.opening, side) {
            (Opening::Polygon(_), _) => Support::Side(SideId(side as u32)),
            (Opening::Sky { .. }, 0) => Support::Left,
            (Opening::Sky { .. }, 1) => Support::Right,
            (Opening::Sky { .. }, _) => Support::Floor,
        }
    }

    /// The unit normal of a side that leaves the container.
    pub(super) fn outward(&self, side: usize) -> Vector {
        self.lines[side].outward
    }

    /// The lowest and the highest abscissa of the container.
    pub(super) fn extent(&self) -> [f64; 2] {
        match &self.opening {
            &Opening::Sky { width } => [0.0, width],
            Opening::Polygon(corners) => abscissas(corners),
        }
    }

    /// The abscissas at which a grain fits, from the lowest to the highest.
    fn range(&self, radius: f64) -> Option<[f64; 2]> {
        match &self.opening {
            &Opening::Sky { width } => Some([radius, radius + (width - 2.0 * radius)]),
            Opening::Polygon(corners) => {
                let mut inset = corners.clone();
                for line in &self.lines {
                    let line = HalfPlane {
                        point: line.point - line.outward * radius,
                        ..*line
                    };
                    inset = clipped(&inset, &line);
                }
                (!inset.is_empty()).then(|| abscissas(&inset))
            }
        }
    }

    /// A random place for a grain to fall from: as high as it fits in at its abscissa.
    pub(super) fn start(&self, radius: f64, positions: &mut Stream) -> Vector {
        let unit = positions.unit();
        let polygon = match &self.opening {
            &Opening::Sky { width } => {
                return Vector::new(radius + (width - 2.0 * radius) * unit, f64::INFINITY);
            }
            Opening::Polygon(corners) => corners,
        };
        // The largest grain fits, so every other does.
        let [low, high] = self.range(radius).unwrap_or_else(|| abscissas(polygon));
        let x = low + (high - low) * unit;
        let above = self.lines.iter().filter(|line| line.outward.y > 0.0);
        let heights = above.map(|line| height(line, radius, x));
        Vector::new(x, heights.fold(f64::INFINITY, f64::min))
    }

    /// Where a grain that falls at x lands on a side, and on which.
    pub(super) fn landing(&self, x: f64, radius: f64) -> (f64, usize) {
        let mut highest = (f64::NEG_INFINITY, 0);
        for (side, line) in self.lines.iter().enumerate() {
            if line.outward.y < 0.0 {
                let y = height(line, radius, x);
                if y > highest.0 {
                    highest = (y, side);
                }
            }
        }
        highest
    }

    /// Where the centre of a grain that rolls at distance `reach` from `base` to the side σ comes to touch each side:
    /// (u, v) relative to the base, u along the roll, v up.
    ///
    /// With o the outward normal and h the distance of the base from the line that the centre may not pass,
    /// (u, v) = h·o + √(reach² − h²)·o⊥, o⊥ being o turned against the roll.
    pub(super) fn stops_of_roll(
        &self,
        base: Vector,
        reach: f64,
        radius: f64,
        direction: f64,
    ) -> impl Iterator<Item = (usize, [f64; 2])> {
        let stop = move |(side, line): (usize, &HalfPlane)| {
            let distance = (touching(line, radius) - base).dot(line.outward);
            if distance >= reach {
                return None;
            }
            let (ou, ov) = (direction * line.outward.x, line.outward.y);
            let half_chord = (reach * reach - distance * distance).max(0.0).sqrt();
            let place = [
                distance * ou - half_chord * ov,
                distance * ov + half_chord * ou,
            ];
            Some((side, place))
        };
        self.lines.iter().enumerate().filter_map(stop)
    }

    /// How far a grain slides down along a side until it touches the next, and which that is.
    pub(super) fn end_of_slide(
        &self,
        start: Vector,
        radius: f64,
        side: usize,
        along: Vector,
    ) -> (f64, Option<usize>) {
        let mut end = (f64::INFINITY, None);
        for (other, line) in self.lines.iter().enumerate() {
            let approach = along.dot(line.outward);
            if other != side && approach > 0.0 {
                let way = (touching(line, radius) - start).dot(line.outward) / approach;
                if way < end.0 {
                    end = (way.max(0.0), Some(other));
                }
            }
        }
        end
    }

    /// The place beside `centre` where a grain touches a side to the last bits.
    pub(super) fn touch(&self, centre: Vector, radius: f64, side: usize) -> Vector {
        let line = &self.lines[side];
        centre + line.outward * (touching(line, radius) - centre).dot(line.outward)
    }
}

/// A point of the line on which the centre of a grain lies that touches a side.
fn touching(line: &HalfPlane, radius: f64) -> Vector {
    line.point - line.outward * radius
}

/// Height of the centre of a grain that touches a side at the abscissa x.
fn height(line: &HalfPlane, radius: f64, x: f64) -> f64 {
    let point = touching(line, radius);
    point.y - (x - point.x) * line.outward.x / line.outward.y
}

fn abscissas(corners: &[Vector]) -> [f64; 2] {
    let start = [f64::INFINITY, f64::NEG_INFINITY];
    corners.iter().fold(start, |[low, high], corner| {
        [low.min(corner.x), high.max(corner.x)]
    })
}

/// The part of a convex polygon in a half-plane, by its corners.
pub(super) fn clipped(corners: &[Vector], line: &HalfPlane) -> Vec<Vector> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (&from, &to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let (a, b) = (line.distance(from), line.distance(to));
        if a >= 0.0 {
            kept.push(from);
        }
        if (a < 0.0) != (b < 0.0) {
            kept.push(from + (to - from) * (a / (a - b)));
        }
    }
    kept
}
