//! A fibre bundle, the oracle of breakage event by event: between two rigid sides every fibre is a grain glued to the
//! bottom, its bond to the top breaks. Strengths are uniform between 0 and 1 and all fibres equally stiff, so that the
//! load per fibre is F/N = x(1 − x) at the mean share x of broken fibres, 1/4 at most, and bursts of n fibres under a
//! load that never falls come D(n) times,
//!
//! ```text
//! D(n)/N = n^(n−1)/n! ∫₀^½ (1 − a) a^(n−1) e^(−na) dx,   a = x/(1 − x)
//! ```
//!
//! Hemmer & Hansen, J. Appl. Mech. 59 (1992) 909.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use kavics::equilibrium::EventKind;
use kavics::scene::Scene;

/// The integrals for n = 1 to 5, by quadrature.
const BURSTS: [f64; 5] = [0.241_855, 0.036_822, 0.012_117, 0.005_514, 0.003_000];
const SEEDS: u64 = 20;

/// A bundle whose load a fibre rises to 0.3, beyond what it can carry.
fn bundle(fibres: usize, seed: u64, breakage: &str, steps: usize) -> Scene {
    let folder = tempfile::tempdir().expect("a folder");
    let mut grains = "x,y,radius\n".to_owned();
    for fibre in 0..fibres {
        let _ = writeln!(grains, "{},1.0,1.0", 1.5 + 3.0 * fibre as f64);
    }
    fs::write(folder.path().join("fibres.csv"), grains).expect("a list");
    let scene = format!(
        r#"
seed = {seed}
[box]
width = {width:.1}
height = 2.0
[grains.listed]
file = "fibres.csv"
[contact.glue.cemented]
stiffness.direct = {{ normal = 2.0, shear = 2.0, moment = 2.0 }}
[contact.fibre.cemented]
stiffness.direct = {{ normal = 2.0, shear = 2.0, moment = 2.0 }}
strength.force = {{ tension = 1.0 }}
strength.scatter.uniform = {{ from = 0.0, to = 1.0 }}
[side.bottom]
contact = "glue"
[side.top]
contact = "fibre"
free = ["y"]
[[load]]
name = "pull"
side = "top"
force = {{ y = {load:.1} }}
[[stage]]
factors = {{ to = 0.3, steps = {steps} }}
[equilibrium]
breakage = "{breakage}"
"#,
        width = 3.0 * fibres as f64,
        load = fibres as f64,
    );
    let none = |_: &Path, _| Err("no reader for this file".to_owned());
    Scene::parse(&scene, "scene.toml", folder.path(), &none)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// What a bundle did: load factor and avalanche of every break, in order.
struct Breaks {
    load_factor: Vec<f64>,
    avalanche: Vec<usize>,
}

fn breaks(scene: &Scene) -> Breaks {
    let mut found = Breaks {
        load_factor: Vec::new(),
        avalanche: Vec::new(),
    };
    for equilibrium in scene.load_path().map_while(Result::ok) {
        for event in equilibrium.events {
            if matches!(event.kind, EventKind::Broke { .. }) {
                found.load_factor.push(event.load_factor);
                found.avalanche.push(event.avalanche.unwrap_or(0));
            }
        }
    }
    found
}

/// Sizes of the bursts before the last one, in which the bundle falls apart.
fn bursts(breaks: &Breaks) -> Vec<usize> {
    let last = *breaks.avalanche.last().expect("a bundle breaks");
    let mut sizes = vec![0; last];
    for &avalanche in breaks.avalanche.iter().filter(|&&a| a < last) {
        sizes[avalanche] += 1;
    }
    sizes
}

/// Mean and its standard error.
fn mean(values: &[f64]) -> [f64; 2] {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>();
    [mean, (square / (count - 1.0) / count).sqrt()]
}

/// Bursts and largest loads of bundles of so many fibres, over all seeds.
fn agree_with_the_theory(fibres: usize) {
    let bundles: Vec<Breaks> = (1..=SEEDS)
        .map(|seed| breaks(&bundle(fibres, seed, "event-driven", 1)))
        .collect();
    let count = fibres as f64;
    for (size, expected) in (1..).zip(BURSTS) {
        let shares: Vec<f64> = bundles
            .iter()
            .map(|breaks| bursts(breaks).iter().filter(|&&s| s == size).count() as f64 / count)
            .collect();
        let [found, error] = mean(&shares);
        println!("bursts of {size}: {found:.6} ± {error:.6}, expected {expected:.6}");
        assert!((found - expected).abs() < 4.0 * error, "bursts of {size}");
    }
    let peaks: Vec<f64> = bundles
        .iter()
        .map(|breaks| breaks.load_factor.iter().copied().fold(0.0, f64::max))
        .collect();
    let [peak, error] = mean(&peaks);
    println!("largest load of a fibre: {peak:.5} ± {error:.5}, expected 0.25");
    // The largest load of one bundle scatters by 1/(4·√N).
    assert!(
        peaks
            .iter()
            .all(|peak| (peak - 0.25).abs() < 1.0 / count.sqrt())
    );
}

#[test]
fn bursts_of_a_fibre_bundle_come_as_often_as_the_theory_says() {
    agree_with_the_theory(1000);
}

#[test]
#[ignore = "takes some minutes"]
fn bursts_of_ten_thousand_fibres_come_as_often_as_the_theory_says() {
    agree_with_the_theory(10_000);
}

#[test]
#[ignore = "takes some minutes"]
fn one_bundle_of_a_hundred_thousand_fibres_bursts_as_the_theory_says() {
    let fibres = 100_000;
    let breaks = breaks(&bundle(fibres, 1, "event-driven", 1));
    let sizes = bursts(&breaks);
    for (size, expected) in (1..).zip(BURSTS) {
        let found = sizes.iter().filter(|&&s| s == size).count() as f64;
        let expected = expected * fibres as f64;
        println!("bursts of {size}: {found}, expected {expected:.0}");
        // Bursts of one size are rare among all fibres, so that their number scatters by its root at most.
        assert!(
            (found - expected).abs() < 4.0 * expected.sqrt(),
            "bursts of {size}"
        );
    }
    let peak = breaks.load_factor.iter().copied().fold(0.0, f64::max);
    println!("largest load of a fibre: {peak:.5}, expected 0.25");
    assert!((peak - 0.25).abs() < 1.0 / (fibres as f64).sqrt());
}

#[test]
fn a_bundle_pulled_to_its_end_breaks_every_fibre_once_and_the_load_follows_the_strengths() {
    let fibres = 500;
    let scene = bundle(fibres, 3, "event-driven", 7);
    let breaks = breaks(&scene);
    let mut strengths: Vec<f64> = scene
        .assembly
        .contacts
        .values()
        .iter()
        .filter(|contact| contact.point.y > 1.0)
        .map(|contact| contact.strength_factor)
        .collect();
    strengths.sort_by(f64::total_cmp);
    assert!(breaks.load_factor.len() >= fibres - 1);
    for (broken, (factor, strength)) in breaks.load_factor.iter().zip(strengths).enumerate() {
        let expected = strength * (fibres - broken) as f64 / fibres as f64;
        assert!(
            (factor - expected).abs() < 1e-9 * expected.max(1e-3),
            "break {broken}"
        );
    }
}

#[test]
fn load_steps_change_the_bursts_and_events_do_not() {
    // With finite steps a burst is all that breaks in one: small ones vanish. Events know of no step.
    let sizes = |breakage: &str, steps: usize| {
        let mut steps_of = Vec::new();
        for equilibrium in bundle(2000, 7, breakage, steps)
            .load_path()
            .map_while(Result::ok)
        {
            let broke =
                |event: &&kavics::equilibrium::Event| matches!(event.kind, EventKind::Broke { .. });
            steps_of.push(equilibrium.events.iter().filter(broke).count());
        }
        steps_of
    };
    let single = |sizes: &[usize]| sizes.iter().filter(|&&size| size == 1).count();
    let coarse = sizes("worst-first", 30);
    assert!(single(&coarse) < 5);
    let by_event = |steps: usize| {
        let breaks = breaks(&bundle(2000, 7, "event-driven", steps));
        (bursts(&breaks), breaks.load_factor)
    };
    let (few, many) = (by_event(3), by_event(60));
    assert_eq!(few.0, many.0);
    let near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-9;
    assert!(few.1.iter().zip(&many.1).all(near));
    assert!(single(&few.0) > 400);
}
