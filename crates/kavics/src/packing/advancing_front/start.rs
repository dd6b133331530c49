//! How an advancing front starts: where the middle of a container is, and the first two grains there.

use std::collections::BinaryHeap;

use crate::assembly::Grain;
use crate::geometry::{Container, Vector};
use crate::packing::PackingError;
use crate::packing::advancing_front::cells::Cells;
use crate::packing::advancing_front::front::Front;
use crate::packing::random::{Purpose, stream};

/// Width of a ring in mean diameters, or in quarters of the largest if that is more.
const RING_WIDTH: f64 = 16.0;
/// What is rounding, in units in the last place of the farthest coordinate.
const ROUNDING: f64 = 8.0;
/// Overlap that is allowed besides, over the smallest radius: so that crystals of equal grains stay in touch, where
/// rounding adds up from grain to grain.
const OVERLAP: f64 = 1e-10;

/// A front of the first two grains, or of one where there is no room beside it.
pub(super) fn start<'a>(
    container: &'a Container,
    radii: &[f64],
    seed: u64,
) -> Result<Front<'a>, PackingError> {
    let (mut smallest, mut largest, mut sum) = (f64::INFINITY, 0.0_f64, 0.0);
    for &radius in radii {
        (smallest, largest, sum) = (smallest.min(radius), largest.max(radius), sum + radius);
    }
    let corners = container.corners();
    let farthest = corners
        .iter()
        .fold(0.0_f64, |m, c| m.max(c.x.abs()).max(c.y.abs()));
    let rounding = ROUNDING * f64::EPSILON * farthest;
    let middle = middle(container, largest, rounding)?;
    let region = region(container, middle, radii);
    let mut front = Front {
        container,
        middle,
        cells: Cells::new(region, radii, rounding + OVERLAP * smallest),
        rounding,
        usual: sum / radii.len() as f64,
        smallest,
        ring_width: RING_WIDTH * (2.0 * sum / radii.len() as f64).max(0.5 * largest),
        pockets: BinaryHeap::new(),
    };
    let pair = first_pair(&front, radii, seed);
    for grain in pair {
        front.cells.push(grain);
    }
    if front.cells.count() == 2 {
        front.open(0, 1);
        front.open(1, 0);
    }
    Ok(front)
}

/// The first two grains, side by side in the middle in a random direction, or along a side or towards a corner.
fn first_pair(front: &Front, radii: &[f64], seed: u64) -> Vec<Grain> {
    let (container, middle) = (front.container, front.middle);
    let along = container
        .sides()
        .iter()
        .map(|side| side.outward.quarter_turn());
    let to_corners = container.corners().iter().map(|&corner| corner - middle);
    let mut directions = vec![random_direction(seed)];
    directions.extend(along.chain(to_corners));
    let first = Grain {
        centre: middle,
        radius: radii[0],
    };
    let Some(&radius) = radii.get(1) else {
        return vec![first];
    };
    for direction in directions {
        let unit = direction * (1.0 / direction.length());
        for shift in [radius, 0.0] {
            let centre = middle - unit * shift;
            let one = Grain { centre, ..first };
            let centre = centre + unit * (first.radius + radius);
            let other = Grain { centre, radius };
            if front.is_inside(one) && front.is_inside(other) {
                return vec![one, other];
            }
        }
    }
    vec![first]
}

/// A direction, all equally likely: a point of the square that lies in its circle.
fn random_direction(seed: u64) -> Vector {
    let mut stream = stream(seed, Purpose::Positions);
    loop {
        let point = Vector::new(2.0 * stream.unit() - 1.0, 2.0 * stream.unit() - 1.0);
        if (0.01..1.0).contains(&point.length_squared()) {
            return point;
        }
    }
}

/// Where a pack starts: the centroid, or the deepest point where the centroid is too near to a side.
fn middle(container: &Container, largest: f64, rounding: f64) -> Result<Vector, PackingError> {
    let centroid = centroid(container);
    if container.depth(centroid) >= 2.0 * largest {
        return Ok(centroid);
    }
    let deepest = deepest(container);
    let depth = container.depth(deepest);
    if depth >= largest - rounding {
        return Ok(deepest);
    }
    Err(PackingError::ContainerTooNarrow {
        diameter: 2.0 * largest,
    })
}

fn centroid(container: &Container) -> Vector {
    let corners = container.corners();
    let (origin, next) = (corners[0], corners.iter().cycle().skip(1));
    let (mut moment, mut twice_area) = (Vector::default(), 0.0);
    for (&a, &b) in corners.iter().zip(next) {
        let (a, b) = (a - origin, b - origin);
        moment = moment + (a + b) * a.cross(b);
        twice_area += a.cross(b);
    }
    origin + moment * (1.0 / (3.0 * twice_area))
}

/// The point farthest from all sides, by trisection, as the depth is a concave function of x and of y.
fn deepest(container: &Container) -> Vector {
    let [low, high] = extent(container);
    let highest = |x: f64| {
        let depth = |y: f64| container.depth(Vector::new(x, y));
        let y = summit([low.y, high.y], depth);
        (y, depth(y))
    };
    let x = summit([low.x, high.x], |x| highest(x).1);
    Vector::new(x, highest(x).0)
}

/// Where a concave function of a number is largest.
fn summit([mut low, mut high]: [f64; 2], value: impl Fn(f64) -> f64) -> f64 {
    // (2/3)^100 is below the rounding of the interval.
    for _ in 0..100 {
        let third = (high - low) / 3.0;
        let (left, right) = (low + third, high - third);
        let (at_left, at_right) = (value(left), value(right));
        if at_left <= at_right {
            low = left;
        }
        if at_right <= at_left {
            high = right;
        }
    }
    low.midpoint(high)
}

fn extent(container: &Container) -> [Vector; 2] {
    let corners = container.corners().iter();
    corners.fold([container.corners()[0]; 2], |[low, high], c| {
        [
            Vector::new(low.x.min(c.x), low.y.min(c.y)),
            Vector::new(high.x.max(c.x), high.y.max(c.y)),
        ]
    })
}

/// A square about the middle that holds the pack, or nearly, within the extent of the container.
fn region(container: &Container, middle: Vector, radii: &[f64]) -> [Vector; 2] {
    let [low, high] = extent(container);
    let needed = 5.0 * radii.iter().map(|r| r * r).sum::<f64>();
    let mut half = needed.sqrt();
    let size = container.size();
    while half < size && area_within(container, middle, half) < needed {
        half *= 2.0;
    }
    [
        Vector::new(low.x.max(middle.x - half), low.y.max(middle.y - half)),
        Vector::new(high.x.min(middle.x + half), high.y.min(middle.y + half)),
    ]
}

/// Area of the container in a square about a point, by a raster.
fn area_within(container: &Container, middle: Vector, half: f64) -> f64 {
    const LINES: u32 = 64;
    let at = |k: u32| half * (f64::from(2 * k + 1) / f64::from(LINES) - 1.0);
    let points = (0..LINES * LINES).map(|k| Vector::new(at(k % LINES), at(k / LINES)));
    let inside = points
        .filter(|&p| container.depth(middle + p) >= 0.0)
        .count();
    inside as f64 * 4.0 * half * half / f64::from(LINES * LINES)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Container {
        // Legs 3 and 4: the inscribed circle has radius (3 + 4 − 5)/2 = 1.
        Container::polygon(&[(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)].map(|(x, y)| Vector::new(x, y)))
    }

    #[test]
    fn the_deepest_point_of_a_triangle_is_the_centre_of_its_inscribed_circle() {
        let deepest = deepest(&triangle());
        assert!((deepest - Vector::new(1.0, 1.0)).length() < 1e-14);
    }

    #[test]
    fn the_centroid_of_a_triangle_is_the_mean_of_its_corners() {
        let centroid = centroid(&triangle());
        assert!((centroid - Vector::new(4.0 / 3.0, 1.0)).length() < 1e-15);
    }

    #[test]
    fn a_raster_measures_the_container_in_a_square() {
        let area = area_within(&triangle(), Vector::new(0.0, 0.0), 1.0);
        // Of the square of side 2 about the right angle a quarter is inside.
        assert_eq!(area, 1.0);
        let area = area_within(&triangle(), Vector::new(0.0, 0.0), 8.0);
        assert!((area - 6.0).abs() < 0.5, "{area}");
    }
}
