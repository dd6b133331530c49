//! Pieces of a graph: nodes tied together by edges.

/// Sets of nodes, merged edge by edge; the lowest node stands for its piece.
#[derive(Clone, Debug)]
pub struct Pieces {
    parent: Vec<u32>,
}

impl Pieces {
    /// The pieces that the given edges tie together.
    pub fn new(nodes: usize, edges: impl IntoIterator<Item = [u32; 2]>) -> Self {
        let mut pieces = Self {
            parent: (0..nodes as u32).collect(),
        };
        for [one, other] in edges {
            pieces.join(one, other);
        }
        for node in 0..nodes as u32 {
            let root = pieces.root(node);
            pieces.parent[node as usize] = root;
        }
        pieces
    }

    fn join(&mut self, one: u32, other: u32) {
        let (one, other) = (self.root(one), self.root(other));
        self.parent[one.max(other) as usize] = one.min(other);
    }

    fn root(&mut self, mut node: u32) -> u32 {
        while self.parent[node as usize] != node {
            let above = self.parent[self.parent[node as usize] as usize];
            self.parent[node as usize] = above;
            node = above;
        }
        node
    }

    /// The lowest node of a node's piece.
    pub fn of(&self, node: usize) -> usize {
        self.parent[node] as usize
    }

    /// For each node, whether its piece holds a node of which `flag` is true.
    pub fn any(&self, flag: impl Fn(usize) -> bool) -> Vec<bool> {
        let mut found = vec![false; self.parent.len()];
        for node in 0..self.parent.len() {
            if flag(node) {
                found[self.of(node)] = true;
            }
        }
        (0..self.parent.len())
            .map(|node| found[self.of(node)])
            .collect()
    }
}
