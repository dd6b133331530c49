//! From one equilibrium to the next along the load path, bonds breaking on the way.

use rayon::prelude::*;

use super::ledger::{self, Forces};
use super::work::{self, Account, Stretch, Vanishing};
use super::{Breakage, Program};
use crate::contact_law::{ContactForce, Mode, Phase};
use crate::equilibrium::bond::Bond;
use crate::equilibrium::configuration::{Action, Configuration, Failure, Longest, Progress};
use crate::equilibrium::steered::Steering;
use crate::equilibrium::system::System;
use crate::equilibrium::{
    ALL_FREEDOMS, Displacement, Energy, Event, EventKind, Freedom, Load, Warning,
};
use crate::ids::{BodyId, ContactId, GrainId, PerBody, PerGrain};

/// An equilibrium with all that the next one starts from.
#[derive(Clone, Debug, Default)]
pub struct Point {
    /// Displacements and bonds.
    pub configuration: Configuration,
    /// Loads and reactions.
    pub forces: Forces,
    /// Work and energy since the start.
    pub energy: Energy,
    /// Factor of each action.
    pub factors: Vec<f64>,
    /// Grains set aside.
    pub set_aside: PerGrain<bool>,
    /// Last residual.
    pub residual: f64,
}

/// What happened on the way.
#[derive(Clone, Debug, Default)]
pub struct Way {
    /// Events in order.
    pub events: Vec<Event>,
    /// What the user should know.
    pub warnings: Vec<Warning>,
    /// Linear solves and iterates.
    pub progress: Progress,
    /// What the work has cost where stiffness depends on the state.
    pub account: Account,
    /// Energy that softening took, `[force·length]`.
    pub softened: f64,
}

/// An iteration is said to be near its limit from this share of it on.
const NEAR_LIMIT: f64 = 0.8;

/// A bond that breaks.
pub struct Break {
    contact: ContactId,
    mode: Mode,
}

/// The action at given factors.
pub fn action(program: &Program, factors: &[f64], bodies: usize) -> Action {
    let mut loads = PerBody::filled(Load::default(), bodies);
    for applied in &program.loads {
        let factor = factors[applied.action];
        if factor != 0.0 {
            loads[applied.body] += applied.load * factor;
        }
    }
    let moved = program
        .prescribed
        .iter()
        .map(|p| (p.body, p.freedom, p.amplitude * factors[p.action]))
        .collect();
    Action { loads, moved }
}

/// Goes from `point` to the equilibrium at `factors`, and on at these until nothing breaks any more.
///
/// # Errors
/// Where there is no equilibrium; `point` stays as it is.
pub fn advance(
    system: &mut System<'_>,
    program: &Program,
    breakage: Breakage,
    point: &Point,
    factors: &[f64],
    load_factor: f64,
    way: &mut Way,
) -> Result<Point, Failure> {
    let action = action(program, factors, system.assembly.body_count());
    let (mut here, _) = equilibrium(system, point, &[], &action, load_factor, way)?;
    here = hold(system, here, breakage, &action, load_factor, way)?;
    here.factors = factors.to_vec();
    Ok(here)
}

/// From an equilibrium under `action` to one in which no bond is beyond its limits.
pub fn hold(
    system: &mut System<'_>,
    mut here: Point,
    breakage: Breakage,
    action: &Action,
    load_factor: f64,
    way: &mut Way,
) -> Result<Point, Failure> {
    loop {
        let broken = over_limit(&here, system.settings.tie_tolerance, breakage);
        if broken.is_empty() {
            break;
        }
        here = break_bonds(system, &here, &broken, action, load_factor, way)?;
    }
    check(system, &here, way)?;
    Ok(here)
}

/// The equilibrium under `action`, reached from `before` while some forces vanish, and what each of these sets free.
pub fn equilibrium(
    system: &mut System<'_>,
    before: &Point,
    vanishing: &[Vanishing],
    action: &Action,
    load_factor: f64,
    way: &mut Way,
) -> Result<(Point, Vec<f64>), Failure> {
    let mut configuration = before.configuration.clone();
    system.equilibrate(&mut configuration, action, &mut way.progress)?;
    let along = Along::Vanishing(vanishing);
    Ok(settled(
        system,
        before,
        configuration,
        action,
        along,
        load_factor,
        way,
    ))
}

/// What leads from one equilibrium to the next beside the action.
#[derive(Clone, Copy)]
pub enum Along<'a> {
    /// Forces that vanish.
    Vanishing(&'a [Vanishing]),
    /// One more equation.
    Steering(Steering<'a>),
}

/// The point that a configuration in equilibrium is, reached from `before`; and what each vanishing force sets free.
pub fn settled(
    system: &mut System<'_>,
    before: &Point,
    configuration: Configuration,
    action: &Action,
    along: Along<'_>,
    load_factor: f64,
    way: &mut Way,
) -> (Point, Vec<f64>) {
    let forces = forces(system, &configuration, action);
    let (vanishing, steering): (&[Vanishing], _) = match along {
        Along::Vanishing(vanishing) => (vanishing, None),
        Along::Steering(steering) => (&[], Some(steering)),
    };
    let stretch = Stretch {
        before: (&before.configuration, &before.forces),
        after: (&configuration, &forces),
        action,
        vanishing,
        steering,
    };
    let mut energy = before.energy;
    let released = add_work(system, &mut energy, &stretch, &mut way.account);
    let reached = Reached {
        configuration,
        forces,
        energy,
    };
    let point = remembered(system, before, reached, load_factor, way);
    (point, released)
}

/// An equilibrium before its bonds remember it.
struct Reached {
    configuration: Configuration,
    forces: Forces,
    energy: Energy,
}

fn forces(system: &mut System<'_>, configuration: &Configuration, action: &Action) -> Forces {
    let imbalance = system.imbalance(configuration, &action.loads);
    system.largest_force = system.largest_force.max(imbalance.force);
    Forces {
        loads: action.loads.clone(),
        reactions: reactions(system, &imbalance.unbalanced),
    }
}

/// The point of an equilibrium, and what happened on the way to it.
fn remembered(
    system: &System<'_>,
    before: &Point,
    reached: Reached,
    load_factor: f64,
    way: &mut Way,
) -> Point {
    let Reached {
        mut configuration,
        forces,
        energy,
    } = reached;
    way.softened += energy.fracture_energy - before.energy.fracture_energy;
    let set_aside = system.loose_grains();
    let iteration = way.progress.iterations;
    let happened = phase_events(&before.configuration, &configuration)
        .chain(set_aside_events(&before.set_aside, &set_aside))
        .map(|kind| Event {
            iteration,
            load_factor,
            kind,
            avalanche: None,
            drive: None,
        });
    way.events.extend(happened);
    system.watch.note_load_factor(load_factor);
    for bond in configuration.bonds.values_mut() {
        bond.remember(system.properties);
    }
    let mut point = Point {
        configuration,
        forces,
        energy,
        factors: before.factors.clone(),
        set_aside,
        residual: way.progress.residual,
    };
    break_softened(system, &mut point, 0.0, load_factor, way);
    point
}

/// Adds the work on a way, by straight lines where all stiffness is constant; answers what vanishing forces set free.
fn add_work(
    system: &mut System<'_>,
    energy: &mut Energy,
    stretch: &Stretch<'_>,
    account: &mut Account,
) -> Vec<f64> {
    let after = stretch.after.0;
    let released = if work::depends_on_state(system, after) {
        let work = work::along(system, stretch, account);
        energy.external_work += work.external;
        energy.friction_work += work.friction;
        energy.nonpotential_work += work.nonpotential;
        energy.fracture_energy += work.fracture;
        energy.elastic_energy = ledger::elastic_energy(after, system.properties);
        work.released
    } else {
        ledger::add_way(energy, stretch.before, stretch.after, system.properties);
        let freed = |vanishing: &Vanishing| {
            let v = after.bonds[vanishing.contact].displacement;
            ledger::release_energy(vanishing.force, vanishing.from, v)
        };
        stretch.vanishing.iter().map(freed).collect()
    };
    for freed in &released {
        energy.release_energy += freed;
    }
    released
}

/// Breaks the bonds that softening has left at most this share of their force.
pub fn break_softened(
    system: &System<'_>,
    point: &mut Point,
    share: f64,
    load_factor: f64,
    way: &mut Way,
) {
    for contact in system.assembly.contacts.ids() {
        let bond = &mut point.configuration.bonds[contact];
        let Some((left, mode)) = bond.left().filter(|(left, _)| *left <= share) else {
            continue;
        };
        // What little it still holds goes with it.
        let held = if left > 0.0 {
            bond.energy(system.properties)
        } else {
            0.0
        };
        let fracture_energy = held + bond.memory.damage.dissipated;
        bond.break_into_successor(
            &system.assembly.contacts[contact],
            system.properties,
            system.assembly.thickness,
        );
        point.energy.fracture_energy += held;
        point.energy.elastic_energy -= held;
        way.events.push(Event {
            iteration: way.progress.iterations,
            load_factor,
            kind: EventKind::Broke {
                contact,
                mode,
                fracture_energy,
                release_energy: 0.0,
            },
            avalanche: None,
            drive: None,
        });
    }
}

/// What bound freedoms need so that nothing stays unbalanced.
pub fn reactions(system: &System<'_>, unbalanced: &PerBody<Load>) -> PerBody<Load> {
    unbalanced
        .ids()
        .map(|body| {
            let mut components = unbalanced[body].components();
            for freedom in ALL_FREEDOMS {
                let component = &mut components[freedom.index()];
                *component = if system.is_bound(body, freedom) {
                    -*component
                } else {
                    0.0
                };
            }
            Load::from_components(components)
        })
        .collect()
}

fn phase_events<'a>(
    before: &'a Configuration,
    after: &'a Configuration,
) -> impl Iterator<Item = EventKind> + 'a {
    let pairs = before.bonds.iter().zip(after.bonds.values());
    pairs
        .flat_map(|((contact, old), new)| changes(contact, old.phase, new.phase))
        .flatten()
}

/// What a change of phase is called: a contact that closes sliding closes and slides, one that slides the other way
/// sticks and slides.
fn changes(contact: ContactId, old: Phase, new: Phase) -> [Option<EventKind>; 2] {
    let first = match (old, new) {
        (old, new) if old == new => return [None, None],
        (_, Phase::Open) => return [Some(EventKind::Opened(contact)), None],
        (Phase::Open, _) => Some(EventKind::Closed(contact)),
        (Phase::Closed, _) => None,
        (Phase::SlidingForward | Phase::SlidingBackward, _) => Some(EventKind::Stuck(contact)),
    };
    let slides = matches!(new, Phase::SlidingForward | Phase::SlidingBackward);
    [first, slides.then_some(EventKind::Slid(contact))]
}

pub(super) fn set_aside_events<'a>(
    before: &'a PerGrain<bool>,
    after: &'a PerGrain<bool>,
) -> impl Iterator<Item = EventKind> + 'a {
    let changed = before
        .iter()
        .zip(after.values())
        .filter(|((_, before), after)| before != after);
    changed.map(|((grain, _), &now): ((GrainId, _), _)| {
        if now {
            EventKind::SetAside(grain)
        } else {
            EventKind::TakenBack(grain)
        }
    })
}

/// The bonds that break now: the worst with its ties, or all beyond their limits.
pub(super) fn over_limit(point: &Point, tie_tolerance: f64, breakage: Breakage) -> Vec<Break> {
    let utilisation = |bond: &Bond| bond.limits.utilisation(bond.force);
    let bonds = &point.configuration.bonds;
    let worst = self::utilisation(&point.configuration);
    if worst <= 1.0 {
        return Vec::new();
    }
    let ties = tie_tolerance.max(10.0 * point.residual);
    let bound = match breakage {
        Breakage::WorstFirst | Breakage::EventDriven => worst * (1.0 - ties),
        Breakage::Simultaneous => 1.0 - ties,
    };
    bonds
        .iter()
        .filter_map(|(contact, bond)| {
            let (reached, mode) = utilisation(bond);
            (reached >= bound).then_some(Break { contact, mode })
        })
        .collect()
}

/// Largest utilisation of any bond.
pub(super) fn utilisation(configuration: &Configuration) -> f64 {
    let bonds = configuration.bonds.values().iter();
    bonds
        .map(|bond| bond.limits.utilisation(bond.force).0)
        .fold(0.0, f64::max)
}

/// Breaks bonds and finds the next equilibrium under the same action.
pub(super) fn break_bonds(
    system: &mut System<'_>,
    point: &Point,
    broken: &[Break],
    action: &Action,
    load_factor: f64,
    way: &mut Way,
) -> Result<Point, Failure> {
    let mut start = point.clone();
    let bonds = &mut start.configuration.bonds;
    let first_event = way.events.len();
    let mut vanishing = Vec::with_capacity(broken.len());
    for Break { contact, mode } in broken {
        let bond = &mut bonds[*contact];
        let (force, from) = (bond.force, bond.displacement);
        let held = bond.energy(system.properties);
        bond.break_into_successor(
            &system.assembly.contacts[*contact],
            system.properties,
            system.assembly.thickness,
        );
        vanishing.push(Vanishing {
            contact: *contact,
            force: difference(force, bond.force),
            from,
        });
        let fracture_energy = held - bond.energy(system.properties);
        start.energy.fracture_energy += fracture_energy;
        let kind = EventKind::Broke {
            contact: *contact,
            mode: *mode,
            fracture_energy,
            release_energy: 0.0,
        };
        way.events.push(Event {
            iteration: way.progress.iterations,
            load_factor,
            kind,
            avalanche: None,
            drive: None,
        });
    }
    system.watch.note_broken(broken.len());
    let (next, released) = equilibrium(system, &start, &vanishing, action, load_factor, way)?;
    for (released, event) in released.into_iter().zip(&mut way.events[first_event..]) {
        if let EventKind::Broke { release_energy, .. } = &mut event.kind {
            *release_energy = released;
        }
    }
    Ok(next)
}

fn difference(a: ContactForce, b: ContactForce) -> ContactForce {
    ContactForce {
        normal: a.normal - b.normal,
        shear: a.shear - b.shear,
        moment: a.moment - b.moment,
    }
}

/// Refuses an equilibrium with a contact whose shear stiffness is lost; warns of what makes it less than it seems.
pub(super) fn check(system: &System<'_>, point: &Point, way: &mut Way) -> Result<(), Failure> {
    let (mut on_floor, mut unstable) = (0, 0);
    for (contact, bond) in point.configuration.bonds.iter() {
        if !bond.is_active() || bond.stiffness.hardening == 0.0 {
            continue;
        }
        let opening = bond.displacement.normal;
        if bond.stiffness.shear_at(opening) <= 0.0 {
            return Err(Failure::ShearLost { contact });
        }
        on_floor += usize::from(bond.stiffness.on_floor(opening));
        let tangent = bond.respond(bond.displacement, system.properties).tangent;
        let coupling = 0.5 * (tangent[0][1] + tangent[1][0]);
        unstable += usize::from(
            bond.phase == Phase::Closed && tangent[0][0] * tangent[1][1] < coupling * coupling,
        );
    }
    let warnings = [
        (on_floor, Warning::ShearFloor { contacts: on_floor }),
        (unstable, Warning::SecondOrderWork { contacts: unstable }),
        (
            way.progress.held_pivots,
            Warning::RegularisedPivots {
                count: way.progress.held_pivots,
            },
        ),
        (
            way.progress.chattered,
            Warning::Chattered {
                contacts: way.progress.chattered,
            },
        ),
    ];
    way.warnings = warnings
        .into_iter()
        .filter(|(count, _)| *count > 0)
        .map(|(_, warning)| warning)
        .collect();
    let relative = way.account.relative_error();
    let is_rounding = way.account.error <= work::rounding(system, &point.configuration);
    if relative > system.settings.work_tolerance && !is_rounding {
        way.warnings.push(Warning::WorkError { relative });
    }
    warn_of_solver(system, way);
    Ok(())
}

/// Warns of what the solver did other than asked for, or hardly.
fn warn_of_solver(system: &System<'_>, way: &mut Way) {
    way.warnings.extend(near_limit(way.progress.longest));
    let direct = system.breakdown;
    way.warnings
        .extend(direct.map(|breakdown| Warning::SolvedDirectly { breakdown }));
    if way.progress.uncounted {
        way.warnings.push(Warning::FloppyModesUncounted);
    }
}

fn near_limit(Longest { iterations, limit }: Longest) -> Option<Warning> {
    let is_near = iterations as f64 > NEAR_LIMIT * limit as f64;
    is_near.then_some(Warning::ManyIterations { iterations, limit })
}

/// The undeformed assembly.
pub fn undeformed(system: &mut System<'_>, program: &Program) -> Point {
    let assembly = system.assembly;
    let (properties, thickness) = (system.properties, assembly.thickness);
    let contacts = assembly.contacts.values().par_iter().with_min_len(4096);
    let bonds = contacts.map(|contact| Bond::new(contact, properties, thickness));
    let bonds = bonds.collect::<Vec<_>>().into();
    let bodies = assembly.body_count();
    let configuration = Configuration {
        displacements: PerBody::filled(Displacement::default(), bodies),
        bonds,
    };
    let none = PerBody::filled(Load::default(), bodies);
    // A piece is loose if nothing will ever load it.
    let mut ever = none.clone();
    for applied in &program.loads {
        ever[applied.body] += applied.load.magnitude();
    }
    system.leave_out_loose_pieces(&configuration.bonds, &ever);
    Point {
        configuration,
        forces: Forces {
            loads: none.clone(),
            reactions: none,
        },
        energy: Energy::default(),
        factors: vec![0.0; program.actions.len()],
        set_aside: system.loose_grains(),
        residual: 0.0,
    }
}

/// Freedoms that are held or moved.
pub fn bound(program: &Program) -> Vec<(BodyId, Freedom)> {
    let held = program.held.iter().map(|held| (held.body, held.freedom));
    held.chain(program.prescribed.iter().map(|p| (p.body, p.freedom)))
        .collect()
}

/// Events of grains that are set aside from the start.
pub fn first_events(point: &Point) -> Vec<Event> {
    let aside = point.set_aside.iter().filter(|(_, aside)| **aside);
    aside
        .map(|(grain, _)| Event {
            iteration: 0,
            load_factor: 0.0,
            kind: EventKind::SetAside(grain),
            avalanche: None,
            drive: None,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_iteration_that_came_nearest_to_its_limit_is_told() {
        let mut longest = Longest::default();
        assert_eq!(near_limit(longest), None);
        for (iterations, limit) in [(330, 400), (500, 1000), (9, 400)] {
            longest.note(iterations, limit);
        }
        let told = Warning::ManyIterations {
            iterations: 330,
            limit: 400,
        };
        assert_eq!(near_limit(longest), Some(told));
    }
}
