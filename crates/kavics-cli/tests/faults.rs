//! Disks and folders that fail a run: it says which file, ends with status 4, and loses nothing.
#![cfg(unix)]

mod broken_off;

use std::fs;
use std::os::unix::fs::symlink;
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

/// Puts a link to a device that is full in the place of a file, whole as a file is replaced.
fn fill_up(place: &Place, file: &Path) {
    let aside = place.folder("aside");
    symlink("/dev/full", &aside).expect("room on the disk");
    fs::rename(&aside, file).expect("a folder");
}

#[test]
fn a_device_that_is_full_is_an_error_and_what_was_found_stays() {
    let place = Place::with(SLIDING);
    for name in [
        "steps.parquet",
        "events.parquet",
        "actions.parquet",
        "iterations.parquet",
        "log.ndjson",
        "grains/000006.parquet",
        "contacts/000006.parquet",
        "sides/000006.parquet",
        "modes/000006.parquet",
    ] {
        let full = name.replace('/', "-");
        let mut child = place.run_to(&full, 2);
        let file = place.folder(&full).join(name);
        fill_up(&place, &file);
        drop(child.stdout.take());
        let failed = child.wait_with_output().expect("a child");
        let said = said(&failed);
        assert_eq!(failed.status.code(), Some(4), "{name}: {said}");
        assert!(
            said.contains(name) && said.contains("No space left on device"),
            "{name}: {said}"
        );
        fs::remove_file(&file).expect("a link");
        let results = ResultsFolder::open(&place.folder(&full)).expect("results");
        let record = results.record().expect("a record");
        let unfinished = record.warnings.last().expect("a warning");
        assert!(unfinished.ends_with("[run-unfinished]"), "{unfinished}");
        if name.contains('/') {
            let rows = results.step_rows().expect("a table");
            assert_eq!(rows.len(), 5, "{name}: a row for each step that is whole");
        }
        place.assert_ends_alike(&full, &[]);
    }
}

#[test]
fn a_record_or_report_that_cannot_be_written_is_an_error() {
    let place = Place::with(SLIDING);
    for name in ["run.json", "report.html"] {
        let mut child = place.run_to(name, 2);
        let file = place.folder(name).join(name);
        let before = fs::read(&file);
        fill_up(&place, &file);
        drop(child.stdout.take());
        let failed = child.wait_with_output().expect("a child");
        let said = said(&failed);
        assert_eq!(failed.status.code(), Some(4), "{said}");
        assert!(said.contains(name), "{said}");
        fs::remove_file(&file).expect("a link");
        if let Ok(before) = before {
            fs::write(&file, before).expect("room on the disk");
        }
        place.assert_ends_alike(name, &[]);
    }
}

/// Runs a scene on a disk of so many bytes, which is enlarged before it goes on; what comes of it is laid into `copy`. The
/// disk is in memory, and mounted for this shell alone, so that it is gone with it.
const SMALL_DISK: &str = r#"
mount -t tmpfs -o size="$SIZE" none "$DISK" || exit 99
"$KAVICS" run "$SCENE" -o "$DISK/results" --checkpoint 0 2> "$COPY.said"
echo $? > "$COPY.status"
mount -o remount,size=256m "$DISK" || exit 99
"$KAVICS" run "$SCENE" -o "$DISK/results" --resume 2>> "$COPY.said" || exit 98
cp -r "$DISK/results" "$COPY"
"#;

fn on_a_small_disk(place: &Place, copy: &str, size: &str) -> Output {
    let mut shell = Command::new("unshare");
    shell.args(["--map-root-user", "--mount", "sh", "-c", SMALL_DISK]);
    shell.env("KAVICS", assert_cmd::cargo::cargo_bin("kavics"));
    shell.env("SCENE", place.folder("scene.toml"));
    shell.env("DISK", place.folder("disk"));
    shell.env("COPY", place.folder(copy)).env("SIZE", size);
    shell.output().expect("a shell")
}

#[test]
fn a_disk_that_is_full_is_an_error_wherever_it_comes() {
    let mut may = Command::new("unshare");
    may.args(["--map-root-user", "--mount", "true"]);
    if !may.status().is_ok_and(|status| status.success()) {
        eprintln!("no disk can be mounted here, and none was filled");
        return;
    }
    let place = Place::with(EVENTS);
    fs::create_dir(place.folder("disk")).expect("room on the disk");
    for (size, fits) in [
        ("16k", false),
        ("128k", false),
        ("512k", false),
        ("900k", false),
        ("64m", true),
    ] {
        let done = on_a_small_disk(&place, size, size);
        assert!(done.status.success(), "{size}: {}", said(&done));
        let text = |ending: &str| fs::read_to_string(place.folder(&format!("{size}.{ending}")));
        let status = text("status").expect("a status");
        let said = text("said").expect("what was said");
        assert_eq!(
            status.trim(),
            if fits { "0" } else { "4" },
            "{size}: {said}"
        );
        assert_eq!(
            said.contains("No space left on device"),
            !fits,
            "{size}: {said}"
        );
        assert!(!said.contains("mistake in kavics"), "{size}: {said}");
        place.assert_alike(size);
    }
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

/// The checkpoints of a folder, the oldest first.
fn checkpoints(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder.join("checkpoint")).expect("a folder");
    let paths = entries.flatten().map(|entry| entry.path());
    let is_checkpoint = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "arrow");
    let mut paths: Vec<PathBuf> = paths.filter(is_checkpoint).collect();
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

/// Performs a task with so many kilobytes of addresses.
fn within(kilobytes: usize, folder: &Path, arguments: &[&str]) -> Output {
    let script = format!("ulimit -v {kilobytes}; exec \"$0\" \"$@\"");
    let mut shell = Command::new("sh");
    shell.args(["-c", &script, env!("CARGO_BIN_EXE_kavics")]);
    let done = shell.args(arguments).current_dir(folder).output();
    done.expect("a shell")
}

#[test]
#[cfg(target_os = "linux")]
fn a_run_has_room_in_the_addresses_that_it_asks_for() {
    let place = Place::with(EVENTS);
    for threads in ["1", "2"] {
        let run = ["run", "scene.toml", "--force", "--threads", threads];
        let refused = within(100_000, &place.folder(""), &run);
        let said = said(&refused);
        assert_eq!(refused.status.code(), Some(2), "{said}");
        let asked = said.strip_prefix("about ").and_then(|rest| {
            let (megabytes, rest) = rest.split_once(' ')?;
            let expected = "MB of address space needed, 102 MB available";
            rest.starts_with(expected).then(|| megabytes.parse().ok())?
        });
        let asked: usize = asked.unwrap_or_else(|| panic!("{said}"));
        let enough = (asked + 1) * 1000 * 1000 / 1024;
        let done = within(enough, &place.folder(""), &run);
        assert!(done.status.success(), "{}", self::said(&done));
    }
}

#[test]
fn a_run_does_not_go_on_where_a_recorded_table_is_missing_or_damaged() {
    let place = Place::with(SLIDING);
    stop(place.run_to("lacking", 4));
    let folder = place.folder("lacking");
    for table in ["grains/000000.parquet", "contacts/000003.parquet"] {
        let whole = fs::read(folder.join(table)).expect("a table");
        let says = |what: &str| {
            let before = files(&folder);
            let failed = place.run("lacking", &["--resume"]);
            let said = said(&failed);
            assert_eq!(failed.status.code(), Some(4), "{said}");
            assert!(said.contains(table) && said.contains(what), "{said}");
            assert!(!said.contains("going on"), "{said}");
            assert!(files(&folder) == before);
        };
        fs::remove_file(folder.join(table)).expect("a table");
        says("is missing");
        let mut bytes = whole.clone();
        let near_the_end = bytes.len() - 100;
        bytes[near_the_end] ^= 4;
        fs::write(folder.join(table), bytes).expect("room on the disk");
        says("damaged");
        fs::write(folder.join(table), whole).expect("room on the disk");
    }
    place.assert_ends_alike("lacking", &[]);
}

#[test]
fn grains_that_have_no_room_in_memory_are_refused_before_they_are_placed() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let scene = "[box]\nwidth = 20000.0\nheight = \"fit\"\n[grains.square]\nradius = 1.0\n\
                 rows = { count = 9000, longest = 9000 }\n";
    fs::write(room.path().join("large.toml"), scene).expect("room on the disk");
    for task in ["check", "pack", "run"] {
        let refused = within(2_000_000, room.path(), &[task, "large.toml"]);
        let said = said(&refused);
        assert_eq!(refused.status.code(), Some(2), "{said}");
        assert!(
            said.contains(" of address space needed, 2048 MB available"),
            "{said}"
        );
        assert!(!room.path().join("large.results").exists());
    }
}
