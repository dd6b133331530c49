//! Which side of the container has which number: `run.json` keeps the corners of the container alone.

use kavics::assembly::{Side, box_sides, polygon_sides};
use kavics::geometry::Vector;
use kavics::ids::PerSide;

/// The names of the sides of a box, in the order of their numbers.
const BOX: [&str; 4] = ["left", "right", "bottom", "top"];

/// A side that grains touch: its number, and its outward normal.
pub(crate) type Touched = (usize, Vector);

/// The sides of the container with these corners, counter-clockwise, by their numbers.
///
/// The sides of a box are known by their names. Those of a polygon run from corner to corner of the scene, which may
/// start anywhere and go round in either sense: the numbers are those that agree best with the normals of `touched`.
pub(crate) fn sides(corners: &[Vector], names: &[&str], touched: &[Touched]) -> PerSide<Side> {
    let is_present = |name: &str| names.contains(&name);
    if corners.len() == 4 && names.iter().all(|name| BOX.contains(name)) && is_axial(corners) {
        return box_between(corners, BOX.map(is_present));
    }
    let orders = (0..corners.len()).flat_map(|start| [(start, false), (start, true)]);
    let best = orders
        .map(|(start, backward)| turned(corners, start, backward, &is_present))
        .min_by(|a, b| mismatch(a, touched).total_cmp(&mismatch(b, touched)));
    best.unwrap_or_default()
}

/// Whether all sides of a polygon lie along the axes.
fn is_axial(corners: &[Vector]) -> bool {
    let next = corners.iter().cycle().skip(1);
    corners
        .iter()
        .zip(next)
        .all(|(a, b)| a.x == b.x || a.y == b.y)
}

/// A box has its lower left corner at the origin.
fn box_between(corners: &[Vector], present: [bool; 4]) -> PerSide<Side> {
    let width = corners.iter().map(|corner| corner.x).fold(0.0, f64::max);
    let height = corners.iter().map(|corner| corner.y).fold(0.0, f64::max);
    box_sides(width, height, present)
}

fn turned(
    corners: &[Vector],
    start: usize,
    backward: bool,
    is_present: &impl Fn(&str) -> bool,
) -> PerSide<Side> {
    let mut corners = corners.to_vec();
    corners.rotate_left(start);
    if backward {
        corners.reverse();
    }
    let present: Vec<bool> = (0..corners.len())
        .map(|side| is_present(&side.to_string()))
        .collect();
    polygon_sides(&corners, &present)
}

/// How far the normals of the touched sides are from those that grains met.
fn mismatch(sides: &PerSide<Side>, touched: &[Touched]) -> f64 {
    let of_side = |&(number, normal): &Touched| match sides.values().get(number) {
        Some(side) => (side.outward - normal).length(),
        None => f64::INFINITY,
    };
    touched.iter().map(of_side).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(points: &[(f64, f64)]) -> Vec<Vector> {
        points.iter().map(|&(x, y)| Vector::new(x, y)).collect()
    }

    #[test]
    fn a_box_is_known_by_its_names() {
        let container = corners(&[(4.0, 0.0), (4.0, 3.0), (0.0, 3.0), (0.0, 0.0)]);
        let sides = sides(&container, &["left", "top"], &[]);
        let present: Vec<bool> = sides.values().iter().map(|side| side.present).collect();
        assert_eq!(present, [true, false, false, true]);
        assert_eq!(sides.values()[1].start, Vector::new(4.0, 0.0));
    }

    #[test]
    fn the_sides_of_a_polygon_are_known_by_the_normals_of_what_touches_them() {
        let given = corners(&[(0.0, 0.0), (4.0, 0.0), (1.0, 3.0)]);
        for backward in [false, true] {
            let mut given = given.clone();
            if backward {
                given.reverse();
            }
            let expected = polygon_sides(&given, &[true, true, false]);
            let touched: Vec<Touched> = (0..2).map(|k| (k, expected.values()[k].outward)).collect();
            let mut stored = corners(&[(4.0, 0.0), (1.0, 3.0), (0.0, 0.0)]);
            stored.rotate_left(1);
            let found = sides(&stored, &["0", "1"], &touched);
            assert_eq!(found.values(), expected.values());
        }
    }
}
