//! A graph drawn in the plane with straight edges: the edges around each node, and the walk along a face.

use std::ops::Range;

use rayon::prelude::*;

use crate::geometry::Vector;

/// Nodes that one task looks at; fixed, so that the result does not depend on the number of threads.
pub(super) const NODES_A_TASK: usize = 16_384;

/// One of the two directions of an edge, in the star of the node it leaves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HalfEdge {
    /// The node it goes to.
    pub to: u32,
    /// The slot of the way back.
    pub twin: u32,
}

/// The half-edges of a graph, counter-clockwise around each node; a half-edge is known by its slot.
///
/// On the left of each half-edge lies a face. The faces of a planar graph are those of its drawing, and each
/// component has one that lies around it.
#[derive(Clone, Debug, Default)]
pub struct Embedding {
    start: Vec<u32>,
    /// The node each half-edge goes to.
    to: Vec<u32>,
    /// The slot of its way back.
    twin: Vec<u32>,
}

impl Embedding {
    /// The embedding of the graph with nodes at `points` and these edges between different nodes; O(N).
    pub fn new(points: &[Vector], edges: &[[u32; 2]]) -> Self {
        let point = |node: u32| points[node as usize];
        Self::of(points.len(), point, edges.iter().copied())
    }

    /// The same of so many nodes at these points, and edges that come one by one.
    pub(super) fn of(
        nodes: usize,
        point: impl Fn(u32) -> Vector + Sync,
        edges: impl Iterator<Item = [u32; 2]> + Clone,
    ) -> Self {
        let start = starts(nodes, edges.clone());
        let mut to = vec![0; start[nodes] as usize];
        let mut next = start.clone();
        for [i, j] in edges {
            for (from, end) in [(i, j), (j, i)] {
                let place = &mut next[from as usize];
                to[*place as usize] = end;
                *place += 1;
            }
        }
        drop(next);
        sort_stars(&point, &start, &mut to);
        let twin = twins(&start, &to);
        Self { start, to, twin }
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.start.len() - 1
    }

    /// The slot where the star of each node starts, and the number of slots at the end.
    pub(super) fn starts(&self) -> &[u32] {
        &self.start
    }

    /// The slots of the half-edges that leave a node.
    pub fn star(&self, node: u32) -> Range<u32> {
        self.start[node as usize]..self.start[node as usize + 1]
    }

    /// The half-edge in a slot.
    pub fn half_edge(&self, slot: u32) -> HalfEdge {
        HalfEdge {
            to: self.to[slot as usize],
            twin: self.twin[slot as usize],
        }
    }

    /// Number of half-edges.
    pub fn half_edges(&self) -> usize {
        self.to.len()
    }

    /// The slots of an edge, one that leaves its first node and the way back; none where there is no such edge.
    pub fn slots(&self, [first, second]: [u32; 2]) -> Option<[u32; 2]> {
        let slot = self.slot(first, second)?;
        Some([slot, self.twin[slot as usize]])
    }

    /// The first slot from one node to another.
    pub(super) fn slot(&self, from: u32, to: u32) -> Option<u32> {
        self.star(from).find(|&slot| self.to[slot as usize] == to)
    }

    /// The nodes that a node has an edge with.
    pub fn neighbours(&self, node: u32) -> impl Iterator<Item = u32> {
        let star = self.star(node);
        self.to[star.start as usize..star.end as usize]
            .iter()
            .copied()
    }

    /// The next half-edge along the face on the left of one.
    pub fn next(&self, slot: u32) -> u32 {
        let HalfEdge { to, twin } = self.half_edge(slot);
        let star = self.star(to);
        if twin == star.start {
            star.end - 1
        } else {
            twin - 1
        }
    }
}

/// Where the star of each node starts.
fn starts(nodes: usize, edges: impl Iterator<Item = [u32; 2]>) -> Vec<u32> {
    let mut start = vec![0_u32; nodes + 1];
    for node in edges.flatten() {
        start[node as usize + 1] += 1;
    }
    for node in 0..nodes {
        start[node + 1] += start[node];
    }
    start
}

/// Sorts each star by the directions of its half-edges; equal directions by the nodes they go to.
fn sort_stars(point: &(impl Fn(u32) -> Vector + Sync), start: &[u32], to: &mut [u32]) {
    let tasks = by_nodes(start, to);
    tasks.into_par_iter().for_each(|(nodes, mut own)| {
        let mut sorted: Vec<(f64, u32)> = Vec::new();
        for node in nodes {
            let star;
            (star, own) = own.split_at_mut((start[node + 1] - start[node]) as usize);
            let centre = point(node as u32);
            let direction = |&end: &u32| (pseudo_angle(point(end) - centre), end);
            sorted.clear();
            sorted.extend(star.iter().map(direction));
            sort_by_direction(&mut sorted);
            for (end, (_, by_direction)) in star.iter_mut().zip(&sorted) {
                *end = *by_direction;
            }
        }
    });
}

/// Equal directions by the nodes they go to; insertion, as stars are small.
fn sort_by_direction(star: &mut [(f64, u32)]) {
    let after = |a: &(f64, u32), b: &(f64, u32)| a.0 > b.0 || a.0 == b.0 && a.1 > b.1;
    if star.len() > 32 {
        star.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        return;
    }
    for k in 1..star.len() {
        let item = star[k];
        let mut place = k;
        while place > 0 && after(&star[place - 1], &item) {
            star[place] = star[place - 1];
            place -= 1;
        }
        star[place] = item;
    }
}

/// The way back of each half-edge; of several edges between two nodes, the first at one end is the last at the other.
fn twins(start: &[u32], to: &[u32]) -> Vec<u32> {
    let star = |node: u32| start[node as usize] as usize..start[node as usize + 1] as usize;
    let mut twins = vec![0; to.len()];
    let tasks = by_nodes(start, &mut twins);
    tasks.into_par_iter().for_each(|(nodes, own)| {
        let mut places = own.iter_mut();
        for node in nodes.start as u32..nodes.end as u32 {
            for (slot, twin) in star(node).zip(&mut places) {
                let before = &to[star(node).start..slot];
                let back = star(to[slot]);
                *twin = if before.last() == Some(&to[slot]) {
                    let same = before.iter().rev().take_while(|&&end| end == to[slot]);
                    let mut back = back.rev().filter(|&back| to[back] == node);
                    back.nth(same.count()).unwrap_or_default() as u32
                } else {
                    // The last one, without a jump that cannot be foreseen.
                    let last = |found, place| if to[place] == node { place } else { found };
                    back.fold(0, last) as u32
                };
            }
        }
    });
    twins
}

/// Cuts what belongs to the slots into the parts of one task each, with the nodes they leave.
pub(super) fn by_nodes<'a, T>(
    start: &[u32],
    mut of_slots: &'a mut [T],
) -> Vec<(Range<usize>, &'a mut [T])> {
    let nodes = start.len() - 1;
    let mut tasks = Vec::new();
    for first in (0..nodes).step_by(NODES_A_TASK) {
        let last = (first + NODES_A_TASK).min(nodes);
        let (own, others) = of_slots.split_at_mut((start[last] - start[first]) as usize);
        tasks.push((first..last, own));
        of_slots = others;
    }
    tasks
}

/// Rises with the polar angle from −π to π, from −2 to 2; exact to rounding, and the same on every platform.
fn pseudo_angle(along: Vector) -> f64 {
    let share = along.x / (along.x.abs() + along.y.abs());
    if along.y < 0.0 {
        share - 1.0
    } else {
        1.0 - share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square with a tail that leaves it, and a lone node.
    fn kite() -> Embedding {
        let points = [
            (0.0, 0.0),
            (1.0, 0.0),
            (1.0, 1.0),
            (0.0, 1.0),
            (2.0, 2.0),
            (9.0, 9.0),
        ];
        let points = points.map(|(x, y)| Vector::new(x, y));
        Embedding::new(&points, &[[0, 1], [1, 2], [2, 3], [0, 3], [2, 4]])
    }

    fn walk(graph: &Embedding, from: u32) -> Vec<u32> {
        let mut nodes = Vec::new();
        let mut slot = from;
        loop {
            slot = graph.next(slot);
            nodes.push(graph.half_edge(slot).to);
            if slot == from {
                return nodes;
            }
        }
    }

    #[test]
    fn the_face_on_the_left_of_an_edge_is_walked_around() {
        let graph = kite();
        let [forward, back] = graph.slots([0, 1]).unwrap();
        assert_eq!(walk(&graph, forward), [2, 3, 0, 1]);
        // Around the outside, with both sides of the tail.
        assert_eq!(walk(&graph, back), [3, 2, 4, 2, 1, 0]);
    }

    #[test]
    fn a_lone_node_has_an_empty_star() {
        assert!(kite().star(5).is_empty());
        assert_eq!(kite().star(2).len(), 3);
        assert_eq!(kite().nodes(), 6);
    }

    #[test]
    fn pseudo_angles_rise_with_the_angle() {
        let angles =
            (1..=64).map(|k| f64::from(k) * std::f64::consts::TAU / 64.0 - std::f64::consts::PI);
        let pseudo: Vec<f64> = angles
            .map(|a| pseudo_angle(Vector::new(libm::cos(a), libm::sin(a))))
            .collect();
        assert!(pseudo.windows(2).all(|pair| pair[0] < pair[1]));
    }
}
