//! The search for an equilibrium: contacts open, close, stick and slide by an active set.
//!
//! With one set of phases the forces are brought to balance; then the contact whose phase is violated most changes
//! it (ties together), and so on. On a set of phases met before, the next largest violation goes first.

use std::collections::HashMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};

use super::balance::Settled;
use super::configuration::{Action, Configuration, Failure, Progress};
use super::system::System;
use crate::contact_law::{Phase, PhaseChange};
use crate::ids::{BodyId, ContactId, Id};

/// Violations this near to each other change together.
const PHASE_TIES: f64 = 1e-6;
/// Sets of phases that are tried before the search is given up: so many, and so many more a contact with phases.
const MOST_SETS: [usize; 2] = [1000, 4];
/// Proximal steps in a row before a mechanism is called one.
const MOST_DRIFTS: usize = 200;

impl System<'_> {
    /// Brings a configuration into equilibrium under an action, contacts changing phase on the way.
    ///
    /// # Errors
    /// Where there is no equilibrium, or none is found.
    pub fn equilibrate(
        &mut self,
        configuration: &mut Configuration,
        action: &Action,
        progress: &mut Progress,
    ) -> Result<(), Failure> {
        let mut met: HashMap<u64, usize> = HashMap::new();
        let mut changed: HashMap<ContactId, usize> = HashMap::new();
        let phased = configuration
            .bonds
            .values()
            .iter()
            .filter(|bond| self.has_phases(bond))
            .count();
        let most_sets = MOST_SETS[0] + MOST_SETS[1] * phased;
        let mut drifts = 0;
        let mut moves = !action.moved.is_empty();
        loop {
            let loose = self.leave_out_loose_pieces(&configuration.bonds, &action.loads);
            self.relax(&loose, &mut configuration.displacements);
            let settled = self.settle(configuration, action, moves, progress)?;
            moves = false;
            let groups = self.violations(configuration);
            if settled == Settled::Balanced && groups.is_empty() {
                note_effort(&met, &changed, most_sets, progress);
                return Ok(());
            }
            drifts = if settled == Settled::Drifting {
                drifts + 1
            } else {
                0
            };
            if drifts > MOST_DRIFTS {
                return Err(self.mechanism(configuration, action));
            }
            if groups.is_empty() {
                continue;
            }
            let visits = met.entry(phases_hash(configuration)).or_insert(0);
            let Some(group) = groups.get(*visits) else {
                return Err(chatter(&changed));
            };
            *visits += 1;
            if met.len() > most_sets {
                return Err(chatter(&changed));
            }
            for &(contact, phase) in group {
                configuration.bonds[contact].phase = phase;
                *changed.entry(contact).or_insert(0) += 1;
            }
        }
    }

    /// The phase changes asked for, in groups of equal violation, the largest first.
    pub(super) fn violations(&self, configuration: &Configuration) -> Vec<Vec<(ContactId, Phase)>> {
        let bonds = &configuration.bonds;
        let force = bonds
            .values()
            .iter()
            .map(|b| b.force.normal.hypot(b.force.shear))
            .fold(0.0, f64::max);
        let threshold = (10.0 * self.settings.tolerance * force).max(self.noise());
        let mut wanted: Vec<(ContactId, PhaseChange)> = bonds
            .iter()
            .filter_map(|(contact, bond)| {
                let law = bond.law(self.properties)?;
                let change = law.phase_change(
                    bond.displacement,
                    bond.force,
                    &bond.stiffness,
                    &bond.memory,
                    bond.phase,
                )?;
                (change.violation > threshold).then_some((contact, change))
            })
            .collect();
        wanted.sort_by(|a, b| b.1.violation.total_cmp(&a.1.violation).then(a.0.cmp(&b.0)));
        let mut groups: Vec<Vec<(ContactId, Phase)>> = Vec::new();
        let mut head = f64::INFINITY;
        for (contact, change) in wanted {
            if change.violation < head * (1.0 - PHASE_TIES) || groups.is_empty() {
                groups.push(Vec::new());
                head = change.violation;
            }
            groups
                .last_mut()
                .expect("a group was just begun")
                .push((contact, change.to));
        }
        groups
    }

    /// Named by the grains that are least in balance.
    fn mechanism(&self, configuration: &Configuration, action: &Action) -> Failure {
        let unbalanced = self.imbalance(configuration, &action.loads).unbalanced;
        let size = |grain: usize| {
            let body = BodyId::from_index(grain);
            unbalanced[body].largest_force(self.moment_arm(body))
        };
        Failure::Mechanism {
            grains: self.foremost_grains(size),
        }
    }
}

/// Takes note of contacts that went in circles, and of how many sets of phases there were.
fn note_effort(
    met: &HashMap<u64, usize>,
    changed: &HashMap<ContactId, usize>,
    most_sets: usize,
    progress: &mut Progress,
) {
    if met.values().any(|&visits| visits > 1) {
        let circling = changed.values().filter(|&&times| times > 1).count();
        progress.chattered = progress.chattered.max(circling);
    }
    progress.longest.note(met.len(), most_sets);
}

fn phases_hash(configuration: &Configuration) -> u64 {
    let mut hasher = DefaultHasher::new();
    for bond in configuration.bonds.values() {
        bond.phase.hash(&mut hasher);
    }
    hasher.finish()
}

/// The contacts that changed phase most often.
fn chatter(changed: &HashMap<ContactId, usize>) -> Failure {
    let mut contacts: Vec<(usize, ContactId)> = changed
        .iter()
        .map(|(&contact, &times)| (times, contact))
        .collect();
    contacts.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
    Failure::Chatter {
        contacts: contacts.into_iter().take(10).map(|c| c.1).collect(),
    }
}
