//! Runs that signals stop, and what --resume says where there is nothing to go on from.
#![cfg(unix)]

mod broken_off;

use std::fs;
use std::process::{Child, ExitStatus};
use std::thread::sleep;

use broken_off::{EVENTS, Place, SLIDING, SOFTENING, said, wait_for};
use kavics_results::{ResultsFolder, RunState};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

fn signal(child: &Child, signal: Signal) {
    kill(Pid::from_raw(child.id() as i32), signal).expect("a running child");
}

fn ended(mut child: Child) -> ExitStatus {
    // Nobody reads any more: a pipe that is full would keep the run from its end.
    drop(child.stdout.take());
    child.wait().expect("a child")
}

#[test]
fn a_signal_stops_a_run_which_goes_on_to_the_same_end() {
    for (scene, stopped_by) in [
        (EVENTS, Signal::SIGTERM),
        (SLIDING, Signal::SIGINT),
        (SOFTENING, Signal::SIGHUP),
    ] {
        let place = Place::with(scene);
        let child = place.run_to("stopped", 2);
        signal(&child, stopped_by);
        assert_eq!(ended(child).code(), Some(75), "{stopped_by}");
        let results = ResultsFolder::open(&place.folder("stopped")).expect("results");
        assert_eq!(results.record().expect("a record").state, RunState::Stopped);
        results.check_whole().expect("all tables");
        assert!(results.steps().expect("a table").len() >= 2);
        let said = place.assert_ends_alike("stopped", &[]);
        assert!(said.contains("going on after load step"), "{said}");
    }
}

#[test]
fn a_run_that_is_stopped_again_and_again_comes_to_the_same_end() {
    let place = Place::with(SLIDING);
    let first = place.run_to("stopped", 1);
    signal(&first, Signal::SIGTERM);
    assert_eq!(ended(first).code(), Some(75));
    for _ in 0..4 {
        let child = place.spawn("stopped", &["--resume"]);
        sleep(place.whole.mul_f64(0.3));
        signal(&child, Signal::SIGTERM);
        ended(child);
    }
    place.assert_ends_alike("stopped", &[]);
}

#[test]
fn a_second_signal_ends_a_run_at_once() {
    let place = Place::of("bench/fracture-10k.toml");
    let child = place.spawn("stopped", &[]);
    wait_for(&place.folder("stopped/grains/000000.parquet"));
    signal(&child, Signal::SIGTERM);
    signal(&child, Signal::SIGINT);
    let status = ended(child).code();
    // The first one may have been enough.
    assert!(status == Some(130) || status == Some(75), "{status:?}");
    place.assert_ends_alike("stopped", &[]);
}

#[test]
fn a_long_load_step_is_not_waited_for() {
    // One load step of hundreds of events.
    let scene = EVENTS.replace("steps = 6", "steps = 1");
    let place = Place::with(&scene);
    let child = place.spawn("stopped", &[]);
    wait_for(&place.folder("stopped/checkpoint"));
    signal(&child, Signal::SIGTERM);
    assert_eq!(ended(child).code(), Some(75));
    let results = ResultsFolder::open(&place.folder("stopped")).expect("results");
    assert!(results.steps().expect("a table").is_empty());
    place.assert_ends_alike("stopped", &[]);
}

#[test]
fn results_that_are_finished_stay_as_they_are() {
    let place = Place::with(SLIDING);
    let again = place.run("whole", &["--resume"]);
    assert_eq!(again.status.code(), Some(0));
    assert_eq!(
        said(&again),
        format!("{} is finished\n", place.folder("whole").display())
    );
}

#[test]
fn with_nothing_to_go_on_from_a_run_begins_at_the_beginning_and_says_so() {
    let place = Place::with(SLIDING);
    let said = place.assert_ends_alike("new", &[]);
    assert!(said.contains("nothing to go on from"), "{said}");
}

#[test]
fn a_run_that_ended_before_its_first_checkpoint_begins_again() {
    let place = Place::with(SOFTENING);
    let child = place.run_to("early", 1);
    signal(&child, Signal::SIGKILL);
    ended(child);
    fs::remove_dir_all(place.folder("early/checkpoint")).expect("a folder");
    let said = place.assert_ends_alike("early", &[]);
    assert!(said.contains("nothing to go on from"), "{said}");
}

#[test]
fn a_folder_of_something_else_is_left_alone() {
    let place = Place::with(SOFTENING);
    let other = place.folder("other");
    fs::create_dir(&other).expect("room on the disk");
    fs::write(other.join("letter.txt"), "dear").expect("room on the disk");
    let refused = place.run("other", &["--resume"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        said(&refused).contains("is not a results folder"),
        "{}",
        said(&refused)
    );
    assert!(other.join("letter.txt").is_file());
}

#[test]
fn a_scene_that_has_changed_is_refused_with_the_line() {
    let place = Place::with(SLIDING);
    let child = place.run_to("stopped", 2);
    signal(&child, Signal::SIGTERM);
    assert_eq!(ended(child).code(), Some(75));
    let refused = place.run(
        "stopped",
        &[
            "--resume",
            "--set",
            "contact.grit.cohesionless.friction=0.5",
        ],
    );
    assert_eq!(refused.status.code(), Some(2));
    let said = said(&refused);
    assert!(
        said.contains("then: friction = 0.4\n  now:  friction = 0.5"),
        "{said}"
    );
    // More time between checkpoints, or other threads, are no other scene.
    place.assert_ends_alike("stopped", &["--checkpoint", "60"]);
}

#[test]
fn what_has_no_equilibrium_is_not_sought_again() {
    let weak = SLIDING.replace(
        "friction = 0.4",
        "friction = 0.4\n[weight]\ngravity = 9.81\ndensity = 1e9",
    );
    let place = Place::with(&weak);
    let record = ResultsFolder::open(&place.folder("whole")).and_then(|r| r.record());
    let state = record.expect("a record").state;
    let again = place.run("whole", &["--resume"]);
    let expected = if state == RunState::Done { 0 } else { 3 };
    assert_eq!(again.status.code(), Some(expected), "{}", said(&again));
}
