//! Sparse linear systems. Knows no grain and no contact.
//!
//! In: the pattern of a matrix, its values, right-hand sides. Out: solutions, and what the factor tells of the matrix.
//! Or the blocks of a matrix and its near-null modes: then solutions by iteration.

mod analysis;
mod block;
mod block_matrix;
mod conjugate_gradients;
mod downdate;
mod eigen;
mod general;
mod inertia;
mod iterative;
mod multigrid;
mod node_vectors;
pub mod ordering;
mod panels;
mod pattern;
mod refine;
mod scaled_matrix;
mod stabilised_gradients;
mod sweeps;
mod symmetric;

pub use analysis::minimum_degree;
pub use block_matrix::{BlockMatrix, RowSum};
pub use eigen::{EigenProblem, Eigenpairs};
pub use general::GeneralSolver;
pub use inertia::Inertia;
pub use iterative::{BlockSystem, Iterated, IterativeSolver, Solution};
pub use multigrid::Modes;
pub use pattern::Pattern;
pub use symmetric::SymmetricSolver;

/// The matrix could not be factorised, not even with floppy modes held.
#[derive(Debug)]
pub struct Singular;

/// The matrix is not positive definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotPositive;
