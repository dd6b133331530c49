//! Disks and folders that fail a run: it says which file, ends with status 4, and loses nothing.
#![cfg(unix)]

mod broken_off;

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output};

use broken_off::{EVENTS, Place, SLIDING, files, said};
use kavics_results::ResultsFolder;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

/// All tables that are there can be read, and hold no fewer load steps than these.
fn assert_readable(folder: &Path, least: usize) {
    let results = ResultsFolder::open(folder).expect("results");
    assert!(results.steps().expect("a table").len() >= least);
    results.events().expect("a table");
    results.record().expect("a record");
    for step in results.recorded_steps().expect("a folder") {
        results.grains(step).expect("a table");
    }
}

fn ended(mut child: Child) -> Option<i32> {
    drop(child.stdout.take());
    child.wait().expect("a child").code()
}

fn stop(child: Child) {
    kill(Pid::from_raw(child.id() as i32), Signal::SIGTERM).expect("a running child");
    assert_eq!(ended(child), Some(75));
}

/// The same command with files no larger than so many blocks of 512 bytes.
fn limited(command: &Command, blocks: u64) -> Output {
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("ulimit -f {blocks}; exec \"$0\" \"$@\"")]);
    shell.arg(command.get_program()).args(command.get_args());
    if let Some(folder) = command.get_current_dir() {
        shell.current_dir(folder);
    }
    shell.output().expect("a shell")
}

#[test]
fn a_limit_on_the_size_of_files_is_an_error_with_the_file() {
    let place = Place::with(EVENTS);
    let largest = files(&place.folder("whole")).into_iter();
    let largest = largest.filter(|file| file.0.ends_with(".parquet"));
    let largest = largest.map(|file| file.1.len()).max().expect("a table") as u64;
    for blocks in [largest / 1024, largest / 512 - 1] {
        let name = format!("limited-{blocks}");
        let failed = limited(&place.command(&name, &[]), blocks);
        let said = said(&failed);
        assert_eq!(failed.status.code(), Some(4), "{said}");
        assert!(said.contains("File too large"), "{said}");
        assert!(said.contains(&name), "{said}");
        if place.folder(&name).join("steps.parquet").is_file() {
            assert_readable(&place.folder(&name), 0);
        }
        place.assert_ends_alike(&name, &[]);
    }
}

#[test]
fn a_device_that_is_full_is_an_error_and_what_was_found_stays() {
    let place = Place::with(SLIDING);
    let child = place.run_to("full", 2);
    let table = place.folder("full/events.parquet");
    let aside = place.folder("aside");
    symlink("/dev/full", &aside).expect("room on the disk");
    fs::rename(&aside, &table).expect("a folder");
    assert_eq!(ended(child), Some(4));
    fs::remove_file(&table).expect("a link");
    let results = ResultsFolder::open(&place.folder("full")).expect("results");
    results.steps().expect("a table");
    place.assert_ends_alike("full", &[]);
}

#[test]
fn a_folder_that_vanishes_is_an_error_and_a_run_goes_on_when_it_is_back() {
    let place = Place::with(SLIDING);
    let child = place.run_to("there", 3);
    fs::rename(place.folder("there"), place.folder("away")).expect("a folder");
    assert_eq!(ended(child), Some(4));
    assert!(!place.folder("there").exists());
    assert_readable(&place.folder("away"), 0);
    fs::rename(place.folder("away"), place.folder("there")).expect("a folder");
    place.assert_ends_alike("there", &[]);
}

#[test]
fn a_folder_that_takes_no_files_is_an_error() {
    let place = Place::with(SLIDING);
    let failed = place.run("/proc/kavics", &[]);
    assert_eq!(failed.status.code(), Some(4), "{}", said(&failed));
    assert!(
        said(&failed).contains("/proc/kavics: cannot be written"),
        "{}",
        said(&failed)
    );
}

#[test]
fn a_folder_that_becomes_read_only_is_an_error() {
    let place = Place::with(SLIDING);
    stop(place.run_to("shut", 2));
    let folder = place.folder("shut");
    fs::set_permissions(&folder, fs::Permissions::from_mode(0o555)).expect("a folder of ours");
    if fs::write(folder.join(".run.json.try"), "").is_ok() {
        // Whoever may write everywhere, as root may, cannot be refused.
        fs::remove_file(folder.join(".run.json.try")).expect("a file");
    } else {
        let failed = place.run("shut", &["--resume"]);
        assert_eq!(failed.status.code(), Some(4), "{}", said(&failed));
        assert_readable(&folder, 2);
    }
    fs::set_permissions(&folder, fs::Permissions::from_mode(0o755)).expect("a folder of ours");
    place.assert_ends_alike("shut", &[]);
}

/// The checkpoints of a folder, the oldest first.
fn checkpoints(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder.join("checkpoint")).expect("a folder");
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    paths
}

fn flip(path: &Path) {
    let mut bytes = fs::read(path).expect("a file");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 4;
    fs::write(path, bytes).expect("room on the disk");
}

#[test]
fn a_damaged_checkpoint_is_passed_over() {
    let place = Place::with(SLIDING);
    stop(place.run_to("damaged", 3));
    let both = checkpoints(&place.folder("damaged"));
    assert_eq!(both.len(), 2);
    flip(&both[1]);
    let said = place.assert_ends_alike("damaged", &[]);
    assert!(
        said.contains("damaged: its bytes do not have the hash of its name"),
        "{said}"
    );
}

#[test]
fn where_no_checkpoint_is_whole_nothing_is_touched() {
    let place = Place::with(SLIDING);
    stop(place.run_to("damaged", 3));
    for path in checkpoints(&place.folder("damaged")) {
        flip(&path);
    }
    let before = files(&place.folder("damaged"));
    let failed = place.run("damaged", &["--resume"]);
    let said = said(&failed);
    assert_eq!(failed.status.code(), Some(4), "{said}");
    assert!(said.contains("no checkpoint is whole"), "{said}");
    assert!(files(&place.folder("damaged")) == before);
    assert_readable(&place.folder("damaged"), 3);
}

#[test]
fn grains_that_have_no_room_in_memory_are_refused_before_they_are_placed() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let scene = "[box]\nwidth = 20000.0\nheight = \"fit\"\n[grains.square]\nradius = 1.0\n\
                 rows = { count = 9000, longest = 9000 }\n";
    fs::write(room.path().join("large.toml"), scene).expect("room on the disk");
    for task in ["check", "pack", "run"] {
        let script = "ulimit -v 2000000; exec \"$0\" \"$@\"";
        let mut shell = Command::new("sh");
        shell.args([
            "-c",
            script,
            env!("CARGO_BIN_EXE_kavics"),
            task,
            "large.toml",
        ]);
        let refused = shell.current_dir(room.path()).output().expect("a shell");
        let said = said(&refused);
        assert_eq!(refused.status.code(), Some(2), "{said}");
        assert!(
            said.contains("GB of memory needed, 2000 MB available")
                || said.contains("GB of memory needed, 2048 MB available"),
            "{said}"
        );
        assert!(!room.path().join("large.results").exists());
    }
}
