//! Contact laws: force, tangent and memory of one contact. No grain, no loop, no file.
//!
//! In: a relative displacement, the stiffness of the contact, its memory and phase. Out: force, secant and
//! tangent, and what it will remember. Signs as in theory: opening and tension positive, rotation
//! counter-clockwise. Bojtár & Bagi (1989), eqs. 20–22.

mod cemented;
mod cohesionless;
mod shear;
mod softening;
mod stiffness;
mod strength;

pub use softening::{Damage, Softening};
pub use stiffness::Stiffness;
pub use strength::Limits;

use serde::{Deserialize, Serialize};

use crate::ids::PropertyId;

/// Relative displacement at a contact, second partner less first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RelativeDisplacement {
    /// Opening v_n, `[length]`.
    pub normal: f64,
    /// Shear v_t, `[length]`.
    pub shear: f64,
    /// Relative rotation v_φ, dimensionless.
    pub rotation: f64,
}

/// Force that a contact carries.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactForce {
    /// Normal force N, tension positive, `[force]`.
    pub normal: f64,
    /// Shear force T, `[force]`.
    pub shear: f64,
    /// Bending moment M, `[force·length]`.
    pub moment: f64,
}

impl ContactForce {
    /// k·v.
    pub fn linear(k: &Matrix, v: RelativeDisplacement) -> Self {
        let [normal, shear, moment] =
            k.map(|row| row[0] * v.normal + row[1] * v.shear + row[2] * v.rotation);
        Self {
            normal,
            shear,
            moment,
        }
    }
}

/// How a contact carries what it carries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Phase {
    /// A bond that holds, or a contact that is closed and does not slide.
    #[default]
    Closed,
    /// Slides with a positive shear force.
    SlidingForward,
    /// Slides with a negative shear force.
    SlidingBackward,
    /// Carries nothing, and may close again.
    Open,
}

/// What a contact is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactGeometry {
    /// Dual length on the side of −t and of +t of the contact point, `[length]`.
    pub dual_parts: [f64; 2],
    /// Branch length l, `[length]`.
    pub branch_length: f64,
    /// Thickness of the assembly, `[length]`.
    pub thickness: f64,
}

/// Where the stiffness of a contact comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StiffnessRule {
    /// A layer along the dual edge, the source's eq. 21: k = E·s, G·s, E·s³/12; moduli in `[force/length³]`.
    Layer {
        /// Normal modulus E.
        normal: f64,
        /// Shear modulus G₀.
        shear: f64,
    },
    /// A continuum modulus: k = E·s/l, G·s/l, E·s³/(12·l); moduli in `[force/length²]`.
    Modulus {
        /// Normal modulus E.
        normal: f64,
        /// Shear modulus G₀.
        shear: f64,
    },
    /// The numbers themselves.
    Direct {
        /// k_n, `[force/length]`.
        normal: f64,
        /// k_t, `[force/length]`.
        shear: f64,
        /// k_m, `[force·length]`.
        moment: f64,
    },
}

/// How the printed law, in which the shear modulus depends on the opening, is read (theory: it has no potential).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reading {
    /// As printed: a secant law without potential.
    #[default]
    Printed,
    /// The hyperelastic twin: the same shear force, and the thrust that makes the work path-independent.
    Potential,
    /// The shear force is remembered and grows by increments; closed cycles dissipate.
    History,
}

/// Limits of the force components, as stress over the dual edge or as force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strength {
    /// Whether the limits are stresses (N: σ·s, T: τ·s, M: σ·s²/6) or the forces themselves.
    pub kind: StrengthKind,
    /// Limit of tension.
    pub tension: f64,
    /// Limit of compression.
    pub compression: f64,
    /// Limit of shear.
    pub shear: f64,
    /// Limit of bending.
    pub bending: f64,
    /// Energy G_f, per area of the dual edge, that it takes to break the bond, which then softens beyond its limits,
    /// `[force/length]`; none: it breaks at once.
    pub fracture_energy: Option<f64>,
}

/// What the limits of a [`Strength`] are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StrengthKind {
    /// Stresses, `[force/length²]`.
    Stress,
    /// Forces `[force]`, and for bending a moment `[force·length]`.
    Force,
}

impl Strength {
    /// Never fails.
    pub const UNBREAKABLE: Self = Self {
        kind: StrengthKind::Force,
        tension: f64::INFINITY,
        compression: f64::INFINITY,
        shear: f64::INFINITY,
        bending: f64::INFINITY,
        fracture_energy: None,
    };
}

/// The component of the contact force that broke a bond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Normal force, opening.
    Tension,
    /// Normal force, closing.
    Compression,
    /// Shear force.
    Shear,
    /// Bending moment.
    Bending,
}

/// A bonded contact: normal force, shear force and moment; breaks when a component exceeds its limit, or softens.
#[derive(Clone, Debug, PartialEq)]
pub struct Cemented {
    /// Stiffness.
    pub stiffness: StiffnessRule,
    /// Factor μ of the source, by which compression stiffens shear: G = G₀ − μ·E·v_n/s, dimensionless.
    pub shear_hardening: f64,
    /// How the law with μ ≠ 0 is read.
    pub reading: Reading,
    /// Share of G₀ below which G does not fall; none: G ≤ 0 ends the step.
    pub shear_floor: Option<f64>,
    /// Whether the contact point's place on the dual edge couples normal force and bending.
    pub eccentric: bool,
    /// Limits.
    pub strength: Strength,
    /// What a broken bond becomes; none: nothing.
    pub after_breakage: Option<PropertyId>,
}

/// A cohesionless contact: compression and shear only.
#[derive(Clone, Debug, PartialEq)]
pub struct Cohesionless {
    /// Stiffness; the moment part is not used.
    pub stiffness: StiffnessRule,
    /// Factor μ of the source, as for cement.
    pub shear_hardening: f64,
    /// How the law with μ ≠ 0 is read.
    pub reading: Reading,
    /// Share of G₀ below which G does not fall.
    pub shear_floor: Option<f64>,
    /// Coulomb friction coefficient; none: the law as printed, eq. 22.
    pub friction: Option<f64>,
}

/// What a contact remembers of its last equilibrium.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactMemory {
    /// Relative displacement there.
    pub displacement: RelativeDisplacement,
    /// Force there.
    pub force: ContactForce,
    /// How it carried there.
    pub phase: Phase,
    /// Shear that the contact does not resist any more: slip, or the shear at which it came to be, `[length]`.
    pub slip: f64,
    /// Relative rotation at which the contact came to be, dimensionless.
    pub rotation_origin: f64,
    /// Of a softening bond.
    pub damage: Damage,
}

/// A contact at an instant: where it stands, what it carries and how.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactInstant {
    /// Relative displacement.
    pub displacement: RelativeDisplacement,
    /// Force.
    pub force: ContactForce,
    /// How it carries.
    pub phase: Phase,
}

impl ContactMemory {
    /// The remembered equilibrium.
    pub fn instant(&self) -> ContactInstant {
        ContactInstant {
            displacement: self.displacement,
            force: self.force,
            phase: self.phase,
        }
    }
}

/// A square matrix over the components normal, shear, rotation.
pub type Matrix = [[f64; 3]; 3];

/// How a contact answers a relative displacement.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Response {
    /// Force.
    pub force: ContactForce,
    /// ∂force/∂displacement, not symmetric in general.
    pub tangent: Matrix,
    /// A symmetric stiffness for the iteration: force/displacement where the law has no memory.
    pub secant: Matrix,
}

/// Energy that went through a contact between two equilibria beside what it holds, `[force·length]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dissipation {
    /// Work of friction.
    pub friction: f64,
    /// Work that a law without potential took (positive) or gave (negative).
    pub nonpotential: f64,
    /// Energy that softening took.
    pub fracture: f64,
}

/// A phase that a contact asks for, and how far the present one is from admissible, `[force]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseChange {
    /// The phase asked for.
    pub to: Phase,
    /// How far the present phase is violated, `[force]`.
    pub violation: f64,
}

/// A contact law.
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// Cement.
    Cemented(Cemented),
    /// No cement.
    Cohesionless(Cohesionless),
}

impl Law {
    /// The law's name in scene file and results.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Cemented(_) => "cemented",
            Self::Cohesionless(_) => "cohesionless",
        }
    }

    /// Stiffness of a contact of this law.
    pub fn stiffness(&self, geometry: &ContactGeometry) -> Stiffness {
        match self {
            Self::Cemented(law) => law.stiffness(geometry),
            Self::Cohesionless(law) => law.stiffness(geometry),
        }
    }

    /// Limits of the force components; none where nothing breaks at once.
    pub fn limits(&self, geometry: &ContactGeometry, factor: f64) -> Limits {
        match self {
            Self::Cemented(law) if law.strength.fracture_energy.is_none() => {
                law.strength.limits(geometry, factor)
            }
            Self::Cemented(_) | Self::Cohesionless(_) => Limits::UNBREAKABLE,
        }
    }

    /// What a broken bond becomes; none: nothing.
    pub fn after_breakage(&self) -> Option<PropertyId> {
        match self {
            Self::Cemented(law) => law.after_breakage,
            Self::Cohesionless(_) => None,
        }
    }

    /// Whether contacts of this law open, close, stick and slide.
    pub fn has_phases(&self) -> bool {
        matches!(self, Self::Cohesionless(_))
    }

    /// Whether the force is linear in the relative displacement.
    pub fn is_linear(&self) -> bool {
        match self {
            Self::Cemented(law) => {
                law.shear_hardening == 0.0 && law.strength.fracture_energy.is_none()
            }
            Self::Cohesionless(_) => false,
        }
    }

    /// Force, secant and tangent at `v` while the contact carries as `phase` says.
    pub fn respond(
        &self,
        v: RelativeDisplacement,
        k: &Stiffness,
        memory: &ContactMemory,
        phase: Phase,
    ) -> Response {
        match self {
            Self::Cemented(law) => law.respond(v, k, memory),
            Self::Cohesionless(law) => law.respond(v, k, memory, phase),
        }
    }

    /// The phase that a contact asks for when `phase` is not admissible at `v`.
    pub fn phase_change(
        &self,
        v: RelativeDisplacement,
        force: ContactForce,
        k: &Stiffness,
        memory: &ContactMemory,
        phase: Phase,
    ) -> Option<PhaseChange> {
        match self {
            Self::Cemented(_) => None,
            Self::Cohesionless(law) => law.phase_change(v, force, k, memory, phase),
        }
    }

    /// What a contact remembers once `v` and `force` have become an equilibrium.
    pub fn remember(
        &self,
        v: RelativeDisplacement,
        force: ContactForce,
        k: &Stiffness,
        memory: &ContactMemory,
        phase: Phase,
    ) -> ContactMemory {
        let slip = match self {
            Self::Cemented(_) => memory.slip,
            Self::Cohesionless(law) => law.slip(v, force, k, memory, phase),
        };
        let damage = k.softening.map_or(memory.damage, |softening| Damage {
            dissipated: memory.damage.dissipated + softening.dissipation(v, k, memory),
            ..softening.damage(v, k, memory)
        });
        ContactMemory {
            displacement: v,
            force,
            phase,
            slip,
            damage,
            ..*memory
        }
    }

    /// Energy that a contact holds at `v` under `force`, `[force·length]`.
    pub fn energy(
        &self,
        v: RelativeDisplacement,
        force: ContactForce,
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> f64 {
        if force == ContactForce::default() {
            return 0.0;
        }
        if k.softening.is_some() {
            // A secant law: half of force times displacement.
            return 0.5
                * (force.normal * v.normal + force.shear * v.shear + force.moment * v.rotation);
        }
        let rotation = v.rotation - memory.rotation_origin;
        let bending = 0.5 * k.moment * rotation * rotation + k.coupling * v.normal * rotation;
        0.5 * k.normal * v.normal * v.normal
            + bending
            + shear::energy(force.shear, k.shear_at(v.normal))
    }

    /// Energy that went elsewhere on the straight way from the remembered equilibrium to `v`.
    pub fn dissipation(
        &self,
        v: RelativeDisplacement,
        force: ContactForce,
        k: &Stiffness,
        memory: &ContactMemory,
        phase: Phase,
    ) -> Dissipation {
        let now = ContactInstant {
            displacement: v,
            force,
            phase,
        };
        self.dissipation_between([&memory.instant(), &now], k, memory)
    }

    /// Energy that went elsewhere on the straight way between two instants that share a memory.
    pub fn dissipation_between(
        &self,
        ends: [&ContactInstant; 2],
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> Dissipation {
        match self {
            Self::Cemented(law) => Dissipation {
                nonpotential: shear::dissipation(law.reading, ends, k, memory),
                fracture: k.softening.map_or(0.0, |softening| {
                    let [from, to] = ends.map(|end| end.displacement);
                    softening.dissipation(to, k, &softening.memory_at(from, k, memory))
                }),
                friction: 0.0,
            },
            Self::Cohesionless(law) => law.dissipation(ends, k, memory),
        }
    }
}

/// A contact property: a law with numbers and a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Property {
    /// Name in the scene.
    pub name: String,
    /// The law.
    pub law: Law,
}
