//! The front of a growing pack: pockets between two grains, and where a grain comes to rest that is put into one.
//!
//! A grain of radius r that touches grains a and b, with ρ_a = r + R_a, ρ_b = r + R_b and the branch vector d from a to
//! b, has its centre to the left of a → b at
//!
//! ```math
//! x = x_a + \alpha\, d + \sqrt{\rho_a^2/d^2 - \alpha^2}\; d^\perp, \qquad
//! \alpha = \tfrac12 \Big(1 + \frac{(R_a - R_b)(\rho_a + \rho_b)}{d^2}\Big)
//! ```
//!
//! Where that place overlaps other grains, the grain rolls away from b on a, and away from a on b, from one place where
//! it touches a second grain to the next, until it overlaps none; of both places the one nearer to the middle is taken.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::assembly::Grain;
use crate::geometry::{Container, Vector};
use crate::packing::advancing_front::cells::Cells;

/// Stops of one roll; most need one or two.
const MOST_STOPS: usize = 32;
/// Ratio of the radii of a grain and a much smaller one.
const MUCH_LARGER: f64 = 3.0;
/// Depth below which a pocket is near a side, in radii of the grain tried.
const NEAR_SIDES: f64 = 3.0;
/// How much farther from the middle than the next pocket a grain may come to rest, in its radii.
const PATIENCE: f64 = 0.65;
/// Sectors of a ring, for each width of a ring that it lies away from the middle and each quarter turn.
const SECTORS: f64 = 0.25;
/// A grain that overlaps so many others at once is in no pocket of its size.
const MOST_OVERLAPPED: usize = 48;

/// Where a grain touches two others without overlap: its centre is to the left of `right` → `left`.
#[derive(Clone, Copy)]
pub(super) struct Place {
    centre: Vector,
    right: u32,
    left: u32,
}

/// Two grains and their left side, in the order of their turns and, within a turn, of the distance from the middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Pocket {
    /// Number of the ring, and of the sector in it.
    turn: (u32, u32),
    /// The bits of a positive number rise with it.
    distance: u64,
    right: u32,
    left: u32,
}

/// A growing pack.
pub(super) struct Front<'a> {
    pub(super) container: &'a Container,
    /// Where it grows from.
    pub(super) middle: Vector,
    pub(super) cells: Cells,
    /// How far a grain may leave the container by rounding, `[length]`.
    pub(super) rounding: f64,
    /// Radius by which pockets are put in order, and the smallest that they are opened for, `[length]`.
    pub(super) usual: f64,
    /// Width of the rings that are filled sector by sector, `[length]`.
    pub(super) ring_width: f64,
    pub(super) smallest: f64,
    pub(super) pockets: BinaryHeap<Reverse<Pocket>>,
}

impl Front<'_> {
    /// Whether a grain lies in the container.
    pub(super) fn is_inside(&self, grain: Grain) -> bool {
        self.container.depth(grain.centre) >= grain.radius - self.rounding
    }

    /// The pocket that is nearest to the middle; it is no longer open.
    pub(super) fn nearest(&mut self) -> Option<Pocket> {
        self.pockets.pop().map(|Reverse(pocket)| pocket)
    }

    /// Opens the pocket to the left of `right` → `left`.
    pub(super) fn open(&mut self, right: u32, left: u32) {
        let ends = [self.cells.grain(right), self.cells.grain(left)];
        if let Some(centre) = touching(ends[0], ends[1], self.usual) {
            let pocket = self.pocket(Place {
                centre,
                right,
                left,
            });
            self.pockets.push(Reverse(pocket));
        }
    }

    /// The pocket of two grains, in which a grain would rest there.
    fn pocket(&self, place: Place) -> Pocket {
        let Place {
            centre,
            right,
            left,
        } = place;
        let arm = centre - self.middle;
        let distance = arm.length();
        let ring = (distance / self.ring_width).floor();
        // Rises with the angle from 0 to 4.
        let slope = arm.y / (arm.x.abs() + arm.y.abs());
        let angle = if arm.x < 0.0 {
            3.0 - slope
        } else {
            1.0 + slope
        };
        let sector = angle * (ring * SECTORS).floor();
        Pocket {
            turn: (ring as u32, sector as u32),
            distance: distance.to_bits(),
            right,
            left,
        }
    }

    /// Puts a pocket back whose grain would rest much farther out than the next one's. Whether it did.
    pub(super) fn put_off(&mut self, pocket: Pocket, place: Place, radius: f64) -> bool {
        let (right, left) = (pocket.right, pocket.left);
        let later = self.pocket(Place {
            right,
            left,
            ..place
        });
        let Some(Reverse(next)) = self.pockets.peek() else {
            return false;
        };
        let far = f64::from_bits(next.distance) + PATIENCE * radius;
        let is_farther = later.turn > next.turn
            || later.turn == next.turn && f64::from_bits(later.distance) > far;
        let is_later = later > pocket && is_farther;
        if is_later {
            self.pockets.push(Reverse(later));
        }
        is_later
    }

    /// Adds a grain and opens the pockets beside it; the one towards its two supports where there is room at all.
    pub(super) fn add(&mut self, place: Place, radius: f64) {
        let Place {
            centre,
            right,
            left,
        } = place;
        let new = self.cells.push(Grain { centre, radius });
        self.open(right, new);
        self.open(new, left);
        let ends = [new, right, left].map(|number| self.cells.grain(number));
        if let Some(within) = touching(ends[0], ends[1], self.smallest) {
            let reach = ends[2].radius + self.smallest;
            if (within - ends[2].centre).length_squared() > reach * reach {
                self.open(new, right);
            }
        }
    }

    /// Below which radius another grain may take a pocket in place of one that does not fit: any smaller one near the
    /// sides, and one that is not much larger than those of the pocket in place of one that is.
    pub(super) fn may_fit(&self, pocket: Pocket, radius: f64) -> Option<f64> {
        let [right, left] = [pocket.right, pocket.left].map(|number| self.cells.grain(number));
        let end = if right.radius < left.radius {
            right
        } else {
            left
        };
        let much_larger = MUCH_LARGER * end.radius;
        let is_near_sides = self.container.depth(end.centre) < NEAR_SIDES * radius;
        if is_near_sides && radius <= much_larger {
            Some(radius)
        } else {
            (radius > much_larger).then_some(much_larger)
        }
    }

    /// Where a grain comes to rest that is put into a pocket.
    pub(super) fn place(&self, pocket: Pocket, radius: f64) -> Option<Place> {
        let Pocket { right, left, .. } = pocket;
        let ends = [right, left].map(|number| *self.cells.grain(number));
        let centre = touching(&ends[0], &ends[1], radius)?;
        // It would hardly roll back inside, and to look around a large grain takes time.
        if self.container.depth(centre) < 0.0 {
            return None;
        }
        let start = Place {
            centre,
            right,
            left,
        };
        let mut on_right = Roll::new(ends[0], radius, start, Turn::Left);
        let mut on_left = Roll::new(ends[1], radius, start, Turn::Right);
        let (mut ahead_right, mut ahead_left) = (Ahead::Nothing, Ahead::Nothing);
        let grain = Grain { centre, radius };
        let mut overlapped = 0;
        self.cells.overlapped(grain, |number, other| {
            ahead_right = on_right.meet(ahead_right, number, other);
            ahead_left = on_left.meet(ahead_left, number, other);
            overlapped += 1;
            overlapped < MOST_OVERLAPPED && (ahead_right.is_open() || ahead_left.is_open())
        });
        if overlapped == MOST_OVERLAPPED {
            return None;
        }
        if matches!(ahead_right, Ahead::Nothing) {
            return self.is_inside(grain).then_some(start);
        }
        let one = self.roll(&mut on_right, ahead_right);
        let other = self.roll(&mut on_left, ahead_left);
        match (one, other) {
            (Some(one), Some(other)) => {
                let distance = |place: Place| (place.centre - self.middle).length_squared();
                let is_nearer = distance(one) <= distance(other);
                Some(if is_nearer { one } else { other })
            }
            _ => one.or(other),
        }
    }

    /// Rolls a grain on until it overlaps no other; none if that is outside the container or behind its carrier.
    fn roll(&self, roll: &mut Roll, mut ahead: Ahead) -> Option<Place> {
        for _ in 0..MOST_STOPS {
            match ahead {
                Ahead::Nothing => return self.is_inside(roll.grain()).then_some(roll.place),
                Ahead::Stop { place, turned } => (roll.place, roll.turned) = (place, turned),
                Ahead::NoWay => return None,
            }
            ahead = Ahead::Nothing;
            self.cells.overlapped(roll.grain(), |number, other| {
                ahead = roll.meet(ahead, number, other);
                ahead.is_open()
            });
        }
        None
    }
}

/// To which side a grain turns about its carrier.
#[derive(Clone, Copy)]
enum Turn {
    /// Counter-clockwise.
    Left,
    /// Clockwise.
    Right,
}

/// A grain that rolls on its carrier.
struct Roll {
    carrier: Grain,
    radius: f64,
    turn: Turn,
    /// From the centre of the carrier to that of the grain at the start, by the square of their distance.
    start: Vector,
    place: Place,
    /// 1 − cos of the angle turned, which rises up to the half turn.
    turned: f64,
}

/// What is ahead of a rolling grain.
#[derive(Clone, Copy)]
enum Ahead {
    Nothing,
    /// Past the grains that it overlaps now.
    Stop {
        place: Place,
        turned: f64,
    },
    NoWay,
}

impl Ahead {
    fn is_open(self) -> bool {
        !matches!(self, Self::NoWay)
    }
}

impl Roll {
    fn new(carrier: Grain, radius: f64, place: Place, turn: Turn) -> Self {
        let from = place.centre - carrier.centre;
        Self {
            carrier,
            radius,
            turn,
            start: from * (1.0 / from.length_squared()),
            place,
            turned: 0.0,
        }
    }

    fn grain(&self) -> Grain {
        Grain {
            centre: self.place.centre,
            radius: self.radius,
        }
    }

    /// What is ahead if the grain must also get past an `other` one that it overlaps.
    fn meet(&self, ahead: Ahead, number: u32, other: &Grain) -> Ahead {
        let Some((centre, turned)) = self.past(other) else {
            return Ahead::NoWay;
        };
        match ahead {
            Ahead::NoWay => Ahead::NoWay,
            Ahead::Stop {
                turned: farther, ..
            } if farther >= turned => ahead,
            _ => {
                let mut place = Place {
                    centre,
                    ..self.place
                };
                match self.turn {
                    Turn::Left => place.left = number,
                    Turn::Right => place.right = number,
                }
                Ahead::Stop { place, turned }
            }
        }
    }

    /// Where the grain touches its carrier and an `other` grain that it has rolled past, and how far it has turned then.
    fn past(&self, other: &Grain) -> Option<(Vector, f64)> {
        let (centre, sense) = match self.turn {
            Turn::Left => (touching(&self.carrier, other, self.radius)?, 1.0),
            Turn::Right => (touching(other, &self.carrier, self.radius)?, -1.0),
        };
        let arm = centre - self.carrier.centre;
        let turned = 1.0 - self.start.dot(arm);
        let is_ahead = sense * self.start.cross(arm) >= 0.0 && turned >= self.turned;
        is_ahead.then_some((centre, turned))
    }
}

/// The centre of a grain of `radius` that touches a and b, to the left of a → b.
fn touching(a: &Grain, b: &Grain, radius: f64) -> Option<Vector> {
    let (one, other) = (a.radius + radius, b.radius + radius);
    let branch = b.centre - a.centre;
    let squared = branch.length_squared();
    let along = 0.5 * (1.0 + (a.radius - b.radius) * (one + other) / squared);
    let across = one * one / squared - along * along;
    (across >= 0.0).then(|| a.centre + branch * along + branch.quarter_turn() * across.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grain(x: f64, y: f64, radius: f64) -> Grain {
        Grain {
            centre: Vector::new(x, y),
            radius,
        }
    }

    #[test]
    fn a_grain_that_touches_two_lies_on_their_left() {
        // Legs 3, 4 and 5: radii 1, 2, 3 at the corners of that triangle.
        let (a, b) = (grain(0.0, 0.0, 1.0), grain(3.0, 0.0, 2.0));
        assert_eq!(touching(&a, &b, 3.0), Some(Vector::new(0.0, 4.0)));
        assert_eq!(touching(&b, &a, 3.0), Some(Vector::new(0.0, -4.0)));
        // A gap of 2 is bridged by radius 1 on the straight line, and by nothing smaller.
        let far = grain(4.0, 0.0, 1.0);
        assert_eq!(touching(&a, &far, 1.0), Some(Vector::new(2.0, 0.0)));
        assert_eq!(touching(&a, &far, 0.9), None);
    }
}
