//! Which bodies meet, and the dual graph: from grains and sides to contact sites, power cells and triangles.

use rayon::prelude::*;

use crate::assembly::{Bodies, Grain, Partner, Side, Site, container};
use crate::geometry::{Disc, DualEdge, DualGraph, Edges, Grid, Near, SideEdge, lowest_first};
use crate::ids::{GrainId, Id, PerGrain, PerSide, SideId};

/// Which pairs of grains carry a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Between {
    /// Grains that touch.
    #[default]
    Touching,
    /// Every pair with a common edge of the power diagram.
    Neighbours,
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

/// Edges shorter than this share of the mean radius count as no edge.
const NO_LENGTH: f64 = 1e-9;
/// Grains nearer than this share of the mean radius are likely neighbours in the power diagram.
const LIKELY: f64 = 1e-3;
/// Grains that one task looks at.
const GRAINS_A_TASK: usize = 16_384;

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
    let scale = 1.0 / unit;
    let disc = |index: u32| Disc {
        centre: discs[index as usize].centre * scale,
        radius: discs[index as usize].radius * scale,
        index,
    };
    // Neighbours get near numbers; the caller's come back with the sites.
    let (grid, order) = Grid::of(discs.len(), disc);
    let grid = grid.known_by_places();
    // Edges of neighbours that nearly touch help to find the others.
    let (near, edges) = match between {
        Between::Touching => (touching_tolerance, Edges::OfNearPairs),
        Between::Neighbours => (touching_tolerance.max(LIKELY * mean_radius), Edges::All),
    };
    let near = Near::within(&grid, scale * near);
    let dual = DualGraph::new(&grid, &container.scaled(scale), near, edges);
    let choice = Choice {
        bodies: Bodies { grains, sides },
        dual: &dual,
        order: &order,
        unit,
        reach,
        touching_tolerance,
        no_length: NO_LENGTH * mean_radius,
    };
    let (sites, triangles) = rayon::join(|| choice.sites(between), || triangles(&dual, &order));
    ContactGraph {
        sites,
        cell_area: cell_area(&dual, &order, unit),
        triangles,
    }
}

/// The triangles by the ids of their grains, lowest first.
fn triangles(dual: &DualGraph<'_>, order: &[u32]) -> Vec<[GrainId; 3]> {
    let own =
        |triangle: [u32; 3]| lowest_first(triangle.map(|place| order[place as usize])).map(GrainId);
    let mut triangles = Vec::with_capacity(dual.most_triangles());
    triangles.extend(dual.inner_triangles().map(own));
    triangles.extend(dual.outer_triangles().map(own));
    triangles
}

fn cell_area(dual: &DualGraph<'_>, order: &[u32], unit: f64) -> PerGrain<f64> {
    let mut areas = PerGrain::filled(0.0, order.len());
    for (&id, area) in order.iter().zip(dual.cell_areas()) {
        areas[GrainId(id)] = area * unit * unit;
    }
    areas
}

/// What makes a site of a near pair or an edge.
struct Choice<'a> {
    bodies: Bodies<'a>,
    dual: &'a DualGraph<'a>,
    /// The id of the grain at each place.
    order: &'a [u32],
    /// Length of the diagram's unit, `[length]`.
    unit: f64,
    reach: &'a PerSide<f64>,
    touching_tolerance: f64,
    no_length: f64,
}

/// Grains with consecutive ids.
struct Task {
    /// The lowest id.
    first: usize,
    /// Their places, rising: what is near in memory is looked at together.
    places: Vec<u32>,
    /// Where the sites of each of them start, and their number at the end.
    start: Vec<u32>,
}

impl Task {
    fn sites(&self) -> usize {
        self.start[self.start.len() - 1] as usize
    }
}

impl Choice<'_> {
    /// Between grains by (first, second), then those with sides by (first, second).
    fn sites(&self, between: Between) -> Vec<Site> {
        let mut sites = match between {
            Between::Touching => self.touching(),
            Between::Neighbours => self.neighbours(),
        };
        let between_grains = sites.len();
        let site = |edge: &SideEdge| self.site_at_side(edge);
        sites.extend(self.dual.side_edges().iter().filter_map(site));
        sites[between_grains..].sort_unstable_by_key(|site| (site.first, site.second));
        sites
    }

    /// The sites of the near pairs: those that touch.
    fn touching(&self) -> Vec<Site> {
        let mut tasks = self.tasks();
        tasks.par_iter_mut().for_each(|task| self.count(task));
        let total = tasks.iter().map(Task::sites).sum();
        // Few grains touch a side.
        let mut sites = Vec::with_capacity(total + total / 64 + 1024);
        sites.par_extend((0..total).into_par_iter().map(|_| Site::NOTHING));
        let mut rest = &mut sites[..];
        let mut parts = Vec::with_capacity(tasks.len());
        for task in tasks {
            let own;
            (own, rest) = rest.split_at_mut(task.sites());
            parts.push((task, own));
        }
        let fill = |(task, own): (Task, &mut [Site])| self.fill(&task, own);
        parts.into_par_iter().for_each(fill);
        sites
    }

    /// The grains of each task.
    fn tasks(&self) -> Vec<Task> {
        let count = self.order.len();
        let task = |first: usize| Task {
            first,
            places: Vec::with_capacity(GRAINS_A_TASK),
            start: vec![0; GRAINS_A_TASK.min(count - first) + 1],
        };
        let mut tasks: Vec<Task> = (0..count).step_by(GRAINS_A_TASK).map(task).collect();
        for (place, &id) in (0..).zip(self.order) {
            tasks[id as usize / GRAINS_A_TASK].places.push(place);
        }
        tasks
    }

    /// Where the sites of each grain of a task start.
    fn count(&self, task: &mut Task) {
        for &place in &task.places {
            let own = self.order[place as usize] as usize - task.first;
            task.start[own + 1] = self.higher(place).count() as u32;
        }
        for own in 1..task.start.len() {
            task.start[own] += task.start[own - 1];
        }
    }

    /// The touching sites of the grains of a task.
    fn fill(&self, task: &Task, sites: &mut [Site]) {
        let mut higher: Vec<(u32, u32)> = Vec::new();
        for &place in &task.places {
            let start = task.start[self.order[place as usize] as usize - task.first];
            higher.clear();
            for near in self.higher(place) {
                let after = higher.iter().rposition(|other| *other < near);
                higher.insert(after.map_or(0, |after| after + 1), near);
            }
            for (site, (_, name)) in sites[start as usize..].iter_mut().zip(&higher) {
                *site = self.site_of_near(place, *name);
            }
        }
    }

    /// The near pairs of the grain at a place with those of higher ids: the id, and the name of the pair.
    fn higher(&self, place: u32) -> impl Iterator<Item = (u32, u32)> {
        let id = self.order[place as usize];
        let near = self.dual.near_of(place);
        let by_id = near.map(|(other, name)| (self.order[other as usize], name));
        by_id.filter(move |(other, _)| *other > id)
    }

    fn site_of_near(&self, place: u32, name: u32) -> Site {
        let (other, parts) = self.dual.near_edge(place, name);
        self.site(place, other, parts)
    }

    /// The sites of all edges, and of touching pairs without edge.
    fn neighbours(&self) -> Vec<Site> {
        let site = |edge: &DualEdge| self.site(edge.first, edge.second, edge.parts);
        let has_length = |site: &Site| site.edge_parts[0] + site.edge_parts[1] > self.no_length;
        let mut sites: Vec<Site> = self
            .dual
            .edges
            .iter()
            .map(site)
            .filter(has_length)
            .collect();
        for place in 0..self.order.len() as u32 {
            let near = self
                .higher(place)
                .map(|(_, name)| self.site_of_near(place, name));
            let touches = |site: &Site| site.branch(self.bodies).gap <= self.touching_tolerance;
            sites.extend(near.filter(|site| !has_length(site) && touches(site)));
        }
        sites.par_sort_unstable_by_key(|site| (site.first, site.second));
        sites
    }

    /// The site between the grains at two places, of their common edge's parts as seen from the first.
    fn site(&self, from: u32, to: u32, parts: [f64; 2]) -> Site {
        let [a, b] = [from, to].map(|place| self.order[place as usize]);
        let [before, after] = parts.map(|part| part * self.unit);
        // Seen from the other grain, n and t are reversed.
        let edge_parts = if a < b {
            [before, after]
        } else {
            [after, before]
        };
        Site {
            first: Partner::Grain(GrainId(a.min(b))),
            second: Partner::Grain(GrainId(a.max(b))),
            edge_parts,
        }
    }

    fn site_at_side(&self, edge: &SideEdge) -> Option<Site> {
        let grain = GrainId(self.order[edge.disc as usize]);
        let id = SideId::from_index(edge.side as usize);
        let (Grain { centre, radius }, side) = (self.bodies.grains[grain], &self.bodies.sides[id]);
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
            edge_parts: parts,
        })
    }
}
