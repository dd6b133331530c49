//! Bonds of linear contacts break: their stiffness goes out of the factor, and the change of the displacements is
//! solved for.

use super::linear::{Course, MOST_SOLVES, Walk};
use super::spring::{force_at, less, relative_at};
use crate::contact_law::{ContactForce, Mode, RelativeDisplacement};
use crate::equilibrium::bond::Bond;
use crate::equilibrium::configuration::Failure;
use crate::equilibrium::elastic::Entries;
use crate::equilibrium::{Displacement, Energy, Event, EventKind, Iterate};
use crate::ids::{ContactId, Id};
use crate::loading::advance;
use crate::loading::ledger;

/// The factor is made anew after so many events.
const MOST_EVENTS: usize = 512;
/// The balance is looked at after so many events.
const LOOK_EVERY: usize = 128;
/// With more left unbalanced than this share of the forces the factor is made anew.
const DRIFT: f64 = 1e-10;

/// A bond that broke.
struct Broken {
    contact: ContactId,
    mode: Mode,
    /// As it was.
    bond: Bond,
    /// Relative displacement at which it broke.
    at: RelativeDisplacement,
    /// Force that it no longer carries.
    lost: ContactForce,
    /// Energy that it held, less what its successor holds.
    fracture_energy: f64,
}

/// What a change that fails goes back to.
struct Before {
    displacements: Vec<[Displacement; 2]>,
    set_aside: Vec<bool>,
    proportional: bool,
}

impl Walk<'_, '_> {
    /// Breaks bonds together where the factor stands, and finds the line that goes on from there.
    pub fn break_bonds(&mut self, contacts: &[(ContactId, Mode)]) -> Result<(), Failure> {
        let was_proportional = self.course.network.proportional;
        let mut entries = Entries::new();
        let mut in_place = true;
        let mut broken = Vec::with_capacity(contacts.len());
        for &(contact, mode) in contacts {
            broken.push(self.break_bond(contact, mode, &mut entries, &mut in_place));
        }
        if in_place {
            self.way.progress.iterations += 1;
            self.solve_for_change(&entries);
        } else {
            self.make_anew(&broken, was_proportional)?;
        }
        self.went_on = true;
        self.record(&broken, !in_place);
        self.course.events = self.course.events.saturating_add(1);
        self.look_after();
        Ok(())
    }

    /// K′·Δu = Σ Bᵀ·ΔQ, for the part that varies alone where there is no other.
    fn solve_for_change(&mut self, entries: &Entries<2>) {
        let Course {
            network,
            answers,
            answer,
            ..
        } = &mut self.course;
        if network.proportional {
            let varying: Entries<1> = entries.iter().map(|e| (e.0, [e.1[1]])).collect();
            self.system.answer_entries(&varying, answer);
            self.system.add_answer(&mut network.displacements, answer);
        } else {
            self.system.answer_entries(entries, answers);
            self.system.add_answer(&mut network.displacements, answers);
        }
    }

    /// One bond gives way to its successor.
    fn break_bond(
        &mut self,
        contact: ContactId,
        mode: Mode,
        entries: &mut Entries<2>,
        in_place: &mut bool,
    ) -> Broken {
        let (system, network) = (&mut *self.system, &mut self.course.network);
        let place = contact.index();
        let v = network.relative(system, place);
        let old = network.springs[place];
        let q = old.forces(v);
        let bond = &mut self.point.configuration.bonds[contact];
        let before = *bond;
        let property = before.property.map(|property| (contact, property));
        self.course.broken.extend(property);
        bond.displacement = relative_at(v, self.x);
        bond.force = force_at(q, self.x);
        let held = bond.energy(system.properties);
        bond.break_into_successor(
            &system.assembly.contacts[contact],
            system.properties,
            system.assembly.thickness,
        );
        network.renew_spring(contact, bond);
        let new = network.springs[place];
        let rest = new.forces(v);
        let lost = [less(q[0], rest[0]), less(q[1], rest[1])];
        system.entries(contact, lost, entries);
        // The factor is the worse for every bond that cannot be taken out: none is needed any more.
        *in_place = *in_place
            && old
                .less(&new)
                .is_some_and(|columns| system.take_out(contact, columns));
        // A successor is free of shear and bending where it came to be, not at zero.
        network.proportional &= bond.property.is_none();
        Broken {
            contact,
            mode,
            bond: before,
            at: bond.displacement,
            lost: force_at(lost, self.x),
            fracture_energy: held - bond.energy(system.properties),
        }
    }

    /// Where the factor cannot be changed in place, or what is left may be a mechanism: all from the beginning, loose
    /// pieces left out. What the loads then still move is no equilibrium, and the bonds are as they were.
    fn make_anew(&mut self, broken: &[Broken], was_proportional: bool) -> Result<(), Failure> {
        let before = Before {
            displacements: self.course.network.displacements.clone(),
            set_aside: self.system.set_aside.clone(),
            proportional: was_proportional,
        };
        let loose = self.leave_out();
        let network = &mut self.course.network;
        network.freeze(self.system, &before.set_aside, &loose, self.x);
        if self.factorise() && self.balance(MOST_SOLVES) {
            return Ok(());
        }
        self.go_back(before.displacements);
        let failure = self.failure_from_here();
        for broken in broken {
            self.point.configuration.bonds[broken.contact] = broken.bond;
            let network = &mut self.course.network;
            network.renew_spring(broken.contact, &broken.bond);
        }
        self.system.set_aside = before.set_aside;
        self.course.network.proportional = before.proportional;
        self.course.events = usize::MAX;
        Err(failure)
    }

    /// Displaced as before the break, with the bonds as they are now.
    fn go_back(&mut self, displacements: Vec<[Displacement; 2]>) {
        let network = &mut self.course.network;
        network.displacements = displacements;
        let configuration = &mut self.point.configuration;
        for body in configuration.displacements.ids() {
            configuration.displacements[body] = network.displacement_at(body.index(), self.x);
        }
    }

    /// Work, energies and events of a break.
    fn record(&mut self, broken: &[Broken], may_be_loose: bool) {
        let load_factor = self.load_factor();
        let direction = self.run.direction;
        let avalanche = Some(self.run.avalanche(direction * self.x));
        let course = &self.course;
        let drive = course.places.drive(&course.network, &self.outer, self.x);
        let released = self.release(broken);
        for (broken, release_energy) in broken.iter().zip(released) {
            self.point.energy.fracture_energy += broken.fracture_energy;
            self.point.energy.release_energy += release_energy;
            self.way.events.push(Event {
                iteration: self.way.progress.iterations,
                load_factor,
                kind: EventKind::Broke {
                    contact: broken.contact,
                    mode: broken.mode,
                    fracture_energy: broken.fracture_energy,
                    release_energy,
                },
                avalanche,
                drive,
            });
        }
        let watch = &self.system.watch;
        watch.note_broken(broken.len());
        watch.note_load_factor(load_factor);
        watch.note_iteration(self.way.progress.iterations, self.point.residual);
        if may_be_loose {
            self.note_set_aside(load_factor, avalanche);
        }
    }

    /// Goes over to the new line; answers the energy that each bond sets free beyond its own.
    ///
    /// At a fixed factor that is ½·ΔQ·(v′ − v). Where nothing acts at factor zero the factor falls with the break, from
    /// λ to λ·D/(D + ½·Σ ΔQ·(v′ − v)), D the energy of the bonds: the work of the straight way there is such that
    /// nothing is set free.
    fn release(&mut self, broken: &[Broken]) -> Vec<f64> {
        let beyond: Vec<f64> = broken
            .iter()
            .map(|broken| self.release_of(broken))
            .collect();
        let own: f64 = broken.iter().map(|broken| broken.fracture_energy).sum();
        let whole = own + beyond.iter().sum::<f64>();
        if self.course.network.proportional && whole > 0.0 {
            self.x *= own / whole;
            self.arrive();
            return vec![0.0; broken.len()];
        }
        self.arrive();
        beyond
    }

    fn release_of(&self, broken: &Broken) -> f64 {
        let network = &self.course.network;
        let after = network.relative_at(self.system, broken.contact.index(), self.x);
        let (q, v) = (broken.lost, broken.at);
        0.5 * (q.normal * (after.normal - v.normal)
            + q.shear * (after.shear - v.shear)
            + q.moment * (after.rotation - v.rotation))
    }

    /// Grains that have been set aside or taken back.
    pub fn note_set_aside(&mut self, load_factor: f64, avalanche: Option<usize>) {
        let now = self.system.loose_grains();
        let iteration = self.way.progress.iterations;
        let happened = advance::set_aside_events(&self.point.set_aside, &now);
        self.way.events.extend(happened.map(|kind| Event {
            iteration,
            load_factor,
            kind,
            avalanche,
            drive: None,
        }));
        self.point.set_aside = now;
    }

    /// Keeps rounding from growing: looks at the balance, and makes the factor anew, at fixed counts of events.
    fn look_after(&mut self) {
        let events = self.course.events;
        if events >= MOST_EVENTS {
            self.factorise();
            self.balance(MOST_SOLVES);
        } else if events.is_multiple_of(LOOK_EVERY) {
            let residual = self.course.network.residual(self.system, self.farthest);
            if !residual.is_small(DRIFT, self.system.noise()) {
                self.factorise();
            }
            self.balance(1);
        }
        self.keep_iterate();
    }

    /// The state after an event is an iterate, where these are asked for.
    fn keep_iterate(&mut self) {
        if !self.system.settings.keep_iterates {
            return;
        }
        let mut configuration = self.point.configuration.clone();
        let network = &self.course.network;
        network.write(self.system, &mut configuration, self.x);
        let energy = Energy {
            elastic_energy: ledger::elastic_energy(&configuration, self.system.properties),
            ..self.point.energy
        };
        self.way.progress.iterates.push(Iterate {
            iteration: self.way.progress.iterations,
            residual: self.point.residual,
            state: configuration.state(),
            ledger: Some((self.load_factor(), energy)),
        });
    }
}
