//! Placing grains: radii after a sieve curve, dropping, an advancing front, a target packing fraction, regular rows.
//!
//! In: sizes, a container and a seed. Out: grains that do not overlap, in the order of their ids.
//! A box stands on the floor y = 0 and reaches from x = 0 to its width.

mod advancing_front;
pub mod dropped;
mod error;
pub mod random;
pub mod rows;
pub mod sieve;
pub mod statistics;
mod target;
mod wanted;

pub use advancing_front::advancing_front;
pub use dropped::{Bed, Dropped, Shape, Support, Supports};
pub use error::PackingError;
pub use random::{Purpose, Source, Stream};
pub use sieve::{Mass, SieveCurve, Sizes};
pub use target::target;

use crate::geometry::Container;

/// Most grains that are placed: ids and memory end somewhere above.
pub const MOST_GRAINS: usize = 1 << 28;

/// Largest and, as its reciprocal, smallest length: areas of larger ones overflow.
const LARGEST: f64 = 1e30;

fn is_length(value: f64) -> bool {
    (LARGEST.recip()..=LARGEST).contains(&value)
}

fn check_radius(radius: f64) -> Result<(), PackingError> {
    if is_length(radius) {
        Ok(())
    } else {
        Err(PackingError::Radius { radius })
    }
}

fn check_box(length: f64) -> Result<(), PackingError> {
    if is_length(length) {
        Ok(())
    } else {
        Err(PackingError::BoxLength { length })
    }
}

/// Whether the smallest of some radii is more than rounding, in a container whose corners have coordinates up to
/// `farthest`, `[length]`.
fn check_resolution(radii: &[f64], farthest: f64) -> Result<(), PackingError> {
    // 1e-10 of the container: its corners are known to 1e-16, so such a grain has six digits.
    const SMALLEST: f64 = 1e-10;
    let radius = radii.iter().fold(f64::INFINITY, |a, &b| a.min(b));
    if radius >= SMALLEST * farthest {
        Ok(())
    } else {
        Err(PackingError::TooSmall { radius, farthest })
    }
}

/// Largest coordinate of the corners of a container, whatever its sign.
fn farthest(container: &Container) -> f64 {
    let corners = container.corners().iter();
    corners.fold(0.0_f64, |far, c| far.max(c.x.abs()).max(c.y.abs()))
}

fn check_count(count: usize) -> Result<(), PackingError> {
    match count {
        0 => Err(PackingError::NoGrains),
        1..=MOST_GRAINS => Ok(()),
        _ => Err(PackingError::TooManyGrains { most: MOST_GRAINS }),
    }
}
