//! Grains that touch at least two others each, placed from the middle of a convex container outwards.
//!
//! The first two grains touch in the middle. Every further grain is put into the open pocket nearest to the middle, beside
//! two grains, and rolls on one of them where others are in its way, until it touches two and overlaps none
//! (`front.rs`). It opens a pocket on either side, and one towards its supports where there is room for the smallest.
//! A pocket in which none of the radii that wait together fits is closed. So a disc grows until its grains are spent or no
//! pocket is open: the container is full.
//!
//! This is an advancing front (Feng, Han & Owen, 2003; Bagi, 2005) in which the front is not a chain but a heap of
//! pockets, as in the global method of Bennett (1972): it needs no closing of chains, and leaves room behind itself open.

mod cells;
mod front;
mod start;
mod waiting;

use std::f64::consts::PI;

use crate::assembly::Grain;
use crate::geometry::Container;
use crate::ids::PerGrain;
use crate::packing::advancing_front::start::start;
use crate::packing::advancing_front::waiting::Waiting;
use crate::packing::random::{Purpose, stream};
use crate::packing::{PackingError, Sizes, check_count, check_resolution, farthest};

/// More than any share of a container that grains fill in the first attempt.
const MOST_SOLID: f64 = 0.93;
/// Numbers of grains tried to fill a container; three or four are usual.
const MOST_ATTEMPTS: usize = 200;
/// Number of grains below which each lower number is tried.
const STEPWISE: usize = 1000;
/// Number of grains from which on small containers tell how many fit.
const LARGE: usize = 200_000;
/// Share of the grains that is left out for their error.
const SPARE: f64 = 0.003;
/// Grains as large as each that come after it at least.
const AFTER: f64 = 20.0;

/// Fills a convex container with touching grains, from the middle outwards; the ids are in the order of placing.
///
/// Every grain but the first two touches at least two others, to a few units in the last place of the coordinates;
/// none leaves the container by more than that, or overlaps another by 10⁻¹⁰ of the smallest radius more. A side is
/// touched by accident only.
///
/// With a `count` n the pack has exactly the radii of [`Sizes::radii`]. They come in random order, with two exceptions:
/// near the sides, and where it is three times as large as those it would touch, a grain that does not fit lets up to
/// seven smaller ones pass; and the grains after each have at least twenty times its area together, so that the last
/// are the smallest and fit into the last gaps.
///
/// Without a `count` the container is filled, and the radii are those of [`Sizes::radii`] for the number n that was
/// placed, so that the realised sieve curve keeps the bound told there. n is sought from above: after a number that
/// does not fit, the next is the number of mean grains with the area of those placed (some more at first; one less
/// each time below a thousand grains; 1/500 less, and larger grains brought forward, where only a few large ones are
/// left over). The first n of which all grains find a place is taken. In another order some per mille more might.
/// Above two hundred thousand grains, two small containers of the same shape tell an n that is likely to fit, less some
/// per mille, and the search starts there.
///
/// # Errors
/// Those of the sizes; grains wider than the largest circle in the container; with a `count`, a container that is full
/// before (it tells with how many).
pub fn advancing_front(
    container: &Container,
    sizes: &Sizes,
    count: Option<usize>,
    seed: u64,
) -> Result<PerGrain<Grain>, PackingError> {
    let Some(count) = count else {
        return fill(container, sizes, seed);
    };
    let packed = pack(container, sizes.radii(count, seed)?, AFTER, seed)?;
    let fitted = packed.grains.len();
    if fitted < count {
        return Err(PackingError::ContainerFull { count, fitted });
    }
    Ok(packed.grains.into())
}

fn fill(container: &Container, sizes: &Sizes, seed: u64) -> Result<PerGrain<Grain>, PackingError> {
    let most = at_most(container, sizes, seed)?;
    let likely = (most > LARGE).then(|| likely(container, sizes, most, seed));
    let likely = likely.flatten();
    let mut count = likely.unwrap_or(most);
    let (mut after, mut fitted, mut is_full) = (AFTER, 0, likely.is_some());
    for _ in 0..MOST_ATTEMPTS {
        check_count(count)?;
        let radii = sizes.radii(count, seed)?;
        let mean = mean_square(&radii);
        let packed = pack(container, radii, after, seed)?;
        fitted = packed.grains.len();
        if fitted == count && is_full {
            return Ok(packed.grains.into());
        }
        if fitted == count {
            count += count / 16 + 1;
            continue;
        }
        if count >= STEPWISE && count - fitted == packed.waiting.len() {
            count -= count / 500;
            after *= 2.0;
        } else {
            count = fewer(count, packed.room(mean), !is_full);
        }
        is_full = true;
    }
    Err(PackingError::ContainerFull { count, fitted })
}

/// The next lower number of grains to try after `count`, if there is room for about `room`.
fn fewer(count: usize, room: usize, is_first: bool) -> usize {
    let next = if is_first {
        // The room is uncertain by some grains.
        room + 2 + (room / 50).min(8)
    } else if count < STEPWISE {
        count - 1
    } else {
        room
    };
    next.min(count - 1).max(1)
}

/// A number of grains that is likely to fit, by a few per mille, as two small containers of the same shape tell.
///
/// At scale s grains fill an area of φ·(A·s² − w·U·s), since beside the sides (perimeter U) they lie less densely, so
/// the area over s is linear in s. None where the small containers cannot be filled.
fn likely(container: &Container, sizes: &Sizes, most: usize, seed: u64) -> Option<usize> {
    let small = |count: f64| {
        let scale = (count / most as f64).sqrt();
        let grains = fill(&container.scaled(scale), sizes, seed).ok()?;
        let area = grains
            .values()
            .iter()
            .map(|g| g.radius * g.radius)
            .sum::<f64>();
        Some((scale, area / scale, area / grains.len() as f64))
    };
    let ((s, a, _), (t, b, mean)) = (small(3e3)?, small(3e4)?);
    let area = b + (b - a) / (t - s) * (1.0 - t);
    let count = area / mean * (1.0 - SPARE);
    (count > 1.0 && count < most as f64).then_some(count as usize)
}

/// A number of grains that hardly fits.
fn at_most(container: &Container, sizes: &Sizes, seed: u64) -> Result<usize, PackingError> {
    let mut count = 1000;
    for _ in 0..2 {
        let mean = PI * mean_square(&sizes.radii(count, seed)?);
        count = (MOST_SOLID * container.area() / mean) as usize + 2;
        check_count(count)?;
    }
    Ok(count)
}

fn mean_square(radii: &[f64]) -> f64 {
    radii.iter().map(|r| r * r).sum::<f64>() / radii.len() as f64
}

/// Grains that were placed, and the radii that waited together when no pocket was left.
struct Packed {
    grains: Vec<Grain>,
    waiting: Vec<f64>,
}

impl Packed {
    /// Number of grains of a mean square radius that have the area of these, those that waited too long included.
    fn room(&self, mean: f64) -> usize {
        let radii = self
            .grains
            .iter()
            .map(|g| g.radius)
            .chain(self.waiting.iter().copied());
        (radii.map(|r| r * r).sum::<f64>() / mean) as usize
    }
}

/// Places as many grains as fit.
fn pack(
    container: &Container,
    mut radii: Vec<f64>,
    after: f64,
    seed: u64,
) -> Result<Packed, PackingError> {
    check_resolution(&radii, farthest(container))?;
    bring_forward(&mut radii, after, seed);
    let mut front = start(container, &radii, seed)?;
    let placed = front.cells.count();
    let mut waiting = Waiting::new(radii, placed);
    while !waiting.is_empty()
        && let Some(pocket) = front.nearest()
    {
        let fits = |radius| front.place(pocket, radius);
        let or_below = |radius| front.may_fit(pocket, radius);
        let Some(chosen) = waiting.choose(fits, or_below) else {
            continue;
        };
        if !front.put_off(pocket, chosen.answer, chosen.radius) {
            front.add(chosen.answer, chosen.radius);
            waiting.take(chosen.index);
        }
    }
    Ok(Packed {
        grains: front.cells.into_grains(),
        waiting: waiting.together().to_vec(),
    })
}

/// Exchanges grains with smaller ones before them until each is followed by `after` times its area.
fn bring_forward(radii: &mut [f64], after: f64, seed: u64) {
    const MOST_EXCHANGES: usize = 64;
    let mut stream = stream(seed, Purpose::Radii);
    let mut following = 0.0;
    for place in (1..radii.len()).rev() {
        for _ in 0..MOST_EXCHANGES {
            if after * radii[place] * radii[place] <= following {
                break;
            }
            let other = stream.below(place);
            if radii[other] < radii[place] {
                radii.swap(other, place);
            }
        }
        following += radii[place] * radii[place];
    }
}
