//! Void cells: the loops of the contact graph and what lies in them.
//!
//! The graph has the grains as nodes and the active contacts between them as edges, drawn straight from centre to
//! centre; contacts with sides close no loop. Its faces but those that lie around everything are the void cells.
//! Satake (1992); Bagi (1996); Kruyt & Rothenburg (1996); Kuhn (1999).

use std::f64::consts::PI;

use crate::assembly::Partner;
use crate::geometry::{Embedding, Vector, spatial_order};
use crate::ids::{ContactId, GrainId, PerGrain};
use crate::measure::enclosure::nearest_to_the_left;
use crate::measure::face_walk::{Walk, Walker};
use crate::measure::{Snapshot, SymmetricTensor};

/// No cell: what lies around everything.
const OUTSIDE: u32 = u32::MAX;

/// A void cell: a bounded face of the contact graph.
///
/// Its boundary is a loop of contacts, and around each island in it another. An island is a part of the graph that
/// no contact joins to the loop; chains of grains that hang in the cell belong to the loop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VoidCell {
    /// Order m: contacts of the loop that have another face on their other side. Those met from both sides, as in
    /// chains that hang in the cell, do not count, nor do those of islands.
    pub order: usize,
    /// Islands in the cell, and not within one of them.
    pub islands: usize,
    /// Grains in the cell without an active contact with another grain.
    pub rattlers: usize,
    /// Area A_m: within the loop, less that within the outlines of islands, `[length²]`.
    pub area: f64,
    /// Void area: A_m less the sectors of discs in it, Σ ½ R² θ with θ the angle between neighbouring contacts of a
    /// grain, and less the discs of rattlers; overlaps count twice, `[length²]`.
    pub void_area: f64,
    /// Centroid of the area A_m, `[length]`.
    pub centroid: Vector,
    /// Shape tensor of the loop with edges l, over those that count for the order.
    ///
    /// ```math
    /// S_{ij} = \frac{\sum_{e=1}^{m} l_i^e l_j^e}{\sum_{e=1}^{m} (l^e)^2}
    /// ```
    ///
    /// Symmetric, trace 1, dimensionless; isotropic for a regular polygon. Its larger eigenvalue lies along the cell.
    pub shape: SymmetricTensor,
}

/// The void cells of a state, and the graph they are the faces of.
#[derive(Clone, Debug, Default)]
pub struct VoidCells {
    /// The void cells, along rows from the bottom.
    pub cells: Vec<VoidCell>,
    /// Grains V with an active contact with another grain.
    pub grains: usize,
    /// Active contacts E between grains.
    pub contacts: usize,
    /// Components C: parts of the graph that no contact joins.
    pub components: usize,
    /// Area within the outlines of the components that lie in no cell: Σ A_m, `[length²]`.
    pub enclosed_area: f64,
    contact_ids: Vec<ContactId>,
    /// The nodes of each contact.
    edges: Vec<[u32; 2]>,
    grain_of_node: Vec<u32>,
    graph: Embedding,
    first_slots: Vec<u32>,
    walk_of_slot: Vec<u32>,
    cell_of_walk: Vec<u32>,
}

/// The void cells of the contact graph in this state; O(N), and what it takes to find where islands lie.
///
/// Where contacts cross, as between discs that overlap by far, there are no faces, and [`VoidCells::euler`] tells.
pub fn void_cells(snapshot: &Snapshot<'_>) -> VoidCells {
    let grains = &snapshot.assembly.grains;
    let centres: Vec<Vector> = grains.ids().map(|grain| snapshot.centre(grain)).collect();
    // Nodes that are near in the plane are near in memory, so that walks stay within the cache.
    let grain_of_node = spatial_order(&centres);
    let centre = |&grain: &u32| centres[grain as usize];
    let centres: Vec<Vector> = grain_of_node.iter().map(centre).collect();
    let radius = |&grain: &u32| grains[GrainId(grain)].radius;
    let radii: Vec<f64> = grain_of_node.iter().map(radius).collect();
    let (contact_ids, edges) = active_contacts(snapshot, &grain_of_node);
    let graph = Embedding::new(&centres, &edges);
    let mut walker = Walker::new(&graph, &centres, &radii);
    let mut found = VoidCells {
        contacts: edges.len(),
        contact_ids,
        edges,
        grain_of_node,
        ..VoidCells::default()
    };
    let mut outlines = Vec::new();
    walker.walk_all(|walk| outlines.extend(found.take(walk)));
    let longest = walker.longest_squared.sqrt();
    found.walk_of_slot = walker.walk_of_slot;
    found.graph = graph;
    found.components = outlines.len();
    let nodes = 0..found.graph.nodes() as u32;
    let alone: Vec<u32> = nodes.filter(|&n| found.graph.star(n).is_empty()).collect();
    found.grains = grains.len() - alone.len();
    outlines.sort_unstable_by(|a, b| {
        let [a, b] = [a, b].map(|outline| centres[outline.leftmost as usize]);
        a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
    });
    found.place(&outlines, &alone, &centres, &radii, longest);
    found
}

/// How many void cells there are of each order, from order 0.
pub fn loop_orders(cells: &[VoidCell]) -> Vec<usize> {
    let longest = cells.iter().map(|cell| cell.order).max();
    let mut counts = vec![0; longest.map_or(0, |order| order + 1)];
    for cell in cells {
        counts[cell.order] += 1;
    }
    counts
}

/// The walk around a component, and its number among all walks.
struct Outline {
    number: usize,
    leftmost: u32,
    walk: Walk,
}

/// The active contacts between grains, and their nodes.
fn active_contacts(
    snapshot: &Snapshot<'_>,
    grain_of_node: &[u32],
) -> (Vec<ContactId>, Vec<[u32; 2]>) {
    let mut node_of_grain = PerGrain::filled(0_u32, grain_of_node.len());
    for (node, &grain) in grain_of_node.iter().enumerate() {
        node_of_grain[GrainId(grain)] = node as u32;
    }
    let (mut ids, mut edges) = (Vec::new(), Vec::new());
    let states = snapshot.state.contacts.values();
    for ((id, contact), state) in snapshot.assembly.contacts.iter().zip(states) {
        if let (Partner::Grain(first), Partner::Grain(second)) = (contact.first, contact.second)
            && state.is_active()
        {
            ids.push(id);
            edges.push([first, second].map(|grain| node_of_grain[grain]));
        }
    }
    (ids, edges)
}

impl VoidCells {
    /// Mean order Σ m / L of the L loops; none without a loop.
    ///
    /// In the bulk 2Z/(Z − 2), with Z the contacts a grain. Satake (1992).
    pub fn mean_order(&self) -> Option<f64> {
        let orders: usize = self.cells.iter().map(|cell| cell.order).sum();
        (!self.cells.is_empty()).then(|| orders as f64 / self.cells.len() as f64)
    }

    /// V − E + L − C, with L loops; 0 for a graph without crossings, after Euler.
    pub fn euler(&self) -> isize {
        (self.grains + self.cells.len()) as isize - (self.contacts + self.components) as isize
    }

    /// The grains along the loop of a cell, counter-clockwise; one that the loop passes several times is met as often.
    pub fn around(&self, cell: usize) -> impl Iterator<Item = GrainId> {
        let first = self.first_slots[cell];
        let along = std::iter::successors(Some(first), move |&slot| {
            Some(self.graph.next(slot)).filter(|&next| next != first)
        });
        along.map(|slot| {
            let node = self.graph.half_edge(slot).to;
            GrainId(self.grain_of_node[node as usize])
        })
    }

    /// The cells on the left and on the right of each contact of the graph, seen from its first grain; none: outside.
    ///
    /// With X^L, X^R any points chosen for these cells, or the middle of the contact where there is none, and h the
    /// vector X^L − X^R turned by −90°, Σ h_i l_j = A δ_ij, where A is the enclosed area. Satake (1992).
    pub fn beside(&self) -> impl Iterator<Item = (ContactId, [Option<usize>; 2])> {
        let contacts = self.contact_ids.iter().zip(&self.edges);
        contacts.map(|(&id, &edge)| {
            let slots = self.graph.slots(edge).map(|slots| slots.map(Some));
            let beside = slots.unwrap_or_default();
            (id, beside.map(|slot| self.cell_left_of(slot?)))
        })
    }

    fn cell_left_of(&self, slot: u32) -> Option<usize> {
        let cell = self.cell_of_walk[self.walk_of_slot[slot as usize] as usize];
        (cell != OUTSIDE).then_some(cell as usize)
    }

    /// Makes a cell of a walk, or gives it back as an outline.
    fn take(&mut self, walk: Walk) -> Option<Outline> {
        let number = self.cell_of_walk.len();
        if let Some(leftmost) = walk.leftmost {
            self.cell_of_walk.push(OUTSIDE);
            return Some(Outline {
                number,
                leftmost,
                walk,
            });
        }
        self.cell_of_walk.push(self.cells.len() as u32);
        self.first_slots.push(walk.first_slot);
        self.cells.push(VoidCell::new(&walk));
        None
    }

    /// Puts components, from left to right, and grains without a contact into the cells that they lie in.
    ///
    /// The first thing to the left of a component's leftmost grain is the loop it lies in, or an outline that lies in
    /// the same cell and was placed before.
    fn place(
        &mut self,
        outlines: &[Outline],
        alone: &[u32],
        centres: &[Vector],
        radii: &[f64],
        longest: f64,
    ) {
        // Left of the first there is nothing.
        let islands = outlines.iter().skip(1).map(|outline| outline.leftmost);
        let seekers = islands.chain(alone.iter().copied());
        let points: Vec<Vector> = seekers.map(|node| centres[node as usize]).collect();
        let mut met = nearest_to_the_left(&points, &self.graph, centres, longest).into_iter();
        for (k, Outline { number, walk, .. }) in outlines.iter().enumerate() {
            let slot = if k == 0 { None } else { met.next().flatten() };
            match slot.and_then(|slot| self.cell_left_of(slot)) {
                Some(cell) => {
                    self.cell_of_walk[*number] = cell as u32;
                    self.cells[cell].add_island(walk);
                }
                None => self.enclosed_area -= walk.area,
            }
        }
        for (&node, slot) in alone.iter().zip(met) {
            if let Some(cell) = slot.and_then(|slot| self.cell_left_of(slot)) {
                self.cells[cell].add_rattler(radii[node as usize]);
            }
        }
    }
}

impl VoidCell {
    /// The cell within a walk, as long as nothing lies in it.
    fn new(walk: &Walk) -> Self {
        let mut cell = Self {
            order: walk.order,
            area: walk.area,
            void_area: walk.area - walk.solid,
            centroid: walk.origin,
            ..Self::default()
        };
        if walk.area > 0.0 {
            cell.centroid = walk.origin + walk.moment * (1.0 / walk.area);
        }
        let squares = walk.edges.trace();
        if squares > 0.0 {
            cell.shape = walk.edges * (1.0 / squares);
        }
        cell
    }

    /// Takes the outline of an island out of the cell.
    fn add_island(&mut self, outline: &Walk) {
        let arm = outline.origin - self.centroid;
        let moment = outline.moment + arm * outline.area;
        self.islands += 1;
        self.area += outline.area;
        self.void_area += outline.area - outline.solid;
        if self.area > 0.0 {
            self.centroid = self.centroid + moment * (1.0 / self.area);
        }
    }

    fn add_rattler(&mut self, radius: f64) {
        self.rattlers += 1;
        self.void_area -= PI * radius * radius;
    }
}
