//! Placing grains: radii after a sieve curve, dropping, an advancing front, regular rows.
//!
//! In: sizes, a box and a seed. Out: grains that do not overlap, in the order of their ids.
//! The box stands on the floor y = 0 and reaches from x = 0 to its width.

pub mod advancing_front;
mod cells;
pub mod dropped;
mod error;
mod front;
pub mod random;
pub mod rows;
pub mod sieve;
mod skyline;
mod start;
pub mod statistics;
mod waiting;

pub use advancing_front::advancing_front;
pub use dropped::{Dropped, Support, Supports};
pub use error::PackingError;
pub use random::{Purpose, Stream};
pub use sieve::{Mass, SieveCurve, Sizes};

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
