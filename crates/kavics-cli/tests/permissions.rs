//! Files and folders that may not be read or written: one sentence that names the file and the reason, status 4, nothing
//! lost. Root may do everything, so that commands of root are run as nobody.
#![cfg(unix)]

mod broken_off;

use std::fs::{self, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::Command;

use broken_off::{Place, SLIDING, said};
use kavics_results::ResultsFolder;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

/// The user and the group that own nothing.
const NOBODY: u32 = 65534;

/// Three grains in a heap, the upper one pressed.
const HEAP: &str = r#"
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
factors = [1.0, 2.0]
"#;

fn allow(path: &Path, mode: u32) {
    fs::set_permissions(path, Permissions::from_mode(mode)).expect("a file of ours");
}

fn is_root(place: &Place) -> bool {
    fs::metadata(place.folder("")).expect("a folder").uid() == 0
}

/// A place whose commands are run by whom files can be kept from.
fn place(scene: &str) -> Place {
    let place = Place::with(scene);
    allow(&place.folder(""), 0o755);
    if is_root(&place) {
        // The folder of the build may be closed to others.
        let program = assert_cmd::cargo::cargo_bin("kavics");
        let own = place.folder("kavics");
        fs::hard_link(&program, &own)
            .or_else(|_| fs::copy(&program, &own).map(|_| ()))
            .expect("room on the disk");
        give(&place.folder("whole"));
    }
    place
}

/// Gives a folder and all in it to nobody.
fn give(path: &Path) {
    chown(path, Some(NOBODY), Some(NOBODY)).expect("root may");
    if path.is_dir() {
        for entry in fs::read_dir(path).expect("a folder").flatten() {
            give(&entry.path());
        }
    }
}

/// `kavics …` in the place.
fn kavics(place: &Place, arguments: &[&str]) -> Command {
    let own = place.folder("kavics");
    let mut command = if is_root(place) {
        let mut command = Command::new(own);
        command.uid(NOBODY).gid(NOBODY);
        command
    } else {
        Command::new(assert_cmd::cargo::cargo_bin("kavics"))
    };
    command.args(arguments).current_dir(place.folder(""));
    command
}

/// The command ends with status 4 and a sentence with these words.
fn refused(place: &Place, arguments: &[&str], words: &[&str]) {
    let done = kavics(place, arguments).output().expect("the command runs");
    let said = said(&done);
    assert_eq!(done.status.code(), Some(4), "{arguments:?}: {said}");
    for word in words {
        assert!(said.contains(word), "{arguments:?}: {said}");
    }
    assert!(
        !said.contains("mistake in kavics") && said.lines().count() <= 3,
        "{arguments:?}: {said}"
    );
}

const DENIED: &str = "Permission denied";

#[test]
fn results_that_may_not_be_read_are_named() {
    let place = place(HEAP);
    let measure: &[&str] = &["measure", "whole"];
    let report: &[&str] = &["report", "whole"];
    let draw: &[&str] = &["draw", "whole", "-o", "whole/forces.svg"];
    let export: &[&str] = &["export", "whole", "--to", "vtp", "-o", "whole/vtp"];
    let curve: &[&str] = &[
        "draw",
        "whole",
        "--curve",
        "residual",
        "-o",
        "whole/residual.svg",
    ];
    let view: &[&str] = &["view", "whole", "--no-open"];
    let all = [measure, report, draw, export, curve, view];
    for (file, tasks) in [
        ("run.json", &all[..]),
        ("scene.toml", &[measure, report]),
        ("steps.parquet", &[measure, report, curve]),
        ("events.parquet", &[report]),
        ("grains/000002.parquet", &[measure, report, draw, export]),
        ("contacts/000002.parquet", &[measure, report, draw, export]),
        ("grains", &[measure, report, draw, export]),
    ] {
        let path = place.folder("whole").join(file);
        let mode = fs::metadata(&path).expect("a file").mode() & 0o777;
        allow(&path, 0o000);
        for task in tasks {
            refused(&place, task, &[file, DENIED]);
        }
        allow(&path, mode);
    }
    allow(&place.folder("whole"), 0o000);
    for task in all {
        refused(&place, task, &["whole", DENIED]);
    }
    for option in ["--resume", "--force", "-q"] {
        refused(
            &place,
            &["run", "scene.toml", "-o", "whole", option],
            &["whole", DENIED],
        );
    }
    allow(&place.folder("whole"), 0o755);
}

#[test]
fn a_scene_that_may_not_be_read_is_named() {
    let place = place(HEAP);
    let listed = "[box]\nwidth = 4.0\nheight = 4.0\n[grains.listed]\nfile = \"pack.csv\"\n";
    fs::write(place.folder("listed.toml"), listed).expect("room on the disk");
    fs::write(place.folder("pack.csv"), "x,y,radius\n1,1,1\n").expect("room on the disk");
    for file in ["scene.toml", "pack.csv"] {
        allow(&place.folder(file), 0o000);
    }
    for task in ["check", "run", "pack"] {
        refused(&place, &[task, "scene.toml"], &["scene.toml", DENIED]);
    }
    let done = kavics(&place, &["pack", "listed.toml"]).output();
    let done = done.expect("the command runs");
    let said = said(&done);
    assert!(matches!(done.status.code(), Some(2 | 4)), "{said}");
    assert!(said.contains("pack.csv") && said.contains(DENIED), "{said}");
}

#[test]
fn a_folder_in_which_nothing_may_be_made_is_named() {
    let place = place(HEAP);
    fs::create_dir(place.folder("shut")).expect("room on the disk");
    allow(&place.folder("shut"), 0o555);
    let run: &[&str] = &["run", "scene.toml", "-o", "shut/results"];
    for task in [
        run,
        &["pack", "scene.toml", "-o", "shut/pack.csv"],
        &["measure", "whole", "-o", "shut/steps.csv"],
        &["report", "whole", "-o", "shut/report.html"],
        &["draw", "whole", "-o", "shut/forces.svg"],
        &["export", "whole", "--to", "vtp", "-o", "shut/vtp"],
    ] {
        refused(&place, task, &["shut/", "cannot be written", DENIED]);
    }
    assert_eq!(
        fs::read_dir(place.folder("shut"))
            .expect("a folder")
            .count(),
        0
    );
}

#[test]
fn results_that_may_not_be_replaced_stay_as_they_are() {
    let place = place(HEAP);
    let folder = place.folder("whole");
    let before = broken_off::files(&folder);
    allow(&folder, 0o555);
    refused(
        &place,
        &["run", "scene.toml", "-o", "whole", "--force"],
        &["whole", DENIED],
    );
    allow(&folder, 0o755);
    assert!(broken_off::files(&folder) == before);
}

#[test]
fn a_folder_that_becomes_read_only_is_an_error_and_the_run_goes_on_later() {
    let place = place(SLIDING);
    let mut child = place.run_to("shut", 2);
    kill(Pid::from_raw(child.id() as i32), Signal::SIGTERM).expect("a running child");
    assert_eq!(child.wait().expect("a child").code(), Some(75));
    let folder = place.folder("shut");
    if is_root(&place) {
        give(&folder);
    }
    let before = broken_off::files(&folder);
    allow(&folder, 0o555);
    allow(&folder.join("checkpoint"), 0o555);
    refused(
        &place,
        &["run", "scene.toml", "-o", "shut", "--resume"],
        &["shut", DENIED],
    );
    allow(&folder.join("checkpoint"), 0o755);
    // The lock can be made now, and nothing else.
    refused(
        &place,
        &["run", "scene.toml", "-o", "shut", "--resume"],
        &["shut", "cannot be written", DENIED],
    );
    let results = ResultsFolder::open(&folder).expect("results");
    assert!(results.steps().expect("a table").len() >= 2);
    assert!(broken_off::files(&folder) == before);
    allow(&folder, 0o755);
    place.assert_ends_alike("shut", &[]);
}
