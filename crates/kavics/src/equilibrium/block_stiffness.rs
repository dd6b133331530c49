//! The stiffness of the assembly by blocks, for solvers that iterate.
//!
//! A node is a body with a free freedom. Held freedoms, and bodies that are set aside, are unit rows.

use super::Iteration;
use rayon::prelude::*;

use super::configuration::Configuration;
use super::kinematics::{Block, FREEDOMS};
use super::system::System;
use crate::geometry::Vector;
use crate::ids::{BodyId, ContactId, Id};
use crate::solver::{BlockMatrix, BlockSystem, Modes, RowSum};

/// A row of nodes is this many mean radii high.
const ROW: f64 = 3.0;

/// The nodes in an order in which neighbours stand near to each other: by rows from the bottom, in them from the left.
pub struct NodeOrder {
    /// Body of each node.
    pub bodies: Vec<BodyId>,
    /// Node of each body.
    node: Vec<Option<u32>>,
    /// First of the contacts of each node, and their number at the end.
    contact_start: Vec<u32>,
    contacts: Vec<ContactId>,
}

impl NodeOrder {
    fn new(system: &System<'_>) -> Self {
        let mut bodies: Vec<BodyId> = (0..system.numbers.len())
            .filter(|&body| system.numbers[body].iter().any(Option::is_some))
            .map(BodyId::from_index)
            .collect();
        let height = ROW * system.assembly.mean_radius();
        bodies.par_sort_by_cached_key(|&body| {
            let place = system.reference_point(body);
            // Whole numbers order as they are; x does once it is counted in small parts of a row.
            let row = (place.y / height).floor() as i64;
            (row, (place.x / height * 256.0).floor() as i64)
        });
        let mut node = vec![None; system.numbers.len()];
        for (place, body) in bodies.iter().enumerate() {
            node[body.index()] = Some(place as u32);
        }
        let mut order = Self {
            contact_start: vec![0; bodies.len() + 1],
            contacts: Vec::new(),
            bodies,
            node,
        };
        order.list_contacts(system);
        order
    }

    fn list_contacts(&mut self, system: &System<'_>) {
        for frame in &system.frames {
            let nodes = [frame.first, frame.second].map(|body| self.node[body.index()]);
            for node in nodes.into_iter().flatten() {
                self.contact_start[node as usize + 1] += 1;
            }
        }
        for node in 0..self.bodies.len() {
            self.contact_start[node + 1] += self.contact_start[node];
        }
        let mut next = self.contact_start.clone();
        self.contacts = vec![ContactId(0); next.last().map_or(0, |&count| count as usize)];
        for (contact, frame) in system.frames.iter().enumerate() {
            let nodes = [frame.first, frame.second].map(|body| self.node[body.index()]);
            for node in nodes.into_iter().flatten() {
                let place = &mut next[node as usize];
                self.contacts[*place as usize] = ContactId::from_index(contact);
                *place += 1;
            }
        }
    }

    fn contacts(&self, node: usize) -> &[ContactId] {
        &self.contacts[self.contact_start[node] as usize..self.contact_start[node + 1] as usize]
    }
}

impl System<'_> {
    /// The nodes of this system.
    pub(super) fn node_order(&self) -> NodeOrder {
        NodeOrder::new(self)
    }

    /// The stiffness by blocks.
    pub(super) fn block_system(
        &self,
        order: &NodeOrder,
        configuration: &Configuration,
        iteration: Iteration,
    ) -> BlockSystem<FREEDOMS> {
        let nodes = order.bodies.len();
        let whole = BlockMatrix::from_rows(nodes, nodes, |node, sum| {
            self.add_row(order, configuration, iteration, node, sum);
        });
        let (diagonal, ties) = whole.split();
        BlockSystem { diagonal, ties }
    }

    fn add_row(
        &self,
        order: &NodeOrder,
        configuration: &Configuration,
        iteration: Iteration,
        node: usize,
        sum: &mut RowSum<FREEDOMS>,
    ) {
        let body = order.bodies[node];
        let mut own = self.held_units(body);
        if !self.set_aside[body.index()] {
            for &contact in order.contacts(node) {
                let (bond, frame) = (&configuration.bonds[contact], &self.frames[contact.index()]);
                if !bond.is_active() {
                    continue;
                }
                let blocks = frame.stiffness(&self.stiffness_of(bond, iteration));
                let (other, here, tie) = if frame.first == body {
                    (frame.second, &blocks.first_first, &blocks.first_second)
                } else {
                    (frame.first, &blocks.second_second, &blocks.second_first)
                };
                self.add_free(&mut own, here, body, body);
                if let Some(other_node) = order.node[other.index()] {
                    self.add_free(sum.entry(other_node), tie, body, other);
                }
            }
        }
        *sum.entry(node as u32) = own;
    }

    /// Ones where a freedom of a body is no unknown or the body is set aside.
    fn held_units(&self, body: BodyId) -> Block {
        let mut units = [[0.0; FREEDOMS]; FREEDOMS];
        for (freedom, number) in self.numbers[body.index()].iter().enumerate() {
            if number.is_none() || self.set_aside[body.index()] {
                units[freedom][freedom] = 1.0;
            }
        }
        units
    }

    /// Adds the part of a stiffness between free freedoms to a block by its columns.
    fn add_free(&self, sum: &mut Block, block: &Block, row_body: BodyId, column_body: BodyId) {
        let (rows, columns) = (
            &self.numbers[row_body.index()],
            &self.numbers[column_body.index()],
        );
        for (row, _) in rows.iter().enumerate().filter(|(_, n)| n.is_some()) {
            for (column, _) in columns.iter().enumerate().filter(|(_, n)| n.is_some()) {
                sum[column][row] += block[row][column];
            }
        }
    }

    /// The rigid motions of the assembly at each node, lengths over its size; zero at held freedoms.
    pub(super) fn rigid_modes(&self, order: &NodeOrder) -> Modes<FREEDOMS> {
        let places = || order.bodies.iter().map(|&body| self.reference_point(body));
        let count = order.bodies.len().max(1) as f64;
        let centre = places().fold(Vector::default(), |sum: Vector, p| sum + p) * (1.0 / count);
        let size = places()
            .map(|place| (place - centre).length())
            .fold(self.assembly.mean_radius(), f64::max);
        let bodies = order.bodies.iter().zip(places());
        bodies
            .map(|(&body, place)| {
                let r = (place - centre) * (1.0 / size);
                let mut modes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-r.y, r.x, 1.0 / size]];
                for (freedom, number) in self.numbers[body.index()].iter().enumerate() {
                    if number.is_none() || self.set_aside[body.index()] {
                        for mode in &mut modes {
                            mode[freedom] = 0.0;
                        }
                    }
                }
                modes
            })
            .collect()
    }

    /// What turns the components of a load on each node into forces.
    pub(super) fn load_units(&self, order: &NodeOrder) -> Vec<[f64; FREEDOMS]> {
        let bodies = order.bodies.iter();
        bodies
            .map(|&body| [1.0, 1.0, 1.0 / self.moment_arm(body)])
            .collect()
    }

    fn reference_point(&self, body: BodyId) -> Vector {
        self.assembly.reference_point(self.assembly.partner(body))
    }
}
