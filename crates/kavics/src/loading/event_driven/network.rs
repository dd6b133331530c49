//! The assembly of linear contacts along the line of a load step: displacements u₀ + x·u₁, forces Q₀ + x·Q₁.

use super::acting::Acting;
use super::spring::{Interval, Spring, force_at, relative_at};
use crate::contact_law::{ContactForce, Mode, RelativeDisplacement};
use crate::equilibrium::bond::Bond;
use crate::equilibrium::configuration::Configuration;
use crate::equilibrium::side_sums::SideSums;
use crate::equilibrium::system::System;
use crate::equilibrium::{Displacement, Load};
use crate::ids::{BodyId, ContactId, Id};

/// Linear contacts and the displacements along a line.
#[derive(Clone, Debug)]
pub struct Network {
    /// Each contact.
    pub springs: Vec<Spring>,
    /// Each body: [u₀, u₁].
    pub displacements: Vec<[Displacement; 2]>,
    /// What acts.
    pub acting: Acting,
    /// Whether nothing acts and nothing is strained at x = 0.
    pub proportional: bool,
}

/// How far the displacements of a network are from balance.
#[derive(Clone, Debug)]
pub struct Residual {
    /// What is left unbalanced of the two parts.
    pub unbalanced: Vec<[Load; 2]>,
    /// Largest unbalanced force at any factor up to a given one.
    pub largest: f64,
    /// Largest contact force up to it.
    pub force: f64,
}

/// The factors at which all contacts hold, and the contacts at the upper end.
#[derive(Clone, Debug)]
pub struct Reach {
    /// The factors.
    pub interval: Interval,
    /// The contact that ends it.
    pub last: ContactId,
    /// It and all whose own intervals end there but for a relative tolerance.
    pub near: Vec<ContactId>,
}

impl Network {
    /// The contacts of a configuration under what acts; only what is moved or set aside is displaced.
    pub fn new(system: &System<'_>, configuration: &Configuration, acting: Acting) -> Self {
        let bonds = configuration.bonds.values().iter();
        let mut network = Self {
            springs: bonds.map(Spring::new).collect(),
            displacements: vec![[Displacement::default(); 2]; acting.loads.len()],
            acting,
            proportional: false,
        };
        network.start_again(system, configuration);
        network
    }

    /// Displaces only what is moved or set aside.
    pub fn start_again(&mut self, system: &System<'_>, configuration: &Configuration) {
        let bodies = self.displacements.iter_mut().enumerate();
        for (body, pair) in bodies {
            *pair = [Displacement::default(); 2];
            if system.set_aside[body] {
                pair[0] = configuration.displacements[BodyId::from_index(body)];
            }
        }
        self.enter_moves();
    }

    /// What has just been set aside stays where it is at x, loose pieces as a whole, but for what is moved.
    pub fn freeze(&mut self, system: &System<'_>, before: &[bool], loose: &[Vec<BodyId>], x: f64) {
        for (body, set_aside) in before.iter().enumerate() {
            if system.set_aside[body] && !set_aside {
                let here = self.displacement_at(body, x);
                self.displacements[body] = [here, Displacement::default()];
            }
        }
        for piece in loose {
            let motion = system.rigid_motion(piece, |body| self.displacements[body.index()][0]);
            for &body in piece {
                self.displacements[body.index()][0] = motion.at(system.place(body));
            }
        }
        self.enter_moves();
    }

    fn enter_moves(&mut self) {
        for (body, freedom, parts) in &self.acting.moved {
            let pair = &mut self.displacements[body.index()];
            for (u, part) in pair.iter_mut().zip(parts) {
                *u.component_mut(*freedom) = *part;
            }
        }
    }

    /// Takes a contact as it is now.
    pub fn renew_spring(&mut self, contact: ContactId, bond: &Bond) {
        self.springs[contact.index()] = Spring::new(bond);
    }

    /// Displacement of a body at x.
    pub fn displacement_at(&self, body: usize, x: f64) -> Displacement {
        let [constant, rate] = self.displacements[body].map(Displacement::components);
        let mut sum = constant;
        for (value, rate) in sum.iter_mut().zip(rate) {
            *value += x * rate;
        }
        Displacement::from_components(sum)
    }

    /// Relative displacements of a contact.
    pub fn relative(&self, system: &System<'_>, contact: usize) -> [RelativeDisplacement; 2] {
        let frame = &system.frames[contact];
        let first = &self.displacements[frame.first.index()];
        let second = &self.displacements[frame.second.index()];
        [
            frame.relative_displacement(first[0], second[0]),
            frame.relative_displacement(first[1], second[1]),
        ]
    }

    /// Forces of a contact.
    pub fn forces(&self, system: &System<'_>, contact: usize) -> [ContactForce; 2] {
        if self.proportional {
            let frame = &system.frames[contact];
            let [first, second] = [frame.first, frame.second].map(BodyId::index);
            let [first, second] = [first, second].map(|body| self.displacements[body][1]);
            let v = frame.relative_displacement(first, second);
            return [ContactForce::default(), self.springs[contact].force_by(v)];
        }
        self.springs[contact].forces(self.relative(system, contact))
    }

    /// Force of a contact at x.
    pub fn force_at(&self, system: &System<'_>, contact: usize, x: f64) -> ContactForce {
        force_at(self.forces(system, contact), x)
    }

    /// Relative displacement of a contact at x.
    pub fn relative_at(&self, system: &System<'_>, contact: usize, x: f64) -> RelativeDisplacement {
        relative_at(self.relative(system, contact), x)
    }

    /// The factors at which all contacts hold; `direction` −1 counts them the other way.
    pub fn reach(&self, system: &System<'_>, direction: f64, ties: f64) -> Reach {
        let mut interval = Interval::ALL;
        let mut last = ContactId(0);
        let mut near: Vec<(f64, ContactId)> = Vec::new();
        for contact in 0..self.springs.len() {
            let q = self.forces(system, contact);
            let here = self.springs[contact].interval(q, direction);
            interval.lower = interval.lower.max(here.lower);
            if here.upper <= tied(interval.upper, ties) && here.upper < f64::INFINITY {
                let id = ContactId::from_index(contact);
                near.push((here.upper, id));
                if here.upper < interval.upper {
                    (interval.upper, last) = (here.upper, id);
                }
            }
        }
        let bound = tied(interval.upper, ties);
        let near = near.into_iter().filter(|near| near.0 <= bound);
        Reach {
            interval,
            last,
            near: near.map(|near| near.1).collect(),
        }
    }

    /// The components that reach their limits first as the factor grows in a direction.
    pub fn growing(
        &self,
        system: &System<'_>,
        contacts: &[ContactId],
        direction: f64,
    ) -> Vec<(ContactId, Mode)> {
        let contacts = contacts.iter();
        contacts
            .map(|&contact| {
                let [_, rate] = self.forces(system, contact.index());
                let growth = force_at([ContactForce::default(), rate], direction);
                (contact, self.springs[contact.index()].mode(growth))
            })
            .collect()
    }

    /// The largest utilisation at x, and the contacts that have it but for a relative tolerance.
    pub fn worst(&self, system: &System<'_>, x: f64, ties: f64) -> (f64, Vec<(ContactId, Mode)>) {
        let mut worst = 0.0;
        let mut near: Vec<(f64, ContactId, Mode)> = Vec::new();
        for (contact, spring) in self.springs.iter().enumerate() {
            let (reached, mode) = spring.limits.utilisation(self.force_at(system, contact, x));
            if reached > 0.0 && reached >= worst * (1.0 - ties) {
                near.push((reached, ContactId::from_index(contact), mode));
                worst = reached.max(worst);
            }
        }
        let bound = worst * (1.0 - ties);
        let tied = near.into_iter().filter(|near| near.0 >= bound);
        (
            worst,
            tied.map(|(_, contact, mode)| (contact, mode)).collect(),
        )
    }

    /// What is unbalanced, and how much of it there is at factors up to ±`farthest`.
    pub fn residual(&self, system: &System<'_>, farthest: f64) -> Residual {
        let mut unbalanced = self.acting.loads.clone();
        let mut force: f64 = 0.0;
        let mut sides = [(); 2].map(|()| SideSums::new(system.assembly));
        for (contact, frame) in system.frames.iter().enumerate() {
            let q = self.forces(system, contact);
            let sizes = q.map(|q| q.normal.hypot(q.shear));
            force = force.max(sizes[0] + farthest * sizes[1]);
            for (part, q) in q.into_iter().enumerate() {
                let [first, second] = frame.loads(q);
                unbalanced[frame.first.index()][part] += first;
                let sum = &mut unbalanced[frame.second.index()][part];
                sides[part].add(frame.second, sum, second);
            }
        }
        for (part, sides) in sides.iter().enumerate() {
            for (side, load) in sides.cut_off() {
                unbalanced[side.index()][part] += load;
            }
        }
        let mut largest: f64 = 0.0;
        for (body, parts) in unbalanced.iter().enumerate() {
            let [constant, rate] =
                parts.map(|load| system.free_size(BodyId::from_index(body), load));
            let here = constant + farthest * rate;
            // A sum that is not a number must not pass for balance.
            if here > largest || here.is_nan() {
                largest = here;
            }
        }
        Residual {
            unbalanced,
            largest,
            force,
        }
    }

    /// Writes the state at x into a configuration.
    pub fn write(&self, system: &System<'_>, configuration: &mut Configuration, x: f64) {
        for body in configuration.displacements.ids() {
            configuration.displacements[body] = self.displacement_at(body.index(), x);
        }
        system.respond(configuration);
    }
}

impl Residual {
    /// Whether it is rounding beside the forces, or below `noise`.
    pub fn is_small(&self, share: f64, noise: f64) -> bool {
        self.largest <= share * self.force || self.largest <= noise
    }
}

/// The factor at which a contact has reached its limit but for a share, if forces grow in proportion to it.
fn tied(upper: f64, share: f64) -> f64 {
    upper + share / (1.0 - share) * upper.abs()
}
