//! Stages in which factors rest, turn, and start apart: whatever breaks bonds and steers, the loads are those of the factors.

use std::fmt::Write;
use std::path::Path;

use kavics::equilibrium::{Equilibrium, EventKind, Warning};
use kavics::loading::Program;
use kavics::scene::Scene;
use proptest::prelude::*;

/// A block on two held grains, loaded at three others in different directions.
fn scene(strength: f64, settings: &str, stages: &str) -> Scene {
    let text = format!(
        "[box]\nwidth = 10.0\nheight = \"fit\"\n[grains.hexagonal]\nradius = 1.0\nrows = [5, 4, 5]\n\
         [contact.mortar.cemented]\nstiffness.layer = {{ normal = 1.0, shear = 0.55 }}\n\
         strength.force = {{ shear = {strength:?} }}\n\
         [[support]]\ngrains = {{ edge = \"bottom\" }}\nfix = [\"x\", \"y\"]\n\
         [[load]]\nname = \"a\"\ngrains = {{ ids = [11] }}\nforce = {{ y = -0.01 }}\n\
         [[load]]\nname = \"b\"\ngrains = {{ ids = [13] }}\nforce = {{ x = 0.01 }}\n\
         [[load]]\nname = \"c\"\ngrains = {{ ids = [10] }}\nforce = {{ x = 0.004, y = 0.002 }}\n\
         {settings}{stages}"
    );
    let lists = |_: &Path, _: Option<usize>| Err("no grain lists here".to_owned());
    Scene::parse(&text, "stages.toml", Path::new("."), &lists)
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn follow(scene: &Scene) -> Vec<Equilibrium> {
    let path = scene.load_path();
    let path: Result<Vec<_>, _> = path.collect();
    path.unwrap_or_else(|error| panic!("{error}"))
}

/// The settings that are to agree as long as nothing breaks.
const SETTINGS: [&str; 6] = [
    "",
    "[equilibrium]\niteration = \"tangent\"\n",
    "[equilibrium]\nsolver = \"iterative\"\n",
    "[equilibrium]\nbreakage = \"event-driven\"\n",
    "[equilibrium]\nbreakage = \"simultaneous\"\n",
    "[equilibrium]\ncontrol = \"displacement\"\n",
];

fn assert_loads_are_those_of_the_factors(program: &Program, equilibrium: &Equilibrium) {
    let mut loads = equilibrium.loads.clone();
    for applied in &program.loads {
        loads[applied.body] += applied.load * -equilibrium.factors[applied.action];
    }
    for (body, load) in loads.iter() {
        let largest = load
            .components()
            .into_iter()
            .fold(0.0, |a, b| b.abs().max(a));
        assert!(
            largest < 1e-15,
            "step {}, {body:?}: {load:?}",
            equilibrium.step
        );
    }
}

fn assert_same(found: &Equilibrium, expected: &Equilibrium, settings: &str) {
    let step = expected.step;
    assert_eq!(found.step, step, "{settings}");
    for (found, expected) in found.factors.iter().zip(&expected.factors) {
        assert!((found - expected).abs() < 1e-12, "{settings}, step {step}");
    }
    let displacements = found.state.displacements.iter();
    for ((body, u), v) in displacements.zip(expected.state.displacements.values()) {
        for (u, v) in u.components().into_iter().zip(v.components()) {
            assert!(
                (u - v).abs() < 1e-11,
                "{settings}, step {step}, {body:?}: {u} for {v}"
            );
        }
    }
    let (found, expected) = (found.energy, expected.energy);
    let error = (found.elastic_energy - expected.elastic_energy).abs();
    assert!(error < 1e-13, "{settings}, step {step}");
    let error = (found.external_work - expected.external_work).abs();
    assert!(error < 1e-13, "{settings}, step {step}");
}

/// Some of the loads, and a few factors.
fn stage() -> impl Strategy<Value = (Vec<bool>, Vec<f64>)> {
    let factor = prop_oneof![Just(0.0), Just(1.0), -2.0..3.0];
    let some = prop::collection::vec(any::<bool>(), 3);
    let some = some.prop_filter("a stage applies something", |some| some.contains(&true));
    (some, prop::collection::vec(factor, 1..4))
}

fn written(stages: &[(Vec<bool>, Vec<f64>)]) -> String {
    let mut text = String::new();
    for (some, factors) in stages {
        let names = ["a", "b", "c"].into_iter().zip(some);
        let names: Vec<&str> = names.filter(|(_, on)| **on).map(|(name, _)| name).collect();
        let _ = write!(
            text,
            "[[stage]]\napply = {names:?}\nfactors = {factors:?}\n"
        );
    }
    text
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn as_long_as_nothing_breaks_all_settings_agree(
        stages in prop::collection::vec(stage(), 1..4),
    ) {
        let stages = written(&stages);
        let expected = follow(&scene(1e3, SETTINGS[0], &stages));
        for settings in SETTINGS {
            let scene = scene(1e3, settings, &stages);
            let found = follow(&scene);
            prop_assert_eq!(found.len(), expected.len());
            for (found, expected) in found.iter().zip(&expected) {
                assert_same(found, expected, settings);
                assert_loads_are_those_of_the_factors(&scene.program, found);
                let is_open = |warning: &Warning| matches!(warning, Warning::WorkError { .. });
                prop_assert!(!found.warnings.iter().any(is_open), "{}", settings);
            }
        }
    }
}

fn broken(path: &[Equilibrium]) -> Vec<EventKind> {
    let events = path.iter().flat_map(|equilibrium| &equilibrium.events);
    let kinds = events.map(|event| event.kind);
    kinds
        .filter(|kind| matches!(kind, EventKind::Broke { .. }))
        .collect()
}

/// Factors at rest before anything acts, and repeated ones, are no events.
#[test]
fn factors_that_rest_at_zero_change_nothing() {
    for settings in ["", "[equilibrium]\nbreakage = \"event-driven\"\n"] {
        let run = |factors: &str| {
            let stages = format!("[[stage]]\napply = [\"a\"]\nfactors = {factors}\n");
            follow(&scene(1e-3, settings, &stages))
        };
        let expected = run("[1.0]");
        let broke = broken(&expected);
        assert!(!broke.is_empty());
        for factors in ["[0.0, 1.0]", "[0.0, 0.0, 1.0]", "[0.0, 0.25, 1.0, 1.0]"] {
            let found = run(factors);
            let kinds = broken(&found);
            assert_eq!(kinds.len(), broke.len(), "{settings}{factors}");
            let [found, expected] = [&found, &expected].map(|path| &path[path.len() - 1]);
            let energies = [found, expected].map(|end| end.energy.elastic_energy);
            assert!(
                (energies[0] - energies[1]).abs() < 1e-15,
                "{settings}{factors}"
            );
            assert!(
                found.energy.ledger_error().abs() < 1e-15,
                "{settings}{factors}"
            );
        }
    }
}

/// Actions that start apart are between their factors, each at its own share, where a load step ends halfway.
#[test]
fn halfway_each_action_has_a_factor_of_its_own() {
    let stages = "[[stage]]\napply = [\"a\"]\nfactors = [1.0]\n\
                  [[stage]]\napply = [\"a\", \"b\"]\nfactors = [-100.0]\n";
    for settings in ["", "[equilibrium]\nbreakage = \"event-driven\"\n"] {
        let scene = scene(1e-3, settings, stages);
        let path: Vec<Equilibrium> = scene.load_path().map_while(Result::ok).collect();
        let last = &path[path.len() - 1];
        assert!(!last.complete, "{settings}");
        assert_loads_are_those_of_the_factors(&scene.program, last);
        let share = (last.factors[0] - 1.0) / -101.0;
        assert!((last.factors[1] + 100.0 * share).abs() < 1e-9, "{settings}");
        assert!(
            (last.factors[0] - last.load_factor).abs() < 1e-12,
            "{settings}"
        );
    }
}
