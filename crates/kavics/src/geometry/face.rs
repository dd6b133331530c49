//! One face of the graph of near discs, triangulated alone.
//!
//! On the left of an edge lies the corner whose radical centre is the lowest; the rest of the face falls into the
//! chains of corners before and after it.

use crate::geometry::Vector;
use crate::geometry::container::{Container, HalfPlane};
use crate::geometry::embedding::Embedding;
use crate::geometry::faces::lowest_first;
use crate::geometry::lifted::Lifted;
use crate::geometry::near_pairs::Disc;
use crate::geometry::outer_triangles::Lowest;
use crate::geometry::power_diagram::DualEdge;

/// Faces with more corners are left open.
const LONGEST: usize = 64;

/// What triangulating the faces needs to know.
pub(super) struct Triangulation<'a> {
    pub discs: &'a [Disc],
    pub graph: &'a Embedding,
    pub lifted: &'a Lifted<'a>,
    pub container: &'a Container,
    /// Radical centres must be inside by this.
    pub margin: f64,
    /// Whether the dual edges across the faces are wanted.
    pub diagonals: bool,
}

/// A corner of a face: its disc, and the half-edge that leaves it along the face.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub disc: Disc,
    pub slot: u32,
    /// What the face gives to the area of the disc's cell.
    pub area: f64,
    /// Length of the half-edge times that of its dual edge on the side of the face.
    pub doubled: f64,
}

/// Corners from `low` to `high`, with the edge from `high` to `low` that has them on its left.
#[derive(Clone, Copy)]
struct Chain {
    low: usize,
    high: usize,
    /// Length of that edge times that of its dual edge on the right.
    beyond: f64,
}

/// A face, and what its triangles give.
#[derive(Default)]
pub(super) struct Face {
    pub corners: Vec<Corner>,
    /// Counter-clockwise, lowest number first.
    pub triangles: Vec<[u32; 3]>,
    /// Dual edges across the face.
    pub diagonals: Vec<DualEdge>,
    /// The lowest slot of its half-edges.
    pub lowest: u32,
    chains: Vec<Chain>,
}

impl Face {
    /// Walks around the face on the left of a half-edge that leaves `node`; false where it is too long.
    pub(super) fn walk(
        &mut self,
        triangulation: &Triangulation<'_>,
        node: u32,
        from: u32,
        mut see: impl FnMut(u32),
    ) -> bool {
        let Triangulation { discs, graph, .. } = triangulation;
        self.corners.clear();
        self.lowest = from;
        let (mut slot, mut at) = (from, node);
        loop {
            see(slot);
            self.lowest = self.lowest.min(slot);
            self.corners.push(Corner {
                disc: discs[at as usize],
                slot,
                area: 0.0,
                doubled: 0.0,
            });
            let to = graph.half_edge(slot).to;
            (slot, at) = (graph.next(slot), to);
            if slot == from {
                return true;
            }
            if self.corners.len() > LONGEST {
                return false;
            }
        }
    }

    /// Triangulates the face; false where it is no simple loop, or a radical centre is not inside the container.
    pub(super) fn fill(&mut self, triangulation: &Triangulation<'_>) -> bool {
        self.chains.clear();
        self.triangles.clear();
        self.diagonals.clear();
        if !(self.is_simple() && self.turns_left()) {
            return false;
        }
        self.chains.push(Chain {
            low: 0,
            high: self.corners.len() - 1,
            beyond: 0.0,
        });
        while let Some(chain) = self.chains.pop() {
            if !self.triangle_over(chain, triangulation) {
                return false;
            }
        }
        true
    }

    /// Whether it meets no disc twice.
    fn is_simple(&self) -> bool {
        let corners = &self.corners;
        let number = |k: usize| corners[k].disc.index;
        let first_time = |k: usize| (0..k).all(|other| number(other) != number(k));
        corners.len() >= 3 && (0..corners.len()).all(first_time)
    }

    fn turns_left(&self) -> bool {
        let origin = self.corners[0].disc.centre;
        let along = |k: usize| self.corners[k].disc.centre - origin;
        let twice = |k: usize| along(k).cross(along(k + 1));
        (1..self.corners.len() - 1).map(twice).sum::<f64>() > 0.0
    }

    /// The triangle on the left of the edge of a chain.
    fn triangle_over(&mut self, chain: Chain, triangulation: &Triangulation<'_>) -> bool {
        let Chain { low, high, beyond } = chain;
        let [from, to] = [high, low].map(|k| self.corners[k].disc);
        let mut lowest = Lowest::new([&from, &to], triangulation.lifted);
        for k in low + 1..high {
            lowest.look(k as u32, &self.corners[k].disc, || true);
        }
        let Some((apex, centre)) = lowest.found() else {
            return false;
        };
        if !triangulation.is_inside(centre) {
            return false;
        }
        let (apex, doubled, foot) = (apex as usize, lowest.doubled(), lowest.foot);
        let numbers = [high, low, apex].map(|k| self.corners[k].disc.index);
        self.triangles.push(lowest_first(numbers));
        self.share(high, low, foot, doubled + beyond);
        if low == 0 && high == self.corners.len() - 1 {
            self.corners[high].doubled = doubled;
        } else if triangulation.diagonals {
            self.diagonals.push(lowest.dual_edge([beyond, doubled]));
        }
        self.beside(low, apex, centre);
        self.beside(apex, high, centre);
        true
    }

    /// The edge of a triangle from corner `low` on to corner `high`, whose radical centre is `centre`.
    fn beside(&mut self, low: usize, high: usize, centre: Vector) {
        let [a, b] = [low, high].map(|k| self.corners[k].disc);
        let along = b.centre - a.centre;
        let doubled = along.cross(centre - a.centre);
        if high > low + 1 {
            self.chains.push(Chain {
                low,
                high,
                beyond: doubled,
            });
            return;
        }
        let squared = along.length_squared();
        let foot = 0.5 * (1.0 + (a.radius - b.radius) * (a.radius + b.radius) / squared);
        self.corners[low].doubled = doubled;
        self.share(low, high, foot, doubled);
    }

    /// Gives both ends of an edge their share of the area over it.
    fn share(&mut self, from: usize, to: usize, foot: f64, doubled: f64) {
        self.corners[from].area += 0.5 * foot * doubled;
        self.corners[to].area += 0.5 * (1.0 - foot) * doubled;
    }
}

impl Triangulation<'_> {
    fn is_inside(&self, point: Vector) -> bool {
        let inside = |side: &HalfPlane| side.distance(point) > self.margin;
        self.container.sides().iter().all(inside)
    }

    /// Whether an edge may have no dual length, by its length times the dual length.
    pub(super) fn may_be_nothing(&self, first: u32, second: u32, product: f64) -> bool {
        let [a, b] = [first, second].map(|disc| self.discs[disc as usize].radius);
        // What rounding the heights of the lifted discs can do to it.
        product <= 1e3 * (self.lifted.noise + f64::EPSILON * (a + b) * (a + b))
    }
}
