//! Contacts whose stiffness depends on the state: the factor of the next event is a root of ρ_max(x) − 1, each value of
//! which is an equilibrium found from the last one accepted. What a contact remembers comes from accepted equilibria
//! alone.
//!
//! After a break equilibrium is found at the same factor; where a bond is then beyond its limit, the factor falls to where
//! none is, and if there is no such factor down to where the run began, the worst bond breaks where the factor stands.

use super::acting::{self, Acting};
use super::bracket::Bracket;
use super::{EventDriven, Reached, Run, Unfinished};
use crate::equilibrium::configuration::Failure;
use crate::equilibrium::system::System;
use crate::equilibrium::{Drive, EventKind, Iteration};
use crate::loading::advance::{self, Break, Point, Way};
use crate::loading::load_path::COLLAPSE;
use crate::loading::{Breakage, Program};

/// A root is known to this share of the factor.
const FACTOR_TOLERANCE: f64 = 1e-12;
/// The first step down after a break, as a share of the factor; the next ones double.
const FIRST_FALL: f64 = 1.0 / 256.0;

/// A search through a load step.
struct Search<'w, 'a> {
    system: &'w mut System<'a>,
    program: &'w Program,
    point: &'w mut Point,
    way: &'w mut Way,
    run: &'w mut Run,
    acting: Acting,
    /// The present factor.
    x: f64,
    /// Largest factor of the load step.
    scale: f64,
    went_on: bool,
}

/// An equilibrium that was looked at.
#[derive(Clone, Copy)]
struct Trial {
    x: f64,
    /// ρ_max − 1.
    excess: f64,
}

/// Goes on with a load step to the next event or its end; `point` becomes the last equilibrium found.
pub fn advance(
    event_driven: &mut EventDriven,
    system: &mut System<'_>,
    program: &Program,
    point: &mut Point,
    unfinished: &mut Unfinished,
) -> Option<Reached> {
    let load_step = &unfinished.load_step;
    let [start, target] = acting::ends(program, load_step);
    let mut search = Search {
        acting: Acting::new(program, load_step, system.assembly.body_count()),
        system,
        program,
        point,
        way: &mut unfinished.way,
        run: &mut event_driven.run,
        x: unfinished.x.unwrap_or(start),
        scale: start.abs().max(target.abs()),
        went_on: unfinished.went_on,
    };
    let outcome = search.follow(target);
    if let Ok(false) = outcome {
        (unfinished.x, unfinished.went_on) = (Some(search.x), search.went_on);
        return None;
    }
    if search.x == target {
        search.point.factors.clone_from(&load_step.to);
    }
    Some(Reached {
        load_factor: search.acting.load_factor(search.x),
        went_on: search.went_on,
        failure: outcome.err(),
    })
}

impl Search<'_, '_> {
    /// To the next event; whether that is the end of the load step.
    fn follow(&mut self, target: f64) -> Result<bool, Failure> {
        let broken = self.over_limit();
        if !broken.is_empty() {
            self.break_bonds(&broken)?;
            if !self.over_limit().is_empty()
                && let Some(trial) = self.fall()
            {
                self.accept(trial.x)?;
            }
        } else if self.go_on(target)? {
            self.run.reach(self.run.direction * target);
            return Ok(true);
        }
        Ok(false)
    }

    fn over_limit(&self) -> Vec<Break> {
        let ties = self.system.settings.tie_tolerance;
        advance::over_limit(self.point, ties, Breakage::EventDriven)
    }

    /// Goes to the target or to the next event before it; whether the target is reached. Where there is no equilibrium the
    /// way is halved.
    fn go_on(&mut self, target: f64) -> Result<bool, Failure> {
        let mut end = target;
        let trial = loop {
            match self.look(end) {
                Ok(trial) => break trial,
                Err(failure) if (end - self.x).abs() <= COLLAPSE * self.scale => {
                    return Err(failure);
                }
                Err(_) => end = 0.5 * (self.x + end),
            }
        };
        if trial.excess <= 0.0 {
            self.accept(trial.x)?;
            return Ok(end == target);
        }
        let utilisation = advance::utilisation(&self.point.configuration);
        let trial = self.root(self.x, utilisation - 1.0, trial);
        self.accept(trial.x)?;
        Ok(false)
    }

    /// The equilibrium at x, from the last accepted one.
    fn look(&mut self, x: f64) -> Result<Trial, Failure> {
        let action = self.acting.at(self.program, x);
        let excess = self.by_secant_or_tangent(|search| {
            let mut configuration = search.point.configuration.clone();
            let progress = &mut search.way.progress;
            search
                .system
                .equilibrate(&mut configuration, &action, progress)?;
            Ok(advance::utilisation(&configuration) - 1.0)
        })?;
        Ok(Trial { x, excess })
    }

    /// Where the secant finds no admissible phases, by the tangent again.
    fn by_secant_or_tangent<T>(
        &mut self,
        mut seek: impl FnMut(&mut Self) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let found = seek(self);
        let secant = self.system.settings.iteration == Iteration::Secant;
        if found.is_ok() || !secant || !self.system.any_phases(&self.point.configuration) {
            return found;
        }
        self.system.settings.iteration = Iteration::Tangent;
        let again = seek(self);
        self.system.settings.iteration = Iteration::Secant;
        again.or(found)
    }

    /// Where ρ_max passes 1 between an admissible factor and that of `over`, on the far side of the root.
    fn root(&mut self, admissible: f64, excess: f64, over: Trial) -> Trial {
        let way = over.x - admissible;
        let tolerance = FACTOR_TOLERANCE * self.scale / way.abs();
        let mut bracket = Bracket::new(excess, over.excess, tolerance);
        let mut best = over;
        while let Some(share) = bracket.next() {
            let x = admissible + share * way;
            // Where there is no equilibrium the root lies nearer.
            let looked = self.look(x);
            bracket.narrow(share, looked.as_ref().map_or(1.0, |trial| trial.excess));
            if let Ok(trial) = looked
                && trial.excess > 0.0
            {
                best = trial;
            }
        }
        best
    }

    /// The first event in falling direction, if any factor down to where the run began is admissible.
    fn fall(&mut self) -> Option<Trial> {
        let direction = self.run.direction;
        let back = direction * self.run.back;
        let mut step = FIRST_FALL * self.scale;
        let mut over: Option<Trial> = None;
        let mut last = self.x;
        while last != back {
            let next = self.x - direction * step;
            let next = if direction * next <= self.run.back {
                back
            } else {
                next
            };
            if let Ok(trial) = self.look(next) {
                if trial.excess <= 0.0 {
                    let over = over.or_else(|| self.look(self.x).ok())?;
                    return Some(self.root(trial.x, trial.excess, over));
                }
                over = Some(trial);
            }
            last = next;
            step *= 2.0;
        }
        None
    }

    /// The equilibrium at x, which was looked at, becomes the point.
    fn accept(&mut self, x: f64) -> Result<(), Failure> {
        let action = self.acting.at(self.program, x);
        let load_factor = self.acting.load_factor(x);
        let mut point = self.by_secant_or_tangent(|search| {
            let Search {
                system, point, way, ..
            } = search;
            let found = advance::equilibrium(system, point, &[], &action, load_factor, way);
            Ok(found?.0)
        })?;
        point.factors = self.acting.factors(x);
        advance::check(self.system, &point, self.way)?;
        self.went_on |= x != self.x;
        self.x = x;
        *self.point = point;
        Ok(())
    }

    fn drive(&self) -> Option<Drive> {
        let Point {
            configuration,
            forces,
            ..
        } = &*self.point;
        let displacements = configuration
            .displacements
            .iter()
            .map(|(body, u)| (body, *u));
        let moved = self.acting.moved.iter();
        let reactions =
            moved.map(|(body, freedom, _)| forces.reactions[*body].components()[freedom.index()]);
        self.acting.drive(self.x, displacements, reactions)
    }

    /// Breaks bonds together where the factor stands.
    fn break_bonds(&mut self, broken: &[Break]) -> Result<(), Failure> {
        let action = self.acting.at(self.program, self.x);
        let load_factor = self.acting.load_factor(self.x);
        let before = self.way.events.len();
        let drive = self.drive();
        let next = advance::break_bonds(
            self.system,
            self.point,
            broken,
            &action,
            load_factor,
            self.way,
        );
        let next = next.and_then(|point| {
            advance::check(self.system, &point, self.way)?;
            Ok(point)
        });
        match next {
            Ok(point) => *self.point = point,
            Err(failure) => {
                self.way.events.truncate(before);
                return Err(failure);
            }
        }
        let avalanche = self.run.avalanche(self.run.direction * self.x);
        for event in &mut self.way.events[before..] {
            event.avalanche = Some(avalanche);
            if matches!(event.kind, EventKind::Broke { .. }) {
                event.drive = drive;
            }
        }
        self.went_on = true;
        Ok(())
    }
}
