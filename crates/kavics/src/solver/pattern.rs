//! Where the entries of a sparse matrix stand, and its scaling.

use faer::sparse::SymbolicSparseColMatRef;

/// Compressed columns without values: the lower triangle of a symmetric matrix, its diagonal entries first in their
/// columns, or all of a matrix that is not symmetric.
#[derive(Clone, Debug, Default)]
pub struct Pattern {
    /// First entry of each column, and the number of entries at the end.
    pub column_start: Vec<usize>,
    /// Row of each entry.
    pub row: Vec<usize>,
}

impl Pattern {
    /// Number of unknowns.
    pub fn order(&self) -> usize {
        self.column_start.len() - 1
    }

    /// Place of the diagonal entry of a column.
    pub fn diagonal(&self, column: usize) -> usize {
        let start = self.column_start[column];
        let rows = &self.row[start..self.column_start[column + 1]];
        let place = rows.iter().position(|&row| row == column);
        start + place.expect("every diagonal entry is stored")
    }

    pub(super) fn symbolic(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let order = self.order();
        SymbolicSparseColMatRef::new_checked(order, order, &self.column_start, None, &self.row)
    }

    /// Scale of each unknown: one over the square root of its diagonal entry without sign, 1 where that is zero.
    pub(super) fn scales(&self, values: &[f64], scale: &mut [f64]) {
        for (column, scale) in scale.iter_mut().enumerate() {
            let entry = values[self.diagonal(column)].abs();
            *scale = if entry > 0.0 { 1.0 / entry.sqrt() } else { 1.0 };
        }
    }

    /// The values with rows and columns scaled.
    pub(super) fn scaled(&self, values: &[f64], scale: &[f64]) -> Vec<f64> {
        let mut scaled = values.to_vec();
        for (column, &factor) in scale.iter().enumerate() {
            for entry in self.column_start[column]..self.column_start[column + 1] {
                scaled[entry] *= factor * scale[self.row[entry]];
            }
        }
        scaled
    }
}

pub(super) fn scale_vector(x: &mut [f64], scale: &[f64]) {
    for (x, s) in x.iter_mut().zip(scale) {
        *x *= s;
    }
}
