//! Every kind of warning, provoked by a scene, is said on the terminal, in `run.json` and in the report, and stands in
//! `docs/warnings.md`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use kavics::warning::WarningKind;
use kavics_results::ResultsFolder;

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Three grains in a heap, the upper one pressed.
const THREE: &str = r#"
[box]
width = 4.0
height = 4.0

[grains.hexagonal]
radius = 1.0
rows = [2, 1]

[contact.cement.cemented]
stiffness.layer = { normal = 1.0, shear = 0.5 }

[[support]]
grains = { ids = [0, 1] }
fix = ["x", "y"]

[[load]]
name = "press"
grains = { ids = [2] }
force = { y = -0.01 }

[[stage]]
apply = ["press"]
factors = [1.0]
"#;

/// A single grain on the floor: no contact is between grains.
const LONE: &str = r#"
[box]
width = 2.0
height = 2.0

[grains.hexagonal]
radius = 1.0
rows = [1]

[contact.cement.cemented]
stiffness.layer = { normal = 1.0, shear = 0.5 }

[[zone]]
contact = "cement"

[side.bottom]
contact = "cement"

[[load]]
name = "press"
grains = { ids = [0] }
force = { y = -0.01 }

[[stage]]
factors = [1.0]
"#;

/// Sand with little shear stiffness and much friction, pressed at once: its contacts open, close, slide and stick hundreds of
/// times before they settle.
const SAND: &str = r#"
[box]
width = 12.0
height = "fit"

[grains.dropped]
count = 40
radius = { from = 0.7, to = 1.0 }

[contact.sand.cohesionless]
stiffness.layer = { normal = 1000.0, shear = 50.0 }
friction = 2.0

[side.left]
contact = "sand"
[side.right]
contact = "sand"
free = ["x"]
[side.bottom]
contact = "sand"
[side.top]
contact = "sand"
reach = 1.0
free = ["y"]

[[load]]
name = "side"
side = "right"
force = { x = -1.0 }
[[load]]
name = "lid"
side = "top"
force = { y = -1.0 }

[equilibrium]
iteration = "tangent"

[[stage]]
factors = [1.0]
"#;

/// Of packings of this sand that settle slowly.
const SEEDS: [u32; 3] = [90, 701, 742];

/// What the run of a scene said.
struct Said {
    terminal: String,
    record: Vec<String>,
    report: String,
}

/// Runs a scene with what is added to its text or set from outside.
fn run(scene: &str, add: &str, set: &[&str]) -> Said {
    let place = tempfile::tempdir().expect("a temporary folder");
    let file = place.path().join("scene.toml");
    fs::write(&file, format!("{scene}{add}")).expect("room");
    fs::write(
        place.path().join("table.csv"),
        "step,stress_xx,stres_xx\n1,0.5,0.5\n",
    )
    .expect("room");
    run_file(&file, set)
}

fn run_file(file: &Path, set: &[&str]) -> Said {
    let place = tempfile::tempdir().expect("a temporary folder");
    let results = place.path().join("results");
    let mut command = Command::new(env!("CARGO_BIN_EXE_kavics"));
    command.arg("run").arg(file).arg("-o").arg(&results);
    for value in set {
        command.args(["--set", value]);
    }
    let done = command.output().expect("the command runs");
    let terminal = String::from_utf8_lossy(&done.stderr).into_owned();
    let folder =
        ResultsFolder::open(&results).unwrap_or_else(|error| panic!("{error}\n{terminal}"));
    Said {
        record: folder.record().expect("run.json").warnings,
        report: fs::read_to_string(results.join("report.html")).expect("report.html"),
        terminal,
    }
}

impl Said {
    fn expect(&self, kinds: &[WarningKind]) {
        for kind in kinds {
            let mark = format!("[{}]", kind.name());
            assert!(self.terminal.contains(&mark), "{mark}\n{}", self.terminal);
            let recorded = self.record.iter().any(|text| text.ends_with(&mark));
            assert!(recorded, "{mark} {:?}", self.record);
            assert!(self.report.contains(&mark), "{mark} is not in the report");
        }
        for text in &self.record {
            let known = WarningKind::ALL
                .iter()
                .any(|kind| text.ends_with(&format!("[{}]", kind.name())));
            assert!(known, "{text} is of no kind");
        }
    }
}

fn scene(name: &str) -> PathBuf {
    workspace().join("scenes").join(name)
}

#[test]
fn action_unused() {
    let idle = "[[load]]\nname = \"idle\"\ngrains = { ids = [2] }\nforce = { x = 1.0 }\n";
    run(THREE, idle, &[]).expect(&[WarningKind::ActionUnused]);
}

#[test]
fn compared_table() {
    let compare = "[compare]\nfile = \"table.csv\"\n";
    run(THREE, compare, &[]).expect(&[WarningKind::ComparedTable]);
}

/// Sand without friction, poured and pressed.
#[test]
fn chattered_floppy_set_aside_cut_and_work() {
    run_file(&scene("sandbox-dropped.toml"), &[]).expect(&[
        WarningKind::Chattered,
        WarningKind::DualLengthCapped,
        WarningKind::FloppyModesHeld,
        WarningKind::NoFriction,
        WarningKind::SetAside,
        WarningKind::StepCut,
        WarningKind::WindowAtBoundary,
        WarningKind::WorkError,
    ]);
}

#[test]
fn floppy_modes_uncounted() {
    let iterative = ["equilibrium.solver=\"iterative\""];
    run(THREE, "", &iterative).expect(&[WarningKind::FloppyModesUncounted]);
}

#[test]
fn large_displacements() {
    let far = ["load.0.force={ y = -3.0 }"];
    let said = run(LONE, "", &far);
    said.expect(&[WarningKind::LargeDisplacements]);
    // u = F/(E·s) with E = 1 and the dual length s = 2 of a grain at a side, over the branch of length 1.
    let says = "load step 1: contact 0 displaced by 1.5 branch lengths, which is not small: ";
    let told = said.record.iter().filter(|text| text.starts_with(says));
    assert_eq!(told.count(), 1, "{:?}", said.record);
    let near = run(LONE, "", &[]).record;
    let mark = format!("[{}]", WarningKind::LargeDisplacements.name());
    assert!(near.iter().all(|text| !text.ends_with(&mark)), "{near:?}");
}

#[test]
fn load_uncovered() {
    let edge = "[[load]]\nname = \"edge\"\nedge = \"top\"\nnormal = [-0.001, -0.001]\n";
    let set = ["box.width=6.0", "stage.0.apply=[\"edge\"]"];
    run(THREE, edge, &set).expect(&[WarningKind::LoadUncovered]);
}

/// How often contacts change their phase hangs on the last digits, which differ between processors: one of some packings is enough.
#[test]
fn many_iterations() {
    let said = SEEDS.map(|seed| run(SAND, "", &[&format!("seed={seed}")]));
    let mark = format!("[{}]", WarningKind::ManyIterations.name());
    let provoked = said.iter().find(|said| said.terminal.contains(&mark));
    let provoked = provoked.expect("a packing whose contacts are slow to settle");
    provoked.expect(&[WarningKind::ManyIterations]);
}

#[test]
fn no_modes() {
    let modes = "[measure]\nstability = 1\n[equilibrium]\nbreakage = \"event-driven\"\n";
    run(THREE, modes, &[]).expect(&[WarningKind::NoModes]);
}

/// The window of three grains that are all held or loaded is empty.
#[test]
fn no_moduli_and_window_empty() {
    let moduli = "[measure]\nmoduli = true\n";
    run(THREE, moduli, &[]).expect(&[WarningKind::NoModuli, WarningKind::WindowEmpty]);
}

#[test]
fn separated() {
    run_file(&scene("softening.toml"), &[]).expect(&[WarningKind::Separated]);
}

#[test]
fn second_order_work_and_shear_may_vanish() {
    let set = [
        "contact.cement.cemented.shear_hardening=2.0",
        "load.0.force={ x = 1.5, y = -1.0 }",
    ];
    run(THREE, "", &set).expect(&[WarningKind::SecondOrderWork, WarningKind::ShearMayVanish]);
}

#[test]
fn shear_floor() {
    let set = [
        "contact.cement.cemented.shear_hardening=0.75",
        "contact.cement.cemented.shear_floor=0.99",
        "load.0.force={ y = 0.1 }",
    ];
    run(THREE, "", &set).expect(&[WarningKind::ShearFloor]);
}

#[test]
fn side_hidden() {
    run_file(&scene("tension.toml"), &[]).expect(&[WarningKind::SideHidden]);
}

#[test]
fn side_untouched() {
    let side = "[side.top]\ncontact = \"cement\"\n";
    run(THREE, side, &[]).expect(&[WarningKind::SideUntouched]);
}

/// Sand at rest on few contacts: between two sets of phases the stiffness is not positive definite.
#[test]
fn solved_directly() {
    let set = ["equilibrium.solver=\"iterative\""];
    run_file(&scene("sandbox-dropped.toml"), &set).expect(&[WarningKind::SolvedDirectly]);
}

#[test]
fn zone_empty() {
    run(LONE, "", &[]).expect(&[WarningKind::ZoneEmpty]);
}

#[test]
fn run_unfinished() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let file = place.path().join("scene.toml");
    fs::write(&file, THREE).expect("room");
    let command = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_kavics"));
        command.current_dir(place.path());
        command
    };
    let done = command().args(["run", "scene.toml"]).output();
    assert!(done.expect("the command runs").status.success());
    let record = place.path().join("scene.results/run.json");
    let text = fs::read_to_string(&record).expect("run.json");
    fs::write(&record, text.replace("\"done\"", "\"running\"")).expect("room");
    let measured = command().args(["measure", "scene.results"]).output();
    let said = String::from_utf8(measured.expect("the command runs").stderr).expect("text");
    assert!(said.contains("[run-unfinished]"), "{said}");
}

#[test]
fn every_kind_is_provoked_and_explained() {
    let tests = include_str!("warnings.rs");
    let page = fs::read_to_string(workspace().join("docs/warnings.md")).expect("the page");
    for kind in WarningKind::ALL {
        let row = format!("| `{}` |", kind.name());
        assert!(page.contains(&row), "docs/warnings.md has no row {row}");
        let name = format!("{kind:?}");
        let here = tests.contains(&format!("WarningKind::{name}"))
            || tests.contains(&format!("[{}]", kind.name()));
        assert!(here, "nothing provokes {}", kind.name());
    }
}

#[test]
fn the_page_explains_no_warning_that_there_is_not() {
    let page = fs::read_to_string(workspace().join("docs/warnings.md")).expect("the page");
    let rows = page.lines().filter_map(|line| line.strip_prefix("| `"));
    for row in rows {
        let name = row.split('`').next().expect("a name");
        let known = WarningKind::ALL.iter().any(|kind| kind.name() == name);
        assert!(known, "{name}");
    }
}
