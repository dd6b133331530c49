//! How one grain comes to rest: it falls, rolls over grains and slides along sides.

use crate::assembly::Grain;
use crate::geometry::Vector;
use crate::ids::GrainId;
use crate::packing::dropped::sides::Sides;
use crate::packing::dropped::skyline::{Resting, Skyline};
use crate::packing::random::{Purpose, Source, Stream, stream};
use crate::packing::{Bed, PackingError, Support, Supports};

/// Relative difference of places over the radius below which a stop counts as touched at the start of a motion.
const TIE: f64 = 1e-9;
/// Falls and motions of one grain; a grain needs about three.
pub(super) const MOST_MOVES: usize = 100_000;
/// Abscissas that are tried for a grain before there is no room for it.
const MOST_STARTS: usize = 100;

/// A growing pack.
pub(super) struct Pack {
    sides: Sides,
    skyline: Skyline,
    positions: Stream,
    coins: Stream,
}

/// A grain at rest, and what it rests on.
pub(super) type Placed = (Grain, Supports);

/// A grain found no place to rest.
pub(super) struct Restless;

/// What carries a moving grain, or stops it.
#[derive(Clone, Copy)]
enum Body {
    Grain(Grain, GrainId),
    Side(usize),
}

/// Where a motion ends, and what stopped it (none: the grain leaves its carrier sideways).
struct Stop {
    centre: Vector,
    by: Option<Body>,
}

/// How a motion over one body after another ends.
enum Moved {
    Rests(Supports),
    Leaves,
}

/// A place (u, v) on the way of a roll relative to the carrier, u along the roll, v up, and what stops it there.
#[derive(Clone, Copy)]
struct Place {
    u: f64,
    v: f64,
    by: Option<Body>,
}

impl Place {
    /// Rises along the whole quarter circle from the top to the side, evenly sharp.
    fn progress(&self) -> f64 {
        self.u - self.v
    }
}

/// A grain that rolls on a carrier to the side σ = ±1.
#[derive(Clone, Copy)]
struct Roll {
    radius: f64,
    carrier: Grain,
    id: GrainId,
    direction: f64,
}

impl Pack {
    /// The grains of the bed, before the first drop.
    ///
    /// # Errors
    /// Those of the container.
    pub(super) fn new(bed: &Bed<'_>, radii: &[f64], seed: u64) -> Result<Self, PackingError> {
        let source = Source {
            seed,
            layer: bed.layer,
        };
        let largest = radii.iter().fold(0.0_f64, |a, &b| a.max(b));
        let sides = Sides::new(&bed.shape, largest)?;
        let resting = bed.resting.iter().map(|grain| grain.radius);
        let all = radii.iter().copied().chain(resting);
        let mut skyline = Skyline::new(sides.extent(), all);
        for &grain in bed.resting {
            skyline.push(grain);
        }
        Ok(Self {
            sides,
            skyline,
            positions: stream(source, Purpose::Positions),
            coins: stream(source, Purpose::Coins),
        })
    }

    /// Adds a grain to those at rest.
    pub(super) fn push(&mut self, grain: Grain) {
        self.skyline.push(grain);
    }

    /// The lowest of the places that a grain comes to rest at from random abscissas; none where it has no room.
    pub(super) fn lowest_place(
        &mut self,
        radius: f64,
        tries: usize,
    ) -> Result<Option<Placed>, Restless> {
        let mut lowest: Option<Placed> = None;
        for _ in 0..tries {
            let Some(centre) = self.start(radius) else {
                continue;
            };
            let place = self.place(Grain { centre, radius }).ok_or(Restless)?;
            if lowest.is_none_or(|(grain, _)| place.0.centre.y < grain.centre.y) {
                lowest = Some(place);
            }
        }
        Ok(lowest)
    }

    /// A random place to fall from that no grain takes.
    fn start(&mut self, radius: f64) -> Option<Vector> {
        (0..MOST_STARTS).find_map(|_| {
            let centre = self.sides.start(radius, &mut self.positions);
            self.has_room(centre, radius).then_some(centre)
        })
    }

    fn has_room(&self, centre: Vector, radius: f64) -> bool {
        let mut room = true;
        if centre.y < f64::INFINITY {
            let x = centre.x;
            self.skyline.search([x, x], radius, centre.y, |resting| {
                let reach = radius + resting.grain.radius;
                if (centre - resting.grain.centre).length_squared() < reach * reach {
                    room = false;
                    return f64::INFINITY;
                }
                centre.y
            });
        }
        room
    }

    /// Where a grain comes to rest that is let go.
    fn place(&mut self, mut moving: Grain) -> Option<Placed> {
        for _ in 0..MOST_MOVES {
            let carrier = self.fall(&mut moving);
            match self.move_over(&mut moving, carrier)? {
                Moved::Rests(supports) => return Some((moving, supports)),
                Moved::Leaves => {}
            }
        }
        None
    }

    /// Lets a grain fall onto the first grain or side below it.
    fn fall(&self, moving: &mut Grain) -> Body {
        let Grain { centre, radius } = *moving;
        let (mut y, side) = self.sides.landing(centre.x, radius);
        let mut carrier = Body::Side(side);
        self.skyline
            .search([centre.x, centre.x], radius, y, |resting| {
                let from = resting.grain.centre;
                let reach = radius + resting.grain.radius;
                let rise_squared = reach * reach - (centre.x - from.x) * (centre.x - from.x);
                // Only grains with lower centres can be below; the one just left is level with the falling grain.
                if rise_squared > 0.0 && from.y < centre.y {
                    let landing = (from.y + rise_squared.sqrt()).min(centre.y);
                    if landing > y {
                        y = landing;
                        carrier = Body::of(resting);
                    }
                }
                y
            });
        moving.centre.y = y.min(centre.y);
        carrier
    }

    /// Moves a grain over one carrier after another until it rests or leaves the last.
    fn move_over(&mut self, moving: &mut Grain, mut carrier: Body) -> Option<Moved> {
        let direction = self.direction(moving, &carrier);
        if direction == 0.0 {
            return Some(Moved::Rests(self.supports(carrier, None)));
        }
        for _ in 0..MOST_MOVES {
            let stop = match carrier {
                Body::Grain(grain, id) => {
                    let radius = moving.radius;
                    let roll = Roll {
                        radius,
                        carrier: grain,
                        id,
                        direction,
                    };
                    self.roll(moving.centre, &roll)
                }
                Body::Side(side) => self.slide(moving, side),
            };
            moving.centre = stop.centre;
            let Some(obstacle) = stop.by else {
                return Some(Moved::Leaves);
            };
            if !self.leads_on(moving, &obstacle, direction) {
                return Some(Moved::Rests(self.supports(carrier, Some(obstacle))));
            }
            carrier = obstacle;
        }
        None
    }

    /// To which side a grain moves that landed on a body: ±1, or 0 on a level side.
    fn direction(&mut self, moving: &Grain, carrier: &Body) -> f64 {
        let ahead = match carrier {
            Body::Grain(grain, _) => moving.centre.x - grain.centre.x,
            Body::Side(side) => -self.sides.outward(*side).x,
        };
        if ahead != 0.0 {
            ahead.signum()
        } else if matches!(carrier, Body::Side(_)) {
            0.0
        } else if self.coins.coin() {
            1.0
        } else {
            -1.0
        }
    }

    /// Whether a grain moves on over what stopped it: its centre, or the normal, is ahead of the obstacle.
    fn leads_on(&self, moving: &Grain, obstacle: &Body, direction: f64) -> bool {
        let ahead = match obstacle {
            Body::Grain(grain, _) => moving.centre.x - grain.centre.x,
            Body::Side(side) => -self.sides.outward(*side).x,
        };
        direction * ahead > 0.0
    }

    fn supports(&self, carrier: Body, obstacle: Option<Body>) -> Supports {
        let support = |body| match body {
            Body::Grain(_, id) => Support::Grain(id),
            Body::Side(side) => self.sides.support(side),
        };
        Supports {
            first: support(carrier),
            second: obstacle.map(support),
        }
    }

    /// Rolls a grain from `start` over its carrier.
    fn roll(&self, start: Vector, roll: &Roll) -> Stop {
        let base = roll.carrier.centre;
        let reach = roll.radius + roll.carrier.radius;
        let first = roll.direction * (start.x - base.x) - (start.y - base.y) - TIE * roll.radius;
        let mut stop = Place {
            u: reach,
            v: 0.0,
            by: None,
        };
        let take = |found: Place, stop: &mut Place| {
            let progress = found.progress();
            // Behind the top, u < −v, places have a progress that belongs to another one.
            if found.v >= 0.0
                && progress >= first
                && progress < stop.progress()
                && found.u > -found.v
            {
                *stop = found;
            }
        };
        let sides = self
            .sides
            .stops_of_roll(base, reach, roll.radius, roll.direction);
        for (side, [u, v]) in sides {
            let by = Some(Body::Side(side));
            take(Place { u, v, by }, &mut stop);
        }
        let end = base.x + roll.direction * stop.u;
        let path = [start.x.min(end), start.x.max(end)];
        self.skyline
            .search(path, roll.radius, base.y + stop.v, |resting| {
                if let Some(found) = roll.stop_by(resting) {
                    take(found, &mut stop);
                }
                base.y + stop.v
            });
        let mut centre = Vector::new(base.x + roll.direction * stop.u, base.y + stop.v);
        if let Some(Body::Side(side)) = stop.by {
            centre = self.sides.touch(centre, roll.radius, side);
        }
        Stop {
            centre,
            by: stop.by,
        }
    }

    /// Slides a grain down along a side.
    fn slide(&self, moving: &Grain, side: usize) -> Stop {
        let Grain { centre, radius } = *moving;
        let turned = self.sides.outward(side).quarter_turn();
        let along = if turned.y < 0.0 { turned } else { -turned };
        let (mut way, next) = self.sides.end_of_slide(centre, radius, side, along);
        let mut by = next.map(Body::Side);
        let end = centre.x + along.x * way;
        let path = [centre.x.min(end), centre.x.max(end)];
        let bound = centre.y + along.y * way;
        self.skyline.search(path, radius, bound, |resting| {
            let reach = radius + resting.grain.radius;
            let offset = resting.grain.centre - centre;
            let (ahead, beside) = (offset.dot(along), offset.cross(along));
            let half_chord_squared = reach * reach - beside * beside;
            if ahead > 0.0 && half_chord_squared > 0.0 {
                let found = ahead - half_chord_squared.sqrt();
                if found >= -TIE * radius && found < way {
                    (way, by) = (found, Some(Body::of(resting)));
                }
            }
            centre.y + along.y * way
        });
        let mut centre = self.sides.touch(centre + along * way, radius, side);
        if let Some(Body::Side(next)) = by {
            centre = self.sides.touch(centre, radius, next);
        }
        Stop { centre, by }
    }
}

impl Body {
    fn of(resting: &Resting) -> Self {
        Self::Grain(resting.grain, resting.id)
    }
}

impl Roll {
    /// The place where the moving grain, on its way, comes to touch a grain that is not its carrier.
    fn stop_by(&self, resting: &Resting) -> Option<Place> {
        let reach = self.radius + self.carrier.radius;
        let other_reach = self.radius + resting.grain.radius;
        let offset = resting.grain.centre - self.carrier.centre;
        let (du, dv) = (self.direction * offset.x, offset.y);
        let distance_squared = du * du + dv * dv;
        let sum = reach + other_reach;
        if distance_squared >= sum * sum || resting.id == self.id {
            return None;
        }
        let a = 0.5 * (1.0 + (reach * reach - other_reach * other_reach) / distance_squared);
        let b = (reach * reach / distance_squared - a * a).max(0.0).sqrt();
        Some(Place {
            u: a * du - b * dv,
            v: a * dv + b * du,
            by: Some(Body::of(resting)),
        })
    }
}
