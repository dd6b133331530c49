//! Power diagram of discs in a convex container, and the regular triangulation that is dual to it.
//!
//! In: discs, a container, and pairs that are likely neighbours. Out: areas of the cells, edges, triangles.
//! A cell is all points whose power |x − x_i|² − R_i² is least with its disc i. Aurenhammer (1987).

use crate::geometry::Vector;
use crate::geometry::container::Container;
use crate::geometry::cutting::{Clipping, CutOut};
use crate::geometry::embedding::{Embedding, HalfEdge};
use crate::geometry::faces::{Faces, Triangulation};
use crate::geometry::lifted::Lifted;
use crate::geometry::near_pairs::{Disc, Grid, NearPair};

/// A pair whose gap or overlap is a larger share of the smaller radius is no edge of the graph of near discs.
const NEAR: f64 = 0.01;

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
    /// The common edge of each near pair, of no length where there is none; neighbours come near each other.
    pub near_edges: Vec<DualEdge>,
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
    let (lifted, (graph, unlinked)) = rayon::join(
        || Lifted::new(&grid.discs, &centres, container.middle()),
        || graph(&grid.discs, &centres, near),
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
    let mut of_faces = std::mem::take(&mut faces.triangles);
    let (near_edges, triangles) = rayon::join(
        || near_edges(near, &faces, &cut, &graph, &grid.discs),
        || {
            of_faces.retain(|triangle| !faces.cells[triangle[0] as usize].open);
            of_faces
        },
    );
    let mut diagram = PowerDiagram {
        near_edges,
        triangles,
        ..PowerDiagram::default()
    };
    if edges == Edges::All {
        diagram.edges = all_edges(&diagram.near_edges, &mut faces, &mut cut);
    }
    diagram.add_cells(&faces, cut);
    diagram
}

/// The graph of the near pairs whose discs touch but for a small share of the smaller radius, and the discs of the
/// others.
fn graph(discs: &[Disc], centres: &[Vector], near: &[NearPair]) -> (Embedding, Vec<u32>) {
    let radius = |disc: u32| discs[disc as usize].radius;
    let smallest = discs
        .iter()
        .fold(f64::INFINITY, |r, disc| r.min(disc.radius));
    let touch = |pair: &NearPair, smaller: f64| pair.gap.abs() <= NEAR * smaller;
    let ends = |pair: &NearPair| [pair.first, pair.second];
    if near.iter().all(|pair| touch(pair, smallest)) {
        return (Embedding::of(centres, near.iter().map(ends)), Vec::new());
    }
    let is_link = |&&pair: &&NearPair| touch(&pair, radius(pair.first).min(radius(pair.second)));
    let (links, others): (Vec<_>, Vec<_>) = near.iter().partition(is_link);
    let links: Vec<[u32; 2]> = links.into_iter().map(ends).collect();
    let others = others.into_iter().flat_map(ends).collect();
    (Embedding::new(centres, &links), others)
}

/// The edges of the near pairs: the disc with the lower number says what there is.
fn near_edges(
    near: &[NearPair],
    faces: &Faces,
    cut: &CutOut,
    graph: &Embedding,
    discs: &[Disc],
) -> Vec<DualEdge> {
    let of_faces = |disc: &u32| !faces.cells[*disc as usize].open;
    let all = 0..discs.len() as u32;
    let mut edges = Vec::with_capacity(near.len());
    for disc in all.filter(of_faces) {
        edges.extend(edges_of_faces(disc, faces, graph, discs));
    }
    let of_cut = near
        .iter()
        .filter(|pair| faces.cells[pair.first as usize].open);
    edges.extend(of_cut.map(|&NearPair { first, second, .. }| DualEdge {
        first,
        second,
        parts: cut.parts(first, second),
    }));
    edges
}

/// The edges of the graph from a disc to those of higher numbers, from the triangles on both sides.
fn edges_of_faces(
    first: u32,
    faces: &Faces,
    graph: &Embedding,
    discs: &[Disc],
) -> impl Iterator<Item = DualEdge> {
    let higher = graph
        .star(first)
        .filter(move |&slot| graph.half_edges()[slot as usize].to > first);
    higher.map(move |slot| {
        let HalfEdge { to, twin } = graph.half_edges()[slot as usize];
        let branch = discs[to as usize].centre - discs[first as usize].centre;
        let inverse = 1.0 / branch.length();
        let part = |slot: u32| faces.doubled_areas[slot as usize] * inverse;
        DualEdge {
            first,
            second: to,
            parts: [part(twin), part(slot)],
        }
    })
}

/// All edges by (first, second): of near pairs, across faces, and of the cells that were cut out.
fn all_edges(near_edges: &[DualEdge], faces: &mut Faces, cut: &mut CutOut) -> Vec<DualEdge> {
    let diagonals = whole_diagonals(std::mem::take(&mut faces.diagonals));
    let of_graph = near_edges.iter().copied().chain(diagonals);
    let of_faces = |edge: &DualEdge| !faces.cells[edge.first as usize].open;
    let mut edges = std::mem::take(&mut cut.diagram.edges);
    edges.extend(of_graph.filter(of_faces));
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
    /// Adds the cells, and what those that were cut out know besides.
    fn add_cells(&mut self, faces: &Faces, mut cut: CutOut) {
        self.cell_area = faces.cells.iter().map(|cell| cell.area).collect();
        for (disc, area) in cut.discs.iter().zip(&cut.areas) {
            self.cell_area[*disc as usize] = *area;
        }
        // The disc with the lowest number says what triangles there are.
        self.triangles.append(&mut cut.diagram.triangles);
        self.outer_triangles = cut.diagram.outer_triangles;
        self.side_edges = cut.diagram.side_edges;
    }

    fn scale(&mut self, unit: f64) {
        for area in &mut self.cell_area {
            *area *= unit * unit;
        }
        let of_sides = self.side_edges.iter_mut().map(|edge| &mut edge.parts);
        let parts = self.edges.iter_mut().map(|edge| &mut edge.parts);
        let of_near = self.near_edges.iter_mut().map(|edge| &mut edge.parts);
        for part in parts.chain(of_sides).chain(of_near).flatten() {
            *part *= unit;
        }
    }
}
