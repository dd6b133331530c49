//! Solutions that are corrected by what they leave.

use super::SymmetricSolver;

/// Corrections at most.
const CORRECTIONS: usize = 2;
/// What is left is rounding below this share of the right-hand side.
const ROUNDING: f64 = 1e-15;

impl SymmetricSolver {
    /// Solves in place and corrects the solution, at most twice: x ← x + K⁻¹(b − Kx), as long as that makes the largest
    /// of b − Kx smaller. Answers what is left over the largest of b.
    ///
    /// `multiply` writes Kx into its second argument. The matrix need not be just that of the factor: one that has
    /// changed a little since will do, and is then the one that is solved for.
    ///
    /// The Newton iteration needs no such correction: it solves for unbalanced forces that are computed anew each time.
    pub fn solve_corrected(
        &mut self,
        x: &mut [f64],
        mut multiply: impl FnMut(&[f64], &mut [f64]),
    ) -> f64 {
        let right = x.to_vec();
        let wanted = largest(&right);
        let mut left = vec![0.0; x.len()];
        let mut residual = |x: &[f64], left: &mut [f64]| {
            multiply(x, left);
            for (left, right) in left.iter_mut().zip(&right) {
                *left = right - *left;
            }
            largest(left)
        };
        self.solve(x);
        let mut size = residual(x, &mut left);
        let mut corrected = vec![0.0; x.len()];
        for _ in 0..CORRECTIONS {
            if size <= ROUNDING * wanted {
                break;
            }
            self.solve(&mut left);
            for ((corrected, x), step) in corrected.iter_mut().zip(&*x).zip(&left) {
                *corrected = x + step;
            }
            let next = residual(&corrected, &mut left);
            if next >= size {
                break;
            }
            x.copy_from_slice(&corrected);
            size = next;
        }
        if wanted > 0.0 { size / wanted } else { size }
    }
}

/// Largest without sign; not a number where there is one that is not.
fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most: f64, x| {
        if x.is_nan() || x.abs() > most {
            x.abs()
        } else {
            most
        }
    })
}
