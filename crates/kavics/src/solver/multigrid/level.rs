//! One level: its matrix, its smoother and the way to the next.

use rayon::prelude::*;

use super::aggregation::aggregates;
use super::coarsening::{Modes, coarse_matrix, orthonormalised, prolongation, scale_transfer};
use crate::solver::NotPositive;
use crate::solver::block::{block_product, transposed};
use crate::solver::block_matrix::{BlockMatrix, CHUNK, Nodes};
use crate::solver::scaled_matrix::ScaledMatrix;

/// Smallest eigenvalue that the smoother aims at, as a share of the largest.
const SMOOTHED: f64 = 0.1;

/// What a level keeps, in single precision.
pub struct Level<const B: usize> {
    matrix: ScaledMatrix<f32, B>,
    prolongation: BlockMatrix<f32, B>,
    restriction: BlockMatrix<f32, B>,
    smoother: Smoother,
}

/// The vectors of one level.
pub struct Work<const B: usize> {
    /// What is to be answered.
    pub right: Nodes<f32, B>,
    /// The answer.
    pub x: Nodes<f32, B>,
    /// What the answer leaves.
    pub rest: Nodes<f32, B>,
    /// The answer of the first of two cycles.
    pub first: Nodes<f32, B>,
}

impl<const B: usize> Work<B> {
    /// Room for so many nodes.
    pub fn new(nodes: usize) -> Self {
        let zero = vec![[0.0; B]; nodes];
        Self {
            right: zero.clone(),
            x: zero.clone(),
            rest: zero,
            first: Vec::new(),
        }
    }
}

/// x ← x + (a − b·A)·r, the Chebyshev polynomial of degree two on the upper part of the spectrum.
#[derive(Clone, Copy, Debug)]
struct Smoother {
    a: f32,
    b: f32,
}

impl Smoother {
    /// Saad, Iterative methods for sparse linear systems (2003), algorithm 12.1: two steps from zero.
    fn new(largest: f64) -> Self {
        let middle = 0.5 * (1.0 + SMOOTHED) * largest;
        let half = 0.5 * (1.0 - SMOOTHED) * largest;
        let sigma = middle / half;
        let rho = 1.0 / (2.0 * sigma - 1.0 / sigma);
        let (first, again) = (1.0 / middle, 2.0 * rho / half);
        Self {
            a: (first + rho / sigma * first + again) as f32,
            b: (again * first) as f32,
        }
    }
}

/// A matrix and its modes.
pub type Coarse<const B: usize> = (ScaledMatrix<f64, B>, Modes<B>);

impl<const B: usize> Level<B> {
    /// A level and the next one; none where hardly anything can be gathered.
    ///
    /// # Errors
    /// Where the next one is not positive.
    pub fn new(
        matrix: &ScaledMatrix<f64, B>,
        modes: &Modes<B>,
        largest: f64,
    ) -> Result<Option<(Self, Coarse<B>)>, NotPositive> {
        let aggregates = aggregates(&matrix.ties);
        if aggregates.count == 0 || 10 * aggregates.count > 9 * matrix.nodes() {
            return Ok(None);
        }
        let (orthonormal, coefficients) = orthonormalised(modes, &aggregates).ok_or(NotPositive)?;
        // The weight that damps the smallest part of the spectrum most: Vaněk, Mandel & Brezina (1996), section 3.
        let weight = 4.0 / (3.0 * largest);
        let mut up = prolongation(matrix, &orthonormal, &aggregates, weight);
        let mut down = up.transposed(aggregates.count);
        let (coarse, scaling) = ScaledMatrix::from_whole(coarse_matrix(matrix, &up, &down))?;
        scale_transfer(&mut up, &mut down, &scaling.inverse);
        let coarse_modes = coefficients
            .iter()
            .zip(&scaling.lower)
            .map(|(modes, lower)| block_product(&transposed(lower), modes))
            .collect();
        let level = Self {
            matrix: matrix.rounded(),
            prolongation: up.rounded(),
            restriction: down.rounded(),
            smoother: Smoother::new(largest),
        };
        Ok(Some((level, (coarse, coarse_modes))))
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.matrix.nodes()
    }

    /// Smooths x = 0.
    pub fn smooth_from_zero(&self, work: &mut Work<B>) {
        let (right, Smoother { a, b }) = (&work.right, self.smoother);
        self.matrix.for_rows(right, &mut work.x, |row, product, x| {
            for ((x, product), right) in x.iter_mut().zip(product).zip(right[row]) {
                *x = a * right - b * product;
            }
        });
    }

    /// Smooths x by what it leaves.
    pub fn smooth(&self, work: &mut Work<B>) {
        let (rest, Smoother { a, b }) = (&work.rest, self.smoother);
        self.matrix.for_rows(rest, &mut work.x, |row, product, x| {
            for ((x, product), rest) in x.iter_mut().zip(product).zip(rest[row]) {
                *x += a * rest - b * product;
            }
        });
    }

    /// What x leaves.
    pub fn residual(&self, work: &mut Work<B>) {
        let right = &work.right;
        self.matrix
            .for_rows(&work.x, &mut work.rest, |row, product, rest| {
                for ((rest, product), right) in rest.iter_mut().zip(product).zip(right[row]) {
                    *rest = right - product;
                }
            });
    }

    /// To the aggregates.
    pub fn restrict(&self, rest: &[[f32; B]], right: &mut [[f32; B]]) {
        let chunks = right.par_chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(chunk, right)| {
            for (place, right) in right.iter_mut().enumerate() {
                *right = self.restriction.row_product(chunk * CHUNK + place, rest);
            }
        });
    }

    /// From the aggregates, added to x.
    pub fn prolong(&self, coarse: &[[f32; B]], x: &mut [[f32; B]]) {
        let chunks = x.par_chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(chunk, x)| {
            for (place, x) in x.iter_mut().enumerate() {
                let step = self.prolongation.row_product(chunk * CHUNK + place, coarse);
                for (x, step) in x.iter_mut().zip(step) {
                    *x += step;
                }
            }
        });
    }
}
