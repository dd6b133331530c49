//! One run at a time writes a results folder; readers are not kept out, and nothing stays locked by a run that was killed.
#![cfg(unix)]

mod broken_off;

use std::fs;
use std::process::{Child, Command, Output};

use broken_off::{Place, SLIDING, said};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

fn signal(child: &Child, signal: Signal) {
    kill(Pid::from_raw(child.id() as i32), signal).expect("a running child");
}

fn task(place: &Place, arguments: &[&str]) -> Output {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("kavics"));
    command.args(arguments).current_dir(place.folder(""));
    command.output().expect("the command runs")
}

#[test]
fn a_second_run_is_refused_beside_one_that_is_under_way() {
    let place = Place::with(SLIDING);
    let mut child = place.run_to("shared", 2);
    // It holds still, and is under way all the same.
    signal(&child, Signal::SIGSTOP);
    let before = broken_off::files(&place.folder("shared"));
    for option in ["--resume", "--force", "-q"] {
        let refused = place.run("shared", &[option]);
        let said = said(&refused);
        assert_eq!(refused.status.code(), Some(2), "{option}: {said}");
        assert!(said.contains("is being written by another run"), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
    assert!(broken_off::files(&place.folder("shared")) == before);
    for reader in [
        &["measure", "shared"][..],
        &["report", "shared", "-o", "report.html"],
        &["draw", "shared", "--step", "0", "-o", "forces.svg"],
        &["export", "shared", "--to", "vtp", "-o", "vtp"],
    ] {
        let read = task(&place, reader);
        assert_eq!(read.status.code(), Some(0), "{reader:?}: {}", said(&read));
    }
    signal(&child, Signal::SIGCONT);
    signal(&child, Signal::SIGTERM);
    assert_eq!(child.wait().expect("a child").code(), Some(75));
    assert!(!place.folder("shared/checkpoint/lock").exists());
    place.assert_ends_alike("shared", &[]);
}

#[test]
fn a_run_that_was_killed_keeps_nobody_out() {
    let place = Place::with(SLIDING);
    let mut child = place.run_to("killed", 2);
    child.kill().expect("a running child");
    child.wait().expect("a child");
    let lock = fs::read(place.folder("killed/checkpoint/lock")).expect("a lock that nobody holds");
    assert!(lock.is_empty());
    place.assert_ends_alike("killed", &[]);
    assert!(!place.folder("killed/checkpoint").exists());
}

/// Killed before anything but the lock was there.
#[test]
fn a_lone_lock_is_as_good_as_an_empty_folder() {
    let place = Place::with(SLIDING);
    for (name, option) in [("fresh", "-v"), ("resumed", "--resume")] {
        fs::create_dir_all(place.folder(name).join("checkpoint")).expect("room on the disk");
        fs::write(place.folder(name).join("checkpoint/lock"), "").expect("room on the disk");
        let done = place.run(name, &[option]);
        assert_eq!(done.status.code(), Some(0), "{}", said(&done));
        place.assert_alike(name);
    }
}
