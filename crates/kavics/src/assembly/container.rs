//! The rectangular box, and grains that do not fit: into it, or beside each other.

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
