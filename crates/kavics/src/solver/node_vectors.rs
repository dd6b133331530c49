//! Vectors by nodes: sums over fixed chunks, added up in order, so that they are the same on any number of threads.

use rayon::prelude::*;

use super::block_matrix::CHUNK;

/// a·b.
pub fn dot<const B: usize>(a: &[[f64; B]], b: &[[f64; B]]) -> f64 {
    let chunks = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK));
    in_order(chunks.map(|(a, b)| flat_dot(a.as_flattened(), b.as_flattened())))
}

/// The dot product within a chunk.
pub fn flat_dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Euclidean norm.
pub fn norm<const B: usize>(a: &[[f64; B]]) -> f64 {
    dot(a, a).sqrt()
}

/// Parts added up in their order.
pub fn in_order(parts: impl IndexedParallelIterator<Item = f64>) -> f64 {
    let parts: Vec<f64> = parts.collect();
    parts.into_iter().sum()
}

/// The largest of parts; a part that is not a number wins.
pub fn largest_of(parts: impl Iterator<Item = f64>) -> f64 {
    parts.fold(0.0, |largest, part| {
        if part > largest || part.is_nan() {
            part
        } else {
            largest
        }
    })
}

/// Largest component times the weight of its node.
pub fn largest<const B: usize>(r: &[[f64; B]], weights: &[f32]) -> f64 {
    let chunks = r.par_chunks(CHUNK).zip(weights.par_chunks(CHUNK));
    let parts: Vec<f64> = chunks.map(|(r, w)| largest_in_chunk(r, w)).collect();
    largest_of(parts.into_iter())
}

/// The same within a chunk.
pub fn largest_in_chunk<const B: usize>(r: &[[f64; B]], weights: &[f32]) -> f64 {
    let nodes = r.iter().zip(weights);
    largest_of(nodes.map(|(r, &weight)| f64::from(weight) * largest_of(r.iter().map(|v| v.abs()))))
}

/// y ← combine(y, x), component by component.
pub fn update<const B: usize>(
    y: &mut [[f64; B]],
    x: &[[f64; B]],
    combine: impl Fn(f64, f64) -> f64 + Sync,
) {
    let chunks = y.par_chunks_mut(CHUNK).zip(x.par_chunks(CHUNK));
    chunks.for_each(|(y, x)| {
        for (y, x) in y.as_flattened_mut().iter_mut().zip(x.as_flattened()) {
            *y = combine(*y, *x);
        }
    });
}

/// y ← combine(y, x), with x in single precision.
pub fn update_by_single<const B: usize>(
    y: &mut [[f64; B]],
    x: &[[f32; B]],
    combine: impl Fn(f64, f64) -> f64 + Sync,
) {
    let chunks = y.par_chunks_mut(CHUNK).zip(x.par_chunks(CHUNK));
    chunks.for_each(|(y, x)| {
        for (y, x) in y.as_flattened_mut().iter_mut().zip(x.as_flattened()) {
            *y = combine(*y, f64::from(*x));
        }
    });
}

/// Writes r times a factor in single precision.
pub fn round<const B: usize>(r: &[[f64; B]], factor: f64, single: &mut [[f32; B]]) {
    let chunks = single.par_chunks_mut(CHUNK).zip(r.par_chunks(CHUNK));
    chunks.for_each(|(single, r)| {
        for (single, r) in single.as_flattened_mut().iter_mut().zip(r.as_flattened()) {
            *single = (r * factor) as f32;
        }
    });
}
