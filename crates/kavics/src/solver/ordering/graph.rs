//! Graphs as lists of neighbours.

use std::ops::Range;

/// No node.
pub(super) const NONE: u32 = u32::MAX;

/// An undirected graph: the neighbours of each node, without the node itself. An edge stands in both of its lists.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Graph {
    /// First neighbour of each node, and the number of neighbours at the end.
    pub start: Vec<u32>,
    /// Neighbours of the nodes, one list after the other.
    pub neighbour: Vec<u32>,
}

impl Graph {
    /// The graph of the given edges; an edge given twice stands once, one from a node to itself not at all.
    pub fn from_edges(nodes: usize, edges: impl Iterator<Item = [u32; 2]> + Clone) -> Self {
        let edges = edges.filter(|[first, second]| first != second);
        let mut end = vec![0; nodes + 1];
        for node in edges.clone().flatten() {
            end[node as usize + 1] += 1;
        }
        for node in 0..nodes {
            end[node + 1] += end[node];
        }
        let mut next = end.clone();
        let mut neighbour = vec![0; end[nodes] as usize];
        for [first, second] in edges {
            for [from, to] in [[first, second], [second, first]] {
                neighbour[next[from as usize] as usize] = to;
                next[from as usize] += 1;
            }
        }
        Self {
            start: end,
            neighbour,
        }
        .without_repeats()
    }

    fn without_repeats(mut self) -> Self {
        let (mut kept, mut from) = (0, 0);
        for node in 0..self.nodes() {
            let to = self.start[node + 1] as usize;
            self.neighbour[from..to].sort_unstable();
            self.start[node] = kept as u32;
            for entry in from..to {
                if entry == from || self.neighbour[entry] != self.neighbour[entry - 1] {
                    self.neighbour[kept] = self.neighbour[entry];
                    kept += 1;
                }
            }
            from = to;
        }
        self.neighbour.truncate(kept);
        if let Some(last) = self.start.last_mut() {
            *last = kept as u32;
        }
        self
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// Neighbours of a node.
    pub fn neighbours(&self, node: u32) -> &[u32] {
        &self.neighbour[self.places(node)]
    }

    /// Number of neighbours of a node.
    pub fn degree(&self, node: u32) -> usize {
        self.places(node).len()
    }

    pub(super) fn places(&self, node: u32) -> Range<usize> {
        let node = node as usize;
        self.start[node] as usize..self.start[node + 1] as usize
    }

    /// The graph of the listed nodes, numbered in their order.
    pub(super) fn induced(&self, nodes: &[u32]) -> Self {
        let most = self.neighbour.iter().max().map_or(0, |&n| n as usize + 1);
        let mut number = vec![NONE; self.nodes().max(most)];
        for (new, &node) in nodes.iter().enumerate() {
            number[node as usize] = new as u32;
        }
        let mut start = vec![0];
        let mut neighbour = Vec::with_capacity(self.neighbour.len());
        for &node in nodes {
            let numbers = self.neighbours(node).iter().map(|&n| number[n as usize]);
            neighbour.extend(numbers.filter(|&n| n != NONE));
            start.push(neighbour.len() as u32);
        }
        Self { start, neighbour }
    }
}
