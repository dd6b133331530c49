//! What is sought and how far the search has come: actions, configurations, failures.

use rayon::prelude::*;

use super::bond::Bond;
use super::{Displacement, Freedom, Iterate, Load, SolveError, State};
use crate::assembly::{Assembly, Partner};
use crate::ids::{BodyId, ContactId, GrainId, PerBody, PerContact};

/// Fewer bonds are not worth a task of their own.
const LEAST_TASK: usize = 4096;

/// What acts on the assembly.
#[derive(Clone, Debug, Default)]
pub struct Action {
    /// External load on each body.
    pub loads: PerBody<Load>,
    /// Values of the moved freedoms.
    pub moved: Vec<(BodyId, Freedom, f64)>,
}

/// Displacements and bonds, and how well they balance.
#[derive(Debug, Default)]
pub struct Configuration {
    /// Displacement of each body.
    pub displacements: PerBody<Displacement>,
    /// Each contact.
    pub bonds: PerContact<Bond>,
}

impl Clone for Configuration {
    /// Bonds are many bytes: all threads copy.
    fn clone(&self) -> Self {
        let bonds = self.bonds.values().par_iter().with_min_len(LEAST_TASK);
        Self {
            displacements: self.displacements.clone(),
            bonds: bonds.copied().collect::<Vec<_>>().into(),
        }
    }
}

impl Configuration {
    /// As a result.
    pub fn state(&self) -> State {
        let bonds = self.bonds.values().par_iter().with_min_len(LEAST_TASK);
        State {
            displacements: self.displacements.clone(),
            contacts: bonds.map(Bond::state).collect::<Vec<_>>().into(),
        }
    }
}

/// Why a configuration does not balance; the load path adds load step and factor.
#[derive(Clone, Debug)]
pub enum Failure {
    /// The iteration did not settle.
    NotConverged {
        /// Linear solves.
        iterations: usize,
        /// Last residual.
        residual: f64,
        /// Body with the largest unbalanced force.
        at: BodyId,
    },
    /// Loads move grains that nothing holds.
    Mechanism {
        /// Those that move most.
        grains: Vec<GrainId>,
    },
    /// Contacts change phase without end.
    Chatter {
        /// Which.
        contacts: Vec<ContactId>,
    },
    /// The shear modulus of a contact is not positive.
    ShearLost {
        /// Which.
        contact: ContactId,
    },
}

impl Failure {
    /// With load step and factor, as the user sees it.
    pub fn at(
        self,
        step: usize,
        load_factor: f64,
        assembly: &Assembly,
        tolerance: f64,
    ) -> SolveError {
        match self {
            Self::NotConverged {
                iterations,
                residual,
                at,
            } => SolveError::NotConverged {
                step,
                load_factor,
                iterations,
                residual,
                tolerance,
                at: match assembly.partner(at) {
                    Partner::Grain(grain) => format!("grain {grain}"),
                    Partner::Side(side) => format!("side {}", assembly.sides[side].name),
                },
            },
            Self::Mechanism { grains } => SolveError::Mechanism {
                step,
                load_factor,
                grains,
            },
            Self::Chatter { contacts } => SolveError::Chatter {
                step,
                load_factor,
                contacts,
            },
            Self::ShearLost { contact } => SolveError::ShearLost {
                step,
                load_factor,
                contact,
            },
        }
    }
}

/// Counts of one search for equilibrium.
#[derive(Clone, Debug, Default)]
pub struct Progress {
    /// Linear solves.
    pub iterations: usize,
    /// Last residual.
    pub residual: f64,
    /// Floppy modes held in the last factorisation.
    pub held_pivots: usize,
    /// Largest number of contacts that changed phase in circles in one search.
    pub chattered: usize,
    /// The iteration that came nearest to its limit, and that limit.
    pub longest: Longest,
    /// Whether a system was solved by iteration, which counts no floppy modes.
    pub uncounted: bool,
    /// The way, when asked for.
    pub iterates: Vec<Iterate>,
}

/// How near iterations came to the limit at which they are given up.
#[derive(Clone, Copy, Debug, Default)]
pub struct Longest {
    /// Iterations of the one that came nearest.
    pub iterations: usize,
    /// Its limit; 0 before any.
    pub limit: usize,
}

impl Longest {
    /// Takes note of an iteration that has ended well.
    pub fn note(&mut self, iterations: usize, limit: usize) {
        if iterations * self.limit >= self.iterations * limit {
            *self = Self { iterations, limit };
        }
    }
}
