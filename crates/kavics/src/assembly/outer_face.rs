//! The grains that the outside of the contact graph touches.

use crate::assembly::{Assembly, Partner};
use crate::ids::{GrainId, Id};

/// Grains on the outer face of the contact graph: those reached from outside without crossing a contact.
///
/// The outside lies beyond the hull of the triangles, and in each triangle that is entered through an edge without
/// contact. Grains of no triangle count too. In the order of the ids.
pub fn outer_grains(assembly: &Assembly) -> Vec<GrainId> {
    let edges = Edges::new(assembly);
    let mut outer = vec![true; assembly.grains.len()];
    for grain in assembly.triangles.iter().flatten() {
        outer[grain.index()] = false;
    }
    for (edge, _) in edges.hull() {
        for grain in edge {
            outer[grain.index()] = true;
        }
    }
    for triangle in edges.entered_from_outside(assembly) {
        for grain in assembly.triangles[triangle] {
            outer[grain.index()] = true;
        }
    }
    assembly
        .grains
        .ids()
        .filter(|grain| outer[grain.index()])
        .collect()
}

/// The edges of the triangles, each with its triangles, sorted by its grains; and the pairs in contact, sorted.
struct Edges {
    of_triangles: Vec<([GrainId; 2], usize)>,
    in_contact: Vec<[GrainId; 2]>,
}

impl Edges {
    fn new(assembly: &Assembly) -> Self {
        let mut of_triangles: Vec<_> = assembly
            .triangles
            .iter()
            .enumerate()
            .flat_map(|(index, &[a, b, c])| {
                [[a, b], [b, c], [c, a]].map(|[p, q]| ([p.min(q), p.max(q)], index))
            })
            .collect();
        of_triangles.sort_unstable();
        let mut in_contact: Vec<_> = assembly
            .contacts
            .values()
            .iter()
            .filter_map(|contact| match (contact.first, contact.second) {
                (Partner::Grain(a), Partner::Grain(b)) => Some([a.min(b), a.max(b)]),
                _ => None,
            })
            .collect();
        in_contact.sort_unstable();
        Self {
            of_triangles,
            in_contact,
        }
    }

    /// Edges with one triangle only.
    fn hull(&self) -> impl Iterator<Item = ([GrainId; 2], usize)> {
        let groups = self.of_triangles.chunk_by(|a, b| a.0 == b.0);
        groups
            .filter(|group| group.len() == 1)
            .map(|group| group[0])
    }

    /// The triangles of an edge without contact; none of one with.
    fn through(&self, edge: [GrainId; 2]) -> impl Iterator<Item = usize> {
        let open = self.in_contact.binary_search(&edge).is_err();
        let start = self
            .of_triangles
            .partition_point(|(other, _)| *other < edge);
        let same = self.of_triangles[start..]
            .iter()
            .take_while(move |(other, _)| open && *other == edge);
        same.map(|&(_, triangle)| triangle)
    }

    fn entered_from_outside(&self, assembly: &Assembly) -> Vec<usize> {
        let mut entered = vec![false; assembly.triangles.len()];
        let mut waiting: Vec<usize> = self
            .hull()
            .flat_map(|(edge, _)| self.through(edge))
            .collect();
        let mut found = Vec::new();
        while let Some(triangle) = waiting.pop() {
            if std::mem::replace(&mut entered[triangle], true) {
                continue;
            }
            found.push(triangle);
            let [a, b, c] = assembly.triangles[triangle];
            for [p, q] in [[a, b], [b, c], [c, a]] {
                waiting.extend(self.through([p.min(q), p.max(q)]));
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::{
        Between, Bodies, ContactGraph, Grain, Shaping, box_sides, contact_graph,
    };
    use crate::geometry::Vector;
    use crate::ids::{PerGrain, PerSide, PropertyId};

    /// Rows 4-3-4: the ends of the short row lie in notches of the block, and are outside all the same.
    #[test]
    fn the_ends_of_short_rows_are_outside() {
        let pitch = 3.0_f64.sqrt();
        let row = |count: u32, first: f64, y: f64| {
            (0..count).map(move |k| Grain {
                centre: Vector::new(first + 2.0 * f64::from(k), y),
                radius: 1.0,
            })
        };
        let grains: PerGrain<Grain> = row(4, 1.0, 1.0)
            .chain(row(3, 2.0, 1.0 + pitch))
            .chain(row(4, 1.0, 1.0 + 2.0 * pitch))
            .collect();
        let sides = box_sides(8.0, 2.0 + 2.0 * pitch, [false; 4]);
        let ContactGraph {
            sites,
            cell_area,
            triangles,
        } = contact_graph(
            &grains,
            &sides,
            Between::Touching,
            &PerSide::filled(0.0, 4),
            1e-7,
        );
        let bodies = Bodies {
            grains: &grains,
            sides: &sides,
        };
        let contacts = sites
            .iter()
            .map(|site| site.contact(Shaping::default(), bodies, PropertyId(0), 1.0))
            .collect();
        let assembly = Assembly {
            grains,
            sides,
            contacts,
            cell_area,
            triangles,
            thickness: 1.0,
        };
        let inner: Vec<u32> = vec![5];
        let outer: Vec<u32> = outer_grains(&assembly)
            .into_iter()
            .map(|grain| grain.0)
            .collect();
        assert!(
            (0..11).all(|grain| outer.contains(&grain) != inner.contains(&grain)),
            "{outer:?}"
        );
    }
}
