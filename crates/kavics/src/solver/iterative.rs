//! Large systems by iteration: Krylov methods led by multigrid.

use rayon::prelude::*;

use super::NotPositive;
use super::block::{Block, block_product, times, transposed};
use super::block_matrix::{BlockMatrix, CHUNK, Nodes};
use super::conjugate_gradients::conjugate_gradients;
use super::multigrid::{Modes, Multigrid};
use super::node_vectors::largest;
use super::scaled_matrix::{ScaledMatrix, Scaling};
use super::stabilised_gradients::stabilised_gradients;

/// A sum of positive semidefinite stiffnesses between two nodes each is at most twice its diagonal.
const LARGEST_EIGENVALUE: f64 = 2.0;
/// Iterations at most.
const MOST_ITERATIONS: usize = 500;
/// The residual has to halve within so many iterations.
const PATIENCE: usize = 40;
/// A hierarchy that needs this many times the iterations that it needed when new, and ten more, is renewed.
const WORN: usize = 2;

/// A matrix by its blocks: those on the diagonal, and the rows without them.
#[derive(Clone, Debug, Default)]
pub struct BlockSystem<const B: usize> {
    /// Blocks on the diagonal, with a one alone in its row for a freedom that is held.
    pub diagonal: Vec<Block<f64, B>>,
    /// Blocks beside it.
    pub ties: BlockMatrix<f64, B>,
}

/// How an iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Iterated {
    /// The residual is below its bound.
    Converged,
    /// The iteration gains no more.
    Stagnated,
    /// The matrix is not positive definite.
    NegativeCurvature,
}

/// What an iteration found.
pub struct Solution<const B: usize> {
    /// The unknowns.
    pub x: Nodes<f64, B>,
    /// How it ended.
    pub end: Iterated,
    /// The residual, computed anew, over that at the start; 0 within its bound.
    pub gain: f64,
}

/// When an iteration ends.
pub struct Goal<'a> {
    /// What the components of each node's residual are multiplied by.
    pub weights: &'a [f32],
    /// Bound on all of them.
    bound: f64,
    /// Iterations so far.
    iterations: usize,
    /// Residual at the start.
    start: f64,
    /// Residual that counted as progress, and its iteration.
    best: (f64, usize),
}

impl<'a> Goal<'a> {
    fn new(weights: &'a [f32], bound: f64) -> Self {
        Self {
            weights,
            bound,
            iterations: 0,
            start: f64::NAN,
            best: (f64::INFINITY, 0),
        }
    }

    /// Counts an iteration that begins with a residual; whether it is the end.
    pub fn end(&mut self, rest: f64) -> Option<Iterated> {
        if self.iterations == 0 {
            self.start = rest;
        }
        if rest <= self.bound {
            return Some(Iterated::Converged);
        }
        if rest < 0.5 * self.best.0 {
            self.best = (rest, self.iterations);
        }
        self.iterations += 1;
        let over = self.iterations > MOST_ITERATIONS || self.iterations > self.best.1 + PATIENCE;
        (over || !rest.is_finite()).then_some(Iterated::Stagnated)
    }

    /// What `product`, the rows of A·x, leaves of the right-hand side, over the residual at the start.
    fn gain<const B: usize>(
        &self,
        mut right: Nodes<f64, B>,
        product: impl Fn(usize) -> [f64; B] + Sync,
    ) -> f64 {
        let chunks = right.par_chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(chunk, right)| {
            for (place, right) in right.iter_mut().enumerate() {
                let product = product(chunk * CHUNK + place);
                for (right, product) in right.iter_mut().zip(product) {
                    *right -= product;
                }
            }
        });
        let rest = largest(&right, self.weights);
        if rest <= self.bound {
            0.0
        } else {
            rest / self.start
        }
    }
}

/// Solves systems by iteration; keeps the hierarchy from one to the next while it serves.
pub struct IterativeSolver<const B: usize> {
    matrix: ScaledMatrix<f64, B>,
    scaling: Scaling<B>,
    /// Of each node's residual in the scaled system.
    weights: Vec<f32>,
    multigrid: Multigrid<B>,
    /// Iterations of the first solve with this hierarchy, and of the last one.
    iterations: [usize; 2],
}

impl<const B: usize> IterativeSolver<B> {
    /// Prepares a symmetric positive definite matrix with its near-null modes; a residual is seen in the given
    /// `units`: each of its components is multiplied by that of its freedom.
    ///
    /// # Errors
    /// Where the matrix is found not to be positive definite.
    pub fn new(
        system: BlockSystem<B>,
        modes: &Modes<B>,
        units: &[[f64; B]],
    ) -> Result<Self, NotPositive> {
        let (matrix, scaling) = scaled_definite(system)?;
        let modes = modes.par_iter().zip(&scaling.lower);
        let modes = modes.map(|(mode, lower)| block_product(&transposed(lower), mode));
        let multigrid = Multigrid::new(&matrix, &modes.collect(), LARGEST_EIGENVALUE)?;
        Ok(Self {
            matrix,
            weights: weights(&scaling, units),
            scaling,
            multigrid,
            iterations: [0; 2],
        })
    }

    /// Takes another matrix of the same nodes, near to the one that the hierarchy was made for.
    ///
    /// # Errors
    /// Where a block on its diagonal is not positive definite.
    pub fn take(&mut self, system: BlockSystem<B>, units: &[[f64; B]]) -> Result<(), NotPositive> {
        (self.matrix, self.scaling) = scaled_definite(system)?;
        self.weights = weights(&self.scaling, units);
        Ok(())
    }

    /// Whether the hierarchy leads the iteration much worse than when it was new.
    pub fn is_worn(&self) -> bool {
        let [first, last] = self.iterations;
        last > WORN * first + 10
    }

    /// Iterations of the last solve.
    pub fn iterations(&self) -> usize {
        self.iterations[1]
    }

    /// Iterations of the first solve with this hierarchy and of the last one, by which it wears.
    pub fn counts(&self) -> [usize; 2] {
        self.iterations
    }

    /// Takes the counts of the same hierarchy made before.
    pub fn go_on_counting(&mut self, counts: [usize; 2]) {
        self.iterations = counts;
    }

    /// Solves with the matrix until no component of the residual, in its unit, is above `bound`.
    pub fn solve(&mut self, right: &[[f64; B]], bound: f64) -> Solution<B> {
        let scaled = scaled_right(&self.scaling, right);
        let mut goal = Goal::new(&self.weights, bound);
        let (matrix, multigrid) = (&self.matrix, &mut self.multigrid);
        let (x, end) = conjugate_gradients(matrix, multigrid, scaled, &mut goal);
        let rest = scaled_right(&self.scaling, right);
        let gain = goal.gain(rest, |row| matrix.row_product(row, &x));
        let iterations = goal.iterations;
        self.count(iterations);
        let x = unscaled(&self.scaling, &x);
        Solution { x, end, gain }
    }

    /// Solves with a matrix that is not symmetric, but near to the symmetric one.
    pub fn solve_general(
        &mut self,
        system: &BlockSystem<B>,
        right: &[[f64; B]],
        bound: f64,
    ) -> Solution<B> {
        let matrix = scaled_general(&self.scaling, system);
        let scaled = scaled_right(&self.scaling, right);
        let mut goal = Goal::new(&self.weights, bound);
        let (x, end) = stabilised_gradients(&matrix, &mut self.multigrid, scaled, &mut goal);
        let rest = scaled_right(&self.scaling, right);
        let gain = goal.gain(rest, |row| matrix.row_product(row, &x));
        let iterations = goal.iterations;
        self.count(iterations);
        let x = unscaled(&self.scaling, &x);
        Solution { x, end, gain }
    }

    fn count(&mut self, iterations: usize) {
        let [first, last] = &mut self.iterations;
        *last = iterations;
        if *first == 0 {
            *first = iterations;
        }
    }
}

/// Scales a matrix; refuses a node with a freedom that has no stiffness of its own.
fn scaled_definite<const B: usize>(
    system: BlockSystem<B>,
) -> Result<(ScaledMatrix<f64, B>, Scaling<B>), NotPositive> {
    let (matrix, scaling) = ScaledMatrix::new(&system.diagonal, system.ties)?;
    let mut nodes = scaling.lower.iter();
    let definite = nodes.all(|lower| (0..B).all(|i| lower[i][i] > 0.0));
    definite.then_some((matrix, scaling)).ok_or(NotPositive)
}

/// L⁻¹·b.
fn scaled_right<const B: usize>(scaling: &Scaling<B>, right: &[[f64; B]]) -> Nodes<f64, B> {
    let nodes = right.par_iter().zip(&scaling.inverse);
    nodes
        .map(|(right, inverse)| times(inverse, right))
        .collect()
}

/// L⁻ᵀ·x.
fn unscaled<const B: usize>(scaling: &Scaling<B>, x: &[[f64; B]]) -> Nodes<f64, B> {
    let nodes = x.par_iter().zip(&scaling.inverse);
    nodes
        .map(|(x, inverse)| times(&transposed(inverse), x))
        .collect()
}

/// L⁻¹·A·L⁻ᵀ with the blocks on the diagonal.
fn scaled_general<const B: usize>(
    scaling: &Scaling<B>,
    system: &BlockSystem<B>,
) -> BlockMatrix<f64, B> {
    let inverse = &scaling.inverse;
    let scaled = |row: usize, column: usize, block: &Block<f64, B>| {
        block_product(
            &inverse[row],
            &block_product(block, &transposed(&inverse[column])),
        )
    };
    let nodes = system.diagonal.len();
    BlockMatrix::from_rows(nodes, nodes, |row, sum| {
        let (columns, blocks) = system.ties.row(row);
        *sum.entry(row as u32) = scaled(row, row, &system.diagonal[row]);
        for (&column, block) in columns.iter().zip(blocks) {
            let scaled = scaled(row, column as usize, block);
            for (sum, value) in sum
                .entry(column)
                .as_flattened_mut()
                .iter_mut()
                .zip(scaled.as_flattened())
            {
                *sum += value;
            }
        }
    })
}

/// How large a component of L·r can be, in its unit, over the largest of r.
fn weights<const B: usize>(scaling: &Scaling<B>, units: &[[f64; B]]) -> Vec<f32> {
    let nodes = scaling.lower.par_iter().zip(units);
    nodes
        .map(|(lower, units)| {
            let sizes = (0..B).map(|row| {
                let sum: f64 = lower.iter().map(|column| column[row].abs()).sum();
                sum * units[row]
            });
            sizes.fold(0.0, f64::max) as f32
        })
        .collect()
}
