//! What holds at every equilibrium, whatever the pack and the load.

use kavics::assembly::{
    Assembly, Between, Bodies, ContactGraph, Shaping, box_sides, contact_graph,
};
use kavics::contact_law::{Cemented, Law, Property, Reading, StiffnessRule, Strength};
use kavics::equilibrium::{Displacement, Equilibrium, Freedom, Iteration, Load, Settings};
use kavics::ids::{BodyId, GrainId, Id, PerProperty, PerSide, PropertyId};
use kavics::loading::{Action, AppliedLoad, Breakage, Held, LoadPath, Program, Stage};
use kavics::packing::{Bed, dropped};
use proptest::prelude::*;

const GRAINS: usize = 40;

/// A dropped pack on a floor that it is glued to.
fn pack(seed: u64) -> Assembly {
    let radii: Vec<f64> = (0..GRAINS)
        .map(|k| 0.5 + (k * 7 % GRAINS) as f64 / GRAINS as f64)
        .collect();
    let grains = dropped::drop(&Bed::empty_box(12.0), &radii, 1, seed)
        .expect("a pack")
        .grains;
    let top = grains
        .values()
        .iter()
        .map(|g| g.centre.y + g.radius)
        .fold(0.0, f64::max);
    let sides = box_sides(12.0, top, [true, true, true, false]);
    let ContactGraph {
        sites,
        cell_area,
        triangles,
    } = contact_graph(
        &grains,
        &sides,
        Between::Touching,
        &PerSide::filled(0.0, 4),
        1e-7,
    );
    let bodies = Bodies {
        grains: &grains,
        sides: &sides,
    };
    let contacts = sites
        .iter()
        .map(|s| s.contact(Shaping::default(), bodies, PropertyId(0), 1.0))
        .collect();
    Assembly {
        grains,
        sides,
        contacts,
        cell_area,
        triangles,
        thickness: 1.0,
    }
}

fn cement(modulus: f64, hardening: f64) -> PerProperty<Property> {
    let law = Law::Cemented(Cemented {
        stiffness: StiffnessRule::Layer {
            normal: modulus,
            shear: 0.6 * modulus,
        },
        shear_hardening: hardening,
        reading: Reading::Printed,
        shear_floor: Some(0.01),
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

/// One force on one grain, the sides held.
fn solve(
    assembly: &Assembly,
    properties: &PerProperty<Property>,
    loaded: GrainId,
    load: Load,
    settings: Settings,
) -> Equilibrium {
    let side = |side: usize| BodyId::from_index(assembly.grains.len() + side);
    let freedoms = [Freedom::X, Freedom::Y, Freedom::Rotation];
    let program = Program {
        actions: vec![Action {
            name: "load".into(),
        }],
        held: (0..4)
            .flat_map(|s| {
                freedoms.map(|freedom| Held {
                    body: side(s),
                    freedom,
                })
            })
            .collect(),
        loads: vec![AppliedLoad {
            body: BodyId(loaded.0),
            load,
            action: 0,
        }],
        stages: vec![Stage {
            name: "load".into(),
            actions: vec![0],
            factors: vec![1.0],
        }],
        ..Program::default()
    };
    let path = LoadPath::new(
        assembly,
        properties,
        &program,
        Breakage::WorstFirst,
        settings,
    );
    path.last().expect("a load step").expect("an equilibrium")
}

fn displacement(equilibrium: &Equilibrium, grain: GrainId) -> Displacement {
    equilibrium.state.displacements[BodyId(grain.0)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn forces_and_moments_balance(seed in 0_u64..1000, grain in 0..GRAINS as u32, x in -1.0..1.0, y in -1.0..1.0, moment in -1.0..1.0, hardening in 0.0..0.5) {
        let assembly = pack(seed);
        let load = Load { x, y, moment };
        let end = solve(&assembly, &cement(1e4, hardening), GrainId(grain), load, Settings::default());
        prop_assert!(end.residual <= 1e-10);
        let centre = assembly.grains[GrainId(grain)].centre;
        let mut sum = [x, y, moment + centre.x * y - centre.y * x];
        for (side, body) in assembly.sides.values().iter().zip(assembly.grains.len()..) {
            let (r, at) = (end.reactions[BodyId::from_index(body)], side.middle());
            sum[0] += r.x;
            sum[1] += r.y;
            sum[2] += r.moment + at.x * r.y - at.y * r.x;
        }
        prop_assert!(sum.iter().all(|s| s.abs() < 1e-9), "{sum:?}");
    }

    /// Betti: the work of one load on the displacements of another is that of the other on those of the one.
    #[test]
    fn works_are_reciprocal(seed in 0_u64..1000, one in 0..GRAINS as u32, other in 0..GRAINS as u32) {
        let assembly = pack(seed);
        let properties = cement(1e4, 0.0);
        let loads = [Load { x: 1.0, y: 0.3, moment: -0.2 }, Load { x: -0.4, y: 1.0, moment: 0.5 }];
        let first = solve(&assembly, &properties, GrainId(one), loads[0], Settings::default());
        let second = solve(&assembly, &properties, GrainId(other), loads[1], Settings::default());
        let works = [loads[0].work(displacement(&second, GrainId(one))), loads[1].work(displacement(&first, GrainId(other)))];
        prop_assert!((works[0] - works[1]).abs() < 1e-9 * works[0].abs().max(1e-6), "{works:?}");
    }

    #[test]
    fn secant_and_tangent_end_at_the_same_equilibrium(seed in 0_u64..1000, grain in 0..GRAINS as u32, push in 1.0_f64..200.0) {
        let assembly = pack(seed);
        let properties = cement(1e4, 0.75);
        let load = Load { x: 0.3 * push, y: -push, moment: 0.0 };
        let solve = |iteration| {
            solve(&assembly, &properties, GrainId(grain), load, Settings { iteration, tolerance: 1e-12, ..Settings::default() })
        };
        let (secant, tangent) = (solve(Iteration::Secant), solve(Iteration::Tangent));
        let size = displacement(&secant, GrainId(grain)).largest_length(1.0);
        for (a, b) in secant.state.displacements.values().iter().zip(tangent.state.displacements.values()) {
            prop_assert!((*a - *b).largest_length(1.0) < 1e-9 * size);
        }
    }

    /// A bonded assembly of constant stiffness stores half the work of its load.
    #[test]
    fn energy_held_is_half_the_work_of_the_load(seed in 0_u64..1000, grain in 0..GRAINS as u32) {
        let assembly = pack(seed);
        let load = Load { x: 0.5, y: -1.0, moment: 0.1 };
        let end = solve(&assembly, &cement(1e4, 0.0), GrainId(grain), load, Settings::default());
        let work = 0.5 * load.work(displacement(&end, GrainId(grain)));
        prop_assert!((end.energy.elastic_energy - work).abs() < 1e-10 * work);
        prop_assert!(end.energy.ledger_error().abs() < 1e-10 * work);
    }
}
