//! Conjugate gradients with multigrid, for symmetric positive definite systems.

use rayon::prelude::*;

use super::block_matrix::{CHUNK, Nodes};
use super::iterative::{Goal, Iterated};
use super::multigrid::Multigrid;
use super::node_vectors::{
    flat_dot, in_order, largest, largest_in_chunk, largest_of, norm, round, update_by_single,
};
use super::scaled_matrix::ScaledMatrix;

/// Solves A·x = b for a scaled matrix from x = 0.
///
/// The multigrid works in single precision and is symmetric but for its rounding; the flexible form of the method
/// bears that. Notay, SIAM J. Sci. Comput. 22 (2000) 1444.
pub fn conjugate_gradients<const B: usize>(
    matrix: &ScaledMatrix<f64, B>,
    multigrid: &mut Multigrid<B>,
    right: Nodes<f64, B>,
    goal: &mut Goal<'_>,
) -> (Nodes<f64, B>, Iterated) {
    let mut x = vec![[0.0; B]; right.len()];
    let (mut p, mut q) = (x.clone(), x.clone());
    let mut r = right;
    let mut rest = largest(&r, goal.weights);
    // Those of the last iteration: α and r·z.
    let (mut alpha, mut product) = (0.0, 1.0);
    loop {
        if let Some(end) = goal.end(rest) {
            return (x, end);
        }
        let scale = norm(&r);
        let z = multigrid.apply(|single| round(&r, 1.0 / scale, single));
        let (rz, qz) = products(&r, &q, z);
        // z·(r − r₀) over that of the last iteration, with r − r₀ = −α·q.
        let beta = -alpha * scale * qz / product;
        product = scale * rz;
        update_by_single(&mut p, z, |p, z| scale * z + beta * p);
        let curvature = multiply(matrix, &p, &mut q);
        if !(product > 0.0 && curvature > 0.0) {
            return (x, Iterated::NegativeCurvature);
        }
        alpha = product / curvature;
        rest = step(alpha, (&p, &q), (&mut x, &mut r), goal.weights);
    }
}

/// r·z and q·z.
fn products<const B: usize>(r: &[[f64; B]], q: &[[f64; B]], z: &[[f32; B]]) -> (f64, f64) {
    let chunks = r.par_chunks(CHUNK).zip(q.par_chunks(CHUNK));
    let parts: Vec<(f64, f64)> = chunks
        .zip(z.par_chunks(CHUNK))
        .map(|((r, q), z)| {
            let entries = r.as_flattened().iter().zip(q.as_flattened());
            let entries = entries.zip(z.as_flattened());
            entries.fold((0.0, 0.0), |(rz, qz), ((r, q), &z)| {
                (rz + r * f64::from(z), qz + q * f64::from(z))
            })
        })
        .collect();
    let sum = |(a, b), (c, d)| (a + c, b + d);
    parts.into_iter().fold((0.0, 0.0), sum)
}

/// q = A·p; answers p·q.
fn multiply<const B: usize>(
    matrix: &ScaledMatrix<f64, B>,
    p: &[[f64; B]],
    q: &mut [[f64; B]],
) -> f64 {
    in_order(q.par_chunks_mut(CHUNK).enumerate().map(|(chunk, q)| {
        let first = chunk * CHUNK;
        for (place, q) in q.iter_mut().enumerate() {
            *q = matrix.row_product(first + place, p);
        }
        flat_dot(p[first..first + q.len()].as_flattened(), q.as_flattened())
    }))
}

/// x ← x + α·p, r ← r − α·q; answers the largest weighted residual.
fn step<const B: usize>(
    alpha: f64,
    (p, q): (&[[f64; B]], &[[f64; B]]),
    (x, r): (&mut [[f64; B]], &mut [[f64; B]]),
    weights: &[f32],
) -> f64 {
    let changed = x.par_chunks_mut(CHUNK).zip(r.par_chunks_mut(CHUNK));
    let given = p.par_chunks(CHUNK).zip(q.par_chunks(CHUNK));
    let parts: Vec<f64> = changed
        .zip(given)
        .zip(weights.par_chunks(CHUNK))
        .map(|(((x, r), (p, q)), weights)| {
            for (x, p) in x.as_flattened_mut().iter_mut().zip(p.as_flattened()) {
                *x += alpha * p;
            }
            for (r, q) in r.as_flattened_mut().iter_mut().zip(q.as_flattened()) {
                *r -= alpha * q;
            }
            largest_in_chunk(r, weights)
        })
        .collect();
    largest_of(parts.into_iter())
}
