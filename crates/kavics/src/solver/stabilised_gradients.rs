//! Stabilised biconjugate gradients with multigrid, for systems that are not symmetric.
//!
//! van der Vorst, SIAM J. Sci. Stat. Comput. 13 (1992) 631, preconditioned from the right.

use rayon::prelude::*;

use super::block_matrix::{BlockMatrix, CHUNK, Nodes};
use super::iterative::{Goal, Iterated};
use super::multigrid::Multigrid;
use super::node_vectors::{dot, largest, norm, round, update};

/// Solves A·x = b from x = 0; the multigrid is that of a symmetric matrix near to A.
pub fn stabilised_gradients<const B: usize>(
    matrix: &BlockMatrix<f64, B>,
    multigrid: &mut Multigrid<B>,
    right: Nodes<f64, B>,
    goal: &mut Goal<'_>,
) -> (Nodes<f64, B>, Iterated) {
    let zero = vec![[0.0; B]; right.len()];
    let (mut x, mut v, mut p) = (zero.clone(), zero.clone(), zero);
    let mut r = right;
    let shadow = r.clone();
    let (mut rho, mut alpha, mut omega) = (1.0, 1.0, 1.0);
    loop {
        if let Some(end) = goal.end(largest(&r, goal.weights)) {
            return (x, end);
        }
        let next = dot(&shadow, &r);
        let beta = (next / rho) * (alpha / omega);
        rho = next;
        update(&mut p, &v, |p, v| beta * (p - omega * v));
        update(&mut p, &r, |p, r| p + r);
        let y = preconditioned(multigrid, &p);
        v = product(matrix, &y);
        alpha = rho / dot(&shadow, &v);
        update(&mut r, &v, |r, v| r - alpha * v);
        let z = preconditioned(multigrid, &r);
        let t = product(matrix, &z);
        omega = dot(&t, &r) / dot(&t, &t);
        update(&mut x, &y, |x, y| x + alpha * y);
        if r.iter().all(|r| *r == [0.0; B]) {
            return (x, Iterated::Converged);
        }
        if !(rho.is_normal() && alpha.is_finite() && omega.is_normal()) {
            return (x, Iterated::Stagnated);
        }
        update(&mut x, &z, |x, z| x + omega * z);
        update(&mut r, &t, |r, t| r - omega * t);
    }
}

fn preconditioned<const B: usize>(multigrid: &mut Multigrid<B>, r: &[[f64; B]]) -> Nodes<f64, B> {
    let scale = norm(r);
    if scale == 0.0 {
        return r.to_vec();
    }
    let z = multigrid.apply(|single| round(r, 1.0 / scale, single));
    let z = z.par_iter().map(|z| z.map(|z| scale * f64::from(z)));
    z.collect()
}

fn product<const B: usize>(matrix: &BlockMatrix<f64, B>, x: &[[f64; B]]) -> Nodes<f64, B> {
    let mut y = vec![[0.0; B]; x.len()];
    y.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, y)| {
        for (place, y) in y.iter_mut().enumerate() {
            *y = matrix.row_product(chunk * CHUNK + place, x);
        }
    });
    y
}
