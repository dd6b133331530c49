//! The grains that are met first along the normal of a side.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use crate::assembly::{Grain, Side};
use crate::ids::{GrainId, PerGrain};

/// A part of a side and the grain that is met first over it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvelopePart {
    /// The grain.
    pub grain: GrainId,
    /// Where the part begins, from the start of the side, `[length]`.
    pub from: f64,
    /// Where it ends, `[length]`.
    pub to: f64,
}

/// The parts of a side over which each grain is the first that is met along the side's normal from outside.
///
/// Exact for grains that do not overlap: their order changes only where the shadow of a grain begins or ends.
/// In order along the side; stretches over which no grain is met do not appear. O(N log N).
pub fn envelope(grains: &PerGrain<Grain>, side: &Side) -> Vec<EnvelopePart> {
    let mut shadows = shadows(grains, side);
    drop_hidden(&mut shadows, side.length());
    let mut ends: Vec<(f64, bool, usize)> = Vec::with_capacity(2 * shadows.len());
    for (k, shadow) in shadows.iter().enumerate() {
        ends.push((shadow.from(), true, k));
        ends.push((shadow.to(), false, k));
    }
    // What ends at a point goes before what begins there.
    ends.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut parts = Vec::new();
    let mut met = BTreeSet::new();
    let mut from = f64::NEG_INFINITY;
    for (to, begins, k) in ends {
        if to > from {
            add_part(&mut parts, &mut met, (from, to), side.length());
            from = to;
        }
        if begins {
            met.insert(shadows[k]);
        } else {
            met.remove(&shadows[k]);
        }
    }
    parts
}

/// Drops shadows of grains that others hide wherever they reach: by cells of the side, whose whole width some grain
/// shades.
fn drop_hidden(shadows: &mut Vec<Shadow>, length: f64) {
    let radii = shadows.iter().map(|shadow| shadow.radius).sum::<f64>();
    let cells = (length * shadows.len() as f64 / radii).clamp(1.0, shadows.len().max(1) as f64);
    let width = length / cells.floor();
    let mut hidden_below = vec![f64::INFINITY; cells as usize];
    let touched = |shadow: &Shadow| {
        let cell = |at: f64| ((at / width).max(0.0) as usize).min(cells as usize - 1);
        cell(shadow.from())..=cell(shadow.to())
    };
    for shadow in shadows.iter() {
        for cell in touched(shadow) {
            let (from, to) = (cell as f64 * width, (cell + 1) as f64 * width);
            if shadow.from() <= from && to <= shadow.to() {
                let deepest = shadow.depth(from).max(shadow.depth(to));
                hidden_below[cell] = deepest.min(hidden_below[cell]);
            }
        }
    }
    shadows.retain(|shadow| {
        let nearest = shadow.distance - shadow.radius;
        touched(shadow).any(|cell| nearest <= hidden_below[cell])
    });
}

fn add_part(
    parts: &mut Vec<EnvelopePart>,
    met: &mut BTreeSet<Shadow>,
    (from, to): (f64, f64),
    length: f64,
) {
    // Overlapping grains have no order, and one may have stayed in the set.
    while met.first().is_some_and(|s| s.to() <= from) {
        met.pop_first();
    }
    let Some(first) = met.first() else { return };
    let (from, to) = (from.max(0.0), to.min(length));
    if from >= to {
        return;
    }
    match parts.last_mut() {
        Some(last) if last.grain == first.grain && last.to == from => last.to = to,
        _ => parts.push(EnvelopePart {
            grain: first.grain,
            from,
            to,
        }),
    }
}

/// A grain as seen from the side.
#[derive(Clone, Copy, Debug)]
struct Shadow {
    grain: GrainId,
    /// Coordinate of the centre along the side.
    along: f64,
    /// Distance of the centre from the side.
    distance: f64,
    radius: f64,
}

fn shadows(grains: &PerGrain<Grain>, side: &Side) -> Vec<Shadow> {
    let direction = (side.end - side.start) * (1.0 / side.length());
    let shadow = |(grain, g): (GrainId, &Grain)| Shadow {
        grain,
        along: (g.centre - side.start).dot(direction),
        distance: side.distance(g.centre),
        radius: g.radius,
    };
    grains.iter().map(shadow).collect()
}

impl Shadow {
    fn from(&self) -> f64 {
        self.along - self.radius
    }

    fn to(&self) -> f64 {
        self.along + self.radius
    }

    /// Distance from the side at which the grain is met.
    fn depth(&self, at: f64) -> f64 {
        let u = at - self.along;
        self.distance - (self.radius * self.radius - u * u).max(0.0).sqrt()
    }
}

impl Ord for Shadow {
    /// Which is met first, in the middle of the common shadow.
    fn cmp(&self, other: &Self) -> Ordering {
        if self.grain == other.grain {
            return Ordering::Equal;
        }
        let middle = 0.5 * (self.from().max(other.from()) + self.to().min(other.to()));
        let depths = self.depth(middle).total_cmp(&other.depth(middle));
        depths.then(self.grain.cmp(&other.grain))
    }
}

impl PartialOrd for Shadow {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Shadow {
    fn eq(&self, other: &Self) -> bool {
        self.grain == other.grain
    }
}

impl Eq for Shadow {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::box_sides;
    use crate::geometry::Vector;
    use crate::ids::SideId;

    fn top(discs: &[(f64, f64, f64)]) -> Vec<(u32, f64, f64)> {
        let grain = |&(x, y, radius): &(f64, f64, f64)| Grain {
            centre: Vector::new(x, y),
            radius,
        };
        let sides = box_sides(8.0, 8.0, [false; 4]);
        let parts = envelope(&discs.iter().map(grain).collect(), &sides[SideId(3)]);
        parts.iter().map(|p| (p.grain.0, p.from, p.to)).collect()
    }

    #[test]
    fn a_higher_grain_hides_a_lower_one() {
        let discs = [(3.0, 2.0, 2.0), (4.0, 6.0, 1.0)];
        assert_eq!(top(&discs), [(0, 1.0, 3.0), (1, 3.0, 5.0)]);
        let discs = [(3.0, 2.0, 2.0), (3.0, 6.0, 1.0)];
        assert_eq!(top(&discs), [(0, 1.0, 2.0), (1, 2.0, 4.0), (0, 4.0, 5.0)]);
    }

    #[test]
    fn parts_end_with_the_side_and_gaps_stay_open() {
        let discs = [(0.0, 2.0, 1.0), (7.5, 2.0, 1.0)];
        assert_eq!(top(&discs), [(0, 0.0, 1.0), (1, 6.5, 8.0)]);
    }

    #[test]
    fn ends_of_hidden_grains_do_not_part_the_first() {
        let discs = [(4.0, 6.0, 2.0), (3.0, 2.0, 0.5), (4.0, 2.0, 0.25)];
        assert_eq!(top(&discs), [(0, 2.0, 6.0)]);
    }

    #[test]
    fn touching_grains_of_a_row_share_its_length() {
        let discs = [(1.0, 1.0, 1.0), (3.0, 1.0, 1.0), (5.0, 1.0, 1.0)];
        assert_eq!(top(&discs), [(0, 0.0, 2.0), (1, 2.0, 4.0), (2, 4.0, 6.0)]);
    }

    #[test]
    fn of_equal_grains_in_one_place_the_first_is_met() {
        assert_eq!(top(&[(2.0, 2.0, 1.0), (2.0, 2.0, 1.0)]), [(0, 1.0, 3.0)]);
    }
}
