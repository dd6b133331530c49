//! Invariants of packs that are dropped into convex polygons.

use kavics::assembly::Grain;
use kavics::geometry::{Container, Grid, Vector};
use kavics::ids::{GrainId, Id};
use kavics::packing::dropped::{drop, fill};
use kavics::packing::statistics::packing_fraction;
use kavics::packing::{Bed, Dropped, PackingError, Shape, Sizes, Support};
use proptest::prelude::*;

const SEED: u64 = 1;

fn polygon(corners: &[(f64, f64)]) -> Container {
    let corners: Vec<_> = corners.iter().map(|&(x, y)| Vector::new(x, y)).collect();
    Container::polygon(&corners)
}

fn bed(container: &Container) -> Bed<'static> {
    Bed {
        shape: Shape::Polygon(container.clone()),
        ..Bed::empty_box(1.0)
    }
}

/// A few units in the last place of the largest coordinate.
fn rounding(container: &Container) -> f64 {
    let largest = |v: &Vector| v.x.abs().max(v.y.abs());
    let corners = container.corners().iter().map(largest);
    16.0 * f64::EPSILON * corners.fold(1.0, f64::max)
}

fn assert_inside(grains: &[Grain], container: &Container) {
    for grain in grains {
        let depth = container.depth(grain.centre) - grain.radius;
        assert!(depth > -rounding(container), "{grain:?} outside: {depth:e}");
    }
}

fn assert_no_overlap(grains: &[Grain], container: &Container) {
    let centres: Vec<Vector> = grains.iter().map(|g| g.centre).collect();
    let radii: Vec<f64> = grains.iter().map(|g| g.radius).collect();
    for pair in Grid::new(&centres, &radii).near_pairs(0.0) {
        assert!(pair.gap > -rounding(container), "{pair:?}");
    }
}

/// The unit normal from a support to the grain on it, and the gap between them.
fn normal(
    grain: &Grain,
    support: Support,
    grains: &[Grain],
    container: &Container,
) -> (Vector, f64) {
    match support {
        Support::Grain(below) => {
            let below = grains[below.index()];
            let branch = grain.centre - below.centre;
            let length = branch.length();
            let gap = length - grain.radius - below.radius;
            (branch * (1.0 / length), gap)
        }
        Support::Side(side) => {
            let side = container.sides()[side.index()];
            (-side.outward, side.distance(grain.centre) - grain.radius)
        }
        other => panic!("a polygon has no {other:?}"),
    }
}

/// Each support touches, and their forces, which only push, can carry the weight.
fn assert_stable(dropped: &Dropped, container: &Container, before: usize) {
    let grains = dropped.grains.values();
    for (index, supports) in dropped.supports.values().iter().enumerate().skip(before) {
        let grain = grains[index];
        let check = |support: Support| {
            let (normal, gap) = normal(&grain, support, grains, container);
            assert!(gap.abs() < rounding(container), "{support:?}: {gap:e}");
            if let Support::Grain(below) = support {
                assert!(below < GrainId::from_index(index));
            }
            normal
        };
        let first = check(supports.first);
        let Some(second) = supports.second else {
            assert!(first.x.abs() < 1e-15 && first.y > 0.0, "{grain:?}");
            continue;
        };
        let second = check(second);
        // Weights a, b of the normals in (0, 1) = a·n₁ + b·n₂, times n₁ × n₂.
        let (a, b) = (-second.x, first.x);
        let turn = first.cross(second);
        let slack = 1e-7;
        assert!(
            a * turn >= -slack && b * turn >= -slack && turn != 0.0,
            "{grain:?} rolls off {supports:?}"
        );
    }
}

fn assert_sound(dropped: &Dropped, container: &Container) {
    assert_inside(dropped.grains.values(), container);
    assert_no_overlap(dropped.grains.values(), container);
    assert_stable(dropped, container, 0);
}

/// A triangle on its apex, a hopper, a hexagon, a sliver, a tilted square, a roof.
fn containers() -> Vec<Container> {
    let hexagon: Vec<(f64, f64)> = (0..6)
        .map(|k| (std::f64::consts::PI / 3.0 * f64::from(k)).sin_cos())
        .map(|(sin, cos)| (20.0 * cos, 20.0 * sin))
        .collect();
    vec![
        polygon(&[(0.0, 0.0), (20.0, 30.0), (-20.0, 30.0)]),
        polygon(&[
            (-3.0, 0.0),
            (3.0, 0.0),
            (15.0, 20.0),
            (15.0, 40.0),
            (-15.0, 40.0),
            (-15.0, 20.0),
        ]),
        polygon(&hexagon),
        polygon(&[(0.0, 0.0), (200.0, 9.0), (200.0, 14.0), (0.0, 4.0)]),
        polygon(&[(0.0, -20.0), (20.0, 0.0), (0.0, 20.0), (-20.0, 0.0)]),
        polygon(&[(0.0, 0.0), (40.0, 0.0), (20.0, 25.0)]),
    ]
}

#[test]
fn every_polygon_is_filled_with_a_stable_pack() {
    for container in containers() {
        let sizes = Sizes::Uniform { from: 0.3, to: 0.9 };
        let dropped = fill(&bed(&container), &sizes, 1, SEED).unwrap();
        assert_sound(&dropped, &container);
        let solid: f64 = dropped
            .grains
            .values()
            .iter()
            .map(|g| g.radius * g.radius)
            .sum();
        let fraction = std::f64::consts::PI * solid / container.area();
        assert!((0.6..0.85).contains(&fraction), "{fraction}");
    }
}

#[test]
fn a_rectangle_packs_as_a_box_does() {
    let (width, height) = (100.0, 130.0);
    let container = polygon(&[(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]);
    let radii = Sizes::Uniform { from: 0.5, to: 1.5 }
        .radii(2500, SEED)
        .unwrap();
    let dropped = drop(&bed(&container), &radii, 1, SEED).unwrap();
    assert_eq!(dropped.grains.len(), radii.len());
    assert_sound(&dropped, &container);
    let corner = |x, y| Vector::new(x, y);
    let fraction = packing_fraction(&dropped.grains, corner(6.0, 6.0), corner(94.0, 80.0));
    // As a box: 0.810 to 0.813; four standard deviations of some 1800 grains are about 0.008.
    assert!((0.803..0.82).contains(&fraction), "{fraction}");
}

#[test]
fn the_first_grain_slides_into_the_apex() {
    let container = polygon(&[(0.0, 0.0), (4.0, 4.0), (-4.0, 4.0)]);
    let dropped = drop(&bed(&container), &[1.0], 1, SEED).unwrap();
    let centre = dropped.grains.values()[0].centre;
    // Both sides rise by 45°, so the centre lies √2 above the apex.
    assert!(
        centre.x.abs() < 1e-15 && (centre.y - 2.0_f64.sqrt()).abs() < 1e-15,
        "{centre:?}"
    );
}

#[test]
fn a_polygon_without_room_says_so() {
    let container = polygon(&[(0.0, 0.0), (4.0, 4.0), (-4.0, 4.0)]);
    let wide = drop(&bed(&container), &[2.0], 1, SEED).unwrap_err();
    assert_eq!(wide, PackingError::ContainerTooNarrow { diameter: 4.0 });
    let one = drop(&bed(&container), &[1.0], 1, SEED).unwrap();
    let full = Bed {
        resting: one.grains.values(),
        ..bed(&container)
    };
    let error = drop(&full, &[1.6], 1, SEED).unwrap_err();
    assert_eq!(error, PackingError::NoRoom { diameter: 3.2 });
}

/// A convex polygon: the corners of a random one on an ellipse.
fn any_container() -> impl Strategy<Value = Container> {
    let angles = prop::collection::vec(0.0..std::f64::consts::TAU, 3..9);
    (angles, 0.1..1.0_f64, 0.0..3.2_f64).prop_filter_map("narrow", |(mut angles, flat, turn)| {
        angles.sort_by(f64::total_cmp);
        let corner = |angle: &f64| {
            let (x, y) = (30.0 * angle.cos(), 30.0 * flat * angle.sin());
            let (sin, cos) = turn.sin_cos();
            Vector::new(x * cos - y * sin, x * sin + y * cos)
        };
        let apart = angles.windows(2).all(|pair| pair[1] - pair[0] > 0.05)
            && angles[0] + std::f64::consts::TAU - angles[angles.len() - 1] > 0.05;
        let corners: Vec<Vector> = angles.iter().map(corner).collect();
        apart.then(|| Container::polygon(&corners))
    })
}

proptest! {
    #[test]
    fn every_pack_in_a_polygon_is_stable_inside_and_without_overlap(
        container in any_container(),
        seed in any::<u64>(),
        smallest in 0.02..0.5_f64,
        tries in 1_usize..3,
    ) {
        let radii = Sizes::Uniform { from: smallest, to: 1.0 }.radii(400, seed).unwrap();
        match drop(&bed(&container), &radii, tries, seed) {
            Ok(dropped) => {
                assert_sound(&dropped, &container);
                prop_assert_eq!(&dropped, &drop(&bed(&container), &radii, tries, seed).unwrap());
            }
            Err(PackingError::ContainerTooNarrow { .. }) => {}
            Err(other) => panic!("{other}"),
        }
    }

    #[test]
    fn grains_dropped_onto_a_bed_in_a_polygon_rest_on_it(
        container in any_container(),
        seed in any::<u64>(),
        height in -10.0..10.0_f64,
    ) {
        let small = Sizes::Uniform { from: 0.2, to: 0.4 };
        let below = Bed { top: Some(height), ..bed(&container) };
        let Ok(first) = drop(&below, &small.radii(100, seed).unwrap(), 1, seed) else {
            return Ok(());
        };
        let radii = Sizes::Uniform { from: 0.1, to: 0.8 }.radii(300, seed).unwrap();
        let onto = Bed { resting: first.grains.values(), layer: 1, ..bed(&container) };
        let Ok(second) = drop(&onto, &radii, 1, seed) else {
            return Ok(());
        };
        let join = |a: &[_], b: &[_]| [a, b].concat();
        let supports = [first.supports.values(), second.supports.values()].concat();
        let both = Dropped {
            grains: join(first.grains.values(), second.grains.values()).into(),
            supports: supports.into(),
        };
        assert!(first.grains.values().iter().all(|g| g.centre.y + g.radius <= height));
        assert_sound(&both, &container);
    }
}
