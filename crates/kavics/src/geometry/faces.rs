//! Power cells from the faces of the graph of near discs: no search, a few tests a triangle.
//!
//! Discs that touch have a common edge of their cells, so the regular triangulation contains the contact graph and
//! falls apart into its faces. A face that is a short simple loop is triangulated alone: on the left of an edge lies
//! the corner whose radical centre is the lowest. Discs whose cells do not follow so are left open: those on other
//! faces or without contact, those with a radical centre at the container's boundary, those where an edge of the
//! graph turns out to have no dual length.

use rayon::prelude::*;

use crate::geometry::Vector;
use crate::geometry::container::{Container, HalfPlane};
use crate::geometry::embedding::{Embedding, HalfEdge, NODES_A_TASK, by_nodes};
use crate::geometry::lifted::Lifted;
use crate::geometry::near_pairs::Disc;
use crate::geometry::outer_triangles::Lowest;
use crate::geometry::power_diagram::DualEdge;

/// Faces with more corners are left open.
const LONGEST: usize = 64;

/// What the faces give, for all discs that are not open.
#[derive(Debug, Default)]
pub(super) struct Faces {
    /// Cells of the discs.
    pub cells: Vec<FaceCell>,
    /// Length of each half-edge times that of the dual edge on its left: twice the area of the triangle over it.
    pub doubled_areas: Vec<f64>,
    /// Triangles, counter-clockwise, lowest number first.
    pub triangles: Vec<[u32; 3]>,
    /// Dual edges across the faces, when asked for; each in two parts.
    pub diagonals: Vec<DualEdge>,
}

/// The cell of a disc as its faces give it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FaceCell {
    /// Area so far.
    pub area: f64,
    /// Sum of the fingerprints of its triangles.
    pub fingerprint: u64,
    /// Whether the cell must be found otherwise.
    pub open: bool,
}

/// What triangulating the faces needs to know.
pub(super) struct Triangulation<'a> {
    pub discs: &'a [Disc],
    pub points: &'a [Vector],
    pub graph: &'a Embedding,
    pub lifted: &'a Lifted<'a>,
    pub container: &'a Container,
    /// Radical centres must be inside by this.
    pub margin: f64,
    /// Whether the dual edges across the faces are wanted.
    pub diagonals: bool,
}

/// A number that tells triangles apart, the same in whatever order they are met.
pub(super) fn fingerprint([a, b, c]: [u32; 3]) -> u64 {
    let mixed = u64::from(a).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ (u64::from(b) << 32 | u64::from(c)).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
    (mixed ^ (mixed >> 31)).wrapping_mul(0x94d0_49bb_1331_11eb)
}

/// A triangle with its lowest number first, turning as before.
pub fn lowest_first([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// A corner of a face: its disc, and the slot of the half-edge that leaves it along the face.
#[derive(Clone, Copy)]
struct Corner {
    disc: Disc,
    slot: u32,
}

/// What a task finds; discs and slots that are not its own are kept aside.
struct Task<'a> {
    first: usize,
    first_slot: u32,
    cells: &'a mut [FaceCell],
    doubled_areas: &'a mut [f64],
    seen: Vec<bool>,
    other_cells: Vec<(u32, FaceCell)>,
    other_doubled_areas: Vec<(u32, f64)>,
    triangles: Vec<[u32; 3]>,
    diagonals: Vec<DualEdge>,
    face: Vec<Corner>,
    chains: Vec<(usize, usize)>,
    found: Vec<Found>,
    /// What the face gives to the cells of its corners.
    sums: Vec<FaceCell>,
}

/// A triangle of a face: its corners' places in the face, the edge it lies on first; and its radical centre.
#[derive(Clone, Copy)]
struct Found {
    corners: [usize; 3],
    centre: Vector,
}

impl Triangulation<'_> {
    /// Triangulates all faces that are short simple loops; O(N).
    pub(super) fn faces(&self) -> Faces {
        let nodes = self.discs.len();
        let mut faces = Faces {
            cells: vec![FaceCell::default(); nodes],
            doubled_areas: vec![0.0; self.graph.half_edges().len()],
            ..Faces::default()
        };
        let slots = by_nodes(self.graph.starts(), &mut faces.doubled_areas);
        let mut cells = faces.cells.as_mut_slice();
        let tasks: Vec<Task<'_>> = slots
            .into_iter()
            .map(|(nodes, doubled_areas)| {
                let own;
                (own, cells) = std::mem::take(&mut cells).split_at_mut(nodes.len());
                Task::new(
                    nodes.start,
                    self.graph.starts()[nodes.start],
                    own,
                    doubled_areas,
                )
            })
            .collect();
        let work = |mut task: Task<'_>| {
            self.task(&mut task);
            (
                task.other_cells,
                task.other_doubled_areas,
                task.triangles,
                task.diagonals,
            )
        };
        let found: Vec<_> = tasks.into_par_iter().map(work).collect();
        faces
            .triangles
            .reserve_exact(found.iter().map(|task| task.2.len()).sum());
        for (cells, doubled_areas, triangles, diagonals) in found {
            for (disc, cell) in cells {
                faces.cells[disc as usize].add(cell);
            }
            for (slot, doubled) in doubled_areas {
                faces.doubled_areas[slot as usize] = doubled;
            }
            faces.triangles.extend(triangles);
            faces.diagonals.extend(diagonals);
        }
        self.open_edges_without_length(&mut faces);
        faces
    }

    /// The faces whose lowest slot belongs to the task.
    fn task(&self, task: &mut Task<'_>) {
        for k in 0..task.cells.len() {
            let star = self.graph.star((task.first + k) as u32);
            if star.is_empty() {
                task.cells[k].open = true;
            }
            for slot in star {
                if !task.seen[(slot - task.first_slot) as usize] {
                    self.face(slot, (task.first + k) as u32, task);
                }
            }
        }
    }

    /// Walks around one face and triangulates it, if it can be.
    fn face(&self, from: u32, node: u32, task: &mut Task<'_>) {
        task.face.clear();
        let (mut slot, mut at, mut lowest) = (from, node, from);
        let origin = self.points[node as usize];
        let mut twice_area = 0.0;
        loop {
            task.see(slot);
            lowest = lowest.min(slot);
            task.face.push(Corner {
                disc: self.discs[at as usize],
                slot,
            });
            let to = self.graph.half_edges()[slot as usize].to;
            let along = self.points[at as usize] - origin;
            twice_area += along.cross(self.points[to as usize] - origin);
            slot = self.graph.next(slot);
            at = to;
            if slot == from || task.face.len() > LONGEST {
                break;
            }
        }
        let closed = slot == from;
        if closed && lowest < task.first_slot {
            return;
        }
        let simple = closed && twice_area > 0.0 && is_simple(&task.face);
        if !(simple && self.fill(task)) {
            task.open_face();
        }
    }

    /// Triangulates a simple loop; false, and nothing kept, where a radical centre is not inside the container.
    fn fill(&self, task: &mut Task<'_>) -> bool {
        let last = task.face.len() - 1;
        task.chains.clear();
        task.found.clear();
        task.chains.push((0, last));
        while let Some((low, high)) = task.chains.pop() {
            let Some(triangle) = self.apex(&task.face, low, high) else {
                return false;
            };
            if !self.is_inside(triangle.centre) {
                return false;
            }
            let apex = triangle.corners[2];
            if apex > low + 1 {
                task.chains.push((low, apex));
            }
            if high > apex + 1 {
                task.chains.push((apex, high));
            }
            task.found.push(triangle);
        }
        task.sums.clear();
        task.sums.resize(last + 1, FaceCell::default());
        for k in 0..task.found.len() {
            self.keep(task.found[k], last, task);
        }
        for k in 0..=last {
            task.add(task.face[k].disc.index, task.sums[k]);
        }
        true
    }

    /// The triangle over the edge from corner `high` to corner `low`, with the rest of the chain on its left.
    fn apex(&self, face: &[Corner], low: usize, high: usize) -> Option<Found> {
        let mut lowest = Lowest::new([&face[high].disc, &face[low].disc], self.lifted);
        for (k, corner) in face.iter().enumerate().take(high).skip(low + 1) {
            lowest.look(k as u32, &corner.disc, || true);
        }
        let (apex, centre) = lowest.found()?;
        Some(Found {
            corners: [high, low, apex as usize],
            centre,
        })
    }

    fn is_inside(&self, point: Vector) -> bool {
        let inside = |side: &HalfPlane| side.distance(point) > self.margin;
        self.container.sides().iter().all(inside)
    }

    /// Adds what a triangle gives to the cells of its corners and to the edges.
    fn keep(&self, triangle: Found, last: usize, task: &mut Task<'_>) {
        let [high, low, apex] = triangle.corners;
        let numbers = triangle.corners.map(|k| task.face[k].disc.index);
        let turned = lowest_first(numbers);
        task.triangles.push(turned);
        let mark = fingerprint(turned);
        let mut areas = [0.0; 3];
        let edges = [
            (0, 1, high == last && low == 0),
            (1, 2, apex == low + 1),
            (2, 0, high == apex + 1),
        ];
        for (from, to, of_graph) in edges {
            let (p, q) = (
                task.face[triangle.corners[from]],
                task.face[triangle.corners[to]],
            );
            let (a, b) = (&p.disc, &q.disc);
            let e = b.centre - a.centre;
            let inverse = 1.0 / e.length_squared();
            let foot = 0.5 * (1.0 + (a.radius - b.radius) * (a.radius + b.radius) * inverse);
            let doubled = e.cross(triangle.centre - a.centre);
            areas[from] += 0.5 * foot * doubled;
            areas[to] += 0.5 * (1.0 - foot) * doubled;
            if of_graph {
                task.set_doubled(p.slot, doubled);
            } else if self.diagonals {
                let height = doubled * inverse.sqrt();
                let half = half_of_diagonal(a.index, b.index, height);
                task.diagonals.push(half);
            }
        }
        for (corner, area) in triangle.corners.into_iter().zip(areas) {
            task.sums[corner].add(FaceCell {
                area,
                fingerprint: mark,
                open: false,
            });
        }
    }

    /// Opens the ends of edges that, by their length, may not belong to the triangulation.
    fn open_edges_without_length(&self, faces: &mut Faces) {
        let nodes = self.discs.len() as u32;
        let firsts: Vec<u32> = (0..nodes).step_by(NODES_A_TASK).collect();
        let of_task = |&first: &u32| {
            let mut ends = Vec::new();
            for node in first..(first + NODES_A_TASK as u32).min(nodes) {
                for slot in self.graph.star(node) {
                    let HalfEdge { to, twin } = self.graph.half_edges()[slot as usize];
                    let doubled = [slot, twin].map(|slot| faces.doubled_areas[slot as usize]);
                    if to > node && self.may_be_nothing(node, to, doubled[0] + doubled[1]) {
                        ends.extend([node, to]);
                    }
                }
            }
            ends
        };
        let found: Vec<Vec<u32>> = firsts.par_iter().map(of_task).collect();
        for disc in found.into_iter().flatten() {
            faces.cells[disc as usize].open = true;
        }
    }

    /// Whether an edge may have no dual length, by its length times the dual length.
    fn may_be_nothing(&self, first: u32, second: u32, product: f64) -> bool {
        let [a, b] = [first, second].map(|disc| self.discs[disc as usize].radius);
        // What rounding the heights of the lifted discs can do to it.
        product <= 1e3 * (self.lifted.noise + f64::EPSILON * (a + b) * (a + b))
    }
}

/// The part of a diagonal's dual edge on the left of the way from `from` to `to`.
fn half_of_diagonal(from: u32, to: u32, height: f64) -> DualEdge {
    if from < to {
        DualEdge {
            first: from,
            second: to,
            parts: [0.0, height],
        }
    } else {
        DualEdge {
            first: to,
            second: from,
            parts: [height, 0.0],
        }
    }
}

/// Whether a face meets no disc twice.
fn is_simple(face: &[Corner]) -> bool {
    let numbers = || face.iter().map(|corner| corner.disc.index);
    let first_time = |(k, number)| !numbers().take(k).any(|other| other == number);
    face.len() >= 3 && numbers().enumerate().all(first_time)
}

impl FaceCell {
    fn add(&mut self, other: Self) {
        self.area += other.area;
        self.fingerprint = self.fingerprint.wrapping_add(other.fingerprint);
        self.open |= other.open;
    }
}

impl<'a> Task<'a> {
    fn new(
        first: usize,
        first_slot: u32,
        cells: &'a mut [FaceCell],
        doubled_areas: &'a mut [f64],
    ) -> Self {
        Self {
            first,
            first_slot,
            seen: vec![false; doubled_areas.len()],
            doubled_areas,
            other_cells: Vec::new(),
            other_doubled_areas: Vec::new(),
            // Twice as many triangles as discs, but for the boundary.
            triangles: Vec::with_capacity(2 * cells.len() + 64),
            cells,
            diagonals: Vec::new(),
            face: Vec::new(),
            chains: Vec::new(),
            found: Vec::new(),
            sums: Vec::new(),
        }
    }

    fn see(&mut self, slot: u32) {
        let own = slot.checked_sub(self.first_slot);
        if let Some(seen) = own.and_then(|own| self.seen.get_mut(own as usize)) {
            *seen = true;
        }
    }

    fn set_doubled(&mut self, slot: u32, doubled: f64) {
        let own = slot.checked_sub(self.first_slot);
        match own.and_then(|own| self.doubled_areas.get_mut(own as usize)) {
            Some(place) => *place = doubled,
            None => self.other_doubled_areas.push((slot, doubled)),
        }
    }

    fn add(&mut self, disc: u32, cell: FaceCell) {
        let own = (disc as usize).checked_sub(self.first);
        match own.and_then(|own| self.cells.get_mut(own)) {
            Some(place) => place.add(cell),
            None => self.other_cells.push((disc, cell)),
        }
    }

    fn open_face(&mut self) {
        for k in 0..self.face.len() {
            let cell = FaceCell {
                open: true,
                ..FaceCell::default()
            };
            self.add(self.face[k].disc.index, cell);
        }
    }
}
