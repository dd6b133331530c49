//! Equilibria of small assemblies with closed forms.

use kavics::assembly::{Assembly, Contact, Grain, Partner};
use kavics::contact_law::{
    Cemented, Cohesionless, ContactForce, Law, Property, Reading, StiffnessRule, Strength,
    StrengthKind,
};
use kavics::equilibrium::{Equilibrium, EventKind, Freedom, Iteration, Load, Settings, SolveError};
use kavics::geometry::Vector;
use kavics::ids::{BodyId, ContactId, GrainId, PerProperty, PropertyId};
use kavics::loading::{Action, AppliedLoad, Breakage, Held, LoadPath, Prescribed, Program, Stage};
use kavics::measure::{Snapshot, Window, measures};

/// Equal discs of radius 1 that touch where they are two apart; every dual length is `s`.
fn assembly(centres: &[(f64, f64)], s: f64) -> Assembly {
    let grains: Vec<Grain> = centres
        .iter()
        .map(|&(x, y)| Grain {
            centre: Vector::new(x, y),
            radius: 1.0,
        })
        .collect();
    let mut contacts = Vec::new();
    for (i, a) in grains.iter().enumerate() {
        for (j, b) in grains.iter().enumerate().skip(i + 1) {
            let branch = b.centre - a.centre;
            if (branch.length() - 2.0).abs() < 1e-9 {
                let normal = branch * (1.0 / branch.length());
                contacts.push(Contact {
                    first: Partner::Grain(GrainId(i as u32)),
                    second: Partner::Grain(GrainId(j as u32)),
                    normal,
                    branch_length: branch.length(),
                    point: a.centre + normal,
                    dual_parts: [0.5 * s, 0.5 * s],
                    dual_length_full: s,
                    property: PropertyId(0),
                    strength_factor: 1.0,
                });
            }
        }
    }
    Assembly {
        grains: grains.into(),
        contacts: contacts.into(),
        thickness: 1.0,
        ..Assembly::default()
    }
}

fn cement(shear: f64, hardening: f64, reading: Reading) -> Cemented {
    Cemented {
        stiffness: StiffnessRule::Layer { normal: 1.0, shear },
        shear_hardening: hardening,
        reading,
        shear_floor: None,
        eccentric: false,
        strength: Strength::UNBREAKABLE,
        after_breakage: None,
    }
}

fn properties(laws: impl IntoIterator<Item = Law>) -> PerProperty<Property> {
    laws.into_iter()
        .map(|law| Property {
            name: law.name().into(),
            law,
        })
        .collect()
}

fn held(body: u32, freedom: Freedom) -> Held {
    Held {
        body: BodyId(body),
        freedom,
    }
}

/// The first disc held in x and y, the second in y, the third pressed down by 1 at factor 1.
fn three_discs(factors: &[f64]) -> (Assembly, Program) {
    let assembly = assembly(&[(0.0, 0.0), (2.0, 0.0), (1.0, 3.0_f64.sqrt())], 1.2);
    let program = Program {
        actions: vec![Action {
            name: "press".into(),
        }],
        held: vec![
            held(0, Freedom::X),
            held(0, Freedom::Y),
            held(1, Freedom::Y),
        ],
        loads: vec![AppliedLoad {
            body: BodyId(2),
            load: Load {
                x: 0.0,
                y: -1.0,
                moment: 0.0,
            },
            action: 0,
        }],
        stages: vec![Stage {
            name: "press".into(),
            actions: vec![0],
            factors: factors.to_vec(),
        }],
        ..Program::default()
    };
    (assembly, program)
}

fn run(
    assembly: &Assembly,
    program: &Program,
    properties: &PerProperty<Property>,
    settings: Settings,
) -> Result<Vec<Equilibrium>, SolveError> {
    LoadPath::new(
        assembly,
        properties,
        program,
        Breakage::WorstFirst,
        settings,
    )
    .collect()
}

fn tangent() -> Settings {
    Settings {
        iteration: Iteration::Tangent,
        ..Settings::default()
    }
}

fn assert_close(found: f64, expected: f64, relative: f64) {
    assert!(
        (found - expected).abs() <= relative * expected.abs(),
        "found {found}, expected {expected}"
    );
}

/// Bojtár & Bagi's three discs: R = 1, E = 1, G₀ = 0.4, s = 1.2, P = 0.3; solved apart to 30 digits.
#[test]
fn three_discs_reach_the_reference_in_every_reading_and_iteration() {
    let reference = [
        (
            0.0,
            Reading::Printed,
            0.049_176_958_769_47,
            -0.167_588_495_575_22,
            0.055_309_734_513_274,
        ),
        (
            0.5,
            Reading::Printed,
            0.048_012_104_596_778,
            -0.166_579_702_269_97,
            0.058_111_938_138_986,
        ),
        (
            0.5,
            Reading::Potential,
            0.048_064_395_056_73,
            -0.166_118_485_605_55,
            0.057_986_146_842_612,
        ),
    ];
    let (assembly, program) = three_discs(&[0.3]);
    for (hardening, reading, u2x, u3y, rotation) in reference {
        for settings in [
            Settings {
                tolerance: 1e-13,
                ..Settings::default()
            },
            tangent(),
        ] {
            let properties = properties([Law::Cemented(cement(0.4, hardening, reading))]);
            let end = run(&assembly, &program, &properties, settings)
                .expect("an equilibrium")
                .pop()
                .expect("a step");
            let u = &end.state.displacements;
            assert_close(u[BodyId(1)].x, u2x, 1e-10);
            assert_close(u[BodyId(2)].y, u3y, 1e-10);
            assert_close(u[BodyId(1)].rotation, rotation, 1e-10);
        }
    }
}

#[test]
fn after_breakage_three_discs_return_to_the_origin_and_the_ledger_closes() {
    let (mut assembly, program) = three_discs(&[0.1, 0.2, 0.3, 0.4, 0.2, 0.0, 0.4]);
    // The lower contact breaks in tension between factors 0.2 and 0.3; the others hold.
    let mut weak = cement(0.4, 0.0, Reading::Printed);
    weak.strength = Strength {
        kind: StrengthKind::Force,
        tension: 0.05,
        ..Strength::UNBREAKABLE
    };
    let properties = properties([
        Law::Cemented(cement(0.4, 0.0, Reading::Printed)),
        Law::Cemented(weak),
    ]);
    assembly.contacts.values_mut()[0].property = PropertyId(1);
    let path = run(&assembly, &program, &properties, Settings::default()).expect("equilibria");
    let (kn, kt, km) = (1.2, 0.48, 0.144);
    let after = -(kn * kt + km * kn + 3.0 * km * kt) / (8.0 * km * kn * kt);
    assert_close(path[4].state.displacements[BodyId(2)].y, 0.4 * after, 1e-9);
    assert_close(path[7].state.displacements[BodyId(2)].y, 0.4 * after, 1e-9);
    assert!(
        path[6]
            .state
            .displacements
            .values()
            .iter()
            .all(|u| u.x == 0.0 && u.y == 0.0 && u.rotation == 0.0)
    );
    assert!(path.iter().all(|e| e.energy.ledger_error().abs() < 1e-12));
    let broke = path
        .iter()
        .flat_map(|e| &e.events)
        .filter(|e| matches!(e.kind, EventKind::Broke { .. }))
        .count();
    assert_eq!(broke, 1);
}

#[test]
fn a_bond_that_holds_all_ends_the_run_at_its_strength() {
    let mut law = cement(0.5, 0.0, Reading::Printed);
    law.strength = Strength {
        kind: StrengthKind::Force,
        tension: 0.7,
        ..Strength::UNBREAKABLE
    };
    let assembly = assembly(&[(0.0, 0.0), (2.0, 0.0)], 1.0);
    let program = Program {
        actions: vec![Action {
            name: "pull".into(),
        }],
        held: [Freedom::X, Freedom::Y, Freedom::Rotation]
            .map(|freedom| held(0, freedom))
            .to_vec(),
        loads: vec![AppliedLoad {
            body: BodyId(1),
            load: Load {
                x: 1.0,
                y: 0.0,
                moment: 0.0,
            },
            action: 0,
        }],
        stages: vec![Stage {
            name: "pull".into(),
            actions: vec![0],
            factors: vec![0.5, 1.0],
        }],
        ..Program::default()
    };
    let properties = properties([Law::Cemented(law)]);
    let mut path = LoadPath::new(
        &assembly,
        &properties,
        &program,
        Breakage::WorstFirst,
        Settings::default(),
    );
    let last = path
        .by_ref()
        .take_while(Result::is_ok)
        .filter_map(Result::ok)
        .last()
        .expect("equilibria");
    assert!(!last.complete && last.load_factor <= 0.7 && last.load_factor > 0.7 * (1.0 - 1e-4));
    let mut path = LoadPath::new(
        &assembly,
        &properties,
        &program,
        Breakage::WorstFirst,
        Settings::default(),
    );
    let error = path.find_map(Result::err).expect("an end");
    assert!(
        matches!(error, SolveError::Mechanism { step: 2, ref grains, .. } if grains == &[GrainId(1)]),
        "{error}"
    );
}

fn grit() -> Law {
    Law::Cohesionless(Cohesionless {
        stiffness: StiffnessRule::Direct {
            normal: 2.0,
            shear: 1.0,
            moment: 0.0,
        },
        shear_hardening: 0.0,
        reading: Reading::Printed,
        shear_floor: None,
        friction: Some(0.5),
    })
}

/// One contact between two discs, the second moved: friction dissipates 4·μ·N·(Δ − μ·N/k_t) a cycle.
#[test]
fn a_cycle_of_shear_dissipates_what_coulomb_says() {
    let assembly = assembly(&[(0.0, 0.0), (2.0, 0.0)], 1.0);
    let all = [Freedom::X, Freedom::Y, Freedom::Rotation];
    let prescribed = |freedom, amplitude, action| Prescribed {
        body: BodyId(1),
        freedom,
        amplitude,
        action,
    };
    let program = Program {
        actions: vec![
            Action {
                name: "press".into(),
            },
            Action {
                name: "shear".into(),
            },
        ],
        held: all
            .map(|freedom| held(0, freedom))
            .into_iter()
            .chain([held(1, Freedom::Rotation)])
            .collect(),
        prescribed: vec![
            prescribed(Freedom::X, -0.1, 0),
            prescribed(Freedom::Y, 0.3, 1),
        ],
        stages: vec![
            Stage {
                name: "press".into(),
                actions: vec![0],
                factors: vec![1.0],
            },
            Stage {
                name: "shear".into(),
                actions: vec![1],
                factors: vec![1.0, -1.0, 1.0],
            },
        ],
        ..Program::default()
    };
    let path = run(
        &assembly,
        &program,
        &properties([grit()]),
        Settings::default(),
    )
    .expect("equilibria");
    let cycle = path[4].energy.friction_work - path[2].energy.friction_work;
    let (limit, shear, amplitude) = (0.5 * 0.2, 1.0, 0.3);
    assert_close(cycle, 4.0 * limit * (amplitude - limit / shear), 1e-12);
    assert_eq!(
        path[4].state.contacts[ContactId(0)].force,
        ContactForce {
            normal: -0.2,
            shear: 0.1,
            moment: 0.0
        }
    );
}

/// Rows 5-4-5-4-5-4-5 of touching discs, the lowest row on rollers, the top row pressed by a fifth of the load each.
fn block() -> (Assembly, Program) {
    let pitch = 3.0_f64.sqrt();
    let mut centres = Vec::new();
    for row in 0..7 {
        let (count, first) = if row % 2 == 0 { (5, 1.0) } else { (4, 2.0) };
        centres
            .extend((0..count).map(|k| (first + 2.0 * f64::from(k), 1.0 + pitch * f64::from(row))));
    }
    let assembly = assembly(&centres, 2.0 / pitch);
    let top = 27..32;
    let program = Program {
        actions: vec![Action {
            name: "press".into(),
        }],
        held: (0..5)
            .map(|grain| held(grain, Freedom::Y))
            .chain([held(2, Freedom::X)])
            .collect(),
        loads: top
            .map(|grain| AppliedLoad {
                body: BodyId(grain),
                load: Load {
                    x: 0.0,
                    y: -0.2,
                    moment: 0.0,
                },
                action: 0,
            })
            .collect(),
        stages: vec![Stage {
            name: "press".into(),
            actions: vec![0],
            factors: vec![1.0, 1.6],
        }],
        ..Program::default()
    };
    (assembly, program)
}

/// G₀, μ, load step; stress parts times area, xx: shear, variation, fabric, isotropic, total; solved apart to nine
/// digits.
const BLOCK: [(f64, f64, usize, [f64; 5]); 3] = [
    (
        0.6,
        0.0,
        1,
        [
            1.667_429_146,
            2.810_016_797,
            0.249_574_535,
            -4.799_258_963,
            -0.072_238_485,
        ],
    ),
    (
        0.55,
        0.75,
        1,
        [
            1.691_959_118,
            2.786_468_944,
            0.248_779_492,
            -4.799_071_887,
            -0.071_864_333,
        ],
    ),
    (
        0.55,
        0.75,
        2,
        [
            2.802_245_499,
            4.368_981_183,
            0.395_723_579,
            -7.675_096_846,
            -0.108_146_585,
        ],
    ),
];

#[test]
fn the_block_of_32_discs_reaches_the_reference() {
    let (mut assembly, program) = block();
    assembly.cell_area = vec![1.0; 32].into();
    let window = Window::new((5..32).map(GrainId).collect(), 32);
    for (shear, hardening, step, expected) in BLOCK {
        let properties = properties([Law::Cemented(cement(shear, hardening, Reading::Printed))]);
        let path = run(&assembly, &program, &properties, tangent()).expect("equilibria");
        let end: &Equilibrium = &path[step];
        let snapshot = Snapshot {
            assembly: &assembly,
            state: &end.state,
            loads: &end.loads,
            reactions: &end.reactions,
        };
        let parts = measures(&snapshot, &window).stress.expect("contacts");
        let found = [
            parts.shear.xx,
            parts.variation.xx,
            parts.fabric.xx,
            parts.isotropic,
            parts.total.xx,
        ];
        for (found, expected) in found.into_iter().zip(expected) {
            assert!(
                (found * 27.0 - expected).abs() < 1e-9,
                "found {}, expected {expected}",
                found * 27.0
            );
        }
        let total = if step == 1 {
            -9.526_279_442
        } else {
            -15.242_047_107
        };
        assert!((parts.total.yy * 27.0 - total).abs() < 1e-9);
    }
}
