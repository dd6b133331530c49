//! Placing grains: radii after a sieve curve, dropping, regular rows, a target packing fraction.
//!
//! In: sizes, a box and a seed. Out: grains that do not overlap, in the order of their ids.
//! The box stands on the floor y = 0 and reaches from x = 0 to its width; a target is packed in any convex container.

mod advancing_front;
pub mod dropped;
mod error;
mod exchange;
mod filling;
mod partners;
pub mod random;
mod relaxation;
mod rolling;
pub mod rows;
mod sides;
pub mod sieve;
mod skyline;
mod soft_discs;
mod spread;
pub mod statistics;
pub mod target;
mod wanted;

pub use advancing_front::advancing_front;
pub use dropped::{Bed, Dropped, Shape, Support, Supports};
pub use error::PackingError;
pub use random::{Purpose, Source, Stream};
pub use sieve::{Mass, SieveCurve, Sizes};
pub use target::target;

/// Most grains that are placed: ids and memory end somewhere above.
pub const MOST_GRAINS: usize = 1 << 28;

fn check_radius(radius: f64) -> Result<(), PackingError> {
    if radius > 0.0 && radius.is_finite() {
        Ok(())
    } else {
        Err(PackingError::Radius { radius })
    }
}

fn check_box(length: f64) -> Result<(), PackingError> {
    if length > 0.0 && length.is_finite() {
        Ok(())
    } else {
        Err(PackingError::BoxLength { length })
    }
}

fn check_count(count: usize) -> Result<(), PackingError> {
    match count {
        0 => Err(PackingError::NoGrains),
        1..=MOST_GRAINS => Ok(()),
        _ => Err(PackingError::TooManyGrains { most: MOST_GRAINS }),
    }
}
