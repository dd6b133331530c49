//! Part of a graph, and what it is beside.

use super::flow::Side;
use super::graph::{Graph, NONE};

/// Part of a graph: its nodes, and around them nodes that are eliminated later.
pub(super) struct Part {
    /// Neighbours of the nodes of the part. Numbers from the number of nodes on are nodes around it.
    pub graph: Graph,
    /// Number in the whole graph, of the nodes of the part first.
    pub original: Vec<u32>,
    /// Where the nodes of the part are.
    pub position: Vec<[f64; 2]>,
}

impl Part {
    /// Number of nodes.
    pub(super) fn nodes(&self) -> usize {
        self.graph.nodes()
    }

    /// The graph of its nodes alone.
    pub(super) fn inner_graph(&self) -> Graph {
        let nodes: Vec<u32> = (0..self.nodes() as u32).collect();
        self.graph.induced(&nodes)
    }

    /// The part of the given nodes, in their order; `number` maps the nodes of this part and those around to `NONE`.
    pub(super) fn of(&self, nodes: &[u32], number: &mut [u32]) -> Self {
        for (new, &node) in nodes.iter().enumerate() {
            number[node as usize] = new as u32;
        }
        let mut around = Vec::new();
        let mut start = Vec::with_capacity(nodes.len() + 1);
        let entries = nodes.iter().map(|&node| self.graph.degree(node)).sum();
        let mut neighbour = Vec::with_capacity(entries);
        start.push(0);
        for &node in nodes {
            for &old in self.graph.neighbours(node) {
                let new = &mut number[old as usize];
                if *new == NONE {
                    *new = (nodes.len() + around.len()) as u32;
                    around.push(old);
                }
                neighbour.push(*new);
            }
            start.push(neighbour.len() as u32);
        }
        for &node in nodes.iter().chain(&around) {
            number[node as usize] = NONE;
        }
        let all = nodes.iter().chain(&around);
        Self {
            graph: Graph { start, neighbour },
            original: all.map(|&node| self.original[node as usize]).collect(),
            position: nodes
                .iter()
                .map(|&node| self.position[node as usize])
                .collect(),
        }
    }

    /// The two sides of a cut as parts, and the separator in the numbers of the whole graph.
    pub(super) fn divided(&self, side: &[Side]) -> ([Self; 2], Vec<u32>) {
        let on = |wanted: Side| -> Vec<u32> {
            let nodes = 0..self.nodes() as u32;
            nodes
                .filter(|&node| side[node as usize] == wanted)
                .collect()
        };
        let mut number = vec![NONE; self.original.len()];
        let separator = on(Side::Middle);
        let parts = [Side::First, Side::Second].map(|side| self.of(&on(side), &mut number));
        (
            parts,
            separator
                .iter()
                .map(|&node| self.original[node as usize])
                .collect(),
        )
    }
}
