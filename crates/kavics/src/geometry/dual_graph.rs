//! Cells, edges and triangles of the power diagram by the places of discs in a grid, as they are found.

use rayon::prelude::*;

use crate::geometry::container::Container;
use crate::geometry::cutting::{Clipping, CutOut};
use crate::geometry::embedding::{Embedding, HalfEdge};
use crate::geometry::face::Triangulation;
use crate::geometry::faces::Faces;
use crate::geometry::lifted::Lifted;
use crate::geometry::near_pairs::{Disc, Grid, NearPair};
use crate::geometry::power_diagram::{DualEdge, SideEdge};

/// A pair whose gap or overlap is a larger share of the smaller radius is no edge of the graph of near discs.
const NEAR: f64 = 0.01;

/// Which edges of a power diagram are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edges {
    /// Those of the near pairs alone.
    OfNearPairs,
    /// All.
    All,
}

/// Pairs of discs that are likely neighbours.
pub(crate) struct Near {
    /// The graph of those that touch but for a small share of the smaller radius.
    graph: Embedding,
    /// The others, each both ways, sorted.
    others: Vec<[u32; 2]>,
}

/// Near pairs as one task finds them, the lower place first.
#[derive(Default)]
struct Pairs {
    links: Vec<[u32; 2]>,
    others: Vec<[u32; 2]>,
}

impl Pairs {
    fn add(&mut self, disc: &Disc, other: &Disc, gap: f64) {
        let pair = [disc.index, other.index];
        if gap.abs() <= NEAR * disc.radius.min(other.radius) {
            self.links.push(pair);
        } else {
            self.others.push(pair);
        }
    }
}

impl Near {
    /// All pairs of a grid, whose discs are known by their places, with a gap of at most `reach`.
    pub(crate) fn within(grid: &Grid, reach: f64) -> Self {
        Self::new(grid, &grid.near(reach, Pairs::add))
    }

    /// Pairs by the numbers that the discs had before, and their gaps times `scale`.
    pub(super) fn of_pairs(grid: &Grid, numbers: &[u32], near: &[NearPair], scale: f64) -> Self {
        let mut places = vec![0_usize; numbers.len()];
        for (place, &number) in numbers.iter().enumerate() {
            places[number as usize] = place;
        }
        let mut pairs = Pairs::default();
        for NearPair { first, second, gap } in near {
            let [a, b] = [first, second].map(|&number| &grid.discs[places[number as usize]]);
            pairs.add(a, b, gap * scale);
        }
        Self::new(grid, &[pairs])
    }

    fn new(grid: &Grid, pairs: &[Pairs]) -> Self {
        let links = pairs.iter().flat_map(|pairs| &pairs.links).copied();
        let point = |place: u32| grid.discs[place as usize].centre;
        let others = pairs.iter().flat_map(|pairs| &pairs.others);
        let mut others: Vec<_> = others.flat_map(|&[a, b]| [[a, b], [b, a]]).collect();
        others.par_sort_unstable();
        Self {
            graph: Embedding::of(grid.discs.len(), point, links),
            others,
        }
    }
}

/// The power diagram of the discs of a grid, which are known by their places.
pub(crate) struct DualGraph<'a> {
    /// All edges between cells by (first, second), where wanted; edges of no length may be among them.
    pub(crate) edges: Vec<DualEdge>,
    discs: &'a [Disc],
    near: Near,
    faces: Faces,
    cut: CutOut,
}

impl<'a> DualGraph<'a> {
    /// In lengths for which the container's unit is 1.
    pub(crate) fn new(grid: &'a Grid, container: &Container, near: Near, edges: Edges) -> Self {
        let lifted = Lifted::new(&grid.discs, container.middle());
        let size = container.size();
        let triangulation = Triangulation {
            discs: &grid.discs,
            graph: &near.graph,
            lifted: &lifted,
            container,
            margin: 1e-9 * size,
            diagonals: edges == Edges::All,
        };
        let mut faces = triangulation.faces();
        for [disc, _] in &near.others {
            faces.open[*disc as usize] = true;
        }
        let clipping = Clipping {
            container,
            size,
            grid,
            lifted: &lifted,
        };
        let mut cut = clipping.open_cells(&mut faces, &triangulation);
        clipping.add_outer_triangles(&mut cut, &near.graph);
        for (&disc, &area) in cut.discs.iter().zip(&cut.areas) {
            faces.areas[disc as usize] = area;
        }
        let mut dual = Self {
            edges: Vec::new(),
            discs: &grid.discs,
            near,
            faces,
            cut,
        };
        if edges == Edges::All {
            dual.edges = dual.all_edges();
        }
        dual
    }

    /// The near pairs of a disc: the other disc, and the name of the pair seen from this one.
    pub(crate) fn near_of(&self, disc: u32) -> impl Iterator<Item = (u32, u32)> {
        let Near { graph, others } = &self.near;
        let of_graph = graph
            .star(disc)
            .map(|slot| (graph.half_edge(slot).to, slot));
        let begin = others.partition_point(|pair| pair[0] < disc);
        let own = others[begin..]
            .iter()
            .take_while(move |pair| pair[0] == disc);
        let names = (graph.half_edges() + begin) as u32..;
        of_graph.chain(own.zip(names).map(|(pair, name)| (pair[1], name)))
    }

    /// The disc at a place.
    pub(crate) fn disc(&self, place: u32) -> &Disc {
        &self.discs[place as usize]
    }

    /// The other disc of a near pair of one, and the parts of their common edge as seen from this one; of no length
    /// where they have none.
    pub(crate) fn near_edge(&self, disc: u32, name: u32) -> (u32, [f64; 2]) {
        let Near { graph, others } = &self.near;
        if let Some(number) = (name as usize).checked_sub(graph.half_edges()) {
            let [_, other] = others[number];
            return (other, self.cut_parts([disc, other]));
        }
        let HalfEdge { to, twin } = graph.half_edge(name);
        // The disc with the lower place says what there is.
        if self.faces.open[disc.min(to) as usize] {
            return (to, self.cut_parts([disc, to]));
        }
        let branch = self.disc(to).centre - self.disc(disc).centre;
        let inverse = 1.0 / branch.length();
        let part = |slot: u32| self.faces.doubled_areas[slot as usize] * inverse;
        (to, [part(twin), part(name)])
    }

    /// The parts of the edge of a cell that was cut out, seen from the first of two discs.
    fn cut_parts(&self, [from, to]: [u32; 2]) -> [f64; 2] {
        let parts = self.cut.parts(from.min(to), from.max(to));
        DualEdge::seen_from(from, to, parts).parts
    }

    /// Of near pairs, across faces, and of the cells that were cut out.
    fn all_edges(&mut self) -> Vec<DualEdge> {
        let mut edges = std::mem::take(&mut self.faces.diagonals);
        for disc in 0..self.discs.len() as u32 {
            let higher = self.near_of(disc).filter(|(other, _)| *other > disc);
            edges.extend(higher.map(|(second, name)| DualEdge {
                first: disc,
                second,
                parts: self.near_edge(disc, name).1,
            }));
        }
        edges.retain(|edge| !self.faces.open[edge.first as usize]);
        edges.extend_from_slice(&self.cut.diagram.edges);
        edges.par_sort_unstable_by_key(|edge| (edge.first, edge.second));
        edges
    }

    /// Area of each cell.
    pub(crate) fn cell_areas(&self) -> &[f64] {
        &self.faces.areas
    }

    /// Edges on the container by (disc, side).
    pub(crate) fn side_edges(&self) -> &[SideEdge] {
        &self.cut.diagram.side_edges
    }

    /// Upper bound on the number of all triangles.
    pub(crate) fn most_triangles(&self) -> usize {
        let found = &self.cut.diagram;
        let of_faces: usize = self.faces.triangles.iter().map(Vec::len).sum();
        of_faces + found.triangles.len() + found.outer_triangles.len()
    }

    /// Triangles whose radical centre lies in the container.
    pub(crate) fn inner_triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        // The disc with the lowest number says what triangles there are.
        let is_right = |triangle: &&[u32; 3]| !self.faces.open[triangle[0] as usize];
        let of_faces = self.faces.triangles.iter().flatten().filter(is_right);
        of_faces.chain(&self.cut.diagram.triangles).copied()
    }

    /// The other triangles.
    pub(crate) fn outer_triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        self.cut.diagram.outer_triangles.iter().copied()
    }
}

/// Where the parts add up to less than nothing by rounding, an edge of no length in their middle.
pub(super) fn not_turned_around([before, after]: [f64; 2]) -> [f64; 2] {
    if before + after >= 0.0 {
        return [before, after];
    }
    let middle = 0.5 * (after - before);
    [-middle, middle]
}
