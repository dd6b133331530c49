//! A path that goes on from the memory of another one comes to the same equilibria, to the last bit.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use kavics::equilibrium::Memory;
use kavics::loading::{LoadPath, Station};
use kavics::scene::Scene;
use proptest::prelude::*;

fn scene(text: &str) -> Scene {
    let lists = |_: &Path, _: Option<usize>| Err("no grain lists here".to_owned());
    match Scene::parse(text, "resume.toml", Path::new("."), &lists) {
        Ok(scene) => scene,
        Err(error) => panic!("{error}"),
    }
}

/// What comes out of a path, written so that no bit is lost, and what it remembers at each station.
#[derive(Default)]
struct Course {
    found: Vec<String>,
    /// A memory, and how much had been found before.
    memories: Vec<(Memory, usize)>,
}

fn follow(mut path: LoadPath<'_>) -> Course {
    let mut course = Course::default();
    while let Some(station) = path.advance() {
        match station {
            Ok(Station::Equilibrium(equilibrium)) => course.found.push(format!("{equilibrium:?}")),
            Ok(Station::Event | Station::Stopped) => {}
            Err(error) => course.found.push(error.to_string()),
        }
        let memory = path.memory().map(|memory| (memory, course.found.len()));
        course.memories.extend(memory);
    }
    course
}

/// Goes on from every station, or as many of them as are enough, and answers how many there are.
fn assert_goes_on(scene: &Scene, enough: usize) -> usize {
    let whole = follow(scene.load_path());
    let stride = whole.memories.len().div_ceil(enough).max(1);
    for (memory, before) in whole.memories.iter().step_by(stride) {
        let path = scene
            .load_path()
            .resume(memory)
            .expect("a memory that fits");
        if let Some(again) = path.last_equilibrium() {
            let last: String = format!("{:?}", again.state);
            assert!(whole.found[before - 1].contains(&last), "after {before}");
        }
        let rest = follow(path).found;
        assert!(
            rest == whole.found[*before..],
            "other equilibria after {before}"
        );
    }
    whole.memories.len()
}

/// Dropped grains between four sides, pressed from above and then sheared.
fn pressed(seed: u64, contact: &str, equilibrium: &str, factors: &str) -> String {
    format!(
        r#"seed = {seed}
[box]
width = 9.0
height = "fit"
[grains.dropped]
count = 40
radius = {{ from = 0.5, to = 1.0 }}
{contact}
[[zone]]
contact = "mortar"
[side.left]
contact = "mortar"
[side.right]
contact = "mortar"
[side.bottom]
contact = "mortar"
[side.top]
contact = "mortar"
reach = 1.0
[[move]]
name = "press"
side = "top"
y = -0.02
[[move]]
name = "shear"
side = "top"
x = 0.02
[[stage]]
apply = ["press"]
factors = {factors}
[[stage]]
apply = ["shear"]
factors = {{ to = 1.0, steps = 4 }}
[equilibrium]
{equilibrium}
"#
    )
}

const RISING: &str = "{ to = 1.0, steps = 5 }";
const CYCLIC: &str = "[0.4, 1.0, 0.3, 1.0]";

const BRITTLE: &str = r#"[contact.mortar.cemented]
stiffness.layer = { normal = 100.0, shear = 60.0 }
strength.stress = { tension = 0.05, shear = 0.1, bending = 0.1, compression = 1.0 }
strength.scatter.weibull = { shape = 2.0 }
after_breakage = "grit"
[contact.grit.cemented]
stiffness.layer = { normal = 20.0, shear = 10.0 }
strength.stress = { tension = 0.2, shear = 0.3, bending = 0.3 }
"#;

const HARDENING: &str = r#"[contact.mortar.cemented]
stiffness.layer = { normal = 100.0, shear = 60.0 }
shear_hardening = 0.75
reading = "history"
shear_floor = 0.05
strength.stress = { tension = 0.05, shear = 0.1, bending = 0.1 }
after_breakage = "grit"
[contact.grit.cohesionless]
stiffness.layer = { normal = 100.0, shear = 50.0 }
friction = 0.4
"#;

const LOOSE: &str = r"[contact.mortar.cohesionless]
stiffness.layer = { normal = 100.0, shear = 50.0 }
friction = 0.3
";

const SOFTENING: &str = r"[contact.mortar.cemented]
stiffness.layer = { normal = 100.0, shear = 60.0 }
strength.stress = { tension = 0.05, shear = 0.1, bending = 0.1 }
fracture_energy = 0.001
";

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4))]

    #[test]
    fn from_load_step_to_load_step(
        seed in 0_u64..1000,
        contact in prop::sample::select(&[BRITTLE, HARDENING, LOOSE, SOFTENING][..]),
        iteration in prop::sample::select(&["secant", "tangent"][..]),
        solver in prop::sample::select(&["direct", "iterative"][..]),
        factors in prop::sample::select(&[RISING, CYCLIC][..]),
    ) {
        let settings = format!("iteration = \"{iteration}\"\nsolver = \"{solver}\"");
        let scene = scene(&pressed(seed, contact, &settings, factors));
        prop_assert!(assert_goes_on(&scene, 12) > 1);
    }

    #[test]
    fn from_event_to_event(
        seed in 0_u64..1000,
        contact in prop::sample::select(&[BRITTLE, HARDENING][..]),
        factors in prop::sample::select(&[RISING, CYCLIC][..]),
    ) {
        let scene = scene(&pressed(seed, contact, "breakage = \"event-driven\"", factors));
        prop_assert!(assert_goes_on(&scene, 8) > 1);
    }

    #[test]
    fn along_a_steered_path(
        seed in 0_u64..1000,
        control in prop::sample::select(&["displacement", "dissipation", "auto"][..]),
    ) {
        let settings = format!("control = \"{control}\"\nmost_steps = 40");
        let scene = scene(&pressed(seed, SOFTENING, &settings, RISING));
        prop_assert!(assert_goes_on(&scene, 8) > 1);
    }
}

/// A hexagonal block that bonds leave by hundreds, so that its factor is changed in place and made anew.
fn fractured(rows: usize, settings: &str) -> String {
    format!(
        r#"seed = 3
[box]
width = 62.0
height = "fit"
[grains.hexagonal]
radius = 1.0
rows = {{ count = {rows}, longest = 30 }}
[contact.mortar.cemented]
stiffness.layer = {{ normal = 1.0, shear = 0.6 }}
strength.stress = {{ tension = 0.01, shear = 0.02, bending = 0.02 }}
strength.scatter.weibull = {{ shape = 1.5 }}
[[support]]
grains = {{ edge = "bottom" }}
fix = ["x", "y"]
[[move]]
name = "pull"
grains = {{ edge = "top" }}
x = 0.0
y = 1.0
[[stage]]
factors = {{ to = 0.6, steps = 4 }}
[equilibrium]
{settings}
"#
    )
}

#[test]
fn in_the_middle_of_hundreds_of_events() {
    let scene = scene(&fractured(48, "breakage = \"event-driven\""));
    let stations = assert_goes_on(&scene, 12);
    assert!(
        stations > 8,
        "{stations} stations, of which the load steps are 5"
    );
}

/// A factor that lags behind the stiffness is remembered by its values.
#[test]
fn with_a_factor_that_lags_behind() {
    let text = fractured(116, "").replace("strength.s", "# strength.s");
    let text = text.replace(
        "shear = 0.6 }",
        "shear = 0.6 }\nshear_hardening = 0.75\nshear_floor = 0.05",
    );
    let scene = scene(&text.replace("steps = 4", "steps = 3"));
    assert!(scene.load_path().unknowns() > 10_000);
    assert_eq!(assert_goes_on(&scene, 8), 4);
}

/// A path that is stopped anywhere remembers a place from which all that follows is the same.
#[test]
fn stopped_in_the_middle_of_a_load_step() {
    for (contact, settings) in [
        (HARDENING, ""),
        (HARDENING, "breakage = \"event-driven\""),
        (BRITTLE, "breakage = \"event-driven\""),
        (SOFTENING, "control = \"dissipation\"\nmost_steps = 40"),
    ] {
        let scene = scene(&pressed(5, contact, settings, CYCLIC));
        let whole = follow(scene.load_path()).found;
        for delay in [1, 3, 10, 30] {
            let stop = Arc::new(AtomicBool::new(false));
            let mut path = scene.load_path().stopped_by(Arc::clone(&stop));
            let mut found = 0;
            let watch = std::thread::spawn(move || {
                std::thread::sleep(std::time::Duration::from_millis(delay));
                stop.store(true, Ordering::Relaxed);
            });
            let stopped = loop {
                match path.advance() {
                    Some(Ok(Station::Equilibrium(equilibrium))) => {
                        assert!(format!("{equilibrium:?}") == whole[found]);
                        found += 1;
                    }
                    Some(Ok(Station::Event)) => {}
                    Some(Ok(Station::Stopped)) => break true,
                    Some(Err(_)) => found += 1,
                    None => break false,
                }
            };
            watch.join().expect("a clock");
            if stopped {
                let memory = path.memory().expect("something to go on from");
                let rest = scene
                    .load_path()
                    .resume(&memory)
                    .expect("a memory that fits");
                assert!(
                    follow(rest).found == whole[found..],
                    "stopped after {found}"
                );
            }
        }
    }
}

#[test]
fn a_memory_of_another_scene_is_refused() {
    let small = scene(&pressed(1, LOOSE, "", RISING));
    let large = scene(&pressed(1, LOOSE, "", RISING).replace("count = 40", "count = 41"));
    let course = follow(small.load_path());
    let (memory, _) = course.memories.last().expect("a memory");
    let refused = large.load_path().resume(memory).err().expect("a refusal");
    assert!(
        refused.to_string().ends_with("does not fit the scene"),
        "{refused}"
    );
}
