//! Why there is no equilibrium.

use thiserror::Error;

use crate::ids::{ContactId, GrainId};

/// A load step without equilibrium. The last equilibrium stays valid.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SolveError {
    /// The iteration did not settle.
    #[error(
        "load step {step}: no equilibrium found beyond load factor {load_factor:.6} after {iterations} iterations (residual {residual:.1e}, wanted {tolerance:.1e}); largest at {at}"
    )]
    NotConverged {
        /// Load step.
        step: usize,
        /// Factor of the last equilibrium.
        load_factor: f64,
        /// Linear solves in the last attempt.
        iterations: usize,
        /// Residual of the last attempt.
        residual: f64,
        /// Bound on it.
        tolerance: f64,
        /// Body with the largest unbalanced force: `grain 7`, `side top`.
        at: String,
    },
    /// Loads move grains that nothing holds.
    #[error(
        "load step {step}: mechanism beyond load factor {load_factor:.6}: nothing holds {}",
        list(grains)
    )]
    Mechanism {
        /// Load step.
        step: usize,
        /// Factor of the last equilibrium.
        load_factor: f64,
        /// The grains that move most, at most ten.
        grains: Vec<GrainId>,
    },
    /// Contacts open, close, stick and slide without end.
    #[error(
        "load step {step}: no equilibrium found beyond load factor {load_factor:.6}: the status of {} does not settle",
        list_contacts(contacts)
    )]
    Chatter {
        /// Load step.
        step: usize,
        /// Factor of the last equilibrium.
        load_factor: f64,
        /// The contacts that change status again and again, at most ten.
        contacts: Vec<ContactId>,
    },
    /// The shear modulus of a contact fell to zero or below.
    #[error(
        "load step {step}: shear modulus of contact {contact} is not positive beyond load factor {load_factor:.6}"
    )]
    ShearLost {
        /// Load step.
        step: usize,
        /// Factor of the last equilibrium.
        load_factor: f64,
        /// The contact.
        contact: ContactId,
    },
    /// The path beyond the peak took as many load steps as it may.
    #[error(
        "load step {step}: {most_steps} load steps of stage `{stage}` end at load factor {load_factor:.6}, before factor {wanted} is reached; `most_steps` allows more"
    )]
    MostSteps {
        /// The load step that is not taken.
        step: usize,
        /// Factor of the last equilibrium.
        load_factor: f64,
        /// Name of the stage.
        stage: String,
        /// How many load steps it may take.
        most_steps: usize,
        /// The factor that was to be reached.
        wanted: f64,
    },
}

fn list(grains: &[GrainId]) -> String {
    named("grain", grains.iter().map(ToString::to_string))
}

fn list_contacts(contacts: &[ContactId]) -> String {
    named("contact", contacts.iter().map(ToString::to_string))
}

fn named(word: &str, ids: impl ExactSizeIterator<Item = String>) -> String {
    let plural = if ids.len() == 1 { "" } else { "s" };
    format!("{word}{plural} {}", ids.collect::<Vec<_>>().join(", "))
}
