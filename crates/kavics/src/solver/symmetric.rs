//! LDLᵀ of a symmetric matrix.
//!
//! Rows and columns are scaled by the square root of the diagonal, so that a pivot near zero means a floppy mode
//! whatever the units are.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::SparseColMatRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    self, CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
};
use faer::{Conj, MatMut, Par, Side};

use super::Singular;
use super::pattern::{Pattern, scale_vector};

/// A scaled pivot below this is that of a floppy mode.
const FLOPPY: f64 = 1e-13;
/// What such a pivot is set to; no pivot of a stiffness has just this value.
const HELD_PIVOT: f64 = 1.234_567_890_123_456_7;

/// LDLᵀ of a symmetric matrix, given by its lower triangle.
pub struct SymmetricSolver {
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    scale: Vec<f64>,
    memory: MemBuffer,
}

impl SymmetricSolver {
    /// Analyses the pattern.
    ///
    /// # Errors
    /// Where memory does not suffice.
    pub fn new(pattern: &Pattern) -> Result<Self, Singular> {
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..CholeskySymbolicParams::default()
        };
        let symbolic = cholesky::factorize_symbolic_cholesky(
            pattern.symbolic(),
            Side::Lower,
            SymmetricOrdering::Amd,
            parameters,
        )
        .map_err(|_| Singular)?;
        let scratch = symbolic
            .factorize_numeric_ldlt_scratch::<f64>(Par::Seq, faer::Spec::default())
            .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let factor = vec![0.0; symbolic.len_val()];
        Ok(Self {
            symbolic,
            factor,
            scale: Vec::new(),
            memory: MemBuffer::new(scratch),
        })
    }

    /// Factorises; answers how many floppy modes were held.
    ///
    /// # Errors
    /// Where a factor is not finite.
    pub fn factorise(&mut self, pattern: &Pattern, values: &[f64]) -> Result<usize, Singular> {
        self.scale = pattern.scales(values);
        let scaled = pattern.scaled(values, &self.scale);
        let regularisation = LdltRegularization {
            dynamic_regularization_signs: None,
            dynamic_regularization_delta: HELD_PIVOT,
            dynamic_regularization_epsilon: FLOPPY,
        };
        self.symbolic
            .factorize_numeric_ldlt(
                &mut self.factor,
                SparseColMatRef::new(pattern.symbolic(), &scaled),
                Side::Lower,
                regularisation,
                Par::Seq,
                MemStack::new(&mut self.memory),
                faer::Spec::default(),
            )
            .map_err(|_| Singular)?;
        Ok(self.held_pivots())
    }

    fn held_pivots(&self) -> usize {
        let SymbolicCholeskyRaw::Supernodal(symbolic) = self.symbolic.raw() else {
            unreachable!("the supernodal factorisation is asked for")
        };
        let panels = (0..symbolic.n_supernodes()).map(|panel| {
            let columns = symbolic.supernode_end()[panel] - symbolic.supernode_begin()[panel];
            let rows = columns + symbolic.nnz_per_super()[panel];
            let start = symbolic.col_ptr_for_val()[panel];
            (0..columns)
                .filter(|column| self.factor[start + column * (rows + 1)] == HELD_PIVOT)
                .count()
        });
        panels.sum()
    }

    /// Solves in place.
    pub fn solve(&mut self, x: &mut [f64]) {
        scale_vector(x, &self.scale);
        let n = x.len();
        LdltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, n, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
        scale_vector(x, &self.scale);
    }
}
