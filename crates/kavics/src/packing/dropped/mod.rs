//! Grains dropped one after another: each falls, rolls over those at rest and slides along sides that slope, until it
//! rests on two supports.
//!
//! A grain of radius r falls at an abscissa x where it fits, in a box in [r, W − r]. On grain k, with ρ = r + R_k, its centre would lie at
//! y_k + √(ρ² − (x − x_k)²); it lands on the one where that is highest, or on a side. From there it rolls on k to
//! the side σ = ±1 on which its centre lies. Its place relative to k is (u, v): u along the roll, v up, u² + v² = ρ².
//! Until the grain leaves k sideways (v = 0), it is stopped by the first of
//!
//! - a side of the container with outward normal o, at (u, v) = h·o + √(ρ² − h²)·o⊥: h is the distance of k from the
//!   line that lies r inside the side, o⊥ is o turned against the roll;
//! - a grain j at (d_u, d_v) with d² = d_u² + d_v² ≤ (ρ + ρ_j)², ρ_j = r + R_j: the first intersection of both circles,
//!   u = a·d_u − b·d_v, v = a·d_v + b·d_u with a = (1 + (ρ² − ρ_j²)/d²)/2 and b = √(ρ²/d² − a²).
//!
//! Where its centre then lies between its carrier and the obstacle, or between the carrier and a side that rises ahead,
//! it rests. Otherwise it moves on over the obstacle to the same side: it rolls over a grain, and slides down along a
//! side until it touches another side or a grain. Where it leaves its carrier sideways, it falls again. Its centre only
//! sinks, so it comes to rest. This is the second model of Meakin & Jullien (1987): rolling on until a local minimum is
//! reached; sides that slope are ours.

mod filling;
mod rolling;
mod sides;
mod skyline;

use crate::assembly::Grain;
use crate::geometry::Container;
use crate::ids::{GrainId, PerGrain, SideId};
use crate::packing::dropped::rolling::{MOST_MOVES, Pack};
use crate::packing::{PackingError, check_count, check_radius, check_resolution, farthest};

pub use crate::packing::dropped::filling::fill;

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
    /// Largest coordinate that is known before grains are dropped.
    fn farthest(&self) -> f64 {
        match &self.shape {
            Shape::Box { width } => width.max(self.top.unwrap_or_default()),
            Shape::Polygon(container) => farthest(container),
        }
    }

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
    /// The floor of the box.
    Floor,
    /// A side of a polygon, by its number in [`Container::sides`].
    Side(SideId),
}

/// The supports of a grain: a level side alone, or two bodies that its centre lies between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Supports {
    /// The grain or side that it moved on last.
    pub first: Support,
    /// What stopped it; none on a level side alone.
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

/// Drops grains of the given `radii`, in their order, into a bed.
///
/// Each is dropped `tries` times at random abscissas and stays at the lowest place found. Where the bed has a top, the
/// dropping ends before the first grain that would be above it. Into a polygon grains fall from the highest place they
/// fit into at their abscissa; where a grain lies there, another abscissa is drawn, and after a hundred in a row without
/// room the dropping ends.
///
/// # Errors
/// No grains, radii or a width that are not positive, grains wider than the container, none that fits below the top.
pub fn drop(
    bed: &Bed<'_>,
    radii: &[f64],
    tries: usize,
    seed: u64,
) -> Result<Dropped, PackingError> {
    let dropped = drop_while_room(bed, radii, tries, seed)?;
    if dropped.grains.is_empty() {
        return Err(no_room(bed, radii[0]));
    }
    Ok(dropped)
}

/// Why a grain has no place in a bed.
pub(super) fn no_room(bed: &Bed<'_>, radius: f64) -> PackingError {
    let diameter = 2.0 * radius;
    match bed.top {
        Some(height) => PackingError::BoxTooLow { diameter, height },
        None => PackingError::NoRoom { diameter },
    }
}

/// As [`drop`], where no grain at all may find room.
pub(super) fn drop_while_room(
    bed: &Bed<'_>,
    radii: &[f64],
    tries: usize,
    seed: u64,
) -> Result<Dropped, PackingError> {
    check(radii, tries)?;
    check_resolution(radii, bed.farthest())?;
    let top = bed.top.unwrap_or(f64::INFINITY);
    let mut pack = Pack::new(bed, radii, seed)?;
    let mut grains = Vec::with_capacity(radii.len());
    let mut supports = Vec::with_capacity(radii.len());
    for (number, &radius) in radii.iter().enumerate() {
        let place = pack.lowest_place(radius, tries);
        let place = place.map_err(|_| PackingError::Restless {
            grain: number,
            moves: MOST_MOVES,
        })?;
        let Some((grain, on)) = place.filter(|(grain, _)| grain.centre.y + radius <= top) else {
            break;
        };
        pack.push(grain);
        grains.push(grain);
        supports.push(on);
    }
    Ok(Dropped {
        grains: grains.into(),
        supports: supports.into(),
    })
}

/// Whether all radii can be dropped.
fn check(radii: &[f64], tries: usize) -> Result<(), PackingError> {
    check_count(radii.len())?;
    if tries == 0 {
        return Err(PackingError::NoTries);
    }
    radii.iter().try_for_each(|&radius| check_radius(radius))
}
