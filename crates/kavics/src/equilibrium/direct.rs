//! Direct solution of the linear systems: LDLᵀ where the stiffness is symmetric, LU where it is not.
//!
//! Rows and columns are scaled by the square root of the diagonal, so that a pivot near zero means a floppy mode
//! whatever the units are.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    self, CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
};
use faer::sparse::linalg::lu::{self, LuRef, LuSymbolicParams, NumericLu, SymbolicLu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use super::sparsity::Sparsity;

/// A scaled pivot below this is that of a floppy mode.
const FLOPPY: f64 = 1e-13;
/// What such a pivot is set to; no pivot of a stiffness has just this value.
const HELD_PIVOT: f64 = 1.234_567_890_123_456_7;

/// The matrix could not be factorised, not even with floppy modes held.
#[derive(Debug)]
pub struct Singular;

/// Scale of each unknown: one over the square root of its diagonal entry, 1 where that is not positive.
fn scales(sparsity: &Sparsity, values: &[f64]) -> Vec<f64> {
    (0..sparsity.order())
        .map(|column| {
            let entry = values[sparsity.diagonal(column)];
            if entry > 0.0 { 1.0 / entry.sqrt() } else { 1.0 }
        })
        .collect()
}

fn scaled(sparsity: &Sparsity, values: &[f64], scale: &[f64]) -> Vec<f64> {
    let mut scaled = values.to_vec();
    for (column, &factor) in scale.iter().enumerate() {
        for entry in sparsity.column_start[column]..sparsity.column_start[column + 1] {
            scaled[entry] *= factor * scale[sparsity.row[entry]];
        }
    }
    scaled
}

fn pattern(sparsity: &Sparsity) -> SymbolicSparseColMatRef<'_, usize> {
    SymbolicSparseColMatRef::new_checked(
        sparsity.order(),
        sparsity.order(),
        &sparsity.column_start,
        None,
        &sparsity.row,
    )
}

fn scale_vector(x: &mut [f64], scale: &[f64]) {
    for (x, s) in x.iter_mut().zip(scale) {
        *x *= s;
    }
}

/// LDLᵀ of a symmetric stiffness, given by its lower triangle.
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
    pub fn new(sparsity: &Sparsity) -> Result<Self, Singular> {
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..CholeskySymbolicParams::default()
        };
        let symbolic = cholesky::factorize_symbolic_cholesky(
            pattern(sparsity),
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
    pub fn factorise(&mut self, sparsity: &Sparsity, values: &[f64]) -> Result<usize, Singular> {
        self.scale = scales(sparsity, values);
        let scaled = scaled(sparsity, values, &self.scale);
        let regularisation = LdltRegularization {
            dynamic_regularization_signs: None,
            dynamic_regularization_delta: HELD_PIVOT,
            dynamic_regularization_epsilon: FLOPPY,
        };
        self.symbolic
            .factorize_numeric_ldlt(
                &mut self.factor,
                SparseColMatRef::new(pattern(sparsity), &scaled),
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

/// LU of a stiffness that is not symmetric, given in full.
pub struct GeneralSolver {
    symbolic: SymbolicLu<usize>,
    factor: NumericLu<usize, f64>,
    scale: Vec<f64>,
}

impl GeneralSolver {
    /// Analyses the pattern.
    ///
    /// # Errors
    /// Where memory does not suffice.
    pub fn new(sparsity: &Sparsity) -> Result<Self, Singular> {
        let symbolic = lu::factorize_symbolic_lu(pattern(sparsity), LuSymbolicParams::default())
            .map_err(|_| Singular)?;
        Ok(Self {
            symbolic,
            factor: NumericLu::new(),
            scale: Vec::new(),
        })
    }

    /// Factorises.
    ///
    /// # Errors
    /// Where no pivot is left.
    pub fn factorise(&mut self, sparsity: &Sparsity, values: &[f64]) -> Result<(), Singular> {
        self.scale = scales(sparsity, values);
        let scaled = scaled(sparsity, values, &self.scale);
        let scratch = self
            .symbolic
            .factorize_numeric_lu_scratch::<f64>(Par::Seq, faer::Spec::default());
        self.symbolic
            .factorize_numeric_lu(
                &mut self.factor,
                SparseColMatRef::new(pattern(sparsity), &scaled),
                Par::Seq,
                MemStack::new(&mut MemBuffer::new(scratch)),
                faer::Spec::default(),
            )
            .map(|_| ())
            .map_err(|_| Singular)
    }

    /// Solves in place.
    pub fn solve(&self, x: &mut [f64]) {
        scale_vector(x, &self.scale);
        let n = x.len();
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        LuRef::new_unchecked(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, n, 1),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
        scale_vector(x, &self.scale);
    }
}
