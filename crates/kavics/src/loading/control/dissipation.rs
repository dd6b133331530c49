//! Load steps steered by the energy that softening takes.

use super::Control;
use super::path::{CLOSED, Reached};
use crate::equilibrium::Iteration;
use crate::equilibrium::configuration::{Action, Failure};
use crate::equilibrium::steered::{Aim, Steering};
use crate::ids::BodyId;
use crate::loading::LoadPath;
use crate::loading::advance::{self, Along, Point, Way};
use crate::loading::load_path::LoadStep;

/// How often a load step is made smaller, and by how much.
const MOST_CUTS: usize = 12;
const CUT: f64 = 0.25;
/// Linear solves that a load step should take.
const WANTED_SOLVES: f64 = 5.0;
/// A load step takes no more than this share of what is left to take of the bonds on their limits.
const ALMOST: f64 = 1.0 - 5e-4;
/// A bond is brought to its limit up to this share.
const TO_LIMIT: f64 = 1.0 - 1e-10;
/// A bond on its limit softens if the load step would bring it there within this share.
const AT_ONCE: f64 = 1e-3;
/// Where a bond comes to its limit or breaks within this last share of a load step it counts as its end.
const AT_END: f64 = 0.98;
/// How often that is done in a load step.
const MOST_CORNERS: usize = 2;
/// Energy below which no load step is cut there, in first increments: the straight way to a corner may be a poor guess.
const LEAST: f64 = 0.2;
/// An elastic part of the way may take this share of the least increment.
const NOTHING: f64 = 1e-6;

impl LoadPath<'_> {
    /// Goes on towards the end of a load step, by load factor or energy.
    pub(super) fn by_energy(
        &mut self,
        load_step: &LoadStep,
        way: &mut Way,
        cuts: &mut usize,
    ) -> Result<Reached, Failure> {
        if !self.steered.by_energy {
            let most = self.steered.bounds[0];
            if self.try_share(load_step, 1.0, most, way).unwrap_or(false) {
                return Ok(Reached::Factor);
            }
            self.steered.by_energy = true;
            *cuts += 1;
        }
        let growth = self.growth(load_step);
        match self.elastic_share(&growth, way)? {
            None => self.soften(load_step, &growth, way, cuts),
            Some(share) => self.stretch(load_step, share, way, cuts),
        }
    }

    /// Share of the load step at which a bond comes to its limit; none: it softens at once.
    fn elastic_share(&mut self, growth: &Action, way: &mut Way) -> Result<Option<f64>, Failure> {
        let configuration = &self.point.configuration;
        let system = &mut self.system;
        let rate = system.elastic_growth(configuration, growth, &mut way.progress)?;
        let mut share: f64 = 1.0;
        for (frame, bond) in system.frames.iter().zip(configuration.bonds.values()) {
            let Some(softening) = bond.softening() else {
                continue;
            };
            let step = frame.relative_displacement(rate[frame.first], rate[frame.second]);
            let meets = softening.meets_limit(step, &bond.stiffness, &bond.memory);
            let on_limit = softening.room(&bond.stiffness, &bond.memory).is_some();
            if on_limit && meets < AT_ONCE {
                return Ok(None);
            }
            if !on_limit {
                share = share.min(meets * TO_LIMIT);
            }
        }
        Ok(Some(share))
    }

    /// Under load control to where the next bond comes to its limit.
    fn stretch(
        &mut self,
        load_step: &LoadStep,
        mut share: f64,
        way: &mut Way,
        cuts: &mut usize,
    ) -> Result<Reached, Failure> {
        let nothing = NOTHING * self.steered.bounds[0];
        let mut last = None;
        for _ in 0..=MOST_CUTS {
            match self.try_share(load_step, share, nothing, way) {
                Ok(true) if share == 1.0 => {
                    self.steered.by_energy = self.steered.control.control == Control::Dissipation;
                    return Ok(Reached::Factor);
                }
                Ok(true) => return Ok(Reached::Share(share)),
                Ok(false) => {}
                Err(failure) => last = Some(failure),
            }
            share *= 0.5;
            *cuts += 1;
        }
        Err(last.unwrap_or_else(|| stuck(way)))
    }

    /// The next equilibrium in which softening has taken the next increment of energy.
    fn soften(
        &mut self,
        load_step: &LoadStep,
        growth: &Action,
        way: &mut Way,
        cuts: &mut usize,
    ) -> Result<Reached, Failure> {
        let bonds = self.point.configuration.bonds.values().iter();
        let room: f64 = bonds
            .filter_map(|bond| bond.softening()?.room(&bond.stiffness, &bond.memory))
            .sum();
        let mut energy = self.steered.increment.min(ALMOST * room);
        let least = LEAST * self.steered.bounds[0];
        let (mut last, mut corners) = (None, 0);
        for cut in 0..=MOST_CUTS {
            let (solves, mut tried) = (way.progress.iterations, way.clone());
            let found = self.try_energy(load_step, growth, energy, cut, &mut tried);
            way.progress.iterations = tried.progress.iterations;
            match found {
                Ok((_, share)) if share >= 1.0 => {
                    if self.try_share(load_step, 1.0, energy, way).unwrap_or(false) {
                        return Ok(Reached::Factor);
                    }
                }
                Ok((point, share)) => {
                    let corner = self.corner(&point, energy);
                    if corner < AT_END && corners < MOST_CORNERS {
                        energy = least.max(energy * corner);
                        corners += 1;
                        continue;
                    }
                    (self.point, *way) = (point, tried);
                    if corners == 0 {
                        self.adapt(energy, way.progress.iterations - solves, cut);
                    }
                    let separated = self.break_worn(load_step, share, None, way);
                    return Ok(if separated {
                        Reached::Separated
                    } else {
                        Reached::Share(share)
                    });
                }
                Err(failure) => last = Some(failure),
            }
            energy *= CUT;
            *cuts += 1;
        }
        Err(last.unwrap_or_else(|| stuck(way)))
    }

    /// Share of the way to `point` at which a bond first comes to its limit or breaks, where the ledger is open.
    fn corner(&self, point: &Point, energy: f64) -> f64 {
        let open = self.left_open(&self.point, point);
        if open <= CLOSED * energy || energy <= LEAST * self.steered.bounds[0] {
            return 1.0;
        }
        let bonds = self.point.configuration.bonds.values().iter();
        let mut corner: f64 = 1.0;
        for (before, after) in bonds.zip(point.configuration.bonds.values()) {
            let Some(softening) = before.softening() else {
                continue;
            };
            let (k, memory) = (&before.stiffness, &before.memory);
            let [limit, broken] = softening.corners(after.displacement, k, memory);
            let on_limit = softening.room(k, memory).is_some();
            corner = corner.min(if on_limit { broken } else { limit.min(broken) });
        }
        corner
    }

    fn try_energy(
        &mut self,
        load_step: &LoadStep,
        growth: &Action,
        energy: f64,
        cut: usize,
        way: &mut Way,
    ) -> Result<(Point, f64), Failure> {
        // The tangent goes round in circles where bonds cannot agree which of them soften; the secant is slow.
        let iterations: &[Iteration] = if cut % 4 == 3 {
            &[Iteration::Tangent, Iteration::Secant]
        } else {
            &[Iteration::Tangent]
        };
        let mut tried = way.clone();
        let mut found = Err(stuck(way));
        for &iteration in iterations {
            found = self.steered(
                load_step,
                growth,
                Aim::Dissipation(energy),
                iteration,
                &mut tried,
            );
            if found.is_ok() {
                *way = tried;
                return found;
            }
        }
        way.progress.iterations = tried.progress.iterations;
        found
    }

    /// The equilibrium and the share of the load step at which `aim` holds.
    pub(super) fn steered(
        &mut self,
        load_step: &LoadStep,
        growth: &Action,
        aim: Aim,
        iteration: Iteration,
        way: &mut Way,
    ) -> Result<(Point, f64), Failure> {
        let (system, point) = (&mut self.system, &self.point);
        let start = advance::action(self.program, &load_step.from, system.assembly.body_count());
        let mut configuration = point.configuration.clone();
        let steering = Steering {
            start: &start,
            growth,
            from: &point.configuration.displacements,
            aim,
            iteration,
        };
        let share = system.steer(&mut configuration, steering, &mut way.progress)?;
        let (action, at) = (steering.action(share), load_step.load_factor(share));
        let along = Along::Steering(steering);
        let (here, _) = advance::settled(system, point, configuration, &action, along, at, way);
        let mut here = advance::hold(system, here, self.breakage, &action, at, way)?;
        here.factors = load_step.factors(share);
        Ok((here, share))
    }

    /// The next increment of energy, so that a load step takes some five linear solves.
    fn adapt(&mut self, energy: f64, solves: usize, cut: usize) {
        let [_, largest] = self.steered.bounds;
        let growth = (WANTED_SOLVES / solves.max(1) as f64)
            .sqrt()
            .clamp(0.5, 2.0);
        let increment = &mut self.steered.increment;
        if cut > 0 || energy == *increment {
            *increment = (energy * growth).min(largest);
        }
    }
}

/// Balanced here, and no farther.
fn stuck(way: &Way) -> Failure {
    Failure::NotConverged {
        iterations: way.progress.iterations,
        residual: way.progress.residual,
        at: BodyId(0),
    }
}
