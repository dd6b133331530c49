//! The factor of K ± WWᵀ from that of K, in place.
//!
//! Per column of the factor, for one column w of W after the other (Davis and Hager, Row modifications of a sparse
//! Cholesky factorization, SIAM J. Matrix Anal. Appl. 26 (2005), 621–639, and method C1 of Gill, Golub, Murray and
//! Saunders, Math. Comp. 28 (1974), 505–535):
//!
//! ```text
//! α' = α ± w_j²/d_j,  γ = ± w_j/(d_j α'),  d_j ← d_j α'/α,  w ← w − w_j l,  l ← l + γ w
//! ```

use super::Singular;
use super::inertia::FLOPPY;
use super::panels::Panel;

/// Change of the factor by R columns, as far as it has come.
pub(super) struct Change<const R: usize> {
    /// 1 to add, −1 to remove.
    sign: f64,
    /// α of each column of W.
    alpha: [f64; R],
}

impl<const R: usize> Change<R> {
    pub fn add() -> Self {
        Self::new(1.0)
    }

    pub fn remove() -> Self {
        Self::new(-1.0)
    }

    fn new(sign: f64) -> Self {
        Self {
            sign,
            alpha: [1.0; R],
        }
    }

    /// Changes a panel. In: its rows of W, column by column; out: what the rows below have left, zero at its own.
    ///
    /// # Errors
    /// Where a pivot would vanish or change its sign.
    pub fn panel(
        &mut self,
        panel: &Panel,
        values: &mut [f64],
        local: &mut [f64],
    ) -> Result<(), Singular> {
        let rows = panel.rows;
        let mut parts = local.chunks_exact_mut(rows);
        let mut w: [&mut [f64]; R] = std::array::from_fn(|_| parts.next().unwrap_or_default());
        for column in 0..panel.columns {
            let heads: [f64; R] = std::array::from_fn(|r| std::mem::take(&mut w[r][column]));
            if heads == [0.0; R] {
                continue;
            }
            let (pivot, below) = values[column * rows + column..(column + 1) * rows]
                .split_first_mut()
                .ok_or(Singular)?;
            let gamma = self.pivot(pivot, heads)?;
            let tails = w.each_mut().map(|w| &mut w[column + 1..]);
            update(below, tails, heads, gamma);
        }
        Ok(())
    }

    /// Changes a pivot; answers γ.
    fn pivot(&mut self, pivot: &mut f64, heads: [f64; R]) -> Result<[f64; R], Singular> {
        let mut gamma = [0.0; R];
        for r in 0..R {
            let alpha = self.alpha[r] + self.sign * heads[r] * heads[r] / *pivot;
            let changed = *pivot * (alpha / self.alpha[r]);
            // A comparison that is false for what is not a number.
            let keeps = alpha > 0.0 && changed.abs() > FLOPPY;
            if !keeps {
                return Err(Singular);
            }
            gamma[r] = self.sign * heads[r] / (*pivot * alpha);
            *pivot = changed;
            self.alpha[r] = alpha;
        }
        Ok(gamma)
    }
}

fn update<const R: usize>(
    column: &mut [f64],
    w: [&mut [f64]; R],
    heads: [f64; R],
    gamma: [f64; R],
) {
    let rows = column.len();
    let w = w.map(|w| &mut w[..rows]);
    for i in 0..rows {
        let mut value = column[i];
        for r in 0..R {
            let rest = w[r][i] - heads[r] * value;
            w[r][i] = rest;
            value += gamma[r] * rest;
        }
        column[i] = value;
    }
}
