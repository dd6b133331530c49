//! The last level, small enough for a dense factor.

use crate::solver::NotPositive;
use crate::solver::scaled_matrix::ScaledMatrix;

/// A dense factor of the last level.
pub struct Dense {
    order: usize,
    /// L by rows.
    lower: Vec<f64>,
}

impl Dense {
    /// L·Lᵀ of a matrix.
    ///
    /// # Errors
    /// Where it is not positive definite.
    pub fn new<const B: usize>(matrix: &ScaledMatrix<f64, B>) -> Result<Self, NotPositive> {
        let order = matrix.ties.rows() * B;
        let mut lower = vec![0.0; order * order];
        for row in 0..matrix.ties.rows() {
            for i in 0..B {
                lower[(row * B + i) * (order + 1)] = 1.0;
            }
            let (columns, blocks) = matrix.ties.row(row);
            for (&column, block) in columns.iter().zip(blocks) {
                for (j, entries) in block.iter().enumerate() {
                    for (i, &entry) in entries.iter().enumerate() {
                        lower[(row * B + i) * order + column as usize * B + j] = entry;
                    }
                }
            }
        }
        let mut dense = Self { order, lower };
        dense.factorise()?;
        Ok(dense)
    }

    fn factorise(&mut self) -> Result<(), NotPositive> {
        for row in 0..self.order {
            let (above, here) = self.lower.split_at_mut(row * self.order);
            for column in 0..row {
                let other = &above[column * self.order..][..=column];
                let sum: f64 = dot(&here[..column], &other[..column]);
                here[column] = (here[column] - sum) / other[column];
            }
            let pivot = here[row] - dot(&here[..row], &here[..row]);
            if pivot.is_nan() || pivot <= 0.0 {
                return Err(NotPositive);
            }
            here[row] = pivot.sqrt();
        }
        Ok(())
    }

    /// Solves in place.
    pub fn solve(&self, x: &mut [f64]) {
        for row in 0..self.order {
            let entries = &self.lower[row * self.order..][..=row];
            x[row] = (x[row] - dot(&entries[..row], &x[..row])) / entries[row];
        }
        for row in (0..self.order).rev() {
            let entries = &self.lower[row * self.order..][..=row];
            x[row] /= entries[row];
            let value = x[row];
            for (x, entry) in x[..row].iter_mut().zip(entries) {
                *x -= entry * value;
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
