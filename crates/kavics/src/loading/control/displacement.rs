//! Load steps steered by the displacement that the growing loads work on.

use super::path::Reached;
use crate::equilibrium::Iteration;
use crate::equilibrium::configuration::{Action, Failure};
use crate::equilibrium::steered::Aim;
use crate::loading::LoadPath;
use crate::loading::advance::{self, Way};
use crate::loading::load_path::{COLLAPSE, LoadStep};

/// A share this near to 1 is the whole load step.
const WHOLE: f64 = 1e-8;
/// Bonds with less than this share of their force left that separate the assembly where nothing else goes on.
const TEARING: f64 = 1e-2;

impl LoadPath<'_> {
    /// A load step of the present point's that grows as the stage's factors do: in the first of a stage each action to the
    /// stage's factor, wherever it comes from, then all alike.
    pub(super) fn increment_of_displacement(&mut self, load_step: &LoadStep) -> LoadStep {
        let counted_to = self.steered.counted_to;
        self.steered.counted_to = load_step.load_factor[1];
        if self.steered.taken.1 == 0 {
            return load_step.clone();
        }
        let wanted = load_step.load_factor[1];
        // As long as all is elastic, the factors of the stage to the last digit.
        let onward = |from: f64| {
            if from == counted_to {
                wanted
            } else {
                from + (wanted - counted_to)
            }
        };
        let mut to = load_step.from.clone();
        for &action in &self.program.stages[load_step.stage].actions {
            to[action] = onward(to[action]);
        }
        let from = load_step.load_factor[0];
        LoadStep {
            stage: load_step.stage,
            from: load_step.from.clone(),
            to,
            load_factor: [from, onward(from)],
        }
    }

    /// The load step whose loads work on the displacement that they would cause in the elastic assembly.
    pub(super) fn by_displacement(
        &mut self,
        load_step: &LoadStep,
        way: &mut Way,
        cuts: &mut usize,
    ) -> Result<Reached, Failure> {
        let growth = self.growth(load_step);
        let whole = self.work_of_growth(load_step, &growth, way)?;
        let (mut done, mut part) = (0.0, 1.0);
        let mut here = load_step.clone();
        loop {
            let aim = Aim::Displacement(whole * part);
            match self.displaced(&here, &growth, aim, way) {
                Ok(share) => {
                    let load_factor = here.load_factor(share);
                    done += part;
                    here = onward(&here, share);
                    if self.break_worn(&here, 0.0, None, way) {
                        return Ok(Reached::Separated);
                    }
                    if done >= 1.0 {
                        return Ok(Reached::Displacement { load_factor });
                    }
                    part = part.min(1.0 - done);
                }
                Err(failure) if 0.5 * part < 0.5 * COLLAPSE => {
                    if self.break_worn(&here, 0.0, Some(TEARING), way) {
                        return Ok(Reached::Separated);
                    }
                    return Err(failure);
                }
                Err(_) => {
                    part *= 0.5;
                    *cuts += 1;
                }
            }
        }
    }

    fn displaced(
        &mut self,
        here: &LoadStep,
        growth: &Action,
        aim: Aim,
        way: &mut Way,
    ) -> Result<f64, Failure> {
        let mut tried = way.clone();
        let found = self.steered(here, growth, aim, Iteration::Tangent, &mut tried);
        match found {
            Ok((point, mut share)) => {
                *way = tried;
                self.point = point;
                if (share - 1.0).abs() < WHOLE {
                    // As elastic as at first: the factor itself.
                    share = 1.0;
                    self.point.factors = here.factors(1.0);
                }
                Ok(share)
            }
            Err(failure) => {
                way.progress.iterations = tried.progress.iterations;
                Err(failure)
            }
        }
    }

    /// Work of the loads' growth on the displacements that it causes in the assembly as it was when the stage began.
    fn work_of_growth(
        &mut self,
        load_step: &LoadStep,
        growth: &Action,
        way: &mut Way,
    ) -> Result<f64, Failure> {
        let by = load_step.load_factor[1] - load_step.load_factor[0];
        if let Some(compliance) = self.steered.compliance {
            return Ok(compliance * by * by);
        }
        let work = self.elastic_work(growth, way)?;
        let compliance = if load_step.is_common(self.program) {
            work / (by * by)
        } else {
            let mut ones = vec![0.0; self.program.actions.len()];
            for &action in &self.program.stages[load_step.stage].actions {
                ones[action] = 1.0;
            }
            let bodies = self.system.assembly.body_count();
            self.elastic_work(&advance::action(self.program, &ones, bodies), way)?
        };
        self.steered.compliance = Some(compliance);
        Ok(work)
    }

    fn elastic_work(&mut self, growth: &Action, way: &mut Way) -> Result<f64, Failure> {
        let configuration = &self.point.configuration;
        let system = &mut self.system;
        let rate = system.elastic_growth(configuration, growth, &mut way.progress)?;
        let bodies = rate.iter();
        Ok(bodies.map(|(body, u)| growth.loads[body].work(*u)).sum())
    }
}

/// The same growth from where a share of a load step has led.
fn onward(load_step: &LoadStep, share: f64) -> LoadStep {
    let from = load_step.factors(share);
    let ends = load_step.to.iter().zip(&load_step.from);
    let to = ends
        .zip(&from)
        .map(|((to, old), from)| from + (to - old))
        .collect();
    let [start, end] = load_step.load_factor;
    let reached = load_step.load_factor(share);
    LoadStep {
        stage: load_step.stage,
        from,
        to,
        load_factor: [reached, reached + (end - start)],
    }
}
