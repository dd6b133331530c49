//! What every contact law must do.

use kavics::contact_law::{
    Cemented, Cohesionless, ContactForce, ContactGeometry, ContactMemory, Law, Phase, Reading,
    RelativeDisplacement, Stiffness, StiffnessRule, Strength, StrengthKind,
};

const GEOMETRY: ContactGeometry = ContactGeometry {
    dual_parts: [0.5, 0.7],
    branch_length: 2.0,
    thickness: 1.0,
};
const E: f64 = 2.0;
const G: f64 = 0.8;
const MU: f64 = 0.5;

fn cemented(reading: Reading, eccentric: bool) -> Law {
    Law::Cemented(Cemented {
        stiffness: StiffnessRule::Layer {
            normal: E,
            shear: G,
        },
        shear_hardening: MU,
        reading,
        shear_floor: None,
        eccentric,
        strength: Strength::UNBREAKABLE,
        after_breakage: None,
    })
}

/// Beyond its limits at most of the probes.
fn softening(eccentric: bool) -> Law {
    Law::Cemented(Cemented {
        stiffness: StiffnessRule::Layer {
            normal: E,
            shear: G,
        },
        shear_hardening: 0.0,
        reading: Reading::Printed,
        shear_floor: None,
        eccentric,
        strength: Strength {
            kind: StrengthKind::Force,
            tension: 0.1,
            compression: 0.2,
            shear: 0.06,
            bending: 0.02,
            fracture_energy: Some(0.3),
        },
        after_breakage: None,
    })
}

fn cohesionless(reading: Reading, friction: Option<f64>) -> Law {
    Law::Cohesionless(Cohesionless {
        stiffness: StiffnessRule::Layer {
            normal: E,
            shear: G,
        },
        shear_hardening: MU,
        reading,
        shear_floor: Some(0.05),
        friction,
    })
}

/// A new law gets its row here; that is all it takes to be tested.
fn every_law() -> Vec<(&'static str, Law)> {
    vec![
        ("cemented, printed", cemented(Reading::Printed, false)),
        ("cemented, potential", cemented(Reading::Potential, false)),
        ("cemented, history", cemented(Reading::History, false)),
        ("cemented, eccentric", cemented(Reading::Printed, true)),
        ("softening", softening(false)),
        ("softening, eccentric", softening(true)),
        (
            "cohesionless as printed",
            cohesionless(Reading::Printed, None),
        ),
        (
            "cohesionless, potential",
            cohesionless(Reading::Potential, None),
        ),
        (
            "cohesionless, history",
            cohesionless(Reading::History, None),
        ),
        ("friction", cohesionless(Reading::Printed, Some(0.4))),
        (
            "friction, history",
            cohesionless(Reading::History, Some(0.4)),
        ),
    ]
}

fn at(normal: f64, shear: f64, rotation: f64) -> RelativeDisplacement {
    RelativeDisplacement {
        normal,
        shear,
        rotation,
    }
}

/// Closed, and off the places where a law has a kink.
fn probes() -> Vec<RelativeDisplacement> {
    vec![
        at(-0.1, 0.03, 0.02),
        at(-0.02, -0.2, 0.1),
        at(-0.3, 0.2, -0.05),
        at(-0.05, 0.0, 0.0),
    ]
}

fn loaded_memory() -> ContactMemory {
    ContactMemory {
        displacement: at(-0.06, 0.05, 0.0),
        force: ContactForce {
            normal: -0.144,
            shear: 0.02,
            moment: 0.0,
        },
        ..ContactMemory::default()
    }
}

fn components(force: ContactForce) -> [f64; 3] {
    [force.normal, force.shear, force.moment]
}

const PHASES: [Phase; 4] = [
    Phase::Closed,
    Phase::SlidingForward,
    Phase::SlidingBackward,
    Phase::Open,
];

#[test]
fn tangent_is_the_derivative_of_the_force() {
    const STEP: f64 = 1e-6;
    for (name, law) in every_law() {
        let k = law.stiffness(&GEOMETRY);
        for memory in [ContactMemory::default(), loaded_memory()] {
            for (v, phase) in probes()
                .into_iter()
                .flat_map(|v| PHASES.map(|phase| (v, phase)))
            {
                let respond = |v| law.respond(v, &k, &memory, phase);
                let tangent = respond(v).tangent;
                for column in 0..3 {
                    let moved = |sign: f64| {
                        let mut w = [v.normal, v.shear, v.rotation];
                        w[column] += sign * STEP;
                        components(respond(at(w[0], w[1], w[2])).force)
                    };
                    let (plus, minus) = (moved(1.0), moved(-1.0));
                    for row in 0..3 {
                        let numeric = (plus[row] - minus[row]) / (2.0 * STEP);
                        assert!(
                            (tangent[row][column] - numeric).abs() < 1e-7,
                            "{name} {phase:?} {row}{column}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn secant_is_symmetric_and_gives_the_force_of_a_law_without_memory() {
    for (name, law) in every_law() {
        let k = law.stiffness(&GEOMETRY);
        for v in probes() {
            let response = law.respond(v, &k, &ContactMemory::default(), Phase::Closed);
            let s = response.secant;
            assert!((0..3).all(|i| (0..3).all(|j| s[i][j] == s[j][i])), "{name}");
            if !name.contains("potential") && !name.contains("history") {
                let force = s.map(|row| row[0] * v.normal + row[1] * v.shear + row[2] * v.rotation);
                let found = components(response.force);
                assert!(
                    force.iter().zip(found).all(|(a, b)| (a - b).abs() < 1e-15),
                    "{name}"
                );
            }
        }
    }
}

#[test]
fn nothing_displaced_nothing_carried() {
    for (name, law) in every_law() {
        let k = law.stiffness(&GEOMETRY);
        for phase in PHASES {
            let response = law.respond(
                RelativeDisplacement::default(),
                &k,
                &ContactMemory::default(),
                phase,
            );
            assert!(
                components(response.force).iter().all(|q| *q == 0.0),
                "{name} {phase:?}"
            );
        }
    }
}

#[test]
fn an_open_contact_carries_nothing_and_a_cohesionless_one_asks_to_open_under_tension() {
    for (name, law) in every_law().into_iter().filter(|(_, law)| law.has_phases()) {
        let k = law.stiffness(&GEOMETRY);
        let memory = ContactMemory::default();
        let v = at(0.01, 0.02, 0.03);
        assert_eq!(
            law.respond(v, &k, &memory, Phase::Open).force,
            ContactForce::default(),
            "{name}"
        );
        let force = law.respond(v, &k, &memory, Phase::Closed).force;
        let change = law
            .phase_change(v, force, &k, &memory, Phase::Closed)
            .expect("a change");
        assert_eq!(change.to, Phase::Open, "{name}");
        let v = at(-0.01, 0.0, 0.0);
        let change = law
            .phase_change(v, ContactForce::default(), &k, &memory, Phase::Open)
            .expect("a change");
        assert_eq!(
            (change.to, change.violation),
            (Phase::Closed, 0.01 * k.normal),
            "{name}"
        );
    }
}

/// Work of the contact force along straight lines through `corners`, with the energy at the end and what the law
/// says went elsewhere. Each line is gone in `parts` equilibria, the work between them by Simpson's rule.
fn walk(
    law: &Law,
    k: &Stiffness,
    corners: &[RelativeDisplacement],
    parts: usize,
) -> (f64, f64, f64) {
    let mut memory = ContactMemory::default();
    let (mut work, mut elsewhere) = (0.0, 0.0);
    for pair in corners.windows(2) {
        let along = |share: f64| {
            at(
                pair[0].normal + share * (pair[1].normal - pair[0].normal),
                pair[0].shear + share * (pair[1].shear - pair[0].shear),
                pair[0].rotation + share * (pair[1].rotation - pair[0].rotation),
            )
        };
        for part in 0..parts {
            let (from, to) = (part as f64 / parts as f64, (part + 1) as f64 / parts as f64);
            let power = |share: f64| {
                let q = law.respond(along(share), k, &memory, Phase::Closed).force;
                q.normal * (pair[1].normal - pair[0].normal)
                    + q.shear * (pair[1].shear - pair[0].shear)
                    + q.moment * (pair[1].rotation - pair[0].rotation)
            };
            work += (to - from) / 6.0 * (power(from) + 4.0 * power(0.5 * (from + to)) + power(to));
            let v = along(to);
            let force = law.respond(v, k, &memory, Phase::Closed).force;
            let gone = law.dissipation(v, force, k, &memory, Phase::Closed);
            elsewhere += gone.nonpotential + gone.fracture;
            memory = law.remember(v, force, k, &memory, Phase::Closed);
        }
    }
    (
        work,
        law.energy(memory.displacement, memory.force, k, &memory),
        elsewhere,
    )
}

/// Compress by a, shear by b, decompress, unshear.
fn cycle(a: f64, b: f64) -> Vec<RelativeDisplacement> {
    vec![
        at(0.0, 0.0, 0.0),
        at(-a, 0.0, 0.0),
        at(-a, b, 0.0),
        at(0.0, b, 0.0),
        at(0.0, 0.0, 0.0),
    ]
}

/// ∮ Q·dv = ½·μ·E·a·b², and the reverse cycle gives as much.
#[test]
fn a_cycle_of_the_printed_law_takes_or_gives_half_mu_e_a_b_squared() {
    let law = cemented(Reading::Printed, false);
    let k = law.stiffness(&GEOMETRY);
    let (a, b) = (0.1, 0.07);
    let expected = 0.5 * MU * E * a * b * b;
    let mut corners = cycle(a, b);
    let (work, energy, elsewhere) = walk(&law, &k, &corners, 1);
    assert!(
        (work - expected).abs() < 1e-12 * expected
            && energy == 0.0
            && (elsewhere - expected).abs() < 1e-15
    );
    corners.reverse();
    let (work, _, elsewhere) = walk(&law, &k, &corners, 1);
    assert!((work + expected).abs() < 1e-12 * expected && (elsewhere + expected).abs() < 1e-15);
}

#[test]
fn a_cycle_of_the_potential_reading_costs_nothing_and_one_of_the_history_reading_never_gives() {
    let law = cemented(Reading::Potential, false);
    let (work, ..) = walk(&law, &law.stiffness(&GEOMETRY), &cycle(0.1, 0.07), 1);
    assert!(work.abs() < 1e-17);
    let law = cemented(Reading::History, false);
    for corners in [
        cycle(0.1, 0.07),
        cycle(0.1, 0.07).into_iter().rev().collect(),
    ] {
        let (work, ..) = walk(&law, &law.stiffness(&GEOMETRY), &corners, 1);
        assert!(work > 1e-6);
    }
}

/// Work = energy held + what went elsewhere, on a way that stiffens and softens under shear and rotation.
#[test]
fn work_is_energy_held_and_energy_gone() {
    let corners = [
        at(0.0, 0.0, 0.0),
        at(-0.05, 0.03, 0.02),
        at(-0.2, -0.04, 0.01),
        at(-0.01, 0.1, -0.03),
    ];
    for (name, law) in every_law()
        .into_iter()
        .filter(|(name, _)| !name.contains("friction") && !name.contains("softening"))
    {
        let k = law.stiffness(&GEOMETRY);
        for parts in [1, 7] {
            let (work, energy, elsewhere) = walk(&law, &k, &corners, parts);
            assert!(
                (work - energy - elsewhere).abs() < 1e-15,
                "{name}: {work} {energy} {elsewhere}"
            );
        }
    }
}

/// Simpson's rule does not see where softening begins: its error is that of one part in a thousand, squared.
#[test]
fn work_of_a_softening_bond_is_energy_held_and_energy_gone_on_any_way() {
    let corners = [
        at(0.0, 0.0, 0.0),
        at(0.05, 0.03, 0.02),
        at(-0.12, -0.09, 0.03),
        at(0.02, 0.05, -0.1),
        at(0.0, 0.0, 0.0),
        at(0.09, 0.07, -0.1),
    ];
    for law in [softening(false), softening(true)] {
        let k = law.stiffness(&GEOMETRY);
        let (_, held, at_once) = walk(&law, &k, &corners, 1);
        let (work, energy, gone) = walk(&law, &k, &corners, 1000);
        assert!((gone - at_once).abs() < 1e-14, "{gone} {at_once}");
        assert!((held - energy).abs() < 1e-15, "{held} {energy}");
        assert!((work - energy - gone).abs() < 1e-6 * work, "{work} {gone}");
        assert!(energy > 0.01 * work && gone > 0.1 * work);
    }
}

#[test]
fn a_floor_holds_the_shear_stiffness() {
    let law = Law::Cemented(Cemented {
        shear_floor: Some(0.1),
        ..match cemented(Reading::Printed, false) {
            Law::Cemented(law) => law,
            Law::Cohesionless(_) => unreachable!("cemented by name"),
        }
    });
    let k = law.stiffness(&GEOMETRY);
    // G = G₀ − μ·E·v_n/s reaches a tenth of G₀ at v_n = 0.9·G₀·s/(μ·E).
    let opening = 0.9 * G * 1.2 / (MU * E);
    assert!((k.shear_at(opening) - 0.1 * k.shear).abs() < 1e-15);
    assert_eq!(k.shear_at(2.0 * opening), 0.1 * k.shear);
    assert!(k.on_floor(2.0 * opening) && !k.on_floor(0.0));
}

#[test]
fn a_modulus_gives_a_layer_over_the_branch_length() {
    let layer = cemented(Reading::Printed, false).stiffness(&GEOMETRY);
    let law = Cemented {
        stiffness: StiffnessRule::Modulus {
            normal: E,
            shear: G,
        },
        ..match cemented(Reading::Printed, false) {
            Law::Cemented(law) => law,
            Law::Cohesionless(_) => unreachable!("cemented by name"),
        }
    };
    let modulus = law.stiffness(&GEOMETRY);
    for (found, expected) in [
        (modulus.normal, layer.normal),
        (modulus.shear, layer.shear),
        (modulus.moment, layer.moment),
    ] {
        assert!((found - expected / GEOMETRY.branch_length).abs() < 1e-15);
    }
}

/// Work = energy held + friction + what went elsewhere, for a contact that slides there and back, opens and closes.
#[test]
fn a_sliding_contact_books_all_its_work() {
    const PARTS: usize = 4000;
    let corners = [
        at(0.0, 0.0, 0.0),
        at(-0.1, 0.02, 0.0),
        at(-0.2, 0.2, 0.0),
        at(-0.05, -0.1, 0.0),
        at(0.02, 0.1, 0.0),
    ];
    for (name, law) in every_law()
        .into_iter()
        .filter(|(name, _)| name.contains("friction"))
    {
        let k = law.stiffness(&GEOMETRY);
        let (mut memory, mut work, mut gone, mut slid) = (ContactMemory::default(), 0.0, 0.0, 0);
        for pair in corners.windows(2) {
            for part in 1..=PARTS {
                let share = part as f64 / PARTS as f64;
                let v = at(
                    pair[0].normal + share * (pair[1].normal - pair[0].normal),
                    pair[0].shear + share * (pair[1].shear - pair[0].shear),
                    0.0,
                );
                let mut phase = memory.phase;
                let mut force = law.respond(v, &k, &memory, phase).force;
                while let Some(change) = law.phase_change(v, force, &k, &memory, phase) {
                    phase = change.to;
                    force = law.respond(v, &k, &memory, phase).force;
                }
                slid += usize::from(matches!(
                    phase,
                    Phase::SlidingForward | Phase::SlidingBackward
                ));
                let (before, step) = (memory.force, memory.displacement);
                work += 0.5 * (before.normal + force.normal) * (v.normal - step.normal)
                    + 0.5 * (before.shear + force.shear) * (v.shear - step.shear);
                let part = law.dissipation(v, force, &k, &memory, phase);
                assert!(part.friction >= -1e-15, "{name}");
                gone += part.friction + part.nonpotential;
                memory = law.remember(v, force, &k, &memory, phase);
            }
        }
        let held = law.energy(memory.displacement, memory.force, &k, &memory);
        assert!(slid > PARTS / 2, "{name}");
        assert!(
            (work - held - gone).abs() < 1e-3 * work,
            "{name}: {work} {held} {gone}"
        );
    }
}
