//! The drawn geometry is that of the run.

mod runs;

use kavics::assembly::Partner;
use kavics::geometry::Vector;
use kavics_pictures::Layout;
use runs::{Run, run};

fn scenes() -> [Run; 4] {
    [
        run("dropped-1000.toml", "voids = true\n"),
        run("block-32.toml", "\n[record]\nvoids = true\n"),
        run("polygon.toml", "\n[record]\nvoids = true\n"),
        run("three-discs.toml", "\n[record]\nvoids = true\n"),
    ]
}

fn near(a: f64, b: f64, size: f64) -> bool {
    (a - b).abs() <= 1e-9 * size
}

#[test]
fn a_dual_edge_is_as_long_as_the_measures_say_and_lies_across_its_contact() {
    for Run { scene, folder, .. } in scenes() {
        let layout = Layout::read(&folder).expect("a layout");
        let edges = layout.dual_edges();
        let contacts = &scene.assembly.contacts;
        assert_eq!(edges.len(), contacts.len());
        for ((_, contact), [from, to]) in contacts.iter().zip(edges.values()) {
            let along = *to - *from;
            let signed = along.dot(contact.normal.quarter_turn());
            assert!(near(signed, contact.dual_length_full, 1.0), "{contact:?}");
            assert!(near(along.dot(contact.normal), 0.0, 1.0), "{contact:?}");
        }
    }
}

#[test]
fn both_ends_of_a_dual_edge_have_equal_power_with_both_grains() {
    for Run { scene, folder, .. } in scenes() {
        let layout = Layout::read(&folder).expect("a layout");
        let edges = layout.dual_edges();
        for (contact, ends) in scene.assembly.contacts.values().iter().zip(edges.values()) {
            let power = |partner: Partner, at: Vector| match partner {
                Partner::Grain(grain) => {
                    let grain = scene.assembly.grains[grain];
                    (at - grain.centre).length_squared() - grain.radius * grain.radius
                }
                // On the side itself nothing else is nearer.
                Partner::Side(side) => scene.assembly.sides[side].distance(at),
            };
            for &end in ends {
                let is_there = match contact.second {
                    Partner::Grain(_) => power(contact.first, end),
                    Partner::Side(_) => 0.0,
                };
                assert!(
                    near(power(contact.second, end), is_there, 10.0),
                    "{contact:?}"
                );
            }
        }
    }
}

#[test]
fn sides_have_the_numbers_of_the_scene() {
    for Run { scene, folder, .. } in scenes() {
        let layout = Layout::read(&folder).expect("a layout");
        for ((_, side), (_, expected)) in layout
            .assembly
            .sides
            .iter()
            .zip(scene.assembly.sides.iter())
        {
            assert!((side.outward - expected.outward).length() < 1e-12);
            assert!((side.middle() - expected.middle()).length() < 1e-12);
            assert_eq!(side.present, expected.present);
        }
    }
}

#[test]
fn void_triangles_cover_the_cells_of_the_table() {
    for Run { folder, .. } in scenes() {
        let layout = Layout::read(&folder).expect("a layout");
        for step in folder.recorded_steps().expect("steps") {
            let state = layout.state(step).expect("a state");
            let cells = layout.void_cells(&state);
            let areas = folder.voids(step).expect("void cells").numbers("area");
            let areas = areas.expect("areas");
            assert_eq!(cells.cells.len(), areas.len());
            // Displacements are small: the cells are those of the undeformed places.
            let centre = |grain| layout.assembly.grains[grain].centre;
            let mut covered = vec![0.0; areas.len()];
            for triangle in layout.void_triangles(&state, &cells) {
                let [a, b, c] = triangle.corners.map(centre);
                covered[triangle.void] += 0.5 * (b - a).cross(c - a);
            }
            for (covered, area) in covered.iter().zip(&areas) {
                assert!(near(*covered, *area, 1.0), "{covered} of {area} at {step}");
            }
        }
    }
}
