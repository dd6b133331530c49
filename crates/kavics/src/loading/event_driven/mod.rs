//! Breakage event by event: each bond breaks at the very factor at which it reaches its limit.
//!
//! After a bond broke the factor goes on to where the next one reaches its limit, which may lie lower: the path of
//! snap-back. Where all contacts are linear the factor of the next event is the end of an interval (`linear.rs`), else
//! a root (`rooted.rs`).

mod acting;
mod bracket;
mod breaking;
mod linear;
mod memory;
mod network;
mod outer;
mod rooted;
mod spring;

use std::iter::successors;

use self::linear::Course;
use self::outer::Outer;
use super::Program;
use super::advance::{Point, Way};
use super::load_path::LoadStep;
use crate::equilibrium::configuration::Failure;
use crate::equilibrium::system::System;
use crate::ids::PerProperty;

/// Event-driven breakage: what is kept from one load step to the next.
#[derive(Debug, Default)]
pub struct EventDriven {
    course: Option<Course>,
    /// The run of factors.
    pub run: Run,
}

/// A load step under way.
#[derive(Clone, Debug, Default)]
pub struct Unfinished {
    /// Its two ends.
    pub load_step: LoadStep,
    /// What has happened in it.
    pub way: Way,
    /// The present factor; none: not yet begun.
    x: Option<f64>,
    /// Whether there is another equilibrium than that before the load step.
    went_on: bool,
    /// What acts at the present factor.
    outer: Outer,
}

impl Unfinished {
    /// A load step that is still to be begun.
    pub fn new(load_step: LoadStep) -> Self {
        Self {
            load_step,
            ..Self::default()
        }
    }
}

/// How far a load step came.
#[derive(Debug)]
pub struct Reached {
    /// The load factor.
    pub load_factor: f64,
    /// Whether there is another equilibrium than that before the load step.
    pub went_on: bool,
    /// Why it came no farther.
    pub failure: Option<Failure>,
}

/// A part of a stage in which factors do not turn. Factors count in the direction of loading.
#[derive(Clone, Copy, Debug, Default)]
pub struct Run {
    stage: usize,
    /// 1 where factors rise, −1 where they fall.
    direction: f64,
    /// Whether its line is that of the whole stage.
    common: bool,
    /// The factor falls no farther than to this: to zero, or to where the run began.
    back: f64,
    /// Highest factor reached.
    highest: f64,
    /// Whether an event has happened in it.
    eventful: bool,
    /// Avalanches so far, over the whole run.
    avalanches: usize,
}

impl Run {
    /// Goes on with a load step, in a new run where stage, line or direction change.
    fn turn(&mut self, stage: usize, common: bool, [start, target]: [f64; 2]) {
        let direction = if target < start { -1.0 } else { 1.0 };
        let same = self.stage == stage && self.common && common;
        if same && (direction == self.direction || start == target) {
            return;
        }
        *self = Self {
            stage,
            direction,
            common,
            back: if common {
                (direction * start).min(0.0)
            } else {
                0.0
            },
            highest: direction * start,
            eventful: false,
            avalanches: self.avalanches,
        };
    }

    /// Number of the avalanche of an event: another one beyond all factors reached before.
    fn avalanche(&mut self, factor: f64) -> usize {
        if factor > self.highest || !self.eventful {
            self.avalanches += 1;
        }
        self.eventful = true;
        self.reach(factor);
        self.avalanches - 1
    }

    fn reach(&mut self, factor: f64) {
        self.highest = self.highest.max(factor);
    }
}

impl EventDriven {
    /// Goes on with a load step; `point` becomes the last equilibrium found. None: it pauses after an event.
    pub fn advance(
        &mut self,
        system: &mut System<'_>,
        program: &Program,
        point: &mut Point,
        unfinished: &mut Unfinished,
    ) -> Option<Reached> {
        if unfinished.x.is_none() {
            let load_step = &unfinished.load_step;
            let ends = acting::ends(program, load_step);
            let common = load_step.is_common(program);
            self.run.turn(load_step.stage, common, ends);
        }
        if is_linear(system, point) {
            linear::advance(self, system, program, point, unfinished)
        } else {
            rooted::advance(self, system, program, point, unfinished)
        }
    }
}

/// Whether every contact is linear, and whatever it may break into.
pub fn is_linear(system: &System<'_>, point: &Point) -> bool {
    let properties = system.properties;
    let mut linear = PerProperty::filled(false, properties.len());
    for (property, linear) in properties.ids().zip(linear.values_mut()) {
        let mut chain = successors(Some(property), |&p| properties[p].law.after_breakage());
        *linear = chain.all(|p| properties[p].law.is_linear());
    }
    let bonds = point.configuration.bonds.values().iter();
    bonds
        .filter_map(|bond| bond.property)
        .all(|property| linear[property])
}
