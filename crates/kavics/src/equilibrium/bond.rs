//! A contact as it stands: its law with numbers, memory and phase.

use super::ContactState;
use crate::assembly::Contact;
use crate::contact_law::{
    ContactForce, ContactGeometry, ContactMemory, Law, Limits, Mode, Phase, Property,
    RelativeDisplacement, Response, Softening, Stiffness,
};
use crate::ids::{PerProperty, PropertyId};

/// A contact as it stands between two equilibria.
#[derive(Clone, Copy, Debug)]
pub struct Bond {
    /// Its property now; none: broken into nothing.
    pub property: Option<PropertyId>,
    /// Stiffness by that property.
    pub stiffness: Stiffness,
    /// Limits by that property.
    pub limits: Limits,
    /// What it remembers of the last equilibrium.
    pub memory: ContactMemory,
    /// How it carries.
    pub phase: Phase,
    /// Whether a bond of it has broken.
    pub broken: bool,
    /// Relative displacement in the present state.
    pub displacement: RelativeDisplacement,
    /// Force in the present state.
    pub force: ContactForce,
}

/// What a law needs to know of a contact's shape.
pub fn geometry(contact: &Contact, thickness: f64) -> ContactGeometry {
    ContactGeometry {
        dual_parts: contact.dual_parts,
        branch_length: contact.branch_length,
        thickness,
    }
}

impl Bond {
    /// An unloaded contact.
    pub fn new(contact: &Contact, properties: &PerProperty<Property>, thickness: f64) -> Self {
        let geometry = geometry(contact, thickness);
        let law = &properties[contact.property].law;
        Self {
            property: Some(contact.property),
            stiffness: law
                .stiffness(&geometry)
                .with_strength_factor(contact.strength_factor),
            limits: law.limits(&geometry, contact.strength_factor),
            memory: ContactMemory::default(),
            phase: Phase::Closed,
            broken: false,
            displacement: RelativeDisplacement::default(),
            force: ContactForce::default(),
        }
    }

    /// Whether it can carry a force.
    pub fn is_active(&self) -> bool {
        self.property.is_some() && self.phase != Phase::Open
    }

    /// Its law, while it has one.
    pub fn law<'a>(&self, properties: &'a PerProperty<Property>) -> Option<&'a Law> {
        self.property.map(|property| &properties[property].law)
    }

    /// The answer of its law at `v`; nothing where it is broken into nothing.
    pub fn respond(&self, v: RelativeDisplacement, properties: &PerProperty<Property>) -> Response {
        match self.law(properties) {
            Some(law) => law.respond(v, &self.stiffness, &self.memory, self.phase),
            None => Response::default(),
        }
    }

    /// Energy that it holds in the present state, `[force·length]`.
    pub fn energy(&self, properties: &PerProperty<Property>) -> f64 {
        self.law(properties).map_or(0.0, |law| {
            law.energy(self.displacement, self.force, &self.stiffness, &self.memory)
        })
    }

    /// How it softens, while it holds.
    pub fn softening(&self) -> Option<&Softening> {
        self.property.and(self.stiffness.softening.as_ref())
    }

    /// Share of its force that a softening bond has left in the remembered state, and the mode that began it.
    pub fn left(&self) -> Option<(f64, Mode)> {
        let (left, mode) = self.softening()?.left(&self.stiffness, &self.memory);
        Some((left, mode?))
    }

    /// Takes the present state for the remembered one.
    pub fn remember(&mut self, properties: &PerProperty<Property>) {
        if let Some(law) = self.law(properties) {
            self.memory = law.remember(
                self.displacement,
                self.force,
                &self.stiffness,
                &self.memory,
                self.phase,
            );
        }
    }

    /// The bond breaks: its successor feels no shear and no rotation where it stands now; its opening counts
    /// from the undeformed assembly.
    pub fn break_into_successor(
        &mut self,
        contact: &Contact,
        properties: &PerProperty<Property>,
        thickness: f64,
    ) {
        let successor = self.law(properties).and_then(Law::after_breakage);
        self.broken = true;
        self.property = successor;
        self.phase = Phase::Closed;
        self.memory = ContactMemory {
            slip: self.displacement.shear,
            rotation_origin: self.displacement.rotation,
            displacement: self.displacement,
            ..ContactMemory::default()
        };
        self.limits = Limits::UNBREAKABLE;
        if let Some(property) = successor {
            let geometry = geometry(contact, thickness);
            let law = &properties[property].law;
            self.stiffness = law
                .stiffness(&geometry)
                .with_strength_factor(contact.strength_factor);
            self.limits = law.limits(&geometry, contact.strength_factor);
            if law.has_phases() && self.displacement.normal > 0.0 {
                self.phase = Phase::Open;
            }
        }
        self.force = self.respond(self.displacement, properties).force;
        self.memory.force = self.force;
        self.memory.phase = self.phase;
    }

    /// As a result.
    pub fn state(&self) -> ContactState {
        ContactState {
            displacement: self.displacement,
            force: self.force,
            property: self.property,
            broken: self.broken,
            phase: self.phase,
        }
    }
}
