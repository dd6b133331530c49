//! One softening bond: what it carries, what it takes to break, how it unloads.

use kavics::contact_law::{
    Cemented, ContactForce, ContactGeometry, ContactMemory, Law, Mode, Phase, Reading,
    RelativeDisplacement, Stiffness, StiffnessRule, Strength, StrengthKind,
};
use proptest::prelude::*;

const GEOMETRY: ContactGeometry = ContactGeometry {
    dual_parts: [0.6, 0.6],
    branch_length: 2.0,
    thickness: 0.5,
};
/// G_f.
const FRACTURE_ENERGY: f64 = 0.3;
/// G_f·s·H.
const ENERGY: f64 = 0.3 * 1.2 * 0.5;

fn law() -> Law {
    Law::Cemented(Cemented {
        stiffness: StiffnessRule::Layer {
            normal: 2.0,
            shear: 0.8,
        },
        shear_hardening: 0.0,
        reading: Reading::Printed,
        shear_floor: None,
        eccentric: false,
        strength: Strength {
            kind: StrengthKind::Force,
            tension: 0.1,
            compression: 0.2,
            shear: 0.06,
            bending: 0.02,
            fracture_energy: Some(FRACTURE_ENERGY),
        },
        after_breakage: None,
    })
}

fn along(direction: [f64; 3], length: f64) -> RelativeDisplacement {
    RelativeDisplacement {
        normal: direction[0] * length,
        shear: direction[1] * length,
        rotation: direction[2] * length,
    }
}

struct Bond {
    law: Law,
    k: Stiffness,
    memory: ContactMemory,
}

impl Bond {
    fn new() -> Self {
        let law = law();
        let k = law.stiffness(&GEOMETRY);
        let memory = ContactMemory::default();
        Self { law, k, memory }
    }

    /// Goes straight to `v`; answers force and energy taken on the way.
    fn go(&mut self, v: RelativeDisplacement) -> (ContactForce, f64) {
        let force = self.force(v);
        let (law, k, memory) = (&self.law, &self.k, &self.memory);
        let taken = law.dissipation(v, force, k, memory, Phase::Closed).fracture;
        self.memory = law.remember(v, force, k, memory, Phase::Closed);
        (force, taken)
    }

    fn force(&self, v: RelativeDisplacement) -> ContactForce {
        let response = self.law.respond(v, &self.k, &self.memory, Phase::Closed);
        response.force
    }

    fn ultimate(&self, mode: Mode) -> f64 {
        self.k.softening.expect("softening").ultimate(&self.k, mode)
    }
}

/// Direction, stiffness and limit of each mode: k_n = E·s·H, k_t = G·s·H, k_m = E·s³·H/12.
fn modes() -> [(Mode, [f64; 3], f64, f64); 4] {
    let bending = 2.0 * 1.2_f64.powi(3) / 12.0 * 0.5;
    [
        (Mode::Tension, [1.0, 0.0, 0.0], 1.2, 0.1),
        (Mode::Compression, [-1.0, 0.0, 0.0], 1.2, 0.2),
        (Mode::Shear, [0.0, -1.0, 0.0], 0.48, 0.06),
        (Mode::Bending, [0.0, 0.0, 1.0], bending, 0.02),
    ]
}

/// ½·Q_lim·v_u = G_f·s·H with v_u = κ_u·Q_lim/k, in one way or in many.
#[test]
fn a_bond_takes_its_fracture_energy_to_break_in_every_mode() {
    for (mode, direction, stiffness, limit) in modes() {
        let broken = 2.0 * ENERGY / limit;
        let elastic = limit / stiffness;
        for parts in [1, 3, 100] {
            let mut bond = Bond::new();
            assert!((bond.ultimate(mode) - broken / elastic).abs() < 1e-12 * broken / elastic);
            let mut taken = 0.0;
            for part in 1..=parts {
                let length = 1.01 * broken * f64::from(part) / f64::from(parts);
                let (force, gone) = bond.go(along(direction, length));
                taken += gone;
                let expected = if length < elastic {
                    stiffness * length
                } else {
                    (limit * (broken - length) / (broken - elastic)).max(0.0)
                };
                let found = force.normal.abs() + force.shear.abs() + force.moment.abs();
                assert!((found - expected).abs() < 1e-12, "{mode:?} {length}");
            }
            assert!((taken - ENERGY).abs() < 1e-13, "{mode:?}: {taken}");
            assert!((bond.memory.damage.dissipated - ENERGY).abs() < 1e-13);
            assert_eq!(bond.memory.damage.mode, Some(mode));
        }
    }
}

#[test]
fn a_softened_bond_unloads_to_the_origin_and_loads_again_on_the_same_line() {
    let mut bond = Bond::new();
    let (at_most, _) = bond.go(along([1.0, 0.3, 0.1], 0.5));
    let memory = bond.memory;
    for share in [0.7, 0.2, -0.1, 0.0, 0.6, 1.0] {
        let v = along([1.0, 0.3, 0.1], 0.5 * share);
        let (force, taken) = bond.go(v);
        assert!((force.normal - share * at_most.normal).abs() < 1e-16);
        assert!((force.shear - share * at_most.shear).abs() < 1e-16);
        assert!((force.moment - share * at_most.moment).abs() < 1e-16);
        assert_eq!(taken, 0.0);
    }
    assert_eq!(bond.memory.damage, memory.damage);
}

#[test]
fn the_mode_that_reaches_its_limit_first_says_how_the_bond_softens() {
    // At the end shear is the worst, but tension came first: 0.1/1.2 of opening before 0.06/0.48 of shear.
    let mut bond = Bond::new();
    bond.go(along([1.0, 0.0, 0.0], 0.09));
    bond.go(along([0.5, 1.0, 0.0], 0.6));
    assert_eq!(bond.memory.damage.mode, Some(Mode::Tension));
}

fn corner() -> impl Strategy<Value = [f64; 3]> {
    [-0.4..0.4, -0.4..0.4, -0.3..0.3]
}

proptest! {
    /// Damage only grows, and what it takes does not depend on where a straight way is cut.
    #[test]
    fn softening_never_gives_energy_back(ways in prop::collection::vec(corner(), 2..6), cut in 0.01..0.99) {
        let (mut whole, mut parts) = (Bond::new(), Bond::new());
        let mut last = [0.0; 3];
        for corner in ways {
            let middle: Vec<f64> = (0..3).map(|i| last[i] + cut * (corner[i] - last[i])).collect();
            let before = whole.memory.damage.utilisation;
            let (_, taken) = whole.go(along(corner, 1.0));
            let (_, first) = parts.go(along([middle[0], middle[1], middle[2]], 1.0));
            let (_, second) = parts.go(along(corner, 1.0));
            prop_assert!(taken >= 0.0 && first >= 0.0 && second >= 0.0);
            prop_assert!((taken - first - second).abs() < 1e-12, "{} {} {}", taken, first, second);
            prop_assert!(whole.memory.damage.utilisation >= before);
            last = corner;
        }
    }

    /// At the end of the way the energy taken grows as its slope says.
    #[test]
    fn the_slope_of_the_energy_taken_is_its_derivative_along_the_way(end in corner(), share in 0.3..0.9) {
        let bond = Bond::new();
        let softening = bond.k.softening.expect("softening");
        let taken = |s: f64| softening.dissipation(along(end, s), &bond.k, &bond.memory);
        let v = along(end, share);
        let slope = softening.dissipation_slope(v, &bond.k, &bond.memory);
        let by_way = slope.normal * end[0] + slope.shear * end[1] + slope.moment * end[2];
        let step = 1e-5;
        let numeric = (taken(share + step) - taken(share - step)) / (2.0 * step);
        // Where a mode takes over or the bond breaks within the step the derivative jumps.
        let kappa = |s: f64| softening.limits.utilisation(bond.k.trial_force(along(end, s)));
        let smooth = (kappa(share - step).0 - 1.0) * (kappa(share + step).0 - 1.0) > 0.0
            && kappa(share + step).0 < bond.ultimate(Mode::Bending).min(bond.ultimate(Mode::Compression));
        prop_assert!(!smooth || (numeric - by_way).abs() < 1e-6 * (1.0 + by_way.abs()), "{} {}", numeric, by_way);
    }
}
