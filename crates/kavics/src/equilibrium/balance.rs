//! Balance of forces while every contact keeps its phase: Newton iteration on the assembled stiffness.

use super::bond::Bond;
use super::configuration::{Action, Configuration, Failure, Progress};
use super::kinematics::ALL_FREEDOMS;
use super::steered::{moved_displacements, product};
use super::system::{Imbalance, System};
use super::{Displacement, Freedom, Iterate, Iteration, Load};
use crate::contact_law::{ContactForce, Matrix, RelativeDisplacement};
use crate::ids::{BodyId, Id, PerBody};

/// How an iteration with fixed phases ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settled {
    /// In balance.
    Balanced,
    /// A mechanism: the configuration was moved along it by a proximal step.
    Drifting,
}

/// Linear solves with one set of phases before the iteration is given up.
const MOST_ITERATIONS: usize = 400;
/// With floppy modes held, a residual that falls slower than this says that the loads move one.
const STUCK: f64 = 0.7;
/// A secant iteration that falls slower than this goes on with the tangent, and with a new factor.
const SLOW: f64 = 0.3;
/// Weight of the proximal term that carries over a mechanism, as a share of the diagonal.
const PROXIMAL: f64 = 1e-6;

impl System<'_> {
    /// Iterates to balance with every contact in its phase. `moves`: the moved freedoms are not yet at their values.
    ///
    /// # Errors
    /// Where the iteration does not settle.
    pub fn settle(
        &mut self,
        configuration: &mut Configuration,
        action: &Action,
        moves: bool,
        progress: &mut Progress,
    ) -> Result<Settled, Failure> {
        if moves {
            self.start_moving(configuration, action, progress);
        }
        let start = configuration.displacements.clone();
        let (mut iteration, mut history) = (self.settings.iteration, History::default());
        loop {
            self.respond(configuration);
            let imbalance = self.imbalance(configuration, &action.loads);
            progress.residual = imbalance.residual(self.noise());
            (self.watch).note_iteration(progress.iterations, progress.residual);
            self.keep_iterate(configuration, progress);
            if progress.residual <= self.settings.tolerance {
                progress.longest.note(history.len(), MOST_ITERATIONS);
                if self.is_rounding(&imbalance, action) {
                    self.try_undeformed(configuration, action);
                }
                return Ok(Settled::Balanced);
            }
            let falls = history.push(imbalance.largest);
            let floppy = progress.held_pivots > 0 && history.len() > 1 && falls > STUCK;
            let failure = not_converged(progress, &imbalance);
            if self.ends_here() {
                return Err(failure);
            }
            if floppy || history.is_over(iteration) {
                configuration.displacements = start;
                let iteration = if floppy { Iteration::Secant } else { iteration };
                return self.give_up(failure, configuration, action, iteration, progress);
            }
            if falls > SLOW {
                self.factored = None;
                if history.len() > 2 {
                    iteration = Iteration::Tangent;
                }
            }
            let solved = self.solve(
                configuration,
                &imbalance.unbalanced,
                iteration,
                0.0,
                progress,
            );
            match solved {
                Ok(step) if self.is_small(&step) || !self.any_phases(configuration) => {
                    self.advance(configuration, &step);
                }
                // As good as a mechanism: the set of phases will change before anything moves so far.
                Ok(_) | Err(_) => {
                    configuration.displacements = start;
                    return self.give_up(failure, configuration, action, iteration, progress);
                }
            }
        }
    }

    /// The first step where freedoms are moved.
    fn start_moving(
        &mut self,
        configuration: &mut Configuration,
        action: &Action,
        progress: &mut Progress,
    ) {
        let unbalanced = self.predict(configuration, action);
        if let Ok(step) = self.solve(configuration, &unbalanced, Iteration::Secant, 0.0, progress) {
            self.advance(configuration, &step);
        }
    }

    /// No balance from here: a proximal step where contacts may change phase, else a mechanism or the failure.
    fn give_up(
        &mut self,
        failure: Failure,
        configuration: &mut Configuration,
        action: &Action,
        iteration: Iteration,
        progress: &mut Progress,
    ) -> Result<Settled, Failure> {
        if self.any_phases(configuration) {
            self.drift(configuration, action, iteration, progress)
        } else {
            Err(self.mechanism_or(failure, configuration, action, progress))
        }
    }

    /// A mechanism where the secant has floppy modes; else the failure as it is.
    fn mechanism_or(
        &mut self,
        failure: Failure,
        configuration: &mut Configuration,
        action: &Action,
        progress: &mut Progress,
    ) -> Failure {
        self.respond(configuration);
        let unbalanced = self.imbalance(configuration, &action.loads).unbalanced;
        self.factored = None;
        let solved = self.solve(configuration, &unbalanced, Iteration::Secant, 0.0, progress);
        if solved.is_err() || progress.held_pivots == 0 {
            return failure;
        }
        self.drift(configuration, action, Iteration::Secant, progress)
            .err()
            .unwrap_or(failure)
    }

    /// Brings the moved freedoms to their values; the loads that the move causes at the other freedoms are those
    /// of the linear contacts, and the first linear solve answers them.
    fn predict(&mut self, configuration: &mut Configuration, action: &Action) -> PerBody<Load> {
        self.respond(configuration);
        for &(body, freedom, value) in &action.moved {
            *configuration.displacements[body].component_mut(freedom) = value;
        }
        let u = &configuration.displacements;
        let forces = self
            .frames
            .iter()
            .zip(configuration.bonds.values())
            .map(|(frame, bond)| {
                let v = frame.relative_displacement(u[frame.first], u[frame.second]);
                linear_force(bond, v, &self.stiffness_of(bond, Iteration::Secant))
            });
        let imbalance = self.imbalance_of(forces, &action.loads);
        let by_moves = self.force_by_moves(configuration, &action.moved);
        self.moved_force = imbalance.force.max(by_moves);
        imbalance.unbalanced
    }

    /// Largest contact force if only the moved bodies had moved, and contacts were linear.
    pub fn force_by_moves(
        &self,
        configuration: &Configuration,
        moved: &[(BodyId, Freedom, f64)],
    ) -> f64 {
        if moved.iter().all(|moved| moved.2 == 0.0) {
            return 0.0;
        }
        let u = moved_displacements(moved, self.assembly.body_count());
        let contacts = self.frames.iter().zip(configuration.bonds.values());
        let sizes = contacts.map(|(frame, bond)| {
            let v = frame.relative_displacement(u[frame.first], u[frame.second]);
            let force = product(&self.stiffness_of(bond, Iteration::Secant), v);
            force.normal.hypot(force.shear)
        });
        sizes.fold(0.0, f64::max)
    }

    /// Whether nothing acts and what is left of the forces is rounding.
    fn is_rounding(&self, imbalance: &Imbalance, action: &Action) -> bool {
        imbalance.force > 0.0
            && imbalance.force <= self.noise()
            && action
                .loads
                .values()
                .iter()
                .all(|load| *load == Load::default())
            && action.moved.iter().all(|moved| moved.2 == 0.0)
    }

    /// Where nothing acts any more, the undeformed assembly is the equilibrium that rounding stands for, if it is one.
    fn try_undeformed(&self, configuration: &mut Configuration, action: &Action) {
        let mut undeformed = configuration.clone();
        for (body, set_aside) in self.set_aside.iter().enumerate() {
            if !set_aside {
                undeformed.displacements[BodyId::from_index(body)] = Displacement::default();
            }
        }
        self.respond(&mut undeformed);
        let imbalance = self.imbalance(&undeformed, &action.loads);
        if imbalance.largest == 0.0 && imbalance.force == 0.0 {
            *configuration = undeformed;
        }
    }

    pub(super) fn keep_iterate(&self, configuration: &Configuration, progress: &mut Progress) {
        if self.settings.keep_iterates && progress.iterations > 0 {
            let (iteration, residual) = (progress.iterations, progress.residual);
            progress.iterates.push(Iterate {
                iteration,
                residual,
                state: configuration.state(),
                ledger: None,
            });
        }
    }

    /// A proximal step along a mechanism that the loads move.
    fn drift(
        &mut self,
        configuration: &mut Configuration,
        action: &Action,
        iteration: Iteration,
        progress: &mut Progress,
    ) -> Result<Settled, Failure> {
        self.respond(configuration);
        let imbalance = self.imbalance(configuration, &action.loads);
        // A tangent may be singular even so; the secant is not.
        let step = self
            .solve(
                configuration,
                &imbalance.unbalanced,
                iteration,
                PROXIMAL,
                progress,
            )
            .or_else(|_| {
                self.solve(
                    configuration,
                    &imbalance.unbalanced,
                    Iteration::Secant,
                    PROXIMAL,
                    progress,
                )
            })
            .map_err(|_| not_converged(progress, &imbalance))?;
        if !self.any_phases(configuration) {
            return Err(Failure::Mechanism {
                grains: self.foremost_grains(|grain| self.motion(&step, grain)),
            });
        }
        self.advance(configuration, &step);
        self.respond(configuration);
        Ok(Settled::Drifting)
    }

    /// Whether no grain moves farther than the mean radius.
    fn is_small(&self, step: &[f64]) -> bool {
        let limit = self.assembly.mean_radius();
        (0..self.assembly.grains.len()).all(|grain| self.motion(step, grain) < limit)
    }

    /// How far a step moves a body, rotations at its rim.
    fn motion(&self, step: &[f64], body: usize) -> f64 {
        let components = self.numbers[body].map(|number| number.map_or(0.0, |n| step[n as usize]));
        Displacement::from_components(components)
            .largest_length(self.moment_arm(BodyId::from_index(body)))
    }

    pub(super) fn advance(&self, configuration: &mut Configuration, step: &[f64]) {
        for (body, numbers) in self.numbers.iter().enumerate() {
            if self.set_aside[body] {
                continue;
            }
            let u = &mut configuration.displacements[BodyId::from_index(body)];
            for (freedom, number) in ALL_FREEDOMS.into_iter().zip(numbers) {
                if let Some(number) = number {
                    *u.component_mut(freedom) += step[*number as usize];
                }
            }
        }
    }
}

fn linear_force(bond: &Bond, v: RelativeDisplacement, k: &Matrix) -> ContactForce {
    let step = [
        v.normal - bond.displacement.normal,
        v.shear - bond.displacement.shear,
        v.rotation - bond.displacement.rotation,
    ];
    let change = k.map(|row| row[0] * step[0] + row[1] * step[1] + row[2] * step[2]);
    ContactForce {
        normal: bond.force.normal + change[0],
        shear: bond.force.shear + change[1],
        moment: bond.force.moment + change[2],
    }
}

pub(super) fn not_converged(progress: &Progress, imbalance: &Imbalance) -> Failure {
    Failure::NotConverged {
        iterations: progress.iterations,
        residual: progress.residual,
        at: imbalance.at,
    }
}

/// Largest unbalanced forces of an iteration.
#[derive(Default)]
struct History {
    largest: Vec<f64>,
}

impl History {
    /// Adds one; answers by which factor it fell (at first 0).
    fn push(&mut self, largest: f64) -> f64 {
        let before = self.largest.last().copied();
        self.largest.push(largest);
        before.map_or(0.0, |before| largest / before)
    }

    fn len(&self) -> usize {
        self.largest.len()
    }

    /// Too long, not a number, or no gain by the tangent.
    fn is_over(&self, iteration: Iteration) -> bool {
        self.largest.last().is_some_and(|last| !last.is_finite())
            || self.len() > MOST_ITERATIONS
            || iteration == Iteration::Tangent && self.is_hopeless()
    }

    /// No better than twelve iterations ago.
    fn is_hopeless(&self) -> bool {
        let n = self.largest.len();
        n > 12 && self.largest[n - 1] > 0.5 * self.largest[n - 13]
    }
}
