//! Supports, moves, loads and weight on bodies.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::Range;

use super::check_contacts::{ContactsPlan, FREEDOMS, SidePlan};
use super::checker::Checker;
use super::choose::choose;
use super::diagnostic::{Problem, short};
use super::edge_load::edge_loads;
use super::loading_plan::{
    LoadKind, LoadPlan, LoadingPlan, MotionPlan, MovePlan, TargetPlan, WeightPlan,
};
use super::sides::{edge_called, side_called};
use crate::assembly::{Assembly, Grain, Partner, envelope, middle};
use crate::equilibrium::{ALL_FREEDOMS, Freedom, Load};
use crate::ids::{BodyId, GrainId, SideId};
use crate::loading::{Action, AppliedLoad, Held, Prescribed, Program, Stage};
use crate::warning::WarningKind;

/// What determines a freedom.
#[derive(Clone, Debug)]
enum Owner {
    Held(Range<usize>),
    Moved(Range<usize>, Prescribed),
}

type Owners = BTreeMap<(BodyId, Freedom), Owner>;

/// Supports, moves and loads on the grains and sides of an assembly.
pub struct Loading<'a> {
    /// What acts.
    pub plan: &'a LoadingPlan,
    /// Which sides are present, and where they are free.
    pub contacts: &'a ContactsPlan,
    /// On what it acts.
    pub assembly: &'a Assembly,
    /// Gap up to which a grain touches an edge of the box, `[length]`.
    pub tolerance: f64,
}

impl Loading<'_> {
    /// The program with these actions and stages.
    pub fn program(
        &self,
        actions: Vec<Action>,
        stages: Vec<Stage>,
        checker: &mut Checker,
    ) -> Program {
        let mut owners = Owners::new();
        self.support(&mut owners, checker);
        for (action, motion) in self.plan.moves.iter().enumerate() {
            self.prescribe(motion, action, &mut owners, checker);
        }
        self.hold_sides(&mut owners);
        let mut loads = Vec::new();
        let first = self.plan.moves.len();
        for (number, load) in self.plan.loads.iter().enumerate() {
            self.load(load, first + number, &mut loads, checker);
        }
        if let Some(weight) = self.plan.weight {
            self.weigh(weight, first + self.plan.loads.len(), &mut loads);
        }
        let on_loads = self.plan.loads.iter().zip(first..);
        for (load, _) in on_loads.filter(|(_, action)| is_borne(*action, &loads, &owners)) {
            let name = &load.name.value;
            let what = format!(
                "load `{name}` acts on nothing but what is held or moved: it goes into supports, and strains nothing"
            );
            checker.warn(WarningKind::LoadHeld, what);
        }
        let mut held = Vec::new();
        let mut prescribed = Vec::new();
        for ((body, freedom), owner) in owners {
            match owner {
                Owner::Held(_) => held.push(Held { body, freedom }),
                Owner::Moved(_, value) => prescribed.push(value),
            }
        }
        Program {
            actions,
            held,
            prescribed,
            loads,
            stages,
        }
    }

    fn body(&self, grain: GrainId) -> BodyId {
        self.assembly.body(Partner::Grain(grain))
    }

    fn side(&self, side: usize) -> BodyId {
        self.assembly.body(Partner::Side(SideId(side as u32)))
    }

    fn support(&self, owners: &mut Owners, checker: &mut Checker) {
        for support in &self.plan.supports {
            for grain in choose(&support.grains, self.assembly, self.tolerance, checker) {
                for freedom in &support.fix {
                    let key = (self.body(grain), *freedom);
                    owners
                        .entry(key)
                        .or_insert(Owner::Held(support.span.clone()));
                }
            }
        }
    }

    /// What no move drives and the scene does not set free is held.
    fn hold_sides(&self, owners: &mut Owners) {
        for (side, plan) in self.contacts.sides.values().iter().enumerate() {
            let Some(plan) = plan else { continue };
            for (_, freedom) in FREEDOMS {
                if !plan.free.contains(&freedom) {
                    let key = (self.side(side), freedom);
                    owners.entry(key).or_insert(Owner::Held(plan.span.clone()));
                }
            }
        }
    }

    fn prescribe(
        &self,
        motion: &MovePlan,
        action: usize,
        owners: &mut Owners,
        checker: &mut Checker,
    ) {
        let mut values = Vec::new();
        match (&motion.target, &motion.motion) {
            (TargetPlan::Side(side, span), MotionPlan::Freedoms(freedoms)) => {
                let Some(plan) = self.present(*side, span, checker) else {
                    return;
                };
                for (freedom, amplitude, at) in freedoms {
                    if plan.free.contains(freedom) {
                        moves_a_free_side(*side, *freedom, at, &plan.span, checker);
                    } else {
                        values.push((self.side(*side), *freedom, *amplitude, at.clone()));
                    }
                }
            }
            (TargetPlan::Side(..), MotionPlan::Strain { .. }) => {}
            (TargetPlan::Grains(choice), how) => {
                for grain in choose(choice, self.assembly, self.tolerance, checker) {
                    for (freedom, amplitude, at) in self.motion(grain, how) {
                        values.push((self.body(grain), freedom, amplitude, at));
                    }
                }
            }
        }
        self.take(values, action, owners, checker);
    }

    /// Gives freedoms to a move; a freedom that has a value already is an error, told once a move.
    fn take(
        &self,
        values: Vec<(BodyId, Freedom, f64, Range<usize>)>,
        action: usize,
        owners: &mut Owners,
        checker: &mut Checker,
    ) {
        let mut told = false;
        for (body, freedom, amplitude, at) in values {
            let value = Prescribed {
                body,
                freedom,
                amplitude,
                action,
            };
            match owners.entry((body, freedom)) {
                Entry::Vacant(place) => {
                    place.insert(Owner::Moved(at, value));
                }
                Entry::Occupied(first) if !told => {
                    told = true;
                    let (first, how) = match first.get() {
                        Owner::Held(span) => (span, "held here"),
                        Owner::Moved(span, _) => (span, "moved here"),
                    };
                    let what = format!("{} of {}", freedom_name(freedom), self.name(body));
                    checker.push(
                        Problem::at(
                            &at,
                            format!("two values for the freedom {what}"),
                            "expected a freedom that nothing else holds or moves",
                        )
                        .and(first, how),
                    );
                }
                Entry::Occupied(_) => {}
            }
        }
    }

    fn name(&self, body: BodyId) -> String {
        match self.assembly.partner(body) {
            Partner::Grain(grain) => format!("grain {grain}"),
            Partner::Side(side) => side_called(&self.assembly.sides[side].name),
        }
    }

    /// What a motion makes of the freedoms of a grain.
    fn motion(&self, grain: GrainId, how: &MotionPlan) -> Vec<(Freedom, f64, Range<usize>)> {
        match how {
            MotionPlan::Freedoms(freedoms) => freedoms.clone(),
            MotionPlan::Strain {
                xx,
                xy,
                yx,
                yy,
                free_rotation,
                span,
            } => {
                let r = self.assembly.grains[grain].centre - middle(&self.assembly.sides);
                let mut values = vec![
                    (Freedom::X, xx * r.x + yx * r.y, span.clone()),
                    (Freedom::Y, xy * r.x + yy * r.y, span.clone()),
                ];
                if !free_rotation {
                    values.push((Freedom::Rotation, 0.5 * (xy - yx), span.clone()));
                }
                values
            }
        }
    }

    fn present(
        &self,
        side: usize,
        span: &Range<usize>,
        checker: &mut Checker,
    ) -> Option<&SidePlan> {
        let plan = self.contacts.sides.values()[side].as_ref();
        if plan.is_none() {
            let name = checker.sides.name(side);
            checker.push(
                Problem::at(
                    span,
                    format!("{} is absent", side_called(&name)),
                    "expected a side that the scene names",
                )
                .help(format!(
                    "a table `[side.{name}]` with its `contact` makes it present"
                )),
            );
        }
        plan
    }

    fn load(
        &self,
        load: &LoadPlan,
        action: usize,
        loads: &mut Vec<AppliedLoad>,
        checker: &mut Checker,
    ) {
        match &load.kind {
            LoadKind::Edge {
                edge,
                span,
                normal,
                shear,
            } => {
                let grains = &self.assembly.grains;
                let side = &self.assembly.sides[SideId(*edge as u32)];
                let parts: Vec<(GrainId, f64, f64)> = envelope(grains, side)
                    .iter()
                    .map(|part| (part.grain, part.from, part.to))
                    .collect();
                let covered: f64 = parts.iter().map(|(_, from, to)| to - from).sum();
                let uncovered = side.length() - covered;
                let on_grains = edge_loads(grains, &parts, side, *normal, *shear);
                if on_grains.is_empty() {
                    checker.push(Problem::at(
                        span,
                        format!("load `{}` meets no grain", load.name.value),
                        "expected an edge with grains before it",
                    ));
                } else if uncovered > 1e-9 * side.length() {
                    checker.warn(WarningKind::LoadUncovered, format!(
                        "load `{}`: no grain is met over {} of the {} of {}; nothing acts there",
                        load.name.value,
                        short(uncovered),
                        short(side.length()),
                        edge_called(&side.name)
                    ));
                }
                for (grain, load) in on_grains {
                    push_load(self.body(grain), load, action, loads);
                }
            }
            LoadKind::Force(TargetPlan::Grains(choice), force, _) => {
                for grain in choose(choice, self.assembly, self.tolerance, checker) {
                    push_load(self.body(grain), *force, action, loads);
                }
            }
            LoadKind::Force(TargetPlan::Side(side, span), force, parts) => {
                let Some(plan) = self.present(*side, span, checker) else {
                    return;
                };
                for (freedom, at) in parts {
                    if !plan.free.contains(freedom) {
                        loads_a_held_side(*side, *freedom, at, &plan.span, checker);
                    }
                }
                push_load(self.side(*side), *force, action, loads);
            }
        }
    }

    /// Weight ρ·π·R²·t·g of each grain.
    fn weigh(&self, weight: WeightPlan, action: usize, loads: &mut Vec<AppliedLoad>) {
        let specific = weight.density * weight.gravity * self.assembly.thickness;
        for (grain, Grain { radius, .. }) in self.assembly.grains.iter() {
            let force = Load {
                y: -specific * std::f64::consts::PI * radius * radius,
                ..Load::default()
            };
            push_load(self.body(grain), force, action, loads);
        }
    }
}

fn push_load(body: BodyId, load: Load, action: usize, loads: &mut Vec<AppliedLoad>) {
    if load != Load::default() {
        loads.push(AppliedLoad { body, load, action });
    }
}

fn freedom_name(freedom: Freedom) -> &'static str {
    let found = FREEDOMS.iter().find(|(_, f)| *f == freedom);
    found.map_or("", |(name, _)| *name)
}

fn moves_a_free_side(
    side: usize,
    freedom: Freedom,
    at: &Range<usize>,
    table: &Range<usize>,
    checker: &mut Checker,
) {
    let side = side_called(&checker.sides.name(side));
    let freedom = freedom_name(freedom);
    checker.push(
        Problem::at(
            at,
            format!("{side} is free in {freedom} and cannot be moved there"),
            "expected a move of a held freedom",
        )
        .and(table, format!("`free` sets {freedom} free here")),
    );
}

fn loads_a_held_side(
    side: usize,
    freedom: Freedom,
    at: &Range<usize>,
    table: &Range<usize>,
    checker: &mut Checker,
) {
    let side = side_called(&checker.sides.name(side));
    let freedom = freedom_name(freedom);
    checker.push(
        Problem::at(
            at,
            format!("{side} is held in {freedom} and cannot be loaded there"),
            "expected a load on a free freedom",
        )
        .and(table, format!("`free = [\"{freedom}\"]` would set it free")),
    );
}

/// Whether an action loads held and moved freedoms alone.
fn is_borne(action: usize, loads: &[AppliedLoad], owners: &Owners) -> bool {
    let mut own = loads.iter().filter(|load| load.action == action).peekable();
    own.peek().is_some()
        && own.all(|applied| {
            let parts = ALL_FREEDOMS.into_iter().zip(applied.load.components());
            let mut acting = parts.filter(|(_, part)| *part != 0.0);
            acting.all(|(freedom, _)| owners.contains_key(&(applied.body, freedom)))
        })
}
