//! What a system keeps from one equilibrium to the next, to be taken up again by another system of the same assembly.

use std::sync::Arc;

use super::configuration::Configuration;
use super::linear::LARGE;
use super::memory::{Memory, MemoryError, Value, code, count};
use super::system::System;
use super::{Breakdown, Iteration};

/// What a system keeps, beside what follows from the assembly.
#[derive(Clone, Debug)]
pub struct Kept {
    set_aside: Vec<bool>,
    largest_force: f64,
    moved_force: f64,
    breakdown: Option<Breakdown>,
    /// Values that the factor belongs to.
    factored: Option<Arc<Vec<f64>>>,
    /// Iterations of the solver that iterates, where its hierarchy is that of the present stiffness.
    hierarchy: Option<[usize; 2]>,
}

impl System<'_> {
    /// What is kept at an equilibrium.
    pub fn kept(&self, configuration: &Configuration) -> Kept {
        // A smaller system makes a factor whenever its values change: nothing hangs on the one it has.
        let factored = self.factored.as_ref().filter(|_| self.unknowns() >= LARGE);
        Kept {
            set_aside: self.set_aside.clone(),
            largest_force: self.largest_force,
            moved_force: self.moved_force,
            breakdown: self.breakdown,
            factored: factored.map(|(values, _)| Arc::clone(values)),
            hierarchy: self.hierarchy(configuration),
        }
    }

    /// Goes on with what was kept at an equilibrium.
    pub fn take_up(&mut self, kept: Kept, configuration: &Configuration) {
        self.set_aside = kept.set_aside;
        self.largest_force = kept.largest_force;
        self.moved_force = kept.moved_force;
        self.breakdown = kept.breakdown;
        self.factored = None;
        if let Some(values) = kept.factored {
            self.factorise_again(values);
        }
        if let Some(iterations) = kept.hierarchy {
            self.make_hierarchy_again(configuration, iterations);
        }
    }

    fn factorise_again(&mut self, values: Arc<Vec<f64>>) {
        let lower = self.take_lower();
        if self.make_symmetric_solver(&lower).is_ok()
            && let Some(solver) = self.symmetric.as_mut()
            && let Ok(inertia) = solver.factorise(&lower.pattern, &values)
        {
            self.factored = Some((values, inertia));
        }
        self.lower = Some(lower);
    }

    /// The values of the stiffness at a configuration.
    fn secant_values(&mut self, configuration: &Configuration) -> Vec<f64> {
        let lower = self.take_lower();
        let values = self.values(configuration, Iteration::Secant, 0.0, &lower);
        self.lower = Some(lower);
        values
    }
}

/// Where the factor comes from.
const NO_FACTOR: i64 = 0;
const FACTOR_OF_THE_POINT: i64 = 1;
const FACTOR_OF_VALUES: i64 = 2;

impl Kept {
    /// Writes what is kept at `configuration` into a memory.
    pub fn write(&self, system: &System<'_>, configuration: &Configuration, memory: &mut Memory) {
        let aside = self.set_aside.iter().map(|&aside| code(aside));
        memory.put_column("solver.set_aside", aside.collect());
        memory.put("solver.forces", vec![self.largest_force, self.moved_force]);
        let breakdown = match self.breakdown {
            None => 0,
            Some(Breakdown::NotPositive) => 1,
            Some(Breakdown::Stagnated) => 2,
        };
        let factor = self.write_factor(system, configuration, memory);
        let iterations = self
            .hierarchy
            .map_or([-1, -1], |both| both.map(|n| n as i64));
        let counts = vec![breakdown, factor, iterations[0], iterations[1]];
        memory.put("solver.counts", counts);
    }

    fn write_factor(
        &self,
        system: &System<'_>,
        configuration: &Configuration,
        memory: &mut Memory,
    ) -> i64 {
        let Some(values) = &self.factored else {
            return NO_FACTOR;
        };
        let of_the_point = system.lower.as_ref().is_some_and(|lower| {
            let secant =
                system.values_without(configuration, Iteration::Secant, lower, &self.set_aside);
            values.iter().zip(&secant).all(|(a, b)| a.same(*b))
        });
        if of_the_point {
            return FACTOR_OF_THE_POINT;
        }
        memory.put("solver.factor", values.to_vec());
        FACTOR_OF_VALUES
    }

    /// Reads what was kept at `configuration`.
    ///
    /// # Errors
    /// Columns that are missing or do not fit.
    pub fn read(
        system: &mut System<'_>,
        configuration: &Configuration,
        memory: &Memory,
    ) -> Result<Self, MemoryError> {
        const COUNTS: &str = "solver.counts";
        let aside = memory.column::<u8>("solver.set_aside", system.set_aside.len())?;
        let [largest_force, moved_force] = memory.fixed("solver.forces")?;
        let [breakdown, factor, first, last] = memory.fixed::<i64, 4>(COUNTS)?;
        let set_aside: Vec<bool> = aside.iter().map(|&aside| aside != 0).collect();
        system.set_aside.clone_from(&set_aside);
        let factored = match factor {
            NO_FACTOR => None,
            FACTOR_OF_THE_POINT => Some(system.secant_values(configuration)),
            _ => memory.list("solver.factor")?.map(<[f64]>::to_vec),
        };
        Ok(Self {
            set_aside,
            largest_force,
            moved_force,
            breakdown: match breakdown {
                0 => None,
                1 => Some(Breakdown::NotPositive),
                _ => Some(Breakdown::Stagnated),
            },
            factored: factored.map(Arc::new),
            hierarchy: if first < 0 {
                None
            } else {
                Some([count(COUNTS, first)?, count(COUNTS, last)?])
            },
        })
    }
}
