//! Equilibrium with the share of a load step as one more unknown, and one more equation for it.
//!
//! ```math
//! \begin{bmatrix} K & -q \\ h^T & w \end{bmatrix} \begin{bmatrix} \Delta u \\ \Delta\xi \end{bmatrix}
//!   = \begin{bmatrix} r \\ -g \end{bmatrix},\qquad
//! \Delta\xi = -\frac{g + h\cdot K^{-1}r}{w + h\cdot K^{-1}q}
//! ```
//!
//! with the residual r, what it grows by with the share q = ∂r/∂ξ, and the equation g(u, ξ) = 0 with h = ∂g/∂u and
//! w = ∂g/∂ξ. Two back-substitutions with one factor of K. Verhoosel, Remmers & Gutiérrez (2009).

use super::balance::not_converged;
use super::bond::Bond;
use super::configuration::{Action, Configuration, Failure, Progress};
use super::system::System;
use super::{Displacement, Freedom, Iteration, Load};
use crate::contact_law::{ContactForce, Matrix, RelativeDisplacement};
use crate::geometry::Pieces;
use crate::ids::{BodyId, Id, PerBody, PerContact};

/// Sets of phases that are tried for one equilibrium.
const MOST_SETS: usize = 200;
/// Linear solves with one set of phases: by the tangent, by the secant.
const MOST_ITERATIONS: [usize; 2] = [16, 100];
/// The equation holds to this share of what is aimed at.
const AIMED: f64 = 1e-8;

/// What one more equation asks for.
#[derive(Clone, Copy, Debug)]
pub enum Aim {
    /// Energy that softening takes from the last equilibrium on, `[force·length]`.
    Dissipation(f64),
    /// Work of the loads' growth on the displacements from the last equilibrium on, `[force·length]`.
    Displacement(f64),
}

impl Aim {
    fn size(self) -> f64 {
        match self {
            Self::Dissipation(size) | Self::Displacement(size) => size.abs(),
        }
    }
}

/// A load step whose share is to be found.
#[derive(Clone, Copy)]
pub struct Steering<'a> {
    /// What acts at share 0, the last equilibrium.
    pub start: &'a Action,
    /// What it grows by up to share 1.
    pub growth: &'a Action,
    /// Displacements of the last equilibrium.
    pub from: &'a PerBody<Displacement>,
    /// What the equation asks for.
    pub aim: Aim,
    /// Which stiffness the iteration uses.
    pub iteration: Iteration,
}

impl Steering<'_> {
    /// The same way, aimed at a share of it.
    #[must_use]
    pub fn up_to(self, share: f64) -> Self {
        let aim = match self.aim {
            Aim::Dissipation(energy) => Aim::Dissipation(share * energy),
            Aim::Displacement(work) => Aim::Displacement(share * work),
        };
        Self { aim, ..self }
    }

    /// What acts at a share of the load step.
    pub fn action(&self, share: f64) -> Action {
        let mut action = self.start.clone();
        for (load, growth) in action
            .loads
            .values_mut()
            .iter_mut()
            .zip(self.growth.loads.values())
        {
            *load += *growth * share;
        }
        for (moved, growth) in action.moved.iter_mut().zip(&self.growth.moved) {
            moved.2 += share * growth.2;
        }
        action
    }
}

/// g and ∂g/∂u.
struct Equation {
    value: f64,
    slope: PerBody<Load>,
}

impl System<'_> {
    /// Brings a configuration into equilibrium where the equation holds; answers the share of the load step there.
    ///
    /// # Errors
    /// Where none is found.
    pub fn steer(
        &mut self,
        configuration: &mut Configuration,
        steering: Steering<'_>,
        progress: &mut Progress,
    ) -> Result<f64, Failure> {
        let mut ever = steering.start.loads.map(|load| load.magnitude());
        for (load, growth) in ever
            .values_mut()
            .iter_mut()
            .zip(steering.growth.loads.values())
        {
            *load += growth.magnitude();
        }
        let mut share = 0.0;
        for sets in 1..=MOST_SETS {
            let loose = self.leave_out_loose_pieces(&configuration.bonds, &ever);
            self.relax(&loose, &mut configuration.displacements);
            share = self.settle_steered(configuration, steering, share, progress)?;
            let groups = self.violations(configuration);
            let Some(group) = groups.first() else {
                progress.longest.note(sets, MOST_SETS);
                return Ok(share);
            };
            for &(contact, phase) in group {
                configuration.bonds[contact].phase = phase;
            }
        }
        let contacts = self.violations(configuration).into_iter().flatten();
        Err(Failure::Chatter {
            contacts: contacts.take(10).map(|(contact, _)| contact).collect(),
        })
    }

    fn settle_steered(
        &mut self,
        configuration: &mut Configuration,
        steering: Steering<'_>,
        mut share: f64,
        progress: &mut Progress,
    ) -> Result<f64, Failure> {
        let most = MOST_ITERATIONS[usize::from(steering.iteration == Iteration::Secant)];
        for left in (0..=most).rev() {
            let action = steering.action(share);
            for &(body, freedom, value) in &action.moved {
                *configuration.displacements[body].component_mut(freedom) = value;
            }
            self.respond(configuration);
            let imbalance = self.imbalance(configuration, &action.loads);
            progress.residual = imbalance.residual(self.noise());
            self.keep_iterate(configuration, progress);
            let equation = self.equation(configuration, steering);
            // Where all forces vanish, the rounding of the displacements does not.
            let balanced =
                progress.residual <= self.settings.tolerance || imbalance.largest <= self.noise();
            if balanced && equation.value.abs() <= AIMED * steering.aim.size() {
                progress.longest.note(most - left, most);
                return Ok(share);
            }
            let failure = not_converged(progress, &imbalance);
            if left == 0 || !imbalance.largest.is_finite() || self.ends_here() {
                return Err(failure);
            }
            let unbalanced = &imbalance.unbalanced;
            let (step, change) = self
                .steered_step(configuration, steering, &equation, unbalanced, progress)
                .ok_or(failure)?;
            share += step;
            self.advance(configuration, &change);
        }
        unreachable!("the last iteration answers")
    }

    /// One linear solve of the bordered system: the changes of the share and of the displacements.
    fn steered_step(
        &mut self,
        configuration: &Configuration,
        steering: Steering<'_>,
        equation: &Equation,
        unbalanced: &PerBody<Load>,
        progress: &mut Progress,
    ) -> Option<(f64, Vec<f64>)> {
        let Steering {
            growth, iteration, ..
        } = steering;
        let pattern = self.pattern(configuration, growth, iteration);
        let sides = [unbalanced, &pattern];
        let solved = self.solve_pair(configuration, sides, iteration, progress);
        let [answer, rate] = solved.ok()?;
        let by_share = self.work_on(&equation.slope, &rate) + moved_work(&equation.slope, growth);
        let step = -(equation.value + self.work_on(&equation.slope, &answer)) / by_share;
        let change = answer.iter().zip(&rate).map(|(a, b)| a + step * b);
        step.is_finite().then(|| (step, change.collect()))
    }

    fn equation(&self, configuration: &Configuration, steering: Steering<'_>) -> Equation {
        match steering.aim {
            Aim::Displacement(aim) => {
                let slope = steering.growth.loads.clone();
                let u = &configuration.displacements;
                let work = u
                    .ids()
                    .map(|body| slope[body].work(u[body] - steering.from[body]));
                Equation {
                    value: work.sum::<f64>() - aim,
                    slope,
                }
            }
            Aim::Dissipation(aim) => self.dissipation(configuration, aim),
        }
    }

    /// Σ ΔD of the softening bonds less what is aimed at.
    fn dissipation(&self, configuration: &Configuration, aim: f64) -> Equation {
        let mut value = -aim;
        let mut slope = PerBody::filled(Load::default(), self.assembly.body_count());
        for (frame, bond) in self.frames.iter().zip(configuration.bonds.values()) {
            let Some(softening) = bond.softening() else {
                continue;
            };
            let (v, k, memory) = (bond.displacement, &bond.stiffness, &bond.memory);
            value += softening.dissipation(v, k, memory);
            let [first, second] = frame.loads(softening.dissipation_slope(v, k, memory));
            slope[frame.first] += first * -1.0;
            slope[frame.second] += second * -1.0;
        }
        Equation { value, slope }
    }

    /// q: what the unbalanced loads grow by with the share.
    fn pattern(
        &self,
        configuration: &Configuration,
        growth: &Action,
        iteration: Iteration,
    ) -> PerBody<Load> {
        let mut pattern = growth.loads.clone();
        if growth.moved.is_empty() {
            return pattern;
        }
        let moved = moved_displacements(&growth.moved, self.assembly.body_count());
        for (frame, bond) in self.frames.iter().zip(configuration.bonds.values()) {
            let v = frame.relative_displacement(moved[frame.first], moved[frame.second]);
            if bond.is_active() && v != RelativeDisplacement::default() {
                let [first, second] = frame.loads(product(&self.stiffness_of(bond, iteration), v));
                pattern[frame.first] += first;
                pattern[frame.second] += second;
            }
        }
        pattern
    }

    /// How the displacements would grow over the whole load step if no bond softened any further.
    ///
    /// # Errors
    /// Where the stiffness is singular.
    pub fn elastic_growth(
        &mut self,
        configuration: &Configuration,
        growth: &Action,
        progress: &mut Progress,
    ) -> Result<PerBody<Displacement>, Failure> {
        let pattern = self.pattern(configuration, growth, Iteration::Secant);
        self.factored = None;
        let solved = self.solve(configuration, &pattern, Iteration::Secant, 0.0, progress);
        let failure = Failure::Mechanism {
            grains: self.foremost_grains(|grain| pattern.values()[grain].largest_force(1.0)),
        };
        let rate = solved.map_err(|_| failure.clone())?;
        if progress.held_pivots > 0 {
            return Err(failure);
        }
        let mut grown = Configuration {
            displacements: moved_displacements(&growth.moved, self.assembly.body_count()),
            bonds: PerContact::default(),
        };
        self.advance(&mut grown, &rate);
        Ok(grown.displacements)
    }

    /// Whether a piece that the loads' growth pulls is tied to nothing that is held or moved.
    pub fn is_torn(&self, bonds: &PerContact<Bond>, growth: &Action) -> bool {
        let active = self.frames.iter().zip(bonds.values());
        let active = active.filter(|(_, bond)| bond.is_active());
        let pieces = Pieces::new(
            self.assembly.body_count(),
            active.map(|(frame, _)| [frame.first.0, frame.second.0]),
        );
        let tied = pieces.any(|body| self.anchored[body]);
        growth
            .loads
            .iter()
            .any(|(body, load)| *load != Load::default() && !tied[body.index()])
    }

    /// Σ slope·step over the unknowns.
    fn work_on(&self, slope: &PerBody<Load>, step: &[f64]) -> f64 {
        let mut work = 0.0;
        for body in slope.ids() {
            let load = self.free_part(body, slope[body]).components();
            for (value, number) in load.into_iter().zip(&self.numbers[body.index()]) {
                if let Some(number) = number {
                    work += value * step[*number as usize];
                }
            }
        }
        work
    }
}

/// Displacements of the moved freedoms alone.
pub(super) fn moved_displacements(
    moved: &[(BodyId, Freedom, f64)],
    bodies: usize,
) -> PerBody<Displacement> {
    let mut displacements = PerBody::filled(Displacement::default(), bodies);
    for &(body, freedom, value) in moved {
        *displacements[body].component_mut(freedom) = value;
    }
    displacements
}

/// Σ slope·growth over the moved freedoms.
fn moved_work(slope: &PerBody<Load>, growth: &Action) -> f64 {
    let of = |body: BodyId, freedom: Freedom| slope[body].components()[freedom.index()];
    let moved = growth.moved.iter();
    moved
        .map(|&(body, freedom, value)| of(body, freedom) * value)
        .sum()
}

/// Force of a linear contact.
pub(super) fn product(k: &Matrix, v: RelativeDisplacement) -> ContactForce {
    let [normal, shear, moment] =
        k.map(|row| row[0] * v.normal + row[1] * v.shear + row[2] * v.rotation);
    ContactForce {
        normal,
        shear,
        moment,
    }
}
