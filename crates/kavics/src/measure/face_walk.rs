//! Walks along the faces of the contact graph, and what each face is like.

use std::f64::consts::TAU;

use crate::assembly::Grain;
use crate::geometry::{Embedding, HalfEdge, Vector};
use crate::measure::SymmetricTensor;

/// No walk has passed here yet.
const UNSEEN: u32 = u32::MAX;

/// One walk along a face, with the face on its left.
///
/// The face is what the walk goes around, or, of the one walk around a whole component, all that lies outside it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Walk {
    /// The half-edge it starts with.
    pub first_slot: u32,
    /// Whether it goes around a component, so that the face lies outside.
    pub outer: bool,
    /// The leftmost of its nodes, of several the lowest.
    pub leftmost: u32,
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
    grains: &'a [Grain],
    /// Number of the walk through each half-edge.
    pub walk_of_slot: Vec<u32>,
}

impl<'a> Walker<'a> {
    pub fn new(graph: &'a Embedding, centres: &'a [Vector], grains: &'a [Grain]) -> Self {
        Self {
            graph,
            centres,
            grains,
            walk_of_slot: vec![UNSEEN; graph.half_edges().len()],
        }
    }

    /// Hands over every face once, in the order of its lowest half-edge.
    pub fn walk_all(&mut self, mut take: impl FnMut(Walk)) {
        let mut number = 0;
        for node in 0..self.graph.nodes() as u32 {
            for slot in self.graph.star(node) {
                if self.walk_of_slot[slot as usize] == UNSEEN {
                    take(self.walk(node, slot, number));
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
            leftmost: node,
            ..Walk::default()
        };
        let (mut slot, mut from, mut start) = (first_slot, node, Vector::default());
        let mut arriving = self.arriving(node, first_slot);
        loop {
            let HalfEdge { to, twin } = self.graph.half_edges()[slot as usize];
            let end = self.centres[to as usize] - origin;
            let edge = end - start;
            let last_of_star = slot + 1 == self.graph.star(from).end;
            walk.see(from, last_of_star, self.centres);
            let radius = self.grains[from as usize].radius;
            walk.solid += 0.5 * radius * radius * corner(edge, -arriving);
            let doubled = start.cross(end);
            walk.area += 0.5 * doubled;
            walk.moment = walk.moment + (start + end) * (doubled / 6.0);
            let square = SymmetricTensor::square(edge);
            // An edge that is met from both sides leads nowhere, and is taken off again.
            if self.walk_of_slot[twin as usize] == number {
                walk.order -= 1;
                walk.edges += square * -1.0;
            } else {
                walk.order += 1;
                walk.edges += square;
            }
            self.walk_of_slot[slot as usize] = number;
            (start, arriving, from, slot) = (end, edge, to, self.graph.next(slot));
            if slot == first_slot {
                return walk;
            }
        }
    }

    /// The edge by which a walk comes to the node from where it goes on along `slot`.
    fn arriving(&self, node: u32, slot: u32) -> Vector {
        let star = self.graph.star(node);
        let after = if slot + 1 == star.end {
            star.start
        } else {
            slot + 1
        };
        let before = self.graph.half_edges()[after as usize].to;
        self.centres[node as usize] - self.centres[before as usize]
    }
}

impl Walk {
    /// Meets a node; of a star sorted from −π to π, the direction −x lies after the last half-edge.
    ///
    /// Left of the leftmost node of a walk there is no edge of its component: if the walk has that direction in its
    /// corner there, its face lies around the component.
    fn see(&mut self, node: u32, last_of_star: bool, centres: &[Vector]) {
        if node == self.leftmost {
            self.outer |= last_of_star;
            return;
        }
        let (new, old) = (centres[node as usize], centres[self.leftmost as usize]);
        if new.x < old.x || new.x == old.x && new.y < old.y {
            (self.leftmost, self.outer) = (node, last_of_star);
        }
    }
}

/// Angle from one direction to another, counter-clockwise, in (0, 2π].
fn corner(from: Vector, to: Vector) -> f64 {
    let angle = libm::atan2(from.cross(to), from.dot(to));
    if angle > 0.0 { angle } else { angle + TAU }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn corners_are_counted_counter_clockwise_up_to_a_whole_turn() {
        let (right, up) = (Vector::new(2.0, 0.0), Vector::new(0.0, 3.0));
        assert_eq!(corner(right, up), FRAC_PI_2);
        assert_eq!(corner(up, right), TAU - FRAC_PI_2);
        assert_eq!(corner(right, -right), PI);
        assert_eq!(corner(up, up), TAU);
    }
}
