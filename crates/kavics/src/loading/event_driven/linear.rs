//! Linear contacts: between two events the state is a straight line in the factor, u₀ + x·u₁, and each contact holds in
//! an interval of it. The next event is the end of what these have in common, in the direction of loading:
//!
//! * the target lies before that end: the load step ends there;
//! * else the factor goes there, up or down, and the contact breaks;
//! * no factor is admissible, none back to where the factors began to run this way, or only factors ahead: the worst
//!   contact breaks where the factor stands, again and again until the state is admissible.
//!
//! DeJong, Hendriks & Rots (2008); Eliáš, Frantík & Vořechovský (2010) for loads that stay constant.

use std::mem::take;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::acting::{self, Acting};
use super::network::Network;
use super::outer::{Outer, OuterPlaces};
use super::spring::Interval;
use super::{EventDriven, Reached, Run, Unfinished};
use crate::contact_law::Mode;
use crate::equilibrium::Load;
use crate::equilibrium::configuration::Failure;
use crate::equilibrium::system::{Imbalance, System, is_set};
use crate::ids::{BodyId, ContactId, PerBody, PropertyId};
use crate::loading::Program;
use crate::loading::advance::{self, Point, Way};
use crate::loading::ledger::{self, Forces};
use crate::loading::load_path::LoadStep;

/// A residual below this share of the forces is rounding.
const ROUNDING: f64 = 1e-13;
/// A residual above this share of the forces, though solved for, says that the loads move a mechanism.
const UNBALANCED: f64 = 1e-9;
/// The walk pauses after so many events.
const PAUSE_EVERY: usize = 64;
/// Solves after which a residual is what it is.
pub const MOST_SOLVES: usize = 3;

/// What is kept from event to event.
#[derive(Clone, Debug)]
pub struct Course {
    /// The load step whose line it is.
    pub line: LoadStep,
    pub network: Network,
    pub places: OuterPlaces,
    /// Floppy modes held in the factor.
    pub held: usize,
    /// Events since the factor was made.
    pub events: usize,
    /// Bonds that broke since, with their properties before.
    pub broken: Vec<(ContactId, PropertyId)>,
    /// Room for the answers to an event.
    pub answers: Vec<[f64; 2]>,
    /// Room for the answer to an event where all is proportional.
    pub answer: Vec<[f64; 1]>,
}

/// A way through a load step.
pub struct Walk<'w, 'a> {
    pub system: &'w mut System<'a>,
    pub program: &'w Program,
    pub point: &'w mut Point,
    pub way: &'w mut Way,
    pub run: &'w mut Run,
    pub course: Course,
    /// The present factor.
    pub x: f64,
    /// The farthest factor of the load step.
    pub farthest: f64,
    /// What acts at the present factor.
    pub outer: Outer,
    /// Whether there is another equilibrium than that before the load step.
    pub went_on: bool,
    /// Set from outside: pause after the present event.
    stop: Option<Arc<AtomicBool>>,
}

/// How a load step begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Beginning {
    /// On a new line, which has still to be brought into balance.
    New,
    /// On a line that is in balance as far as it has been gone along, but goes farther.
    Farther,
    /// On a line that is in balance.
    Known,
}

/// What comes next.
enum Next {
    Arrive,
    Break(f64, Vec<(ContactId, Mode)>),
}

/// Goes on with a load step; `point` becomes the last equilibrium found. None: it pauses.
pub fn advance(
    event_driven: &mut EventDriven,
    system: &mut System<'_>,
    program: &Program,
    point: &mut Point,
    unfinished: &mut Unfinished,
) -> Option<Reached> {
    let load_step = &unfinished.load_step;
    let [start, target] = acting::ends(program, load_step);
    let (begun, kept) = (unfinished.x.is_some(), event_driven.course.take());
    let (course, beginning) = match kept {
        Some(course) if begun => (course, Beginning::Known),
        kept => Course::start(system, program, point, load_step, kept),
    };
    let mut walk = Walk {
        // A search for why there is no equilibrium is not broken off.
        stop: system.stop.take(),
        system,
        program,
        point,
        way: &mut unfinished.way,
        run: &mut event_driven.run,
        course,
        x: unfinished.x.unwrap_or(start),
        farthest: acting::farthest(program, load_step),
        outer: take(&mut unfinished.outer),
        went_on: unfinished.went_on,
    };
    let begins = if begun { Ok(()) } else { walk.begin(beginning) };
    let outcome = begins.and_then(|()| walk.follow(target));
    walk.system.stop = walk.stop.take();
    if let Ok(false) = outcome {
        (unfinished.x, unfinished.went_on) = (Some(walk.x), walk.went_on);
        unfinished.outer = walk.outer;
        event_driven.course = Some(walk.course);
        return None;
    }
    let failure = walk.end(outcome.map(|_| ()), target, load_step);
    let reached = Reached {
        load_factor: walk.load_factor(),
        went_on: walk.went_on,
        failure,
    };
    event_driven.course = Some(walk.course);
    Some(reached)
}

impl Course {
    /// The course of a line: the kept one where it is on the same.
    fn start(
        system: &System<'_>,
        program: &Program,
        point: &Point,
        load_step: &LoadStep,
        kept: Option<Self>,
    ) -> (Self, Beginning) {
        let configuration = &point.configuration;
        let acting = Acting::new(program, load_step, system.assembly.body_count());
        let mut course = match kept {
            Some(mut course) if course.network.acting == acting => {
                let is_known =
                    acting::farthest(program, load_step) <= acting::farthest(program, &course.line);
                if is_known {
                    return (course, Beginning::Known);
                }
                course.line = load_step.clone();
                return (course, Beginning::Farther);
            }
            Some(mut course) => {
                course.network.acting = acting;
                course.line = load_step.clone();
                course
            }
            None => Self::of(Network::new(system, configuration, acting), load_step),
        };
        course.places = OuterPlaces::new(system, &course.network);
        let bonds = configuration.bonds.values();
        course.network.proportional = course.network.acting.is_proportional()
            && bonds
                .iter()
                .all(|bond| !bond.broken || bond.property.is_none());
        (course, Beginning::New)
    }

    /// A network that has no factor yet.
    pub fn of(network: Network, load_step: &LoadStep) -> Self {
        Self {
            line: load_step.clone(),
            network,
            places: OuterPlaces::default(),
            held: 0,
            events: usize::MAX,
            broken: Vec::new(),
            answers: Vec::new(),
            answer: Vec::new(),
        }
    }
}

impl Walk<'_, '_> {
    /// Brings a course into balance. What is small beside the forces up to one factor need not be so beside those up to a
    /// farther one.
    fn begin(&mut self, beginning: Beginning) -> Result<(), Failure> {
        let moved = self.course.network.acting.largest_moves(self.farthest);
        let configuration = &self.point.configuration;
        self.system.moved_force = self.system.force_by_moves(configuration, &moved);
        if beginning == Beginning::Farther && !self.balance(MOST_SOLVES) {
            self.course.events = usize::MAX;
            return Err(self.failure_from_here());
        }
        if beginning == Beginning::New {
            let before = self.system.set_aside.clone();
            self.leave_out();
            let network = &mut self.course.network;
            network.start_again(self.system, &self.point.configuration);
            let stale = self.course.events == usize::MAX || before != self.system.set_aside;
            if stale && !self.factorise() || !self.balance(MOST_SOLVES) {
                self.course.events = usize::MAX;
                return Err(self.failure_from_here());
            }
            self.note_set_aside(self.load_factor(), None);
        }
        self.outer = self
            .course
            .places
            .at(self.system, &self.course.network, self.x);
        Ok(())
    }

    /// From event to event to the end of the load step; false: to a pause.
    fn follow(&mut self, target: f64) -> Result<bool, Failure> {
        for events in 1.. {
            match self.next(target) {
                Next::Arrive => {
                    self.go(target);
                    self.run.reach(self.run.direction * target);
                    return Ok(true);
                }
                Next::Break(x, contacts) => {
                    self.go(x);
                    self.break_bonds(&contacts)?;
                }
            }
            if self.pauses(events) {
                return Ok(false);
            }
        }
        Ok(false)
    }

    /// Iterates are too much to remember in a pause.
    fn pauses(&self, events: usize) -> bool {
        (events >= PAUSE_EVERY || is_set(self.stop.as_ref())) && !self.system.settings.keep_iterates
    }

    fn next(&self, target: f64) -> Next {
        let direction = self.run.direction;
        let network = &self.course.network;
        let ties = self.ties();
        let reach = network.reach(self.system, direction, ties);
        let Interval { lower, upper } = reach.interval;
        let worst = |x| network.worst(self.system, x, ties);
        let none = lower > upper;
        if none || lower > direction * self.x || upper < self.run.back {
            let (utilisation, contacts) = worst(self.x);
            // Unless the last equilibrium is beyond an end by rounding alone.
            if none || utilisation > 1.0 + ties {
                return Next::Break(self.x, contacts);
            }
        }
        if direction * target <= upper {
            return Next::Arrive;
        }
        let x = direction * upper;
        if !network.proportional {
            let (_, contacts) = worst(x);
            if contacts.iter().any(|(contact, _)| *contact == reach.last) {
                return Next::Break(x, contacts);
            }
        }
        // In proportion to the factor, ties end together; so do limits of zero, at a force of zero.
        Next::Break(x, network.growing(self.system, &reach.near, direction))
    }

    /// Relative difference of utilisations below which contacts break together.
    fn ties(&self) -> f64 {
        let settings = &self.system.settings;
        settings.tie_tolerance.max(10.0 * self.point.residual)
    }

    /// Goes along the line.
    fn go(&mut self, x: f64) {
        self.went_on |= x != self.x;
        self.x = x;
        self.arrive();
    }

    /// Counts the work of the straight way from where it was last counted.
    pub fn arrive(&mut self) {
        let outer = self
            .course
            .places
            .at(self.system, &self.course.network, self.x);
        self.point.energy.external_work += self.outer.work_to(&outer);
        self.outer = outer;
    }

    /// The present load factor.
    pub fn load_factor(&self) -> f64 {
        self.course.network.acting.load_factor(self.x)
    }

    /// Leaves out what nothing holds and nothing on this line loads; answers the loose pieces of more than one body.
    pub fn leave_out(&mut self) -> Vec<Vec<BodyId>> {
        let acting = &self.course.network.acting;
        let ever = acting.loads.iter().map(|[constant, rate]| {
            let mut sum = constant.magnitude();
            sum += rate.magnitude();
            sum
        });
        let ever: PerBody<Load> = ever.collect();
        let bonds = &self.point.configuration.bonds;
        self.system.leave_out_loose_pieces(bonds, &ever)
    }

    /// A factor of the bonds as they are.
    pub fn factorise(&mut self) -> bool {
        let factor = self.system.factorise_bonds(&self.point.configuration);
        self.course.events = 0;
        self.course.broken.clear();
        self.course.held = factor.as_ref().map_or(0, |held| *held);
        self.way.progress.held_pivots = self.course.held;
        factor.is_ok()
    }

    /// Solves for what is unbalanced, so often at most; whether nothing is any more.
    pub fn balance(&mut self, most_solves: usize) -> bool {
        for solve in 0.. {
            let residual = self.course.network.residual(self.system, self.farthest);
            let noise = self.system.noise();
            if solve == most_solves || residual.is_small(ROUNDING, noise) {
                self.system.largest_force = self.system.largest_force.max(residual.force);
                return residual.is_small(UNBALANCED, noise);
            }
            let answer = self.system.answer(&residual.unbalanced);
            self.way.progress.iterations += 1;
            let displacements = &mut self.course.network.displacements;
            self.system.add_answer(displacements, &answer);
        }
        false
    }

    /// Why there is no equilibrium at the present factor, or beyond it, with the bonds as they are, by the search for one.
    pub fn failure_from_here(&mut self) -> Failure {
        for x in [self.x, self.run.direction * self.farthest] {
            let action = self.course.network.acting.at(self.program, x);
            let mut trial = self.point.configuration.clone();
            let progress = &mut self.way.progress;
            self.system.respond(&mut trial);
            if let Err(failure) = self.system.equilibrate(&mut trial, &action, progress) {
                return failure;
            }
        }
        self.not_converged(BodyId(0))
    }

    /// The equilibrium at the present factor becomes the point; answers why there is not more.
    fn end(
        &mut self,
        outcome: Result<(), Failure>,
        target: f64,
        load_step: &LoadStep,
    ) -> Option<Failure> {
        let failure = outcome.err();
        if failure.is_some() && !self.went_on {
            return failure;
        }
        self.point.factors = if self.x == target {
            load_step.to.clone()
        } else {
            self.course.network.acting.factors(self.x)
        };
        let polished = self.write(failure.is_none());
        let checked = advance::check(self.system, self.point, self.way);
        failure.or(polished.err()).or(checked.err())
    }

    /// Writes the state into the point, solved for again where it is not yet within the tolerance.
    fn write(&mut self, has_factor: bool) -> Result<(), Failure> {
        let action = advance::action(
            self.program,
            &self.point.factors,
            self.system.assembly.body_count(),
        );
        let mut outcome = Ok(());
        let mut tries = if has_factor { 0 } else { 2 };
        let imbalance = loop {
            let configuration = &mut self.point.configuration;
            self.course
                .network
                .write(self.system, configuration, self.x);
            let imbalance = self.system.imbalance(configuration, &action.loads);
            self.point.residual = self.residual(&imbalance);
            self.way.progress.residual = self.point.residual;
            if self.point.residual <= self.system.settings.tolerance || tries == 2 {
                if has_factor && self.point.residual > self.system.settings.tolerance {
                    outcome = Err(self.not_converged(imbalance.at));
                }
                break imbalance;
            }
            if tries == 1 {
                self.factorise();
            }
            self.balance(MOST_SOLVES);
            self.arrive();
            tries += 1;
        };
        self.system.largest_force = self.system.largest_force.max(imbalance.force);
        self.point.forces = Forces {
            loads: action.loads,
            reactions: advance::reactions(self.system, &imbalance.unbalanced),
        };
        let properties = self.system.properties;
        let configuration = &mut self.point.configuration;
        self.point.energy.elastic_energy = ledger::elastic_energy(configuration, properties);
        for bond in configuration.bonds.values_mut() {
            bond.remember(properties);
        }
        outcome
    }

    /// Where nothing bears a load any more, what is unbalanced is the rounding of a rigid motion.
    fn residual(&self, imbalance: &Imbalance) -> f64 {
        let noise = self.system.noise();
        let residual = imbalance.residual(noise);
        if residual > self.system.settings.tolerance && imbalance.largest <= noise {
            0.0
        } else {
            residual
        }
    }

    fn not_converged(&self, at: BodyId) -> Failure {
        Failure::NotConverged {
            iterations: self.way.progress.iterations,
            residual: self.way.progress.residual,
            at,
        }
    }
}
