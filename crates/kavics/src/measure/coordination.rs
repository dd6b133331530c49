//! How many contacts the grains have.

use crate::assembly::Partner;
use crate::ids::{Id, PerGrain};

/// Coordination histogram: how many grains have 0, 1, 2, … contacts.
///
/// A contact with a side counts for its grain where it is given.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Coordination {
    /// Number of grains with as many contacts as their place says; the last one is above zero.
    pub grains: Vec<usize>,
}

impl Coordination {
    /// The histogram of `count` grains with contacts between these partners.
    pub fn new(count: usize, contacts: impl Iterator<Item = [Partner; 2]>) -> Self {
        let mut own = PerGrain::filled(0_usize, count);
        for partner in contacts.flatten() {
            if let Partner::Grain(grain) = partner {
                own.values_mut()[grain.index()] += 1;
            }
        }
        let most = own.values().iter().max().map_or(0, |most| most + 1);
        let mut grains = vec![0; most];
        for &contacts in own.values() {
            grains[contacts] += 1;
        }
        Self { grains }
    }

    /// Number of grains without a contact.
    pub fn rattlers(&self) -> usize {
        self.grains.first().copied().unwrap_or_default()
    }

    /// Coordination number Z = Σ m_p / N over all grains; none without a grain.
    pub fn mean(&self) -> Option<f64> {
        self.mean_over(self.grains.iter().sum())
    }

    /// Coordination number over the grains that have a contact; none without one.
    pub fn mean_without_rattlers(&self) -> Option<f64> {
        self.mean_over(self.grains.iter().skip(1).sum())
    }

    fn mean_over(&self, grains: usize) -> Option<f64> {
        let ends: usize = (0..).zip(&self.grains).map(|(m, count)| m * count).sum();
        (grains > 0).then(|| ends as f64 / grains as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::{GrainId, SideId};

    #[test]
    fn a_chain_on_the_floor_with_a_loose_grain() {
        let grain = |id| Partner::Grain(GrainId(id));
        let contacts = [
            [grain(0), grain(1)],
            [grain(1), grain(2)],
            [grain(0), Partner::Side(SideId(2))],
        ];
        let found = Coordination::new(4, contacts.into_iter());
        assert_eq!(found.grains, [1, 1, 2]);
        assert_eq!(found.rattlers(), 1);
        assert_eq!(found.mean(), Some(1.25));
        assert_eq!(found.mean_without_rattlers(), Some(5.0 / 3.0));
    }

    #[test]
    fn no_grains_have_no_mean() {
        let nothing = Coordination::new(0, std::iter::empty());
        assert_eq!(nothing, Coordination::default());
        assert_eq!(nothing.mean(), None);
    }
}
