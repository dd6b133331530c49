//! Aggregates: the nodes of a level gathered into those of the next.

use crate::solver::block_matrix::BlockMatrix;

/// A node with this many times the mean number of neighbours, and this many more, is a hub.
const HUB: [usize; 2] = [4, 16];
/// No aggregate.
const NONE: u32 = u32::MAX;

/// Which aggregate each node belongs to.
pub struct Aggregates {
    /// The aggregate of each node; none for nodes without neighbours.
    pub of: Vec<Option<u32>>,
    /// Number of aggregates.
    pub count: usize,
    /// Nodes of high degree, each an aggregate of its own.
    pub is_hub: Vec<bool>,
}

/// Gathers each node with its neighbours, in the order of the nodes; what is left over joins the neighbour it is tied
/// to most strongly. Vaněk, Mandel & Brezina (1996), algorithm 5.1, on all ties.
pub fn aggregates<const B: usize>(matrix: &BlockMatrix<f64, B>) -> Aggregates {
    let nodes = matrix.rows();
    let hub = HUB[0] * matrix.column.len() / nodes.max(1) + HUB[1];
    let is_hub: Vec<bool> = (0..nodes)
        .map(|node| matrix.row_length(node) > hub)
        .collect();
    let mut gathering = Gathering {
        matrix,
        is_hub: &is_hub,
        of: vec![NONE; nodes],
        count: 0,
    };
    gathering.gather_hubs();
    gathering.gather_neighbourhoods();
    gathering.join_leftovers();
    gathering.gather_leftovers();
    Aggregates {
        of: gathering
            .of
            .iter()
            .map(|&a| (a != NONE).then_some(a))
            .collect(),
        count: gathering.count as usize,
        is_hub,
    }
}

struct Gathering<'a, const B: usize> {
    matrix: &'a BlockMatrix<f64, B>,
    is_hub: &'a [bool],
    of: Vec<u32>,
    count: u32,
}

impl<const B: usize> Gathering<'_, B> {
    fn neighbours(&self, node: usize) -> impl Iterator<Item = usize> + use<'_, B> {
        let columns = self
            .matrix
            .row(node)
            .0
            .iter()
            .map(|&column| column as usize);
        columns.filter(|&other| !self.is_hub[other])
    }

    fn is_free(&self, node: usize) -> bool {
        self.of[node] == NONE
    }

    fn begin(&mut self, node: usize) {
        self.of[node] = self.count;
        for &other in self.matrix.row(node).0 {
            if !self.is_hub[other as usize] && !self.is_hub[node] && self.of[other as usize] == NONE
            {
                self.of[other as usize] = self.count;
            }
        }
        self.count += 1;
    }

    fn gather_hubs(&mut self) {
        for node in 0..self.of.len() {
            if self.is_hub[node] {
                self.begin(node);
            }
        }
    }

    fn gather_neighbourhoods(&mut self) {
        for node in 0..self.of.len() {
            let tied = self.matrix.row_length(node) > 0;
            if tied && self.is_free(node) && self.neighbours(node).all(|other| self.is_free(other))
            {
                self.begin(node);
            }
        }
    }

    fn join_leftovers(&mut self) {
        let gathered = self.of.clone();
        for node in 0..self.of.len() {
            if self.is_free(node) {
                let (columns, blocks) = self.matrix.row(node);
                let mut strongest = (0.0, NONE);
                for (&other, block) in columns.iter().zip(blocks) {
                    let strength: f64 = block.as_flattened().iter().map(|v| v * v).sum();
                    let aggregate = gathered[other as usize];
                    if aggregate != NONE && !self.is_hub[other as usize] && strength > strongest.0 {
                        strongest = (strength, aggregate);
                    }
                }
                self.of[node] = strongest.1;
            }
        }
    }

    fn gather_leftovers(&mut self) {
        for node in 0..self.of.len() {
            if self.is_free(node) && self.matrix.row_length(node) > 0 {
                self.begin(node);
            }
        }
    }
}
