//! The triangles between the cells that meet the container's boundary and the hull of all centres.
//!
//! Cells that reach beyond the container leave gaps among the triangles around their discs. A walk from gap to gap
//! goes once around all triangles that are known. Between it and the hull lie pockets, and on the left of an edge
//! of a pocket lies the corner with the lowest radical centre.

use crate::geometry::Vector;
use crate::geometry::dual_graph::not_turned_around;
use crate::geometry::lifted::Lifted;
use crate::geometry::near_pairs::Disc;
use crate::geometry::power_diagram::DualEdge;

/// Where triangles are missing around a disc `at`: counter-clockwise from neighbour `to` up to neighbour `from`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Gap {
    pub from: u32,
    pub at: u32,
    pub to: u32,
}

/// A triangle, counter-clockwise, and its radical centre.
pub(super) struct OuterTriangle {
    pub discs: [u32; 3],
    pub centre: Vector,
}

/// All triangles beyond the gaps; none, where the gaps do not fit together. About O(b log b) for b gaps.
pub(super) fn outer_triangles(
    mut gaps: Vec<Gap>,
    discs: &[Disc],
    lifted: &Lifted<'_>,
) -> Option<Vec<OuterTriangle>> {
    gaps.sort_unstable();
    let walk = Walk::new(&gaps, discs, lifted)?;
    let hull = walk.hull();
    let mut triangles = Vec::new();
    for (k, &start) in hull.iter().enumerate() {
        let end = hull[(k + 1) % hull.len()];
        // The walk goes clockwise around the known triangles, the hull counter-clockwise.
        let first = walk.place_facing(end, start)?;
        let last = walk.place_facing(start, end)?;
        walk.fill(first, last, &mut triangles)?;
    }
    Some(triangles)
}

/// The gaps in the order in which they are met, with what is missing on the left.
struct Walk<'a> {
    gaps: Vec<Gap>,
    /// Discs and their places in the walk, sorted.
    places: Vec<(u32, u32)>,
    discs: &'a [Disc],
    lifted: &'a Lifted<'a>,
}

impl<'a> Walk<'a> {
    /// None where the walk does not meet every gap once.
    fn new(sorted: &[Gap], discs: &'a [Disc], lifted: &'a Lifted<'a>) -> Option<Self> {
        let mut gaps = Vec::with_capacity(sorted.len());
        let mut gap = *sorted.first()?;
        while gaps.len() < sorted.len() {
            gaps.push(gap);
            let next = sorted.binary_search_by_key(&(gap.at, gap.to), |g| (g.from, g.at));
            gap = sorted[next.ok()?];
        }
        let mut places: Vec<_> = (0..).zip(&gaps).map(|(k, gap)| (gap.at, k)).collect();
        places.sort_unstable();
        let mut met = gaps.clone();
        met.sort_unstable();
        (met == sorted).then_some(Self {
            gaps,
            places,
            discs,
            lifted,
        })
    }

    /// The discs on the hull of the centres, counter-clockwise, those on its edges included (Andrew 1979).
    fn hull(&self) -> Vec<u32> {
        let mut discs: Vec<u32> = self.places.iter().map(|place| place.0).collect();
        discs.dedup();
        let centre = |disc: u32| self.discs[disc as usize].centre;
        discs.sort_unstable_by(|&a, &b| {
            let (p, q) = (centre(a), centre(b));
            p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
        });
        let mut lower = self.chain(discs.iter().copied());
        let mut upper = self.chain(discs.iter().rev().copied());
        lower.pop();
        upper.pop();
        lower.extend(upper);
        lower
    }

    /// The discs that remain where no turn is to the right.
    fn chain(&self, discs: impl Iterator<Item = u32>) -> Vec<u32> {
        let mut chain: Vec<u32> = Vec::new();
        for disc in discs {
            while let [.., a, b] = chain[..] {
                if !self.lifted.turns_left([b, a, disc]) {
                    break;
                }
                chain.pop();
            }
            chain.push(disc);
        }
        chain
    }

    /// The place of a disc from whose gap another can be seen.
    fn place_facing(&self, disc: u32, other: u32) -> Option<u32> {
        let from = self.places.partition_point(|place| place.0 < disc);
        let same = self.places[from..].iter().take_while(|p| p.0 == disc);
        let mut same = same.map(|place| place.1);
        same.find(|&place| self.faces(place, &[other]))
    }

    /// Whether others lie in the angle of the gap at a place; true without a look where the disc is met once.
    fn faces(&self, place: u32, others: &[u32]) -> bool {
        let Gap { from, at, to } = self.gaps[place as usize];
        let first = self.places.partition_point(|p| p.0 < at);
        let once = self.places.get(first + 1).is_none_or(|p| p.0 != at);
        let left = |a, b| self.lifted.turns_left([at, a, b]);
        let in_angle = |&other: &u32| {
            if other == from || other == to || from == to {
                true
            } else if left(to, from) {
                !left(other, to) && !left(from, other)
            } else {
                !(left(from, other) && left(other, to))
            }
        };
        once || others.iter().all(in_angle)
    }

    /// Triangulates the pocket between an edge of the hull and the walk from `first` to `last`.
    fn fill(&self, first: u32, last: u32, triangles: &mut Vec<OuterTriangle>) -> Option<()> {
        let count = self.gaps.len() as u32;
        let length = (last + count - first) % count;
        let place = |k: u32| (first + k) % count;
        let disc = |k: u32| self.gaps[place(k) as usize].at;
        let mut chains = vec![(0, length)];
        while let Some((low, high)) = chains.pop() {
            if high <= low + 1 {
                continue;
            }
            let edge = [disc(high), disc(low)].map(|d| &self.discs[d as usize]);
            let mut lowest = Lowest::new(edge, self.lifted);
            for k in low + 1..high {
                let other = disc(k);
                if other != edge[0].index && other != edge[1].index {
                    let sees = || self.faces(place(k), &[edge[0].index, edge[1].index]);
                    lowest.look(k, &self.discs[other as usize], sees);
                }
            }
            let (apex, centre) = lowest.found()?;
            let [a, b] = edge.map(|disc| disc.index);
            triangles.push(OuterTriangle {
                discs: [a, b, disc(apex)],
                centre,
            });
            chains.push((low, apex));
            chains.push((apex, high));
        }
        Some(())
    }
}

/// The corner on the left of an edge with the lowest radical centre, of those looked at.
pub(super) struct Lowest<'a> {
    edge: [&'a Disc; 2],
    lifted: &'a Lifted<'a>,
    along: Vector,
    squared: f64,
    /// Share of the edge from its first centre to the radical axis.
    pub(super) foot: f64,
    height: f64,
    slack: f64,
    corner: Option<(u32, u32)>,
}

impl<'a> Lowest<'a> {
    /// Of the edge from the first to the second disc.
    pub(super) fn new(edge: [&'a Disc; 2], lifted: &'a Lifted<'a>) -> Self {
        let [a, b] = edge;
        let along = b.centre - a.centre;
        let squared = along.length_squared();
        Self {
            edge,
            lifted,
            along,
            squared,
            foot: 0.5 * (1.0 + (a.radius - b.radius) * (a.radius + b.radius) / squared),
            height: f64::INFINITY,
            slack: 0.0,
            corner: None,
        }
    }

    /// Looks at a corner that is known by `name`; `allowed` is asked only where it would be the lowest.
    ///
    /// With q from the edge's first centre a, e along the edge and g the share of the foot of the radical axis, the
    /// radical centre is a + g e + h e⊥ with h = (q² + R_a² − R_q² − 2 g e·q)/(2 e×q). Exact where rounding matters.
    pub(super) fn look(&mut self, name: u32, disc: &Disc, allowed: impl Fn() -> bool) {
        let [a, b] = self.edge;
        let q = disc.centre - a.centre;
        let up = self.along.cross(q);
        let radii = (a.radius - disc.radius) * (a.radius + disc.radius);
        let q_squared = q.length_squared();
        let size = self.squared + q_squared + a.radius * a.radius + radii.abs();
        let turn = 4.0 * f64::EPSILON * size;
        if up < -turn {
            return;
        }
        let power = q_squared + radii - 2.0 * self.foot * self.along.dot(q);
        let inverse = 1.0 / up;
        let height = 0.5 * power * inverse;
        let error = 16.0 * turn + 4.0 * self.lifted.noise + height.abs() * 2.0 * turn;
        let error = error * inverse.abs();
        let better = if up > turn && (height - self.height).abs() > error + self.slack {
            height < self.height
        } else {
            let left = up > turn || self.lifted.turns_left([a.index, b.index, disc.index]);
            let hides = |corner: (u32, u32)| {
                let triangle = [a.index, b.index, corner.1];
                self.lifted.hides(triangle, disc.index) == Some(true)
            };
            left && self.corner.is_none_or(hides)
        };
        if better && allowed() {
            (self.height, self.slack) = (height, error);
            self.corner = Some((name, disc.index));
        }
    }

    /// The name of the lowest corner, and its radical centre.
    pub(super) fn found(&self) -> Option<(u32, Vector)> {
        let foot = self.edge[0].centre + self.along * self.foot;
        let centre = foot + self.along.quarter_turn() * self.height;
        self.corner.map(|(name, _)| (name, centre))
    }
    /// Length of the edge times that from the radical axis' foot to the radical centre.
    pub(super) fn doubled(&self) -> f64 {
        self.height * self.squared
    }

    /// The dual edge, by the edge's length times its parts on the right and on the left.
    pub(super) fn dual_edge(&self, doubled: [f64; 2]) -> DualEdge {
        let inverse = 1.0 / self.squared.sqrt();
        let parts = not_turned_around(doubled.map(|doubled| doubled * inverse));
        DualEdge::seen_from(self.edge[0].index, self.edge[1].index, parts)
    }
}
