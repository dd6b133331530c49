//! Grains exchange their radii: those that are squeezed become smaller, those that are loose larger.
//!
//! Each grain wishes for a radius smaller than its own in proportion to the sum of its overlaps. The radii are dealt
//! again in the order of the wishes, so they stay the same as a whole. A pack jams at a higher packing fraction
//! where radii are free to move (Brito, Lerner & Wyart, 2018).

use crate::packing::target::relaxation::Relaxation;
use crate::packing::target::soft_discs::{SoftDiscs, Sums};

/// Iterations between two exchanges.
const ITERATIONS: usize = 50;
/// Change of a radius wished for, by the sum of the overlaps, at first.
const WISH: f64 = 0.3;
/// Largest change wished for, by the radius.
const LARGEST_WISH: f64 = 0.1;
/// An energy left by this share or more is slow progress.
const SLOW: f64 = 0.9;
/// Exchanges that may pass without progress.
const PATIENCE: usize = 20;

/// Exchanges radii and relaxes, at most `most` times, until no overlap is above `enough` or there is no progress.
pub(super) fn densify(
    soft: &mut SoftDiscs<'_>,
    relaxation: &mut Relaxation,
    enough: f64,
    most: usize,
) -> Sums {
    let mut sums = relaxation.run(soft, enough, ITERATIONS);
    let (mut wish, mut least, mut idle) = (WISH, sums.overlap, 0);
    for _ in 0..most {
        if sums.largest <= enough || idle > PATIENCE {
            break;
        }
        let before = sums.overlap;
        exchange(soft, wish);
        sums = relaxation.run(soft, enough, ITERATIONS);
        if sums.overlap > before {
            wish *= 0.5;
        } else if sums.overlap > SLOW * before {
            wish *= 1.5;
        }
        idle += 1;
        if sums.overlap < SLOW * least {
            (least, idle) = (sums.overlap, 0);
        }
    }
    sums
}

fn exchange(soft: &mut SoftDiscs<'_>, wish: f64) {
    let radii = soft.radii();
    let wish =
        |(&radius, squeeze): (&f64, f64)| radius - (wish * squeeze).min(LARGEST_WISH * radius);
    let wishes: Vec<f64> = radii.iter().zip(soft.squeezes()).map(wish).collect();
    let mut order: Vec<usize> = (0..radii.len()).collect();
    order.sort_by(|&a, &b| wishes[a].total_cmp(&wishes[b]));
    let mut rising = radii.to_vec();
    rising.sort_by(f64::total_cmp);
    let mut dealt = rising.clone();
    for (k, radius) in order.into_iter().zip(rising) {
        dealt[k] = radius;
    }
    soft.set_radii(dealt);
}
