//! Grains dropped one after another: each falls, then rolls over those at rest until it rests on two supports.
//!
//! A grain of radius r falls at an abscissa x in [r, W − r]. On grain k, with ρ = r + R_k, its centre would lie at
//! y_k + √(ρ² − (x − x_k)²); it lands on the one where that is highest, or on the floor. From there it rolls on k to
//! the side σ = ±1 on which its centre lies. Its place relative to k is (u, v): u along the roll, v up, u² + v² = ρ².
//! Until the grain leaves k sideways (v = 0), it is stopped by the first of
//!
//! - a side of the box, at u = σ·(x_w − x_k), and the floor, at v = r − y_k;
//! - a grain j at (d_u, d_v) with d² = d_u² + d_v² ≤ (ρ + ρ_j)², ρ_j = r + R_j: the upper intersection of both circles,
//!   u = a·d_u − b·d_v, v = a·d_v + b·d_u with a = (1 + (ρ² − ρ_j²)/d²)/2 and b = √(ρ²/d² − a²).
//!
//! At a side or on the floor it rests. Between two grains it rests where its centre lies between theirs; otherwise it
//! rolls on over j. Where it leaves k, it falls again. Its centre only sinks, so it comes to rest. This is the second
//! model of Meakin & Jullien (1987): rolling on until a local minimum is reached.

use crate::assembly::Grain;
use crate::geometry::{Container, Vector};
use crate::ids::{GrainId, PerGrain};
use crate::packing::random::{Purpose, Source, Stream, stream};
use crate::packing::skyline::Skyline;
use crate::packing::{PackingError, Sizes, check_box, check_count, check_radius};

/// What grains are dropped into.
#[derive(Clone, Debug)]
pub struct Bed<'a> {
    /// The container.
    pub shape: Shape,
    /// Grains that lie in it already, apart from each other. They carry the new ones but do not move.
    pub resting: &'a [Grain],
    /// Dropping ends before the first grain whose top would be above this height, `[length]`.
    pub top: Option<f64>,
    /// Number of the layer, from 0: each has random numbers of its own.
    pub layer: u32,
}

/// A container for dropped grains.
#[derive(Clone, Debug)]
pub enum Shape {
    /// From x = 0 to `width`, with the floor y = 0.
    Box {
        /// Width, `[length]`.
        width: f64,
    },
    /// A convex polygon.
    Polygon(Container),
}

impl Bed<'_> {
    /// An empty box of a `width`, open above.
    pub fn empty_box(width: f64) -> Self {
        Self {
            shape: Shape::Box { width },
            resting: &[],
            top: None,
            layer: 0,
        }
    }
}

/// What a grain rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// A grain of the bed or one that was dropped before: the grains of the bed come first, in their order.
    Grain(GrainId),
    /// The left side of the box.
    Left,
    /// The right side of the box.
    Right,
    /// The floor.
    Floor,
}

/// The supports of a grain: the floor alone, two grains, or a grain and a side or the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Supports {
    /// The floor, or the grain it rolled on last.
    pub first: Support,
    /// What stopped it; none on the floor alone.
    pub second: Option<Support>,
}

/// The grains dropped, without those that were in the bed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dropped {
    /// The grains in the order of dropping.
    pub grains: PerGrain<Grain>,
    /// What each rests on.
    pub supports: PerGrain<Supports>,
}

/// Relative difference of u − v over the radius below which a stop counts as touched at the start of a roll.
const TIE: f64 = 1e-9;
/// Falls and rolls of one grain; a grain needs about three.
const MOST_MOVES: usize = 100_000;

/// Drops grains of the given `radii`, in their order, into a bed.
///
/// Each is dropped `tries` times at random abscissas and stays at the lowest place found. Where the bed has a top, the
/// dropping ends before the first grain that would be above it.
///
/// # Errors
/// No grains, radii or a width that are not positive, grains wider than the box, none that fits below the top.
pub fn drop(
    bed: &Bed<'_>,
    radii: &[f64],
    tries: usize,
    seed: u64,
) -> Result<Dropped, PackingError> {
    let &Shape::Box { width } = &bed.shape else {
        return Err(PackingError::PolygonDropped);
    };
    check(width, radii, tries)?;
    let top = bed.top.unwrap_or(f64::INFINITY);
    let mut pack = Pack::new(bed, width, radii, seed);
    let mut grains = Vec::with_capacity(radii.len());
    let mut supports = Vec::with_capacity(radii.len());
    for (number, &radius) in radii.iter().enumerate() {
        let (grain, on) = pack
            .lowest_place(radius, tries)
            .ok_or(PackingError::Restless {
                grain: number,
                moves: MOST_MOVES,
            })?;
        if grain.centre.y + radius > top {
            break;
        }
        pack.skyline.push(grain);
        grains.push(grain);
        supports.push(on);
    }
    if grains.is_empty() {
        let diameter = 2.0 * radii[0];
        return Err(PackingError::BoxTooLow {
            diameter,
            height: top,
        });
    }
    Ok(Dropped {
        grains: grains.into(),
        supports: supports.into(),
    })
}

/// Fills a bed up to its top with dropped grains of the given sizes.
///
/// The number n of grains is such that n grains, graded as wanted to the last, fit below the top, and n + 1 do not;
/// it is found by halving, so that the realised sieve curve keeps the bound of [`Sizes::radii`].
///
/// # Errors
/// As [`drop`], and those of the sizes; a bed without a top.
pub fn fill(
    bed: &Bed<'_>,
    sizes: &Sizes,
    tries: usize,
    seed: u64,
) -> Result<Dropped, PackingError> {
    let height = bed.top.unwrap_or(f64::INFINITY);
    check_box(height)?;
    let source = Source {
        seed,
        layer: bed.layer,
    };
    let attempt = |count: usize| -> Result<Option<Dropped>, PackingError> {
        let radii = sizes.radii(count, source)?;
        let largest = radii.iter().fold(0.0_f64, |a, &b| a.max(b));
        if 2.0 * largest > height {
            let diameter = 2.0 * largest;
            return Err(PackingError::BoxTooLow { diameter, height });
        }
        let dropped = drop(bed, &radii, tries, seed)?;
        Ok((dropped.grains.len() == count).then_some(dropped))
    };
    let mut full = Dropped::default();
    let (mut fits, mut too_many) = (0, 1);
    while let Some(dropped) = attempt(too_many)? {
        full = dropped;
        (fits, too_many) = (too_many, 2 * too_many);
    }
    while too_many - fits > 1 {
        let count = fits.midpoint(too_many);
        if let Some(dropped) = attempt(count)? {
            full = dropped;
            fits = count;
        } else {
            too_many = count;
        }
    }
    Ok(full)
}

/// Whether all radii can be dropped.
fn check(width: f64, radii: &[f64], tries: usize) -> Result<(), PackingError> {
    check_count(radii.len())?;
    check_box(width)?;
    if tries == 0 {
        return Err(PackingError::NoTries);
    }
    radii.iter().try_for_each(|&radius| check_radius(radius))?;
    let diameter = 2.0 * radii.iter().fold(0.0_f64, |a, &b| a.max(b));
    if diameter > width {
        return Err(PackingError::BoxTooNarrow { diameter, width });
    }
    Ok(())
}

struct Pack {
    width: f64,
    skyline: Skyline,
    positions: Stream,
    coins: Stream,
}

/// A grain at rest that carries the moving one.
#[derive(Clone, Copy)]
struct Carrier {
    grain: Grain,
    id: GrainId,
}

/// A stop of a rolling grain: place (u, v) relative to its carrier, and what stopped it (none: it leaves sideways).
#[derive(Clone, Copy)]
struct Stop {
    u: f64,
    v: f64,
    by: Option<Obstacle>,
}

#[derive(Clone, Copy)]
enum Obstacle {
    Grain(Carrier),
    Side(f64),
    Floor,
}

/// How a roll ends.
enum Rolled {
    Rests(Grain, Supports),
    Leaves(Grain),
}

/// A grain that rolls on `carrier` to the side σ = ±1; it came from grain `before`.
#[derive(Clone, Copy)]
struct Roll {
    moving: Grain,
    carrier: Carrier,
    before: Option<GrainId>,
    side: f64,
}

impl Pack {
    /// The grains of the bed, before the first drop.
    fn new(bed: &Bed<'_>, width: f64, radii: &[f64], seed: u64) -> Self {
        let source = Source {
            seed,
            layer: bed.layer,
        };
        let all = || {
            radii
                .iter()
                .copied()
                .chain(bed.resting.iter().map(|g| g.radius))
        };
        let (smallest, largest) = all().fold((f64::INFINITY, 0.0_f64), |(low, high), radius| {
            (low.min(radius), high.max(radius))
        });
        let mut skyline = Skyline::new(width, smallest, largest, all().count());
        for &grain in bed.resting {
            skyline.push(grain);
        }
        Self {
            width,
            skyline,
            positions: stream(source, Purpose::Positions),
            coins: stream(source, Purpose::Coins),
        }
    }

    fn lowest_place(&mut self, radius: f64, tries: usize) -> Option<(Grain, Supports)> {
        let mut lowest: Option<(Grain, Supports)> = None;
        for _ in 0..tries {
            let room = (self.width - 2.0 * radius) * self.positions.unit();
            let place = self.place(radius, radius + room)?;
            if lowest.is_none_or(|(grain, _)| place.0.centre.y < grain.centre.y) {
                lowest = Some(place);
            }
        }
        lowest
    }

    /// Where a grain comes to rest that is dropped at x.
    fn place(&mut self, radius: f64, x: f64) -> Option<(Grain, Supports)> {
        let mut moving = Grain {
            centre: Vector::new(x, f64::INFINITY),
            radius,
        };
        for _ in 0..MOST_MOVES {
            let Some(carrier) = self.fall(&mut moving) else {
                let floor = Supports {
                    first: Support::Floor,
                    second: None,
                };
                return Some((moving, floor));
            };
            match self.roll_on(moving, carrier)? {
                Rolled::Rests(grain, supports) => return Some((grain, supports)),
                Rolled::Leaves(grain) => moving = grain,
            }
        }
        None
    }

    /// Lets a grain fall onto the first grain below it, or onto the floor (none).
    fn fall(&self, moving: &mut Grain) -> Option<Carrier> {
        let Grain { centre, radius } = *moving;
        let (mut y, mut carrier) = (radius, None);
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
                        carrier = Some(Carrier {
                            grain: resting.grain,
                            id: resting.id,
                        });
                    }
                }
                y
            });
        moving.centre.y = y;
        carrier
    }

    /// Rolls a grain over one carrier after another until it rests or leaves the last.
    fn roll_on(&mut self, moving: Grain, carrier: Carrier) -> Option<Rolled> {
        let ahead = moving.centre.x - carrier.grain.centre.x;
        let right = ahead > 0.0 || (ahead == 0.0 && self.coins.coin());
        let mut roll = Roll {
            moving,
            carrier,
            before: None,
            side: if right { 1.0 } else { -1.0 },
        };
        for _ in 0..MOST_MOVES {
            let stop = self.first_stop(&roll);
            let stopped = roll.at(&stop);
            let first = Support::Grain(roll.carrier.id);
            let rests = |by| {
                let second = Some(by);
                Some(Rolled::Rests(stopped, Supports { first, second }))
            };
            match stop.by {
                None => return Some(Rolled::Leaves(stopped)),
                Some(Obstacle::Floor) => return rests(Support::Floor),
                Some(Obstacle::Side(_)) if right => return rests(Support::Right),
                Some(Obstacle::Side(_)) => return rests(Support::Left),
                Some(Obstacle::Grain(next)) => {
                    if is_between(&stopped, &roll.carrier.grain, &next.grain) {
                        return rests(Support::Grain(next.id));
                    }
                    roll = Roll {
                        moving: stopped,
                        carrier: next,
                        before: Some(roll.carrier.id),
                        side: roll.side,
                    };
                }
            }
        }
        None
    }

    /// The first stop of a roll. Stops are compared by u − v, which rises along the whole quarter circle.
    fn first_stop(&self, roll: &Roll) -> Stop {
        let mut stop = roll.stop_of_box(self.width);
        let Grain { centre, radius } = roll.moving;
        let base = roll.carrier.grain.centre;
        let start = roll.side * (centre.x - base.x) - (centre.y - base.y) - TIE * radius;
        let end = base.x + roll.side * stop.u;
        let path = [centre.x.min(end), centre.x.max(end)];
        self.skyline
            .search(path, radius, base.y + stop.v, |resting| {
                let other = Carrier {
                    grain: resting.grain,
                    id: resting.id,
                };
                if let Some(found) = roll.stop_by(other) {
                    let place = found.u - found.v;
                    if found.v >= 0.0 && place >= start && place < stop.u - stop.v {
                        stop = found;
                    }
                }
                base.y + stop.v
            });
        stop
    }
}

impl Roll {
    /// Distance of the centres of the moving grain and its carrier.
    fn reach(&self) -> f64 {
        self.moving.radius + self.carrier.grain.radius
    }

    /// Where the roll ends at the latest: at the side of the carrier, on the floor, at the side of the box.
    fn stop_of_box(&self, width: f64) -> Stop {
        let (reach, radius, base) = (self.reach(), self.moving.radius, self.carrier.grain.centre);
        let other_leg = |leg: f64| (reach * reach - leg * leg).max(0.0).sqrt();
        let mut stop = Stop {
            u: reach,
            v: 0.0,
            by: None,
        };
        if base.y <= radius {
            let v = radius - base.y;
            stop = Stop {
                u: other_leg(v),
                v,
                by: Some(Obstacle::Floor),
            };
        }
        let x = if self.side > 0.0 {
            width - radius
        } else {
            radius
        };
        let u = self.side * (x - base.x);
        if u < stop.u {
            stop = Stop {
                u,
                v: other_leg(u),
                by: Some(Obstacle::Side(x)),
            };
        }
        stop
    }

    /// The upper of the two places where the moving grain touches its carrier and another grain.
    fn stop_by(&self, other: Carrier) -> Option<Stop> {
        if other.id == self.carrier.id || Some(other.id) == self.before {
            return None;
        }
        let reach = self.reach();
        let other_reach = self.moving.radius + other.grain.radius;
        let offset = other.grain.centre - self.carrier.grain.centre;
        let (du, dv) = (self.side * offset.x, offset.y);
        let distance_squared = du * du + dv * dv;
        if distance_squared >= (reach + other_reach) * (reach + other_reach) {
            return None;
        }
        let a = 0.5 * (1.0 + (reach * reach - other_reach * other_reach) / distance_squared);
        let b = (reach * reach / distance_squared - a * a).max(0.0).sqrt();
        Some(Stop {
            u: a * du - b * dv,
            v: a * dv + b * du,
            by: Some(Obstacle::Grain(other)),
        })
    }

    /// The moving grain at a stop; sides and floor are touched to the last bit.
    fn at(&self, stop: &Stop) -> Grain {
        let base = self.carrier.grain.centre;
        let mut centre = Vector::new(base.x + self.side * stop.u, base.y + stop.v);
        match stop.by {
            Some(Obstacle::Side(x)) => centre.x = x,
            Some(Obstacle::Floor) => centre.y = self.moving.radius,
            Some(Obstacle::Grain(_)) | None => {}
        }
        Grain {
            centre,
            radius: self.moving.radius,
        }
    }
}

/// Whether a grain on two others cannot roll off: its centre lies between theirs.
fn is_between(grain: &Grain, one: &Grain, other: &Grain) -> bool {
    let (x, a, b) = (grain.centre.x, one.centre.x, other.centre.x);
    x >= a.min(b) && x <= a.max(b)
}
