//! In which order the unknowns are eliminated: along an order of the bodies, whose graph is that of the contacts.

use super::sparsity::Numbers;
use super::system::System;
use crate::assembly::Partner;
use crate::ids::{BodyId, Id};
use crate::solver::ordering::{Graph, elimination_order, unknowns_in_order};

impl System<'_> {
    /// The unknowns in the order of elimination.
    pub(super) fn order_of_elimination(&self) -> Vec<usize> {
        let contacts = self.frames.iter();
        let edges = contacts.map(|frame| [frame.first.0, frame.second.0]);
        let graph = Graph::from_edges(self.numbers.len(), edges);
        let bodies = 0..self.numbers.len();
        // A side is as long as the assembly and has no place.
        let place = |body| match self.assembly.partner(BodyId::from_index(body)) {
            Partner::Grain(grain) => {
                let centre = self.assembly.grains[grain].centre;
                Some([centre.x, centre.y])
            }
            Partner::Side(_) => None,
        };
        let places: Vec<_> = bodies.map(place).collect();
        let free = |numbers: &Numbers| numbers.iter().flatten().count() as u8;
        let weights: Vec<u8> = self.numbers.iter().map(free).collect();
        unknowns_in_order(&elimination_order(&graph, &places, &weights), &self.numbers)
    }
}
