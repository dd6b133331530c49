//! Order of a small part by exact minimum degree.

use super::part::Part;

/// Order of the nodes of a part, in the numbers of the whole graph: always the node next that has the fewest
/// neighbours in the elimination graph, those around the part counted.
///
/// Rose, D. J. (1972). A graph-theoretic study of the numerical solution of sparse positive definite systems of linear
/// equations. In *Graph Theory and Computing* (ed. Read, R. C.), 183–217. Academic Press.
pub(super) fn order_leaf(part: &Part, out: &mut [u32]) {
    let mut elimination = Elimination::new(part);
    for place in out {
        *place = part.original[elimination.eliminate_next()];
    }
}

/// The elimination graph as rows of bits.
struct Elimination {
    nodes: usize,
    /// 64-bit words of a row.
    words: usize,
    bits: Vec<u64>,
    /// Number of neighbours; of nodes eliminated, the largest number.
    degree: Vec<u32>,
    pivot: Vec<u64>,
}

impl Elimination {
    fn new(part: &Part) -> Self {
        let nodes = part.nodes();
        let words = part.original.len().div_ceil(64);
        let mut bits = vec![0; nodes * words];
        for node in 0..nodes {
            for &neighbour in part.graph.neighbours(node as u32) {
                bits[node * words + neighbour as usize / 64] |= 1 << (neighbour % 64);
            }
        }
        Self {
            nodes,
            words,
            bits,
            degree: (0..nodes as u32)
                .map(|node| part.graph.degree(node) as u32)
                .collect(),
            pivot: vec![0; words],
        }
    }

    fn eliminate_next(&mut self) -> usize {
        let next = (0..self.nodes)
            .min_by_key(|&node| self.degree[node])
            .unwrap_or(0);
        self.degree[next] = u32::MAX;
        self.pivot
            .copy_from_slice(&self.bits[next * self.words..][..self.words]);
        for word in 0..self.nodes.div_ceil(64) {
            let mut rest = self.pivot[word];
            while rest != 0 {
                let node = 64 * word + rest.trailing_zeros() as usize;
                rest &= rest - 1;
                if node < self.nodes {
                    self.join_neighbours(node, next);
                }
            }
        }
        next
    }

    /// The neighbours of the eliminated node become those of one of them.
    fn join_neighbours(&mut self, node: usize, eliminated: usize) {
        let row = &mut self.bits[node * self.words..][..self.words];
        for (word, pivot) in row.iter_mut().zip(&self.pivot) {
            *word |= pivot;
        }
        row[node / 64] &= !(1 << (node % 64));
        row[eliminated / 64] &= !(1 << (eliminated % 64));
        self.degree[node] = row.iter().map(|word| word.count_ones()).sum();
    }
}
