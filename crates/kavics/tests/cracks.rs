//! Cracks in lattices whose broken contacts are known.

use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

use kavics::assembly::{Assembly, Partner};
use kavics::contact_law::{ContactForce, Phase, RelativeDisplacement};
use kavics::equilibrium::{ContactState, Displacement, Load, State};
use kavics::geometry::Vector;
use kavics::ids::{ContactId, Id, PerBody};
use kavics::measure::{Crack, Snapshot, cracks};
use kavics::scene::Scene;

/// A regular block of discs of radius 1 between bottom and top side.
fn block(kind: &str) -> Assembly {
    let scene = format!(
        "[box]\nwidth = 20.0\nheight = \"fit\"\n[grains.{kind}]\nradius = 1.0\nrows = {{ count = 9, longest = 10 }}\n\
         [contact.cement.cemented]\nstiffness.layer = {{ normal = 1.0, shear = 0.5 }}\n\
         [side.bottom]\ncontact = \"cement\"\n[side.top]\ncontact = \"cement\"\n"
    );
    let none = |_: &Path, _| Err("no reader for this file".to_owned());
    let scene = Scene::parse(&scene, "scene.toml", Path::new("."), &none);
    scene.unwrap_or_else(|error| panic!("{error}")).assembly
}

/// The cracks when the contacts that `broken` names are broken.
fn cracks_of(assembly: &Assembly, broken: impl Fn(ContactId) -> bool) -> Vec<Crack> {
    let state = |id| ContactState {
        displacement: RelativeDisplacement::default(),
        force: ContactForce::default(),
        property: None,
        broken: broken(id),
        phase: Phase::default(),
    };
    let bodies = assembly.body_count();
    let state = State {
        displacements: PerBody::filled(Displacement::default(), bodies),
        contacts: assembly.contacts.ids().map(state).collect(),
    };
    let loads = PerBody::filled(Load::default(), bodies);
    cracks(&Snapshot {
        assembly,
        state: &state,
        loads: &loads,
        reactions: &loads,
    })
}

/// Contacts between grains whose branch crosses the line y = `height`.
fn across(assembly: &Assembly, height: f64) -> impl Fn(ContactId) -> bool + '_ {
    move |id| {
        let contact = &assembly.contacts[id];
        let y = [contact.first, contact.second].map(|p| assembly.reference_point(p).y - height);
        !contact.touches_side() && y[0] * y[1] < 0.0
    }
}

#[test]
fn an_intact_assembly_has_no_cracks() {
    let assembly = block("hexagonal");
    assert!(cracks_of(&assembly, |_| false).is_empty());
}

#[test]
fn a_cut_between_two_rows_of_a_hexagonal_block_is_one_crack_along_them() {
    let assembly = block("hexagonal");
    let height = 1.0 + 1.5 * 3.0_f64.sqrt();
    let cut = across(&assembly, height);
    let found = cracks_of(&assembly, &cut);
    assert_eq!(found.len(), 1);
    let crack = &found[0];
    assert_eq!(crack.contacts.len(), 18);
    assert!((crack.centroid.y - height).abs() < 1e-12);
    assert!(crack.orientation.abs() < 1e-12);
    let lengths = crack
        .contacts
        .iter()
        .map(|&id| assembly.contacts[id].dual_length());
    assert!((crack.length - lengths.sum::<f64>()).abs() < 1e-12);
    assert!(crack.extent > 17.0 && crack.extent < crack.length);
}

#[test]
fn a_cut_through_a_square_lattice_runs_straight_on_through_its_voids() {
    // No triangle has two contacts of the cut: the voids are the squares.
    let assembly = block("square");
    let cut = across(&assembly, 6.0);
    let found = cracks_of(&assembly, &cut);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].contacts.len(), 10);
    assert!((found[0].extent - found[0].length).abs() < 1e-9);
}

#[test]
fn two_cuts_apart_are_two_cracks_and_the_longer_one_comes_first() {
    let assembly = block("hexagonal");
    let row = 3.0_f64.sqrt();
    let [low, high] = [1.0 + 1.5 * row, 1.0 + 5.5 * row];
    let left = |id: ContactId| assembly.contacts[id].point.x < 10.0;
    let [lower, upper] = [across(&assembly, low), across(&assembly, high)];
    let found = cracks_of(&assembly, |id| lower(id) && left(id) || upper(id));
    assert_eq!(found.len(), 2);
    assert!(found[0].centroid.y > found[1].centroid.y);
    assert!(found[0].length > 1.5 * found[1].length);
}

#[test]
fn one_broken_contact_is_a_crack_along_its_dual_edge() {
    let assembly = block("hexagonal");
    for (id, contact) in assembly.contacts.iter() {
        let found = cracks_of(&assembly, |broken| broken == id);
        let t = contact.normal.quarter_turn();
        let turn = (found[0].orientation - libm::atan2(t.y, t.x)).rem_euclid(PI);
        assert!(turn.min(PI - turn) < 1e-12, "contact {id}");
        assert!((found[0].extent - contact.dual_length()).abs() < 1e-12);
        assert!(found[0].orientation > -FRAC_PI_2 && found[0].orientation <= FRAC_PI_2);
    }
}

#[test]
fn neighbours_that_leave_a_side_leave_it_in_one_crack() {
    let assembly = block("hexagonal");
    let bottom = |id: ContactId| {
        let contact = &assembly.contacts[id];
        contact.touches_side() && contact.point.y == 0.0
    };
    let found = cracks_of(&assembly, bottom);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].contacts.len(), 10);
    // Grains farther apart part from the side each for itself.
    let every_third = |id: ContactId| match assembly.contacts[id].first {
        Partner::Grain(grain) => bottom(id) && grain.index() % 3 == 0,
        Partner::Side(_) => false,
    };
    assert_eq!(cracks_of(&assembly, every_third).len(), 4);
}

#[test]
fn cracks_turn_with_the_lattice() {
    // The cut of a column of a square lattice stands upright.
    let assembly = block("square");
    let upright = |id: ContactId| {
        let contact = &assembly.contacts[id];
        !contact.touches_side()
            && (contact.point - Vector::new(10.0, contact.point.y)).length() < 1e-9
    };
    let found = cracks_of(&assembly, upright);
    assert_eq!(found.len(), 1);
    assert!((found[0].orientation.abs() - FRAC_PI_2).abs() < 1e-12);
}
