//! Runs that signals stop, and what --resume says where there is nothing to go on from.
#![cfg(unix)]

mod broken_off;

use std::fs;
use std::io::{BufRead, BufReader};
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use broken_off::{EVENTS, Place, Random, SLIDING, SOFTENING, said, wait_for};
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

/// Everything scaled by a hundred: the same events, at displacements that are not small.
#[test]
fn a_run_goes_on_with_the_warnings_that_it_had() {
    let scene = EVENTS
        .replace(
            "tension = 0.01, shear = 0.02, bending = 0.02",
            "tension = 1.0, shear = 2.0, bending = 2.0",
        )
        .replace("y = 1.0", "y = 100.0");
    let place = Place::with(&scene);
    let warnings = |name: &str| {
        let results = ResultsFolder::open(&place.folder(name)).expect("results");
        results.record().expect("a record").warnings
    };
    for (name, arguments) in [("one", ["--threads", "1"]), ("two", ["--threads", "2"])] {
        let child = place.run_to(name, 2);
        signal(&child, Signal::SIGTERM);
        assert_eq!(ended(child).code(), Some(75));
        let mut with = vec!["--resume"];
        with.extend(arguments);
        place.run(name, &with);
        assert_eq!(warnings(name), warnings("whole"));
    }
    let told = warnings("whole");
    let mark = "[large-displacements]";
    let large = told.iter().find(|text| text.ends_with(mark));
    assert!(
        large.is_some_and(|text| text.starts_with("load steps 1 to ")),
        "{told:?}"
    );
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

/// Puts a pipe that nobody reads in the place of a file: who writes to it waits for ever, as for a disk that is gone.
fn block(place: &Place, file: &Path) {
    let aside = place.folder("aside");
    let made = Command::new("mkfifo").arg(&aside).status();
    assert!(made.expect("mkfifo").success());
    fs::rename(&aside, file).expect("a folder");
}

/// Waits until the run has said something with these words.
fn wait_for_words(child: &mut Child, words: &str) {
    let told = BufReader::new(child.stderr.as_mut().expect("a pipe"));
    let mut lines = told.lines().map_while(Result::ok);
    assert!(
        lines.any(|line| line.contains(words)),
        "nothing says {words}"
    );
}

#[test]
fn a_second_signal_ends_a_run_at_once_whatever_it_is() {
    let place = Place::with(SLIDING);
    for (number, [first, second]) in [
        [Signal::SIGTERM, Signal::SIGTERM],
        [Signal::SIGINT, Signal::SIGINT],
        [Signal::SIGHUP, Signal::SIGHUP],
        [Signal::SIGTERM, Signal::SIGINT],
        [Signal::SIGINT, Signal::SIGTERM],
    ]
    .into_iter()
    .enumerate()
    {
        let name = format!("stopped-{number}");
        let mut child = place.run_to(&name, 2);
        let log = place.folder(&name).join("log.ndjson");
        block(&place, &log);
        signal(&child, first);
        wait_for_words(&mut child, "once more to end at once");
        signal(&child, second);
        assert_eq!(ended(child).code(), Some(130), "{first}, {second}");
        fs::remove_file(log).expect("a pipe");
        place.assert_ends_alike(&name, &[]);
    }
}

/// Waits until a process listens to signals.
#[cfg(target_os = "linux")]
fn wait_for_ears(child: &Child) {
    let threads = Path::new("/proc").join(child.id().to_string()).join("task");
    let listens = || {
        let threads = fs::read_dir(&threads).expect("a running child").flatten();
        let names =
            threads.filter_map(|thread| fs::read_to_string(thread.path().join("comm")).ok());
        names.into_iter().any(|name| name.trim() == "ctrl-c")
    };
    while !listens() {
        sleep(Duration::from_millis(2));
    }
}

/// A million grains take seconds to place.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_before_anything_is_written_ends_a_run_at_once() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/million.toml");
    let room = tempfile::tempdir().expect("a temporary folder");
    for by in [Signal::SIGTERM, Signal::SIGINT, Signal::SIGHUP] {
        let child = Command::new(env!("CARGO_BIN_EXE_kavics"))
            .args(["run", "--any-size", "-o", "results"])
            .arg(&scene)
            .current_dir(room.path())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command runs");
        wait_for_ears(&child);
        signal(&child, by);
        let done = child.wait_with_output().expect("a child");
        let said = said(&done);
        assert_eq!(done.status.code(), Some(75), "{by}: {said}");
        assert!(said.contains("before anything was written"), "{by}: {said}");
        assert!(!room.path().join("results").exists());
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_verification_that_is_stopped_leaves_nothing_behind() {
    let room = tempfile::tempdir().expect("a temporary folder");
    for by in [Signal::SIGTERM, Signal::SIGINT, Signal::SIGHUP] {
        let child = Command::new(env!("CARGO_BIN_EXE_kavics"))
            .arg("verify")
            .env("TMPDIR", room.path())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command runs");
        wait_for_ears(&child);
        signal(&child, by);
        let done = child.wait_with_output().expect("a child");
        assert_eq!(done.status.code(), Some(130), "{by}: {}", said(&done));
        let left = fs::read_dir(room.path()).expect("a folder").count();
        assert_eq!(left, 0, "{by}");
    }
}

/// Tasks that write one file end by a signal as any program does, and the file is the old one or the new one, whole.
#[test]
fn a_file_that_is_being_replaced_when_a_signal_comes_is_whole() {
    let place = Place::of("dropped-1000.toml");
    let pack: &[&str] = &["pack", "scene.toml", "-o", "pack.csv"];
    let measure: &[&str] = &["measure", "whole", "-o", "steps.csv"];
    let report: &[&str] = &["report", "whole", "-o", "page.html"];
    let mut random = Random(11);
    for task in [pack, measure, report] {
        let file = place.folder(task[task.len() - 1]);
        let spawn = || {
            let mut command = Command::new(env!("CARGO_BIN_EXE_kavics"));
            command.args(task).current_dir(place.folder(""));
            command
                .stderr(Stdio::null())
                .spawn()
                .expect("the command runs")
        };
        let start = Instant::now();
        assert!(spawn().wait().expect("a child").success());
        let (took, new) = (start.elapsed(), fs::read(&file).expect("a file"));
        for _ in 0..8 {
            fs::write(&file, "old").expect("room on the disk");
            let child = spawn();
            sleep(took.mul_f64(random.next()));
            let _ = kill(Pid::from_raw(child.id() as i32), Signal::SIGTERM);
            let status = ended(child);
            assert!(
                status.success() || status.signal() == Some(Signal::SIGTERM as i32),
                "{task:?}: {status}"
            );
            let found = fs::read(&file).expect("a file");
            assert!(found == b"old" || found == new, "{task:?}");
        }
    }
}

#[test]
fn a_run_that_was_stopped_is_said_to_be_unfinished_everywhere() {
    let place = Place::with(SLIDING);
    let child = place.run_to("stopped", 2);
    signal(&child, Signal::SIGTERM);
    let done = child.wait_with_output().expect("a child");
    let mark = "[run-unfinished]";
    assert!(said(&done).contains(mark), "{}", said(&done));
    let record = fs::read_to_string(place.folder("stopped/run.json")).expect("a record");
    assert!(record.contains(mark), "{record}");
    for task in ["measure", "report"] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_kavics"));
        command.arg(task).arg(place.folder("stopped"));
        let done = command.output().expect("the command runs");
        assert!(said(&done).contains(mark), "{task}: {}", said(&done));
    }
    let page = fs::read_to_string(place.folder("stopped/report.html")).expect("a report");
    assert!(page.contains(mark));
    place.assert_ends_alike("stopped", &[]);
}

/// `nohup` lets the signal be ignored.
#[test]
#[cfg(target_os = "linux")]
fn a_run_that_is_to_outlive_its_terminal_does() {
    let place = Place::with(SLIDING);
    let command = place.command("outlives", &[]);
    let mut shell = std::process::Command::new("sh");
    shell.args(["-c", "trap '' HUP; exec \"$0\" \"$@\""]);
    shell.arg(command.get_program()).args(command.get_args());
    shell.current_dir(command.get_current_dir().expect("a folder"));
    shell.stdout(std::process::Stdio::null());
    let child = shell.spawn().expect("a shell");
    wait_for(&place.folder("outlives/grains/000000.parquet"));
    signal(&child, Signal::SIGHUP);
    assert_eq!(ended(child).code(), Some(0));
}

#[test]
fn a_checkpoint_without_its_scene_is_not_gone_on_from() {
    let place = Place::with(SLIDING);
    let child = place.run_to("stopped", 2);
    signal(&child, Signal::SIGTERM);
    assert_eq!(ended(child).code(), Some(75));
    let scene = place.folder("stopped/scene.toml");
    let text = fs::read(&scene).expect("a scene");
    fs::remove_file(&scene).expect("a file");
    let refused = place.run("stopped", &["--resume"]);
    assert_eq!(refused.status.code(), Some(4), "{}", said(&refused));
    assert!(said(&refused).contains("scene.toml"), "{}", said(&refused));
    fs::write(&scene, text).expect("room on the disk");
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
fn what_a_killed_report_left_is_taken_away() {
    let place = Place::with(SLIDING);
    let folder = place.folder("whole");
    let before = broken_off::files(&folder);
    fs::create_dir(folder.join("checkpoint")).expect("room on the disk");
    for name in ["checkpoint/lock", ".report.html.Ab3xYz", "notes.txt"] {
        fs::write(folder.join(name), "").expect("room on the disk");
    }
    assert_eq!(place.run("whole", &["--resume"]).status.code(), Some(0));
    // What does not belong to the run stays.
    fs::remove_file(folder.join("notes.txt")).expect("a file");
    assert!(broken_off::files(&folder) == before);
    assert!(!folder.join("checkpoint").exists());
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
