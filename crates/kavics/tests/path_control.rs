//! Load paths beyond the peak: softening bonds, steered by displacement or by the energy that they take.

use std::path::Path;

use kavics::assembly::{Assembly, Contact, Grain, Partner};
use kavics::contact_law::{
    Cemented, Law, Property, Reading, StiffnessRule, Strength, StrengthKind,
};
use kavics::equilibrium::{Equilibrium, EventKind, Freedom, Load, Settings, SolveError, Warning};
use kavics::geometry::Vector;
use kavics::ids::{BodyId, GrainId, PerProperty, PropertyId};
use kavics::loading::{
    Action, AppliedLoad, Breakage, Control, Held, LoadPath, PathControl, Prescribed, Program, Stage,
};
use kavics::scene::Scene;

/// Normal stiffness of every contact.
const STIFFNESS: f64 = 1.0;
const LIMIT: f64 = 0.1;
/// Of a contact, whose dual length is 1.
const FRACTURE_ENERGY: f64 = 0.0075;

/// Discs of radius 1 in a row; contact k has property `properties[k]`.
fn row(properties: &[u32]) -> Assembly {
    let grains: Vec<Grain> = (0..=properties.len())
        .map(|k| Grain {
            centre: Vector::new(2.0 * k as f64, 0.0),
            radius: 1.0,
        })
        .collect();
    let contact = |(k, property): (usize, &u32)| Contact {
        first: Partner::Grain(GrainId(k as u32)),
        second: Partner::Grain(GrainId(k as u32 + 1)),
        normal: Vector::new(1.0, 0.0),
        branch_length: 2.0,
        point: Vector::new(2.0 * k as f64 + 1.0, 0.0),
        dual_parts: [0.5, 0.5],
        dual_length_full: 1.0,
        property: PropertyId(*property as _),
        strength_factor: 1.0,
    };
    let contacts: Vec<Contact> = properties.iter().enumerate().map(contact).collect();
    Assembly {
        grains: grains.into(),
        contacts: contacts.into(),
        thickness: 1.0,
        ..Assembly::default()
    }
}

fn cement(tension: f64, fracture_energy: Option<f64>) -> Law {
    Law::Cemented(Cemented {
        stiffness: StiffnessRule::Layer {
            normal: STIFFNESS,
            shear: 0.5,
        },
        shear_hardening: 0.0,
        reading: Reading::Printed,
        shear_floor: None,
        eccentric: false,
        strength: Strength {
            kind: StrengthKind::Force,
            tension,
            fracture_energy,
            ..Strength::UNBREAKABLE
        },
        after_breakage: None,
    })
}

/// Property 0 holds everything, 1 softens, 2 softens and is a little stronger.
fn properties() -> PerProperty<Property> {
    let laws = [
        cement(f64::INFINITY, None),
        cement(LIMIT, Some(FRACTURE_ENERGY)),
        cement(1.05 * LIMIT, Some(FRACTURE_ENERGY)),
    ];
    laws.into_iter()
        .map(|law| Property {
            name: law.name().into(),
            law,
        })
        .collect()
}

/// The first disc held, the last pulled by 1 at factor 1, or moved by it; factors of each stage.
fn pull(assembly: &Assembly, by_move: bool, stages: &[&[f64]]) -> Program {
    let last = BodyId(assembly.grains.len() as u32 - 1);
    let freedoms = [Freedom::X, Freedom::Y, Freedom::Rotation];
    let mut program = Program {
        actions: vec![Action {
            name: "pull".into(),
        }],
        held: freedoms
            .map(|freedom| Held {
                body: BodyId(0),
                freedom,
            })
            .to_vec(),
        stages: stages
            .iter()
            .map(|factors| Stage {
                name: "pull".into(),
                actions: vec![0],
                factors: factors.to_vec(),
            })
            .collect(),
        ..Program::default()
    };
    if by_move {
        program.prescribed.push(Prescribed {
            body: last,
            freedom: Freedom::X,
            amplitude: 1.0,
            action: 0,
        });
    } else {
        program.loads.push(AppliedLoad {
            body: last,
            load: Load {
                x: 1.0,
                ..Load::default()
            },
            action: 0,
        });
    }
    program
}

fn follow(
    assembly: &Assembly,
    program: &Program,
    control: Control,
    most_steps: usize,
) -> (Vec<Equilibrium>, Option<SolveError>) {
    let properties = properties();
    let settings = Settings::default();
    let breakage = Breakage::WorstFirst;
    let path = LoadPath::new(assembly, &properties, program, breakage, settings);
    let path = path.steered_by(PathControl {
        control,
        most_steps,
    });
    let (mut found, mut error) = (Vec::new(), None);
    for step in path {
        match step {
            Ok(equilibrium) => found.push(equilibrium),
            Err(failure) => error = Some(failure),
        }
    }
    (found, error)
}

fn factors(to: f64, steps: usize) -> Vec<f64> {
    (1..=steps).map(|k| to * k as f64 / steps as f64).collect()
}

fn end_displacement(equilibrium: &Equilibrium) -> f64 {
    equilibrium
        .state
        .displacements
        .values()
        .last()
        .expect("a disc")
        .x
}

fn is_separated(path: &[Equilibrium]) -> bool {
    path.last()
        .is_some_and(|end| end.warnings.contains(&Warning::Separated))
}

fn show(path: &[Equilibrium], error: Option<&SolveError>) {
    for e in path {
        println!(
            "{:3} f {:.9} u {:.9} it {} cuts {} res {:.1e} D {:.9} U {:.9} W {:.9} ledger {:.2e} events {}",
            e.step,
            e.load_factor,
            end_displacement(e),
            e.iterations,
            e.cuts,
            e.residual,
            e.energy.fracture_energy,
            e.energy.elastic_energy,
            e.energy.external_work,
            e.energy.ledger_error(),
            e.events.len()
        );
    }
    println!("{error:?}");
}

/// Opening of the weak bond at which it carries a force on its softening branch: v_u = 2·G_f·s/Q, v_e = Q/k.
fn softened_opening(force: f64) -> f64 {
    let (broken, elastic) = (2.0 * FRACTURE_ENERGY / LIMIT, LIMIT / STIFFNESS);
    broken - force * (broken - elastic) / LIMIT
}

#[test]
fn two_contacts_in_series_snap_back_along_the_closed_form() {
    for control in [Control::Dissipation, Control::Auto] {
        let assembly = row(&[0, 1]);
        let program = pull(&assembly, false, &[&factors(0.2, 10)]);
        let (path, error) = follow(&assembly, &program, control, 500);
        show(&path, error.as_ref());
        assert!(error.is_none() && is_separated(&path));
        let mut softened = 0;
        for e in &path[..path.len() - 1] {
            let (force, u) = (e.load_factor, end_displacement(e));
            let elastic = 2.0 * force / STIFFNESS;
            let softening = force / STIFFNESS + softened_opening(force);
            let on_elastic = (u - elastic).abs() < 1e-8;
            assert!(
                on_elastic || (u - softening).abs() < 1e-8,
                "{force} {u} {softening}"
            );
            softened += usize::from(!on_elastic);
            assert!(e.energy.ledger_error().abs() < 1e-10);
        }
        assert!(softened > 3);
        // 1/k > (v_u − v_e)/Q: the displacement falls from 2·Q/k at the peak to v_u.
        let last = &path[path.len() - 1];
        assert!((end_displacement(last) - 2.0 * FRACTURE_ENERGY / LIMIT).abs() < 1e-4);
        assert_eq!(last.load_factor, 0.0);
        assert!(
            (last.energy.fracture_energy - FRACTURE_ENERGY).abs() < 1e-9 * FRACTURE_ENERGY.max(1.0)
        );
        assert!(last.energy.ledger_error().abs() < 1e-9);
    }
}

#[test]
fn a_softening_bar_takes_the_fracture_energy_of_the_bond_that_localises() {
    let assembly = row(&[2, 2, 1, 2, 2]);
    let program = pull(&assembly, false, &[&factors(0.2, 10)]);
    let (path, error) = follow(&assembly, &program, Control::Auto, 500);
    show(&path, error.as_ref());
    assert!(is_separated(&path));
    let last = &path[path.len() - 1].energy;
    assert!(
        (last.fracture_energy - FRACTURE_ENERGY).abs() < 1e-8,
        "{last:?}"
    );
    assert!(last.ledger_error().abs() < 1e-9);
    let events = path.iter().flat_map(|e| &e.events);
    let broke: Vec<f64> = events
        .filter_map(|event| match event.kind {
            EventKind::Broke {
                fracture_energy, ..
            } => Some(fracture_energy),
            _ => None,
        })
        .collect();
    assert!(broke.len() == 1 && (broke[0] - FRACTURE_ENERGY).abs() < 1e-8);
}

#[test]
fn a_moved_end_goes_back_and_forth_through_the_snap_back() {
    let assembly = row(&[0, 1]);
    let program = pull(&assembly, true, &[&factors(0.4, 20)]);
    let (path, error) = follow(&assembly, &program, Control::Auto, 500);
    show(&path, error.as_ref());
    assert!(error.is_none() && !is_separated(&path));
    let last = &path[path.len() - 1];
    assert_eq!(last.load_factor, 0.4);
    assert!((last.energy.fracture_energy - FRACTURE_ENERGY).abs() < 1e-8);
    assert!((last.energy.external_work - FRACTURE_ENERGY).abs() < 1e-8);
    let fell = path
        .windows(2)
        .filter(|w| w[1].load_factor < w[0].load_factor);
    assert!(fell.count() > 3);
}

#[test]
fn under_displacement_control_the_load_falls_beyond_the_peak() {
    // One bond alone does not snap back: 2·G_f·s/Q = 0.15 > Q/k = 0.1.
    let assembly = row(&[1]);
    let program = pull(&assembly, false, &[&factors(0.16, 16)]);
    let (path, error) = follow(&assembly, &program, Control::Displacement, 100);
    show(&path, error.as_ref());
    for (step, e) in path.iter().enumerate().take(15) {
        let u = 0.01 * step as f64;
        assert!((end_displacement(e) - u).abs() < 1e-9, "{step}");
        let force = if u <= 0.1 {
            u
        } else {
            LIMIT * (0.15 - u) / 0.05
        };
        assert!((e.load_factor - force).abs() < 1e-8, "{step}");
    }
    assert!(is_separated(&path));
}

#[test]
fn all_controls_agree_before_the_peak() {
    let assembly = row(&[2, 1, 0]);
    let program = pull(&assembly, false, &[&factors(0.09, 9)]);
    let (by_load, _) = follow(&assembly, &program, Control::Load, 10);
    for control in [Control::Displacement, Control::Dissipation, Control::Auto] {
        let (path, error) = follow(&assembly, &program, control, 10);
        assert!(error.is_none() && path.len() == by_load.len());
        for (a, b) in path.iter().zip(&by_load) {
            assert!((a.load_factor - b.load_factor).abs() < 1e-12, "{control:?}");
            assert!((end_displacement(a) - end_displacement(b)).abs() < 1e-9);
        }
    }
}

#[test]
fn a_softened_assembly_unloads_to_the_origin() {
    for control in [Control::Load, Control::Auto] {
        let assembly = row(&[1]);
        let program = pull(
            &assembly,
            true,
            &[&[0.12], &[0.06, 0.0], &[0.06, 0.12, 0.14]],
        );
        let (path, error) = follow(&assembly, &program, control, 200);
        show(&path, error.as_ref());
        assert!(error.is_none());
        let at = |factor: f64, stage: usize| {
            let found = path
                .iter()
                .find(|e| e.stage == stage && e.load_factor == factor);
            let e = found.expect("this factor");
            (e.state.contacts.values()[0].force.normal, e.energy)
        };
        // On the softening branch at v = 0.12: Q·(v_u − v)/(v_u − v_e).
        let (force, energy) = at(0.12, 0);
        assert!((force - 0.06).abs() < 1e-9);
        assert!((at(0.06, 1).0 - 0.03).abs() < 1e-9);
        assert_eq!(at(0.0, 1).0, 0.0);
        assert!((at(0.0, 1).1.fracture_energy - energy.fracture_energy).abs() < 1e-15);
        assert!((at(0.12, 2).0 - 0.06).abs() < 1e-9);
        assert!((at(0.14, 2).0 - 0.02).abs() < 1e-9);
    }
}

#[test]
fn a_path_ends_at_the_number_of_steps_that_the_scene_allows() {
    let assembly = row(&[0, 1]);
    let program = pull(&assembly, false, &[&factors(0.2, 4)]);
    let (path, error) = follow(&assembly, &program, Control::Auto, 1);
    assert_eq!(path.len(), 6);
    let error = error.expect("an error");
    assert!(matches!(error, SolveError::MostSteps { most_steps: 5, .. }));
    let text = "load step 6: 5 load steps of stage `pull` end at load factor";
    assert!(error.to_string().starts_with(text), "{error}");
}

#[test]
fn a_block_with_scattered_strengths_goes_to_separation_and_the_ledger_closes() {
    let text = "
seed = 4
[box]
width = 10.0
height = \"fit\"
[grains.hexagonal]
radius = 1.0
rows = [5, 4, 5, 4, 5, 4, 5]
[contact.mortar.cemented]
stiffness.modulus = { normal = 1000.0, shear = 400.0 }
strength.stress = { tension = 1.0, shear = 2.0, bending = 2.0 }
strength.scatter.weibull = { shape = 6.0 }
fracture_energy = 0.02
[[support]]
grains = { edge = \"bottom\" }
fix = [\"x\", \"y\"]
[[load]]
name = \"pull\"
edge = \"top\"
normal = [1.0, 1.0]
[[stage]]
factors = { to = 2.0, steps = 20 }
[equilibrium]
control = \"auto\"
";
    let nothing = |_: &Path, _| Err(String::new());
    let scene = Scene::parse(text, "block", Path::new(""), &nothing).expect("a scene");
    let (mut path, mut error) = (Vec::new(), None);
    for step in scene.load_path() {
        match step {
            Ok(e) => path.push(e),
            Err(failure) => error = Some(failure),
        }
    }
    show(&path, error.as_ref());
    assert!(error.is_none() && is_separated(&path));
    let last = &path[path.len() - 1].energy;
    let error = last.ledger_error().abs();
    assert!(error < 1e-3 * last.external_work, "{error}");
}

/// Apart from one another between a floor that holds them and a lid that they leave one by one: each is loaded otherwise.
fn leaving(grains: usize) -> Scene {
    let width = 3 * grains;
    let text = format!(
        "[box]\nwidth = {width}\nheight = 2.0\n[grains.listed]\nfile = \"Cargo.toml\"\n\
         [contact.glue.cemented]\nstiffness.direct = {{ normal = 1.0, shear = 1.0, moment = 1.0 }}\n\
         [contact.dry.cohesionless]\nstiffness.direct = {{ normal = 1.0, shear = 1.0 }}\nfriction = 0.5\n\
         [side.bottom]\ncontact = \"glue\"\n[side.top]\ncontact = \"dry\"\n\
         [[load]]\nname = \"press\"\nedge = \"top\"\nnormal = [-0.01, -0.02]\n\
         [[stage]]\nfactors = [1.0]\n[equilibrium]\ncontrol = \"displacement\"\n"
    );
    // A file that is there; its grains come from here.
    let row = |_: &Path, _: Option<usize>| {
        Ok((0..grains)
            .map(|k| [3.0 * k as f64 + 1.5, 1.0, 1.0])
            .collect())
    };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    Scene::parse(&text, "row", folder, &row).unwrap_or_else(|error| panic!("{error}"))
}

/// One contact after the other opens, so that each grain asks for one more set of phases, of 200 that are tried.
#[test]
fn a_steered_equilibrium_found_near_the_limit_is_told() {
    for (grains, is_near) in [(150, false), (170, true)] {
        let end = leaving(grains).load_path().last().expect("an equilibrium");
        let end = end.unwrap_or_else(|error| panic!("{error}"));
        let told = Warning::ManyIterations {
            iterations: grains + 1,
            limit: 200,
        };
        assert!(
            end.state
                .contacts
                .values()
                .iter()
                .filter(|c| !c.is_active())
                .count()
                == grains
        );
        assert_eq!(end.warnings.contains(&told), is_near, "{:?}", end.warnings);
    }
}
