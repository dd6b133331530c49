//! One cell of the power diagram: a convex polygon that half-planes cut down.

use crate::geometry::Vector;
use crate::geometry::lifted::Lifted;
use crate::geometry::near_pairs::Disc;

/// Tags from here on are sides of the container, those below are discs.
pub(super) const SIDES: u32 = u32::MAX - (1 << 16);

/// The half-plane d·v ≤ c about the cell's centre, behind which `tag` lies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    d: Vector,
    c: f64,
    /// |d_x| + |d_y|.
    size: f64,
    /// Bound on the error of c.
    error: f64,
    pub(super) tag: u32,
}

impl Line {
    /// The radical axis of two discs: d = x_j − x_i, c = (|d|² + R_i² − R_j²)/2.
    pub(super) fn between(disc: &Disc, other: &Disc, noise: f64) -> Self {
        let d = other.centre - disc.centre;
        let squared = d.length_squared();
        let (r, s) = (disc.radius, other.radius);
        Self {
            d,
            c: 0.5 * (squared + (r - s) * (r + s)),
            size: d.x.abs() + d.y.abs(),
            error: noise + 8.0 * f64::EPSILON * (squared + r * r + s * s),
            tag: other.index,
        }
    }

    /// A side of the container at `distance` from the centre.
    pub(super) fn side(outward: Vector, distance: f64, side: u32) -> Self {
        Self {
            d: outward,
            c: distance,
            size: outward.x.abs() + outward.y.abs(),
            error: 0.0,
            tag: SIDES + side,
        }
    }

    /// Whether the line leaves all points alone whose squared distance is at most `squared`.
    pub(super) fn is_beyond(&self, squared: f64) -> bool {
        self.c > 0.0 && self.c * self.c > squared * self.d.length_squared() * (1.0 + 1e-6)
    }

    pub(super) fn is_disc(&self) -> bool {
        self.tag < SIDES
    }
}

/// An edge of the polygon, counter-clockwise from `start`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) line: Line,
    pub(super) start: Vector,
    /// Bound on the error of `start`.
    error: f64,
}

/// The polygon, about its disc's centre.
#[derive(Debug, Default)]
pub(super) struct Cell {
    pub(super) edges: Vec<Edge>,
    next: Vec<Edge>,
    excess: Vec<(f64, bool)>,
    /// Squared distance within which all vertices lie, rounding included.
    pub(super) farthest_squared: f64,
}

impl Cell {
    /// Starts with a polygon of lines counter-clockwise and the points where they start.
    pub(super) fn reset(&mut self, polygon: impl Iterator<Item = (Line, Vector)>) {
        self.edges.clear();
        self.edges.extend(polygon.map(|(line, start)| Edge {
            line,
            start,
            error: 0.0,
        }));
        self.find_farthest();
    }

    /// Empties the cell: another disc has it all.
    pub(super) fn clear(&mut self) {
        self.edges.clear();
        self.farthest_squared = 0.0;
    }

    /// Cuts away what is nearer to another disc; signs at radical centres are exact.
    pub(super) fn cut(&mut self, line: &Line, disc: u32, lifted: &Lifted<'_>) {
        self.excess.clear();
        let mut before = self.edges.len().wrapping_sub(1);
        for (m, edge) in self.edges.iter().enumerate() {
            let excess = line.d.dot(edge.start) - line.c;
            let (a, b) = (&self.edges[before].line, &edge.line);
            let reach = 4.0 * f64::EPSILON * (edge.start.x.abs() + edge.start.y.abs());
            let sure = excess.abs() > line.size * (edge.error + reach) + line.error;
            let outside = if sure || !a.is_disc() || !b.is_disc() {
                excess > 0.0
            } else {
                let exact = lifted.hides([disc, a.tag, b.tag], line.tag);
                exact.unwrap_or(excess > 0.0)
            };
            self.excess.push((excess, outside));
            before = m;
        }
        self.splice(line);
    }

    /// Cuts away what lies beyond a side of the container.
    pub(super) fn clip(&mut self, side: &Line) {
        self.excess.clear();
        for edge in &self.edges {
            let excess = side.d.dot(edge.start) - side.c;
            self.excess.push((excess, excess > 0.0));
        }
        self.splice(side);
    }

    /// Replaces the outside vertices by an edge on `line`.
    fn splice(&mut self, line: &Line) {
        let n = self.edges.len();
        let outside = |m: usize| self.excess[wrapped(m, n)].1;
        let Some(seed) = (0..n).filter(|&m| outside(m)).max_by(|&a, &b| {
            let (a, b) = (self.excess[a].0, self.excess[b].0);
            a.total_cmp(&b)
        }) else {
            return;
        };
        let Some(inside_after) = (1..n).find(|&k| !outside(seed + k)) else {
            self.clear();
            return;
        };
        let inside_before = (1..n).find(|&k| !outside(seed + n - k)).unwrap_or(1);
        let last_outside = wrapped(seed + inside_after - 1, n);
        let last_inside = wrapped(seed + n - inside_before, n);
        let kept = (n + 1) - (inside_before + inside_after - 1);
        let enter = self.crossing(last_inside, line, true);
        let leave = self.crossing(last_outside, line, false);
        self.next.clear();
        self.next.push(enter);
        self.next.push(leave);
        for k in 1..kept {
            self.next.push(self.edges[wrapped(last_outside + k, n)]);
        }
        std::mem::swap(&mut self.edges, &mut self.next);
        self.find_farthest();
    }

    /// The new edge that starts where `line` crosses edge m: the line's own where the edge leaves, else the rest of m.
    fn crossing(&self, m: usize, line: &Line, leaves: bool) -> Edge {
        let edge = &self.edges[m];
        let (a, b) = (&edge.line, line);
        let turn = a.d.cross(b.d);
        let sizes = a.size * b.size;
        let mut start = Vector::new(
            (a.c * b.d.y - b.c * a.d.y) * (1.0 / turn),
            (b.c * a.d.x - a.c * b.d.x) * (1.0 / turn),
        );
        let length = start.x.abs() + start.y.abs();
        let spread = a.error * b.size + b.error * a.size + 8.0 * f64::EPSILON * sizes * length;
        let mut error = spread / turn.abs();
        if !(turn.abs() > 1e-9 * sizes && error.is_finite()) {
            start = self.between_ends(m);
            error = (self.end(m) - edge.start).length() + edge.error;
        }
        Edge {
            line: if leaves { *line } else { edge.line },
            start,
            error,
        }
    }

    /// The point of edge m where the line that is cut with crosses, from the excess at the ends.
    fn between_ends(&self, m: usize) -> Vector {
        let n = self.edges.len();
        let (from, to) = (self.excess[m].0, self.excess[wrapped(m + 1, n)].0);
        let share = from / (from - to);
        let share = if share.is_finite() {
            share.clamp(0.0, 1.0)
        } else {
            0.5
        };
        let (start, end) = (self.edges[m].start, self.end(m));
        start + (end - start) * share
    }

    /// Where edge m ends.
    pub(super) fn end(&self, m: usize) -> Vector {
        self.edges[wrapped(m + 1, self.edges.len())].start
    }

    fn find_farthest(&mut self) {
        let reach = |e: &Edge| {
            let squared = e.start.length_squared();
            if e.error * e.error <= 1e-20 * squared {
                squared
            } else {
                let far = squared.sqrt() + e.error;
                far * far
            }
        };
        self.farthest_squared = self.edges.iter().map(reach).fold(0.0, f64::max);
    }

    /// Area of the polygon.
    pub(super) fn area(&self) -> f64 {
        let twice = |m: usize| self.edges[m].start.cross(self.end(m));
        0.5 * (0..self.edges.len()).map(twice).sum::<f64>()
    }

    /// Edge m on the side of −t and of +t of the foot of the centre on its line, t the outward normal turned by 90°.
    pub(super) fn parts(&self, m: usize) -> [f64; 2] {
        let d = self.edges[m].line.d;
        let tangent = d.quarter_turn() * (1.0 / d.length());
        let (from, to) = (self.edges[m].start.dot(tangent), self.end(m).dot(tangent));
        if from <= to {
            [-from, to]
        } else {
            // Rounding turned an edge of no length around.
            let middle = 0.5 * (from + to);
            [-middle, middle]
        }
    }

    /// The radical centres among the vertices: the discs behind the edges before and after, and the point.
    pub(super) fn radical_centres(&self) -> impl Iterator<Item = (u32, u32, Vector)> {
        let n = self.edges.len();
        (0..n).filter_map(move |m| {
            let (a, b) = (&self.edges[wrapped(m + n - 1, n)].line, &self.edges[m].line);
            let both = a.is_disc() && b.is_disc();
            both.then_some((a.tag, b.tag, self.edges[m].start))
        })
    }
}

/// `m` < 2n, back in 0..n.
fn wrapped(m: usize, n: usize) -> usize {
    if m < n { m } else { m - n }
}
