//! Assemblies that a move takes along as a whole: nothing bears a force, and nothing is amiss.

use std::path::Path;

use kavics::equilibrium::{Equilibrium, Warning};
use kavics::scene::Scene;

/// Three grains on a side that sinks or turns, then is at rest, and in the end presses them against nothing.
fn follow(motion: &str, property: &str, settings: &str) -> Vec<Equilibrium> {
    let text = format!(
        "[box]\nwidth = 4.0\nheight = \"fit\"\n[grains.hexagonal]\nradius = 1.0\nrows = [2, 1]\n\
         [contact.m.cemented]\nstiffness.layer = {{ normal = 1.0, shear = 0.5 }}\n{property}\
         [side.bottom]\ncontact = \"m\"\n[[move]]\nname = \"settle\"\nside = \"bottom\"\n{motion}\n\
         [[stage]]\nfactors = [1.0, 1.0, 2.0]\n[equilibrium]\n{settings}"
    );
    let lists = |_: &Path, _: Option<usize>| Err("no grain lists here".to_owned());
    let scene = Scene::parse(&text, "rigid.toml", Path::new("."), &lists);
    let scene = scene.unwrap_or_else(|error| panic!("{error}\n{text}"));
    let path: Result<Vec<_>, _> = scene.load_path().collect();
    path.unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[test]
fn a_rigid_motion_is_an_equilibrium_without_a_warning_whatever_steers() {
    let softens = "strength.force = { tension = 0.1, shear = 0.1 }\nfracture_energy = 1.0\n";
    let hardens = "shear_hardening = 2.0\nshear_floor = 0.1\n";
    for (property, settings) in [
        ("", ""),
        ("", "breakage = \"event-driven\"\n"),
        ("", "iteration = \"tangent\"\n"),
        (hardens, ""),
        (hardens, "breakage = \"event-driven\"\n"),
        (softens, ""),
        (softens, "control = \"displacement\"\n"),
        (softens, "control = \"dissipation\"\n"),
        (softens, "control = \"auto\"\n"),
    ] {
        for motion in ["y = -0.01", "x = 0.013", "x = 0.013\nrotation = 0.02"] {
            let path = follow(motion, property, settings);
            assert_eq!(path.len(), 4, "{property}{settings}{motion}");
            for equilibrium in &path {
                let contacts = equilibrium.state.contacts.values().iter();
                let forces = contacts.map(|c| c.force.normal.hypot(c.force.shear));
                assert!(
                    forces.fold(0.0, f64::max) < 1e-15,
                    "{property}{settings}{motion}"
                );
                let is_open = |warning: &&Warning| matches!(warning, Warning::WorkError { .. });
                let told = equilibrium.warnings.iter().find(is_open);
                assert!(told.is_none(), "{property}{settings}{motion}: {told:?}");
            }
            let sides = path[3].state.displacements.values();
            assert!(sides.iter().any(|u| u.x.abs().max(u.y.abs()) > 0.019));
        }
    }
}
