//! Filling a bed up to its top: the number of grains is sought by dropping them.
//!
//! A first number follows from the area there is, each further one from what the last attempt left free or left over.

use std::f64::consts::PI;

use crate::assembly::Grain;
use crate::geometry::{HalfPlane, Vector};
use crate::packing::dropped::sides::clipped;
use crate::packing::dropped::{drop_while_room, no_room};
use crate::packing::random::Source;
use crate::packing::{Bed, Dropped, MOST_GRAINS, PackingError, Shape, Sizes, check_box};

/// About the share of the area that dropped grains cover.
const COVERED: f64 = 0.82;
/// Grains from which the mean area is first estimated.
const SAMPLE: usize = 256;
/// Grains for each of which the number of those that fit is left open by one.
const GRAINS_A_MISS: usize = 256;

/// Fills a bed up to its top, or a polygon, with dropped grains of the given sizes.
///
/// Some n grains, graded as wanted to the last so that the realised sieve curve keeps the bound of [`Sizes::radii`], all
/// find room below the top, and n + g do not, with g = max(1, ⌊n/256⌋). It takes about five times the time of dropping
/// n grains once.
///
/// # Errors
/// As [`drop`](crate::packing::dropped::drop), and those of the sizes; a box without a top, grains higher than the box.
pub fn fill(
    bed: &Bed<'_>,
    sizes: &Sizes,
    tries: usize,
    seed: u64,
) -> Result<Dropped, PackingError> {
    let top = top(bed)?;
    let mut search = Search {
        full: Dropped::default(),
        too_many: None,
        step: 1,
    };
    let mut count = first_count(bed, sizes, seed, top)?;
    loop {
        let radii = radii(bed, sizes, count, seed)?;
        let dropped = drop_while_room(bed, &radii, tries, seed)?;
        let estimate = estimate(bed, &radii, &dropped, top);
        if dropped.grains.len() == count {
            search.full = dropped;
        } else if count == 1 {
            return Err(no_room(bed, radii[0]));
        } else {
            search.too_many = Some(count);
        }
        match search.next(estimate) {
            Some(next) => count = next,
            None => return Ok(search.full),
        }
    }
}

/// What is known of the number of grains that fit.
struct Search {
    full: Dropped,
    too_many: Option<usize>,
    /// Grows while only one limit is known.
    step: usize,
}

impl Search {
    /// The number to be tried next, near the estimate of the last attempt; none where the limits are close together.
    fn next(&mut self, estimate: usize) -> Option<usize> {
        let fits = self.full.grains.len();
        let gap = (fits / GRAINS_A_MISS).max(1);
        let step = gap.saturating_mul(self.step);
        self.step *= 2;
        match self.too_many {
            None => Some(estimate.max(fits + step)),
            Some(too_many) if fits == 0 => {
                let step = step * (too_many / GRAINS_A_MISS).max(1);
                Some(estimate.min(too_many.saturating_sub(step)).max(1))
            }
            Some(too_many) if too_many - fits <= gap => None,
            Some(too_many) => {
                // At least a quarter is settled by each attempt, and enough to end by the next one where it can be.
                let margin = ((too_many - fits) / 4).max(gap.min((too_many - fits) / 2));
                Some(estimate.clamp(fits + margin, too_many - margin))
            }
        }
    }
}

/// The height at which the bed ends.
fn top(bed: &Bed<'_>) -> Result<f64, PackingError> {
    let top = bed.top.unwrap_or(f64::INFINITY);
    match &bed.shape {
        Shape::Box { .. } => check_box(top).map(|()| top),
        Shape::Polygon(container) => {
            let corners = container.corners().iter();
            Ok(corners
                .fold(f64::NEG_INFINITY, |high, corner| high.max(corner.y))
                .min(top))
        }
    }
}

/// The radii of an attempt.
fn radii(bed: &Bed<'_>, sizes: &Sizes, count: usize, seed: u64) -> Result<Vec<f64>, PackingError> {
    let layer = bed.layer;
    let radii = sizes.radii(count, Source { seed, layer })?;
    let diameter = 2.0 * radii.iter().fold(0.0_f64, |a, &b| a.max(b));
    match (&bed.shape, bed.top) {
        (Shape::Box { .. }, Some(height)) if diameter > height => {
            Err(PackingError::BoxTooLow { diameter, height })
        }
        _ => Ok(radii),
    }
}

/// About the number of grains whose area is that which grains cover in the room there is.
fn first_count(bed: &Bed<'_>, sizes: &Sizes, seed: u64, top: f64) -> Result<usize, PackingError> {
    let resting: f64 = bed.resting.iter().map(|grain| area(grain.radius)).sum();
    let room = (COVERED * room(bed, top) - resting).max(0.0);
    let mut count = SAMPLE;
    for _ in 0..2 {
        // Few grains of a wide sieve curve have another mean area than many.
        let radii = sizes.radii(count, seed)?;
        let mean = radii.iter().map(|&radius| area(radius)).sum::<f64>() / count as f64;
        let wanted = room / mean;
        if wanted > MOST_GRAINS as f64 {
            return Err(PackingError::TooManyGrains { most: MOST_GRAINS });
        }
        count = (wanted as usize).max(1);
    }
    Ok(count)
}

/// The number of grains that would fit, by an attempt: in the room that is left, or by the share that found room.
fn estimate(bed: &Bed<'_>, radii: &[f64], dropped: &Dropped, top: f64) -> usize {
    let placed = dropped.grains.values();
    let wanted: f64 = radii.iter().map(|&radius| area(radius)).sum();
    let covered: f64 = placed.iter().map(|grain| area(grain.radius)).sum();
    let left = if placed.len() == radii.len() {
        let reached = |grain: &Grain| grain.centre.y + grain.radius;
        let highest = placed.iter().map(reached).fold(f64::NEG_INFINITY, f64::max);
        COVERED * (room(bed, top) - room(bed, highest))
    } else {
        0.0
    };
    (radii.len() as f64 * (covered + left) / wanted) as usize
}

fn area(radius: f64) -> f64 {
    PI * radius * radius
}

/// Area of the container below a height.
fn room(bed: &Bed<'_>, height: f64) -> f64 {
    match &bed.shape {
        Shape::Box { width } => width * height,
        Shape::Polygon(container) => {
            let line = HalfPlane {
                point: Vector::new(0.0, height),
                outward: Vector::new(0.0, 1.0),
            };
            let below = clipped(container.corners(), &line);
            if below.len() < 3 {
                return 0.0;
            }
            let first = below[0];
            let pairs = below.iter().zip(&below[1..]);
            0.5 * pairs
                .map(|(&a, &b)| (a - first).cross(b - first))
                .sum::<f64>()
        }
    }
}
