//! Tangent moduli of windows: lattices, bounds, and the measures that they are made of.

use std::path::Path;

use kavics::assembly::{Assembly, Partner};
use kavics::contact_law::{ContactForce, Matrix, Phase};
use kavics::equilibrium::{ContactFrame, ContactState, Equilibrium, Load, State, relax};
use kavics::ids::{PerBody, PerContact, PropertyId};
use kavics::measure::{
    ElasticityTensor, Moduli, Snapshot, Tensor, Window, average_stress, inside, moduli, strain,
    uniform_strains,
};
use kavics::scene::Scene;
use proptest::prelude::*;

const NORMAL: f64 = 3.0;
const SHEAR: f64 = 1.2;

/// A block whose contacts have the stiffnesses above, its bottom held, its top pressed and sheared.
fn block(grains: &str, size: &str, more: &str, window: &str) -> Scene {
    let text = format!(
        "seed = 1\n[box]\n{size}\n{grains}\n\
         [contact.mortar.cemented]\n\
         stiffness.direct = {{ normal = {NORMAL}, shear = {SHEAR}, moment = 0.2 }}\n{more}\n\
         [[support]]\ngrains = {{ edge = \"bottom\" }}\nfix = [\"x\", \"y\", \"rotation\"]\n\
         [[load]]\nname = \"press\"\nedge = \"top\"\nnormal = [-0.1, -0.1]\nshear = [0.3, 0.3]\n\
         [[stage]]\nfactors = [1.0]\n\
         [measure]\nmoduli = true\nwindow = {window}\n"
    );
    let lists = |_: &Path, _: Option<usize>| Err("no lists here".to_owned());
    Scene::parse(&text, "block.toml", Path::new("."), &lists).expect("a scene")
}

fn dropped(seed: u64, window: &str) -> Scene {
    let grains = "[grains.dropped]\ncount = 70\nradius = { from = 0.5, to = 1.0 }";
    let size = "width = 13.0\nheight = \"fit\"";
    let mut scene = block(grains, size, "", window);
    if seed != 1 {
        let text = scene.text.replace("seed = 1", &format!("seed = {seed}"));
        let lists = |_: &Path, _: Option<usize>| Err("no lists here".to_owned());
        scene = Scene::parse(&text, "block.toml", Path::new("."), &lists).expect("a scene");
    }
    scene
}

fn end(scene: &Scene) -> Equilibrium {
    let last = scene.load_path().last();
    last.expect("a load step").expect("an equilibrium")
}

fn window(scene: &Scene) -> Window {
    Window::new(scene.window.clone(), scene.assembly.grains.len())
}

fn tangents(scene: &Scene) -> PerContact<Matrix> {
    end(scene).tangents.expect("they are asked for")
}

fn measured(scene: &Scene) -> Moduli {
    moduli(&scene.assembly, &tangents(scene), &window(scene)).expect("a stiff window")
}

fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} for {expected}"
    );
}

/// K = √3/2·k_n, G = √3/4·(k_n + k_t); k_m does not enter.
#[test]
fn a_hexagonal_lattice_has_the_moduli_of_its_closed_form() {
    let grains = "[grains.hexagonal]\nradius = 0.5\nrows = { count = 9, longest = 9 }";
    let size = "width = 9.0\nheight = \"fit\"";
    let scene = block(grains, size, "", "{ x = [1.7, 7.3], y = [1.5, 6.5] }");
    let found = measured(&scene);
    let (bulk, shear) = (
        3_f64.sqrt() / 2.0 * NORMAL,
        3_f64.sqrt() / 4.0 * (NORMAL + SHEAR),
    );
    let expected = ElasticityTensor::isotropic(bulk, shear);
    for tensor in [found.tangent, found.voigt] {
        assert!(tensor.minus(&expected).norm() < 1e-12, "{tensor:?}");
        assert!(tensor.anisotropy().is_some_and(|a| a < 1e-13));
    }
    let young = 2.0 * 3_f64.sqrt() * NORMAL * (NORMAL + SHEAR) / (3.0 * NORMAL + SHEAR);
    assert_near(found.tangent.young_modulus(), young, 1e-12);
    let poisson = (NORMAL - SHEAR) / (3.0 * NORMAL + SHEAR);
    assert_near(found.tangent.poisson_ratio(), poisson, 1e-13);
}

/// E_x = E_y = k_n, ν = 0, G = k_t/2.
#[test]
fn a_square_lattice_is_anisotropic() {
    let grains = "[grains.square]\nradius = 1.5\nrows = { count = 6, longest = 6 }";
    let size = "width = 18.0\nheight = \"fit\"";
    let scene = block(grains, size, "", "{ x = [3.1, 14.9], y = [3.1, 14.9] }");
    let found = measured(&scene).tangent;
    let rows = [
        [NORMAL, 0.0, 0.0],
        [0.0, NORMAL, 0.0],
        [0.0, 0.0, 0.5 * SHEAR],
    ];
    let expected = ElasticityTensor { rows };
    assert!(found.minus(&expected).norm() < 1e-12, "{found:?}");
    assert!(found.anisotropy().is_some_and(|a| a > 0.1));
}

#[test]
fn an_empty_window_has_no_moduli() {
    let scene = dropped(1, "\"all\"");
    let none = Window::new(Vec::new(), scene.assembly.grains.len());
    assert_eq!(moduli(&scene.assembly, &tangents(&scene), &none), None);
}

/// The law as printed, its shear stiffness rising under compression, has no potential where contacts are sheared.
#[test]
fn contacts_without_potential_make_moduli_that_are_not_symmetric() {
    let grains = "[grains.dropped]\ncount = 70\nradius = { from = 0.5, to = 1.0 }";
    let size = "width = 13.0\nheight = \"fit\"";
    let more = "shear_hardening = 0.5\nshear_floor = 0.01";
    let scene = block(grains, size, more, "\"undisturbed\"");
    let asymmetry = measured(&scene)
        .tangent
        .asymmetry()
        .expect("a stiff window");
    assert!(asymmetry > 1e-5 && asymmetry < 0.1, "{asymmetry}");
}

/// The answer to a uniform strain of the rim as a state that measures can read.
fn answer(scene: &Scene, field: &PerBody<kavics::equilibrium::Displacement>) -> State {
    let tangents = tangents(scene);
    let contacts = scene
        .assembly
        .contacts
        .values()
        .iter()
        .zip(tangents.values());
    let state = |(contact, k)| {
        let frame = ContactFrame::new(&scene.assembly, contact);
        let v = frame.relative_displacement(field[frame.first], field[frame.second]);
        ContactState {
            displacement: v,
            force: ContactForce::linear(k, v),
            property: Some(PropertyId(0)),
            broken: false,
            phase: Phase::Closed,
        }
    };
    State {
        displacements: field.clone(),
        contacts: contacts.map(state).collect(),
    }
}

/// Σ l²·k over the contacts of a window of all grains, sides included.
fn sum_of_squared_lengths(assembly: &Assembly, stiffness: f64) -> f64 {
    let lengths = assembly.contacts.values().iter().map(|c| c.branch_length);
    lengths.map(|l| l * l * stiffness).sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// The uniform strain is one of the fields among which the answer has the least energy.
    #[test]
    fn moduli_are_symmetric_positive_and_below_their_bound(seed in 0_u64..1000, all in any::<bool>()) {
        let scene = dropped(seed, if all { "\"all\"" } else { "\"undisturbed\"" });
        let Moduli { tangent, voigt } = measured(&scene);
        let rounding = 1e-12 * voigt.norm();
        prop_assert!(tangent.asymmetry().is_some_and(|a| a < 1e-12));
        prop_assert!(tangent.is_positive(rounding));
        prop_assert!(voigt.minus(&tangent).is_positive(rounding));
        prop_assert!(tangent.norm() < 0.99 * voigt.norm(), "nothing relaxed");
    }

    /// K = Σ l²·k_n/4A, G = Σ l²·(k_n + k_t)/8A in any pack: Bathurst & Rothenburg (1988).
    #[test]
    fn the_bound_has_the_mean_field_moduli(seed in 0_u64..1000) {
        let scene = dropped(seed, "\"all\"");
        let voigt = measured(&scene).voigt;
        let area: f64 = scene.assembly.cell_area.values().iter().sum();
        let sum = |stiffness| sum_of_squared_lengths(&scene.assembly, stiffness) / area;
        prop_assert!((voigt.bulk_modulus() - sum(NORMAL) / 4.0).abs() < 1e-12 * voigt.norm());
        let shear = sum(NORMAL + SHEAR) / 8.0;
        prop_assert!((voigt.shear_modulus() - shear).abs() < 1e-12 * voigt.norm());
    }

    /// Average stress and strain of the answer, by their own measures, are columns of the moduli and unit strains.
    #[test]
    fn moduli_are_average_stress_over_average_strain(seed in 0_u64..1000) {
        let scene = dropped(seed, "\"undisturbed\"");
        let (assembly, window) = (&scene.assembly, window(&scene));
        let mut fields = uniform_strains(assembly);
        let free = inside(assembly, &window);
        relax(assembly, &tangents(&scene), &free, &mut fields).expect("an answer");
        let found = measured(&scene).tangent;
        let loads = PerBody::filled(Load::default(), assembly.body_count());
        for (column, field) in fields.iter().enumerate() {
            let state = answer(&scene, field);
            let snapshot = Snapshot { assembly, state: &state, loads: &loads, reactions: &loads };
            let stress = average_stress(&snapshot, &window).expect("a window").symmetric();
            for (row, component) in [stress.xx, stress.yy, stress.xy].into_iter().enumerate() {
                prop_assert!((component - found.rows[row][column]).abs() < 1e-11);
            }
            let mut unit = [0.0; 3];
            unit[column] = 1.0;
            let Tensor { xx, xy, yx, yy } = strain(&snapshot, &window).expect("triangles");
            for (component, expected) in [xx, yy, xy + yx].into_iter().zip(unit) {
                prop_assert!((component - expected).abs() < 1e-12);
            }
        }
    }

    /// Whatever breaks, the moduli of the same window do not grow.
    #[test]
    fn a_contact_less_is_not_stiffer(seed in 0_u64..1000, broken in 0_usize..1000) {
        let scene = dropped(seed, "\"undisturbed\"");
        let before = measured(&scene).tangent;
        let mut fewer = tangents(&scene);
        let inner = |c: &&kavics::assembly::Contact| c.grains().count() == 2;
        let contacts = scene.assembly.contacts.values().iter().filter(inner).count();
        fewer.values_mut()[broken % contacts] = Matrix::default();
        let after = moduli(&scene.assembly, &fewer, &window(&scene)).expect("a window").tangent;
        prop_assert!(before.minus(&after).is_positive(1e-12 * before.norm()));
    }
}

#[test]
fn grains_at_sides_and_at_the_rim_are_not_inside() {
    let scene = dropped(1, "\"undisturbed\"");
    let inside = inside(&scene.assembly, &window(&scene));
    for contact in scene.assembly.contacts.values() {
        for grain in contact.grains().filter(|&grain| inside[grain]) {
            let other = [contact.first, contact.second];
            assert!(
                other.iter().all(|partner| match partner {
                    Partner::Grain(grain) => window(&scene).contains(*grain),
                    Partner::Side(_) => false,
                }),
                "grain {grain}"
            );
        }
    }
    assert!(inside.values().iter().filter(|inside| **inside).count() > 10);
}
