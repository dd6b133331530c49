//! A symmetric matrix scaled so that the blocks on its diagonal are units: L⁻¹·A·L⁻ᵀ, with L·Lᵀ the block on the
//! diagonal.

use rayon::prelude::*;

use super::NotPositive;
use super::block::{Block, Real, add_product, block_product, cholesky, lower_inverse, transposed};
use super::block_matrix::{BlockMatrix, CHUNK};

/// I plus the blocks beside the diagonal.
#[derive(Debug)]
pub struct ScaledMatrix<T, const B: usize> {
    /// The blocks beside the diagonal.
    pub ties: BlockMatrix<T, B>,
}

/// The scaling of a matrix by the blocks on its diagonal.
#[derive(Debug)]
pub struct Scaling<const B: usize> {
    /// L of each node.
    pub lower: Vec<Block<f64, B>>,
    /// L⁻¹ of each node; zero in the rows and columns of freedoms without stiffness.
    pub inverse: Vec<Block<f64, B>>,
}

impl<const B: usize> ScaledMatrix<f64, B> {
    /// Scales a matrix, given by the blocks on its diagonal and beside it.
    ///
    /// # Errors
    /// Where a block on the diagonal is not positive semidefinite.
    pub fn new(
        diagonal: &[Block<f64, B>],
        mut ties: BlockMatrix<f64, B>,
    ) -> Result<(Self, Scaling<B>), NotPositive> {
        let lower: Vec<Block<f64, B>> = diagonal
            .par_iter()
            .map(cholesky)
            .collect::<Option<_>>()
            .ok_or(NotPositive)?;
        let inverse: Vec<Block<f64, B>> = lower.par_iter().map(lower_inverse).collect();
        let starts = &ties.row_start;
        let columns = &ties.column;
        let mut rest = &mut ties.block[..];
        let mut tasks = Vec::new();
        for first in (0..diagonal.len()).step_by(CHUNK) {
            let end = diagonal.len().min(first + CHUNK);
            let (blocks, after) = rest.split_at_mut((starts[end] - starts[first]) as usize);
            tasks.push((first..end, blocks));
            rest = after;
        }
        tasks.into_par_iter().for_each(|(rows, blocks)| {
            let before = starts[rows.start];
            for row in rows {
                for entry in starts[row]..starts[row + 1] {
                    let right = transposed(&inverse[columns[entry as usize] as usize]);
                    let block = &mut blocks[(entry - before) as usize];
                    *block = block_product(&inverse[row], &block_product(block, &right));
                }
            }
        });
        Ok((Self { ties }, Scaling { lower, inverse }))
    }

    /// Scales a matrix whose rows hold the blocks on the diagonal too.
    ///
    /// # Errors
    /// Where a block on the diagonal is not positive semidefinite.
    pub fn from_whole(whole: BlockMatrix<f64, B>) -> Result<(Self, Scaling<B>), NotPositive> {
        let (diagonal, ties) = whole.split();
        Self::new(&diagonal, ties)
    }

    /// The matrix in another precision.
    pub fn rounded<T: Real>(&self) -> ScaledMatrix<T, B> {
        ScaledMatrix {
            ties: self.ties.rounded(),
        }
    }
}

impl<T: Real, const B: usize> ScaledMatrix<T, B> {
    /// One row of A·x.
    #[inline]
    pub fn row_product(&self, row: usize, x: &[[T; B]]) -> [T; B] {
        let (columns, blocks) = self.ties.row(row);
        let mut sum = x[row];
        for (&column, block) in columns.iter().zip(blocks) {
            add_product(&mut sum, block, &x[column as usize]);
        }
        sum
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.ties.rows()
    }

    /// y = A·x.
    pub fn multiply(&self, x: &[[T; B]], y: &mut [[T; B]]) {
        self.for_rows(x, y, |_, product, y| *y = product);
    }

    /// Gives each row of A·x to `take`, with the row of `y`.
    pub fn for_rows(
        &self,
        x: &[[T; B]],
        y: &mut [[T; B]],
        take: impl Fn(usize, [T; B], &mut [T; B]) + Sync,
    ) {
        y.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, y)| {
            for (place, y) in y.iter_mut().enumerate() {
                let row = chunk * CHUNK + place;
                take(row, self.row_product(row, x), y);
            }
        });
    }
}
