//! What a factorisation in a given order costs.

use super::graph::{Graph, NONE};
use super::postorder::{elimination_tree, postorder};

/// Size of a factor and work to make it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Entries of the factor, diagonal included.
    pub entries: f64,
    /// Sum of the squared numbers of entries of its columns: the multiplications and additions of the factorisation.
    pub operations: f64,
}

/// Cost of the factor when the nodes are eliminated in an order, each with as many unknowns as its weight.
///
/// The entries of the columns are counted without the factor: Gilbert, J. R., Ng, E. G. & Peyton, B. W. (1994). An
/// efficient algorithm to compute row and column counts for sparse Cholesky factorization. *SIAM J. Matrix Anal.
/// Appl.* 15, 1075–1091, figure 3, here with weights.
pub fn cost(graph: &Graph, order: &[u32], weights: &[u8]) -> Cost {
    let graph = graph.induced(order);
    let weight: Vec<i32> = order
        .iter()
        .map(|&node| i32::from(weights[node as usize]))
        .collect();
    let count = counts(&graph, &elimination_tree(&graph), &weight);
    let mut cost = Cost::default();
    for (&rows, &own) in count.iter().zip(&weight) {
        for unknown in 0..own {
            let column = f64::from(rows - unknown);
            cost.entries += column;
            cost.operations += column * column;
        }
    }
    cost
}

/// Per node, the weight of the rows in the column of the factor, the diagonal included.
fn counts(graph: &Graph, parent: &[u32], weight: &[i32]) -> Vec<i32> {
    let post = postorder(parent);
    let first = first_descendants(parent, &post);
    let mut count = weight.to_vec();
    for &above in parent.iter().filter(|&&above| above != NONE) {
        count[above as usize] = 0;
    }
    let mut rows = RowSubtrees::new(parent.len());
    for &node in &post {
        for &row in graph.neighbours(node).iter().filter(|&&row| row > node) {
            if let Some(meeting) = rows.leaf(row, node, &first) {
                count[node as usize] += weight[row as usize];
                if meeting != NONE {
                    count[meeting as usize] -= weight[row as usize];
                }
            }
        }
        let above = parent[node as usize];
        if above != NONE {
            // The subtree of this row ends here.
            count[above as usize] -= weight[node as usize];
            rows.ancestor[node as usize] = above;
        }
    }
    for node in 0..parent.len() {
        if parent[node] != NONE {
            count[parent[node] as usize] += count[node];
        }
    }
    count
}

/// Place in postorder of the first descendant of each node.
fn first_descendants(parent: &[u32], post: &[u32]) -> Vec<u32> {
    let mut first = vec![NONE; parent.len()];
    for (number, &node) in post.iter().enumerate() {
        let mut above = node;
        while above != NONE && first[above as usize] == NONE {
            first[above as usize] = number as u32;
            above = parent[above as usize];
        }
    }
    first
}

/// The rows of the factor are subtrees of the elimination tree; these are their leaves found so far.
struct RowSubtrees {
    ancestor: Vec<u32>,
    /// Largest first descendant seen in each row, plus one.
    seen: Vec<u32>,
    last_leaf: Vec<u32>,
}

impl RowSubtrees {
    fn new(nodes: usize) -> Self {
        Self {
            ancestor: (0..nodes as u32).collect(),
            seen: vec![0; nodes],
            last_leaf: vec![NONE; nodes],
        }
    }

    /// If a column is a leaf of a row's subtree: where its path meets that of the leaf before it, if there is one.
    fn leaf(&mut self, row: u32, column: u32, first: &[u32]) -> Option<u32> {
        let start = first[column as usize] + 1;
        if start <= self.seen[row as usize] {
            return None;
        }
        self.seen[row as usize] = start;
        let before = std::mem::replace(&mut self.last_leaf[row as usize], column);
        Some(if before == NONE {
            NONE
        } else {
            self.root(before)
        })
    }

    fn root(&mut self, node: u32) -> u32 {
        let mut root = node;
        while self.ancestor[root as usize] != root {
            root = self.ancestor[root as usize];
        }
        let mut below = node;
        while below != root {
            below = std::mem::replace(&mut self.ancestor[below as usize], root);
        }
        root
    }
}
