//! Which bodies meet, and the dual graph: from grains and sides to contact sites, power cells and triangles.

use rayon::prelude::*;

use crate::assembly::{Contact, Grain, Partner, Side, container};
use crate::geometry::{
    Disc, DualEdge, Edges, Grid, PowerDiagram, SideEdge, Vector, lowest_first, power_diagram_of,
    spatial_order,
};
use crate::ids::{GrainId, Id, PerGrain, PerSide, PropertyId, SideId};

/// Which pairs of grains carry a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Between {
    /// Grains that touch.
    #[default]
    Touching,
    /// Every pair with a common edge of the power diagram.
    Neighbours,
}

/// The dual length that a stiffness uses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum DualLength {
    /// Each part of the edge at most √(R_i·R_j), at a side at most R.
    #[default]
    Capped,
    /// The edge of the power diagram as it is.
    Full,
    /// A number, the same for every contact, half on each side of the contact point, `[length]`.
    Number(f64),
}

/// Where on the dual edge the contact force acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactPoint {
    /// On the line between the centres.
    #[default]
    Tangent,
    /// In the middle of the dual edge.
    Midpoint,
}

/// Where two bodies meet: geometry alone, before it is given a contact property.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// First partner: a grain, of two grains the one with the lower id.
    pub first: Partner,
    /// Second partner.
    pub second: Partner,
    /// Unit normal n from first to second.
    pub normal: Vector,
    /// Distance of the centres, or for a side the radius, `[length]`.
    pub branch_length: f64,
    /// The dual edge on the side of −t and of +t of the tangent point, `[length]`; one may be negative
    /// between grains that do not touch.
    pub edge_parts: [f64; 2],
    /// Distance between the surfaces; negative: overlap, `[length]`.
    pub gap: f64,
}

/// Sites, power cells and triangles of grains in a container.
#[derive(Clone, Debug, Default)]
pub struct ContactGraph {
    /// Between grains by (first, second), then those with sides by (first, second).
    pub sites: Vec<Site>,
    /// Area of each grain's power cell within the container, `[length²]`.
    pub cell_area: PerGrain<f64>,
    /// Triangles of the regular triangulation up to its hull, counter-clockwise, lowest id first; those with their
    /// power centre in the container come first.
    pub triangles: Vec<[GrainId; 3]>,
}

/// How a contact property shapes a contact at its site.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shaping {
    /// Dual length for the stiffness.
    pub dual_length: DualLength,
    /// Contact point.
    pub contact_point: ContactPoint,
}

/// Edges shorter than this share of the mean radius count as no edge.
const NO_LENGTH: f64 = 1e-9;
/// Grains nearer than this share of the mean radius are likely neighbours in the power diagram.
const LIKELY: f64 = 1e-3;

/// The contact graph of grains between the sides of a convex container, and its dual.
///
/// Two grains touch where their gap is at most `touching_tolerance`, and touching grains always have a site. A grain
/// is joined to a present side where its gap is at most `reach` of that side or the tolerance, and its power cell has
/// an edge on the side within the grain's shadow. All sides bound the power diagram, present or not. Lengths in `[length]`.
/// Bojtár & Bagi (1989): the common tangents are the dual graph; as power diagram after Gellatly & Finney (1982).
pub fn contact_graph(
    grains: &PerGrain<Grain>,
    sides: &PerSide<Side>,
    between: Between,
    reach: &PerSide<f64>,
    touching_tolerance: f64,
) -> ContactGraph {
    let container = container(sides);
    let unit = container.unit();
    let discs = grains.values();
    let mean_radius = discs.iter().map(|g| g.radius).sum::<f64>() / discs.len().max(1) as f64;
    // Neighbours get near numbers; the caller's come back with the sites.
    let order = spatial_order(discs.iter().map(|grain| &grain.centre));
    let scale = 1.0 / unit;
    let disc = |(&id, place): (&u32, u32)| Disc {
        centre: discs[id as usize].centre * scale,
        radius: discs[id as usize].radius * scale,
        index: place,
    };
    let grid = Grid::of_discs(order.iter().zip(0..).map(disc).collect());
    // Edges of neighbours that nearly touch help to find the others.
    let (near, edges) = match between {
        Between::Touching => (touching_tolerance, Edges::OfNearPairs),
        Between::Neighbours => (touching_tolerance.max(LIKELY * mean_radius), Edges::All),
    };
    let near = grid.near_pairs_by_cells(scale * near);
    let mut diagram = power_diagram_of(&grid, &container.scaled(scale), &near, edges);
    let choice = Choice {
        grains,
        sides,
        order: &order,
        unit,
        between,
        reach,
        touching_tolerance,
        no_length: NO_LENGTH * mean_radius,
    };
    let edges = choice.edges(&mut diagram);
    let (at_sides, cell_area) = (choice.at_sides(&diagram), cell_area(&diagram, &order, unit));
    let (sites, triangles) = rayon::join(
        || choice.sites(&edges, at_sides),
        || triangles(diagram, &order),
    );
    ContactGraph {
        sites,
        cell_area,
        triangles,
    }
}

/// The triangles by the ids of their grains, lowest first.
fn triangles(mut diagram: PowerDiagram, order: &[u32]) -> Vec<[GrainId; 3]> {
    let own =
        |triangle: [u32; 3]| lowest_first(triangle.map(|place| order[place as usize])).map(GrainId);
    diagram.triangles.append(&mut diagram.outer_triangles);
    diagram.triangles.into_iter().map(own).collect()
}

fn cell_area(diagram: &PowerDiagram, order: &[u32], unit: f64) -> PerGrain<f64> {
    let mut areas = PerGrain::filled(0.0, order.len());
    for (&id, area) in order.iter().zip(&diagram.cell_area) {
        areas[GrainId(id)] = area * unit * unit;
    }
    areas
}

/// What makes a site of a near pair or an edge.
struct Choice<'a> {
    grains: &'a PerGrain<Grain>,
    sides: &'a PerSide<Side>,
    /// The id of the grain at each place.
    order: &'a [u32],
    /// Length of the diagram's unit, `[length]`.
    unit: f64,
    between: Between,
    reach: &'a PerSide<f64>,
    touching_tolerance: f64,
    no_length: f64,
}

impl Choice<'_> {
    /// Between grains by (first, second), then those with sides by (first, second).
    fn sites(&self, edges: &[DualEdge], mut at_sides: Vec<Site>) -> Vec<Site> {
        at_sides.sort_unstable_by_key(|site| (site.first, site.second));
        let site = |&[_, edge]: &[u32; 2]| self.site(&self.joint(&edges[edge as usize]));
        let mut sites = Vec::with_capacity(edges.len() + at_sides.len());
        sites.par_extend(self.sorted(edges).par_iter().map(site));
        sites.append(&mut at_sides);
        sites
    }

    /// The edges by the ids of their grains, as the higher id and the number of the edge: counting sort by the lower
    /// id, then each grain's own.
    fn sorted(&self, edges: &[DualEdge]) -> Vec<[u32; 2]> {
        let id = |place: u32| self.order[place as usize];
        let lower = |edge: &DualEdge| id(edge.first).min(id(edge.second)) as usize;
        let mut start = vec![0_u32; self.grains.len() + 1];
        for edge in edges {
            start[lower(edge) + 1] += 1;
        }
        for grain in 1..start.len() {
            start[grain] += start[grain - 1];
        }
        let mut sorted = vec![[0; 2]; edges.len()];
        for (number, edge) in (0..).zip(edges) {
            // Starts move to the ends.
            let place = &mut start[lower(edge)];
            sorted[*place as usize] = [id(edge.first).max(id(edge.second)), number];
            *place += 1;
        }
        let mut own = &mut sorted[..];
        let mut begin = 0;
        for &end in &start[..self.grains.len()] {
            let (now, rest) = own.split_at_mut((end - begin) as usize);
            now.sort_unstable();
            (own, begin) = (rest, end);
        }
        sorted
    }

    /// The edges that carry a contact, and touching pairs without edge.
    fn edges(&self, diagram: &mut PowerDiagram) -> Vec<DualEdge> {
        let mut edges = std::mem::take(&mut diagram.near_edges);
        if self.between == Between::Neighbours {
            // Without neighbours, the near pairs are those that touch.
            edges.retain(|edge| !self.has_length(edge) && self.touches(edge));
            let all = std::mem::take(&mut diagram.edges);
            edges.extend(all.into_iter().filter(|edge| self.has_length(edge)));
        }
        edges
    }

    fn touches(&self, edge: &DualEdge) -> bool {
        self.site(&self.joint(edge)).gap <= self.touching_tolerance
    }

    /// An edge between two places, by the ids of their grains, the lower first.
    fn joint(&self, edge: &DualEdge) -> DualEdge {
        let [a, b] = [edge.first, edge.second].map(|place| self.order[place as usize]);
        let [before, after] = edge.parts.map(|part| part * self.unit);
        // Seen from the other grain, n and t are reversed.
        let parts = if a < b {
            [before, after]
        } else {
            [after, before]
        };
        DualEdge {
            first: a.min(b),
            second: a.max(b),
            parts,
        }
    }

    fn has_length(&self, edge: &DualEdge) -> bool {
        (edge.parts[0] + edge.parts[1]) * self.unit > self.no_length
    }

    fn site(&self, joint: &DualEdge) -> Site {
        let (first, second) = (GrainId(joint.first), GrainId(joint.second));
        let (a, b) = (self.grains[first], self.grains[second]);
        let branch = b.centre - a.centre;
        let l = branch.length();
        // Coincident centres, which the scene refuses, still get a finite site.
        let normal = if l > 0.0 {
            branch * (1.0 / l)
        } else {
            Vector::new(1.0, 0.0)
        };
        Site {
            first: Partner::Grain(first),
            second: Partner::Grain(second),
            normal,
            branch_length: l,
            edge_parts: joint.parts,
            gap: l - (a.radius + b.radius),
        }
    }

    fn at_sides(&self, diagram: &PowerDiagram) -> Vec<Site> {
        let site = |edge: &SideEdge| self.site_at_side(edge);
        diagram.side_edges.iter().filter_map(site).collect()
    }

    fn site_at_side(&self, edge: &SideEdge) -> Option<Site> {
        let grain = GrainId(self.order[edge.disc as usize]);
        let id = SideId::from_index(edge.side as usize);
        let (Grain { centre, radius }, side) = (self.grains[grain], &self.sides[id]);
        let gap = side.distance(centre) - radius;
        // A cell that meets the side only beside its grain's shadow gives no dual length there.
        let parts = edge.parts.map(|part| part * self.unit);
        let shadow: f64 = parts.iter().map(|part| part.clamp(-radius, radius)).sum();
        let joined = side.present
            && gap <= self.reach[id].max(self.touching_tolerance)
            && shadow > self.no_length;
        joined.then_some(Site {
            first: Partner::Grain(grain),
            second: Partner::Side(id),
            normal: side.outward,
            branch_length: radius,
            edge_parts: parts,
            gap,
        })
    }
}

impl Site {
    /// Where the dual edge's line meets the branch; for a side the grain's point nearest to it, `[length]`.
    pub fn tangent_point(&self, grains: &PerGrain<Grain>) -> Vector {
        let grain = |partner| match partner {
            Partner::Grain(grain) => Some(grains[grain]),
            Partner::Side(_) => None,
        };
        let l = self.branch_length;
        let along = match (grain(self.first), grain(self.second)) {
            (Some(a), Some(b)) if l > 0.0 => {
                0.5 * (l + (a.radius - b.radius) * (a.radius + b.radius) / l)
            }
            (Some(_), Some(_)) => 0.0,
            _ => l,
        };
        let centre = grain(self.first).map_or(Vector::default(), |grain| grain.centre);
        centre + self.normal * along
    }

    /// The contact that a contact property makes of this site.
    ///
    /// Capped, a part of the dual edge reaches at most g = √(R_i·R_j) from the tangent point, at a side g = R: where
    /// the tangent meets the hull of the two grains, so that s does not depend on the box.
    pub fn contact(
        &self,
        shaping: Shaping,
        grains: &PerGrain<Grain>,
        property: PropertyId,
        strength_factor: f64,
    ) -> Contact {
        let g = self.cap(grains);
        let kept = match shaping.dual_length {
            DualLength::Capped => self.edge_parts.map(|part| part.clamp(-g, g)),
            DualLength::Full | DualLength::Number(_) => self.edge_parts,
        };
        let s = match shaping.dual_length {
            DualLength::Number(s) => s,
            DualLength::Capped | DualLength::Full => kept[0] + kept[1],
        };
        let halves = [0.5 * s; 2];
        let (point, dual_parts) = match (shaping.contact_point, shaping.dual_length) {
            (ContactPoint::Tangent, DualLength::Number(_)) => (self.tangent_point(grains), halves),
            (ContactPoint::Tangent, _) => (self.tangent_point(grains), kept),
            (ContactPoint::Midpoint, _) => {
                let offset = 0.5 * (kept[1] - kept[0]);
                let tangent = self.normal.quarter_turn();
                (self.tangent_point(grains) + tangent * offset, halves)
            }
        };
        Contact {
            first: self.first,
            second: self.second,
            normal: self.normal,
            branch_length: self.branch_length,
            point,
            dual_parts,
            dual_length_full: self.edge_parts[0] + self.edge_parts[1],
            property,
            strength_factor,
        }
    }

    /// The length g of the cap.
    fn cap(&self, grains: &PerGrain<Grain>) -> f64 {
        let radius = |partner| match partner {
            Partner::Grain(grain) => Some(grains[grain].radius),
            Partner::Side(_) => None,
        };
        match (radius(self.first), radius(self.second)) {
            (Some(a), Some(b)) => (a * b).sqrt(),
            (Some(r), None) | (None, Some(r)) => r,
            (None, None) => f64::INFINITY,
        }
    }
}
