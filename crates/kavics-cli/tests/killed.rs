//! Runs that are killed at random moments go on and end with the bytes of an uninterrupted run.

mod broken_off;

use std::thread::sleep;
use std::time::Duration;

use broken_off::{EVENTS, Place, Random, SLIDING, SOFTENING};

/// Kills a run and what goes on with it again and again, each after a random share of the whole time; on one thread and
/// on two in turn.
fn assert_survives(place: &Place, kills: usize, random: &mut Random) {
    let mut killed = 0;
    for round in 0.. {
        let name = format!("killed-{round}");
        let threads = |turn: usize| ["--threads", if turn.is_multiple_of(2) { "1" } else { "2" }];
        let mut turn = round;
        loop {
            let mut arguments = threads(turn).to_vec();
            if turn > round {
                arguments.push("--resume");
            }
            let mut child = place.spawn(&name, &arguments);
            sleep(
                place
                    .whole
                    .mul_f64(random.next() * 0.9)
                    .max(Duration::from_millis(1)),
            );
            if child.try_wait().expect("a child").is_some() {
                break;
            }
            child.kill().expect("a running child");
            child.wait().expect("a child");
            killed += 1;
            turn += 1;
            if killed == kills {
                break;
            }
        }
        place.assert_ends_alike_but_for_threads(&name);
        if killed >= kills {
            return;
        }
    }
}

#[test]
fn small_runs_survive_being_killed() {
    let mut random = Random(2026);
    for scene in [EVENTS, SLIDING, SOFTENING] {
        assert_survives(&Place::with(scene), 10, &mut random);
    }
}

#[test]
fn large_runs_survive_being_killed() {
    let mut random = Random(7);
    for scene in ["dropped-1000.toml", "bench/fracture-10k.toml"] {
        assert_survives(&Place::of(scene), 2, &mut random);
    }
}

/// A hundred kills on the scenes that the documentation names; takes many minutes.
#[test]
#[ignore = "takes many minutes"]
fn a_hundred_kills() {
    let mut random = Random(1);
    assert_survives(&Place::of("dropped-1000.toml"), 30, &mut random);
    assert_survives(&Place::of("bench/fracture-10k.toml"), 30, &mut random);
    for scene in [EVENTS, SLIDING, SOFTENING, SLIDING] {
        assert_survives(&Place::with(scene), 10, &mut random);
    }
}

/// What is on the disk is not computed again: killed after load step 50 of 60, ten are left.
#[test]
fn no_load_step_on_the_disk_is_computed_again() {
    let place = Place::of("dropped-1000.toml");
    let mut child = place.run_to("killed", 50);
    child.kill().expect("a running child");
    child.wait().expect("a child");
    let said = place.assert_ends_alike("killed", &[]);
    assert!(said.contains("going on after load step"), "{said}");
    let log = std::fs::read_to_string(place.folder("killed/log.ndjson")).expect("a log");
    let (_, after) = log
        .split_once("\"what\":\"resumed\"")
        .expect("a line that names the step");
    let from: usize = after[",\"step\":".len()..]
        .split(['}', ','])
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!(from >= 49, "{from}");
    assert_eq!(after.matches("\"what\":\"step\"").count(), 60 - from);
}
