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

use std::collections::BinaryHeap;
use std::f64::consts::PI;

use crate::assembly::Grain;
use crate::geometry::{Container, Vector};
use crate::ids::PerGrain;
use crate::packing::cells::Cells;
use crate::packing::front::Front;
use crate::packing::random::{Purpose, stream};
use crate::packing::waiting::{TOGETHER, Waiting};
use crate::packing::{PackingError, Sizes, check_count};

/// More than any share of a container that grains fill in the first attempt.
const MOST_SOLID: f64 = 0.93;
/// Numbers of grains tried to fill a container; three or four are usual.
const MOST_ATTEMPTS: usize = 200;
/// Grains as large as each that come after it at least.
const AFTER: f64 = 20.0;

/// Fills a convex container with touching grains, from the middle outwards; the ids are in the order of placing.
///
/// Every grain but the first two touches at least two others, to a few units in the last place of the coordinates;
/// none overlaps another or leaves the container by more than that.
///
/// With a `count` n the pack has exactly the radii of [`Sizes::radii`]. They come in random order, except that a grain
/// for which no other place is left than near the sides may let a few smaller ones pass, and that each is followed by
/// others of at least twenty times its area together: the last few are the smallest, and fit into the last gaps.
///
/// Without a `count` the container is filled. n is sought from above: the first number tried does not fit, and as long
/// as grains are left over, n is lowered by their area over the mean area (by one a time below a thousand grains; by a
/// five-hundredth, with larger grains brought forward, where only a few large ones are left over). The first n of which
/// all grains are placed is taken, so that the realised sieve curve keeps the bound of [`Sizes::radii`]. It is not the
/// largest n that could be placed: some per mille more might be in another order.
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
    let fitted = packed.len();
    if fitted < count {
        return Err(PackingError::ContainerFull { count, fitted });
    }
    Ok(packed.into())
}

fn fill(container: &Container, sizes: &Sizes, seed: u64) -> Result<PerGrain<Grain>, PackingError> {
    let mut count = at_most(container, sizes, seed)?;
    let mut after = AFTER;
    let mut fitted = 0;
    let mut is_full = false;
    for _ in 0..MOST_ATTEMPTS {
        check_count(count)?;
        let radii = sizes.radii(count, seed)?;
        let mean = mean_square(&radii);
        let packed = pack(container, radii, after, seed)?;
        fitted = packed.len();
        if fitted < count {
            let solid: f64 = packed.iter().map(|g| g.radius * g.radius).sum();
            (count, after) = fewer(count, fitted, (solid / mean) as usize, after, !is_full);
            is_full = true;
        } else if is_full {
            return Ok(packed.into());
        } else {
            count += count / 16 + 1;
        }
    }
    Err(PackingError::ContainerFull { count, fitted })
}

/// The next lower number of grains to try, and how many must come after each.
///
/// `count` were wanted, `fitted` were placed, and `by_area` is the number of usual grains with the area of those.
fn fewer(count: usize, fitted: usize, by_area: usize, after: f64, is_first: bool) -> (usize, f64) {
    let next = if is_first {
        // The estimate is uncertain by some grains; those few are tried one by one.
        (by_area + 2 + (by_area / 50).min(8), after)
    } else if count < 1000 {
        (count - 1, after)
    } else if count - fitted <= TOGETHER {
        (count - count / 500, 2.0 * after)
    } else {
        (by_area, after)
    };
    (next.0.clamp(1, (count - 1).max(1)), next.1)
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

/// Places as many grains as fit.
fn pack(
    container: &Container,
    mut radii: Vec<f64>,
    after: f64,
    seed: u64,
) -> Result<Vec<Grain>, PackingError> {
    bring_forward(&mut radii, after, seed);
    let mut front = start(container, &radii, seed)?;
    let placed = front.cells.count();
    let mut waiting = Waiting::new(radii, placed);
    while !waiting.is_empty()
        && let Some(pocket) = front.nearest()
    {
        let fits = |radius| front.place(pocket, radius);
        let or_smaller = |radius| front.may_take_smaller(pocket, radius);
        let Some(chosen) = waiting.choose(fits, or_smaller) else {
            continue;
        };
        if !front.put_off(pocket, chosen.answer, chosen.radius) {
            front.add(chosen.answer, chosen.radius);
            waiting.take(chosen.index);
        }
    }
    Ok(front.cells.into_grains())
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

/// A front of the first two grains, or of one where there is no room beside it.
fn start<'a>(
    container: &'a Container,
    radii: &[f64],
    seed: u64,
) -> Result<Front<'a>, PackingError> {
    let (mut smallest, mut largest, mut sum) = (f64::INFINITY, 0.0_f64, 0.0);
    for &radius in radii {
        (smallest, largest, sum) = (smallest.min(radius), largest.max(radius), sum + radius);
    }
    let corners = container.corners();
    let farthest = corners
        .iter()
        .fold(0.0_f64, |m, c| m.max(c.x.abs()).max(c.y.abs()));
    let rounding = 8.0 * f64::EPSILON * farthest;
    let middle = middle(container, largest, rounding)?;
    let region = region(container, middle, radii);
    let mut front = Front {
        container,
        middle,
        cells: Cells::new(region, radii, rounding),
        rounding,
        usual: sum / radii.len() as f64,
        smallest,
        pockets: BinaryHeap::new(),
    };
    let pair = first_pair(&front, radii, seed);
    for grain in pair {
        front.cells.push(grain);
    }
    if front.cells.count() == 2 {
        front.open(0, 1);
        front.open(1, 0);
    }
    Ok(front)
}

/// The first two grains, side by side in the middle in a random direction, or along a side or towards a corner.
fn first_pair(front: &Front, radii: &[f64], seed: u64) -> Vec<Grain> {
    let (container, middle) = (front.container, front.middle);
    let along = container
        .sides()
        .iter()
        .map(|side| side.outward.quarter_turn());
    let to_corners = container.corners().iter().map(|&corner| corner - middle);
    let mut directions = vec![random_direction(seed)];
    directions.extend(along.chain(to_corners));
    let first = Grain {
        centre: middle,
        radius: radii[0],
    };
    let Some(&radius) = radii.get(1) else {
        return vec![first];
    };
    for direction in directions {
        let unit = direction * (1.0 / direction.length());
        for shift in [radius, 0.0] {
            let centre = middle - unit * shift;
            let one = Grain { centre, ..first };
            let centre = centre + unit * (first.radius + radius);
            let other = Grain { centre, radius };
            if front.is_inside(one) && front.is_inside(other) {
                return vec![one, other];
            }
        }
    }
    vec![first]
}

/// A direction, all equally likely: a point of the square that lies in its circle.
fn random_direction(seed: u64) -> Vector {
    let mut stream = stream(seed, Purpose::Positions);
    loop {
        let point = Vector::new(2.0 * stream.unit() - 1.0, 2.0 * stream.unit() - 1.0);
        if (0.01..1.0).contains(&point.length_squared()) {
            return point;
        }
    }
}

/// Where a pack starts: the centroid, or the deepest point where the centroid is too near to a side.
fn middle(container: &Container, largest: f64, rounding: f64) -> Result<Vector, PackingError> {
    let centroid = centroid(container);
    if container.depth(centroid) >= 2.0 * largest {
        return Ok(centroid);
    }
    let deepest = deepest(container);
    let depth = container.depth(deepest);
    if depth >= largest - rounding {
        return Ok(deepest);
    }
    let (diameter, width) = (2.0 * largest, 2.0 * depth);
    Err(PackingError::ContainerTooNarrow { diameter, width })
}

fn centroid(container: &Container) -> Vector {
    let corners = container.corners();
    let (origin, next) = (corners[0], corners.iter().cycle().skip(1));
    let (mut moment, mut twice_area) = (Vector::default(), 0.0);
    for (&a, &b) in corners.iter().zip(next) {
        let (a, b) = (a - origin, b - origin);
        moment = moment + (a + b) * a.cross(b);
        twice_area += a.cross(b);
    }
    origin + moment * (1.0 / (3.0 * twice_area))
}

/// The point farthest from all sides, by trisection, as the depth is a concave function of x and of y.
fn deepest(container: &Container) -> Vector {
    let [low, high] = extent(container);
    let highest = |x: f64| {
        let depth = |y: f64| container.depth(Vector::new(x, y));
        let y = summit([low.y, high.y], depth);
        (y, depth(y))
    };
    let x = summit([low.x, high.x], |x| highest(x).1);
    Vector::new(x, highest(x).0)
}

/// Where a concave function of a number is largest.
fn summit([mut low, mut high]: [f64; 2], value: impl Fn(f64) -> f64) -> f64 {
    // (2/3)^100 is below the rounding of the interval.
    for _ in 0..100 {
        let third = (high - low) / 3.0;
        let (left, right) = (low + third, high - third);
        let (at_left, at_right) = (value(left), value(right));
        if at_left <= at_right {
            low = left;
        }
        if at_right <= at_left {
            high = right;
        }
    }
    low.midpoint(high)
}

fn extent(container: &Container) -> [Vector; 2] {
    let corners = container.corners().iter();
    corners.fold([container.corners()[0]; 2], |[low, high], c| {
        [
            Vector::new(low.x.min(c.x), low.y.min(c.y)),
            Vector::new(high.x.max(c.x), high.y.max(c.y)),
        ]
    })
}

/// A square about the middle that holds the pack, or nearly, within the extent of the container.
fn region(container: &Container, middle: Vector, radii: &[f64]) -> [Vector; 2] {
    let [low, high] = extent(container);
    let needed = 5.0 * radii.iter().map(|r| r * r).sum::<f64>();
    let mut half = needed.sqrt();
    let size = container.size();
    while half < size && area_within(container, middle, half) < needed {
        half *= 2.0;
    }
    [
        Vector::new(low.x.max(middle.x - half), low.y.max(middle.y - half)),
        Vector::new(high.x.min(middle.x + half), high.y.min(middle.y + half)),
    ]
}

/// Area of the container in a square about a point, by a raster.
fn area_within(container: &Container, middle: Vector, half: f64) -> f64 {
    const LINES: u32 = 64;
    let at = |k: u32| half * (f64::from(2 * k + 1) / f64::from(LINES) - 1.0);
    let points = (0..LINES * LINES).map(|k| Vector::new(at(k % LINES), at(k / LINES)));
    let inside = points
        .filter(|&p| container.depth(middle + p) >= 0.0)
        .count();
    inside as f64 * 4.0 * half * half / f64::from(LINES * LINES)
}
