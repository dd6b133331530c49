//! Power cells cut out one by one: a cell starts as the container and every disc near enough cuts a part away.

use rayon::prelude::*;

use crate::geometry::container::{Container, HalfPlane};
use crate::geometry::embedding::Embedding;
use crate::geometry::face::Triangulation;
use crate::geometry::faces::{Faces, fingerprint, lowest_first};
use crate::geometry::lifted::Lifted;
use crate::geometry::near_pairs::{Disc, Grid};
use crate::geometry::outer_triangles::{Gap, outer_triangles};
use crate::geometry::power_cell::{Cell, Line, SIDES};
use crate::geometry::power_diagram::{DualEdge, PowerDiagram, SideEdge};

/// Discs whose cells one task cuts; fixed, so that the result does not depend on the number of threads.
const DISCS_A_TASK: usize = 256;
/// Radical centres farther away than this many sizes of the container belong to triangles too flat to matter.
const OUTSIDE: f64 = 1e6;

/// Cells that were cut out one by one.
#[derive(Default)]
pub(super) struct CutOut {
    /// The discs, rising.
    pub(super) discs: Vec<u32>,
    /// Their areas.
    pub(super) areas: Vec<f64>,
    /// Edges, side edges and inner triangles of which they have the lowest number.
    pub(super) diagram: PowerDiagram,
    /// Those whose cells meet the container.
    at_boundary: Vec<u32>,
    /// Where triangles are missing around them.
    gaps: Vec<Gap>,
}

/// One cell that was cut out.
#[derive(Default)]
struct CutCell {
    disc: u32,
    area: f64,
    diagram: PowerDiagram,
    neighbours: Vec<u32>,
    fingerprint: u64,
    gaps: Vec<Gap>,
    at_boundary: bool,
}

/// All that the cells are cut from.
pub(super) struct Clipping<'a> {
    pub(super) container: &'a Container,
    pub(super) size: f64,
    pub(super) grid: &'a Grid,
    pub(super) lifted: &'a Lifted<'a>,
}

impl Clipping<'_> {
    /// Cuts out the cells of the open discs, and of those around them that then turn out to be wrong.
    pub(super) fn open_cells(
        &self,
        faces: &mut Faces,
        triangulation: &Triangulation<'_>,
    ) -> CutOut {
        let graph = triangulation.graph;
        let all = 0..self.grid.discs.len() as u32;
        let mut wanted: Vec<u32> = all.filter(|&i| faces.open[i as usize]).collect();
        let mut cut: Vec<CutCell> = Vec::new();
        while !wanted.is_empty() {
            let mut doubted = Vec::new();
            for cell in self.cells(&wanted, graph) {
                let open = &mut faces.open[cell.disc as usize];
                if *open || triangulation.fingerprint_at(cell.disc) != cell.fingerprint {
                    doubted.extend_from_slice(&cell.neighbours);
                }
                *open = true;
                cut.push(cell);
            }
            doubted.sort_unstable();
            doubted.dedup();
            wanted = doubted;
            wanted.retain(|&disc| !faces.open[disc as usize]);
        }
        cut.sort_unstable_by_key(|cell| cell.disc);
        let mut out = CutOut::default();
        for cell in cut {
            out.add(cell);
        }
        out
    }

    fn cells(&self, discs: &[u32], graph: &Embedding) -> Vec<CutCell> {
        let tasks = discs.par_chunks(DISCS_A_TASK).map(|discs| {
            let mut cell = Cell::default();
            let cut = |&disc| self.cell(&self.grid.discs[disc as usize], graph, &mut cell);
            discs.iter().map(cut).collect::<Vec<_>>()
        });
        tasks.collect::<Vec<_>>().into_iter().flatten().collect()
    }

    fn cell(&self, disc: &Disc, graph: &Embedding, cell: &mut Cell) -> CutCell {
        let mut cut = CutCell {
            disc: disc.index,
            ..CutCell::default()
        };
        self.start(disc, 1e-6 * self.size, cell);
        self.cut_out(disc, graph, self.grid, cell);
        self.collect_triangles(disc, cell, &mut cut.diagram);
        cut.gaps = gaps(disc.index, cell);
        for (a, b, _) in cell.radical_centres() {
            let own = fingerprint(lowest_first([disc.index, a, b]));
            cut.fingerprint = cut.fingerprint.wrapping_add(own);
        }
        let lines = cell.edges.iter().map(|edge| &edge.line);
        let neighbours = lines.filter(|line| line.is_disc()).map(|line| line.tag);
        cut.neighbours = neighbours.collect();
        cut.at_boundary = cut.neighbours.len() < cell.edges.len();
        self.clip_by_sides(disc, cell);
        cut.area = cell.area();
        collect_edges(disc, cell, &mut cut.diagram);
        cut
    }

    /// Adds the triangles with their radical centre beyond the container that no cell within it knows.
    pub(super) fn add_outer_triangles(&self, cut: &mut CutOut, graph: &Embedding) {
        let gaps = std::mem::take(&mut cut.gaps);
        // Cells of discs in a row never meet three by three, and reach as far as one looks.
        if self.is_row(&cut.at_boundary) {
            return;
        }
        let middle = self.container.middle();
        let within = OUTSIDE * self.size;
        if let Some(found) = outer_triangles(gaps, &self.grid.discs, self.lifted) {
            let near = found
                .iter()
                .filter(|t| (t.centre - middle).length() < within);
            let turned = near.map(|triangle| lowest_first(triangle.discs));
            cut.diagram.outer_triangles.extend(turned);
        } else {
            cut.diagram.outer_triangles = self.far_triangles(&cut.at_boundary, graph);
        }
    }

    fn is_row(&self, discs: &[u32]) -> bool {
        let mut centres = discs
            .iter()
            .map(|&disc| self.grid.discs[disc as usize].centre);
        let (Some(first), Some(second)) = (centres.next(), centres.next()) else {
            return true;
        };
        centres.all(|centre| (second - first).cross(centre - first) == 0.0)
    }

    /// The same, where the gaps do not fit together: from cells that reach far out. Cells that meet there reach
    /// through the container's boundary, each from its own centre, so only those can own or cut one.
    fn far_triangles(&self, at_boundary: &[u32], graph: &Embedding) -> Vec<[u32; 3]> {
        let of_boundary = |k: u32| self.grid.discs[at_boundary[k as usize] as usize];
        let (grid, _) = Grid::of(at_boundary.len(), of_boundary);
        let of_disc = |cell: &mut Cell, &index: &u32| {
            let disc = &self.grid.discs[index as usize];
            self.start(disc, OUTSIDE * self.size, cell);
            self.cut_out(disc, graph, &grid, cell);
            let mut found = PowerDiagram::default();
            self.collect_triangles(disc, cell, &mut found);
            found.outer_triangles
        };
        let triangles = at_boundary.par_iter().map_init(Cell::default, of_disc);
        triangles.collect::<Vec<_>>().concat()
    }

    /// Cuts the cell of a disc out of what it was started with, by its neighbours in the graph and all of a grid.
    fn cut_out(&self, disc: &Disc, graph: &Embedding, grid: &Grid, cell: &mut Cell) {
        for other in graph.neighbours(disc.index) {
            self.cut(disc, &self.grid.discs[other as usize], cell);
        }
        for level in &grid.levels {
            let grown = level.largest_radius * level.largest_radius - disc.radius * disc.radius;
            let (mut done, mut reach) = (0.0, f64::INFINITY);
            loop {
                // A disc at distance D has its radical axis no nearer than (D² + R² − R_max²)/2D.
                let farthest = cell.farthest_squared;
                let now = farthest.sqrt() + (farthest + grown).max(0.0).sqrt();
                // A cell that discs cut which nearly coincide may grow by roundings, again and again.
                reach = (now * (1.0 + 1e-6)).min(reach);
                if cell.edges.is_empty() || reach <= done || now.is_nan() {
                    break;
                }
                let step = if done == 0.0 {
                    2.0 * (disc.radius + 2.0 * level.largest_radius)
                } else {
                    2.0 * done
                };
                let distance = if step > 0.0 { reach.min(step) } else { reach };
                for other in grid.around(level, disc.centre, distance).flatten() {
                    self.cut(disc, other, cell);
                }
                if level.is_all_within(disc.centre, distance) {
                    break;
                }
                done = distance;
            }
        }
    }

    /// The container, grown by a margin, as the first cell of a disc.
    fn start(&self, disc: &Disc, margin: f64, cell: &mut Cell) {
        let container = self.container;
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
            cell.cut(&line, disc.index, self.lifted);
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
    fn collect_triangles(&self, disc: &Disc, cell: &Cell, diagram: &mut PowerDiagram) {
        let tolerance = 1e-9 * self.size;
        let (inner, outer) = (diagram.triangles.len(), diagram.outer_triangles.len());
        for (a, b, point) in cell.radical_centres() {
            let point = disc.centre + point;
            let inside = |side: &HalfPlane| side.distance(point) >= -tolerance;
            let triangles = if self.container.sides.iter().all(inside) {
                &mut diagram.triangles
            } else {
                &mut diagram.outer_triangles
            };
            if disc.index < a.min(b) {
                triangles.push([disc.index, a, b]);
            }
        }
        diagram.triangles[inner..].sort_unstable();
        diagram.outer_triangles[outer..].sort_unstable();
    }
}

/// Where the sides cut off triangles around a disc.
fn gaps(disc: u32, cell: &Cell) -> Vec<Gap> {
    let lines = || cell.edges.iter().map(|edge| &edge.line);
    let count = cell.edges.len();
    let Some(first) = lines().position(Line::is_disc) else {
        return Vec::new();
    };
    let mut gaps = Vec::new();
    let mut to = cell.edges[first].line.tag;
    let mut cut_off = false;
    for line in lines().cycle().skip(first + 1).take(count) {
        if line.is_disc() {
            if cut_off {
                gaps.push(Gap {
                    from: line.tag,
                    at: disc,
                    to,
                });
            }
            to = line.tag;
        }
        cut_off = !line.is_disc();
    }
    gaps
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

impl CutOut {
    /// The parts of the edge of a disc that was cut out with one of a higher number.
    pub(super) fn parts(&self, first: u32, second: u32) -> [f64; 2] {
        let key = |edge: &DualEdge| (edge.first, edge.second);
        let edges = &self.diagram.edges;
        let found = edges.binary_search_by_key(&(first, second), key);
        found.map_or([0.0; 2], |k| edges[k].parts)
    }

    fn add(&mut self, cell: CutCell) {
        self.discs.push(cell.disc);
        self.areas.push(cell.area);
        self.diagram.edges.extend(cell.diagram.edges);
        self.diagram.side_edges.extend(cell.diagram.side_edges);
        self.diagram.triangles.extend(cell.diagram.triangles);
        self.diagram
            .outer_triangles
            .extend(cell.diagram.outer_triangles);
        self.gaps.extend(cell.gaps);
        if cell.at_boundary {
            self.at_boundary.push(cell.disc);
        }
    }
}
