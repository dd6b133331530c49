//! Random numbers: one stream for each purpose, all from the seed of the scene.
//!
//! PCG XSL RR 128/64 (O'Neill, 2014) on integers only, so the bits are the same on every platform.

use rand::Rng;
use rand_pcg::Pcg64;

/// What a stream of random numbers is for. A change in how one is used leaves the others as they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Radii drawn one by one.
    Radii,
    /// The order in which grains of given radii come.
    Order,
    /// Where grains are dropped.
    Positions,
    /// To which side a grain rolls that lands right on top of another.
    Coins,
    /// Scatter of strengths, one draw a contact.
    Strengths,
    /// Random shares of the contacts.
    Zones,
}

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub struct Stream {
    generator: Pcg64,
}

/// Where random numbers come from: the seed of the scene and the layer of grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// Seed of the scene.
    pub seed: u64,
    /// Number of the layer, from 0.
    pub layer: u32,
}

impl From<u64> for Source {
    /// The first layer, or what has no layers.
    fn from(seed: u64) -> Self {
        Self { seed, layer: 0 }
    }
}

/// Streams kept for each layer.
const STREAMS_OF_A_LAYER: u64 = 64;

/// The stream of a source for a purpose: the seed gives the state, purpose and layer the increment.
pub fn stream(source: impl Into<Source>, purpose: Purpose) -> Stream {
    let number = match purpose {
        Purpose::Radii => 0,
        Purpose::Order => 1,
        Purpose::Positions => 2,
        Purpose::Coins => 3,
        Purpose::Strengths => 4,
        Purpose::Zones => 5,
    };
    let Source { seed, layer } = source.into();
    let increment = number + STREAMS_OF_A_LAYER * u64::from(layer);
    Stream {
        generator: Pcg64::new(spread(seed), spread(increment)),
    }
}

fn spread(seed: u64) -> u128 {
    let mut state = seed;
    let high = split_mix(&mut state);
    (u128::from(high) << 64) | u128::from(split_mix(&mut state))
}

/// Next number of SplitMix64 (Steele, Lea & Flood, 2014): spreads seeds that are close to each other.
fn split_mix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Stream {
    /// Uniform in [0, 1), a multiple of 2⁻⁵³.
    pub fn unit(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
        (self.generator.next_u64() >> 11) as f64 * STEP
    }

    /// Uniform among 0, …, `count` − 1 (bias below `count`·2⁻⁶⁴).
    pub fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.generator.next_u64()) * count as u128) >> 64) as usize
    }

    /// True or false with equal chance.
    pub fn coin(&mut self) -> bool {
        self.generator.next_u64() >> 63 == 1
    }

    /// Brings values into a random order (Fisher & Yates).
    pub fn shuffle<T>(&mut self, values: &mut [T]) {
        for last in (1..values.len()).rev() {
            let other = self.below(last + 1);
            values.swap(last, other);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_seed_and_purpose_give_the_same_numbers() {
        let draws = |seed, purpose| {
            let mut stream = stream(seed, purpose);
            [stream.unit(), stream.unit(), stream.unit()]
        };
        assert_eq!(draws(7, Purpose::Zones), draws(7, Purpose::Zones));
        assert_ne!(draws(7, Purpose::Zones), draws(7, Purpose::Coins));
        assert_ne!(draws(7, Purpose::Zones), draws(8, Purpose::Zones));
    }

    #[test]
    fn every_layer_has_numbers_of_its_own() {
        let first = |layer| stream(Source { seed: 7, layer }, Purpose::Order).unit();
        assert_eq!(first(0), stream(7, Purpose::Order).unit());
        assert_ne!(first(0), first(1));
        assert_ne!(first(1), first(2));
    }

    #[test]
    fn numbers_lie_in_the_unit_interval_and_have_its_mean() {
        let mut stream = stream(1, Purpose::Positions);
        let draws: Vec<f64> = (0..10_000).map(|_| stream.unit()).collect();
        assert!(draws.iter().all(|u| (0.0..1.0).contains(u)));
        // Four standard deviations of the mean: 4·√(1/12)/100.
        assert!((draws.iter().sum::<f64>() / 1e4 - 0.5).abs() < 0.0116);
    }

    #[test]
    fn shuffling_keeps_every_value() {
        let mut values: Vec<usize> = (0..100).collect();
        stream(3, Purpose::Order).shuffle(&mut values);
        assert_ne!(values, (0..100).collect::<Vec<_>>());
        values.sort_unstable();
        assert_eq!(values, (0..100).collect::<Vec<_>>());
    }
}
