//! The fewest nodes that separate two sides of a graph, as a maximum flow.
//!
//! Menger: they are as many as there are paths from one side to the other that share no node. The paths are found depth
//! first, in phases in each of which a node is visited once, as Pothen, A. & Fan, C.-J. (1990). Computing the block
//! triangular form of a sparse matrix. *ACM Trans. Math. Softw.* 16, 303–324, do for matchings.

use super::graph::{Graph, NONE};

/// On which side of a cut a node is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// On the first side.
    First,
    /// In between: may become part of the separator.
    Middle,
    /// On the second side.
    Second,
}

/// The middle of a graph that is to be cut.
#[derive(Debug)]
pub(super) struct Middle {
    /// Neighbours in the middle of each node; numbers rise from the first side to the second.
    pub graph: Graph,
    /// Whether a node is beside the first side, the second.
    pub beside: Vec<[bool; 2]>,
}

/// What comes before a path's first node.
const FIRST_SIDE: u32 = NONE - 1;

/// Where a search stands: before or behind a node. Passing from before to behind takes the node.
#[derive(Clone, Copy)]
struct Stop(u32);

impl Stop {
    fn before(node: u32) -> Self {
        Self(2 * node)
    }

    fn behind(node: u32) -> Self {
        Self(2 * node + 1)
    }

    fn node(self) -> u32 {
        self.0 / 2
    }

    fn is_behind(self) -> bool {
        self.0 % 2 == 1
    }

    fn index(self) -> usize {
        self.0 as usize
    }
}

/// Paths from the first side to the second that share no node.
pub(super) struct Flow<'a> {
    middle: &'a Middle,
    /// Node before each on its path.
    previous: Vec<u32>,
    /// Node after each on its path; `NONE` for the last.
    next: Vec<u32>,
    /// Phase in which each stop was last visited.
    visited: Vec<u32>,
    phase: u32,
    /// Number of neighbours tried at the stops of the present search.
    tried: Vec<u32>,
    path: Vec<Stop>,
    paths: usize,
}

impl<'a> Flow<'a> {
    /// As many paths as there are. None where they are more than `most`.
    pub(super) fn new(middle: &'a Middle, most: usize) -> Option<Self> {
        let nodes = middle.graph.nodes();
        let mut flow = Self {
            middle,
            previous: vec![NONE; nodes],
            next: vec![NONE; nodes],
            visited: vec![0; 2 * nodes],
            phase: 0,
            tried: Vec::new(),
            path: Vec::new(),
            paths: 0,
        };
        while flow.add_paths() {
            if flow.paths > most {
                return None;
            }
        }
        Some(flow)
    }

    /// Number of paths, and so of nodes of a smallest separator.
    pub(super) fn paths(&self) -> usize {
        self.paths
    }

    /// A phase: a search from every node beside the first side. Whether any found a path.
    fn add_paths(&mut self) -> bool {
        self.phase += 1;
        let before = self.paths;
        for node in 0..self.middle.graph.nodes() as u32 {
            if self.middle.beside[node as usize][0] && self.search(node) {
                self.take_path();
            }
        }
        self.paths > before
    }

    /// Depth first to the second side.
    fn search(&mut self, entry: u32) -> bool {
        self.path.clear();
        self.tried.clear();
        self.visit(Stop::before(entry));
        while let Some(&stop) = self.path.last() {
            if stop.is_behind() && self.middle.beside[stop.node() as usize][1] {
                return true;
            }
            if let Some(next) = self.further(stop) {
                self.visit(next);
            } else {
                self.path.pop();
                self.tried.pop();
            }
        }
        false
    }

    fn visit(&mut self, stop: Stop) {
        let visited = &mut self.visited[stop.index()];
        if *visited != self.phase {
            *visited = self.phase;
            self.path.push(stop);
            self.tried.push(0);
        }
    }

    /// The next stop that a search can go to from its last and has not been at.
    fn further(&mut self, stop: Stop) -> Option<Stop> {
        let is_new = |next: &Stop| self.visited[next.index()] != self.phase;
        let neighbours = if stop.is_behind() {
            self.middle.graph.neighbours(stop.node())
        } else {
            &[]
        };
        let tried = self.tried.last_mut()?;
        while let Some(&neighbour) =
            neighbours.get(neighbours.len().wrapping_sub(1 + *tried as usize))
        {
            *tried += 1;
            if is_new(&Stop::before(neighbour)) {
                return Some(Stop::before(neighbour));
            }
        }
        self.through(stop).filter(is_new)
    }

    /// Where a stop leads other than to its node's neighbours: through the node, or back along the path that takes it.
    fn through(&self, stop: Stop) -> Option<Stop> {
        let node = stop.node();
        match (stop.is_behind(), self.previous[node as usize]) {
            (false, NONE) => Some(Stop::behind(node)),
            (true, NONE) | (false, FIRST_SIDE) => None,
            (true, _) => Some(Stop::before(node)),
            (false, previous) => Some(Stop::behind(previous)),
        }
    }

    /// Makes the search's path part of the flow; what it goes back along leaves the flow.
    fn take_path(&mut self) {
        for step in self.path.windows(2) {
            let (from, to) = (step[0], step[1]);
            if !from.is_behind() && to.node() != from.node() {
                self.previous[from.node() as usize] = NONE;
                self.next[to.node() as usize] = NONE;
            }
        }
        self.previous[self.path[0].node() as usize] = FIRST_SIDE;
        for step in self.path.windows(2) {
            let (from, to) = (step[0], step[1]);
            if from.is_behind() && to.node() != from.node() {
                self.next[from.node() as usize] = to.node();
                self.previous[to.node() as usize] = from.node();
            }
        }
        self.paths += 1;
    }

    /// The smallest separator next to the first side: the side of every node, the separator being what stays in the
    /// middle.
    pub(super) fn cut_near_first(&self) -> Vec<Side> {
        // The last phase has found no path and so visited all that the first side leads to.
        let reached = |stop: Stop| self.visited[stop.index()] == self.phase;
        let nodes = 0..self.middle.graph.nodes() as u32;
        nodes
            .map(
                |node| match (reached(Stop::before(node)), reached(Stop::behind(node))) {
                    (_, true) => Side::First,
                    (true, false) => Side::Middle,
                    (false, false) => Side::Second,
                },
            )
            .collect()
    }

    /// The smallest separator next to the second side.
    pub(super) fn cut_near_second(&self) -> Vec<Side> {
        let leads = self.leads_to_second();
        let nodes = 0..self.middle.graph.nodes() as u32;
        nodes
            .map(|node| {
                match (
                    leads[Stop::before(node).index()],
                    leads[Stop::behind(node).index()],
                ) {
                    (true, _) => Side::Second,
                    (false, true) => Side::Middle,
                    (false, false) => Side::First,
                }
            })
            .collect()
    }

    /// Which stops lead to the second side.
    fn leads_to_second(&self) -> Vec<bool> {
        let mut leads = vec![false; self.visited.len()];
        let mut open = Vec::new();
        let mut mark = |stop: Stop, open: &mut Vec<Stop>| {
            if !std::mem::replace(&mut leads[stop.index()], true) {
                open.push(stop);
            }
        };
        for node in 0..self.middle.graph.nodes() as u32 {
            if self.middle.beside[node as usize][1] {
                mark(Stop::behind(node), &mut open);
            }
        }
        while let Some(stop) = open.pop() {
            let node = stop.node();
            let is_free = self.previous[node as usize] == NONE;
            if !stop.is_behind() {
                for &neighbour in self.middle.graph.neighbours(node) {
                    mark(Stop::behind(neighbour), &mut open);
                }
                if !is_free {
                    mark(Stop::behind(node), &mut open);
                }
            } else if is_free {
                mark(Stop::before(node), &mut open);
            } else if self.next[node as usize] != NONE {
                mark(Stop::before(self.next[node as usize]), &mut open);
            }
        }
        leads
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn middles() -> impl Strategy<Value = Middle> {
        (1_u32..25).prop_flat_map(|nodes| {
            let edges = prop::collection::vec([0..nodes, 0..nodes], 0..60);
            let beside = prop::collection::vec(any::<[bool; 2]>(), nodes as usize);
            (edges, beside).prop_map(move |(edges, beside)| Middle {
                graph: Graph::from_edges(nodes as usize, edges.into_iter()),
                beside,
            })
        })
    }

    /// Number of paths from one side to the other that share no node, by following each.
    fn followed(flow: &Flow) -> usize {
        let mut taken = vec![false; flow.previous.len()];
        let starts = (0..taken.len()).filter(|&node| flow.previous[node] == FIRST_SIDE);
        let mut count = 0;
        for start in starts {
            assert!(flow.middle.beside[start][0]);
            let mut node = start as u32;
            loop {
                assert!(!std::mem::replace(&mut taken[node as usize], true));
                let next = flow.next[node as usize];
                if next == NONE {
                    break;
                }
                assert!(flow.middle.graph.neighbours(node).contains(&next));
                node = next;
            }
            assert!(flow.middle.beside[node as usize][1]);
            count += 1;
        }
        count
    }

    proptest! {
        /// By Menger the separator is then the smallest there is, and the paths are as many as there can be.
        #[test]
        fn a_separator_separates_and_has_a_node_for_every_path(middle in middles()) {
            let flow = Flow::new(&middle, usize::MAX).expect("any number of paths");
            prop_assert_eq!(flow.paths(), followed(&flow));
            for sides in [flow.cut_near_first(), flow.cut_near_second()] {
                let separator = sides.iter().filter(|&&side| side == Side::Middle).count();
                prop_assert_eq!(separator, flow.paths());
                for node in 0..sides.len() as u32 {
                    let side = sides[node as usize];
                    let [beside_first, beside_second] = middle.beside[node as usize];
                    prop_assert!(side != Side::First || !beside_second);
                    prop_assert!(side != Side::Second || !beside_first);
                    let neighbours = middle.graph.neighbours(node).iter();
                    let across = |&other: &u32| (side, sides[other as usize]) == (Side::First, Side::Second);
                    prop_assert!(!neighbours.copied().any(|other| across(&other)));
                }
            }
        }
    }
}
