//! Small dense blocks: the freedoms of one node by those of another.

use std::ops::{AddAssign, Mul};

/// A block by its columns: `block[column][row]`.
pub type Block<T, const B: usize> = [[T; B]; B];

/// A pivot below this share of its diagonal entry is rounding.
const ROUNDING: f64 = 1e-12;

/// A number that vectors and blocks are made of: double precision, or single in a preconditioner.
pub trait Real:
    Copy + Default + Send + Sync + AddAssign + Mul<Output = Self> + From<f32> + 'static
{
    /// The nearest number of this precision.
    fn nearest(value: f64) -> Self;
}

impl Real for f64 {
    fn nearest(value: f64) -> Self {
        value
    }
}

impl Real for f32 {
    fn nearest(value: f64) -> Self {
        value as f32
    }
}

/// A·x added to `sum`.
#[inline]
pub fn add_product<T: Real, const B: usize>(sum: &mut [T; B], a: &Block<T, B>, x: &[T; B]) {
    for (column, &factor) in a.iter().zip(x) {
        for (sum, &entry) in sum.iter_mut().zip(column) {
            *sum += entry * factor;
        }
    }
}

/// A·x.
#[inline]
pub fn times<T: Real, const B: usize>(a: &Block<T, B>, x: &[T; B]) -> [T; B] {
    let mut product = [T::default(); B];
    add_product(&mut product, a, x);
    product
}

/// A·C added to `sum`.
#[inline]
pub fn add_block_product<const B: usize>(
    sum: &mut Block<f64, B>,
    a: &Block<f64, B>,
    c: &Block<f64, B>,
) {
    for (sum, column) in sum.iter_mut().zip(c) {
        add_product(sum, a, column);
    }
}

/// A·C.
#[inline]
pub fn block_product<const B: usize>(a: &Block<f64, B>, c: &Block<f64, B>) -> Block<f64, B> {
    let mut product = [[0.0; B]; B];
    add_block_product(&mut product, a, c);
    product
}

/// Rows for columns.
#[inline]
pub fn transposed<T: Real, const B: usize>(a: &Block<T, B>) -> Block<T, B> {
    let mut transposed = [[T::default(); B]; B];
    for (j, column) in a.iter().enumerate() {
        for (i, &entry) in column.iter().enumerate() {
            transposed[i][j] = entry;
        }
    }
    transposed
}

/// Every entry by a factor.
pub fn scaled<const B: usize>(a: &Block<f64, B>, factor: f64) -> Block<f64, B> {
    a.map(|column| column.map(|entry| factor * entry))
}

/// The block in another precision.
pub fn rounded<T: Real, const B: usize>(a: &Block<f64, B>) -> Block<T, B> {
    a.map(|column| column.map(T::nearest))
}

/// L of A = L·Lᵀ. A freedom without stiffness of its own, by the freedoms before it, is left out: its row and column
/// are zero. None where a pivot is negative beyond rounding.
pub fn cholesky<const B: usize>(a: &Block<f64, B>) -> Option<Block<f64, B>> {
    let mut l = [[0.0; B]; B];
    for j in 0..B {
        let pivot = a[j][j] - (0..j).map(|k| l[k][j] * l[k][j]).sum::<f64>();
        if pivot.is_nan() || pivot < -ROUNDING * a[j][j].abs() {
            return None;
        }
        if pivot <= ROUNDING * a[j][j] {
            continue;
        }
        l[j][j] = pivot.sqrt();
        for i in j + 1..B {
            let before = (0..j).map(|k| l[k][i] * l[k][j]).sum::<f64>();
            l[j][i] = (a[j][i] - before) / l[j][j];
        }
    }
    Some(l)
}

/// L⁻¹ of a lower triangle; zero in the rows and columns of freedoms left out.
pub fn lower_inverse<const B: usize>(l: &Block<f64, B>) -> Block<f64, B> {
    let mut inverse = [[0.0; B]; B];
    for j in (0..B).filter(|&j| l[j][j] > 0.0) {
        inverse[j][j] = 1.0 / l[j][j];
        for i in (j + 1..B).filter(|&i| l[i][i] > 0.0) {
            let sum: f64 = (j..i).map(|k| l[k][i] * inverse[j][k]).sum();
            inverse[j][i] = -sum / l[i][i];
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factor_times_its_transpose_is_the_block() {
        let a = [[4.0, 2.0, -1.0], [2.0, 5.0, 0.5], [-1.0, 0.5, 3.0]];
        let l = cholesky(&a).unwrap();
        let product = block_product(&l, &transposed(&l));
        let one = block_product(&l, &lower_inverse(&l));
        for i in 0..3 {
            for j in 0..3 {
                assert!((product[i][j] - a[i][j]).abs() < 1e-15);
                assert!((one[i][j] - f64::from(u8::from(i == j))).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn a_freedom_without_stiffness_is_left_out() {
        let a = [[4.0, 0.0, 2.0], [0.0, 0.0, 0.0], [2.0, 0.0, 1.0]];
        let inverse = lower_inverse(&cholesky(&a).unwrap());
        assert_eq!(inverse[0], [0.5, 0.0, 0.0]);
        assert_eq!([inverse[1], inverse[2]], [[0.0; 3]; 2]);
    }

    #[test]
    fn a_negative_pivot_has_no_factor() {
        assert!(cholesky(&[[1.0, 2.0], [2.0, 1.0]]).is_none());
    }
}
