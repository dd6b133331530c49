//! The sieve curve that grains are wanted to have, whatever way their sizes are given.

use crate::packing::{Mass, SieveCurve, Sizes};

/// Steps of the diameter at which the curve of uniform radii is given.
const STEPS: u32 = 10;

impl Sizes {
    /// The wanted sieve curve: the one given, or that of uniform radii at ten equal steps of the diameter.
    ///
    /// By number, radii are even; by the mass of discs, P(d) = (d³ − a³)/(b³ − a³) between the diameters a and b.
    /// A single radius has a curve of one point.
    pub fn curve(&self) -> SieveCurve {
        match self {
            Self::Sieve(curve) => curve.clone(),
            &Self::Uniform { from, to } if from == to => SieveCurve {
                diameter: vec![2.0 * from],
                passing: vec![1.0],
                mass: Mass::Disc,
            },
            &Self::Uniform { from, to } => uniform(2.0 * from, 2.0 * to),
        }
    }
}

fn uniform(from: f64, to: f64) -> SieveCurve {
    let cube = |d: f64| d * d * d;
    let steps = (0..=STEPS).map(|step| f64::from(step) / f64::from(STEPS));
    let diameter: Vec<f64> = steps.map(|u| from * (1.0 - u) + to * u).collect();
    let share = |&d: &f64| (cube(d) - cube(from)) / (cube(to) - cube(from));
    SieveCurve {
        passing: diameter.iter().map(share).collect(),
        diameter,
        mass: Mass::Disc,
    }
}

impl SieveCurve {
    /// The curve of several kinds of grains together, each with its mass in any unit: the share that passes is the
    /// mean of theirs, weighted by mass. None where mass is not the same for all, where nothing has mass, and where a
    /// kind has one size only, which would be a jump.
    pub fn mixture(kinds: &[(f64, Self)]) -> Option<Self> {
        let mass = kinds.first()?.1.mass;
        let total: f64 = kinds.iter().map(|(weight, _)| weight).sum();
        let other = |(_, curve): &(f64, Self)| curve.mass != mass || curve.diameter.len() < 2;
        if total <= 0.0 || kinds.iter().any(other) {
            return None;
        }
        let diameters = kinds.iter().flat_map(|(_, curve)| &curve.diameter);
        let mut diameter: Vec<f64> = diameters.copied().collect();
        diameter.sort_unstable_by(f64::total_cmp);
        diameter.dedup();
        let passing = |&d: &f64| {
            let weighted = |(weight, curve): &(f64, Self)| weight * curve.share_passing(d);
            kinds.iter().map(weighted).sum::<f64>() / total
        };
        Some(Self {
            passing: diameter.iter().map(passing).collect(),
            diameter,
            mass,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(diameter: &[f64], passing: &[f64], mass: Mass) -> SieveCurve {
        SieveCurve {
            diameter: diameter.to_vec(),
            passing: passing.to_vec(),
            mass,
        }
    }

    #[test]
    fn uniform_radii_keep_their_own_curve() {
        let sizes = Sizes::Uniform { from: 0.5, to: 1.5 };
        let wanted = sizes.curve();
        wanted.check().unwrap();
        // (2³ − 1)/(3³ − 1) in the middle.
        assert!((wanted.passing[5] - 7.0 / 26.0).abs() < 1e-15);
        let radii = sizes.radii(100_000, 1).unwrap();
        let mass = |limit: f64| -> f64 {
            let below = radii.iter().filter(|r| 2.0 * *r <= limit);
            below.map(|r| r * r).sum()
        };
        for (diameter, passing) in wanted.diameter.iter().zip(&wanted.passing) {
            assert!((mass(*diameter) / mass(3.0) - passing).abs() < 1e-4);
        }
    }

    #[test]
    fn a_single_radius_passes_at_once() {
        let single = Sizes::Uniform { from: 1.0, to: 1.0 }.curve();
        assert_eq!(single.share_passing(2.0), 1.0);
        assert_eq!(single.share_passing(1.999), 0.0);
    }

    #[test]
    fn a_mixture_is_the_mean_by_mass() {
        let fine = curve(&[1.0, 2.0], &[0.0, 1.0], Mass::Disc);
        let coarse = curve(&[2.0, 4.0, 8.0], &[0.0, 0.5, 1.0], Mass::Disc);
        let both = SieveCurve::mixture(&[(3.0, fine.clone()), (1.0, coarse)]).unwrap();
        assert_eq!(both.diameter, [1.0, 2.0, 4.0, 8.0]);
        assert_eq!(both.passing, [0.0, 0.75, 0.875, 1.0]);
        let spheres = curve(&[1.0, 2.0], &[0.0, 1.0], Mass::Sphere);
        assert_eq!(
            SieveCurve::mixture(&[(1.0, fine.clone()), (1.0, spheres)]),
            None
        );
        let single = Sizes::Uniform { from: 1.0, to: 1.0 }.curve();
        assert_eq!(SieveCurve::mixture(&[(1.0, fine), (1.0, single)]), None);
        assert_eq!(SieveCurve::mixture(&[]), None);
    }
}
