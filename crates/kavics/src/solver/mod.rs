//! Sparse linear systems. Knows no grain and no contact.
//!
//! In: the pattern of a matrix, its values, right-hand sides. Out: solutions, and what the factor tells of the matrix.

mod eigen;
mod general;
mod pattern;
mod symmetric;

pub use eigen::{EigenProblem, Eigenpairs};
pub use general::GeneralSolver;
pub use pattern::Pattern;
pub use symmetric::SymmetricSolver;

/// The matrix could not be factorised, not even with floppy modes held.
#[derive(Debug)]
pub struct Singular;
