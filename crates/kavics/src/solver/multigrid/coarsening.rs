//! From one level to the next: how displacements of the aggregates become those of the nodes, and the matrix that
//! follows.

use rayon::prelude::*;

use super::aggregation::Aggregates;
use crate::solver::block::{
    Block, add_block_product, block_product, cholesky, lower_inverse, scaled, transposed,
};
use crate::solver::block_matrix::{BlockMatrix, Nodes};
use crate::solver::scaled_matrix::ScaledMatrix;

/// Steps of the power method.
/// Modes at the nodes: their values column by column.
pub type Modes<const B: usize> = Vec<Block<f64, B>>;

/// Modes orthonormal over each aggregate, and their coefficients: T = Q·R.
pub fn orthonormalised<const B: usize>(
    modes: &Modes<B>,
    aggregates: &Aggregates,
) -> Option<(Modes<B>, Modes<B>)> {
    let mut squares = vec![[[0.0; B]; B]; aggregates.count];
    for (mode, aggregate) in modes.iter().zip(&aggregates.of) {
        if let Some(aggregate) = aggregate {
            add_block_product(&mut squares[*aggregate as usize], &transposed(mode), mode);
        }
    }
    let factors: Vec<Block<f64, B>> = squares.iter().map(cholesky).collect::<Option<_>>()?;
    let inverses: Vec<Block<f64, B>> = factors
        .iter()
        .map(|factor| transposed(&lower_inverse(factor)))
        .collect();
    let orthonormal = modes.iter().zip(&aggregates.of).map(|(mode, aggregate)| {
        aggregate.map_or([[0.0; B]; B], |aggregate| {
            block_product(mode, &inverses[aggregate as usize])
        })
    });
    Some((
        orthonormal.collect(),
        factors.iter().map(transposed).collect(),
    ))
}

/// P = (I − ω·A)·Q, but P = Q at hubs.
pub fn prolongation<const B: usize>(
    matrix: &ScaledMatrix<f64, B>,
    modes: &Modes<B>,
    aggregates: &Aggregates,
    weight: f64,
) -> BlockMatrix<f64, B> {
    let own = modes
        .iter()
        .zip(&aggregates.is_hub)
        .map(|(mode, &is_hub)| scaled(mode, if is_hub { 1.0 } else { 1.0 - weight }))
        .collect::<Vec<_>>();
    let ties: Vec<Block<f64, B>> = modes.par_iter().map(|mode| scaled(mode, -weight)).collect();
    BlockMatrix::from_rows(modes.len(), aggregates.count, |row, sum| {
        if let Some(aggregate) = aggregates.of[row] {
            *sum.entry(aggregate) = own[row];
        }
        if aggregates.is_hub[row] {
            return;
        }
        let (columns, blocks) = matrix.ties.row(row);
        for (&column, block) in columns.iter().zip(blocks) {
            if let Some(aggregate) = aggregates.of[column as usize] {
                sum.add(aggregate, block, &ties[column as usize]);
            }
        }
    })
}

/// Pᵀ·A·P.
pub fn coarse_matrix<const B: usize>(
    matrix: &ScaledMatrix<f64, B>,
    prolongation: &BlockMatrix<f64, B>,
    restriction: &BlockMatrix<f64, B>,
) -> BlockMatrix<f64, B> {
    let aggregates = restriction.rows();
    let half = BlockMatrix::from_rows(matrix.ties.rows(), aggregates, |row, sum| {
        let (columns, blocks) = prolongation.row(row);
        for (&column, block) in columns.iter().zip(blocks) {
            *sum.entry(column) = *block;
        }
        let (others, ties) = matrix.ties.row(row);
        for (&other, tie) in others.iter().zip(ties) {
            let (columns, blocks) = prolongation.row(other as usize);
            for (&column, block) in columns.iter().zip(blocks) {
                sum.add(column, tie, block);
            }
        }
    });
    BlockMatrix::from_rows(aggregates, aggregates, |row, sum| {
        let (nodes, weights) = restriction.row(row);
        for (&node, weight) in nodes.iter().zip(weights) {
            let (columns, blocks) = half.row(node as usize);
            for (&column, block) in columns.iter().zip(blocks) {
                sum.add(column, weight, block);
            }
        }
    })
}

/// P·L⁻ᵀ, and its transpose.
pub fn scale_transfer<const B: usize>(
    prolongation: &mut BlockMatrix<f64, B>,
    restriction: &mut BlockMatrix<f64, B>,
    inverse: &Modes<B>,
) {
    let blocks = prolongation.block.par_iter_mut();
    blocks
        .zip(&prolongation.column)
        .for_each(|(block, &column)| {
            *block = block_product(block, &transposed(&inverse[column as usize]));
        });
    for (row, inverse) in inverse.iter().enumerate() {
        for block in restriction.row_mut(row) {
            *block = block_product(inverse, block);
        }
    }
}

/// Largest eigenvalue, by the power method from a fixed start, and a tenth more.
pub fn largest_eigenvalue<const B: usize>(matrix: &ScaledMatrix<f64, B>) -> f64 {
    let rows = matrix.ties.rows();
    // Any start will do that is no eigenvector.
    let start = |place: usize| ((place * 7919) % 1013) as f64 / 1013.0 - 0.5;
    let mut x: Nodes<f64, B> = (0..rows)
        .map(|row| std::array::from_fn(|i| start(row * B + i)))
        .collect();
    let mut next = vec![[0.0; B]; rows];
    let mut largest = norm(&x);
    for _ in 0..POWER_STEPS {
        for value in x.as_flattened_mut() {
            *value /= largest;
        }
        matrix.multiply(&x, &mut next);
        largest = norm(&next);
        std::mem::swap(&mut x, &mut next);
    }
    1.1 * largest
}

const POWER_STEPS: usize = 10;

fn norm<const B: usize>(x: &[[f64; B]]) -> f64 {
    x.as_flattened().iter().map(|v| v * v).sum::<f64>().sqrt()
}
