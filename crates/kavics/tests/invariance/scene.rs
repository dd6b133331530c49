//! The same at the level of the scene file: grains and corners as numbers.

use std::path::Path;

use kavics::equilibrium::{Displacement, Equilibrium};
use kavics::geometry::Vector;
use kavics::ids::{BodyId, GrainId};
use kavics::measure::{Snapshot, Window, measures};
use kavics::scene::Scene;
use proptest::prelude::*;

use crate::change::{Change, GRAINS, changes};
use crate::pile::Pile;
use crate::twins::{close_tensors, close_vectors, geometric_tolerance, hanging, largest};

/// A glued pile under a push.
fn text(pile: &Pile, change: &Change, scatter: &str) -> String {
    let corner = |x: &Vector| {
        let x = change.point(*x);
        format!("[{:?}, {:?}]", x.x, x.y)
    };
    let corners: Vec<String> = pile.corners.iter().map(corner).collect();
    let sides = [0, 1, 4].map(|side| format!("[side.{side}]\ncontact = \"glue\"\n"));
    let push = change.turned(Vector::new(3.0, -5.0)) * change.force;
    let pushed = change.grain(GrainId(20));
    let corners = corners.join(", ");
    // The list is that of the test; the file only has to be there.
    format!(
        "seed = 3\n[box]\npolygon = [{corners}]\n[grains.listed]\nfile = \"Cargo.toml\"\n\
         [contacts]\nbetween = \"touching\"\n\
         [contact.glue.cemented]\nstiffness.layer = {{ normal = 1000, shear = 600 }}\n{scatter}\n{}\
         [[load]]\nname = \"push\"\ngrains = {{ ids = [{pushed}] }}\nforce = {{ x = {:?}, y = {:?} }}\n\
         [[stage]]\nfactors = [1]\n[equilibrium]\ntolerance = 1e-12\n",
        sides.concat(),
        push.x,
        push.y,
    )
}

fn scene(pile: &Pile, change: &Change, scatter: &str) -> Scene {
    let grains = change.grains(&pile.grains);
    let rows = grains.values().iter();
    let rows: Vec<[f64; 3]> = rows.map(|g| [g.centre.x, g.centre.y, g.radius]).collect();
    let lists = move |_: &Path, _: Option<usize>| Ok(rows.clone());
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    Scene::parse(&text(pile, change, scatter), "scene.toml", folder, &lists)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn last(scene: &Scene) -> Equilibrium {
    let end = scene.load_path().last().expect("step 0");
    end.unwrap_or_else(|error| panic!("{error}"))
}

/// Displacements and stress of the whole; softest is a pile that hangs on one bond.
fn scenes_agree(pile: &Pile, change: &Change) -> Result<(), TestCaseError> {
    let [here, there] = [&Change::none(), change].map(|change| scene(pile, change, ""));
    let [before, found] = [&here, &there].map(last);
    prop_assert_eq!(here.assembly.contacts.len(), there.assembly.contacts.len());
    let tolerance = geometric_tolerance(&here.assembly, change) * hanging(&here.assembly);
    let moved = before.state.displacements.values().iter();
    let size = tolerance * change.displacement * largest(moved.flat_map(|u| [u.x, u.y]));
    for grain in here.assembly.grains.ids() {
        let displacement = |e: &Equilibrium, id: GrainId| e.state.displacements[BodyId(id.0)];
        let expected = change.displacement(displacement(&before, grain));
        let u = |u: Displacement| Vector::new(u.x, u.y);
        let found = displacement(&found, change.grain(grain));
        close_vectors("displacement", u(found), u(expected), size)?;
    }
    let stress = |scene: &Scene, equilibrium: &Equilibrium| {
        let all = Window::new(scene.assembly.grains.ids().collect(), GRAINS);
        let found = measures(&Snapshot::new(&scene.assembly, equilibrium), &all);
        found.stress.map(|stress| stress.total).unwrap_or_default()
    };
    let (before, found) = (stress(&here, &before), stress(&there, &found));
    let factor = change.stress();
    let bound = tolerance * factor * largest([before.xx, before.xy, before.yx, before.yy]);
    close_tensors("stress", found, change.tensor(before) * factor, bound)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(20) })]

    #[test]
    fn a_scene_with_other_numbers_is_the_same_assembly(seed in 0_u64..1000, change in changes(50.0)) {
        // Sides are called by their numbers, so these stay.
        let change = Change { first_side: 0, ..change }.with_stiffness(1);
        scenes_agree(&Pile::dropped(seed), &change)?;
    }

    /// Factors are drawn by the id of the contact: a turned assembly has the same, a renumbered one the same numbers on
    /// other contacts.
    #[test]
    fn scatter_goes_with_the_ids_of_contacts(seed in 0_u64..1000, change in changes(50.0)) {
        let pile = Pile::dropped(seed);
        let change = Change { first_side: 0, ..change };
        let factors = |change: &Change| -> Vec<f64> {
            let scatter = "strength.force = { tension = 1e9 }\nstrength.scatter.weibull = { shape = 5.0 }";
            let scene = scene(&pile, change, scatter);
            scene.assembly.contacts.values().iter().map(|c| c.strength_factor).collect()
        };
        prop_assert_eq!(factors(&Change::none()), factors(&change));
    }
}
