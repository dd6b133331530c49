//! Sums of loads on sides, which may bear very many contacts: what rounding cuts off is kept apart (Neumaier 1974).

use super::Load;
use crate::assembly::Assembly;
use crate::ids::{BodyId, Id};

/// What rounding cut off the sums of the loads on the sides.
pub struct SideSums {
    grains: usize,
    cut_off: Vec<Load>,
}

impl SideSums {
    /// Nothing cut off yet.
    pub fn new(assembly: &Assembly) -> Self {
        Self {
            grains: assembly.grains.len(),
            cut_off: vec![Load::default(); assembly.sides.len()],
        }
    }

    /// Adds a load to the sum of a body.
    pub fn add(&mut self, body: BodyId, sum: &mut Load, load: Load) {
        let before = *sum;
        *sum += load;
        if let Some(side) = body.index().checked_sub(self.grains) {
            let terms = [before, load, *sum].map(Load::components);
            let lost = |i: usize| {
                let [before, load, after] = terms.map(|term| term[i]);
                if before.abs() >= load.abs() {
                    (before - after) + load
                } else {
                    (load - after) + before
                }
            };
            self.cut_off[side] += Load::from_components(std::array::from_fn(lost));
        }
    }

    /// What was cut off, body by body, to be added to the sums.
    pub fn cut_off(&self) -> impl Iterator<Item = (BodyId, Load)> + '_ {
        let sides = self.cut_off.iter().enumerate();
        sides.map(|(side, &load)| (BodyId::from_index(self.grains + side), load))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::Side;
    use crate::geometry::Vector;

    #[test]
    fn a_million_equal_forces_add_up_to_the_last_bit() {
        let side = Side {
            name: "top".into(),
            start: Vector::new(0.0, 1.0),
            end: Vector::new(1.0, 1.0),
            outward: Vector::new(0.0, 1.0),
            present: true,
        };
        let assembly = Assembly {
            sides: vec![side].into(),
            ..Assembly::default()
        };
        let force = Load {
            y: 0.1,
            ..Load::default()
        };
        let mut sums = SideSums::new(&assembly);
        let mut sum = Load::default();
        let mut plain = 0.0;
        for _ in 0..1_000_000 {
            sums.add(BodyId(0), &mut sum, force);
            plain += 0.1;
        }
        for (_, load) in sums.cut_off() {
            sum += load;
        }
        // 0.1 is a little more than a tenth.
        assert_eq!(sum.y, 100_000.000_000_000_0);
        assert!((plain - 1e5_f64).abs() > 1e-7);
    }
}
