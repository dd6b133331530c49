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
