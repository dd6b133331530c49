//! Work and energy between two equilibria. No term is a remainder of the others.

use crate::contact_law::{ContactForce, Dissipation, Property, RelativeDisplacement};
use crate::equilibrium::configuration::Configuration;
use crate::equilibrium::{Displacement, Energy, Load};
use crate::ids::{PerBody, PerProperty};

/// External loads and reactions at an equilibrium.
#[derive(Clone, Debug, Default)]
pub struct Forces {
    /// External load on each body.
    pub loads: PerBody<Load>,
    /// Reaction at held and moved freedoms.
    pub reactions: PerBody<Load>,
}

/// How well the ledger has closed so far, `[force·length]`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Closing {
    /// What it left open at the last equilibrium.
    pub error: f64,
    /// The largest of its terms so far.
    pub largest: f64,
}

impl Closing {
    /// The same at the next equilibrium, and what was left open on the way there beyond `rounding`, over the largest term.
    pub fn at(self, energy: &Energy, rounding: f64) -> (Self, f64) {
        let sizes = energy.terms().into_iter().map(f64::abs);
        let (error, largest) = (energy.ledger_error(), sizes.fold(self.largest, f64::max));
        let open = (error - self.error).abs();
        let relative = if open <= rounding {
            0.0
        } else {
            open / largest
        };
        (Self { error, largest }, relative)
    }
}

/// Work of loads and reactions on the straight way between two equilibria:
///
/// ```math
/// W = \sum_p \tfrac12 (f_0 + R_0 + f_1 + R_1)\cdot(u_1 - u_0)
/// ```
pub fn external_work(
    before: (&PerBody<Displacement>, &Forces),
    after: (&PerBody<Displacement>, &Forces),
) -> f64 {
    let (from, to) = (before.0, after.0);
    let mut work = 0.0;
    for body in from.ids() {
        let step = to[body] - from[body];
        for forces in [before.1, after.1] {
            work += 0.5 * (forces.loads[body].work(step) + forces.reactions[body].work(step));
        }
    }
    work
}

/// Energy that all contacts hold.
pub fn elastic_energy(configuration: &Configuration, properties: &PerProperty<Property>) -> f64 {
    configuration
        .bonds
        .values()
        .iter()
        .map(|bond| bond.energy(properties))
        .sum()
}

/// What friction, laws without potential and softening took since the last equilibrium.
pub fn dissipation(
    configuration: &Configuration,
    properties: &PerProperty<Property>,
) -> Dissipation {
    let mut sum = Dissipation::default();
    for bond in configuration.bonds.values() {
        if let Some(law) = bond.law(properties) {
            let part = law.dissipation(
                bond.displacement,
                bond.force,
                &bond.stiffness,
                &bond.memory,
                bond.phase,
            );
            sum.friction += part.friction;
            sum.nonpotential += part.nonpotential;
            sum.fracture += part.fracture;
        }
    }
    sum
}

/// Energy set free at fixed loads by a bond beyond its own: the force that vanished, ΔQ, works on the way of its
/// contact to the next equilibrium, ½·ΔQ·(v′ − v), `[force·length]`.
pub fn release_energy(
    vanished: ContactForce,
    from: RelativeDisplacement,
    to: RelativeDisplacement,
) -> f64 {
    0.5 * (vanished.normal * (to.normal - from.normal)
        + vanished.shear * (to.shear - from.shear)
        + vanished.moment * (to.rotation - from.rotation))
}

/// Adds the straight way from one equilibrium to the next, breakage apart: exact where stiffness is constant.
pub fn add_way(
    energy: &mut Energy,
    before: (&Configuration, &Forces),
    after: (&Configuration, &Forces),
    properties: &PerProperty<Property>,
) {
    let dissipation = dissipation(after.0, properties);
    energy.external_work += external_work(
        (&before.0.displacements, before.1),
        (&after.0.displacements, after.1),
    );
    energy.friction_work += dissipation.friction;
    energy.nonpotential_work += dissipation.nonpotential;
    energy.fracture_energy += dissipation.fracture;
    energy.elastic_energy = elastic_energy(after.0, properties);
}
