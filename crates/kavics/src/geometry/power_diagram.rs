//! Power diagram of discs in a convex container, and the regular triangulation that is dual to it.
//!
//! In: discs, a container, and pairs that are likely neighbours. Out: areas of the cells, edges, triangles.
//! A cell is all points whose power |x − x_i|² − R_i² is least with its disc i. Aurenhammer (1987).

use crate::geometry::Vector;
use crate::geometry::container::Container;
use crate::geometry::dual_graph::{DualGraph, Edges, Near};
use crate::geometry::faces::lowest_first;
use crate::geometry::near_pairs::{Disc, Grid, NearPair};

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
/// `near` speeds it up: pairs that are likely neighbours, such as all discs that touch.
/// The same bits on any number of threads; degenerate vertices are split the same way by all cells that meet there.
pub fn power_diagram(
    centres: &[Vector],
    radii: &[f64],
    container: &Container,
    near: &[NearPair],
) -> PowerDiagram {
    let unit = container.unit();
    let scale = 1.0 / unit;
    let disc = |index: u32| Disc {
        centre: centres[index as usize] * scale,
        radius: radii[index as usize] * scale,
        index,
    };
    let (grid, numbers) = Grid::of(centres.len().min(radii.len()), disc);
    let grid = grid.known_by_places();
    let near = Near::of_pairs(&grid, &numbers, near, scale);
    let dual = DualGraph::new(&grid, &container.scaled(scale), near, Edges::All);
    dual.diagram(&numbers, unit)
}

impl DualEdge {
    /// The edge whose parts are given as seen from one of its discs to another.
    pub(super) fn seen_from(from: u32, to: u32, [before, after]: [f64; 2]) -> Self {
        // Seen from the other disc, n and t are reversed.
        let parts = if from < to {
            [before, after]
        } else {
            [after, before]
        };
        Self {
            first: from.min(to),
            second: from.max(to),
            parts,
        }
    }
}

impl DualGraph<'_> {
    /// The same by the numbers of the discs, with lengths times `unit`.
    fn diagram(&self, numbers: &[u32], unit: f64) -> PowerDiagram {
        let number = |place: u32| numbers[place as usize];
        let edge = |edge: &DualEdge| {
            let parts = edge.parts.map(|part| part * unit);
            DualEdge::seen_from(number(edge.first), number(edge.second), parts)
        };
        let side_edge = |edge: &SideEdge| SideEdge {
            disc: number(edge.disc),
            side: edge.side,
            parts: edge.parts.map(|part| part * unit),
        };
        let turned = |triangle: [u32; 3]| lowest_first(triangle.map(number));
        let mut diagram = PowerDiagram {
            cell_area: vec![0.0; numbers.len()],
            edges: self.edges.iter().map(edge).collect(),
            side_edges: self.side_edges().iter().map(side_edge).collect(),
            triangles: self.inner_triangles().map(turned).collect(),
            outer_triangles: self.outer_triangles().map(turned).collect(),
        };
        for (&number, area) in numbers.iter().zip(self.cell_areas()) {
            diagram.cell_area[number as usize] = area * unit * unit;
        }
        diagram
            .edges
            .sort_unstable_by_key(|edge| (edge.first, edge.second));
        diagram
            .side_edges
            .sort_unstable_by_key(|edge| (edge.disc, edge.side));
        diagram
    }
}
