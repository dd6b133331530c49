//! Equilibria by iteration are those by a factor.

use std::mem::discriminant;

use kavics::assembly::{
    Assembly, Between, Bodies, ContactGraph, Shaping, box_sides, contact_graph,
};
use kavics::contact_law::{Cemented, Law, Property, Reading, StiffnessRule, Strength};
use kavics::equilibrium::{
    Breakdown, Equilibrium, Freedom, Iteration, Load, Settings, SolveError, SolverChoice, Warning,
};
use kavics::ids::{BodyId, GrainId, Id, PerProperty, PerSide, PropertyId};
use kavics::loading::{Action, AppliedLoad, Breakage, Held, LoadPath, Program, Stage};
use kavics::packing::{Bed, dropped};
use proptest::prelude::*;

/// A dropped pack in a box, glued to its floor, walls and lid; of its contacts only those are there that `keep` names.
fn pack(count: usize, width: f64, seed: u64, keep: impl Fn(usize) -> bool) -> Assembly {
    let radii: Vec<f64> = (0..count)
        .map(|k| 0.5 + (k * 7 % 40) as f64 / 40.0)
        .collect();
    let bed = Bed::empty_box(width);
    let grains = dropped::drop(&bed, &radii, 1, seed).expect("a pack").grains;
    let tops = grains.values().iter().map(|g| g.centre.y + g.radius);
    let sides = box_sides(width, tops.fold(0.0, f64::max), [true; 4]);
    let reach = PerSide::filled(0.0, 4);
    let graph = contact_graph(&grains, &sides, Between::Touching, &reach, 1e-7);
    let ContactGraph {
        sites,
        cell_area,
        triangles,
    } = graph;
    let contacts = sites.iter().enumerate().filter(|(k, _)| keep(*k));
    let contact = |site: &kavics::assembly::Site| {
        let bodies = Bodies {
            grains: &grains,
            sides: &sides,
        };
        site.contact(Shaping::default(), bodies, PropertyId(0), 1.0)
    };
    Assembly {
        contacts: contacts.map(|(_, site)| contact(site)).collect(),
        grains,
        sides,
        cell_area,
        triangles,
        thickness: 1.0,
    }
}

fn cement(shear: f64, shear_hardening: f64) -> PerProperty<Property> {
    let law = Law::Cemented(Cemented {
        stiffness: StiffnessRule::Layer { normal: 1e4, shear },
        shear_hardening,
        reading: Reading::Printed,
        shear_floor: (shear > 0.0).then_some(0.01),
        eccentric: false,
        strength: Strength::UNBREAKABLE,
        after_breakage: None,
    });
    vec![Property {
        name: "cement".into(),
        law,
    }]
    .into()
}

/// Floor and walls held, the lid free to rise and to turn; loads on the lid and on a grain; one grain held in part.
fn program(assembly: &Assembly, loaded: u32, load: Load) -> Program {
    let side = |side: usize| BodyId::from_index(assembly.grains.len() + side);
    let held = |body, freedom| Held { body, freedom };
    let freedoms = [Freedom::X, Freedom::Y, Freedom::Rotation];
    let sides = (0..3).flat_map(|s| freedoms.map(|freedom| held(side(s), freedom)));
    let part = [held(side(3), Freedom::X), held(BodyId(0), Freedom::X)];
    let applied = |body, load| AppliedLoad {
        body,
        load,
        action: 0,
    };
    let press = Load {
        x: 0.0,
        y: -1.0,
        moment: 0.2,
    };
    Program {
        actions: vec![Action {
            name: "load".into(),
        }],
        held: sides.chain(part).collect(),
        loads: vec![applied(BodyId(loaded), load), applied(side(3), press)],
        stages: vec![Stage {
            name: "load".into(),
            actions: vec![0],
            factors: vec![1.0],
        }],
        ..Program::default()
    }
}

fn solve(
    assembly: &Assembly,
    properties: &PerProperty<Property>,
    program: &Program,
    settings: Settings,
) -> Result<Equilibrium, SolveError> {
    let breakage = Breakage::WorstFirst;
    let path = LoadPath::new(assembly, properties, program, breakage, settings);
    path.last().expect("a load step")
}

fn settings(solver: SolverChoice) -> Settings {
    Settings {
        solver,
        ..Settings::default()
    }
}

/// Largest difference of two sets of contact forces over the largest of them.
fn difference(one: &Equilibrium, other: &Equilibrium) -> f64 {
    let forces = |e: &Equilibrium| -> Vec<[f64; 2]> {
        let contacts = e.state.contacts.values().iter();
        contacts.map(|c| [c.force.normal, c.force.shear]).collect()
    };
    let (one, other) = (forces(one), forces(other));
    let largest = one.iter().map(|q| q[0].hypot(q[1])).fold(0.0, f64::max);
    let pairs = one.iter().zip(&other);
    let apart = pairs.map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
    apart.fold(0.0, f64::max) / largest
}

const PUSH: Load = Load {
    x: 0.3,
    y: -1.0,
    moment: 0.1,
};

#[test]
fn contact_forces_are_those_of_a_factor_to_ten_times_the_tolerance() {
    let assembly = pack(10_000, 130.0, 1, |_| true);
    let program = program(&assembly, 9_000, PUSH);
    let run = |choice| {
        let settings = settings(choice);
        solve(&assembly, &cement(6e3, 0.0), &program, settings).expect("an equilibrium")
    };
    let (factor, iterated) = (run(SolverChoice::Direct), run(SolverChoice::Iterative));
    assert_eq!(iterated.warnings, [Warning::FloppyModesUncounted]);
    assert!(iterated.residual <= 1e-10);
    assert!(iterated.iterations <= 3, "{}", iterated.iterations);
    let apart = difference(&factor, &iterated);
    assert!(apart <= 1e-9, "{apart:e}");
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let assembly = pack(6_000, 100.0, 2, |_| true);
    let program = program(&assembly, 5_000, PUSH);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(|| {
            let settings = settings(SolverChoice::Iterative);
            solve(&assembly, &cement(6e3, 0.0), &program, settings).expect("an equilibrium")
        })
    };
    let (one, two) = (run(1).state, run(2).state);
    assert_eq!(one.displacements, two.displacements);
    assert_eq!(one.contacts, two.contacts);
}

/// A shear stiffness below zero makes single grains unstable, and the assembly with them.
#[test]
fn an_indefinite_stiffness_is_solved_directly_and_said() {
    let assembly = pack(300, 20.0, 3, |_| true);
    let program = program(&assembly, 200, PUSH);
    let run = |choice| solve(&assembly, &cement(-6e3, 0.0), &program, settings(choice));
    let (factor, iterated) = (
        run(SolverChoice::Direct).expect("an equilibrium"),
        run(SolverChoice::Iterative).expect("an equilibrium"),
    );
    let breakdown = Breakdown::NotPositive;
    assert!(
        iterated
            .warnings
            .contains(&Warning::SolvedDirectly { breakdown })
    );
    assert_eq!(factor.state.displacements, iterated.state.displacements);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// With contacts missing, pieces hang by one bond, are loose, or are loaded and held by nothing.
    #[test]
    fn small_assemblies_end_as_by_a_factor(seed in 0_u64..1000, loaded in 0_u32..150, missing in 0_usize..60, count in 20_usize..150) {
        let assembly = pack(count, 15.0, seed, |k| (k * 31 + seed as usize) % 100 >= missing);
        let program = program(&assembly, loaded % count as u32, PUSH);
        let run = |solver| {
            let settings = Settings { tolerance: 1e-12, ..settings(solver) };
            solve(&assembly, &cement(6e3, 0.0), &program, settings)
        };
        match (run(SolverChoice::Direct), run(SolverChoice::Iterative)) {
            (Ok(factor), Ok(iterated)) => {
                let apart = difference(&factor, &iterated);
                prop_assert!(apart <= 1e-8, "{apart:e}");
                prop_assert_eq!(factor.set_aside, iterated.set_aside);
            }
            (Err(factor), Err(iterated)) => prop_assert_eq!(discriminant(&factor), discriminant(&iterated)),
            (factor, iterated) => prop_assert!(false, "{:?} {:?}", factor.is_ok(), iterated.is_ok()),
        }
    }

    /// The tangent of the printed law is not symmetric.
    #[test]
    fn an_unsymmetric_tangent_ends_as_by_a_factor(seed in 0_u64..1000, loaded in 0_u32..120, push in 1.0_f64..100.0) {
        let assembly = pack(120, 15.0, seed, |_| true);
        let load = Load { x: 0.3 * push, y: -push, moment: 0.0 };
        let program = program(&assembly, loaded, load);
        let run = |solver| {
            let settings = Settings { iteration: Iteration::Tangent, tolerance: 1e-12, ..settings(solver) };
            solve(&assembly, &cement(6e3, 0.75), &program, settings).expect("an equilibrium")
        };
        let (factor, iterated) = (run(SolverChoice::Direct), run(SolverChoice::Iterative));
        prop_assert_eq!(&iterated.warnings, &[Warning::FloppyModesUncounted]);
        prop_assert_eq!(&factor.warnings, &[]);
        let apart = difference(&factor, &iterated);
        prop_assert!(apart <= 1e-8, "{apart:e}");
    }
}

/// Grains by their ids stand where they were, whatever the solver numbers them by.
#[test]
fn a_single_grain_on_the_floor_is_pressed() {
    let assembly = pack(1, 3.0, 1, |_| true);
    let program = program(&assembly, 0, PUSH);
    let iterated = solve(
        &assembly,
        &cement(6e3, 0.0),
        &program,
        settings(SolverChoice::Iterative),
    );
    let state = iterated.expect("an equilibrium").state;
    assert!(state.displacements[BodyId(GrainId(0).0)].y < 0.0);
}
