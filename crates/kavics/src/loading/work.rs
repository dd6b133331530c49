//! Work where stiffness depends on the state: the way between two equilibria is divided until the ledger closes.
//!
//! In: two equilibria and what acts on the way. Out: the terms of the ledger for the way, and the error left in them.
//! The equilibria on the way are found with the memory of its start and forgotten again: they tell where the work goes
//! and change nothing. Sums over equal parts are extrapolated (Romberg 1955), each part by itself.

use super::advance::reactions;
use super::ledger::{self, Forces};
use super::refinement::Refinement;
use crate::contact_law::{ContactForce, ContactInstant, RelativeDisplacement};
use crate::equilibrium::configuration::{Action, Configuration, Progress};
use crate::equilibrium::steered::Steering;
use crate::equilibrium::system::System;
use crate::equilibrium::{Displacement, Freedom, Load};
use crate::ids::{BodyId, ContactId, Id, PerBody, PerContact};

/// Equilibria that are sought on one way before its error is left as it is.
const MOST_EQUILIBRIA: usize = 64;

/// Terms of the ledger on a way, `[force·length]`.
#[derive(Clone, Debug, Default)]
pub struct Work {
    /// Work of loads and reactions.
    pub external: f64,
    /// Gain of what the contacts hold.
    pub elastic: f64,
    /// Work of friction.
    pub friction: f64,
    /// What laws without potential took.
    pub nonpotential: f64,
    /// What softening took.
    pub fracture: f64,
    /// What each force that vanishes on the way sets free.
    pub released: Vec<f64>,
}

impl Work {
    /// What does not add up.
    pub fn imbalance(&self) -> f64 {
        let released: f64 = self.released.iter().sum();
        self.external - self.elastic - self.friction - self.nonpotential - self.fracture - released
    }

    /// The largest term, apart from the elastic one, which has no error.
    pub fn largest(&self) -> f64 {
        let terms = [
            self.external,
            self.friction,
            self.nonpotential,
            self.fracture,
        ];
        let released = self.released.iter().copied();
        terms
            .into_iter()
            .chain(released)
            .fold(0.0, |most, term| most.max(term.abs()))
    }

    /// This and `factor` times another.
    #[must_use]
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        let released = self.released.iter().zip(&other.released);
        Self {
            external: self.external + factor * other.external,
            elastic: self.elastic + factor * other.elastic,
            friction: self.friction + factor * other.friction,
            nonpotential: self.nonpotential + factor * other.nonpotential,
            fracture: self.fracture + factor * other.fracture,
            released: released.map(|(a, b)| a + factor * b).collect(),
        }
    }
}

/// What the work of a load step has cost and how well it is known.
#[derive(Clone, Copy, Debug, Default)]
pub struct Account {
    /// Linear solves.
    pub iterations: usize,
    /// Work of all bodies, signs apart, `[force·length]`.
    pub scale: f64,
    /// Estimate of the error, `[force·length]`.
    pub error: f64,
}

impl Account {
    /// Error over scale.
    pub fn relative_error(&self) -> f64 {
        if self.error == 0.0 {
            0.0
        } else {
            self.error / self.scale
        }
    }
}

/// A force that a broken bond no longer carries; it vanishes evenly on the way to the next equilibrium.
#[derive(Clone, Copy, Debug)]
pub struct Vanishing {
    /// The contact.
    pub contact: ContactId,
    /// Its force less that of its successor.
    pub force: ContactForce,
    /// Where the contact stood when the bond broke.
    pub from: RelativeDisplacement,
}

/// The way between two equilibria.
pub struct Stretch<'a> {
    /// Its start; the bonds remember it.
    pub before: (&'a Configuration, &'a Forces),
    /// Its end.
    pub after: (&'a Configuration, &'a Forces),
    /// What acts at its end.
    pub action: &'a Action,
    /// What vanishes on it.
    pub vanishing: &'a [Vanishing],
    /// What steers it, where the load factor does not.
    pub steering: Option<Steering<'a>>,
}

/// An equilibrium on the way, without what it shares with the others.
#[derive(Clone, Debug, Default)]
pub struct Sample {
    displacements: PerBody<Displacement>,
    contacts: PerContact<ContactInstant>,
    forces: Forces,
    elastic: f64,
}

/// Whether any contact has a stiffness that depends on the state.
pub fn depends_on_state(system: &System<'_>, configuration: &Configuration) -> bool {
    configuration.bonds.values().iter().any(|bond| {
        bond.law(system.properties)
            .is_some_and(|law| !law.is_linear())
    })
}

/// Work below this is rounding, `[force·length]`: forces that are, on the largest displacement.
pub fn rounding(system: &System<'_>, configuration: &Configuration) -> f64 {
    let displacements = configuration.displacements.values().iter();
    let lengths = displacements.map(|u| u.x.hypot(u.y));
    system.noise() * lengths.fold(0.0, f64::max)
}

/// The work on a way, to the wanted tolerance where that can be reached; the account tells what is left.
pub fn along(system: &mut System<'_>, stretch: &Stretch<'_>, account: &mut Account) -> Work {
    let ends = [stretch.before, stretch.after]
        .map(|(configuration, forces)| Sample::new(system, configuration, forces.clone()));
    let gross = gross_work(&ends);
    account.scale += gross;
    let settings = system.settings;
    let half = 0.5 * settings.work_tolerance;
    let allowed = (half * account.scale - account.error)
        .max(half * gross)
        .max(settings.tolerance * gross);
    let first = stretch.work(system, [0.0, 1.0], [&ends[0], &ends[1]]);
    let mut refinement = Refinement::new(ends.into(), first);
    let mut tries = 0;
    while refinement.error() > allowed && tries < MOST_EQUILIBRIA {
        let Some(part) = refinement.worst(allowed) else {
            break;
        };
        let [from, to] = refinement.shares(part);
        let middle = 0.5 * (from + to);
        let neighbours = refinement.ends(part);
        tries += 1;
        let Some(sample) = stretch.sample(system, middle, neighbours, account) else {
            refinement.give_up(part);
            continue;
        };
        let halves = [
            stretch.work(system, [from, middle], [neighbours[0], &sample]),
            stretch.work(system, [middle, to], [&sample, neighbours[1]]),
        ];
        refinement.split(part, sample, halves);
    }
    account.error += refinement.error();
    refinement.work().clone()
}

/// Work of the bodies on the straight way, signs apart.
fn gross_work([from, to]: &[Sample; 2]) -> f64 {
    let bodies = from.displacements.ids();
    bodies
        .map(|body| {
            let step = to.displacements[body] - from.displacements[body];
            let work =
                |forces: &Forces| forces.loads[body].work(step) + forces.reactions[body].work(step);
            0.5 * (work(&from.forces) + work(&to.forces)).abs()
        })
        .sum()
}

impl Sample {
    fn new(system: &System<'_>, configuration: &Configuration, forces: Forces) -> Self {
        Self {
            displacements: configuration.displacements.clone(),
            contacts: configuration.bonds.map(|bond| ContactInstant {
                displacement: bond.displacement,
                force: bond.force,
                phase: bond.phase,
            }),
            forces,
            elastic: ledger::elastic_energy(configuration, system.properties),
        }
    }
}

impl Stretch<'_> {
    /// The terms between two equilibria at the given shares of the way, by straight lines.
    fn work(&self, system: &System<'_>, shares: [f64; 2], ends: [&Sample; 2]) -> Work {
        let [from, to] = ends;
        let external = ledger::external_work(
            (&from.displacements, &from.forces),
            (&to.displacements, &to.forces),
        );
        let mut work = Work {
            external,
            elastic: to.elastic - from.elastic,
            ..Work::default()
        };
        for (contact, bond) in self.before.0.bonds.iter() {
            if let Some(law) = bond.law(system.properties) {
                let instants = ends.map(|end| &end.contacts[contact]);
                let part = law.dissipation_between(instants, &bond.stiffness, &bond.memory);
                work.friction += part.friction;
                work.nonpotential += part.nonpotential;
                work.fracture += part.fracture;
            }
        }
        let left = 2.0 - shares[0] - shares[1];
        let released = self.vanishing.iter().map(|vanishing| {
            let [v, next] = ends.map(|end| end.contacts[vanishing.contact].displacement);
            left * ledger::release_energy(vanishing.force, v, next)
        });
        work.released = released.collect();
        work
    }

    /// The equilibrium at a share of the way, sought from between its neighbours.
    fn sample(
        &self,
        system: &mut System<'_>,
        share: f64,
        neighbours: [&Sample; 2],
        account: &mut Account,
    ) -> Option<Sample> {
        let mut configuration = self.start(neighbours);
        let kept = (
            system.set_aside.clone(),
            system.moved_force,
            system.settings,
        );
        system.settings.keep_iterates = false;
        let mut progress = Progress::default();
        let found = self.balance(system, &mut configuration, share, &mut progress);
        (system.set_aside, system.moved_force, system.settings) = kept;
        account.iterations += progress.iterations;
        Some(Sample::new(system, &configuration, found?))
    }

    /// Brings a configuration into equilibrium at a share of the way; answers what then acts on it.
    fn balance(
        &self,
        system: &mut System<'_>,
        configuration: &mut Configuration,
        share: f64,
        progress: &mut Progress,
    ) -> Option<Forces> {
        let (loads, action) = if let Some(steering) = self.steering {
            let steering = steering.up_to(share);
            let reached = system.steer(configuration, steering, progress).ok()?;
            let action = steering.action(reached);
            (action.loads.clone(), action)
        } else {
            let loads = self.loads(share);
            let action = Action {
                loads: self.with_vanishing(system, &loads, share),
                moved: self.moved(share),
            };
            system.equilibrate(configuration, &action, progress).ok()?;
            (loads, action)
        };
        let imbalance = system.imbalance(configuration, &action.loads);
        let reactions = reactions(system, &imbalance.unbalanced);
        Some(Forces { loads, reactions })
    }

    fn loads(&self, share: f64) -> PerBody<Load> {
        let (before, after) = (&self.before.1.loads, &self.after.1.loads);
        let between = before.ids().map(|body| {
            let mut load = before[body];
            load += (after[body] - before[body]) * share;
            load
        });
        between.collect()
    }

    /// Loads and what is left of the forces that vanish.
    fn with_vanishing(
        &self,
        system: &System<'_>,
        loads: &PerBody<Load>,
        share: f64,
    ) -> PerBody<Load> {
        let mut all = loads.clone();
        for vanishing in self.vanishing {
            let frame = &system.frames[vanishing.contact.index()];
            let [first, second] = frame.loads(vanishing.force);
            all[frame.first] += first * (1.0 - share);
            all[frame.second] += second * (1.0 - share);
        }
        all
    }

    fn moved(&self, share: f64) -> Vec<(BodyId, Freedom, f64)> {
        let before = &self.before.0.displacements;
        let moved = self.action.moved.iter().map(|&(body, freedom, value)| {
            let from = before[body].components()[freedom.index()];
            (body, freedom, from + share * (value - from))
        });
        moved.collect()
    }

    /// Where the search begins: half-way between the neighbours, with the memory of the start and the phases of the
    /// neighbour before.
    fn start(&self, [before, after]: [&Sample; 2]) -> Configuration {
        let mut configuration = self.before.0.clone();
        let u = &mut configuration.displacements;
        for body in before.displacements.ids() {
            let [a, b] = [before, after].map(|sample| sample.displacements[body].components());
            u[body] = Displacement::from_components([0, 1, 2].map(|i: usize| 0.5 * (a[i] + b[i])));
        }
        let bonds = configuration.bonds.values_mut().iter_mut();
        for (bond, instant) in bonds.zip(before.contacts.values()) {
            bond.phase = instant.phase;
        }
        configuration
    }
}
