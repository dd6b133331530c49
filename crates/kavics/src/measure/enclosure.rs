//! What lies to the left of a point: the nearest edge of a graph that a level ray meets.
//!
//! Edges are kept by rows of equal height, in each row from left to right, so that a ray looks at few of them. Only
//! rows with a ray are filled.

use crate::geometry::{Embedding, Vector};
use crate::measure::rows::Rows;

/// An edge as it is met in a row.
#[derive(Clone, Copy, Debug)]
struct Entry {
    /// Where it is leftmost.
    left: f64,
    /// Where this edge or one before it in the row is rightmost.
    reach: f64,
    /// Its lower end.
    low: Vector,
    /// Its upper end.
    high: Vector,
    /// Its half-edge downwards, with the points to the right of it on the left.
    downward: u32,
}

/// Where a ray to the left meets an edge, and how the edge leans there.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
struct Hit {
    x: f64,
    lean: f64,
}

/// For each point, the half-edge that has it on its left and is the first to the left of it; none where there is no
/// edge. A ray that runs through a node passes just above it. No edge is longer than `longest`.
pub(super) fn nearest_to_the_left(
    points: &[Vector],
    graph: &Embedding,
    centres: &[Vector],
    longest: f64,
) -> Vec<Option<u32>> {
    if points.is_empty() {
        return Vec::new();
    }
    let rows = Rows::new(centres);
    let filled = rows.fill(points, graph, centres, longest);
    let nearest = |&point: &Vector| nearest(&filled[rows.row(point.y)], point);
    points.iter().map(nearest).collect()
}

impl Rows {
    /// The edges of each row that one of the points lies in.
    fn fill(
        &self,
        points: &[Vector],
        graph: &Embedding,
        centres: &[Vector],
        longest: f64,
    ) -> Vec<Vec<Entry>> {
        let wanted = self.near(points, 0.0);
        let near = self.near(points, longest);
        let mut rows = vec![Vec::new(); self.count];
        for node in 0..graph.nodes() as u32 {
            let high = centres[node as usize];
            if !near[self.row(high.y)] {
                continue;
            }
            for slot in graph.star(node) {
                let low = centres[graph.half_edge(slot).to as usize];
                // The way back of this one is met at the other end.
                if high.y <= low.y {
                    continue;
                }
                let entry = Entry {
                    left: low.x.min(high.x),
                    reach: low.x.max(high.x),
                    low,
                    high,
                    downward: slot,
                };
                for row in self.row(low.y)..=self.row(high.y) {
                    if wanted[row] {
                        rows[row].push(entry);
                    }
                }
            }
        }
        for row in &mut rows {
            sort(row);
        }
        rows
    }

    /// Whether a row is within a distance of one of the points.
    fn near(&self, points: &[Vector], distance: f64) -> Vec<bool> {
        let mut begin = vec![0_i64; self.count + 1];
        for point in points {
            begin[self.row(point.y - distance)] += 1;
            begin[self.row(point.y + distance) + 1] -= 1;
        }
        let mut covered = 0;
        let count = |change: i64| {
            covered += change;
            covered > 0
        };
        begin[..self.count].iter().copied().map(count).collect()
    }
}

/// Sorts a row from left to right.
fn sort(row: &mut [Entry]) {
    row.sort_unstable_by(|a, b| a.left.total_cmp(&b.left).then(a.downward.cmp(&b.downward)));
    let mut reach = f64::NEG_INFINITY;
    for entry in row {
        reach = reach.max(entry.reach);
        entry.reach = reach;
    }
}

fn nearest(row: &[Entry], point: Vector) -> Option<u32> {
    let mut best: Option<(Hit, u32)> = None;
    let beginning = row.partition_point(|entry| entry.left < point.x);
    for entry in row[..beginning].iter().rev() {
        if best.is_some_and(|(hit, _)| entry.reach < hit.x) {
            break;
        }
        let hit = entry.hit(point);
        if hit.is_some_and(|hit| best.is_none_or(|(nearest, _)| hit > nearest)) {
            best = hit.map(|hit| (hit, entry.downward));
        }
    }
    best.map(|(_, downward)| downward)
}

impl Entry {
    /// Where a ray from `point` to the left meets the edge; its lower end belongs to it, its upper end does not.
    fn hit(&self, point: Vector) -> Option<Hit> {
        if !(self.low.y <= point.y && point.y < self.high.y) {
            return None;
        }
        let lean = (self.high.x - self.low.x) / (self.high.y - self.low.y);
        let x = self.low.x + lean * (point.y - self.low.y);
        (x < point.x).then_some(Hit { x, lean })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles side by side and a level edge above.
    fn drawing() -> ([Vector; 8], Embedding) {
        let centres = [
            (0.0, 0.0),
            (2.0, 0.0),
            (1.0, 2.0),
            (3.0, 0.0),
            (5.0, 0.0),
            (4.0, 2.0),
            (0.0, 3.0),
            (5.0, 3.0),
        ];
        let centres = centres.map(|(x, y)| Vector::new(x, y));
        let edges = [[0, 1], [1, 2], [0, 2], [3, 4], [4, 5], [3, 5], [6, 7]];
        let graph = Embedding::new(&centres, &edges);
        (centres, graph)
    }

    /// The ends of the edges first met, the upper one first.
    fn met(points: &[(f64, f64)]) -> Vec<Option<(u32, u32)>> {
        let (centres, graph) = drawing();
        let points: Vec<Vector> = points.iter().map(|&(x, y)| Vector::new(x, y)).collect();
        let ends = |slot: u32| {
            let half_edge = graph.half_edge(slot);
            (graph.half_edge(half_edge.twin).to, half_edge.to)
        };
        let found = nearest_to_the_left(&points, &graph, &centres, 5.0);
        found.into_iter().map(|slot| slot.map(ends)).collect()
    }

    #[test]
    fn a_ray_meets_the_nearest_edge_on_its_left() {
        let right_of_both = (9.0, 1.0);
        let between = (2.5, 0.5);
        let inside = (4.0, 0.5);
        let left_of_all = (-1.0, 1.0);
        let found = met(&[right_of_both, between, inside, left_of_all]);
        assert_eq!(found, [Some((5, 4)), Some((2, 1)), Some((5, 3)), None]);
    }

    #[test]
    fn a_ray_through_a_node_passes_just_above_it() {
        let level_with_the_bases = (9.0, 0.0);
        let level_with_the_tops = (9.0, 2.0);
        assert_eq!(met(&[level_with_the_bases]), [Some((5, 4))]);
        // From a node itself, the edges that leave it are not met.
        assert_eq!(met(&[(3.0, 0.0)]), [Some((2, 1))]);
        assert_eq!(met(&[level_with_the_tops]), [None]);
    }

    #[test]
    fn a_level_edge_is_never_met() {
        assert_eq!(met(&[(9.0, 3.0)]), [None]);
    }
}
