//! Random grains at a wanted packing fraction, without overlap, in any convex container.
//!
//! Grains are spread at random, as many as have the wanted area together, and relaxed as soft discs until none
//! overlap (O'Hern, Silbert, Liu & Nagel, 2003). Discs are larger than the grains by a play: where no overlap of the
//! discs is above it, the grains do not overlap. Where they would jam before, they exchange their radii.

mod exchange;
mod partners;
mod relaxation;
mod soft_discs;
mod spread;

use std::f64::consts::PI;

use crate::assembly::Grain;
use crate::geometry::{Container, Vector};
use crate::ids::PerGrain;
use crate::packing::target::exchange::densify;
use crate::packing::target::relaxation::Relaxation;
use crate::packing::target::soft_discs::{SoftDiscs, Sums};
use crate::packing::target::spread::spread;
use crate::packing::{PackingError, Sizes, check_resolution, farthest};

/// Play and iterations while the grains keep their radii.
const KEEPING: (f64, usize) = (1e-6, 1000);
/// Plays and numbers of exchanges of radii, one after the other.
const EXCHANGING: [(f64, usize); 2] = [(1e-4, 60), (1e-3, 60)];
/// Halvings of the range of scales that holds the nearest reached, and exchanges at each.
const HALVINGS: (usize, usize) = (6, 12);
/// Relative difference of scales that does not matter.
const SCALE_TOLERANCE: f64 = 1e-4;
/// Grains from which the mean area is estimated first.
const SAMPLE: usize = 4096;
/// Corrections of the number of grains.
const CORRECTIONS: usize = 8;

/// Random grains of the given sizes in a convex container at a wanted packing fraction, without overlap.
///
/// The packing fraction is π·Σ R² over the area of the whole container, and as many grains are taken as come nearest to
/// it: exact to half a grain. Grains pack less densely at a side, so away from the sides it is higher, about by the
/// factor 1 + 0.2·R̄·U/A (R̄ mean radius `[length]`, U perimeter `[length]`, A area `[length²]`). The radii are those
/// of [`Sizes::radii`].
///
/// The grains hardly touch: gaps of near neighbours are up to some 10⁻³ of the radii, so their contacts are best those
/// of all neighbours. Ids follow rows from the bottom, as the grains lay before they were relaxed. The seed alone
/// decides, not the number of threads.
///
/// # Errors
/// A packing fraction that is not between 0 and 1, sizes that are none, a largest grain that does not fit, and
/// [`PackingError::TargetMissed`] where grains still overlap after a fixed number of iterations.
pub fn target(
    container: &Container,
    sizes: &Sizes,
    packing_fraction: f64,
    seed: u64,
) -> Result<PerGrain<Grain>, PackingError> {
    let radii = radii(container, sizes, packing_fraction, seed)?;
    let mut soft = SoftDiscs::new(container, spread(container, &radii, seed));
    let reached = pack(&mut soft);
    if reached >= 1.0 {
        return Ok(soft.grains().collect());
    }
    Err(PackingError::TargetMissed {
        wanted: packing_fraction,
        nearest: solid_area(&radii) / container.area() * reached * reached,
    })
}

/// Relaxes the discs; the largest scale found at which the grains do not overlap: at least 1 where they are packed.
fn pack(soft: &mut SoftDiscs<'_>) -> f64 {
    let mut relaxation = Relaxation::new();
    let (play, iterations) = KEEPING;
    soft.set_scale(1.0 + play);
    let mut sums = relaxation.run(soft, enough(play), iterations);
    for (play, exchanges) in EXCHANGING {
        if touching_scale(soft, &sums) < 1.0 {
            soft.set_scale(1.0 + play);
            sums = densify(soft, &mut relaxation, enough(play), exchanges);
        }
    }
    let reached = touching_scale(soft, &sums);
    if reached < 1.0 {
        nearest_scale(soft, &mut relaxation, reached)
    } else {
        reached
    }
}

/// Overlap of the discs, by the sum of their radii, up to which the grains do not overlap, with a margin for rounding.
fn enough(play: f64) -> f64 {
    0.999 * play / (1.0 + play)
}

/// The scale at which the discs, where they are, touch and do not overlap.
fn touching_scale(soft: &SoftDiscs<'_>, sums: &Sums) -> f64 {
    soft.scale() * (1.0 - sums.largest)
}

/// The largest scale at which the discs find room, between `low`, where they have it, and 1.
fn nearest_scale(soft: &mut SoftDiscs<'_>, relaxation: &mut Relaxation, mut low: f64) -> f64 {
    let (halvings, exchanges) = HALVINGS;
    let mut high = 1.0;
    for _ in 0..halvings {
        let middle = 0.5 * (low + high);
        soft.set_scale(middle);
        let sums = densify(soft, relaxation, SCALE_TOLERANCE, exchanges);
        low = low.max(touching_scale(soft, &sums));
        if low < middle * (1.0 - SCALE_TOLERANCE) {
            high = middle;
        }
    }
    low
}

/// The radii of as many grains as come nearest to the packing fraction, if the largest fits.
fn radii(
    container: &Container,
    sizes: &Sizes,
    packing_fraction: f64,
    seed: u64,
) -> Result<Vec<f64>, PackingError> {
    if !(packing_fraction > 0.0 && packing_fraction < 1.0) {
        let fraction = packing_fraction;
        return Err(PackingError::PackingFraction { fraction });
    }
    let area = container.area();
    if !area.is_finite() {
        return Err(PackingError::BoxLength { length: area });
    }
    let radii = nearest_radii(sizes, packing_fraction * area, seed)?;
    check_resolution(&radii, farthest(container))?;
    let largest = radii.iter().fold(0.0_f64, |a, &b| a.max(b));
    if !fits(container, largest * (1.0 + KEEPING.0)) {
        let diameter = 2.0 * largest;
        return Err(PackingError::ContainerTooNarrow { diameter });
    }
    Ok(radii)
}

/// As many radii as come nearest to the `wanted` area together.
fn nearest_radii(sizes: &Sizes, wanted: f64, seed: u64) -> Result<Vec<f64>, PackingError> {
    let mut radii = sizes.radii(SAMPLE, seed)?;
    for _ in 0..CORRECTIONS {
        let count = (radii.len() as f64 * wanted / solid_area(&radii)).round();
        let count = (count as usize).max(1);
        if count == radii.len() {
            break;
        }
        radii = sizes.radii(count, seed)?;
    }
    let miss = |radii: &[f64]| (solid_area(radii) - wanted).abs();
    for count in [(radii.len() - 1).max(1), radii.len() + 1] {
        let other = sizes.radii(count, seed)?;
        if miss(&other) < miss(&radii) {
            radii = other;
        }
    }
    Ok(radii)
}

/// Area of grains with these radii.
fn solid_area(radii: &[f64]) -> f64 {
    PI * radii.iter().map(|r| r * r).sum::<f64>()
}

/// Whether a disc fits into the container: whether any of its points lies so deep.
fn fits(container: &Container, radius: f64) -> bool {
    let mut corners = container.corners().to_vec();
    for side in container.sides() {
        corners = cut(&corners, |point| side.distance(point) - radius);
    }
    !corners.is_empty()
}

/// The part of a convex polygon that is not below ground.
fn cut(corners: &[Vector], height: impl Fn(Vector) -> f64) -> Vec<Vector> {
    let mut left = Vec::with_capacity(corners.len() + 1);
    for (&a, &b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let (from, to) = (height(a), height(b));
        if from >= 0.0 {
            left.push(a);
        }
        if (from < 0.0) != (to < 0.0) {
            left.push(a + (b - a) * (from / (from - to)));
        }
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Container {
        let corners = [(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)].map(|(x, y)| Vector::new(x, y));
        Container::polygon(&corners)
    }

    #[test]
    fn the_largest_disc_in_a_triangle_is_its_inscribed_circle() {
        // Area 6 over half the perimeter, 6.
        assert!(fits(&triangle(), 1.0 - 1e-12));
        assert!(!fits(&triangle(), 1.0 + 1e-12));
    }

    #[test]
    fn the_number_of_grains_comes_nearest_to_the_area() {
        let equal = Sizes::Uniform { from: 1.0, to: 1.0 };
        for (grains, count) in [(0.2, 1), (1.4, 1), (2.6, 3), (99.4, 99), (50_000.6, 50_001)] {
            assert_eq!(nearest_radii(&equal, PI * grains, 1).unwrap().len(), count);
        }
    }

    #[test]
    fn grains_that_jam_reach_the_packing_fraction_at_which_they_touch() {
        // Two discs of radius r in a square of side a fit up to r = a/(2 + √2), on its diagonal.
        let corners = [(0.0, 0.0), (3.3, 0.0), (3.3, 3.3), (0.0, 3.3)];
        let square = Container::polygon(&corners.map(|(x, y)| Vector::new(x, y)));
        let grain = |x, y| Grain {
            centre: Vector::new(x, y),
            radius: 1.0,
        };
        let reached = pack(&mut SoftDiscs::new(
            &square,
            vec![grain(1.0, 1.1), grain(2.1, 2.2)],
        ));
        let wanted = 3.3 / (2.0 + 2_f64.sqrt());
        assert!(
            (reached - wanted).abs() < 2.0 * SCALE_TOLERANCE,
            "{reached}"
        );
    }
}
