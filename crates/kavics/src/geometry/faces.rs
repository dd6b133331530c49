//! Power cells from the faces of the graph of near discs: no search, a few tests a triangle.
//!
//! Discs that touch have a common edge of their cells, so the regular triangulation contains the contact graph and
//! falls apart into its faces. A face that is a short simple loop is triangulated alone. Discs whose cells do not
//! follow so are left open: those on other faces or without contact, those with a radical centre at the container's
//! boundary, those where an edge of the graph turns out to have no dual length.

use rayon::prelude::*;

use crate::geometry::embedding::{HalfEdge, NODES_A_TASK, by_nodes};
use crate::geometry::face::{Face, Triangulation};
use crate::geometry::power_diagram::DualEdge;

/// What the faces give, for all discs that are not open.
#[derive(Debug, Default)]
pub(super) struct Faces {
    /// Areas of the cells.
    pub areas: Vec<f64>,
    /// Whether the cell of a disc must be found otherwise.
    pub open: Vec<bool>,
    /// Length of each half-edge times that of the dual edge on its left: twice the area of the triangle over it.
    pub doubled_areas: Vec<f64>,
    /// Triangles, counter-clockwise, lowest number first; some lists of them, which together are all.
    pub triangles: Vec<Vec<[u32; 3]>>,
    /// Dual edges across the faces, when asked for.
    pub diagonals: Vec<DualEdge>,
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

/// What a task works on: some nodes and the half-edges that leave them.
struct Task<'a> {
    first: u32,
    first_slot: u32,
    areas: &'a mut [f64],
    open: &'a mut [bool],
    doubled_areas: &'a mut [f64],
    seen: Vec<bool>,
    found: Found,
}

/// What a task finds; discs and slots that are not its own are kept aside.
#[derive(Default)]
struct Found {
    areas: Vec<(u32, f64)>,
    open: Vec<u32>,
    doubled_areas: Vec<(u32, f64)>,
    triangles: Vec<[u32; 3]>,
    diagonals: Vec<DualEdge>,
}

impl Triangulation<'_> {
    /// Triangulates all faces that are short simple loops; O(N).
    pub(super) fn faces(&self) -> Faces {
        let nodes = self.discs.len();
        let mut faces = Faces {
            areas: vec![0.0; nodes],
            open: vec![false; nodes],
            doubled_areas: vec![0.0; self.graph.half_edges()],
            ..Faces::default()
        };
        let tasks = self.tasks(&mut faces);
        let found: Vec<Found> = tasks.into_par_iter().map(|task| self.task(task)).collect();
        for found in found {
            for (disc, area) in found.areas {
                faces.areas[disc as usize] += area;
            }
            for disc in found.open {
                faces.open[disc as usize] = true;
            }
            for (slot, doubled) in found.doubled_areas {
                faces.doubled_areas[slot as usize] = doubled;
            }
            faces.triangles.push(found.triangles);
            faces.diagonals.extend(found.diagonals);
        }
        self.open_edges_without_length(&mut faces);
        faces
    }

    fn tasks<'a>(&self, faces: &'a mut Faces) -> Vec<Task<'a>> {
        let slots = by_nodes(self.graph.starts(), &mut faces.doubled_areas);
        let areas = faces.areas.chunks_mut(NODES_A_TASK);
        let open = faces.open.chunks_mut(NODES_A_TASK);
        let tasks = slots.into_iter().zip(areas).zip(open);
        let task = |(((nodes, doubled_areas), areas), open)| {
            let nodes: std::ops::Range<usize> = nodes;
            Task::new(nodes.start, self.graph.starts(), areas, open, doubled_areas)
        };
        tasks.map(task).collect()
    }

    /// The faces whose lowest slot belongs to the task.
    fn task(&self, mut task: Task<'_>) -> Found {
        let mut face = Face::default();
        for k in 0..task.areas.len() {
            let node = task.first + k as u32;
            let star = self.graph.star(node);
            if star.is_empty() {
                task.open[k] = true;
            }
            for slot in star {
                if task.seen[(slot - task.first_slot) as usize] {
                    continue;
                }
                let closed = face.walk(self, node, slot, |slot| task.see(slot));
                if closed && face.lowest < task.first_slot {
                    continue;
                }
                if closed && face.fill(self) {
                    task.keep(&face);
                } else {
                    task.open_face(&face);
                }
            }
        }
        task.found
    }

    /// Opens the ends of edges that, by their length, may not belong to the triangulation.
    fn open_edges_without_length(&self, faces: &mut Faces) {
        let nodes = self.discs.len() as u32;
        let firsts: Vec<u32> = (0..nodes).step_by(NODES_A_TASK).collect();
        let of_task = |&first: &u32| {
            let mut ends = Vec::new();
            for node in first..(first + NODES_A_TASK as u32).min(nodes) {
                for slot in self.graph.star(node) {
                    let HalfEdge { to, twin } = self.graph.half_edge(slot);
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
            faces.open[disc as usize] = true;
        }
    }

    /// The sum of the fingerprints of the triangles at a disc that is not open.
    pub(super) fn fingerprint_at(&self, disc: u32) -> u64 {
        let (mut face, mut sum) = (Face::default(), 0_u64);
        for slot in self.graph.star(disc) {
            face.walk(self, disc, slot, |_| {});
            // From where it was started before.
            if let Some(first) = face.corners.iter().find(|c| c.slot == face.lowest) {
                face.walk(self, first.disc.index, first.slot, |_| {});
            }
            face.fill(self);
            let own = face.triangles.iter().filter(|t| t.contains(&disc));
            sum = own.fold(sum, |sum, &triangle| {
                sum.wrapping_add(fingerprint(triangle))
            });
        }
        sum
    }
}

impl<'a> Task<'a> {
    fn new(
        first: usize,
        starts: &[u32],
        areas: &'a mut [f64],
        open: &'a mut [bool],
        doubled_areas: &'a mut [f64],
    ) -> Self {
        Self {
            first: first as u32,
            first_slot: starts[first],
            seen: vec![false; doubled_areas.len()],
            found: Found {
                // Twice as many triangles as discs, but for the boundary.
                triangles: Vec::with_capacity(2 * areas.len() + 64),
                ..Found::default()
            },
            areas,
            open,
            doubled_areas,
        }
    }

    fn see(&mut self, slot: u32) {
        let own = slot.checked_sub(self.first_slot);
        if let Some(seen) = own.and_then(|own| self.seen.get_mut(own as usize)) {
            *seen = true;
        }
    }

    /// Gives a face's areas to the cells of its corners and to its half-edges.
    fn keep(&mut self, face: &Face) {
        self.found.triangles.extend_from_slice(&face.triangles);
        self.found.diagonals.extend_from_slice(&face.diagonals);
        for corner in &face.corners {
            let disc = corner.disc.index;
            let own = disc.checked_sub(self.first);
            match own.and_then(|own| self.areas.get_mut(own as usize)) {
                Some(area) => *area += corner.area,
                None => self.found.areas.push((disc, corner.area)),
            }
            let own = corner.slot.checked_sub(self.first_slot);
            match own.and_then(|own| self.doubled_areas.get_mut(own as usize)) {
                Some(place) => *place = corner.doubled,
                None => self.found.doubled_areas.push((corner.slot, corner.doubled)),
            }
        }
    }

    fn open_face(&mut self, face: &Face) {
        for corner in &face.corners {
            let disc = corner.disc.index;
            let own = disc.checked_sub(self.first);
            match own.and_then(|own| self.open.get_mut(own as usize)) {
                Some(open) => *open = true,
                None => self.found.open.push(disc),
            }
        }
    }
}
