//! The sides of a container, and grains that do not fit: into it, or beside each other.

use crate::assembly::{Grain, Side};
use crate::geometry::{Grid, Vector};
use crate::ids::{GrainId, PerGrain, PerSide, SideId};

/// The sides left, right, bottom, top of the box from (0, 0) to (`width`, `height`), `[length]`.
pub fn box_sides(width: f64, height: f64, present: [bool; 4]) -> PerSide<Side> {
    let (w, h) = (width, height);
    let sides = [
        ("left", (0.0, 0.0), (0.0, h), (-1.0, 0.0)),
        ("right", (w, 0.0), (w, h), (1.0, 0.0)),
        ("bottom", (0.0, 0.0), (w, 0.0), (0.0, -1.0)),
        ("top", (0.0, h), (w, h), (0.0, 1.0)),
    ];
    let vector = |(x, y)| Vector::new(x, y);
    let side = |((name, start, end, outward), present): ((&str, _, _, _), bool)| Side {
        name: name.to_owned(),
        start: vector(start),
        end: vector(end),
        outward: vector(outward),
        present,
    };
    sides.into_iter().zip(present).map(side).collect()
}

/// The sides of the convex polygon with these corners, `[length]`: side k runs from corner k to the next one.
///
/// The corners may go round in either sense; names are the numbers of the sides.
pub fn polygon_sides(corners: &[Vector], present: &[bool]) -> PerSide<Side> {
    let inside_left = twice_area(corners) > 0.0;
    let next = corners.iter().cycle().skip(1);
    let ends = corners.iter().zip(next).zip(present).enumerate();
    let side = |(number, ((&start, &end), &present)): (usize, ((&Vector, &Vector), &bool))| {
        let (along, length) = (end - start, (end - start).length());
        let left = along.quarter_turn();
        let outward = if inside_left { -left } else { left };
        Side {
            name: number.to_string(),
            start,
            end,
            outward: Vector::new(outward.x / length, outward.y / length),
            present,
        }
    };
    ends.map(side).collect()
}

/// Twice the area of a polygon, positive where its corners go round counter-clockwise, `[length²]`.
pub fn twice_area(corners: &[Vector]) -> f64 {
    let Some(&origin) = corners.first() else {
        return 0.0;
    };
    let next = corners.iter().cycle().skip(1);
    let pairs = corners.iter().zip(next);
    pairs.map(|(&a, &b)| (a - origin).cross(b - origin)).sum()
}

/// The middle of the extents of a container, `[length]`.
pub fn middle(sides: &PerSide<Side>) -> Vector {
    let [low, high] = extents(
        sides
            .values()
            .iter()
            .flat_map(|side| [side.start, side.end]),
    );
    (low + high) * 0.5
}

/// Lowest and highest coordinates of some points, `[length]`.
pub fn extents(points: impl IntoIterator<Item = Vector>) -> [Vector; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY].map(|v| Vector::new(v, v));
    points.into_iter().fold(none, |[low, high], p| {
        [
            Vector::new(low.x.min(p.x), low.y.min(p.y)),
            Vector::new(high.x.max(p.x), high.y.max(p.y)),
        ]
    })
}

/// Pairs of grains that overlap by more than `tolerance`, and by how much, deepest first, `[length]`.
pub fn overlaps(grains: &PerGrain<Grain>, tolerance: f64) -> Vec<(GrainId, GrainId, f64)> {
    let centres: Vec<Vector> = grains.values().iter().map(|g| g.centre).collect();
    let radii: Vec<f64> = grains.values().iter().map(|g| g.radius).collect();
    let near = Grid::new(&centres, &radii).near_pairs(-tolerance);
    let pairs = near.iter().filter(|p| -p.gap > tolerance);
    let mut pairs: Vec<_> = pairs
        .map(|p| (GrainId(p.first), GrainId(p.second), -p.gap))
        .collect();
    pairs.sort_by(|a, b| b.2.total_cmp(&a.2));
    pairs
}

/// Grains that reach beyond a side by more than `tolerance`, and by how much, farthest first, `[length]`.
///
/// Absent sides count too: they bound the dual graph.
pub fn outside(
    grains: &PerGrain<Grain>,
    sides: &PerSide<Side>,
    tolerance: f64,
) -> Vec<(GrainId, SideId, f64)> {
    let mut beyond = Vec::new();
    for (grain, &Grain { centre, radius }) in grains.iter() {
        for (id, side) in sides.iter() {
            let depth = radius - side.distance(centre);
            if depth > tolerance {
                beyond.push((grain, id, depth));
            }
        }
    }
    beyond.sort_by(|a, b| b.2.total_cmp(&a.2));
    beyond
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grains(discs: &[(f64, f64, f64)]) -> PerGrain<Grain> {
        let grain = |&(x, y, radius): &(f64, f64, f64)| Grain {
            centre: Vector::new(x, y),
            radius,
        };
        discs.iter().map(grain).collect()
    }

    #[test]
    fn normals_leave_the_box() {
        let sides = box_sides(4.0, 3.0, [true, false, true, false]);
        let middle = Vector::new(2.0, 1.5);
        let distances: Vec<f64> = sides.values().iter().map(|s| s.distance(middle)).collect();
        assert_eq!(distances, [2.0, 2.0, 1.5, 1.5]);
        assert_eq!(sides[SideId(3)].length(), 4.0);
        assert!(!sides[SideId(1)].present);
    }

    #[test]
    fn a_polygon_has_the_same_sides_whichever_way_it_goes_round() {
        let corners = [(1.0, 1.0), (5.0, 1.0), (1.0, 4.0)].map(|(x, y)| Vector::new(x, y));
        let sides = polygon_sides(&corners, &[true, false, true]);
        let point = Vector::new(2.0, 2.0);
        let distances = |sides: &PerSide<Side>| -> Vec<f64> {
            sides.values().iter().map(|s| s.distance(point)).collect()
        };
        let is_one = |distance: &f64| (distance - 1.0).abs() < 1e-15;
        // The long side is 3x + 4y = 19: distance (19 − 14)/5.
        assert!(distances(&sides).iter().all(is_one));
        assert_eq!(sides[SideId(1)].name, "1");
        assert!(sides[SideId(2)].present && !sides[SideId(1)].present);
        assert_eq!(middle(&sides), Vector::new(3.0, 2.5));
        let back = [corners[0], corners[2], corners[1]];
        let back = polygon_sides(&back, &[true; 3]);
        assert!(distances(&back).iter().all(is_one));
    }

    #[test]
    fn the_deepest_overlap_comes_first() {
        let row = grains(&[(1.0, 1.0, 1.0), (2.75, 1.0, 1.0), (4.25, 1.0, 1.0)]);
        let found = overlaps(&row, 1e-9);
        assert_eq!(
            found,
            [
                (GrainId(1), GrainId(2), 0.5),
                (GrainId(0), GrainId(1), 0.25)
            ]
        );
        assert_eq!(overlaps(&row, 0.25).len(), 1);
    }

    #[test]
    fn a_grain_in_a_corner_is_outside_of_two_sides() {
        let sides = box_sides(4.0, 4.0, [false; 4]);
        let found = outside(&grains(&[(0.5, 3.25, 1.0), (2.0, 2.0, 1.0)]), &sides, 1e-9);
        assert_eq!(
            found,
            [(GrainId(0), SideId(0), 0.5), (GrainId(0), SideId(3), 0.25)]
        );
    }
}
