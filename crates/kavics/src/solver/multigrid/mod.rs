//! Smoothed-aggregation multigrid: a preconditioner for symmetric positive definite systems whose nodes share
//! near-null modes, such as the rigid motions of grains.
//!
//! Each level is scaled so that the blocks on its diagonal are units ([`ScaledMatrix`]); its nodes are gathered into
//! aggregates, which move as the modes do, smoothed once by the matrix; Chebyshev polynomials of degree two smooth
//! before and after. Set up in double precision, kept and applied in single: it only leads an iteration that is in
//! double precision. Vaněk, Mandel & Brezina, Computing 56 (1996) 179; Adams, Brezina, Hu & Tuminaro, J. Comput.
//! Phys. 188 (2003) 593.

mod aggregation;
mod coarsening;
mod dense;
mod level;

pub use self::coarsening::Modes;
#[cfg(test)]
mod tests;

use self::coarsening::largest_eigenvalue;
use self::dense::Dense;
use self::level::{Coarse, Level, Work};
use super::NotPositive;
use super::scaled_matrix::ScaledMatrix;

/// The last level has at most so many nodes.
const LAST: usize = 100;
/// A last level that could not be made smaller has a dense factor up to so many nodes.
const MOST_DENSE: usize = 500;
/// Levels at most.
const MOST_LEVELS: usize = 20;
/// From this level on, each is visited twice from the one above: there it costs little.
const TWICE: usize = 2;

/// The levels, and the vectors they work with.
pub struct Multigrid<const B: usize> {
    levels: Vec<Level<B>>,
    last: Option<Dense>,
    work: Vec<Work<B>>,
}

impl<const B: usize> Multigrid<B> {
    /// Sets the levels up for a scaled matrix, its modes (Lᵀ times those of the nodes), and a bound on its largest
    /// eigenvalue: 2 for a sum of positive semidefinite stiffnesses between two nodes each.
    ///
    /// # Errors
    /// Where a level is not positive definite.
    pub fn new(
        matrix: &ScaledMatrix<f64, B>,
        modes: &Modes<B>,
        mut largest: f64,
    ) -> Result<Self, NotPositive> {
        let mut levels: Vec<Level<B>> = Vec::new();
        let mut coarse: Option<Coarse<B>> = None;
        loop {
            let (matrix, modes) = coarse.as_ref().map_or((matrix, modes), |(a, t)| (a, t));
            if matrix.nodes() <= LAST || levels.len() == MOST_LEVELS {
                break;
            }
            if !levels.is_empty() {
                largest = largest_eigenvalue(matrix);
            }
            let Some((level, next)) = Level::new(matrix, modes, largest)? else {
                break;
            };
            levels.push(level);
            coarse = Some(next);
        }
        let last = coarse.as_ref().map_or(matrix, |(matrix, _)| matrix);
        let nodes = levels.iter().map(Level::nodes).chain([last.nodes()]);
        Ok(Self {
            work: nodes.map(Work::new).collect(),
            last: (last.nodes() <= MOST_DENSE)
                .then(|| Dense::new(last))
                .transpose()?,
            levels,
        })
    }

    /// z = M·r by one cycle; `fill` writes r.
    pub fn apply(&mut self, fill: impl FnOnce(&mut [[f32; B]])) -> &[[f32; B]] {
        fill(&mut self.work[0].right);
        let cycle = Cycle {
            levels: &self.levels,
            last: self.last.as_ref(),
        };
        cycle.run(0, &mut self.work);
        &self.work[0].x
    }
}

struct Cycle<'a, const B: usize> {
    levels: &'a [Level<B>],
    last: Option<&'a Dense>,
}

impl<const B: usize> Cycle<'_, B> {
    /// Answers the right-hand side of a level, the first in `work`.
    fn run(&self, at: usize, work: &mut [Work<B>]) {
        let (here, below) = work.split_first_mut().expect("room for each level");
        let Some(level) = self.levels.get(at) else {
            return solve_last(self.last, here);
        };
        level.smooth_from_zero(here);
        level.residual(here);
        level.restrict(&here.rest, &mut below[0].right);
        self.run(at + 1, below);
        if at + 1 >= TWICE {
            self.run_again(at + 1, below);
        }
        level.prolong(&below[0].x, &mut here.x);
        level.residual(here);
        level.smooth(here);
    }

    /// A second cycle for what the first has left.
    fn run_again(&self, at: usize, work: &mut [Work<B>]) {
        let Some(level) = self.levels.get(at) else {
            return;
        };
        let here = &mut work[0];
        level.residual(here);
        std::mem::swap(&mut here.right, &mut here.rest);
        here.first.clone_from(&here.x);
        self.run(at, work);
        let Work { x, first, .. } = &mut work[0];
        for (x, first) in x.as_flattened_mut().iter_mut().zip(first.as_flattened()) {
            *x += first;
        }
    }
}

fn solve_last<const B: usize>(last: Option<&Dense>, work: &mut Work<B>) {
    let Some(last) = last else {
        work.x.copy_from_slice(&work.right);
        return;
    };
    let right = work.right.as_flattened().iter();
    let mut x: Vec<f64> = right.map(|&v| f64::from(v)).collect();
    last.solve(&mut x);
    for (single, double) in work.x.as_flattened_mut().iter_mut().zip(x) {
        *single = double as f32;
    }
}
