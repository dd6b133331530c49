//! Power diagram of discs in a convex container, and the regular triangulation that is dual to it.
//!
//! In: discs, a container, and pairs that are likely neighbours. Out: areas of the cells, edges, triangles.
//! A cell is all points whose power |x − x_i|² − R_i² is least with its disc i. Aurenhammer (1987).

use rayon::prelude::*;

use crate::geometry::Vector;
use crate::geometry::container::{Container, HalfPlane};
use crate::geometry::embedding::Embedding;
use crate::geometry::faces::{Faces, Triangulation, fingerprint, lowest_first};
use crate::geometry::lifted::Lifted;
use crate::geometry::near_pairs::{Disc, Grid, NearPair};
use crate::geometry::outer_triangles::{Gap, outer_triangles};
use crate::geometry::power_cell::{Cell, Line, SIDES};

/// Discs whose cells one task cuts; fixed, so that the result does not depend on the number of threads.
const DISCS_A_TASK: usize = 256;
/// A pair whose gap or overlap is a larger share of the smaller radius is no edge of the graph of near discs.
const NEAR: f64 = 0.01;

/// Radical centres farther away than this many sizes of the container belong to triangles too flat to matter.
const OUTSIDE: f64 = 1e6;

/// Which edges of a power diagram are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edges {
    /// Those of the near pairs alone.
    OfNearPairs,
    /// All.
    All,
}

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
    /// The common edge of each near pair, of no length where there is none; its parts as in [`DualEdge`].
    pub near_edges: Vec<[f64; 2]>,
    /// All edges between cells by (first, second), where wanted; edges of no length may be among them.
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
/// `near` speeds it up: pairs that are likely neighbours, such as all discs that touch.
/// The same bits on any number of threads; degenerate vertices are split the same way by all cells that meet there.
pub fn power_diagram(
    centres: &[Vector],
    radii: &[f64],
    container: &Container,
    near: &[NearPair],
    edges: Edges,
) -> PowerDiagram {
    let unit = container.unit();
    let scale = 1.0 / unit;
    let centres: Vec<Vector> = centres.iter().map(|&x| x * scale).collect();
    let radii: Vec<f64> = radii.iter().map(|&r| r * scale).collect();
    let scaled = |pair: &NearPair| NearPair {
        gap: pair.gap * scale,
        ..*pair
    };
    let near: Vec<NearPair> = near.iter().map(scaled).collect();
    let grid = Grid::new(&centres, &radii);
    let mut diagram = power_diagram_of(&grid, &container.scaled(scale), &near, edges);
    diagram.scale(unit);
    diagram
}

/// As [`power_diagram`], of the discs of a grid, in lengths for which the container's unit is 1.
pub fn power_diagram_of(
    grid: &Grid,
    container: &Container,
    near: &[NearPair],
    edges: Edges,
) -> PowerDiagram {
    let centres: Vec<Vector> = grid.discs.iter().map(|disc| disc.centre).collect();
    let (links, unlinked) = links(&grid.discs, near);
    let (lifted, graph) = rayon::join(
        || Lifted::new(&grid.discs, &centres, container.middle()),
        || Embedding::new(&centres, &links),
    );
    let size = container.size();
    let triangulation = Triangulation {
        discs: &grid.discs,
        points: &centres,
        graph: &graph,
        lifted: &lifted,
        container,
        margin: 1e-9 * size,
        diagonals: edges == Edges::All,
    };
    let mut faces = triangulation.faces();
    for disc in unlinked {
        faces.cells[disc as usize].open = true;
    }
    let clipping = Clipping {
        container,
        size,
        grid,
        lifted,
    };
    let mut cut = clipping.open_cells(&mut faces, &graph);
    clipping.add_outer_triangles(&mut cut, &graph);
    let mut diagram = PowerDiagram {
        near_edges: near_edges(near, &faces, &cut, &graph, &grid.discs),
        ..PowerDiagram::default()
    };
    if edges == Edges::All {
        diagram.edges = all_edges(near, &diagram.near_edges, &mut faces, &mut cut);
    }
    diagram.add_cells(faces, cut);
    diagram
}

/// Whether a near pair is an edge of the graph: its discs touch but for a small share of the smaller radius.
fn is_link(discs: &[Disc], pair: &NearPair) -> bool {
    let [a, b] = [pair.first, pair.second].map(|disc| discs[disc as usize].radius);
    pair.gap.abs() <= NEAR * a.min(b)
}

/// The edges of the graph, and the discs of the other near pairs.
fn links(discs: &[Disc], near: &[NearPair]) -> (Vec<[u32; 2]>, Vec<u32>) {
    let (mut links, mut unlinked) = (Vec::with_capacity(near.len()), Vec::new());
    for pair in near {
        let ends = [pair.first, pair.second];
        if is_link(discs, pair) {
            links.push(ends);
        } else {
            unlinked.extend(ends);
        }
    }
    (links, unlinked)
}

/// The edges of the near pairs: the disc with the lower number says what there is.
fn near_edges(
    near: &[NearPair],
    faces: &Faces,
    cut: &CutOut,
    graph: &Embedding,
    discs: &[Disc],
) -> Vec<[f64; 2]> {
    let mut links = 0..;
    let parts = |pair: &NearPair| {
        let link = is_link(discs, pair).then(|| links.next()).flatten();
        if faces.cells[pair.first as usize].open {
            return cut.parts(pair.first, pair.second);
        }
        let [a, b] = [pair.first, pair.second].map(|disc| discs[disc as usize].centre);
        let inverse = 1.0 / (b - a).length();
        let slots = graph.slots(link.unwrap_or_default());
        let [after, before] = slots.map(|slot| faces.doubled_areas[slot as usize]);
        [before * inverse, after * inverse]
    };
    near.iter().map(parts).collect()
}

/// All edges by (first, second): of near pairs, across faces, and of the cells that were cut out.
fn all_edges(
    near: &[NearPair],
    near_edges: &[[f64; 2]],
    faces: &mut Faces,
    cut: &mut CutOut,
) -> Vec<DualEdge> {
    let diagonals = whole_diagonals(std::mem::take(&mut faces.diagonals));
    let of_faces = |first: u32| !faces.cells[first as usize].open;
    let edge = |(pair, &parts): (&NearPair, &[f64; 2])| DualEdge {
        first: pair.first,
        second: pair.second,
        parts,
    };
    let of_graph = near.iter().zip(near_edges).map(edge);
    let mut edges = std::mem::take(&mut cut.diagram.edges);
    edges.extend(
        of_graph
            .chain(diagonals)
            .filter(|edge| of_faces(edge.first)),
    );
    edges.sort_unstable_by_key(|edge| (edge.first, edge.second));
    edges
}

/// Puts both parts of each diagonal together.
fn whole_diagonals(mut halves: Vec<DualEdge>) -> impl Iterator<Item = DualEdge> {
    halves.sort_by_key(|edge| (edge.first, edge.second));
    let halves: Vec<_> = halves.chunks_exact(2).map(|h| (h[0], h[1])).collect();
    halves.into_iter().map(|(one, other)| {
        let parts = [one.parts[0] + other.parts[0], one.parts[1] + other.parts[1]];
        DualEdge {
            parts: not_turned_around(parts),
            ..one
        }
    })
}

/// Rounding may turn an edge of no length around.
fn not_turned_around([before, after]: [f64; 2]) -> [f64; 2] {
    if before + after >= 0.0 {
        return [before, after];
    }
    let middle = 0.5 * (after - before);
    [-middle, middle]
}

impl PowerDiagram {
    /// Adds cells and triangles; the disc with the lowest number says what triangles there are.
    fn add_cells(&mut self, mut faces: Faces, mut cut: CutOut) {
        self.cell_area = faces.cells.iter().map(|cell| cell.area).collect();
        for (disc, area) in cut.discs.iter().zip(&cut.areas) {
            self.cell_area[*disc as usize] = *area;
        }
        let cells = &faces.cells;
        faces
            .triangles
            .retain(|triangle| !cells[triangle[0] as usize].open);
        faces.triangles.append(&mut cut.diagram.triangles);
        self.triangles = faces.triangles;
        self.outer_triangles = cut.diagram.outer_triangles;
        self.side_edges = cut.diagram.side_edges;
    }

    fn scale(&mut self, unit: f64) {
        for area in &mut self.cell_area {
            *area *= unit * unit;
        }
        let of_sides = self.side_edges.iter_mut().map(|edge| &mut edge.parts);
        let parts = self.edges.iter_mut().map(|edge| &mut edge.parts);
        let of_near = self.near_edges.iter_mut();
        for part in parts.chain(of_sides).chain(of_near).flatten() {
            *part *= unit;
        }
    }
}

/// Cells that were cut out one by one.
#[derive(Default)]
struct CutOut {
    /// The discs, rising.
    discs: Vec<u32>,
    /// Their areas.
    areas: Vec<f64>,
    /// Edges, side edges and inner triangles of which they have the lowest number.
    diagram: PowerDiagram,
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
struct Clipping<'a> {
    container: &'a Container,
    size: f64,
    grid: &'a Grid,
    lifted: Lifted<'a>,
}

impl Clipping<'_> {
    /// Cuts out the cells of the open discs, and of those around them that then turn out to be wrong.
    fn open_cells(&self, faces: &mut Faces, graph: &Embedding) -> CutOut {
        let all = 0..self.grid.discs.len() as u32;
        let mut wanted: Vec<u32> = all.filter(|&i| faces.cells[i as usize].open).collect();
        let mut cut: Vec<CutCell> = Vec::new();
        while !wanted.is_empty() {
            let mut doubted = Vec::new();
            for cell in self.cells(&wanted, graph) {
                let of_faces = &mut faces.cells[cell.disc as usize];
                if of_faces.open || of_faces.fingerprint != cell.fingerprint {
                    doubted.extend_from_slice(&cell.neighbours);
                }
                of_faces.open = true;
                cut.push(cell);
            }
            doubted.sort_unstable();
            doubted.dedup();
            wanted = doubted;
            wanted.retain(|&disc| !faces.cells[disc as usize].open);
        }
        cut.sort_unstable_by_key(|cell| cell.disc);
        let mut out = CutOut::default();
        cut.into_iter().for_each(|cell| out.add(cell));
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
    fn add_outer_triangles(&self, cut: &mut CutOut, graph: &Embedding) {
        let gaps = std::mem::take(&mut cut.gaps);
        let all = match outer_triangles(gaps, &self.grid.discs, &self.lifted) {
            Some(triangles) => triangles
                .into_iter()
                .filter(|triangle| triangle.centre.length() < OUTSIDE * self.size)
                .map(|triangle| lowest_first(triangle.discs))
                .collect(),
            None => {
                cut.diagram.outer_triangles.clear();
                self.far_triangles(&cut.at_boundary, graph)
            }
        };
        cut.diagram.outer_triangles.extend::<Vec<_>>(all);
    }

    /// The same, where the gaps do not fit together: from cells that reach far out. Cells that meet there reach
    /// through the container's boundary, each from its own centre, so only those can own or cut one.
    fn far_triangles(&self, at_boundary: &[u32], graph: &Embedding) -> Vec<[u32; 3]> {
        let of_boundary = at_boundary.iter().map(|&k| self.grid.discs[k as usize]);
        let grid = Grid::of_discs(of_boundary.collect());
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
    fn parts(&self, first: u32, second: u32) -> [f64; 2] {
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
