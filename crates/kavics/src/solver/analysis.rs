//! What is known of a factor before any value: the permuted pattern and the panels.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::SymbolicSupernodalParams;
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::simplicial::{
    prefactorize_symbolic_cholesky, prefactorize_symbolic_cholesky_scratch,
};
use faer::sparse::linalg::cholesky::supernodal::{
    SymbolicSupernodalCholesky, factorize_supernodal_symbolic_cholesky,
    factorize_supernodal_symbolic_cholesky_scratch,
};
use faer::sparse::{SymbolicSparseColMat, SymbolicSparseColMatRef};

use super::Singular;
use super::pattern::Pattern;

/// Lower triangle of the matrix in the order of elimination.
pub(super) struct Permuted {
    /// Where its entries stand, rows ascending.
    pub pattern: SymbolicSparseColMat<usize>,
    /// Per entry its place among the caller's.
    pub source: Vec<u32>,
}

/// Columns with entries above the diagonal or below it, on the way.
struct Columns {
    start: Vec<usize>,
    row: Vec<usize>,
    source: Vec<u32>,
}

impl Columns {
    /// Sorts entries `(row, column, source)` by column; within a column they stay in order.
    fn new(order: usize, entries: impl Iterator<Item = (usize, usize, u32)> + Clone) -> Self {
        let mut start = vec![0; order + 1];
        for (_, column, _) in entries.clone() {
            start[column + 1] += 1;
        }
        for column in 0..order {
            start[column + 1] += start[column];
        }
        let mut next = start.clone();
        let (mut row, mut source) = (vec![0; start[order]], vec![0; start[order]]);
        for (entry_row, column, entry) in entries {
            row[next[column]] = entry_row;
            source[next[column]] = entry;
            next[column] += 1;
        }
        Self { start, row, source }
    }

    fn transposed(&self) -> Self {
        let order = self.start.len() - 1;
        let entries = (0..order).flat_map(|column| {
            let entries = self.start[column]..self.start[column + 1];
            entries.map(move |entry| (column, self.row[entry], self.source[entry]))
        });
        Self::new(order, entries)
    }

    fn symbolic(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let order = self.start.len() - 1;
        SymbolicSparseColMatRef::new_unsorted_checked(order, order, &self.start, None, &self.row)
    }
}

/// Permutes a lower triangle and finds the panels of its factor.
pub(super) fn analyse(
    pattern: &Pattern,
    inverse: &[usize],
) -> Result<(Permuted, SymbolicSupernodalCholesky<usize>), Singular> {
    let order = pattern.order();
    let entries = (0..order).flat_map(|column| {
        let entries = pattern.column_start[column]..pattern.column_start[column + 1];
        entries.map(move |entry| {
            let (i, j) = (inverse[pattern.row[entry]], inverse[column]);
            (i.min(j), i.max(j), entry as u32)
        })
    });
    let upper = Columns::new(order, entries);
    let symbolic = panels(upper.symbolic())?;
    let lower = upper.transposed();
    drop(upper);
    let pattern = SymbolicSparseColMat::new_checked(order, order, lower.start, None, lower.row);
    let source = lower.source;
    Ok((Permuted { pattern, source }, symbolic))
}

fn panels(
    upper: SymbolicSparseColMatRef<'_, usize>,
) -> Result<SymbolicSupernodalCholesky<usize>, Singular> {
    let order = upper.ncols();
    let (mut tree, mut counts) = (vec![0; order], vec![0; order]);
    let entries = upper.row_idx().len();
    let scratch = prefactorize_symbolic_cholesky_scratch::<usize>(order, entries).or(
        factorize_supernodal_symbolic_cholesky_scratch::<usize>(order),
    );
    let mut memory = MemBuffer::try_new(scratch).map_err(|_| Singular)?;
    let stack = MemStack::new(&mut memory);
    let tree = prefactorize_symbolic_cholesky(&mut tree, &mut counts, upper, stack);
    let parameters = SymbolicSupernodalParams::default();
    factorize_supernodal_symbolic_cholesky(upper, tree, &counts, stack, parameters)
        .map_err(|_| Singular)
}

/// An order of elimination with little fill, by approximate minimum degree: old numbers in the new order.
///
/// # Errors
/// Where memory does not suffice.
pub fn minimum_degree(pattern: &Pattern) -> Result<Vec<usize>, Singular> {
    let (order, entries) = (pattern.order(), pattern.row.len());
    let (mut forward, mut inverse) = (vec![0; order], vec![0; order]);
    let scratch = amd::order_maybe_unsorted_scratch::<usize>(order, entries);
    let mut memory = MemBuffer::try_new(scratch).map_err(|_| Singular)?;
    amd::order_maybe_unsorted(
        &mut forward,
        &mut inverse,
        pattern.symbolic(),
        amd::Control::default(),
        MemStack::new(&mut memory),
    )
    .map_err(|_| Singular)?;
    Ok(forward)
}
