//! The load path: an iterator of equilibria.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::advance::{self, Point, Way};
use super::boundary::{Boundary, Last};
use super::control::{PathControl, Steered};
use super::event_driven::{self, EventDriven, Unfinished};
use super::{Breakage, Program, Stage, work};
use crate::assembly::Assembly;
use crate::contact_law::Property;
use crate::equilibrium::configuration::Failure;
use crate::equilibrium::system::{System, is_set};
use crate::equilibrium::{
    Equilibrium, Iteration, LargeMotion, Settings, SolveError, Stability, State, Warning, Watch,
    second_order_work,
};
use crate::ids::{PerGrain, PerProperty};

/// A load step that fails is halved until its end is known to this share of the load factor.
pub(super) const COLLAPSE: f64 = 1e-4;

/// Rounding of the ledger is below this share of its largest term.
const OPEN: f64 = 1e-9;

/// Where a load path comes to.
#[derive(Clone, Debug)]
pub enum Station {
    /// The end of a load step.
    Equilibrium(Box<Equilibrium>),
    /// An event within a load step, with more of it to come.
    Event,
    /// Wherever it was when it was told to stop.
    Stopped,
}

/// The equilibria of a program, one load step after the other.
///
/// The first item is the undeformed state, step 0. Where a load step cannot be finished, the last equilibrium
/// found within it comes with `complete = false`, then the error, then nothing.
pub struct LoadPath<'a> {
    pub(super) system: System<'a>,
    pub(super) program: &'a Program,
    pub(super) breakage: Breakage,
    pub(super) event_driven: EventDriven,
    /// The event-driven load step under way.
    pub(super) unfinished: Option<Unfinished>,
    pub(super) point: Point,
    /// Stage and place of the next load step in it.
    pub(super) next: (usize, usize),
    pub(super) step: usize,
    pub(super) waiting: VecDeque<Result<Equilibrium, SolveError>>,
    /// No load step is left: an error, or separated.
    pub(super) ended: bool,
    pub(super) steered: Steered,
    pub(super) last: Last,
    /// Where the path stood before the present attempt, which may be stopped.
    pub(super) kept: Option<Box<Boundary>>,
    /// Grains set aside before loading.
    aside_before: usize,
}

/// Factors at the two ends of a load step.
#[derive(Clone, Debug, Default)]
pub struct LoadStep {
    /// Index of the stage.
    pub stage: usize,
    /// Factor of each action at the start.
    pub from: Vec<f64>,
    /// And at the end.
    pub to: Vec<f64>,
    /// The stage's load factor at the two ends.
    pub load_factor: [f64; 2],
}

impl LoadStep {
    pub(super) fn factors(&self, share: f64) -> Vec<f64> {
        let between = |(from, to): (&f64, &f64)| {
            if share == 1.0 {
                *to
            } else {
                from + share * (to - from)
            }
        };
        self.from.iter().zip(&self.to).map(between).collect()
    }

    pub(super) fn load_factor(&self, share: f64) -> f64 {
        let [from, to] = self.load_factor;
        if share == 1.0 {
            to
        } else {
            from + share * (to - from)
        }
    }

    /// Whether all actions of the stage start from the same factor.
    pub(super) fn is_common(&self, program: &Program) -> bool {
        let actions = program.stages[self.stage].actions.iter();
        actions
            .map(|&action| self.from[action])
            .all(|from| from == self.load_factor[0])
    }

    /// Whether no factor changes by more than rounding.
    pub(super) fn is_at_rest(&self) -> bool {
        let mut ends = self.from.iter().zip(&self.to);
        ends.all(|(from, to)| (to - from).abs() <= 1e-12 * from.abs().max(to.abs()))
    }

    /// The factors at which the stage's actions are zero.
    pub(super) fn unloaded(&self, program: &Program) -> Vec<f64> {
        let mut factors = self.from.clone();
        for &action in &program.stages[self.stage].actions {
            factors[action] = 0.0;
        }
        factors
    }

    /// Share of this load step to which its end is to be known.
    fn resolution(&self) -> f64 {
        let [from, to] = self.load_factor;
        let scale = from.abs().max(to.abs());
        if from == to {
            COLLAPSE
        } else {
            COLLAPSE * scale / (to - from).abs()
        }
    }
}

impl<'a> LoadPath<'a> {
    /// The path of `program` through `assembly`.
    pub fn new(
        assembly: &'a Assembly,
        properties: &'a PerProperty<Property>,
        program: &'a Program,
        breakage: Breakage,
        settings: Settings,
    ) -> Self {
        let mut system = System::new(assembly, properties, settings, &advance::bound(program));
        let point = advance::undeformed(&mut system, program);
        let aside_before = aside_count(&point.set_aside);
        let mut path = Self {
            system,
            program,
            breakage,
            event_driven: EventDriven::default(),
            unfinished: None,
            point,
            next: (0, 0),
            step: 0,
            waiting: VecDeque::new(),
            ended: false,
            steered: Steered::default(),
            last: Last::default(),
            kept: None,
            aside_before,
        };
        let way = Way {
            events: advance::first_events(&path.point),
            ..Way::default()
        };
        let start = path.equilibrium(0, 0.0, true, 0, way);
        path.waiting.push_back(Ok(start));
        path
    }

    /// The same path, stages steered by `control`.
    #[must_use]
    pub fn steered_by(mut self, control: PathControl) -> Self {
        self.steered = Steered::new(control, &self.point.configuration);
        self
    }

    /// The same path, which stops soon after `stop` is set.
    #[must_use]
    pub fn stopped_by(mut self, stop: Arc<AtomicBool>) -> Self {
        self.system.stop = Some(stop);
        self
    }

    /// Goes on to the next station; none after the last. Without `stopped_by` it never stops.
    ///
    /// # Errors
    /// Where a load step cannot be finished.
    pub fn advance(&mut self) -> Option<Result<Station, SolveError>> {
        if self.waiting.is_empty() && !self.ended {
            if is_set(self.system.stop.as_ref()) {
                return Some(Ok(Station::Stopped));
            }
            self.keep();
            if !self.go_on()? && !self.system.stopped {
                self.forget_kept();
                return Some(Ok(Station::Event));
            }
            if self.system.stopped {
                self.waiting.clear();
                self.ended = true;
                return Some(Ok(Station::Stopped));
            }
            self.forget_kept();
        }
        let next = self.waiting.pop_front()?;
        Some(next.map(|equilibrium| Station::Equilibrium(Box::new(self.warned(equilibrium)))))
    }

    /// Keeps where the path stands, if it may be stopped before it stands elsewhere.
    fn keep(&mut self) {
        let configuration = &self.point.configuration;
        self.system.drop_old_hierarchy(configuration);
        // From event to event of linear contacts nothing is searched for that could be stopped.
        let is_walk = self.breakage == Breakage::EventDriven
            && event_driven::is_linear(&self.system, &self.point);
        if self.system.stop.is_some() && !is_walk && !self.is_within() {
            self.kept = Some(Box::new(self.boundary()));
        }
    }

    /// Within a load step whose iterates are kept, which are too much to remember, only its start can be gone on from.
    pub(super) fn is_within(&self) -> bool {
        self.unfinished.is_some() && self.system.settings.keep_iterates
    }

    fn forget_kept(&mut self) {
        if !self.is_within() {
            self.kept = None;
        }
    }

    /// Goes through the next load step; false: to an event in it. None where no load step is left.
    fn go_on(&mut self) -> Option<bool> {
        let step = self.step + usize::from(self.unfinished.is_none());
        self.system.watch.begin(step);
        if self.breakage == Breakage::EventDriven {
            return self.take_events();
        }
        let load_step = self.next_load_step()?;
        if self.steered.is_load_controlled() {
            self.take(&load_step);
        } else {
            self.take_steered(load_step);
        }
        Some(true)
    }

    /// Number of unknown displacements and rotations.
    pub fn unknowns(&self) -> usize {
        self.system.unknowns()
    }

    /// A window on the load step that is sought, to be read from another thread.
    pub fn watch(&self) -> Arc<Watch> {
        Arc::clone(&self.system.watch)
    }

    fn next_load_step(&mut self) -> Option<LoadStep> {
        let (mut stage, mut place) = self.next;
        while place >= self.program.stages.get(stage)?.factors.len() {
            (stage, place) = (stage + 1, 0);
        }
        self.next = (stage, place + 1);
        let Stage {
            actions, factors, ..
        } = &self.program.stages[stage];
        let from = self.point.factors.clone();
        let mut to = from.clone();
        for &action in actions {
            to[action] = factors[place];
        }
        let before = actions.first().map_or(0.0, |&action| from[action]);
        Some(LoadStep {
            stage,
            from,
            to,
            load_factor: [before, factors[place]],
        })
    }

    /// Finishes a load step, in parts where it does not go in one.
    pub(super) fn take(&mut self, load_step: &LoadStep) {
        self.step += 1;
        let before = self.wants_modes().then(|| self.point.configuration.state());
        let mut way = Way::default();
        let (mut done, mut part, mut cuts) = (0.0, 1.0, 0);
        let failure: Option<Failure> = loop {
            let target = if done + part > 1.0 - 1e-12 {
                1.0
            } else {
                done + part
            };
            match self.attempt(load_step, target, &mut way) {
                Ok(()) if target == 1.0 => break None,
                Ok(()) => done = target,
                Err(failure) if 0.5 * part < 0.5 * load_step.resolution() => break Some(failure),
                Err(_) => {
                    part *= 0.5;
                    cuts += 1;
                }
            }
        };
        let complete = failure.is_none();
        let reached = if complete { 1.0 } else { done };
        let load_factor = load_step.load_factor(reached);
        if reached > 0.0 {
            let mut equilibrium =
                self.equilibrium(load_step.stage, load_factor, complete, cuts, way);
            equilibrium.stability = before.and_then(|before| self.stability(&before));
            self.come_to(equilibrium);
        }
        self.end_with(failure, load_factor);
    }

    /// Goes on with a load step event by event; whether it is finished.
    fn take_events(&mut self) -> Option<bool> {
        let mut unfinished = if let Some(unfinished) = self.unfinished.take() {
            unfinished
        } else {
            let load_step = self.next_load_step()?;
            self.step += 1;
            Unfinished::new(load_step)
        };
        let (system, point) = (&mut self.system, &mut self.point);
        let reached = self
            .event_driven
            .advance(system, self.program, point, &mut unfinished);
        let Some(reached) = reached else {
            self.unfinished = Some(unfinished);
            return Some(false);
        };
        let Unfinished { load_step, way, .. } = unfinished;
        let complete = reached.failure.is_none();
        if complete || reached.went_on {
            let equilibrium =
                self.equilibrium(load_step.stage, reached.load_factor, complete, 0, way);
            self.come_to(equilibrium);
        }
        self.end_with(reached.failure, reached.load_factor);
        Some(true)
    }

    /// The path has come to an equilibrium.
    pub(super) fn come_to(&mut self, mut equilibrium: Equilibrium) {
        let configuration = &self.point.configuration;
        let rounding = work::rounding(&self.system, configuration);
        let (closing, open) = self.last.closing.at(&equilibrium.energy, rounding);
        let is_constant = !work::depends_on_state(&self.system, configuration);
        // With constant stiffness no more than rounding is left open.
        let allowed = self.system.settings.work_tolerance.max(OPEN);
        if is_constant && open > allowed {
            let warning = Warning::WorkError { relative: open };
            equilibrium.warnings.push(warning);
        }
        self.last = Last {
            stage: equilibrium.stage,
            load_factor: equilibrium.load_factor,
            is_tested: equilibrium.stability.is_some(),
            closing,
        };
        self.waiting.push_back(Ok(equilibrium));
    }

    fn end_with(&mut self, failure: Option<Failure>, load_factor: f64) {
        let Some(failure) = failure else {
            return;
        };
        let tolerance = self.system.settings.tolerance;
        let error = failure.at(self.step, load_factor, self.system.assembly, tolerance);
        self.waiting.push_back(Err(error));
        self.ended = true;
    }

    /// One part of a load step, where the secant finds no admissible phases by the tangent again.
    pub(super) fn attempt(
        &mut self,
        load_step: &LoadStep,
        share: f64,
        way: &mut Way,
    ) -> Result<(), Failure> {
        let failure = match self.attempt_once(load_step, share, way) {
            Err(failure)
                if self.system.settings.iteration == Iteration::Secant && self.has_phases() =>
            {
                failure
            }
            reached => return reached,
        };
        self.system.settings.iteration = Iteration::Tangent;
        let again = self.attempt_once(load_step, share, way);
        self.system.settings.iteration = Iteration::Secant;
        again.map_err(|_| failure)
    }

    fn has_phases(&self) -> bool {
        self.system.any_phases(&self.point.configuration)
    }

    /// One try; on failure all stays as it was but for the count of iterations.
    fn attempt_once(
        &mut self,
        load_step: &LoadStep,
        share: f64,
        way: &mut Way,
    ) -> Result<(), Failure> {
        let mut tried = way.clone();
        let (factors, load_factor) = (load_step.factors(share), load_step.load_factor(share));
        let reached = advance::advance(
            &mut self.system,
            self.program,
            self.breakage,
            &self.point,
            &factors,
            load_factor,
            &mut tried,
        );
        match reached {
            Ok(point) => {
                self.point = point;
                *way = tried;
                Ok(())
            }
            Err(failure) => {
                way.progress.iterations = tried.progress.iterations;
                way.account.iterations = tried.account.iterations;
                Err(failure)
            }
        }
    }

    pub(super) fn equilibrium(
        &self,
        stage: usize,
        load_factor: f64,
        complete: bool,
        cuts: usize,
        way: Way,
    ) -> Equilibrium {
        Equilibrium {
            step: self.step,
            stage,
            load_factor,
            factors: self.point.factors.clone(),
            complete,
            iterations: way.progress.iterations,
            work_iterations: way.account.iterations,
            residual: self.point.residual,
            cuts,
            state: self.point.configuration.state(),
            loads: self.point.forces.loads.clone(),
            reactions: self.point.forces.reactions.clone(),
            set_aside: self.point.set_aside.clone(),
            energy: self.point.energy,
            events: way.events,
            warnings: way.warnings,
            iterates: way.progress.iterates,
            stability: None,
            tangents: (self.system.settings.keep_tangents)
                .then(|| self.system.contact_tangents(&self.point.configuration)),
        }
    }

    /// With the warnings that the equilibrium itself gives rise to.
    fn warned(&self, mut equilibrium: Equilibrium) -> Equilibrium {
        let grains = aside_count(&equilibrium.set_aside);
        if equilibrium.step == 0 {
            return equilibrium;
        }
        let warnings = &mut equilibrium.warnings;
        if equilibrium.cuts > 0 {
            let cuts = equilibrium.cuts;
            warnings.push(Warning::StepCut { cuts });
        }
        if grains > self.aside_before {
            warnings.push(Warning::SetAside { grains });
        }
        if self.wants_modes() && equilibrium.stability.is_none() {
            warnings.push(Warning::NoModes);
        }
        let (state, set_aside) = (&equilibrium.state, &equilibrium.set_aside);
        let large = LargeMotion::of(&self.system, state, set_aside);
        warnings.extend(large.map(Warning::LargeDisplacements));
        equilibrium
    }

    fn wants_modes(&self) -> bool {
        self.system.settings.modes > 0
    }

    /// The stability of the present point, reached from `before`.
    pub(super) fn stability(&self, before: &State) -> Option<Stability> {
        let configuration = &self.point.configuration;
        let modes = self.system.settings.modes;
        let mut stability = self.system.stability(configuration, modes).ok()?;
        stability.summary.second_order_work = second_order_work(before, &configuration.state());
        Some(stability)
    }
}

fn aside_count(set_aside: &PerGrain<bool>) -> usize {
    set_aside.values().iter().filter(|&&aside| aside).count()
}

impl Iterator for LoadPath<'_> {
    type Item = Result<Equilibrium, SolveError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            match self.advance()? {
                Ok(Station::Equilibrium(equilibrium)) => return Some(Ok(*equilibrium)),
                Ok(Station::Event) => {}
                Ok(Station::Stopped) => return None,
                Err(error) => return Some(Err(error)),
            }
        }
    }
}
