//! Containers and layers of scenes that are right, and what is built from them.

use std::path::Path;

use kavics::assembly::Partner;
use kavics::equilibrium::Freedom;
use kavics::scene::{Scene, SceneError};
use proptest::prelude::*;

fn read(text: &str) -> Result<Scene, SceneError> {
    Scene::parse(text, "scene.toml", Path::new(""), &|_, _| {
        Err("no reader for this file".to_owned())
    })
}

fn parse(text: &str) -> Scene {
    read(text).unwrap_or_else(|error| panic!("{error}"))
}

fn placed(text: &str) -> Vec<[f64; 3]> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes_wrong");
    let lists = |_: &Path, frame: Option<usize>| {
        let x = frame.map_or(0.0, |frame| frame as f64);
        Ok(vec![[x, 1.0, 0.5], [2.0, 1.0, 0.5], [3.0, 1.0, 0.5]])
    };
    let pack = Scene::place_grains(text, "scene.toml", &folder, &lists);
    let pack = pack.unwrap_or_else(|error| panic!("{error}"));
    let row = |g: &kavics::assembly::Grain| [g.centre.x, g.centre.y, g.radius];
    pack.grains.values().iter().map(row).collect()
}

#[test]
fn a_frame_and_rows_of_a_list_may_be_chosen() {
    let list = |more: &str| {
        placed(&format!(
            "[box]\nwidth = 9\nheight = 2\n[grains.listed]\nfile = \"../../Cargo.toml\"\n{more}"
        ))
    };
    assert_eq!(list("frame = 1")[0][0], 1.0);
    assert_eq!(list("rows = [1, 2]"), [[2.0, 1.0, 0.5], [3.0, 1.0, 0.5]]);
    assert_eq!(list("rows = [2, 2]"), [[3.0, 1.0, 0.5]]);
}

/// The hull of rows 2-3-2 of radius 1: a hexagon whose sides lie R outside that of the outer centres.
fn hexagon(clockwise: bool) -> String {
    let apothem = 3_f64.sqrt() + 1.0;
    let side = 2.0 * apothem / 3_f64.sqrt();
    let (x, y) = (
        [0.5, 1.5, 2.0, 1.5, 0.5, 0.0],
        [0.0, 0.0, 1.0, 2.0, 2.0, 1.0],
    );
    let corner = |k: usize| format!("[{:?}, {:?}]", x[k] * side, y[k] * apothem);
    let mut corners: Vec<String> = (0..6).map(corner).collect();
    if clockwise {
        corners.reverse();
    }
    format!(
        "[box]\npolygon = [{}]\n[grains.hexagonal]\nradius = 1\nrows = [2, 3, 2]\n\
         [contact.a.cemented]\nstiffness.layer = {{ normal = 1, shear = 1 }}\n",
        corners.join(", ")
    )
}

/// Two grains at each of the six sides, twelve contacts between grains.
#[test]
fn a_polygon_has_its_sides_in_either_sense() {
    for clockwise in [false, true] {
        let side = |k: usize| format!("[side.{k}]\ncontact = \"a\"\n");
        let sides = (0..6).map(side).collect::<Vec<_>>().concat();
        let scene = parse(&format!("{}{sides}", hexagon(clockwise)));
        let contacts = scene.assembly.contacts.values();
        assert_eq!(contacts.iter().filter(|c| !c.touches_side()).count(), 12);
        for (side, plan) in scene.assembly.sides.iter() {
            assert_eq!(plan.name, side.to_string());
            let at = contacts.iter().filter(|c| c.second == Partner::Side(side));
            for contact in at.clone() {
                assert!((contact.normal.dot(plan.outward) - 1.0).abs() < 1e-12);
            }
            assert_eq!(at.count(), 2, "side {side}");
        }
        let area: f64 = scene.assembly.cell_area.values().iter().sum();
        let apothem = 3_f64.sqrt() + 1.0;
        assert!((area - 12_f64.sqrt() * apothem * apothem).abs() < 1e-12);
    }
}

#[test]
fn edges_of_a_polygon_hold_and_load() {
    let scene = parse(&format!(
        "{}[[support]]\ngrains = {{ edge = \"0\" }}\nfix = [\"x\", \"y\"]\n\
         [[load]]\nname = \"press\"\nedge = \"2\"\nnormal = [-1, -1]\nshear = [0.5, 0.5]\n\
         [[stage]]\nfactors = [1]\n",
        hexagon(false)
    ));
    let held: Vec<u32> = scene.program.held.iter().map(|h| h.body.0).collect();
    assert_eq!(held, [0, 0, 1, 1]);
    let sum = |part: fn(&kavics::equilibrium::Load) -> f64| -> f64 {
        scene.program.loads.iter().map(|l| part(&l.load)).sum()
    };
    // Side 2 runs from (2s, a) to (3s/2, 2a): outward (√3, 1)/2, along (−1, √3)/2.
    let length = 2.0 * (3_f64.sqrt() + 1.0) / 3_f64.sqrt();
    let expected = [-(3_f64.sqrt() / 2.0) - 0.25, -0.5 + 3_f64.sqrt() / 4.0].map(|f| f * length);
    assert!((sum(|l| l.x) - expected[0]).abs() < 1e-12);
    assert!((sum(|l| l.y) - expected[1]).abs() < 1e-12);
    assert!(
        scene
            .warnings
            .iter()
            .all(|w| !w.contains("no grain is met"))
    );
}

#[test]
fn a_strain_of_a_polygon_is_about_the_middle_of_its_extents() {
    let scene = parse(&format!(
        "{}[[move]]\nname = \"squeeze\"\ngrains = {{ ids = [0, 3, 6] }}\nstrain = {{ xx = -0.5 }}\n\
         [[stage]]\nfactors = [1]\n",
        hexagon(false)
    ));
    let along_x = scene.program.prescribed.iter();
    let along_x = along_x.filter(|p| p.freedom == Freedom::X);
    let amplitudes: Vec<f64> = along_x.map(|p| p.amplitude).collect();
    // Grains 0, 3, 6 lie one radius left, in the middle, and one radius right.
    for (amplitude, expected) in amplitudes.iter().zip([0.5, 0.0, -0.5]) {
        assert!((amplitude - expected).abs() < 1e-12);
    }
}

const LAYERS: &str = r"
seed = 5
[box]
width = 12.0
height = 14.0
[[layer]]
square = { radius = 0.5, rows = [10, 10] }
[[layer]]
top = 7.0
[layer.dropped]
radius = { from = 0.4, to = 0.6 }
[[layer]]
hexagonal = { radius = 0.5, rows = [8, 7] }
[[layer]]
dropped = { radius = 0.3 }
";

/// Layers keep their order, stand above each other, and end below their tops.
#[test]
fn layers_lie_on_those_below() {
    let grains = placed(LAYERS);
    assert_eq!(placed(LAYERS), grains);
    let top = |grains: &[[f64; 3]]| grains.iter().map(|[_, y, r]| y + r).fold(0.0, f64::max);
    assert_eq!(top(&grains[..20]), 2.0);
    let is_row = |rows: &[[f64; 3]]| rows.iter().all(|[.., r]| *r == 0.5);
    let third = grains[20..].windows(15).position(is_row);
    let third = 20 + third.expect("the rows of the third layer");
    let second_top = top(&grains[..third]);
    assert!(second_top > 6.0 && second_top <= 7.0, "{second_top}");
    assert_eq!(grains[third][1], second_top + 0.5);
    let last = &grains[third + 15..];
    assert!(last.iter().all(|[.., r]| *r == 0.3));
    assert!(top(last) > 13.0 && top(last) <= 14.0);
}

/// The same layer twice is not the same twice: each has random numbers of its own.
#[test]
fn layers_have_random_numbers_of_their_own() {
    let layer = "[[layer]]\ndropped = { count = 30, radius = { from = 0.5, to = 1 } }\n";
    let grains = placed(&format!(
        "[box]\nwidth = 30\nheight = \"fit\"\n{layer}{layer}"
    ));
    let radii: Vec<f64> = grains.iter().map(|[.., r]| *r).collect();
    assert_ne!(radii[..30], radii[30..]);
    let sorted = |radii: &[f64]| {
        let mut radii = radii.to_vec();
        radii.sort_by(f64::total_cmp);
        radii
    };
    assert_eq!(sorted(&radii[..30]), sorted(&radii[30..]));
}

#[test]
fn one_layer_is_the_same_as_grains() {
    let text = |name: &str| {
        format!("[box]\nwidth = 9\nheight = 9\n{name}\ndropped = {{ radius = 0.5 }}\n")
    };
    assert_eq!(placed(&text("[[layer]]")), placed(&text("[grains]")));
    let rows = "[box]\npolygon = [[-2, 3], [2, 3], [2, 9], [-2, 9]]\n[grains.square]\nradius = 1\nrows = [2, 2]\n";
    assert_eq!(placed(rows)[0], [-1.0, 4.0, 1.0]);
    assert_eq!(placed(rows)[3], [1.0, 6.0, 1.0]);
}

/// Whether corners make a convex polygon: each triple of corners in a row turns as every triple in order does.
fn is_convex(corners: &[(i32, i32)]) -> bool {
    let turn = |a: usize, b: usize, c: usize| {
        let at = |k: usize| corners[k % corners.len()];
        let ((ax, ay), (bx, by), (cx, cy)) = (at(a), at(b), at(c));
        ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)).signum()
    };
    let number = corners.len();
    let triples = (0..number)
        .flat_map(|a| (a + 1..number).flat_map(move |b| (b + 1..number).map(move |c| (a, b, c))));
    let sense = if number < 3 { 0 } else { turn(0, 1, 2) };
    sense != 0 && triples.into_iter().all(|(a, b, c)| turn(a, b, c) == sense)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    /// What is taken is convex, what is convex is taken, and the power cells fill it.
    #[test]
    fn polygons_are_taken_if_and_only_if_they_are_convex(
        corners in prop::collection::vec((-9_i32..9, -9_i32..9), 2..6),
    ) {
        let list: Vec<String> = corners.iter().map(|(x, y)| format!("[{x}, {y}]")).collect();
        let text = format!(
            "[box]\npolygon = [{}]\n[grains.dropped]\nradius = 0.05\ncount = 3\n\
             [contact.a.cemented]\nstiffness.layer = {{ normal = 1, shear = 1 }}\n\
             [[support]]\ngrains = {{ ids = [0, 1, 2] }}\nfix = [\"x\", \"y\", \"rotation\"]\n",
            list.join(", ")
        );
        match read(&text) {
            Ok(scene) => {
                prop_assert!(is_convex(&corners), "{:?}", corners);
                let next = corners.iter().cycle().skip(1);
                let twice = corners.iter().zip(next).map(|((ax, ay), (bx, by))| ax * by - ay * bx);
                let area = 0.5 * f64::from(twice.sum::<i32>().abs());
                let cells: f64 = scene.assembly.cell_area.values().iter().sum();
                prop_assert!((cells - area).abs() < 1e-9 * area, "{} {}", cells, area);
            }
            Err(error) => {
                let told = error.to_string();
                let narrow = ["error: the grains cannot be placed", "error: only"];
                let of_grains = narrow.iter().any(|start| told.starts_with(start));
                prop_assert_eq!(of_grains, is_convex(&corners), "{} {:?}", told, corners);
            }
        }
    }
}
