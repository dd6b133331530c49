//! Cracks: chains of broken contacts.
//!
//! A crack runs along dual edges, from void to void of the undeformed assembly: broken contacts around one void
//! belong to one crack. The voids are the triangles of the regular triangulation, merged across edges that carry no
//! contact. What lies around the assembly joins nothing; the gap between two grains that touch a side and each other
//! does.

use crate::assembly::{Assembly, Contact, Partner, Side};
use crate::geometry::{Pieces, Vector};
use crate::ids::{ContactId, Id};
use crate::measure::{Snapshot, SymmetricTensor};

/// No void: what lies around the assembly.
const OUTSIDE: u32 = u32::MAX;

/// A crack.
#[derive(Clone, Debug, PartialEq)]
pub struct Crack {
    /// Its broken contacts, by id.
    pub contacts: Vec<ContactId>,
    /// Length: the sum of its dual lengths Σ s, `[length]`.
    pub length: f64,
    /// Extent: from end to end along its orientation, `[length]`.
    pub extent: f64,
    /// Centroid of its dual edges, `[length]`.
    pub centroid: Vector,
    /// Angle of its orientation from the x axis, counter-clockwise, in radians within (−π/2, π/2]: the principal
    /// direction of the dual edges as lines,
    ///
    /// ```math
    /// \sum_c s \left(d_i d_j + \tfrac{s^2}{12} t_i t_j\right)
    /// ```
    ///
    /// with d from the centroid to the contact point and t along the dual edge.
    pub orientation: f64,
}

/// The cracks of a state in the undeformed assembly, the longest first.
pub fn cracks(snapshot: &Snapshot<'_>) -> Vec<Crack> {
    let assembly = snapshot.assembly;
    let states = &snapshot.state.contacts;
    let broken: Vec<ContactId> = states
        .iter()
        .filter(|(_, state)| state.broken)
        .map(|(id, _)| id)
        .collect();
    if broken.is_empty() {
        return Vec::new();
    }
    let mut cracks: Vec<Crack> = chains(&Voids::new(assembly), &broken)
        .into_iter()
        .map(|contacts| crack(assembly, contacts))
        .collect();
    cracks.sort_by(|a, b| {
        let longest = b.length.total_cmp(&a.length);
        longest.then(a.contacts[0].cmp(&b.contacts[0]))
    });
    cracks
}

/// Contacts that meet at voids, chain by chain.
fn chains(voids: &Voids, contacts: &[ContactId]) -> Vec<Vec<ContactId>> {
    let mut met: Vec<(u32, u32)> = Vec::with_capacity(2 * contacts.len());
    for (place, contact) in contacts.iter().enumerate() {
        let beside = voids.beside[contact.index()];
        met.extend(
            beside
                .into_iter()
                .filter(|&v| v != OUTSIDE)
                .map(|v| (v, place as u32)),
        );
    }
    met.sort_unstable();
    let at_one_void = met.windows(2).filter(|pair| pair[0].0 == pair[1].0);
    let edges = at_one_void.map(|pair| [pair[0].1, pair[1].1]);
    let pieces = Pieces::new(contacts.len(), edges);
    let mut chains = vec![Vec::new(); contacts.len()];
    for (place, &contact) in contacts.iter().enumerate() {
        chains[pieces.of(place)].push(contact);
    }
    chains.retain(|chain| !chain.is_empty());
    chains
}

fn crack(assembly: &Assembly, contacts: Vec<ContactId>) -> Crack {
    let members = || contacts.iter().map(|&id| &assembly.contacts[id]);
    let length: f64 = members().map(Contact::dual_length).sum();
    // A crack of contacts without dual length still has a place.
    let weight = |c: &Contact| {
        if length > 0.0 {
            c.dual_length() / length
        } else {
            1.0
        }
    };
    let weights: f64 = members().map(weight).sum();
    let centroid = members().fold(Vector::default(), |sum, c| {
        sum + c.point * (weight(c) / weights)
    });
    let mut spread = SymmetricTensor::default();
    for contact in members() {
        let (s, t) = (contact.dual_length(), contact.normal.quarter_turn());
        let place = SymmetricTensor::square(contact.point - centroid);
        let edge = SymmetricTensor::square(t) * (s * s / 12.0);
        spread += (place + edge) * s;
    }
    let orientation = spread.principal_direction();
    Crack {
        length,
        extent: extent(members(), orientation),
        centroid,
        orientation,
        contacts,
    }
}

/// How far the dual edges reach along a direction.
fn extent<'a>(contacts: impl Iterator<Item = &'a Contact>, angle: f64) -> f64 {
    let along = Vector::new(libm::cos(angle), libm::sin(angle));
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for contact in contacts {
        let t = contact.normal.quarter_turn();
        let [right, left] = contact.dual_parts;
        for end in [contact.point - t * right, contact.point + t * left] {
            least = least.min(end.dot(along));
            most = most.max(end.dot(along));
        }
    }
    most - least
}

/// The voids on the two sides of each contact.
struct Voids {
    beside: Vec<[u32; 2]>,
}

/// A triangle's edge: its grains, the lower first, and the triangle.
type TriangleEdge = ([u32; 2], u32);

impl Voids {
    fn new(assembly: &Assembly) -> Self {
        let edges = triangle_edges(assembly);
        let carried = carried_edges(assembly);
        let is_carried = |grains: &[u32; 2]| carried.binary_search_by_key(grains, |c| c.0).is_ok();
        let open = edges
            .windows(2)
            .filter(|pair| pair[0].0 == pair[1].0 && !is_carried(&pair[0].0))
            .map(|pair| [pair[0].1, pair[1].1]);
        let voids = Pieces::new(assembly.triangles.len(), open);
        let mut beside = vec![[OUTSIDE; 2]; assembly.contacts.len()];
        for &(grains, contact) in &carried {
            let first = edges.partition_point(|edge| edge.0 < grains);
            let around = edges[first..].iter().take_while(|edge| edge.0 == grains);
            for (slot, edge) in beside[contact as usize].iter_mut().zip(around) {
                *slot = voids.of(edge.1 as usize) as u32;
            }
        }
        let mut all = Self { beside };
        all.join_at_sides(assembly, &carried);
        all
    }

    /// Where neighbours along a side touch each other, the gap at the side is a void beside all three contacts.
    fn join_at_sides(&mut self, assembly: &Assembly, carried: &[([u32; 2], u32)]) {
        let mut at_sides = contacts_along_sides(assembly);
        at_sides.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut gap = assembly.triangles.len() as u32;
        for pair in at_sides.windows(2) {
            let [(side, _, one, first), (other_side, _, other, second)] = [pair[0], pair[1]];
            let grains = [one.min(other), one.max(other)];
            let between = carried.binary_search_by_key(&grains, |c| c.0);
            let Ok(between) = between.map(|place| carried[place].1) else {
                continue;
            };
            if side != other_side || self.beside[between as usize][1] != OUTSIDE {
                continue;
            }
            let slots = [(first, 1), (second, 0), (between, 1)];
            for (contact, slot) in slots {
                self.beside[contact as usize][slot] = gap;
            }
            gap += 1;
        }
    }
}

/// Side, place along it, grain and contact of each contact with a side.
fn contacts_along_sides(assembly: &Assembly) -> Vec<(usize, f64, u32, u32)> {
    let contacts = assembly.contacts.iter();
    let along_side = |(id, contact): (ContactId, &Contact)| match (contact.first, contact.second) {
        (Partner::Grain(grain), Partner::Side(side)) => {
            let &Side { start, end, .. } = &assembly.sides[side];
            let place = (contact.point - start).dot(end - start);
            Some((side.index(), place, grain.0, id.0))
        }
        _ => None,
    };
    contacts.filter_map(along_side).collect()
}

fn triangle_edges(assembly: &Assembly) -> Vec<TriangleEdge> {
    let mut edges: Vec<TriangleEdge> = Vec::with_capacity(3 * assembly.triangles.len());
    for (number, triangle) in assembly.triangles.iter().enumerate() {
        for corner in 0..3 {
            let (one, other) = (triangle[corner].0, triangle[(corner + 1) % 3].0);
            edges.push(([one.min(other), one.max(other)], number as u32));
        }
    }
    edges.sort_unstable();
    edges
}

/// The contacts between grains by their grains.
fn carried_edges(assembly: &Assembly) -> Vec<([u32; 2], u32)> {
    let contacts = assembly.contacts.iter();
    let between_grains =
        contacts.filter_map(|(id, contact)| match (contact.first, contact.second) {
            (Partner::Grain(one), Partner::Grain(other)) => {
                Some(([one.0.min(other.0), one.0.max(other.0)], id.0))
            }
            _ => None,
        });
    let mut carried: Vec<_> = between_grains.collect();
    carried.sort_unstable();
    carried
}
