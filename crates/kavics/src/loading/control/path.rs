//! Steered load steps as a path of equilibria.

use super::Control;
use crate::assembly::Assembly;
use crate::equilibrium::configuration::{Action, Failure};
use crate::equilibrium::{Load, SolveError, Warning};
use crate::loading::advance::{self, Along, Point, Way};
use crate::loading::load_path::LoadStep;
use crate::loading::{LoadPath, Program, work};

/// A softening bond with less than this share of its force left is broken, where the path lets it.
const WORN: f64 = 1e-3;
/// A load step leaves open at most this share of the energy that softening takes in it.
pub(super) const CLOSED: f64 = 2e-3;

/// Where a steered load step has come to.
pub(super) enum Reached {
    /// The factor that the stage gives.
    Factor,
    /// A share of the way there; the same factor is aimed at again.
    Share(f64),
    /// The displacement that the stage's factor stands for.
    Displacement { load_factor: f64 },
    /// Nothing ties the loaded part to the supports.
    Separated,
}

impl LoadPath<'_> {
    /// One load step, and what comes of it.
    pub(in crate::loading) fn take_steered(&mut self, mut load_step: LoadStep) {
        self.steered
            .begin(load_step.stage, load_step.load_factor[0]);
        if self.steered.control.control == Control::Displacement {
            load_step = self.increment_of_displacement(&load_step);
        }
        let growth = self.growth(&load_step);
        // Moves are displacements already, and what does not grow cannot be steered.
        let grows = is_loading(&growth)
            || self.steered.control.control != Control::Displacement && !is_still(&growth);
        let steerable = grows && !load_step.is_at_rest();
        if !steerable {
            self.take(&load_step);
            return;
        }
        if self.steered.taken.1 >= self.most_steps(&load_step) {
            self.end_at_most_steps(&load_step);
            return;
        }
        self.steered.taken.1 += 1;
        self.step += 1;
        let (mut way, mut cuts) = (Way::default(), 0);
        let reached = match self.steered.control.control {
            Control::Displacement => self.by_displacement(&load_step, &mut way, &mut cuts),
            _ => self.by_energy(&load_step, &mut way, &mut cuts),
        };
        match reached {
            Ok(reached) => self.push(&load_step, &reached, cuts, way),
            Err(failure) => self.end(&load_step, failure),
        }
    }

    fn most_steps(&self, load_step: &LoadStep) -> usize {
        let factors = &self.program.stages[load_step.stage].factors;
        factors.len() + self.steered.control.most_steps
    }

    /// What the action grows by over a load step.
    pub(super) fn growth(&self, load_step: &LoadStep) -> Action {
        growth(self.program, self.system.assembly, load_step)
    }

    fn push(&mut self, load_step: &LoadStep, reached: &Reached, cuts: usize, mut way: Way) {
        let load_factor = match *reached {
            Reached::Factor => load_step.load_factor[1],
            Reached::Share(share) => {
                self.next.1 -= 1;
                load_step.load_factor(share)
            }
            Reached::Displacement { load_factor } => load_factor,
            Reached::Separated => {
                way.warnings.push(Warning::Separated);
                self.ended = true;
                0.0
            }
        };
        let equilibrium = self.equilibrium(load_step.stage, load_factor, true, cuts, way);
        self.come_to(equilibrium);
    }

    fn end(&mut self, load_step: &LoadStep, failure: Failure) {
        let (assembly, tolerance) = (self.system.assembly, self.system.settings.tolerance);
        let at = load_step.load_factor[0];
        let error = failure.at(self.step, at, assembly, tolerance);
        self.waiting.push_back(Err(error));
        self.ended = true;
    }

    fn end_at_most_steps(&mut self, load_step: &LoadStep) {
        let [load_factor, wanted] = load_step.load_factor;
        self.waiting.push_back(Err(SolveError::MostSteps {
            step: self.step + 1,
            load_factor,
            stage: self.program.stages[load_step.stage].name.clone(),
            most_steps: self.most_steps(load_step),
            wanted,
        }));
        self.ended = true;
    }

    /// Under load control to a share of the load step. Kept if it balances, softening takes no more than `most`, and
    /// no bond comes to its limit or breaks halfway, which would leave the ledger open.
    pub(super) fn try_share(
        &mut self,
        load_step: &LoadStep,
        share: f64,
        most: f64,
        way: &mut Way,
    ) -> Result<bool, Failure> {
        let (before, mut tried) = (self.point.clone(), way.clone());
        self.attempt(load_step, share, &mut tried)?;
        let softened = tried.softened - way.softened;
        if softened > most || self.left_open(&before, &self.point) > CLOSED * softened {
            self.point = before;
            return Ok(false);
        }
        *way = tried;
        Ok(true)
    }

    /// What the ledger leaves open between two points.
    pub(super) fn left_open(&self, before: &Point, after: &Point) -> f64 {
        let rounding = 1e-12 * self.point.energy.external_work.abs()
            + work::rounding(&self.system, &after.configuration);
        let open = after.energy.ledger_error() - before.energy.ledger_error();
        (open.abs() - rounding).max(0.0)
    }

    /// Breaks the bonds that are as good as broken; answers whether that separates the assembly.
    pub(super) fn break_worn(
        &mut self,
        load_step: &LoadStep,
        share: f64,
        worn: Option<f64>,
        way: &mut Way,
    ) -> bool {
        let (mut start, mut tried) = (self.point.clone(), way.clone());
        let (system, load_factor) = (&mut self.system, load_step.load_factor(share));
        let events = tried.events.len();
        let worn = worn.unwrap_or(WORN);
        advance::break_softened(system, &mut start, worn, load_factor, &mut tried);
        let growth = growth(self.program, system.assembly, load_step);
        let torn = system.is_torn(&start.configuration.bonds, &growth);
        if tried.events.len() == events && !torn {
            return false;
        }
        let (factors, at) = if torn {
            (load_step.unloaded(self.program), 0.0)
        } else {
            (load_step.factors(share), load_factor)
        };
        let action = advance::action(self.program, &factors, system.assembly.body_count());
        let mut configuration = start.configuration.clone();
        let next = system
            .equilibrate(&mut configuration, &action, &mut tried.progress)
            .map(|()| {
                let along = Along::Vanishing(&[]);
                advance::settled(
                    system,
                    &start,
                    configuration,
                    &action,
                    along,
                    at,
                    &mut tried,
                )
                .0
            })
            .and_then(|here| advance::hold(system, here, self.breakage, &action, at, &mut tried));
        let Ok(next) = next else { return false };
        self.point = next;
        self.point.factors = factors;
        *way = tried;
        torn
    }
}

fn growth(program: &Program, assembly: &Assembly, load_step: &LoadStep) -> Action {
    let ends = load_step.to.iter().zip(&load_step.from);
    let growth: Vec<f64> = ends.map(|(to, from)| to - from).collect();
    advance::action(program, &growth, assembly.body_count())
}

fn is_still(growth: &Action) -> bool {
    growth.moved.iter().all(|moved| moved.2 == 0.0)
}

fn is_loading(growth: &Action) -> bool {
    growth
        .loads
        .values()
        .iter()
        .any(|load| *load != Load::default())
}
