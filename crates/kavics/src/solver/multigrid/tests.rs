use proptest::prelude::*;

use super::*;
use crate::solver::block::{Block, block_product, transposed};
use crate::solver::block_matrix::BlockMatrix;
use crate::solver::{BlockSystem, Iterated, IterativeSolver};

/// Normal, shear and rotational stiffness of a spring.
const STIFFNESS: [f64; 3] = [1.0, 0.4, 1.0 / 12.0];

/// A square lattice of nodes tied to their neighbours, along one diagonal too; the lowest row is held.
struct Lattice {
    side: usize,
}

impl Lattice {
    fn place(&self, node: usize) -> [f64; 2] {
        [(node % self.side) as f64, (node / self.side) as f64]
    }

    fn is_held(&self, node: usize) -> bool {
        node < self.side
    }

    fn neighbours(&self, node: usize) -> impl Iterator<Item = usize> {
        let [x, y] = self.place(node);
        let side = self.side;
        (0..side * side).filter(move |&other| {
            let (a, b) = ((other % side) as f64 - x, (other / side) as f64 - y);
            (a.abs() + b.abs() == 1.0) || (a == b && a.abs() == 1.0)
        })
    }

    /// From displacements of a node to those at the spring's middle: its contact map.
    fn map(&self, node: usize, other: usize) -> Block<f64, 3> {
        let ([x, y], [a, b]) = (self.place(node), self.place(other));
        let (dx, dy) = (a - x, b - y);
        let length = dx.hypot(dy);
        let n = [dx / length, dy / length];
        // Rows: along the spring, across it, rotation.
        [
            [n[0], -n[1], 0.0],
            [n[1], n[0], 0.0],
            [0.0, 0.5 * length, 1.0],
        ]
    }

    fn stiffness(&self, node: usize, other: usize) -> [Block<f64, 3>; 2] {
        let (here, mut there) = (self.map(node, other), self.map(other, node));
        // Seen from the other end the spring points back.
        for column in &mut there {
            column[0] = -column[0];
            column[1] = -column[1];
        }
        let weighted = |map: Block<f64, 3>| {
            map.map(|column| std::array::from_fn(|row| STIFFNESS[row] * column[row]))
        };
        let own = block_product(&transposed(&here), &weighted(here));
        let tie = block_product(&transposed(&here), &weighted(there));
        [own, tie.map(|column| column.map(|value| -value))]
    }

    fn system(&self) -> BlockSystem<3> {
        let nodes = self.side * self.side;
        let whole = BlockMatrix::from_rows(nodes, nodes, |node, sum| {
            let unit =
                std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
            if self.is_held(node) {
                *sum.entry(node as u32) = unit;
                return;
            }
            for other in self.neighbours(node) {
                let [own, tie] = self.stiffness(node, other);
                sum.add(node as u32, &own, &unit);
                if !self.is_held(other) {
                    sum.add(other as u32, &tie, &unit);
                }
            }
        });
        let (diagonal, ties) = whole.split();
        BlockSystem { diagonal, ties }
    }

    fn modes(&self) -> Modes<3> {
        let nodes = 0..self.side * self.side;
        nodes
            .map(|node| {
                let [x, y] = self.place(node);
                let modes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-y, x, 1.0]];
                if self.is_held(node) {
                    [[0.0; 3]; 3]
                } else {
                    modes
                }
            })
            .collect()
    }

    fn multigrid(&self) -> Multigrid<3> {
        let system = self.system();
        let (matrix, scaling) = ScaledMatrix::new(&system.diagonal, system.ties).unwrap();
        let modes = self.modes().into_iter().zip(&scaling.lower);
        let modes = modes.map(|(mode, lower)| block_product(&transposed(lower), &mode));
        Multigrid::new(&matrix, &modes.collect(), 2.0).unwrap()
    }

    fn iterations(&self) -> usize {
        let nodes = self.side * self.side;
        let units = vec![[1.0; 3]; nodes];
        let mut solver = IterativeSolver::new(self.system(), &self.modes(), &units).unwrap();
        let mut right = vec![[0.0; 3]; nodes];
        for load in &mut right[nodes - self.side..] {
            *load = [0.3, -1.0, 0.1];
        }
        let solution = solver.solve(&right, 1e-10);
        assert_eq!(solution.end, Iterated::Converged);
        solver.iterations()
    }
}

fn values(seed: u64, nodes: usize) -> Vec<[f32; 3]> {
    let mut state = seed;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 40) as f32 / (1u64 << 24) as f32 - 0.5
    };
    (0..nodes).map(|_| [next(), next(), next()]).collect()
}

fn dot(a: &[[f32; 3]], b: &[[f32; 3]]) -> f64 {
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    pairs.map(|(&a, &b)| f64::from(a) * f64::from(b)).sum()
}

#[test]
fn a_rigid_motion_needs_no_force_away_from_the_held_row() {
    let lattice = Lattice { side: 6 };
    let system = lattice.system();
    let modes = Lattice { side: 6 }.modes();
    for node in 2 * lattice.side..lattice.side * lattice.side {
        let mut force = block_product(&system.diagonal[node], &modes[node]);
        let (columns, blocks) = system.ties.row(node);
        for (&column, block) in columns.iter().zip(blocks) {
            let part = block_product(block, &modes[column as usize]);
            for (force, part) in force.as_flattened_mut().iter_mut().zip(part.as_flattened()) {
                *force += part;
            }
        }
        assert!(force.as_flattened().iter().all(|f| f.abs() < 1e-13));
    }
}

/// A method whose cost grows no faster than the system.
#[test]
fn iterations_hardly_grow_with_the_lattice() {
    let counts = [30, 90].map(|side| Lattice { side }.iterations());
    assert!(counts[1] as f64 <= 1.5 * counts[0] as f64, "{counts:?}");
    assert!(counts[1] <= 30, "{counts:?}");
}

#[test]
fn one_node_and_none_are_solved() {
    for nodes in 0..2 {
        let system = BlockSystem {
            diagonal: vec![[[2.0, 0.0], [0.0, 4.0]]; nodes],
            ties: BlockMatrix::from_rows(nodes, nodes, |_, _| {}),
        };
        let modes = vec![[[1.0, 0.0], [0.0, 1.0]]; nodes];
        let mut solver = IterativeSolver::new(system, &modes, &vec![[1.0; 2]; nodes]).unwrap();
        let solution = solver.solve(&vec![[1.0, 1.0]; nodes], 1e-14);
        assert_eq!(solution.end, Iterated::Converged);
        let exact = |x: &[f64; 2]| (x[0] - 0.5).abs() < 1e-15 && (x[1] - 0.25).abs() < 1e-15;
        assert!(solution.x.iter().all(exact));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]

    /// xᵀ·M·y = yᵀ·M·x and xᵀ·M·x > 0, to the rounding of single precision.
    #[test]
    fn the_cycle_is_symmetric_and_positive(seed in 0_u64..1_000_000, side in 12_usize..40) {
        let lattice = Lattice { side };
        let mut multigrid = lattice.multigrid();
        let [x, y] = [seed, seed + 1].map(|seed| values(seed, side * side));
        let mx = multigrid.apply(|right| right.copy_from_slice(&x)).to_vec();
        let my = multigrid.apply(|right| right.copy_from_slice(&y)).to_vec();
        let scale = (dot(&x, &mx) * dot(&y, &my)).sqrt();
        prop_assert!(dot(&x, &mx) > 0.0);
        prop_assert!((dot(&x, &my) - dot(&y, &mx)).abs() < 1e-4 * scale);
    }
}
