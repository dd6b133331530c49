//! Event-driven breakage: closed forms, and the same order as worst-first.

use std::path::Path;

use kavics::equilibrium::{Equilibrium, Event, EventKind, SolveError};
use kavics::ids::{BodyId, ContactId, GrainId};
use kavics::scene::Scene;

fn scene(text: &str) -> Scene {
    let lists = |_: &Path, _: Option<usize>| Err("no grain lists here".to_owned());
    Scene::parse(text, "events.toml", Path::new("."), &lists).expect("a scene")
}

/// The equilibria, and why there are not more.
fn run(text: &str) -> (Vec<Equilibrium>, Option<SolveError>) {
    let scene = scene(text);
    let mut found = Vec::new();
    for equilibrium in scene.load_path() {
        match equilibrium {
            Ok(equilibrium) => found.push(equilibrium),
            Err(error) => return (found, Some(error)),
        }
    }
    (found, None)
}

fn breaks(path: &[Equilibrium]) -> Vec<Event> {
    let events = path.iter().flat_map(|e| &e.events);
    events
        .filter(|e| matches!(e.kind, EventKind::Broke { .. }))
        .copied()
        .collect()
}

fn contacts(path: &[Equilibrium]) -> Vec<ContactId> {
    let contact = |event: &Event| match event.kind {
        EventKind::Broke { contact, .. } => Some(contact),
        _ => None,
    };
    breaks(path).iter().filter_map(contact).collect()
}

fn energies(event: &Event) -> [f64; 2] {
    match event.kind {
        EventKind::Broke {
            fracture_energy,
            release_energy,
            ..
        } => [fracture_energy, release_energy],
        _ => [f64::NAN; 2],
    }
}

fn assert_close(found: f64, expected: f64, relative: f64) {
    assert!(
        (found - expected).abs() <= relative * expected.abs(),
        "found {found}, expected {expected}"
    );
}

fn assert_ledger_closes(path: &[Equilibrium]) {
    for equilibrium in path {
        let energy = equilibrium.energy;
        assert!(
            energy.ledger_error().abs() <= 1e-9 * energy.external_work.abs(),
            "step {}: {:e} of {:e}",
            equilibrium.step,
            energy.ledger_error(),
            energy.external_work
        );
    }
}

fn with(text: &str, breakage: &str, factors: &str) -> String {
    text.replace("BREAKAGE", breakage)
        .replace("FACTORS", factors)
}

/// Three equal discs, the lower contact weak in tension, the others in shear.
const THREE_DISCS: &str = r#"
[box]
width = 4.0
height = "fit"
[grains.hexagonal]
radius = 1.0
rows = [2, 1]
[contact.weak.cemented]
stiffness.layer = { normal = 1.0, shear = 0.4 }
dual_length = 1.2
strength.force = { tension = 0.05 }
[contact.firm.cemented]
stiffness.layer = { normal = 1.0, shear = 0.4 }
dual_length = 1.2
strength.force = { shear = SHEAR }
[[zone]]
contact = "firm"
[[zone]]
contact = "weak"
strip = { y = [0.0, 1.5] }
[[support]]
grains = { ids = [0] }
fix = ["x", "y"]
[[support]]
grains = { ids = [1] }
fix = ["y"]
[[load]]
name = "press"
grains = { ids = [2] }
force = { y = -1.0 }
[[stage]]
factors = FACTORS
[equilibrium]
breakage = "event-driven"
"#;

#[test]
fn three_discs_break_at_their_closed_form_and_snap_back_to_the_second() {
    let (kn, kt, km) = (1.2_f64, 0.48, 0.144);
    let d = kn * kt + 3.0 * km * kn + 3.0 * km * kt;
    let tension = 3.0_f64.sqrt() * (kn * kt + 3.0 * km * kn - 3.0 * km * kt) / (6.0 * d);
    let first = 0.05 / tension;
    // Before the break the inclined contacts carry 3·P·k_m·k_t/(2·D) of shear, after it P/4.
    let second = 0.5 * first;
    let shear = second / 4.0;
    assert!(first * 1.5 * km * kt / d < shear);
    let text = THREE_DISCS.replace("SHEAR", &shear.to_string());
    let (path, error) = run(&text.replace("FACTORS", "[0.1, 1.0]"));
    let events = breaks(&path);
    assert_eq!(contacts(&path), [ContactId(0)]);
    assert_close(events[0].load_factor, first, 1e-12);
    let drive = events[0].drive.expect("a load drives the path");
    let pressed = -path[1].state.displacements.values()[2].y;
    assert_close(drive.displacement, pressed * first / 0.1, 1e-9);
    assert_close(drive.force, first, 1e-12);
    let last = path.last().expect("an equilibrium");
    assert!(!last.complete);
    assert_close(last.load_factor, second, 1e-12);
    let error = error.expect("a mechanism");
    assert!(
        matches!(error, SolveError::Mechanism { step: 2, ref grains, .. } if grains.contains(&GrainId(2))),
        "{error}"
    );
    assert_ledger_closes(&path);
}

#[test]
fn after_the_last_event_the_factor_goes_on_to_its_target() {
    let text = THREE_DISCS.replace("SHEAR", "9.0");
    let (path, error) = run(&text.replace("FACTORS", "[0.1, 1.0, 0.0, 1.0]"));
    assert!(error.is_none());
    let (kn, kt, km) = (1.2, 0.48, 0.144);
    let after = -(kn * kt + km * kn + 3.0 * km * kt) / (8.0 * km * kn * kt);
    for step in [2, 4] {
        let u = path[step].state.displacements.values()[2];
        assert_close(u.y, after, 1e-9);
    }
    let unloaded = path[3].state.displacements.values();
    assert!(unloaded.iter().all(|u| u.x == 0.0 && u.y == 0.0));
    assert_ledger_closes(&path);
}

/// A row of discs held at its left end, loaded across at its right one.
const CANTILEVER: &str = r#"
[box]
width = 10.0
height = "fit"
[grains.hexagonal]
radius = 1.0
rows = [5]
[contact.mortar.cemented]
stiffness.direct = { normal = 100.0, shear = 50.0, moment = 20.0 }
strength.force = { bending = 0.35 }
[[support]]
grains = { ids = [0] }
fix = ["x", "y", "rotation"]
[[load]]
name = "tip"
grains = { ids = [4] }
force = { y = -1.0 }
[[stage]]
factors = [0.01, 1.0]
[equilibrium]
breakage = "event-driven"
"#;

#[test]
fn a_cantilever_fails_at_its_root() {
    let (path, error) = run(CANTILEVER);
    let last = path.last().expect("an equilibrium");
    // M = P·a at the root, a = 7 from the first contact to the last centre.
    assert_close(last.load_factor, 0.35 / 7.0, 1e-12);
    let error = error.expect("a mechanism");
    assert!(
        matches!(error, SolveError::Mechanism { step: 2, .. }),
        "{error}"
    );
    // It is recognised before the bond breaks: the last equilibrium still has it.
    assert!(last.state.contacts.values().iter().all(|c| !c.broken));
    assert!(contacts(&path).is_empty());
}

/// A disc between two held ones, pulled to the right; the left bond breaks at tension 1.
const BETWEEN: &str = r#"
[box]
width = 6.0
height = "fit"
[grains.hexagonal]
radius = 1.0
rows = [3]
[contact.weak.cemented]
stiffness.direct = { normal = 100.0, shear = 50.0, moment = 20.0 }
strength.force = { tension = 1.0 }
[contact.firm.cemented]
stiffness.direct = { normal = 100.0, shear = 50.0, moment = 20.0 }
[[zone]]
contact = "firm"
[[zone]]
contact = "weak"
strip = { x = [1.5, 2.5] }
[[support]]
grains = { ids = [0, 2] }
fix = ["x", "y", "rotation"]
[[load]]
name = "constant"
grains = { ids = [1] }
force = { x = 1.0 }
[[load]]
name = "growing"
grains = { ids = [1] }
force = { x = 1.0 }
"#;

#[test]
fn a_proportional_load_falls_with_the_break_and_nothing_is_set_free() {
    let text = format!(
        "{BETWEEN}\n[[stage]]\napply = [\"growing\"]\nfactors = [3.0]\n[equilibrium]\nbreakage = \"event-driven\"\n"
    );
    let (path, error) = run(&text);
    assert!(error.is_none());
    let event = breaks(&path)[0];
    assert_close(event.load_factor, 2.0, 1e-12);
    assert_close(energies(&event)[0], 0.5 / 100.0, 1e-12);
    assert_eq!(energies(&event)[1], 0.0);
    assert_ledger_closes(&path);
}

#[test]
fn a_load_that_stays_constant_sets_energy_free() {
    let text = format!(
        "{BETWEEN}\n[[stage]]\napply = [\"constant\"]\nfactors = [0.5]\n[[stage]]\napply = [\"growing\"]\nfactors = [3.0]\n[equilibrium]\nbreakage = \"event-driven\"\n"
    );
    let (path, error) = run(&text);
    assert!(error.is_none());
    let event = breaks(&path)[0];
    assert_close(event.load_factor, 1.5, 1e-12);
    // At the constant load 2 the disc goes from 1/k to 2/k: work 2/k, ½/k of it for the bond, 1/k kept.
    assert_close(energies(&event)[0], 0.5 / 100.0, 1e-12);
    assert_close(energies(&event)[1], 0.5 / 100.0, 1e-10);
    assert_ledger_closes(&path);
}

/// A block of scattered strengths, its lowest row held, its highest moved or loaded.
const BLOCK: &str = r#"
[box]
width = 24.0
height = "fit"
[grains.hexagonal]
radius = 1.0
rows = { count = 9, longest = 12 }
[contact.mortar.cemented]
stiffness.layer = { normal = 1.0, shear = 0.4 }
strength.stress = { tension = 0.01, shear = 0.02, bending = 0.02 }
strength.scatter.weibull = { shape = 3.0 }
[[support]]
grains = { edge = "bottom" }
fix = ["x", "y"]
[weight]
density = 1e-4
ACTION
[equilibrium]
breakage = "BREAKAGE"
"#;

const MOVED: &str = r#"
[[move]]
name = "pull"
grains = { edge = "top" }
y = 1.0
x = 0.3
[[stage]]
apply = ["pull"]
factors = FACTORS
"#;

const LOADED: &str = r#"
[[load]]
name = "pull"
edge = "top"
normal = [0.02, 0.01]
[[stage]]
apply = ["pull"]
factors = FACTORS
"#;

const WEIGHED: &str = r#"
[[move]]
name = "pull"
grains = { edge = "top" }
y = 1.0
[[stage]]
apply = ["weight"]
factors = [1.0]
[[stage]]
apply = ["pull"]
factors = FACTORS
"#;

fn assert_same_state(one: &Equilibrium, other: &Equilibrium) {
    let pairs = one.state.displacements.values().iter();
    let largest = pairs.clone().map(|u| u.x.hypot(u.y)).fold(0.0, f64::max);
    for (a, b) in pairs.zip(other.state.displacements.values()) {
        assert!(
            (a.x - b.x).hypot(a.y - b.y) <= 1e-8 * largest,
            "{a:?} {b:?}"
        );
    }
}

#[test]
fn prescribed_motion_breaks_the_same_bonds_in_the_same_order_as_worst_first() {
    let text = BLOCK.replace("ACTION", MOVED);
    let steps = "{ to = 0.2, steps = 5 }";
    let (events, error) = run(&with(&text, "event-driven", steps));
    assert!(error.is_none());
    let (coarse, _) = run(&with(&text, "worst-first", steps));
    let (fine, _) = run(&with(&text, "worst-first", "{ to = 0.2, steps = 500 }"));
    assert!(contacts(&events).len() > 20, "{}", contacts(&events).len());
    assert_eq!(contacts(&events), contacts(&coarse));
    assert_eq!(contacts(&events), contacts(&fine));
    for step in 0..=5 {
        assert_same_state(&events[step], &coarse[step]);
        assert_same_state(&events[step], &fine[100 * step]);
    }
    assert_ledger_closes(&events);
}

#[test]
fn a_load_breaks_the_same_bonds_in_the_same_order_as_worst_first() {
    let text = BLOCK.replace("ACTION", LOADED);
    let steps = "{ to = 1.0, steps = 5 }";
    let (events, error) = run(&with(&text, "event-driven", steps));
    assert!(
        matches!(error, Some(SolveError::Mechanism { .. })),
        "{error:?}"
    );
    let (coarse, _) = run(&with(&text, "worst-first", steps));
    let (fine, _) = run(&with(&text, "worst-first", "{ to = 1.0, steps = 500 }"));
    let order = contacts(&events);
    assert!(contacts(&fine).len() > 3, "{}", contacts(&fine).len());
    assert_eq!(order[..contacts(&coarse).len()], contacts(&coarse));
    assert_eq!(order[..contacts(&fine).len()], contacts(&fine));
    // Worst-first knows the load that the block bears to a share of 1e-4 of it.
    let peak = breaks(&events)
        .iter()
        .map(|e| e.load_factor)
        .fold(0.0, f64::max);
    let borne = fine.last().expect("an equilibrium").load_factor;
    assert_close(borne, peak, 2e-4);
    assert_ledger_closes(&events);
}

#[test]
fn avalanches_lie_between_two_new_maxima_of_the_factor() {
    for action in [MOVED, LOADED] {
        let text = with(
            &BLOCK.replace("ACTION", action),
            "event-driven",
            "[0.2, 1.0]",
        );
        let (path, _) = run(&text);
        let (mut highest, mut avalanche) = (0.0, None);
        let mut reached = path.iter().map(|e| (e.step, e.load_factor));
        let mut step = reached.next();
        for equilibrium in &path {
            for event in &equilibrium.events {
                if event.load_factor > highest {
                    avalanche = avalanche.map_or(Some(0), |number: usize| Some(number + 1));
                    highest = event.load_factor;
                }
                assert_eq!(event.avalanche, avalanche);
            }
            highest = highest.max(step.map_or(0.0, |step| step.1));
            step = reached.next();
        }
        assert!(avalanche.is_some_and(|number| number > 1));
    }
}

#[test]
fn with_constant_weight_every_equilibrium_is_admissible_and_the_ledger_closes() {
    let text = BLOCK.replace("ACTION", WEIGHED);
    let (path, error) = run(&with(&text, "event-driven", "{ to = 0.2, steps = 20 }"));
    let factors: Vec<f64> = breaks(&path).iter().map(|e| e.load_factor).collect();
    assert!(factors.len() > 20, "{factors:?} {error:?}");
    assert_ledger_closes(&path);
    let released: f64 = breaks(&path).iter().map(|e| energies(e)[1]).sum();
    assert!(released > 0.0);
    assert!(breaks(&path).iter().all(|e| energies(e)[1] > -1e-15));
}

#[test]
fn the_ledger_closes_after_every_event() {
    for action in [MOVED, LOADED, WEIGHED] {
        let text = BLOCK.replace("ACTION", action);
        let text = format!(
            "{}\n[measure]\nevery = \"iteration\"\n",
            with(&text, "event-driven", "{ to = 0.2, steps = 4 }")
        );
        let (path, _) = run(&text);
        let ledgers = path.iter().flat_map(|e| &e.iterates);
        let ledgers: Vec<_> = ledgers.filter_map(|iterate| iterate.ledger).collect();
        assert!(ledgers.len() >= 5, "{}", ledgers.len());
        for (load_factor, energy) in ledgers {
            assert!(
                energy.ledger_error().abs() <= 1e-9 * energy.external_work.abs(),
                "at {load_factor}: {:e} of {:e}",
                energy.ledger_error(),
                energy.external_work
            );
        }
    }
}

/// A column of four discs, its middle bond strong, the others of equal strength.
const COLUMN: &str = r#"
[box]
width = 2.0
height = 8.0
[grains.square]
radius = 1.0
rows = [1, 1, 1, 1]
[contact.strong.cemented]
stiffness.direct = { normal = 1.0, shear = 0.5, moment = 0.3 }
[contact.weak.cemented]
stiffness.direct = { normal = 1.0, shear = 0.5, moment = 0.3 }
strength.force = { tension = 0.1 }
[[zone]]
contact = "weak"
[[zone]]
contact = "strong"
strip = { y = [3.5, 4.5] }
[[support]]
grains = { ids = [0] }
fix = ["x", "y", "rotation"]
[[move]]
name = "pull"
grains = { ids = [3] }
y = 1.0
[[stage]]
factors = { to = 1.0, steps = 4 }
[equilibrium]
breakage = "BREAKAGE"
"#;

#[test]
fn a_piece_that_comes_loose_by_ties_carries_nothing_and_sets_its_energy_free() {
    for breakage in ["event-driven", "worst-first", "simultaneous"] {
        let (path, error) = run(&COLUMN.replace("BREAKAGE", breakage));
        assert!(error.is_none(), "{error:?}");
        let last = path.last().expect("an equilibrium");
        assert_eq!(contacts(&path), [ContactId(0), ContactId(2)]);
        assert!(last.set_aside[GrainId(1)] && last.set_aside[GrainId(2)]);
        let middle = last.state.contacts[ContactId(1)].force;
        assert!(middle.normal.abs() + middle.shear.abs() + middle.moment.abs() < 1e-15);
        assert!(last.energy.elastic_energy < 1e-15, "{:?}", last.energy);
        assert_ledger_closes(&path);
        // The piece moved with what it hung between.
        let u = last.state.displacements[BodyId(1)].y;
        assert!(u > 0.05, "{u}");
    }
}

/// Equal strengths, symmetric loads: bonds break in pairs and rows.
const SYMMETRIC: &str = r#"
[box]
width = 10.0
height = "fit"
[grains.hexagonal]
radius = 1.0
rows = [5, 4, 5, 4, 5, 4, 5]
[contact.mortar.cemented]
stiffness.layer = { normal = 1.0, shear = 0.5 }
strength.stress = { tension = 0.012, shear = 0.05, bending = 0.05 }
[[support]]
grains = { edge = "bottom" }
fix = ["x", "y"]
[[move]]
name = "pull"
grains = { edge = "top" }
y = 1.0
[[stage]]
factors = FACTORS
[equilibrium]
breakage = "BREAKAGE"
"#;

#[test]
fn ties_break_together() {
    let (events, error) = run(&with(SYMMETRIC, "event-driven", "{ to = 0.5, steps = 5 }"));
    assert!(error.is_none(), "{error:?}");
    let (fine, _) = run(&with(SYMMETRIC, "worst-first", "{ to = 0.5, steps = 500 }"));
    assert_eq!(contacts(&events), contacts(&fine));
    let events = breaks(&events);
    assert!(events.len() > 3);
    let tied = |pair: &&[Event]| pair[0].load_factor == pair[1].load_factor;
    assert!(2 * events.windows(2).filter(tied).count() >= events.len() - 1);
}

#[test]
fn a_separated_specimen_carries_nothing() {
    let (path, error) = run(&with(SYMMETRIC, "event-driven", "{ to = 0.5, steps = 5 }"));
    assert!(error.is_none());
    let last = path.last().expect("an equilibrium");
    let forces = last.state.contacts.values().iter();
    let largest = forces
        .map(|c| c.force.normal.hypot(c.force.shear))
        .fold(0.0, f64::max);
    assert!(largest < 1e-12, "{largest:e}");
    assert_ledger_closes(&path);
}

/// Cement whose shear modulus depends on the state.
fn hardened(text: &str, factor: &str, reading: &str) -> String {
    let law = "stiffness.layer = { normal = 1.0, shear = 0.4 }";
    let hardened = format!("{law}\nshear_hardening = {factor}\nreading = \"{reading}\"");
    assert!(text.contains(law));
    text.replace(law, &hardened)
}

/// A block small enough for many equilibria an event.
fn small_block(action: &str) -> String {
    let rows = "rows = { count = 9, longest = 12 }";
    BLOCK
        .replace(rows, "rows = { count = 5, longest = 6 }")
        .replace("ACTION", action)
}

#[test]
fn a_state_that_hardly_matters_gives_the_events_of_constant_stiffness() {
    for (action, factors) in [(MOVED, "[0.1, 0.2]"), (WEIGHED, "[0.1, 0.2]")] {
        let text = with(&small_block(action), "event-driven", factors);
        let (linear, error) = run(&text);
        let (rooted, other_error) = run(&hardened(&text, "1e-13", "printed"));
        assert_eq!(error.is_some(), other_error.is_some());
        assert!(contacts(&linear).len() > 5);
        assert_eq!(contacts(&linear), contacts(&rooted));
        for (one, other) in breaks(&linear).iter().zip(breaks(&rooted)) {
            assert_close(other.load_factor, one.load_factor, 1e-8);
            assert_eq!(one.avalanche, other.avalanche);
        }
    }
}

#[test]
fn with_shear_that_hardens_events_come_in_the_order_of_fine_load_steps() {
    let text = small_block(MOVED);
    for reading in ["printed", "potential", "history"] {
        let text = hardened(&text, "0.75", reading);
        let (events, error) = run(&with(&text, "event-driven", "[0.1, 0.2]"));
        assert!(error.is_none(), "{error:?}");
        let (fine, _) = run(&with(&text, "worst-first", "{ to = 0.2, steps = 400 }"));
        assert!(contacts(&events).len() > 5);
        assert_eq!(contacts(&events), contacts(&fine), "{reading}");
        // A worst-first event comes at the end of the load step in which event-driven has its first of the avalanche.
        let first = breaks(&events)[0].load_factor;
        let coarse = breaks(&fine)[0].load_factor;
        assert!(first <= coarse && coarse - first <= 0.2 / 400.0 + 1e-12);
    }
}

#[test]
fn a_cohesionless_successor_goes_through_to_the_end() {
    let grit = r#"
after_breakage = "grit"
[contact.grit.cohesionless]
stiffness.layer = { normal = 1.0, shear = 0.5 }
friction = 0.5
[[zone]]
contact = "mortar"
[[support]]"#;
    let text = small_block(MOVED).replacen("[[support]]", grit, 1);
    let (path, error) = run(&with(&text, "event-driven", "[0.1, 0.2]"));
    assert!(error.is_none(), "{error:?}");
    assert!(contacts(&path).len() > 5);
    let last = path.last().expect("an equilibrium");
    assert!(last.residual <= 1e-10);
}

#[test]
fn a_cemented_successor_is_a_change_of_stiffness() {
    let stub = r#"
after_breakage = "stub"
[contact.stub.cemented]
stiffness.layer = { normal = 0.2, shear = 0.1 }
[[zone]]
contact = "mortar"
[[support]]"#;
    let text = small_block(MOVED).replacen("[[support]]", stub, 1);
    let (events, error) = run(&with(&text, "event-driven", "[0.1, 0.2]"));
    assert!(error.is_none(), "{error:?}");
    assert!(contacts(&events).len() > 5);
    assert_ledger_closes(&events);
}

/// The same state from a fresh factorisation: the broken contacts are no contacts at all.
#[test]
fn after_a_thousand_events_the_state_is_that_of_a_fresh_factorisation() {
    let text = BLOCK
        .replace("width = 24.0", "width = 90.0")
        .replace(
            "{ count = 9, longest = 12 }",
            "{ count = 45, longest = 45 }",
        )
        .replace("shape = 3.0", "shape = 1.0")
        .replace("ACTION", MOVED);
    let text = with(&text, "event-driven", "[FACTOR]");
    let mut last = None;
    let mut events = 0;
    for factor in ["0.3", "0.6", "1.0"] {
        let (path, error) = run(&text.replace("FACTOR", factor));
        assert!(error.is_none());
        events = contacts(&path).len();
        last = path.into_iter().last();
        if events >= 1000 {
            break;
        }
    }
    assert!(events >= 1000, "{events}");
    let last = last.expect("an equilibrium");
    assert!(last.residual <= 1e-10);
    let mut fresh = scene(&text.replace("FACTOR", &last.load_factor.to_string()));
    let kept = fresh.assembly.contacts.iter();
    let kept = kept.filter(|(id, _)| !last.state.contacts[*id].broken);
    let mut kept: Vec<_> = kept.map(|(_, contact)| *contact).collect();
    for contact in &mut kept {
        contact.strength_factor = 1e9;
    }
    fresh.assembly.contacts = kept.into();
    let found = fresh
        .load_path()
        .last()
        .expect("a step")
        .expect("an equilibrium");
    let pairs = last.state.displacements.values().iter();
    let largest = pairs.clone().map(|u| u.x.hypot(u.y)).fold(0.0, f64::max);
    for (a, b) in pairs.zip(found.state.displacements.values()) {
        assert!(
            (a.x - b.x).hypot(a.y - b.y) <= 1e-9 * largest,
            "{a:?} {b:?}"
        );
    }
}
