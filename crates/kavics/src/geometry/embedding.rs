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
    half_edges: Vec<HalfEdge>,
    /// Both slots of each edge.
    slots: Vec<u32>,
}

impl Embedding {
    /// The embedding of the graph with nodes at `points` and these edges between different nodes; O(N).
    pub fn new(points: &[Vector], edges: &[[u32; 2]]) -> Self {
        Self::of(points, edges.iter().copied())
    }

    /// The same of edges that come one by one.
    pub(super) fn of(
        points: &[Vector],
        edges: impl ExactSizeIterator<Item = [u32; 2]> + Clone,
    ) -> Self {
        let start = starts(points.len(), edges.clone());
        // At first `twin` is the number of the edge, doubled, and one more for the way back.
        let mut half_edges = vec![HalfEdge::default(); 2 * edges.len()];
        let mut next = start.clone();
        for (k, [i, j]) in edges.enumerate() {
            let number = 2 * k as u32;
            for (from, to, twin) in [(i, j, number), (j, i, number + 1)] {
                let place = &mut next[from as usize];
                half_edges[*place as usize] = HalfEdge { to, twin };
                *place += 1;
            }
        }
        drop(next);
        sort_stars(points, &start, &mut half_edges);
        let mut slots = vec![0; half_edges.len()];
        for (place, half_edge) in half_edges.iter().enumerate() {
            slots[half_edge.twin as usize] = place as u32;
        }
        let link = |half_edge: &mut HalfEdge| half_edge.twin = slots[half_edge.twin as usize ^ 1];
        half_edges
            .par_chunks_mut(4 * NODES_A_TASK)
            .for_each(|chunk| chunk.iter_mut().for_each(link));
        Self {
            start,
            half_edges,
            slots,
        }
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

    /// All half-edges by their slots.
    pub fn half_edges(&self) -> &[HalfEdge] {
        &self.half_edges
    }

    /// The slots of an edge: from its first node, and from its second.
    pub fn slots(&self, edge: usize) -> [u32; 2] {
        [self.slots[2 * edge], self.slots[2 * edge + 1]]
    }

    /// The nodes that a node has an edge with.
    pub fn neighbours(&self, node: u32) -> impl Iterator<Item = u32> {
        let star = self.star(node);
        let half_edges = &self.half_edges[star.start as usize..star.end as usize];
        half_edges.iter().map(|half_edge| half_edge.to)
    }

    /// The next half-edge along the face on the left of one.
    pub fn next(&self, slot: u32) -> u32 {
        let HalfEdge { to, twin } = self.half_edges[slot as usize];
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
fn sort_stars(points: &[Vector], start: &[u32], half_edges: &mut [HalfEdge]) {
    let tasks = by_nodes(start, half_edges);
    tasks.into_par_iter().for_each(|(nodes, mut own)| {
        let mut sorted: Vec<(f64, HalfEdge)> = Vec::new();
        for node in nodes {
            let star;
            (star, own) = own.split_at_mut((start[node + 1] - start[node]) as usize);
            let direction = |half_edge: &HalfEdge| {
                let along = points[half_edge.to as usize] - points[node];
                (pseudo_angle(along), *half_edge)
            };
            sorted.clear();
            sorted.extend(star.iter().map(direction));
            sort_by_direction(&mut sorted);
            for (half_edge, (_, by_angle)) in star.iter_mut().zip(&sorted) {
                *half_edge = *by_angle;
            }
        }
    });
}

/// Equal directions by the nodes they go to; insertion, as stars are small.
fn sort_by_direction(star: &mut [(f64, HalfEdge)]) {
    let after =
        |a: &(f64, HalfEdge), b: &(f64, HalfEdge)| a.0 > b.0 || a.0 == b.0 && a.1.to > b.1.to;
    if star.len() > 32 {
        star.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.to.cmp(&b.1.to)));
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
            nodes.push(graph.half_edges()[slot as usize].to);
            if slot == from {
                return nodes;
            }
        }
    }

    #[test]
    fn the_face_on_the_left_of_an_edge_is_walked_around() {
        let graph = kite();
        let [forward, back] = graph.slots(0);
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
