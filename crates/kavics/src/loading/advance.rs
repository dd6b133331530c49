//! From one equilibrium to the next along the load path, bonds breaking on the way.

use rayon::prelude::*;

use super::ledger::{self, Forces};
use super::{Breakage, Program};
use crate::contact_law::{Mode, Phase};
use crate::equilibrium::bond::Bond;
use crate::equilibrium::configuration::{Action, Configuration, Failure, Progress};
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
}

/// A bond that breaks.
struct Break {
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
    let mut here = equilibrium(
        system,
        point,
        point.configuration.clone(),
        &action,
        load_factor,
        way,
    )?;
    loop {
        let broken = over_limit(&here, system.settings.tie_tolerance, breakage);
        if broken.is_empty() {
            break;
        }
        here = break_bonds(system, &here, &broken, &action, load_factor, way)?;
    }
    here.factors = factors.to_vec();
    check(system, &here, way)?;
    Ok(here)
}

/// The equilibrium under `action`, reached from `configuration`; `before` is the last one.
fn equilibrium(
    system: &mut System<'_>,
    before: &Point,
    mut configuration: Configuration,
    action: &Action,
    load_factor: f64,
    way: &mut Way,
) -> Result<Point, Failure> {
    system.equilibrate(&mut configuration, action, &mut way.progress)?;
    let imbalance = system.imbalance(&configuration, &action.loads);
    system.largest_force = system.largest_force.max(imbalance.force);
    let forces = Forces {
        loads: action.loads.clone(),
        reactions: reactions(system, &imbalance.unbalanced),
    };
    let mut energy = before.energy;
    ledger::add_way(
        &mut energy,
        (&before.configuration, &before.forces),
        (&configuration, &forces),
        system.properties,
    );
    let set_aside = system.loose_grains();
    let iteration = way.progress.iterations;
    let happened = phase_events(&before.configuration, &configuration)
        .chain(set_aside_events(&before.set_aside, &set_aside))
        .map(|kind| Event {
            iteration,
            load_factor,
            kind,
        });
    way.events.extend(happened);
    for bond in configuration.bonds.values_mut() {
        bond.remember(system.properties);
    }
    let factors = before.factors.clone();
    Ok(Point {
        configuration,
        forces,
        energy,
        factors,
        set_aside,
        residual: way.progress.residual,
    })
}

/// What bound freedoms need so that nothing stays unbalanced.
fn reactions(system: &System<'_>, unbalanced: &PerBody<Load>) -> PerBody<Load> {
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

fn set_aside_events<'a>(
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
fn over_limit(point: &Point, tie_tolerance: f64, breakage: Breakage) -> Vec<Break> {
    let utilisation = |bond: &Bond| bond.limits.utilisation(bond.force);
    let bonds = &point.configuration.bonds;
    let worst = bonds
        .values()
        .iter()
        .map(|bond| utilisation(bond).0)
        .fold(0.0, f64::max);
    if worst <= 1.0 {
        return Vec::new();
    }
    let ties = tie_tolerance.max(10.0 * point.residual);
    let bound = match breakage {
        Breakage::WorstFirst => worst * (1.0 - ties),
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

/// Breaks bonds and finds the next equilibrium under the same action.
fn break_bonds(
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
    for Break { contact, mode } in broken {
        let bond = &mut bonds[*contact];
        let held = bond.energy(system.properties);
        bond.break_into_successor(
            &system.assembly.contacts[*contact],
            system.properties,
            system.assembly.thickness,
        );
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
        });
    }
    let mut next = equilibrium(
        system,
        &start,
        start.configuration.clone(),
        action,
        load_factor,
        way,
    )?;
    for (Break { contact, .. }, event) in broken.iter().zip(&mut way.events[first_event..]) {
        let bonds = [
            &point.configuration,
            &start.configuration,
            &next.configuration,
        ]
        .map(|c| &c.bonds[*contact]);
        let released = ledger::release_energy(bonds[0], bonds[1], bonds[2]);
        next.energy.release_energy += released;
        if let EventKind::Broke { release_energy, .. } = &mut event.kind {
            *release_energy = released;
        }
    }
    Ok(next)
}

/// Refuses an equilibrium with a contact whose shear stiffness is lost; warns of what makes it less than it seems.
fn check(system: &System<'_>, point: &Point, way: &mut Way) -> Result<(), Failure> {
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
    ];
    way.warnings = warnings
        .into_iter()
        .filter(|(count, _)| *count > 0)
        .map(|(_, warning)| warning)
        .collect();
    let direct = system.breakdown;
    way.warnings
        .extend(direct.map(|breakdown| Warning::SolvedDirectly { breakdown }));
    Ok(())
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
        })
        .collect()
}
