//! Displacements that are not small against the branch lengths are told, whatever leads the load path; those that only
//! carry the assembly along are not.

use std::path::Path;

use kavics::equilibrium::{Equilibrium, LargeMotion, Motion, SMALL_MOTION, Warning};
use kavics::ids::{ContactId, GrainId};
use kavics::scene::Scene;

/// Stiffness of every contact, normal, shear and against rotation.
const STIFFNESS: [f64; 3] = [10.0, 5.0, 2.0];

/// Grains of radius 1 in rows between the sides of a box, all cemented.
fn scene(rows: &str, rest: &str) -> Scene {
    let [normal, shear, moment] = STIFFNESS;
    let text = format!(
        "[box]\nwidth = 20.0\nheight = 4.0\n\
         [grains.hexagonal]\nradius = 1.0\nrows = {rows}\n\
         [contact.cement.cemented]\n\
         stiffness.direct = {{ normal = {normal}, shear = {shear}, moment = {moment} }}\n\
         strength.force = {{ tension = 0.5 }}\n\
         [contact.glue.cemented]\n\
         stiffness.direct = {{ normal = {normal}, shear = {shear}, moment = {moment} }}\n\
         [[zone]]\ncontact = \"cement\"\n{rest}"
    );
    let lists = |_: &Path, _: Option<usize>| Err("no grain lists here".to_owned());
    Scene::parse(&text, "scene.toml", Path::new("."), &lists).unwrap_or_else(|e| panic!("{e}"))
}

/// A single grain on the floor, glued to it, and what acts on it.
fn lone(action: &str, rest: &str) -> Scene {
    let floor = "[side.bottom]\ncontact = \"glue\"\n[[stage]]\nfactors = [1.0]\n";
    let load = format!("[[load]]\nname = \"push\"\ngrains = {{ ids = [0] }}\nforce = {action}\n");
    scene("[1]", &format!("{floor}{load}{rest}"))
}

fn last(scene: &Scene) -> Equilibrium {
    let found = scene.load_path().last().expect("an equilibrium");
    found.unwrap_or_else(|error| panic!("{error}"))
}

fn large(equilibrium: &Equilibrium) -> Option<LargeMotion> {
    let mut warnings = equilibrium.warnings.iter();
    warnings.find_map(|warning| match warning {
        Warning::LargeDisplacements(large) => Some(*large),
        _ => None,
    })
}

fn assert_large(scene: &Scene, expected: f64, motion: Motion) {
    let found = large(&last(scene)).expect("a warning");
    assert_eq!(found.motion, motion);
    assert!(
        (found.size - expected).abs() < 1e-9 * expected,
        "{found:?}, expected {expected}"
    );
}

/// u = F/k over the branch of the grain, its radius 1.
#[test]
fn a_grain_pressed_by_more_than_a_tenth_of_its_branch_is_told_under_every_control() {
    let controls = [
        "",
        "[equilibrium]\nbreakage = \"event-driven\"\n",
        "[equilibrium]\nbreakage = \"simultaneous\"\niteration = \"tangent\"\n",
        "[equilibrium]\ncontrol = \"displacement\"\n",
        "[equilibrium]\ncontrol = \"auto\"\n",
        "[equilibrium]\nsolver = \"iterative\"\n",
    ];
    let pressed = |size: f64, control| {
        let force = -size * STIFFNESS[0];
        lone(&format!("{{ y = {force} }}"), control)
    };
    for control in controls {
        assert_eq!(large(&last(&pressed(0.999 * SMALL_MOTION, control))), None);
        let above = pressed(1.001 * SMALL_MOTION, control);
        assert_large(&above, 1.001 * SMALL_MOTION, Motion::Branch(ContactId(0)));
        assert_large(&pressed(48.0, control), 48.0, Motion::Branch(ContactId(0)));
    }
}

/// A grain that cannot be displaced turns by ω = M/(k_m + k_s·R²): the floor holds its lowest point at the lever R = 1.
#[test]
fn a_grain_that_turns_by_more_than_a_tenth_is_told() {
    let held = "[[support]]\ngrains = { ids = [0] }\nfix = [\"x\", \"y\"]\n";
    let [_, shear, moment] = STIFFNESS;
    let turned = |angle: f64| {
        let applied = angle * (moment + shear);
        lone(&format!("{{ moment = {applied} }}"), held)
    };
    assert_eq!(large(&last(&turned(-0.999 * SMALL_MOTION))), None);
    assert_large(
        &turned(-1.001 * SMALL_MOTION),
        1.001 * SMALL_MOTION,
        Motion::Turn(GrainId(0)),
    );
}

/// u = T/k_s along a floor of length 20, where the grain does not turn.
#[test]
fn a_grain_that_goes_along_a_side_by_more_than_a_tenth_of_the_side_is_told() {
    let upright = "[[support]]\ngrains = { ids = [0] }\nfix = [\"rotation\"]\n";
    let pushed = |share: f64| {
        let force = share * 20.0 * STIFFNESS[1];
        lone(&format!("{{ x = {force} }}"), upright)
    };
    assert_eq!(large(&last(&pushed(0.999 * SMALL_MOTION))), None);
    let above = pushed(1.001 * SMALL_MOTION);
    assert_large(&above, 1.001 * SMALL_MOTION, Motion::Along(ContactId(0)));
}

#[test]
fn the_largest_of_all_contacts_is_named() {
    let loads = "[[load]]\nname = \"a\"\ngrains = { ids = [0] }\nforce = { y = -2.0 }\n\
                 [[load]]\nname = \"b\"\ngrains = { ids = [2] }\nforce = { y = -3.0 }\n\
                 [[stage]]\nfactors = [1.0]\n[side.bottom]\ncontact = \"glue\"\n";
    let scene = scene("[3]", loads);
    let found = large(&last(&scene)).expect("a warning");
    let Motion::Branch(contact) = found.motion else {
        panic!("{found:?}")
    };
    assert!(
        scene.assembly.contacts[contact]
            .grains()
            .any(|grain| grain == GrainId(2))
    );
}

/// The floor carries its grains along, straight and turning: no branch changes but by the turn itself.
#[test]
fn a_floor_that_moves_with_all_it_bears_is_told_only_where_it_turns_far() {
    let floor = "[side.bottom]\ncontact = \"glue\"\n[[stage]]\nfactors = [1.0]\n";
    let moved = |way: &str| {
        let floor = format!("{floor}[[move]]\nname = \"shift\"\nside = \"bottom\"\n{way}\n");
        scene("[9, 8]", &floor)
    };
    let end = last(&moved("y = 5.0\nx = -300.0"));
    let grains = &end.state.displacements.values()[..17];
    assert!(grains.iter().all(|u| (u.x + 300.0).abs() < 1e-6));
    assert_eq!(large(&end), None);
    // At the ends of the floor the grains go 8 times as far as their branches are long.
    assert_eq!(large(&last(&moved("rotation = 0.099"))), None);
    let found = large(&last(&moved("rotation = -0.101"))).expect("a warning");
    assert!((found.size - 0.101).abs() < 1e-9, "{found:?}");
}

/// A grain is pulled off the two that it lies on, which stay on the floor.
#[test]
fn what_is_broken_may_go_as_far_as_it_likes() {
    let pulled = |contact: &str| {
        let rest = format!(
            "[[zone]]\ncontact = \"{contact}\"\n[side.bottom]\ncontact = \"glue\"\n\
             [[move]]\nname = \"pull\"\ngrains = {{ ids = [2] }}\ny = 7.0\n[[stage]]\nfactors = [1.0]\n"
        );
        scene("[2, 1]", &rest)
    };
    let torn = last(&pulled("cement"));
    assert!(
        torn.state
            .contacts
            .values()
            .iter()
            .filter(|c| c.broken)
            .count()
            == 2
    );
    assert_eq!(large(&torn), None);
    assert!(large(&last(&pulled("glue"))).expect("a warning").size > 1.0);
}
