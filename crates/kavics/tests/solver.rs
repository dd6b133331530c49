//! The factor of a sparse symmetric matrix against dense algebra.

use faer::Mat;
use faer::linalg::solvers::Solve;
use kavics::solver::{Inertia, Pattern, Singular, SymmetricSolver, minimum_degree};
use proptest::prelude::*;

/// Unknowns of a node.
const BLOCK: usize = 3;

type Entries = Vec<(usize, [f64; 3])>;

/// The matrix of springs between nodes and to the ground: K = Σ WWᵀ + ground.
#[derive(Clone, Debug)]
struct Network {
    nodes: usize,
    /// Ends and W of each spring.
    springs: Vec<((usize, usize), Entries)>,
    /// Stiffness of each unknown against the ground.
    ground: Vec<f64>,
    /// Order of elimination.
    order: Vec<usize>,
}

impl Network {
    fn unknowns(&self) -> usize {
        BLOCK * self.nodes
    }

    fn dense(&self) -> Mat<f64> {
        let mut dense = Mat::zeros(self.unknowns(), self.unknowns());
        for (unknown, stiffness) in self.ground.iter().enumerate() {
            dense[(unknown, unknown)] += stiffness;
        }
        for (_, entries) in &self.springs {
            add(&mut dense, entries, 1.0);
        }
        dense
    }

    /// Full blocks on the diagonal and for each spring.
    fn pattern(&self) -> Pattern {
        let mut pattern = Pattern {
            column_start: vec![0],
            row: Vec::new(),
        };
        for column in 0..self.unknowns() {
            let node = column / BLOCK;
            let joined = |other: usize| {
                let ends = |&((a, b), _): &((usize, usize), Entries)| {
                    (a, b) == (node, other) || (a, b) == (other, node)
                };
                self.springs.iter().any(ends)
            };
            let rows =
                (column..self.unknowns()).filter(|row| row / BLOCK == node || joined(row / BLOCK));
            pattern.row.extend(rows);
            pattern.column_start.push(pattern.row.len());
        }
        pattern
    }

    fn solver(&self, dense: &Mat<f64>) -> (SymmetricSolver, Inertia) {
        let pattern = self.pattern();
        let mut solver = SymmetricSolver::new(&pattern, &self.order).expect("memory");
        let inertia = solver
            .factorise(&pattern, &values(&pattern, dense))
            .expect("a factor");
        (solver, inertia)
    }
}

fn add(dense: &mut Mat<f64>, entries: &Entries, factor: f64) {
    for (i, row) in entries {
        for (j, column) in entries {
            let product: f64 = row.iter().zip(column).map(|(a, b)| a * b).sum();
            dense[(*i, *j)] += factor * product;
        }
    }
}

fn values(pattern: &Pattern, dense: &Mat<f64>) -> Vec<f64> {
    (0..pattern.order())
        .flat_map(|column| {
            let entries = pattern.column_start[column]..pattern.column_start[column + 1];
            entries.map(move |entry| dense[(pattern.row[entry], column)])
        })
        .collect()
}

fn solved<const R: usize>(dense: &Mat<f64>, right: &[[f64; R]]) -> Vec<[f64; R]> {
    let right = Mat::from_fn(right.len(), R, |i, r| right[i][r]);
    let x = dense.partial_piv_lu().solve(&right);
    let rows = 0..right.nrows();
    rows.map(|i| std::array::from_fn(|r| x[(i, r)])).collect()
}

/// Largest difference over largest value.
fn difference<const R: usize>(a: &[[f64; R]], b: &[[f64; R]]) -> f64 {
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    let largest = pairs.clone().map(|(_, b)| b.abs()).fold(0.0, f64::max);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest
}

/// Nodes in a chain, more springs at will, and a node that touches all or none.
fn graphs() -> impl Strategy<Value = (usize, Vec<(usize, usize)>)> {
    (2_usize..14, any::<bool>()).prop_flat_map(|(nodes, hub)| {
        let chain = (1..nodes).map(|node| (node - 1, node));
        let spokes = (2..nodes).filter(move |_| hub).map(|node| (0, node));
        let certain: Vec<_> = chain.chain(spokes).collect();
        prop::collection::vec((0..nodes, 0..nodes), 0..2 * nodes).prop_map(move |more| {
            let mut ends = certain.clone();
            ends.extend(more.into_iter().filter(|(a, b)| a != b));
            (nodes, ends)
        })
    })
}

fn networks() -> impl Strategy<Value = Network> {
    graphs().prop_flat_map(|(nodes, ends)| {
        let numbers = prop::collection::vec(prop::array::uniform3(-1.0..1.0), 6 * ends.len());
        let ground = prop::collection::vec(0.1..1.0, BLOCK * nodes);
        let any_order = Just((0..BLOCK * nodes).collect::<Vec<_>>()).prop_shuffle();
        (numbers, ground, any_order, any::<bool>()).prop_map(
            move |(numbers, ground, any_order, by_degree)| {
                let springs = ends.iter().zip(numbers.chunks(6));
                let mut network = Network {
                    nodes,
                    springs: springs
                        .map(|(&(a, b), w)| ((a, b), spring(a, b, w)))
                        .collect(),
                    ground,
                    order: any_order,
                };
                if by_degree {
                    network.order = minimum_degree(&network.pattern()).expect("memory");
                }
                network
            },
        )
    })
}

fn spring(a: usize, b: usize, rows: &[[f64; 3]]) -> Entries {
    let unknowns = (0..BLOCK).map(|i| BLOCK * a + i);
    let unknowns = unknowns.chain((0..BLOCK).map(|i| BLOCK * b + i));
    unknowns.zip(rows.iter().copied()).collect()
}

/// W as a right-hand side.
fn full(entries: &Entries, unknowns: usize) -> Vec<[f64; 3]> {
    let mut full = vec![[0.0; 3]; unknowns];
    for (unknown, values) in entries {
        full[*unknown] = *values;
    }
    full
}

fn is_positive_definite(inertia: Inertia) -> bool {
    (inertia.negative, inertia.held) == (0, 0)
}

proptest! {
    #[test]
    fn solutions_are_those_of_dense_elimination(network in networks()) {
        let dense = network.dense();
        let (mut solver, inertia) = network.solver(&dense);
        prop_assert!(is_positive_definite(inertia));
        let right: Vec<[f64; 2]> = (0..network.unknowns())
            .map(|i| [1.0 + i as f64, 1.0 / (1.0 + i as f64)])
            .collect();
        let expected = solved(&dense, &right);
        let mut both = right.clone();
        solver.solve_many(&mut both);
        prop_assert!(difference(&both, &expected) < 1e-10);
        let mut first: Vec<f64> = right.iter().map(|r| r[0]).collect();
        solver.solve(&mut first);
        prop_assert!(first.iter().zip(&both).all(|(a, b)| *a == b[0]), "one is solved as two are");
    }

    #[test]
    fn few_entries_are_solved_and_measured_along_their_paths(network in networks(), pick in any::<prop::sample::Index>()) {
        let dense = network.dense();
        let (mut solver, _) = network.solver(&dense);
        let (_, entries) = pick.get(&network.springs);
        let right = full(entries, network.unknowns());
        let expected = solved(&dense, &right);
        for _again in 0..2 {
            let mut x = vec![[f64::NAN; 3]; network.unknowns()];
            solver.solve_sparse(entries, &mut x);
            prop_assert!(difference(&x, &expected) < 1e-10);
            let flexibility = solver.flexibility(entries);
            for r in 0..3 {
                for s in 0..3 {
                    let wanted: f64 = right.iter().zip(&expected).map(|(w, x)| w[r] * x[s]).sum();
                    prop_assert!((flexibility[r][s] - wanted).abs() < 1e-10);
                }
            }
        }
    }

    #[test]
    fn removing_springs_one_after_the_other_gives_the_factor_of_what_is_left(network in networks()) {
        let mut dense = network.dense();
        let (mut solver, _) = network.solver(&dense);
        let right: Vec<[f64; 1]> = (0..network.unknowns()).map(|i| [1.0 + i as f64]).collect();
        for (_, entries) in network.springs.iter().take(5) {
            solver.remove(entries).expect("the ground still holds");
            add(&mut dense, entries, -1.0);
            let mut x = right.clone();
            solver.solve_many(&mut x);
            prop_assert!(difference(&x, &solved(&dense, &right)) < 1e-9);
        }
        for (_, entries) in network.springs.iter().take(5) {
            solver.add(entries).expect("stiffer");
            add(&mut dense, entries, 1.0);
        }
        let mut x = right.clone();
        solver.solve_many(&mut x);
        prop_assert!(difference(&x, &solved(&dense, &right)) < 1e-9);
    }

    #[test]
    fn signs_of_pivots_are_signs_of_eigenvalues(network in networks(), shift in 0.0..2.0) {
        let mut dense = network.dense();
        for unknown in 0..network.unknowns() {
            dense[(unknown, unknown)] -= shift;
        }
        let eigenvalues = dense.self_adjoint_eigenvalues(faer::Side::Lower).expect("eigenvalues");
        prop_assume!(eigenvalues.iter().all(|value| value.abs() > 1e-6));
        let (mut solver, inertia) = network.solver(&dense);
        prop_assert_eq!(inertia.positive, eigenvalues.iter().filter(|&&value| value > 0.0).count());
        prop_assert_eq!(inertia.negative, eigenvalues.iter().filter(|&&value| value < 0.0).count());
        prop_assert_eq!(inertia.held, 0);
        prop_assert_eq!(solver.inertia(), inertia);
        let right = vec![[1.0]; network.unknowns()];
        let mut x = right.clone();
        solver.solve_many(&mut x);
        prop_assert!(difference(&x, &solved(&dense, &right)) < 1e-6);
    }
}

/// A chain of nodes that pull at each other in all three unknowns, the first held by the ground.
fn chain(nodes: usize, ground: f64) -> Network {
    let rows: Vec<[f64; 3]> = (0..6)
        .map(|i| std::array::from_fn(|r| f64::from(i % 3 == r) * if i < 3 { 1.0 } else { -1.0 }))
        .collect();
    let mut network = Network {
        nodes,
        springs: (1..nodes)
            .map(|b| ((b - 1, b), spring(b - 1, b, &rows)))
            .collect(),
        ground: vec![0.0; BLOCK * nodes],
        order: (0..BLOCK * nodes).collect(),
    };
    network.ground[..BLOCK].fill(ground);
    network
}

#[test]
fn a_chain_without_ground_has_three_floppy_modes() {
    let network = chain(7, 0.0);
    let (mut solver, inertia) = network.solver(&network.dense());
    // Three rigid motions; every other eigenvalue 2 − 2 cos(πk/7), k = 1 … 6, is positive, three times each.
    let expected = Inertia {
        positive: 18,
        negative: 0,
        held: 3,
    };
    assert_eq!(inertia, expected);
    assert!(solver.remove(&network.springs[0].1).is_err());
}

#[test]
fn a_spring_whose_removal_frees_a_node_has_flexibility_one_and_is_not_removed() {
    let network = chain(5, 1.0);
    let (mut solver, _) = network.solver(&network.dense());
    let last = &network.springs[3].1;
    let flexibility = solver.flexibility(last);
    for (r, row) in flexibility.iter().enumerate() {
        for (s, value) in row.iter().enumerate() {
            assert!((value - f64::from(r == s)).abs() < 1e-14);
        }
    }
    let refused: Result<(), Singular> = solver.remove(last);
    assert!(refused.is_err());
    let mut x = vec![1.0; network.unknowns()];
    solver.solve(&mut x);
    assert!(x.iter().all(|x| x.is_nan()), "there is no factor any more");
    let pattern = network.pattern();
    let again = solver.factorise(&pattern, &values(&pattern, &network.dense()));
    assert!(is_positive_definite(again.expect("a factor")));
    let mut x = vec![0.0; network.unknowns()];
    x[12] = 1.0;
    solver.solve(&mut x);
    // A unit force at the end of five equal springs in a row.
    assert!((x[12] - 5.0).abs() < 1e-13);
}

#[test]
fn no_unknowns_are_no_problem() {
    let pattern = Pattern {
        column_start: vec![0],
        row: Vec::new(),
    };
    let mut solver = SymmetricSolver::new(&pattern, &[]).expect("memory");
    assert_eq!(
        solver.factorise(&pattern, &[]).expect("a factor"),
        Inertia::default()
    );
    solver.solve(&mut []);
    assert_eq!(solver.flexibility::<2>(&[]), [[0.0; 2]; 2]);
}

#[test]
fn the_factor_of_a_neighbouring_matrix_solves_after_corrections() {
    let network = chain(6, 1.0);
    let dense = network.dense();
    // 1 % stiffer throughout: each correction leaves 1 − 1/1.01 of what there was.
    let (mut solver, _) = network.solver(&(&dense * 1.01));
    let right: Vec<f64> = (0..network.unknowns()).map(|i| 1.0 + i as f64).collect();
    let mut x = right.clone();
    let left = solver.solve_corrected(&mut x, |x, product| {
        for (i, product) in product.iter_mut().enumerate() {
            *product = x.iter().enumerate().map(|(j, x)| dense[(i, j)] * x).sum();
        }
    });
    let expected = (1.0 - 1.0 / 1.01_f64).powi(3);
    assert!((left / expected - 1.0).abs() < 1e-6, "{left}");
}
