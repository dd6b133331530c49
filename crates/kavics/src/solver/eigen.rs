//! Lowest eigenvalues of a symmetric matrix, and how many lie below a bound.
//!
//! Small matrices are solved dense. Larger ones by a block Krylov method on the inverse of the shifted matrix, with
//! full orthogonalisation: a block holds as many vectors as are wanted and more, so that no eigenvalue that comes
//! several times is overlooked (Parlett, The Symmetric Eigenvalue Problem, 1980, chapters 11 and 13).

use faer::diag::Diag;
use std::ops::Range;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{self, ComputeEigenvectors};
use faer::{Mat, MatRef, Par};

use super::pattern::Pattern;
use super::{Singular, SymmetricSolver, minimum_degree};

/// Up to this many unknowns, or this many a wanted eigenvalue, the matrix is solved dense.
const DENSE: [usize; 2] = [150, 12];
/// Distance of the first shift from zero, as a share of the scale.
const SHIFT: f64 = 1e-6;
/// Shifts, each ten times as far below zero as the one before, until they are below the lowest eigenvalue.
const MOST_SHIFTS: usize = 16;
/// Vectors of a block beyond those that are wanted.
const SPARE: usize = 2;
/// Blocks of the basis before it is restarted, and restarts.
const MOST_BLOCKS: usize = 10;
const MOST_RESTARTS: usize = 100;
/// Residual of an eigenpair that is good enough, as a share of the eigenvalue.
const TOLERANCE: f64 = 1e-8;
/// Rounding of a product with the matrix, as a share of its largest entry.
const NOISE: f64 = 1e-14;
/// A vector of which less than this share is new is none.
const NOTHING_NEW: f64 = 1e-10;

/// The problem K·x = λ·D·x: K symmetric, D diagonal and positive.
#[derive(Clone, Copy, Debug)]
pub struct EigenProblem<'a> {
    /// Where the entries of the lower triangle of K stand.
    pub pattern: &'a Pattern,
    /// The entries of K.
    pub values: &'a [f64],
    /// The diagonal of D.
    pub weights: &'a [f64],
    /// The size of an eigenvalue that is not small.
    pub scale: f64,
}

/// Eigenvalues in rising order, and eigenvectors with xᵀ·D·x = 1.
#[derive(Clone, Debug, Default)]
pub struct Eigenpairs {
    /// The eigenvalues λ.
    pub values: Vec<f64>,
    /// Their eigenvectors x.
    pub vectors: Vec<Vec<f64>>,
}

impl EigenProblem<'_> {
    /// The lowest eigenvalues with their eigenvectors: `count` of them, or all there are.
    ///
    /// # Errors
    /// Where the matrix is not finite, or the iteration does not settle.
    pub fn lowest(&self, count: usize) -> Result<Eigenpairs, Singular> {
        let count = count.min(self.pattern.order());
        if count == 0 {
            return Ok(Eigenpairs::default());
        }
        let [most, most_each] = DENSE;
        if self.pattern.order() <= most.max(most_each * count) {
            self.dense(count)
        } else {
            self.by_krylov(count)
        }
    }

    /// How many eigenvalues lie below `bound`: the negative pivots of K − bound·D (Sylvester's law of inertia).
    ///
    /// # Errors
    /// Where K − bound·D has no factor.
    pub fn count_below(&self, bound: f64) -> Result<usize, Singular> {
        if self.pattern.order() == 0 {
            return Ok(0);
        }
        Ok(self.factor(bound)?.1)
    }

    /// The factor of K − shift·D, and its negative pivots.
    fn factor(&self, shift: f64) -> Result<(SymmetricSolver, usize), Singular> {
        let mut shifted = self.values.to_vec();
        for (column, weight) in self.weights.iter().enumerate() {
            shifted[self.pattern.diagonal(column)] -= shift * weight;
        }
        let mut solver = SymmetricSolver::new(self.pattern, &minimum_degree(self.pattern)?)?;
        let inertia = solver.factorise(self.pattern, &shifted)?;
        Ok((solver, inertia.negative))
    }

    fn dense(&self, count: usize) -> Result<Eigenpairs, Singular> {
        let order = self.pattern.order();
        let scale: Vec<f64> = self
            .weights
            .iter()
            .map(|weight| 1.0 / weight.sqrt())
            .collect();
        let mut matrix = Mat::<f64>::zeros(order, order);
        for column in 0..order {
            let entries = self.pattern.column_start[column]..self.pattern.column_start[column + 1];
            for entry in entries {
                let row = self.pattern.row[entry];
                let value = self.values[entry] * scale[row] * scale[column];
                matrix[(row, column)] += value;
                if row != column {
                    matrix[(column, row)] += value;
                }
            }
        }
        let (values, vectors) = symmetric_eigen(matrix.as_ref())?;
        let vector = |j: usize| (0..order).map(|i| vectors[(i, j)] * scale[i]).collect();
        Ok(Eigenpairs {
            values: values[..count].to_vec(),
            vectors: (0..count).map(vector).collect(),
        })
    }

    fn by_krylov(&self, count: usize) -> Result<Eigenpairs, Singular> {
        let mut basis = Basis::new(self);
        let mut slices = self.slices(count)?;
        while let Some((mut solver, wanted)) = slices.pop() {
            basis = basis.with_lowest(&mut solver, wanted)?;
        }
        Ok(basis.into_eigenpairs())
    }

    /// Factors of K − σD with shifts σ, the first just below zero, the others farther below until nothing lies below; and how
    /// many eigenvalues are to be known with each of them, those below it included.
    fn slices(&self, count: usize) -> Result<Vec<(SymmetricSolver, usize)>, Singular> {
        let (mut shift, mut wanted) = (-SHIFT * self.scale, count);
        let mut slices = Vec::new();
        while wanted > 0 {
            if slices.len() == MOST_SHIFTS {
                return Err(Singular);
            }
            let (solver, below) = self.factor(shift)?;
            slices.push((solver, wanted));
            wanted = wanted.min(below);
            shift *= 10.0;
        }
        Ok(slices)
    }

    /// K·x.
    fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; x.len()];
        for column in 0..x.len() {
            let (mut sum, start) = (0.0, self.pattern.column_start[column]);
            for entry in start..self.pattern.column_start[column + 1] {
                let (row, value) = (self.pattern.row[entry], self.values[entry]);
                product[row] += value * x[column];
                if row != column {
                    sum += value * x[row];
                }
            }
            product[column] += sum;
        }
        product
    }

    /// The rounding of K·x, of a vector of length 1.
    fn noise(&self) -> f64 {
        let size = |(column, weight)| self.values[self.pattern.diagonal(column)].abs() / weight;
        NOISE
            * self
                .weights
                .iter()
                .enumerate()
                .map(size)
                .fold(0.0, f64::max)
    }
}

/// A start vector without any symmetry of the assembly: the additive sequence of a quadratic irrational.
fn scattered(order: usize, column: usize) -> Vec<f64> {
    const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];
    let step = (STEPS[0] * (column + 1) as f64 + STEPS[1]).fract();
    (1..=order)
        .map(|row| (step * row as f64).fract() - 0.5)
        .collect()
}

/// Vectors v with vᵢᵀ·D·vⱼ = δᵢⱼ, and K·v of each.
struct Basis<'a> {
    problem: &'a EigenProblem<'a>,
    vectors: Vec<Vec<f64>>,
    images: Vec<Vec<f64>>,
}

/// Approximate eigenvalues in rising order, and their vectors in the basis.
struct Ritz {
    values: Vec<f64>,
    shares: Mat<f64>,
}

impl<'a> Basis<'a> {
    fn new(problem: &'a EigenProblem<'a>) -> Self {
        Self {
            problem,
            vectors: Vec::new(),
            images: Vec::new(),
        }
    }

    fn len(&self) -> usize {
        self.vectors.len()
    }

    /// The basis of the lowest eigenvectors, from one that holds those below the shift of the factor.
    fn with_lowest(mut self, solver: &mut SymmetricSolver, count: usize) -> Result<Self, Singular> {
        let (known, width) = (self.len(), count - self.len() + SPARE);
        let most = known + MOST_BLOCKS * width;
        let mut last = self.add_block(solver, |column, order| scattered(order, column), 0..width);
        for _ in 0..MOST_RESTARTS * MOST_BLOCKS {
            let ritz = self.ritz()?;
            if last.is_empty() || self.is_good(&ritz, count) {
                let found = self.first(&ritz, count);
                return if found.len() == count {
                    Ok(found)
                } else {
                    Err(Singular)
                };
            }
            if self.len() + width > most {
                self = self.first(&ritz, count + width);
                last = known..known + width;
            }
            let from = self.vectors[last.clone()].to_vec();
            last = self.add_block(solver, |column, _| from[column].clone(), 0..from.len());
        }
        Err(Singular)
    }

    /// Adds what is new of (K − σD)⁻¹·D·x for some x; answers where it stands.
    fn add_block(
        &mut self,
        solver: &mut SymmetricSolver,
        x: impl Fn(usize, usize) -> Vec<f64>,
        columns: Range<usize>,
    ) -> Range<usize> {
        let start = self.len();
        for column in columns {
            let mut vector = x(column, self.problem.weights.len());
            for (value, weight) in vector.iter_mut().zip(self.problem.weights) {
                *value *= weight;
            }
            solver.solve(&mut vector);
            self.add(vector);
        }
        start..self.len()
    }

    /// Adds what is new of a vector.
    fn add(&mut self, mut vector: Vec<f64>) {
        let before = self.norm(&vector);
        // Once more, as the first pass leaves rounding of what it takes away.
        for _ in 0..2 {
            for other in &self.vectors {
                let share = self.inner(other, &vector);
                add(&mut vector, other, -share);
            }
        }
        let norm = self.norm(&vector);
        if norm > NOTHING_NEW * before {
            for value in &mut vector {
                *value /= norm;
            }
            self.images.push(self.problem.times(&vector));
            self.vectors.push(vector);
        }
    }

    fn inner(&self, a: &[f64], b: &[f64]) -> f64 {
        let products = a.iter().zip(b).zip(self.problem.weights);
        products.map(|((a, b), d)| a * b * d).sum()
    }

    fn norm(&self, a: &[f64]) -> f64 {
        self.inner(a, a).sqrt()
    }

    /// The approximate eigenpairs in the space of the basis.
    fn ritz(&self) -> Result<Ritz, Singular> {
        let entry = |i: usize, j: usize| dot(&self.vectors[i], &self.images[j]);
        let projected = Mat::from_fn(self.len(), self.len(), |i, j| entry(i.max(j), i.min(j)));
        let (values, shares) = symmetric_eigen(projected.as_ref())?;
        Ok(Ritz { values, shares })
    }

    /// Whether the first eigenpairs leave residuals that are small against their distance from zero.
    fn is_good(&self, ritz: &Ritz, count: usize) -> bool {
        let least = SHIFT * self.problem.scale;
        let noise = self.problem.noise();
        self.len() >= count
            && (0..count).all(|j| {
                let bound = TOLERANCE * ritz.values[j].abs().max(least);
                self.residual(ritz, j) <= bound.max(noise)
            })
    }

    /// ‖K·x − λ·D·x‖ in the norm of D⁻¹.
    fn residual(&self, ritz: &Ritz, which: usize) -> f64 {
        let x = combined(&self.vectors, ritz, which);
        let image = combined(&self.images, ritz, which);
        let left = x.iter().zip(&image).zip(self.problem.weights);
        let squares = left.map(|((x, image), d)| {
            let rest = image - ritz.values[which] * d * x;
            rest * rest / d
        });
        squares.sum::<f64>().sqrt()
    }

    /// The basis of the first approximate eigenvectors.
    fn first(&self, ritz: &Ritz, count: usize) -> Self {
        let mut first = Self::new(self.problem);
        for which in 0..count.min(self.len()) {
            first.add(combined(&self.vectors, ritz, which));
        }
        first
    }

    fn into_eigenpairs(self) -> Eigenpairs {
        let pairs = self.vectors.iter().zip(&self.images);
        Eigenpairs {
            values: pairs.map(|(x, image)| dot(x, image)).collect(),
            vectors: self.vectors,
        }
    }
}

fn combined(columns: &[Vec<f64>], ritz: &Ritz, which: usize) -> Vec<f64> {
    let mut sum = vec![0.0; columns[0].len()];
    for (i, column) in columns.iter().enumerate() {
        add(&mut sum, column, ritz.shares[(i, which)]);
    }
    sum
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(sum: &mut [f64], other: &[f64], share: f64) {
    for (sum, other) in sum.iter_mut().zip(other) {
        *sum += share * other;
    }
}

/// Eigenvalues of a dense symmetric matrix in rising order, and eigenvectors as columns.
fn symmetric_eigen(matrix: MatRef<'_, f64>) -> Result<(Vec<f64>, Mat<f64>), Singular> {
    let order = matrix.nrows();
    let (mut values, mut vectors) = (Diag::<f64>::zeros(order), Mat::zeros(order, order));
    let parameters = faer::Spec::default();
    let scratch =
        evd::self_adjoint_evd_scratch::<f64>(order, ComputeEigenvectors::Yes, Par::Seq, parameters);
    evd::self_adjoint_evd(
        matrix,
        values.as_mut(),
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        parameters,
    )
    .map_err(|_| Singular)?;
    let values: Vec<f64> = (0..order).map(|i| values.column_vector()[i]).collect();
    if values.iter().all(|value| value.is_finite()) {
        Ok((values, vectors))
    } else {
        Err(Singular)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chains of springs of stiffness 1 side by side, their first nodes held by springs of the given stiffness.
    struct Chains {
        pattern: Pattern,
        values: Vec<f64>,
        weights: Vec<f64>,
    }

    impl Chains {
        fn new(nodes: usize, held: &[f64]) -> Self {
            let (mut pattern, mut values) = (Pattern::default(), Vec::new());
            pattern.column_start.push(0);
            for (chain, &spring) in held.iter().enumerate() {
                for node in 0..nodes {
                    let at = chain * nodes + node;
                    let before = if node == 0 { spring } else { 1.0 };
                    pattern.row.push(at);
                    values.push(before + f64::from(u8::from(node + 1 < nodes)));
                    if node + 1 < nodes {
                        pattern.row.push(at + 1);
                        values.push(-1.0);
                    }
                    pattern.column_start.push(pattern.row.len());
                }
            }
            let weights = vec![1.0; nodes * held.len()];
            Self {
                pattern,
                values,
                weights,
            }
        }

        fn problem(&self) -> EigenProblem<'_> {
            EigenProblem {
                pattern: &self.pattern,
                values: &self.values,
                weights: &self.weights,
                scale: 1.0,
            }
        }
    }

    /// Largest entry of K·x − λ·D·x.
    fn residual(problem: &EigenProblem<'_>, value: f64, x: &[f64]) -> f64 {
        let mut left: Vec<f64> = x
            .iter()
            .zip(problem.weights)
            .map(|(x, d)| -value * d * x)
            .collect();
        for column in 0..x.len() {
            for entry in
                problem.pattern.column_start[column]..problem.pattern.column_start[column + 1]
            {
                let row = problem.pattern.row[entry];
                left[row] += problem.values[entry] * x[column];
                if row != column {
                    left[column] += problem.values[entry] * x[row];
                }
            }
        }
        left.into_iter().map(f64::abs).fold(0.0, f64::max)
    }

    /// A chain of n nodes held at its first by the spring 1 has λ = 4 sin²((k − ½)π/(2n + 1)), k = 1, 2, …
    #[test]
    fn a_chain_has_the_eigenvalues_of_its_closed_form() {
        let chains = Chains::new(400, &[1.0]);
        let pairs = chains.problem().by_krylov(5).expect("eigenvalues");
        for (k, (&value, x)) in pairs.values.iter().zip(&pairs.vectors).enumerate() {
            let half = libm::sin((k as f64 + 0.5) * std::f64::consts::PI / 801.0);
            assert!((value - 4.0 * half * half).abs() < 1e-13, "{k}: {value}");
            assert!(residual(&chains.problem(), value, x) < 1e-9);
        }
    }

    #[test]
    fn eigenvalues_that_come_several_times_are_all_found() {
        let chains = Chains::new(40, &[1.0; 7]);
        let (sparse, dense) = (chains.problem().by_krylov(10), chains.problem().dense(10));
        let (sparse, dense) = (sparse.expect("found"), dense.expect("found"));
        for (one, other) in sparse.values.iter().zip(&dense.values) {
            assert!((one - other).abs() < 1e-12, "{one} {other}");
        }
    }

    #[test]
    fn zero_and_negative_eigenvalues_are_found_and_counted() {
        let chains = Chains::new(50, &[1.0, 0.0, -0.5, 0.0, 2.0]);
        let problem = chains.problem();
        let (sparse, dense) = (problem.by_krylov(6), problem.dense(6));
        let (sparse, dense) = (sparse.expect("found"), dense.expect("found"));
        for (one, other) in sparse.values.iter().zip(&dense.values) {
            assert!((one - other).abs() < 1e-12, "{one} {other}");
        }
        // A spring of stiffness −½ at the end of a chain leaves one negative eigenvalue.
        assert!(sparse.values[0] < -0.1);
        assert!(sparse.values[1..3].iter().all(|value| value.abs() < 1e-13));
        assert_eq!(problem.count_below(-1e-11).expect("a factor"), 1);
        assert_eq!(problem.count_below(1e-11).expect("a factor"), 3);
    }

    #[test]
    fn weights_divide_the_eigenvalues() {
        let mut chains = Chains::new(200, &[1.0]);
        chains.weights.fill(4.0);
        let pairs = chains.problem().lowest(1).expect("eigenvalues");
        let half = libm::sin(0.5 * std::f64::consts::PI / 401.0);
        assert!((pairs.values[0] - half * half).abs() < 1e-13);
        let length: f64 = pairs.vectors[0].iter().map(|x| 4.0 * x * x).sum();
        assert!((length - 1.0).abs() < 1e-12);
    }
}
