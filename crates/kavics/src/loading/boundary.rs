//! What a load path remembers between two of its stations: all that the further ones depend on.

use super::advance::Point;
use super::control::Steered;
use super::event_driven::{EventDriven, Run, Unfinished};
use super::ledger::{Closing, Forces};
use super::load_path::LoadPath;
use super::program::Program;
use crate::equilibrium::configuration::Configuration;
use crate::equilibrium::kept::Kept;
use crate::equilibrium::memory::{Memory, MemoryError, code, count};
use crate::equilibrium::system::System;
use crate::equilibrium::{Energy, Equilibrium};

/// The last equilibrium of the path, beside its state.
#[derive(Clone, Copy, Debug, Default)]
pub struct Last {
    /// Index of its stage.
    pub stage: usize,
    /// Its load factor.
    pub load_factor: f64,
    /// Whether its stability was sought.
    pub is_tested: bool,
    /// How well the ledger had closed.
    pub closing: Closing,
}

/// Where a load path stands.
#[derive(Clone)]
pub struct Boundary {
    pub point: Point,
    /// Stage and place of the next load step in it.
    pub next: (usize, usize),
    pub step: usize,
    pub last: Last,
    pub steered: Steered,
    pub run: Run,
    pub unfinished: Option<Unfinished>,
    pub kept: Kept,
}

const PLACE: &str = "path.place";
const FACTORS: &str = "path.factors";
const LAST: &str = "path.last";

impl LoadPath<'_> {
    /// Where the path stands now.
    pub(super) fn boundary(&self) -> Boundary {
        Boundary {
            point: self.point.clone(),
            next: self.next,
            step: self.step,
            last: self.last,
            steered: self.steered.clone(),
            run: self.event_driven.run,
            unfinished: self.unfinished.clone(),
            kept: self.system.kept(&self.point.configuration),
        }
    }

    /// All that the further equilibria depend on; none where none follow.
    pub fn memory(&self) -> Option<Memory> {
        let mut memory = Memory::default();
        if let Some(kept) = &self.kept {
            kept.write(&self.system, &mut memory);
        } else if !self.waiting.is_empty() || self.ended || self.is_within() {
            return None;
        } else {
            self.boundary().write(&self.system, &mut memory);
            self.event_driven.write(&mut memory);
        }
        Some(memory)
    }

    /// The path from where another one of the same scene stood; the equilibria that follow are the same to the last bit.
    ///
    /// # Errors
    /// A memory that does not fit the scene.
    pub fn resume(mut self, memory: &Memory) -> Result<Self, MemoryError> {
        let point = Point::read(&self.system, self.program, memory)?;
        let kept = Kept::read(&mut self.system, &point.configuration, memory)?;
        let [step, stage, place, last_stage, is_tested] = memory.fixed::<i64, 5>(PLACE)?;
        let of = |value| count(PLACE, value);
        self.step = of(step)?;
        self.next = (of(stage)?, of(place)?);
        let (load_factor, closing) = match *memory.list::<f64>(LAST)?.unwrap_or_default() {
            [load_factor, error, largest] => (load_factor, Closing { error, largest }),
            // Of a version that did not look whether the ledger closes.
            [load_factor] => (load_factor, Closing::default()),
            _ => return Err(MemoryError::unfit(LAST)),
        };
        self.last = Last {
            stage: of(last_stage)?,
            load_factor,
            is_tested: is_tested != 0,
            closing,
        };
        self.steered.read(memory)?;
        self.system.take_up(kept, &point.configuration);
        self.unfinished = Unfinished::read(self.program, memory)?;
        self.event_driven = EventDriven::read(&mut self.system, self.program, &point, memory)?;
        self.point = point;
        self.waiting.clear();
        Ok(self)
    }

    /// The last equilibrium, without what happened on the way to it; none in the middle of a load step.
    pub fn last_equilibrium(&self) -> Option<Equilibrium> {
        if self.unfinished.is_some() {
            return None;
        }
        let Last {
            stage, load_factor, ..
        } = self.last;
        let mut equilibrium =
            self.equilibrium(stage, load_factor, true, 0, super::advance::Way::default());
        if self.last.is_tested {
            equilibrium.stability = self.stability(&equilibrium.state);
        }
        Some(equilibrium)
    }
}

impl Boundary {
    fn write(&self, system: &System<'_>, memory: &mut Memory) {
        self.point.write(system, memory);
        self.kept.write(system, &self.point.configuration, memory);
        let Last {
            stage,
            load_factor,
            is_tested,
            closing,
        } = self.last;
        let place = [self.step, self.next.0, self.next.1, stage];
        let place = place.map(|count| count as i64).into_iter();
        memory.put(PLACE, place.chain([i64::from(code(is_tested))]).collect());
        let numbers = [load_factor, closing.error, closing.largest];
        memory.put(LAST, numbers.to_vec());
        self.steered.write(memory);
        self.run.write(memory);
        if let Some(unfinished) = &self.unfinished {
            unfinished.write(memory);
        }
    }
}

impl Point {
    fn write(&self, system: &System<'_>, memory: &mut Memory) {
        self.configuration.write(system, memory);
        memory.put_loads("body.load", &self.forces.loads);
        memory.put_loads("body.reaction", &self.forces.reactions);
        memory.put("path.energy", self.energy.terms().to_vec());
        memory.put(FACTORS, self.factors.clone());
        memory.put("path.residual", vec![self.residual]);
        let aside = self.set_aside.values().iter();
        memory.put_column("grain.set_aside", aside.map(|&aside| code(aside)).collect());
    }

    fn read(system: &System<'_>, program: &Program, memory: &Memory) -> Result<Self, MemoryError> {
        let (bodies, grains) = (system.assembly.body_count(), system.assembly.grains.len());
        let factors = memory.list(FACTORS)?.unwrap_or_default().to_vec();
        if factors.len() != program.actions.len() {
            return Err(MemoryError::unfit(FACTORS));
        }
        let [residual] = memory.fixed("path.residual")?;
        let aside = memory.column::<u8>("grain.set_aside", grains)?;
        Ok(Self {
            configuration: Configuration::read(system, memory)?,
            forces: Forces {
                loads: memory.loads("body.load", bodies)?,
                reactions: memory.loads("body.reaction", bodies)?,
            },
            energy: Energy::of_terms(memory.fixed("path.energy")?),
            factors,
            set_aside: aside.iter().map(|&aside| aside != 0).collect(),
            residual,
        })
    }
}

impl Energy {
    pub(super) fn terms(self) -> [f64; 6] {
        [
            self.external_work,
            self.elastic_energy,
            self.fracture_energy,
            self.friction_work,
            self.nonpotential_work,
            self.release_energy,
        ]
    }

    pub(super) fn of_terms(terms: [f64; 6]) -> Self {
        let [
            external_work,
            elastic_energy,
            fracture_energy,
            friction_work,
            nonpotential_work,
            release_energy,
        ] = terms;
        Self {
            external_work,
            elastic_energy,
            fracture_energy,
            friction_work,
            nonpotential_work,
            release_energy,
        }
    }
}
