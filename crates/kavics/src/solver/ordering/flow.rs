//! The smallest set of nodes that separates two sets of a graph, as a maximum flow.
//!
//! Menger: as many nodes as there are paths from one set to the other that share no node. The paths are found in phases of
//! shortest ones: Dinic, E. A. (1970). Algorithm for solution of a problem of maximum flow in networks with power
//! estimation. *Soviet Math. Dokl.* 11, 1277–1280; Even, S. & Tarjan, R. E. (1975). Network flow and testing graph
//! connectivity. *SIAM J. Comput.* 4, 507–518.

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
    /// Not part of what is cut.
    Outside,
}

/// Neighbour of a path's first node: the first side.
const FROM_FIRST: u32 = NONE - 1;
/// Neighbour of a path's last node: the second side.
const TO_SECOND: u32 = NONE - 1;
const UNREACHED: u32 = u32::MAX;

/// Where a search stands: before or behind a node. Passing from before to behind takes the node.
#[derive(Clone, Copy, PartialEq, Eq)]
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
    graph: &'a Graph,
    side: &'a [Side],
    /// Node before each on its path.
    previous: Vec<u32>,
    /// Node after each on its path.
    next: Vec<u32>,
    /// Steps from the first side to each stop.
    level: Vec<u32>,
    /// First neighbour of each stop that the phase has not tried.
    untried: Vec<u32>,
    queue: Vec<Stop>,
    /// Middle nodes beside the first side.
    entries: Vec<u32>,
    paths: usize,
}

impl<'a> Flow<'a> {
    /// No path yet.
    pub(super) fn new(graph: &'a Graph, side: &'a [Side]) -> Self {
        let nodes = graph.nodes();
        let beside_first = |&node: &u32| {
            side[node as usize] == Side::Middle
                && graph
                    .neighbours(node)
                    .iter()
                    .any(|&n| side[n as usize] == Side::First)
        };
        Self {
            graph,
            side,
            previous: vec![NONE; nodes],
            next: vec![NONE; nodes],
            level: vec![UNREACHED; 2 * nodes],
            untried: vec![0; 2 * nodes],
            queue: Vec::with_capacity(2 * nodes),
            entries: (0..nodes as u32).filter(beside_first).collect(),
            paths: 0,
        }
    }

    /// Finds as many paths as there are. None where there are more than `most`.
    pub(super) fn saturate(mut self, most: usize) -> Option<Self> {
        while self.paths <= most {
            if !self.measure_levels() {
                return Some(self);
            }
            self.add_shortest_paths();
        }
        None
    }

    /// Number of paths, and so of nodes of a smallest separator.
    pub(super) fn paths(&self) -> usize {
        self.paths
    }

    /// Breadth first from the first side; whether the second is reached.
    fn measure_levels(&mut self) -> bool {
        self.level.fill(UNREACHED);
        self.queue.clear();
        for entry in 0..self.entries.len() {
            self.reach(Stop::before(self.entries[entry]), 0);
        }
        let (mut read, mut found) = (0, false);
        while read < self.queue.len() {
            let stop = self.queue[read];
            let level = self.level[stop.index()] + 1;
            read += 1;
            if stop.is_behind() {
                for &neighbour in self.graph.neighbours(stop.node()) {
                    match self.side[neighbour as usize] {
                        Side::Middle => self.reach(Stop::before(neighbour), level),
                        Side::Second => found = true,
                        Side::First | Side::Outside => {}
                    }
                }
            }
            if found {
                return true;
            }
            if let Some(through) = self.through(stop) {
                self.reach(through, level);
            }
        }
        false
    }

    fn reach(&mut self, stop: Stop, level: u32) {
        let known = &mut self.level[stop.index()];
        if *known == UNREACHED {
            *known = level;
            self.queue.push(stop);
        }
    }

    /// Where a stop leads other than to its node's neighbours: through the node, or back along the path that takes it.
    fn through(&self, stop: Stop) -> Option<Stop> {
        let node = stop.node();
        let previous = self.previous[node as usize];
        match (stop.is_behind(), previous) {
            (false, NONE) => Some(Stop::behind(node)),
            (true, NONE) | (false, FROM_FIRST) => None,
            (true, _) => Some(Stop::before(node)),
            (false, previous) => Some(Stop::behind(previous)),
        }
    }

    /// Adds shortest paths, one after the other, until every further one would be longer.
    fn add_shortest_paths(&mut self) {
        self.untried.fill(0);
        let mut path = Vec::new();
        for entry in 0..self.entries.len() {
            let node = self.entries[entry];
            let start = Stop::before(node);
            if self.previous[node as usize] == FROM_FIRST || self.level[start.index()] != 0 {
                continue;
            }
            path.clear();
            path.push(start);
            if self.search(&mut path) {
                self.take(&path);
            }
        }
    }

    /// Depth first along rising levels to the second side. A stop that was left is not entered again in the phase.
    fn search(&mut self, path: &mut Vec<Stop>) -> bool {
        while let Some(&stop) = path.last() {
            let level = self.level[stop.index()];
            let neighbours = if stop.is_behind() {
                self.graph.neighbours(stop.node())
            } else {
                &[]
            };
            let untried = &mut self.untried[stop.index()];
            let mut further = None;
            while (*untried as usize) < neighbours.len() && further.is_none() {
                let neighbour = neighbours[*untried as usize];
                *untried += 1;
                match self.side[neighbour as usize] {
                    Side::Second => return true,
                    Side::Middle => further = Some(Stop::before(neighbour)),
                    Side::First | Side::Outside => {}
                }
                further = further.filter(|next| self.level[next.index()] == level + 1);
            }
            if further.is_none() && self.untried[stop.index()] as usize == neighbours.len() {
                self.untried[stop.index()] += 1;
                further = self
                    .through(stop)
                    .filter(|next| self.level[next.index()] == level + 1);
            }
            match further {
                Some(next) => {
                    path.push(next);
                }
                None => {
                    self.level[stop.index()] = UNREACHED;
                    path.pop();
                }
            }
        }
        false
    }

    /// Makes the path part of the flow; what it goes back along leaves the flow.
    fn take(&mut self, path: &[Stop]) {
        for step in path.windows(2) {
            let (from, to) = (step[0], step[1]);
            if !from.is_behind() && to.node() != from.node() {
                self.previous[from.node() as usize] = NONE;
                self.next[to.node() as usize] = NONE;
            }
        }
        self.previous[path[0].node() as usize] = FROM_FIRST;
        for step in path.windows(2) {
            let (from, to) = (step[0], step[1]);
            if from.is_behind() && to.node() != from.node() {
                self.next[from.node() as usize] = to.node();
                self.previous[to.node() as usize] = from.node();
            }
        }
        if let Some(last) = path.last() {
            self.next[last.node() as usize] = TO_SECOND;
        }
        for stop in path {
            self.level[stop.index()] = UNREACHED;
        }
        self.paths += 1;
    }

    /// The smallest separator next to the first side: sides of all nodes, the separator being what stays in the middle.
    pub(super) fn cut_near_first(&self) -> Vec<Side> {
        self.sides(|node| {
            let before = self.level[Stop::before(node).index()] != UNREACHED;
            let behind = self.level[Stop::behind(node).index()] != UNREACHED;
            match (before, behind) {
                (_, true) => Side::First,
                (true, false) => Side::Middle,
                (false, false) => Side::Second,
            }
        })
    }

    /// The smallest separator next to the second side.
    pub(super) fn cut_near_second(&mut self) -> Vec<Side> {
        self.measure_reverse();
        self.sides(|node| {
            let before = self.level[Stop::before(node).index()] != UNREACHED;
            let behind = self.level[Stop::behind(node).index()] != UNREACHED;
            match (before, behind) {
                (true, _) => Side::Second,
                (false, true) => Side::Middle,
                (false, false) => Side::First,
            }
        })
    }

    fn sides(&self, of_middle: impl Fn(u32) -> Side) -> Vec<Side> {
        let nodes = 0..self.graph.nodes() as u32;
        nodes
            .map(|node| match self.side[node as usize] {
                Side::Middle => of_middle(node),
                outer => outer,
            })
            .collect()
    }

    /// Marks what leads to the second side.
    fn measure_reverse(&mut self) {
        self.level.fill(UNREACHED);
        self.queue.clear();
        for node in 0..self.graph.nodes() as u32 {
            let beside_second = self.side[node as usize] == Side::Middle
                && self
                    .graph
                    .neighbours(node)
                    .iter()
                    .any(|&n| self.side[n as usize] == Side::Second);
            if beside_second {
                self.reach(Stop::behind(node), 0);
            }
        }
        let mut read = 0;
        while read < self.queue.len() {
            let stop = self.queue[read];
            read += 1;
            let node = stop.node();
            let (previous, next) = (self.previous[node as usize], self.next[node as usize]);
            if stop.is_behind() {
                match next {
                    NONE => self.reach(Stop::before(node), 0),
                    TO_SECOND => {}
                    next => self.reach(Stop::before(next), 0),
                }
            } else {
                for &neighbour in self.graph.neighbours(node) {
                    if self.side[neighbour as usize] == Side::Middle {
                        self.reach(Stop::behind(neighbour), 0);
                    }
                }
                if previous != NONE {
                    self.reach(Stop::behind(node), 0);
                }
            }
        }
    }
}
