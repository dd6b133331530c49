//! LU of a matrix that is not symmetric.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SparseColMatRef;
use faer::sparse::linalg::lu::{self, LuRef, LuSymbolicParams, NumericLu, SymbolicLu};
use faer::{Conj, MatMut, Par};

use super::Singular;
use super::pattern::{Pattern, scale_vector};

/// LU of a matrix that is not symmetric, given in full.
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
    pub fn new(pattern: &Pattern) -> Result<Self, Singular> {
        let symbolic = lu::factorize_symbolic_lu(pattern.symbolic(), LuSymbolicParams::default())
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
    pub fn factorise(&mut self, pattern: &Pattern, values: &[f64]) -> Result<(), Singular> {
        self.scale.resize(pattern.order(), 1.0);
        pattern.scales(values, &mut self.scale);
        let scaled = pattern.scaled(values, &self.scale);
        let scratch = self
            .symbolic
            .factorize_numeric_lu_scratch::<f64>(Par::Seq, faer::Spec::default());
        self.symbolic
            .factorize_numeric_lu(
                &mut self.factor,
                SparseColMatRef::new(pattern.symbolic(), &scaled),
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
