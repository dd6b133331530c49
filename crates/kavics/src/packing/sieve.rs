//! Radii of grains after a sieve curve by mass, or uniform between two limits.
//!
//! In: a curve and a number of grains. Out: that many radii, stratified, in random order.
//! Within a class of the curve (between neighbouring diameters a < b) the share that passes is linear in ln d, so the
//! mass is spread evenly over ln d. With the mass of a grain ∝ dᵖ, a share u of the grains of the class (by number,
//! from the smallest) is finer than d(u), and the mean of dᵖ is m̄:
//!
//! ```math
//! d(u)^{-p} = a^{-p} - u\,(a^{-p} - b^{-p}), \qquad \bar m = \frac{p \ln(b/a)}{a^{-p} - b^{-p}}
//! ```

use crate::packing::random::{Purpose, Source, stream};
use crate::packing::{PackingError, check_count, check_radius, is_length};

/// How the mass of a grain grows with its diameter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mass {
    /// As d²: a disc.
    #[default]
    Disc,
    /// As d³: a sphere, for curves that were measured on real grains.
    Sphere,
}

impl Mass {
    /// dᵖ, the mass of a grain of diameter d but for a constant factor.
    pub fn of(self, diameter: f64) -> f64 {
        match self {
            Self::Disc => diameter * diameter,
            Self::Sphere => diameter * diameter * diameter,
        }
    }

    fn exponent(self) -> f64 {
        match self {
            Self::Disc => 2.0,
            Self::Sphere => 3.0,
        }
    }

    fn diameter(self, mass: f64) -> f64 {
        match self {
            Self::Disc => mass.sqrt(),
            Self::Sphere => libm::cbrt(mass),
        }
    }
}

/// Sieve curve: the share of the mass that passes a sieve, linear in ln d between the given diameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SieveCurve {
    /// Diameters of the sieves, rising, `[length]`.
    pub diameter: Vec<f64>,
    /// Share of the mass that passes each, not falling, from 0 to 1.
    pub passing: Vec<f64>,
    /// What mass is.
    pub mass: Mass,
}

/// Sizes of grains.
#[derive(Clone, Debug, PartialEq)]
pub enum Sizes {
    /// Radii spread evenly, by number.
    Uniform {
        /// Smallest radius, `[length]`.
        from: f64,
        /// Largest radius, `[length]`.
        to: f64,
    },
    /// A sieve curve by mass.
    Sieve(SieveCurve),
}

impl Sizes {
    /// `count` radii in random order; the source is a seed, or a seed and a layer.
    ///
    /// Uniform radii are the middles of `count` equal parts of the range. After a sieve curve, each class from the
    /// coarsest on gets as many grains as fit best what it and the coarser ones should weigh; then their diameters are
    /// moved within the class, keeping their order, until that mass is met to rounding. Where no diameters of the class
    /// meet it (few grains, or sieves close together), the share that passes the lower sieve is off by at most half a
    /// grain of that class or a coarser one, and the next finer class makes up for it. Between the sieves the share
    /// is off by about half of the heaviest grain near, as steps must be, and by more in a class whose limits differ
    /// by a few per cent and whose grains are heavy.
    ///
    /// # Errors
    /// No grains, a range or a curve that is none.
    pub fn radii(&self, count: usize, source: impl Into<Source>) -> Result<Vec<f64>, PackingError> {
        check_count(count)?;
        let mut radii = match self {
            &Self::Uniform { from, to } => uniform(from, to, count)?,
            Self::Sieve(curve) => {
                curve.check()?;
                curve.radii(count)
            }
        };
        stream(source, Purpose::Order).shuffle(&mut radii);
        Ok(radii)
    }
}

fn uniform(from: f64, to: f64, count: usize) -> Result<Vec<f64>, PackingError> {
    check_radius(from)?;
    check_radius(to)?;
    if from > to {
        return Err(PackingError::RadiusRange { from, to });
    }
    let step = (to - from) / count as f64;
    Ok((0..count).map(|i| from + step * (i as f64 + 0.5)).collect())
}

impl SieveCurve {
    /// Whether this is a sieve curve.
    ///
    /// # Errors
    /// The first thing that is wrong with it.
    pub fn check(&self) -> Result<(), PackingError> {
        let (diameters, passing) = (self.diameter.len(), self.passing.len());
        if diameters != passing || diameters < 2 {
            return Err(PackingError::SieveLength { diameters, passing });
        }
        let mut previous = 0.0;
        for (number, &diameter) in (1..).zip(&self.diameter) {
            if !(diameter > previous && is_length(diameter)) {
                return Err(PackingError::SieveDiameter {
                    number,
                    diameter,
                    previous,
                });
            }
            previous = diameter;
        }
        let mut previous = f64::NEG_INFINITY;
        for (number, &passing) in (1..).zip(&self.passing) {
            if !(passing >= previous && passing.is_finite()) {
                return Err(PackingError::SieveFalls {
                    number,
                    passing,
                    previous,
                });
            }
            previous = passing;
        }
        let (first, last) = (self.passing[0], self.passing[passing - 1]);
        if first != 0.0 || last != 1.0 {
            return Err(PackingError::SieveEnds { first, last });
        }
        Ok(())
    }

    /// Wanted share of the mass in grains up to `diameter`.
    pub fn share_passing(&self, diameter: f64) -> f64 {
        let above = self.diameter.partition_point(|&d| d <= diameter);
        if above == 0 {
            return 0.0;
        }
        if above == self.diameter.len() {
            return 1.0;
        }
        let (a, b) = (self.diameter[above - 1], self.diameter[above]);
        let (low, high) = (self.passing[above - 1], self.passing[above]);
        low + (high - low) * libm::log(diameter / a) / libm::log(b / a)
    }

    /// Radii of `count` grains, from the coarsest class to the finest.
    fn radii(&self, count: usize) -> Vec<f64> {
        let classes = self.classes();
        let (total, counts) = apportion(&classes, count);
        let mut radii = Vec::with_capacity(count);
        // What a class has too little of, the next finer one gets more of.
        let mut missing = 0.0;
        for (class, &count) in classes.iter().zip(&counts) {
            missing += total * class.share;
            for mass in class.masses(count, missing) {
                let diameter = self.mass.diameter(mass);
                radii.push(0.5 * diameter.clamp(class.from, class.to));
                missing -= mass;
            }
        }
        radii
    }

    /// The classes that hold mass, the coarsest first.
    fn classes(&self) -> Vec<Class> {
        let limits = self.diameter.windows(2).zip(self.passing.windows(2)).rev();
        limits
            .map(|(d, passing)| Class::new([d[0], d[1]], passing[1] - passing[0], self.mass))
            .filter(|class| class.share > 0.0)
            .collect()
    }
}

/// The grains between two neighbouring sieves.
#[derive(Clone, Copy, Debug)]
struct Class {
    from: f64,
    to: f64,
    /// Share of the whole mass.
    share: f64,
    /// 1/dᵖ at both limits.
    inverse_masses: [f64; 2],
    mean_mass: f64,
}

impl Class {
    fn new([from, to]: [f64; 2], share: f64, mass: Mass) -> Self {
        let inverse_masses = [1.0 / mass.of(from), 1.0 / mass.of(to)];
        Self {
            from,
            to,
            share,
            inverse_masses,
            mean_mass: mass.exponent() * libm::log(to / from)
                / (inverse_masses[0] - inverse_masses[1]),
        }
    }

    /// Mass of the grain that is coarser than a share u of the class, a little off the limits where classes meet.
    fn mass_at(&self, u: f64) -> f64 {
        let [fine, coarse] = self.inverse_masses;
        let inner = OFF_LIMITS + (1.0 - 2.0 * OFF_LIMITS) * u;
        1.0 / (fine - inner * (fine - coarse))
    }

    /// How many grains of the class weigh `wanted` best, and what they can weigh that is nearest to it.
    fn share_out(&self, wanted: f64) -> (usize, f64) {
        let count = (wanted / self.mean_mass).round().max(0.0);
        let (least, most) = (count * self.mass_at(0.0), count * self.mass_at(1.0));
        (count as usize, wanted.clamp(least, most))
    }

    /// Masses of `count` grains whose sum is `wanted`, or as near to it as the class allows.
    fn masses(&self, count: usize, wanted: f64) -> impl Iterator<Item = f64> + use<> {
        let class = *self;
        let bend = class.bend(count, wanted);
        (0..count).map(move |i| class.mass_at(bent(i, count, bend)))
    }

    /// The bend s of [`bent`] with which the masses add up to `wanted`: false position, as Illinois.
    fn bend(&self, count: usize, wanted: f64) -> f64 {
        let surplus = |bend: f64| -> f64 {
            let masses = (0..count).map(|i| self.mass_at(bent(i, count, bend)));
            masses.sum::<f64>() - wanted
        };
        let (mut low, mut high) = (0.0, 1.0);
        let (mut below, mut above) = (surplus(low), surplus(high));
        if below >= 0.0 {
            return low;
        }
        if above <= 0.0 {
            return high;
        }
        let mut bend = 0.5;
        for _ in 0..100 {
            let residual = surplus(bend);
            if residual.abs() <= 1e-14 * wanted {
                break;
            }
            if residual < 0.0 {
                (low, below, above) = (bend, residual, 0.5 * above);
            } else {
                (high, above, below) = (bend, residual, 0.5 * below);
            }
            bend = low + (high - low) * below / (below - above);
        }
        bend
    }
}

/// Share of a class by number at either limit that holds no grains.
const OFF_LIMITS: f64 = 1e-9;

/// Middle u of the stratum `i` of `count`, moved towards 1 by s > ½ and towards 0 by s < ½: s·u/(s·u + (1 − s)(1 − u)).
fn bent(i: usize, count: usize, bend: f64) -> f64 {
    let u = (i as f64 + 0.5) / count as f64;
    let (coarse, fine) = (bend * u, (1.0 - bend) * (1.0 - u));
    coarse / (coarse + fine)
}

/// The mass of all grains and how many each class gets, so that they are `count`.
///
/// The number of grains grows by one at a time as the mass grows, except where a class takes one grain more and the
/// finer ones many less; halving therefore ends at a mass with `count` grains.
fn apportion(classes: &[Class], count: usize) -> (f64, Vec<usize>) {
    let (mut low, mut high) = (0.0, classes[0].mean_mass);
    while share_out(classes, high).iter().sum::<usize>() <= count {
        (low, high) = (high, 2.0 * high);
    }
    let mut counts = share_out(classes, low);
    while counts.iter().sum::<usize>() != count {
        let total = 0.5 * (low + high);
        if total <= low || total >= high {
            break;
        }
        let more = share_out(classes, total);
        if more.iter().sum::<usize>() > count {
            high = total;
        } else {
            (low, counts) = (total, more);
        }
    }
    // Only if two classes change at the same mass.
    let placed: usize = counts.iter().sum();
    if let Some(finest) = counts.last_mut() {
        *finest += count - placed;
    }
    (low, counts)
}

/// Grains of each class if all together weigh `total`, each making up for what the coarser ones cannot hold.
fn share_out(classes: &[Class], total: f64) -> Vec<usize> {
    let mut missing = 0.0;
    let grains = classes.iter().map(|class| {
        missing += total * class.share;
        let (count, held) = class.share_out(missing);
        missing -= held;
        count
    });
    grains.collect()
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

    /// Largest deviation of the realised from the wanted share, at the sieves and at `parts` steps between them, and
    /// the heaviest grain's share of the mass.
    fn deviation(curve: &SieveCurve, count: usize, parts: i32) -> (f64, f64) {
        let mut radii = Sizes::Sieve(curve.clone()).radii(count, 1).unwrap();
        assert_eq!(radii.len(), count);
        radii.sort_by(f64::total_cmp);
        let mass = |r: &f64| curve.mass.of(2.0 * r);
        let total: f64 = radii.iter().map(mass).sum();
        let mut worst = 0.0_f64;
        for pair in curve.diameter.windows(2) {
            for part in 0..parts {
                let d = pair[0] * (pair[1] / pair[0]).powf(f64::from(part) / f64::from(parts));
                let below = radii.partition_point(|r| 2.0 * r <= d);
                let passing = radii[..below].iter().map(mass).sum::<f64>() / total;
                worst = worst.max((passing - curve.share_passing(d)).abs());
            }
        }
        (worst, mass(&radii[count - 1]) / total)
    }

    #[test]
    fn a_usual_curve_is_exact_at_the_sieves() {
        for mass in [Mass::Disc, Mass::Sphere] {
            let usual = curve(&[1.0, 2.0, 4.0], &[0.0, 0.6, 1.0], mass);
            for count in [50, 100, 1000, 10_000] {
                assert!(deviation(&usual, count, 1).0 < 1e-12);
            }
        }
    }

    #[test]
    fn between_the_sieves_a_curve_is_off_by_half_a_grain() {
        let usual = curve(&[1.0, 2.0, 4.0], &[0.0, 0.6, 1.0], Mass::Disc);
        let fuller = wide();
        for count in [1000, 10_000, 100_000] {
            assert!(deviation(&usual, count, 50).0 < 5.0 / count as f64);
            let (worst, heaviest) = deviation(&fuller, count, 50);
            assert!(worst < 0.7 * heaviest, "{worst} {heaviest}");
        }
    }

    #[test]
    fn narrow_classes_are_met_within_five_grains() {
        let narrow = curve(&[1.0, 1.01, 1.3, 1.31], &[0.0, 0.2, 0.2, 1.0], Mass::Disc);
        for count in [100, 345, 1000, 100_000] {
            assert!(deviation(&narrow, count, 1).0 < 5.0 / count as f64);
        }
    }

    #[test]
    fn with_few_grains_a_curve_is_off_by_half_a_grain_of_the_coarsest_class() {
        let diameter = [0.1, 0.101, 0.3, 0.303, 1.0, 1.01, 3.0, 3.03];
        let gaps = curve(
            &diameter,
            &[0.0, 0.1, 0.1, 0.4, 0.4, 0.6, 0.6, 1.0],
            Mass::Disc,
        );
        for count in [10, 30, 100, 300, 1000] {
            let radii = Sizes::Sieve(gaps.clone()).radii(count, 1).unwrap();
            let total: f64 = radii.iter().map(|r| 4.0 * r * r).sum();
            // No grain weighs more than 3.03².
            assert!(deviation(&gaps, count, 1).0 < 0.5 * 3.03 * 3.03 / total);
        }
    }

    #[test]
    fn a_wide_curve_is_exact_at_the_sieves_with_a_thousand_grains() {
        for count in [1000, 10_000, 100_000] {
            assert!(deviation(&wide(), count, 1).0 < 1e-10);
        }
    }

    /// Diameters 1 : 32, heaviest grain 32 768 times the lightest.
    fn wide() -> SieveCurve {
        curve(
            &[0.063, 0.125, 0.25, 0.5, 1.0, 2.0],
            &[0.0, 0.08, 0.12, 0.35, 0.7, 1.0],
            Mass::Sphere,
        )
    }

    #[test]
    fn uniform_radii_are_the_middles_of_equal_parts() {
        let mut radii = Sizes::Uniform { from: 1.0, to: 2.0 }.radii(4, 1).unwrap();
        radii.sort_by(f64::total_cmp);
        assert_eq!(radii, [1.125, 1.375, 1.625, 1.875]);
    }

    #[test]
    fn what_is_no_curve_is_refused() {
        let wrong = |d: &[f64], p: &[f64]| curve(d, p, Mass::Disc).check().unwrap_err().to_string();
        assert_eq!(
            wrong(&[1.0, 2.0, 3.0], &[0.0, 0.6, 0.5]),
            "passing 0.5 (number 3) of the sieve curve must not be below 0.6"
        );
        assert_eq!(
            wrong(&[1.0, 1.0], &[0.0, 1.0]),
            "diameter 1 (number 2) of the sieve curve must be above 1"
        );
        assert_eq!(
            wrong(&[1.0, 2.0], &[0.0, 0.9]),
            "the sieve curve must run from 0 to 1, not from 0 to 0.9"
        );
        assert_eq!(
            wrong(&[1.0], &[0.0, 0.9]),
            "a sieve curve needs a value for each of at least two diameters, not 2 for 1"
        );
    }
}
