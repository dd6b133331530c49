//! Axes of plots, with ticks at round numbers.

use crate::number::{show, tick};

/// From this ratio of the largest to the smallest value on, sizes are better seen by their logarithms.
const WIDE: f64 = 4.0;

/// From this ratio on, only powers of ten are ticks.
const DECADES: f64 = 200.0;

/// Below this share of the largest value a value is rounding.
const ROUNDING: f64 = 1e-9;

/// An axis, linear or logarithmic.
#[derive(Clone, Debug)]
pub struct Axis {
    low: f64,
    high: f64,
    logarithmic: bool,
    ticks: Vec<Tick>,
}

/// A mark of an axis.
#[derive(Clone, Debug)]
pub struct Tick {
    /// The value.
    pub value: f64,
    /// How it is shown.
    pub label: String,
}

impl Axis {
    /// The axis over `values`, with about `count` ticks.
    pub fn over(values: impl Iterator<Item = f64> + Clone, count: f64) -> Self {
        let [mut low, mut high] = extent(values);
        // What is near zero by comparison starts at zero, so that sizes can be compared.
        // So does what is rounding on the other side of it.
        if low > 0.0 && low < 0.5 * high || low < 0.0 && -low < ROUNDING * high {
            low = 0.0;
        } else if high < 0.0 && high > 0.5 * low || high > 0.0 && high < -ROUNDING * low {
            high = 0.0;
        }
        Self::linear(low, high, count)
    }

    fn linear(mut low: f64, mut high: f64, count: f64) -> Self {
        // Rounding is no curve.
        let least = ROUNDING * low.abs().max(high.abs());
        if high - low <= least {
            let half = if high == 0.0 { 0.5 } else { 0.1 * high.abs() };
            (low, high) = (low - half, high + half);
        }
        let step = round_step((high - low) / count);
        let (low, high) = ((low / step).floor() * step, (high / step).ceil() * step);
        Self {
            low,
            high,
            logarithmic: false,
            ticks: linear_ticks(low, high, step),
        }
    }

    /// The axis over sizes: logarithmic where they are spread widely.
    pub fn over_sizes(values: impl Iterator<Item = f64> + Clone, count: f64) -> Self {
        let [low, high] = extent(values);
        if low <= 0.0 || high < WIDE * low {
            return Self::linear(low, high, count);
        }
        let candidates = if high < DECADES * low {
            round_numbers(&[1.0, 2.0, 5.0], low, high)
        } else {
            round_numbers(&[1.0], low, high)
        };
        // From the last number below to the first above.
        let slack = 1e-9;
        let first = candidates.partition_point(|&v| v <= low * (1.0 + slack));
        let last = candidates.partition_point(|&v| v < high * (1.0 - slack));
        let kept = &candidates[first.saturating_sub(1)..=last.min(candidates.len() - 1)];
        let tick = |&value: &f64| Tick {
            value,
            label: show(value),
        };
        Self {
            low: kept[0],
            high: kept[kept.len() - 1],
            logarithmic: true,
            ticks: kept.iter().map(tick).collect(),
        }
    }

    /// Its marks, rising.
    pub fn ticks(&self) -> &[Tick] {
        &self.ticks
    }

    /// How far along the axis a value is, from 0 to 1.
    pub fn share(&self, value: f64) -> f64 {
        if self.logarithmic {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }
}

/// Smallest and largest of the finite values; 0 and 1 without any.
fn extent(values: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    let finite = values.filter(|value| value.is_finite());
    let low = finite.clone().fold(f64::INFINITY, f64::min);
    let high = finite.fold(f64::NEG_INFINITY, f64::max);
    if low > high { [0.0, 1.0] } else { [low, high] }
}

fn linear_ticks(low: f64, high: f64, step: f64) -> Vec<Tick> {
    let count = ((high - low) / step).round() as usize;
    let at = |number: usize| {
        let value = low + number as f64 * step;
        let value = if value.abs() < 1e-9 * step {
            0.0
        } else {
            value
        };
        Tick {
            value,
            label: tick(value, step),
        }
    };
    (0..=count).map(at).collect()
}

/// The factors times powers of ten, from a power below `low` to one above `high`.
fn round_numbers(factors: &[f64], low: f64, high: f64) -> Vec<f64> {
    let powers = low.log10().floor() as i32..=high.log10().floor() as i32 + 1;
    powers
        .flat_map(|power| factors.iter().map(move |factor| factor * 10f64.powi(power)))
        .collect()
}

/// 1, 2 or 5 times a power of ten, at most `value`; for what is not positive 0.
pub fn round_below(value: f64) -> f64 {
    if value <= 0.0 || !value.is_finite() {
        return 0.0;
    }
    let power = 10f64.powf(value.log10().floor());
    let fits = |factor: &f64| factor * power <= value * (1.0 + 1e-9);
    let factor = [5.0, 2.0, 1.0].into_iter().find(fits).unwrap_or(0.5);
    factor * power
}

/// 1, 2 or 5 times a power of ten, at least `rough`.
pub fn round_step(rough: f64) -> f64 {
    let power = 10f64.powf(rough.log10().floor());
    let factor = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|factor| factor * power >= rough * (1.0 - 1e-9))
        .unwrap_or(10.0);
    factor * power
}

#[cfg(test)]
mod tests {
    use super::{Axis, round_below, round_step};

    fn values(axis: &Axis) -> Vec<f64> {
        axis.ticks().iter().map(|tick| tick.value).collect()
    }

    #[test]
    fn ticks_stand_at_round_numbers() {
        let axis = Axis::over([0.0, 0.37].into_iter(), 5.0);
        assert_eq!(axis.ticks().len(), 5);
        assert!((axis.high - 0.4).abs() < 1e-12);
        assert!((round_step(0.074) - 0.1).abs() < 1e-15);
    }

    #[test]
    fn a_number_is_rounded_down_to_one_two_or_five() {
        let rounded = [7.3, 5.0, 4.9, 0.0199, -1.0].map(round_below);
        for (found, expected) in rounded.into_iter().zip([5.0, 5.0, 2.0, 0.01, 0.0]) {
            assert!((found - expected).abs() <= 1e-12, "{found} {expected}");
        }
    }

    #[test]
    fn rounding_below_zero_makes_no_room() {
        let axis = Axis::over([-1e-12, 30.0].into_iter(), 5.0);
        assert_eq!((axis.low, axis.high), (0.0, 30.0));
        let axis = Axis::over([-30.0, 1e-12].into_iter(), 5.0);
        assert_eq!((axis.low, axis.high), (-30.0, 0.0));
    }

    #[test]
    fn a_constant_has_an_axis_around_it() {
        let axis = Axis::over([3.0, 3.0].into_iter(), 5.0);
        assert!(axis.low < 3.0 && axis.high > 3.0);
    }

    #[test]
    fn wide_sizes_stand_by_their_logarithms() {
        let axis = Axis::over_sizes([1.5, 12.0].into_iter(), 5.0);
        assert_eq!(values(&axis), [1.0, 2.0, 5.0, 10.0, 20.0]);
        assert!((axis.share(10.0) - 10f64.ln() / 20f64.ln()).abs() < 1e-12);
        let decades = Axis::over_sizes([0.01, 10.0].into_iter(), 5.0);
        assert_eq!(values(&decades), [0.01, 0.1, 1.0, 10.0]);
        assert_eq!(decades.share(10.0), 1.0);
    }

    #[test]
    fn narrow_sizes_stand_as_they_are() {
        let axis = Axis::over_sizes([1.0, 3.0].into_iter(), 5.0);
        assert_eq!(values(&axis), [1.0, 1.5, 2.0, 2.5, 3.0]);
    }
}
