//! Sparse linear systems. Knows no grain and no contact.
//!
//! In: the pattern of a matrix, its values, right-hand sides. Out: solutions, and what the factor tells of the matrix.

mod analysis;
mod downdate;
mod general;
mod inertia;
mod panels;
mod pattern;
mod refine;
mod sweeps;
mod symmetric;

pub use analysis::minimum_degree;
pub use general::GeneralSolver;
pub use inertia::Inertia;
pub use pattern::Pattern;
pub use symmetric::SymmetricSolver;

/// The matrix could not be factorised, not even with floppy modes held.
#[derive(Debug)]
pub struct Singular;
