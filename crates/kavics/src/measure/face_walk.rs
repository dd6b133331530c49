//! Walks along the faces of the contact graph, and what each face is like.

use crate::geometry::{Embedding, HalfEdge, Vector};
use crate::measure::SymmetricTensor;
use crate::measure::angle::Angles;

/// No walk has passed here yet.
const UNSEEN: u32 = u32::MAX;

/// One walk along a face, with the face on its left.
///
/// The face is what the walk goes around, or, of the one walk around a whole component, all that lies outside it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Walk {
    /// The half-edge it starts with.
    pub first_slot: u32,
    /// The leftmost of its nodes, of several the lowest; none unless it goes around a component, so that the face
    /// lies outside.
    pub leftmost: Option<u32>,
    /// The node that the moment refers to.
    pub origin: Vector,
    /// Edges with another face on their other side.
    pub order: usize,
    /// Area within the walk, negative of an outer one, `[length²]`.
    pub area: f64,
    /// First moment of that area about the origin, `[length³]`.
    pub moment: Vector,
    /// Area of the sectors of the discs at its corners, `[length²]`.
    pub solid: f64,
    /// Σ l_i l_j over the edges that count for the order, `[length²]`.
    pub edges: SymmetricTensor,
}

/// Walks along the faces of a graph.
#[derive(Debug)]
pub(super) struct Walker<'a> {
    graph: &'a Embedding,
    centres: &'a [Vector],
    radii: &'a [f64],
    angles: Angles,
    /// Number of the walk through each half-edge.
    pub walk_of_slot: Vec<u32>,
    /// Squared length of the longest edge met, `[length²]`.
    pub longest_squared: f64,
}

impl<'a> Walker<'a> {
    pub fn new(graph: &'a Embedding, centres: &'a [Vector], radii: &'a [f64]) -> Self {
        Self {
            graph,
            centres,
            radii,
            angles: Angles::new(),
            walk_of_slot: vec![UNSEEN; graph.half_edges()],
            longest_squared: 0.0,
        }
    }

    /// Hands over every face once, in the order of its lowest half-edge.
    pub fn walk_all(&mut self, mut take: impl FnMut(Walk)) {
        let mut number = 0;
        for node in 0..self.graph.nodes() as u32 {
            for slot in self.graph.star(node) {
                if self.walk_of_slot[slot as usize] == UNSEEN {
                    let mut walk = self.walk(node, slot, number);
                    // Rounding cannot make so much of an area that is negative or none.
                    if walk.order == 0 || walk.area <= 1e-6 * walk.edges.trace() {
                        walk.leftmost = self.leftmost_of_outer(node, slot);
                    }
                    take(walk);
                    number += 1;
                }
            }
        }
    }

    fn walk(&mut self, node: u32, first_slot: u32, number: u32) -> Walk {
        let origin = self.centres[node as usize];
        let mut walk = Walk {
            first_slot,
            origin,
            ..Walk::default()
        };
        let (mut slot, mut from, mut start) = (first_slot, node, Vector::default());
        let mut back = self.back(node, first_slot);
        loop {
            let HalfEdge { to, twin } = self.graph.half_edge(slot);
            let end = self.centres[to as usize] - origin;
            let edge = end - start;
            let radius = self.radii[from as usize];
            walk.solid += radius * radius * self.angles.between(edge, back);
            let doubled = start.cross(end);
            walk.area += doubled;
            walk.moment = walk.moment + (start + end) * doubled;
            let square = SymmetricTensor::square(edge);
            self.longest_squared = self.longest_squared.max(square.trace());
            // An edge that is met from both sides leads nowhere, and is taken off again.
            if self.walk_of_slot[twin as usize] == number {
                walk.order -= 1;
                walk.edges += square * -1.0;
            } else {
                walk.order += 1;
                walk.edges += square;
            }
            self.walk_of_slot[slot as usize] = number;
            (start, back, from, slot) = (end, -edge, to, self.graph.next(slot));
            if slot == first_slot {
                break;
            }
        }
        walk.area *= 0.5;
        walk.solid *= 0.5;
        walk.moment = walk.moment * (1.0 / 6.0);
        walk
    }

    /// From a node to where a walk comes from that goes on along `slot`.
    fn back(&self, node: u32, slot: u32) -> Vector {
        let star = self.graph.star(node);
        let after = if slot + 1 == star.end {
            star.start
        } else {
            slot + 1
        };
        let before = self.graph.half_edge(after).to;
        self.centres[before as usize] - self.centres[node as usize]
    }

    /// The leftmost node of a walk, if the walk goes around a component.
    ///
    /// Left of the leftmost node of a walk there is no edge of its component: if the walk has the direction −x in its
    /// corner there, its face lies around the component. Stars run from −π to π, so that corner follows their last
    /// half-edge.
    fn leftmost_of_outer(&self, node: u32, first_slot: u32) -> Option<u32> {
        let (mut leftmost, mut outer) = (node, false);
        let (mut slot, mut from) = (first_slot, node);
        loop {
            let (new, old) = (self.centres[from as usize], self.centres[leftmost as usize]);
            if new.x < old.x || new.x == old.x && new.y < old.y {
                (leftmost, outer) = (from, false);
            }
            outer |= from == leftmost && slot + 1 == self.graph.star(from).end;
            (from, slot) = (self.graph.half_edge(slot).to, self.graph.next(slot));
            if slot == first_slot {
                return outer.then_some(leftmost);
            }
        }
    }
}
