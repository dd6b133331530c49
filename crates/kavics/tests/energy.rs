//! Where the work goes: the ledger of energy closes.

use std::path::Path;

use kavics::equilibrium::{Equilibrium, EventKind, Warning};
use kavics::scene::Scene;
use proptest::prelude::*;

fn run(text: &str) -> Vec<Equilibrium> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes_right");
    let scene = Scene::parse(text, "scene.toml", &folder, &|_, _| {
        Err("no reader for this file".to_owned())
    })
    .unwrap_or_else(|error| panic!("{error}"));
    scene
        .load_path()
        .take_while(Result::is_ok)
        .filter_map(Result::ok)
        .collect()
}

/// The 32 discs of Bojtár & Bagi (1989), each of the upper row pressed down by a fifth of the load factor.
fn block(contact: &str, factors: &str, more: &str) -> Vec<Equilibrium> {
    run(&format!(
        r#"
[box]
width = 10.0
height = "fit"
[grains.hexagonal]
radius = 1.0
rows = [5, 4, 5, 4, 5, 4, 5]
[contact.mortar.cemented]
stiffness.layer = {{ normal = 1.0, shear = 0.55 }}
{contact}
[[support]]
grains = {{ edge = "bottom" }}
fix = ["y"]
[[support]]
grains = {{ ids = [2] }}
fix = ["x"]
[[load]]
name = "press"
edge = "top"
normal = [-0.1, -0.1]
[[stage]]
factors = {factors}
[equilibrium]
{more}
"#
    ))
}

/// A heap of grains with friction between sides, under its weight, then pressed by one of them.
fn heap(friction: &str, factors: &str, more: &str) -> Vec<Equilibrium> {
    run(&format!(
        r#"
[box]
width = 20.0
height = "fit"
[grains.hexagonal]
radius = 1.0
rows = [10, 9, 10, 9, 10]
[contact.sand.cohesionless]
stiffness.direct = {{ normal = 1000.0, shear = 100.0 }}
{friction}
[side.left]
contact = "sand"
[side.right]
contact = "sand"
[side.bottom]
contact = "sand"
[weight]
density = 1.0
gravity = 1.0
[[move]]
name = "press"
side = "right"
x = -0.1
[[stage]]
apply = ["weight"]
factors = [1.0]
[[stage]]
apply = ["press"]
factors = {factors}
[equilibrium]
{more}
"#
    ))
}

/// Two discs, the second moved over the first: pressed on it, then along it.
fn pair(contact: &str, moves: &str, stages: &str) -> Vec<Equilibrium> {
    run(&format!(
        r#"
[box]
width = 4.0
height = "fit"
[grains.hexagonal]
radius = 1.0
rows = [2]
[contact.grit.cohesionless]
stiffness.direct = {{ normal = 2.0, shear = 1.5 }}
{contact}
[[support]]
grains = {{ ids = [0] }}
fix = ["x", "y", "rotation"]
[[support]]
grains = {{ ids = [1] }}
fix = ["rotation"]
{moves}
{stages}
"#
    ))
}

/// Largest ledger error of any load step over the work done so far, signs of the load steps apart.
fn ledger_error(path: &[Equilibrium]) -> f64 {
    let mut done = 0.0;
    let errors = path.windows(2).map(|pair| {
        done += (pair[1].energy.external_work - pair[0].energy.external_work).abs();
        pair[1].energy.ledger_error().abs() / done
    });
    errors.fold(0.0, f64::max)
}

const READINGS: [&str; 3] = ["printed", "potential", "history"];

fn hardening(reading: &str) -> String {
    format!("shear_hardening = 0.75\nreading = \"{reading}\"")
}

fn precise(work_tolerance: f64) -> String {
    format!("tolerance = 1e-12\nwork_tolerance = {work_tolerance:e}")
}

#[test]
fn the_ledger_closes_to_every_tolerance_in_every_reading() {
    for reading in READINGS {
        let contact = format!(
            "{}\nstrength.force = {{ tension = 0.05 }}",
            hardening(reading)
        );
        for tolerance in [1e-3, 1e-5, 1e-7, 1e-9] {
            let path = block(&contact, "[1.0, 0.2, 1.4, 1.6, 1.8]", &precise(tolerance));
            let broken = path.iter().flat_map(|e| &e.events).count();
            let error = ledger_error(&path);
            assert!(path.len() == 6 && broken >= 9, "{reading}: {broken} events");
            assert!(error < tolerance, "{reading} {tolerance}: {error}");
            // Stiffness is 1, so that the loads go far; the ledger closes all the same.
            let mut warnings = path.iter().flat_map(|e| &e.warnings);
            assert!(warnings.all(|w| matches!(w, Warning::LargeDisplacements(_))));
        }
    }
}

/// The trapezoid is of second order in the load step.
#[test]
fn by_straight_lines_half_the_load_step_leaves_a_quarter_of_the_error() {
    for reading in ["printed", "potential"] {
        let error = |steps: usize| {
            let factors = format!("{{ to = 1.0, steps = {steps} }}");
            let path = block(&hardening(reading), &factors, &precise(1.0));
            assert!(path.iter().all(|e| e.work_iterations == 0));
            path[steps].energy.ledger_error()
        };
        for ratio in [error(2) / error(4), error(4) / error(8)] {
            assert!((ratio - 4.0).abs() < 0.4, "{reading}: {ratio}");
        }
    }
}

#[test]
fn the_work_of_a_potential_does_not_depend_on_the_path() {
    let path = block(&hardening("potential"), "[0.7, 1.6, 0.0]", &precise(1e-8));
    let work = path[2].energy.external_work;
    assert!(path[3].energy.external_work.abs() < 1e-8 * 2.0 * work);
    assert!(path.iter().all(|e| e.energy.nonpotential_work == 0.0));
}

#[test]
fn the_history_reading_never_gives_work() {
    let path = block(
        &hardening("history"),
        "[0.5, 1.0, 1.6, 0.8, 0.0]",
        &precise(1e-8),
    );
    let lost = |e: &Equilibrium| e.energy.nonpotential_work;
    assert!(path.windows(2).all(|pair| lost(&pair[1]) > lost(&pair[0])));
}

#[test]
fn the_tolerance_of_work_changes_no_equilibrium() {
    let blocks = [1.0, 1e-9].map(|tolerance| {
        let contact = "shear_hardening = 0.75\nstrength.force = { tension = 0.05 }";
        block(contact, "[1.0, 1.8]", &precise(tolerance))
    });
    let heaps = ["1", "1e-6"].map(|tolerance| {
        heap(
            "friction = 0.5",
            "[0.2]",
            &format!("work_tolerance = {tolerance}"),
        )
    });
    for [coarse, fine] in [blocks, heaps] {
        for (coarse, fine) in coarse.iter().zip(&fine) {
            let displacements = [coarse, fine].map(|e| e.state.displacements.values());
            assert_eq!(displacements[0], displacements[1]);
            assert_eq!(coarse.iterations, fine.iterations);
        }
        assert!(fine.iter().any(|e| e.work_iterations > 0));
    }
}

#[test]
fn constant_stiffness_needs_no_equilibria_between_and_closes_at_every_breakage() {
    let path = block(
        "strength.force = { tension = 0.05 }",
        "[1.0, 0.2, 1.4, 1.6, 1.8]",
        "",
    );
    let broken = path
        .iter()
        .flat_map(|e| &e.events)
        .filter(|event| matches!(event.kind, EventKind::Broke { .. }));
    assert!(broken.count() >= 9);
    assert!(path.iter().all(|e| e.work_iterations == 0));
    assert!(ledger_error(&path) < 1e-9);
}

#[test]
fn a_heap_that_slides_opens_and_closes_closes_its_ledger() {
    for friction in [
        "friction = 0.5",
        "friction = 0.5\nshear_hardening = 0.02",
        "friction = 0.5\nshear_hardening = 0.02\nreading = \"history\"",
    ] {
        let path = heap(friction, "[0.2, 1.0, 0.5]", "");
        assert_eq!(path.len(), 5);
        let error = ledger_error(&path);
        assert!(error < 1e-6, "{friction}: {error}");
        let slid = |e: &Equilibrium| e.energy.friction_work;
        assert!(path.windows(2).all(|pair| slid(&pair[1]) >= slid(&pair[0])));
        assert!(path.iter().all(|e| e.warnings.is_empty()));
    }
}

/// A cycle of amplitude Δ under the normal force N takes 4·μ_f·N·(Δ − μ_f·N/k_t).
#[test]
fn a_cycle_of_sliding_takes_what_coulomb_says() {
    let path = pair(
        "friction = 0.5",
        "[[move]]\nname = \"press\"\ngrains = { ids = [1] }\nx = -0.1\n\
         [[move]]\nname = \"slide\"\ngrains = { ids = [1] }\ny = 0.2",
        "[[stage]]\napply = [\"press\"]\nfactors = [1.0]\n\
         [[stage]]\napply = [\"slide\"]\nfactors = { to = 1.0, steps = 1 }\n\
         [[stage]]\napply = [\"slide\"]\nfactors = [-1.0, 1.0]",
    );
    let (limit, stiffness, amplitude) = (0.5 * 0.2, 1.5, 0.2);
    let cycle = path[4].energy.friction_work - path[2].energy.friction_work;
    let expected = 4.0 * limit * (amplitude - limit / stiffness);
    assert!(
        (cycle - expected).abs() < 1e-7 * expected,
        "{cycle} {expected}"
    );
    assert!(ledger_error(&path) < 1e-6);
}

/// A contact without friction opens while it is sheared: its shear force jumps, and no straight way ends there.
#[test]
fn where_the_work_stays_unknown_a_warning_says_how_far() {
    let path = pair(
        "",
        "[[move]]\nname = \"press\"\ngrains = { ids = [1] }\nx = -0.1\n\
         [[move]]\nname = \"slide\"\ngrains = { ids = [1] }\ny = 0.2",
        "[[stage]]\napply = [\"press\"]\nfactors = [1.0]\n\
         [[stage]]\nfactors = [-0.37]",
    );
    assert!(path[1].warnings.is_empty());
    let [Warning::WorkError { relative }] = path[2].warnings[..] else {
        panic!("{:?}", path[2].warnings);
    };
    let error = path[2].energy.ledger_error().abs();
    assert!(relative > 1e-6 && relative < 1e-3, "{relative}");
    assert!(error <= 2.0 * relative * path[1].energy.external_work);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_ledger_closes_in_any_pack(
        seed in 0_u32..1000,
        grains in 5_u32..25,
        hardening in 0.0..0.4,
        reading in 0_usize..3,
        x in -0.3..0.3,
        y in -0.3..0.0,
        tension in 0.5_f64..20.0,
    ) {
        let reading = READINGS[reading];
        let path = run(&format!(r#"
seed = {seed}
[box]
width = 8.0
height = "fit"
[grains.dropped]
count = {grains}
radius = {{ from = 0.6, to = 1.2 }}
[contact.mortar.cemented]
stiffness.layer = {{ normal = 100.0, shear = 60.0 }}
shear_hardening = {hardening}
reading = "{reading}"
shear_floor = 0.1
strength.force = {{ tension = {tension}, shear = 12.0 }}
[side.left]
contact = "mortar"
[side.right]
contact = "mortar"
[side.bottom]
contact = "mortar"
[[move]]
name = "press"
side = "right"
x = {x}
y = {y}
[[stage]]
factors = [1.0, 0.4, 1.5]
"#));
        if path.iter().all(|e| e.warnings.iter().all(|w| !matches!(w, Warning::WorkError { .. }))) {
            prop_assert!(ledger_error(&path) < 1e-6, "{}", ledger_error(&path));
        }
        if hardening == 0.0 {
            prop_assert!(path.iter().all(|e| e.work_iterations == 0));
        }
    }
}
