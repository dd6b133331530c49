//! Load steps beyond the peak: the load factor becomes an unknown, and something that only grows takes its place.
//!
//! Displacement control follows the displacement that the growing loads work on; dissipation control the energy that
//! softening bonds take, so that the factor and the displacement both may fall. Gutiérrez (2004); Verhoosel, Remmers &
//! Gutiérrez (2009). The energy is summed bond by bond, which holds with constant loads and friction too.

mod displacement;
mod dissipation;
mod path;

use crate::equilibrium::configuration::Configuration;
use crate::equilibrium::memory::{Memory, MemoryError, code, count};

/// What steers the load steps of a stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Control {
    /// The load factor.
    #[default]
    Load,
    /// The displacement that the growing loads work on.
    Displacement,
    /// The energy that softening takes, wherever it takes any.
    Dissipation,
    /// The load factor; the energy from the first load step on that fails or takes much of it, until a factor of the
    /// stage is reached by elastic loading again.
    Auto,
}

/// How stages are steered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathControl {
    /// By what.
    pub control: Control,
    /// Load steps that a stage may take beside its factors' own number.
    pub most_steps: usize,
}

impl Default for PathControl {
    fn default() -> Self {
        Self {
            control: Control::Load,
            most_steps: 2000,
        }
    }
}

/// Largest energy of one load step, in fracture energies of the mean softening bond.
const LARGEST: f64 = 0.25;
/// Its first value, and what a load step under load control may take.
const FIRST: f64 = 0.05;

/// What is kept from one steered load step to the next.
#[derive(Clone, Debug, Default)]
pub(super) struct Steered {
    control: PathControl,
    /// Whether the energy steers now.
    by_energy: bool,
    /// Energy of the next load step, `[force·length]`.
    increment: f64,
    /// Bounds on it.
    bounds: [f64; 2],
    /// Stage, and the load steps taken in it.
    taken: (usize, usize),
    /// Work of the loads at factor 1 on the displacements that they cause in the elastic assembly; and the load
    /// factor that a load step of the present stage counts from.
    compliance: Option<f64>,
    counted_to: f64,
}

const COUNTS: &str = "steered.counts";
const NUMBERS: &str = "steered.numbers";
const COMPLIANCE: &str = "steered.compliance";

impl Steered {
    pub(super) fn new(control: PathControl, configuration: &Configuration) -> Self {
        let bonds = configuration.bonds.values().iter();
        let energies: Vec<f64> = bonds
            .filter_map(|bond| Some(bond.softening()?.energy))
            .collect();
        let mean = energies.iter().sum::<f64>() / energies.len().max(1) as f64;
        let nothing_softens = energies.is_empty() && control.control != Control::Displacement;
        Self {
            control: PathControl {
                control: if nothing_softens {
                    Control::Load
                } else {
                    control.control
                },
                ..control
            },
            increment: FIRST * mean,
            bounds: [FIRST * mean, LARGEST * mean],
            ..Self::default()
        }
    }

    /// Writes what is kept.
    pub(super) fn write(&self, memory: &mut Memory) {
        let (stage, steps) = self.taken;
        let by_energy = i64::from(code(self.by_energy));
        memory.put(COUNTS, vec![by_energy, stage as i64, steps as i64]);
        memory.put(NUMBERS, vec![self.increment, self.counted_to]);
        memory.put(COMPLIANCE, self.compliance.into_iter().collect());
    }

    /// Reads what was kept.
    pub(super) fn read(&mut self, memory: &Memory) -> Result<(), MemoryError> {
        let [by_energy, stage, steps] = memory.fixed::<i64, 3>(COUNTS)?;
        self.by_energy = by_energy != 0;
        self.taken = (count(COUNTS, stage)?, count(COUNTS, steps)?);
        [self.increment, self.counted_to] = memory.fixed(NUMBERS)?;
        let compliance = memory.list::<f64>(COMPLIANCE)?.unwrap_or_default();
        self.compliance = compliance.first().copied();
        Ok(())
    }

    pub(super) fn is_load_controlled(&self) -> bool {
        self.control.control == Control::Load
    }

    /// A new stage begins from this load factor.
    fn begin(&mut self, stage: usize, load_factor: f64) {
        if self.taken.1 == 0 || self.taken.0 != stage {
            self.taken = (stage, 0);
            self.by_energy = self.control.control == Control::Dissipation;
            self.compliance = None;
            self.counted_to = load_factor;
        }
    }
}
