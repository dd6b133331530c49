//! Power diagram of discs in a convex container, and the regular triangulation that is dual to it.
//!
//! In: discs, a container, and pairs that are likely neighbours. Out: areas of the cells, edges, triangles.
//! A cell is all points whose power |x − x_i|² − R_i² is least with its disc i. Aurenhammer (1987).

use rayon::prelude::*;

use crate::geometry::Vector;
use crate::geometry::container::{Container, HalfPlane};
use crate::geometry::lifted::Lifted;
use crate::geometry::near_pairs::{DISCS_A_TASK, Disc, Grid, NearPair};
use crate::geometry::power_cell::{Cell, Line, SIDES};

/// Radical centres farther away than this many sizes of the container belong to triangles too flat to matter.
const OUTSIDE: f64 = 1e6;

/// Common edge of the cells of two discs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DualEdge {
    /// The disc with the lower number.
    pub first: u32,
    /// The other.
    pub second: u32,
    /// Its lengths on the side of −t and of +t of the line through the centres, `[length]`; n from first to second,
    /// t is n turned by a quarter turn. One may be negative.
    pub parts: [f64; 2],
}

/// Edge of a cell on a side of the container.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideEdge {
    /// The disc.
    pub disc: u32,
    /// The side.
    pub side: u32,
    /// Its lengths on the side of −t and of +t of the centre's foot, `[length]`; n is the side's outward normal.
    pub parts: [f64; 2],
}

/// Cells, edges and triangles of discs in a container.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PowerDiagram {
    /// Area of each cell, `[length²]`.
    pub cell_area: Vec<f64>,
    /// Edges between cells by (first, second); edges of no length may be among them.
    pub edges: Vec<DualEdge>,
    /// Edges on the container by (disc, side).
    pub side_edges: Vec<SideEdge>,
    /// Triangles, counter-clockwise, lowest number first, whose radical centre lies in the container or, to 1e-9 of
    /// its size, on its boundary.
    pub triangles: Vec<[u32; 3]>,
    /// The other triangles, up to the hull: their radical centre lies outside the container, but no farther than a
    /// million times its size.
    pub outer_triangles: Vec<[u32; 3]>,
}

/// The power diagram of discs in a container.
///
/// `near` speeds it up: pairs that are likely neighbours, by (first, second), such as all discs that touch.
/// The same bits on any number of threads; degenerate vertices are split the same way by all cells that meet there.
pub fn power_diagram(
    centres: &[Vector],
    radii: &[f64],
    container: &Container,
    near: &[NearPair],
) -> PowerDiagram {
    // A power of two as unit of length: exact, and no product can overflow.
    let unit = f64::from_bits(container.size().to_bits() & (0x7ff << 52));
    let unit = if unit.is_normal() { unit } else { 1.0 };
    let scale = 1.0 / unit;
    let centres: Vec<Vector> = centres.iter().map(|&x| x * scale).collect();
    let radii: Vec<f64> = radii.iter().map(|&r| r * scale).collect();
    let clipping = Clipping::new(&centres, &radii, container.scaled(scale), near);
    let tasks: Vec<(PowerDiagram, Vec<u32>)> = clipping
        .grid
        .discs
        .par_chunks(DISCS_A_TASK)
        .map(|discs| clipping.cells(discs))
        .collect();
    let mut diagram = PowerDiagram::default();
    let mut at_boundary = Vec::new();
    for (task, outer) in tasks {
        diagram.append(task, unit);
        at_boundary.extend(outer);
    }
    diagram.outer_triangles = clipping.outer_triangles(&at_boundary);
    diagram
}

impl PowerDiagram {
    fn append(&mut self, task: Self, unit: f64) {
        let area = |a: f64| a * unit * unit;
        self.cell_area.extend(task.cell_area.into_iter().map(area));
        let length = |parts: [f64; 2]| parts.map(|p| p * unit);
        self.edges.extend(task.edges.into_iter().map(|e| DualEdge {
            parts: length(e.parts),
            ..e
        }));
        let side_edges = task.side_edges.into_iter().map(|e| SideEdge {
            parts: length(e.parts),
            ..e
        });
        self.side_edges.extend(side_edges);
        self.triangles.extend(task.triangles);
    }
}

/// All that the cells are cut from.
struct Clipping<'a> {
    container: Container,
    size: f64,
    grid: Grid,
    lifted: Lifted<'a>,
    neighbours: Neighbours,
}

impl<'a> Clipping<'a> {
    fn new(centres: &'a [Vector], radii: &[f64], container: Container, near: &[NearPair]) -> Self {
        Self {
            size: container.size(),
            grid: Grid::new(centres, radii),
            lifted: Lifted::new(centres, radii, container.middle()),
            neighbours: Neighbours::new(centres.len(), near),
            container,
        }
    }

    /// Cells, edges and inner triangles of some discs, and those whose cells meet the container.
    fn cells(&self, discs: &[Disc]) -> (PowerDiagram, Vec<u32>) {
        let mut cell = Cell::default();
        let (mut diagram, mut at_boundary) = (PowerDiagram::default(), Vec::new());
        for disc in discs {
            self.cut_out(disc, &mut cell);
            self.collect_triangles(disc, &cell, true, &mut diagram.triangles);
            if cell.edges.iter().any(|edge| !edge.line.is_disc()) {
                at_boundary.push(disc.index);
            }
            self.clip_by_sides(disc, &mut cell);
            diagram.cell_area.push(cell.area());
            collect_edges(disc, &cell, &mut diagram);
        }
        (diagram, at_boundary)
    }

    /// The triangles with their radical centre outside the container. Cells that meet there reach through the
    /// container's boundary, each from its own centre, so only those can own or cut one.
    fn outer_triangles(&self, at_boundary: &[u32]) -> Vec<[u32; 3]> {
        let of_disc = |cell: &mut Cell, &index: &u32| {
            let disc = &self.grid.discs[index as usize];
            self.start(disc, OUTSIDE * self.size, cell);
            let near = self.neighbours.of(index).iter().chain(at_boundary);
            near.for_each(|&other| self.cut(disc, &self.grid.discs[other as usize], cell));
            let mut triangles = Vec::new();
            self.collect_triangles(disc, cell, false, &mut triangles);
            triangles
        };
        let triangles = at_boundary.par_iter().map_init(Cell::default, of_disc);
        triangles.collect::<Vec<_>>().concat()
    }

    /// The cell of a disc in the container grown a little, so that radical centres on its boundary are not lost.
    fn cut_out(&self, disc: &Disc, cell: &mut Cell) {
        self.start(disc, 1e-6 * self.size, cell);
        for &other in self.neighbours.of(disc.index) {
            self.cut(disc, &self.grid.discs[other as usize], cell);
        }
        for level in &self.grid.levels {
            let grown = level.largest_radius * level.largest_radius - disc.radius * disc.radius;
            let mut done = 0.0;
            loop {
                // A disc at distance D has its radical axis no nearer than (D² + R² − R_max²)/2D.
                let farthest = cell.farthest_squared;
                let reach = farthest.sqrt() + (farthest + grown).max(0.0).sqrt();
                let reach = reach * (1.0 + 1e-6);
                if cell.edges.is_empty() || reach <= done || reach.is_nan() {
                    break;
                }
                let step = if done == 0.0 {
                    2.0 * (disc.radius + 2.0 * level.largest_radius)
                } else {
                    2.0 * done
                };
                let distance = if step > 0.0 { reach.min(step) } else { reach };
                for other in level.around(disc.centre, distance).flatten() {
                    self.cut(disc, other, cell);
                }
                done = distance;
            }
        }
    }

    /// The container, grown by a margin, as the first cell of a disc.
    fn start(&self, disc: &Disc, margin: f64, cell: &mut Cell) {
        let container = &self.container;
        let around = &container.around;
        let normal = |k: usize| container.sides[around[k % around.len()] as usize].outward;
        let polygon = around.iter().zip(&container.corners).enumerate();
        cell.reset(polygon.map(|(k, (&side, &corner))| {
            let outward = normal(k);
            let distance = container.sides[side as usize].distance(disc.centre) + margin;
            let before = normal(k + around.len() - 1);
            // Both sides move out by the margin.
            let shift = (before + outward) * (margin / (1.0 + before.dot(outward)));
            let line = Line::side(outward, distance, side);
            (line, corner - disc.centre + shift)
        }));
    }

    fn cut(&self, disc: &Disc, other: &Disc, cell: &mut Cell) {
        let line = Line::between(disc, other, self.lifted.noise);
        if line.is_beyond(cell.farthest_squared) || other.index == disc.index {
            return;
        }
        if other.centre == disc.centre {
            let larger = other.radius > disc.radius;
            if larger || (other.radius == disc.radius && other.index < disc.index) {
                cell.clear();
            }
        } else if cell.edges.iter().all(|e| e.line.tag != other.index) {
            cell.cut(&line, disc.index, &self.lifted);
        }
    }

    fn clip_by_sides(&self, disc: &Disc, cell: &mut Cell) {
        for (k, side) in self.container.sides.iter().enumerate() {
            let line = Line::side(side.outward, side.distance(disc.centre), k as u32);
            if !line.is_beyond(cell.farthest_squared) {
                cell.clip(&line);
            }
        }
    }

    /// The triangles that a disc owns, with their radical centre in the container or outside it.
    fn collect_triangles(
        &self,
        disc: &Disc,
        cell: &Cell,
        within: bool,
        triangles: &mut Vec<[u32; 3]>,
    ) {
        let tolerance = 1e-9 * self.size;
        let before = triangles.len();
        for (a, b, point) in cell.radical_centres() {
            let point = disc.centre + point;
            let inside = |side: &HalfPlane| side.distance(point) >= -tolerance;
            if disc.index < a.min(b) && self.container.sides.iter().all(inside) == within {
                triangles.push([disc.index, a, b]);
            }
        }
        triangles[before..].sort_unstable();
    }
}

/// The edges of a clipped cell: with discs of higher numbers, and with sides.
fn collect_edges(disc: &Disc, cell: &Cell, diagram: &mut PowerDiagram) {
    let (edges, sides) = (diagram.edges.len(), diagram.side_edges.len());
    for (m, edge) in cell.edges.iter().enumerate() {
        let tag = edge.line.tag;
        if tag >= SIDES {
            diagram.side_edges.push(SideEdge {
                disc: disc.index,
                side: tag - SIDES,
                parts: cell.parts(m),
            });
        } else if tag > disc.index {
            diagram.edges.push(DualEdge {
                first: disc.index,
                second: tag,
                parts: cell.parts(m),
            });
        }
    }
    diagram.edges[edges..].sort_unstable_by_key(|e| e.second);
    diagram.side_edges[sides..].sort_unstable_by_key(|e| e.side);
}

/// The likely neighbours of each disc.
struct Neighbours {
    start: Vec<u32>,
    others: Vec<u32>,
}

impl Neighbours {
    fn new(count: usize, near: &[NearPair]) -> Self {
        let mut start = vec![0_u32; count + 1];
        for pair in near {
            start[pair.first as usize + 1] += 1;
            start[pair.second as usize + 1] += 1;
        }
        for i in 0..count {
            start[i + 1] += start[i];
        }
        let mut next = start.clone();
        let mut others = vec![0; 2 * near.len()];
        for pair in near {
            for (one, other) in [(pair.first, pair.second), (pair.second, pair.first)] {
                let place = &mut next[one as usize];
                others[*place as usize] = other;
                *place += 1;
            }
        }
        Self { start, others }
    }

    fn of(&self, disc: u32) -> &[u32] {
        let disc = disc as usize;
        &self.others[self.start[disc] as usize..self.start[disc + 1] as usize]
    }
}
