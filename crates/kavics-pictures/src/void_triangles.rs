//! Void cells as triangles between grain centres, for what draws triangles.
//!
//! The triangles of the undeformed power diagram have every contact as an edge; merged across edges that carry none,
//! they are the void cells, with their islands left out.

use kavics::assembly::{Assembly, Contact, Partner};
use kavics::equilibrium::State;
use kavics::geometry::Pieces;
use kavics::ids::{ContactId, GrainId, Id};
use kavics::measure::VoidCells;

use crate::Layout;

/// A triangle of a void cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VoidTriangle {
    /// Number of the cell.
    pub void: usize,
    /// The grains at its corners, counter-clockwise before loading.
    pub corners: [GrainId; 3],
}

/// An edge of a triangle: its grains, the lower id first, the triangle, and whether the triangle is on its left.
type Edge = ([GrainId; 2], u32, bool);

impl Layout {
    /// The triangles that fill the void cells of a state, cell by cell.
    pub fn void_triangles(&self, state: &State, cells: &VoidCells) -> Vec<VoidTriangle> {
        let triangles = &self.assembly.triangles;
        let edges = edges(triangles);
        let contacts = Pairs::new(&self.assembly, state);
        let across = edges.windows(2).filter_map(|pair| {
            let [(grains, a, _), (same, b, _)] = [pair[0], pair[1]];
            (grains == same && contacts.find(grains).is_none()).then_some([a, b])
        });
        let pieces = Pieces::new(triangles.len(), across);
        let void_of_piece = void_of_piece(&edges, &pieces, &contacts, cells);
        let number = |triangle: usize| void_of_piece.get(pieces.of(triangle)).copied().flatten();
        let found = triangles
            .iter()
            .enumerate()
            .filter_map(|(place, &corners)| {
                Some(VoidTriangle {
                    void: number(place)?,
                    corners,
                })
            });
        let mut found: Vec<VoidTriangle> = found.collect();
        found.sort_by_key(|triangle| triangle.void);
        found
    }
}

/// All edges, the two triangles at one beside each other.
fn edges(triangles: &[[GrainId; 3]]) -> Vec<Edge> {
    let of_triangle = |(number, &[a, b, c]): (usize, &[GrainId; 3])| {
        [[a, b], [b, c], [c, a]].map(|[from, to]| {
            let grains = [from.min(to), from.max(to)];
            (grains, number as u32, from < to)
        })
    };
    let mut edges: Vec<Edge> = triangles.iter().enumerate().flat_map(of_triangle).collect();
    edges.sort_unstable();
    edges
}

/// The cell that each piece of merged triangles is, by a contact on its rim.
fn void_of_piece(
    edges: &[Edge],
    pieces: &Pieces,
    contacts: &Pairs,
    cells: &VoidCells,
) -> Vec<Option<usize>> {
    let mut beside = vec![[None; 2]; contacts.count];
    for (contact, cells) in cells.beside() {
        beside[contact.index()] = cells;
    }
    let mut voids = Vec::new();
    for &(grains, triangle, left) in edges {
        if let Some(contact) = contacts.find(grains) {
            let piece = pieces.of(triangle as usize);
            if voids.len() <= piece {
                voids.resize(piece + 1, None);
            }
            let void = beside[contact.index()][usize::from(!left)];
            voids[piece] = voids[piece].or(void);
        }
    }
    voids
}

/// The active contacts between grains, sorted by their partners.
struct Pairs {
    pairs: Vec<([GrainId; 2], ContactId)>,
    count: usize,
}

impl Pairs {
    fn new(assembly: &Assembly, state: &State) -> Self {
        let active = assembly.contacts.iter().filter(|(id, _)| {
            let state = state.contacts.values().get(id.index());
            state.is_some_and(kavics::equilibrium::ContactState::is_active)
        });
        let pair = |(id, contact): (ContactId, &Contact)| match (contact.first, contact.second) {
            (Partner::Grain(a), Partner::Grain(b)) => Some(([a.min(b), a.max(b)], id)),
            _ => None,
        };
        let mut pairs: Vec<_> = active.filter_map(pair).collect();
        pairs.sort_unstable();
        Self {
            pairs,
            count: assembly.contacts.len(),
        }
    }

    fn find(&self, grains: [GrainId; 2]) -> Option<ContactId> {
        let place = self.pairs.binary_search_by_key(&grains, |pair| pair.0);
        Some(self.pairs[place.ok()?].1)
    }
}
