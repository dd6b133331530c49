//! Checkpoints of other versions: refused in both directions with both versions named, or gone on from with a warning.
#![cfg(unix)]

mod broken_off;

use std::fs;
use std::path::Path;

use broken_off::{Place, SLIDING, said};
use kavics_results::{CHECKPOINT_VERSION, ResultsFolder};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use xxhash_rust::xxh3::xxh3_64;

fn stopped(place: &Place, name: &str) {
    let mut child = place.run_to(name, 3);
    kill(Pid::from_raw(child.id() as i32), Signal::SIGTERM).expect("a running child");
    assert_eq!(child.wait().expect("a child").code(), Some(75));
}

/// Words of all checkpoints changed for others of the same length, as another version would have written them.
fn rewrite(folder: &Path, words: &str, others: &str) {
    assert_eq!(words.len(), others.len());
    let entries = fs::read_dir(folder.join("checkpoint")).expect("a folder");
    for path in entries.map(|entry| entry.expect("an entry").path()) {
        let mut bytes = fs::read(&path).expect("a checkpoint");
        let places: Vec<usize> = (0..bytes.len() - words.len())
            .filter(|&at| bytes[at..].starts_with(words.as_bytes()))
            .collect();
        assert!(!places.is_empty(), "{words} is not in {}", path.display());
        for at in places {
            bytes[at..at + words.len()].copy_from_slice(others.as_bytes());
        }
        let name = path
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let number = name.split('-').next().expect("a number");
        fs::remove_file(&path).expect("a checkpoint");
        let renamed = format!("{number}-{:016x}.arrow", xxh3_64(&bytes));
        fs::write(path.with_file_name(renamed), bytes).expect("room on the disk");
    }
}

/// The only line of the log about `what`, and that the others are still there.
fn logged(folder: &Path, what: &str) -> String {
    let log = fs::read_to_string(folder.join("log.ndjson")).expect("a log");
    assert!(
        log.lines()
            .next()
            .is_some_and(|line| line.contains("\"what\":\"opened\"")),
        "{log}"
    );
    assert!(log.contains("\"what\":\"step\""), "{log}");
    let about = format!("\"what\":\"{what}\",\"why\":");
    let mut lines = log.lines().filter(|line| line.contains(&about));
    let line = lines.next().unwrap_or_else(|| panic!("{log}"));
    assert!(lines.next().is_none(), "{log}");
    line.to_owned()
}

#[test]
fn an_older_and_a_newer_checkpoint_are_refused_with_both_versions() {
    let place = Place::with(SLIDING);
    let mine = format!("\"checkpoint_version\":{CHECKPOINT_VERSION}");
    for other in [CHECKPOINT_VERSION - 1, CHECKPOINT_VERSION + 1] {
        let name = format!("version-{other}");
        stopped(&place, &name);
        let folder = place.folder(&name);
        rewrite(&folder, &mine, &format!("\"checkpoint_version\":{other}"));
        let before = broken_off::files(&folder);
        let refused = place.run(&name, &["--resume"]);
        let said = said(&refused);
        assert_eq!(refused.status.code(), Some(4), "{said}");
        assert!(
            said.contains(&format!("a checkpoint of version {other}")),
            "{said}"
        );
        assert!(
            said.contains(&format!("reads version {CHECKPOINT_VERSION}")),
            "{said}"
        );
        assert!(broken_off::files(&folder) == before);
        let log = logged(&folder, "refused");
        assert!(
            log.contains(&format!("a checkpoint of version {other}")),
            "{log}"
        );
        let results = ResultsFolder::open(&folder).expect("results");
        assert!(results.steps().expect("a table").len() >= 3);
    }
}

#[test]
fn a_run_that_another_kavics_began_goes_on_and_says_so() {
    let place = Place::with(SLIDING);
    stopped(&place, "other");
    let mine = env!("CARGO_PKG_VERSION");
    let other: String = mine
        .chars()
        .map(|c| if c == '1' { '0' } else { c })
        .collect();
    rewrite(
        &place.folder("other"),
        &format!("\"version\":\"{mine}\""),
        &format!("\"version\":\"{other}\""),
    );
    let said = place.assert_ends_alike("other", &[]);
    let says = format!("the run began with kavics {other}");
    assert!(said.contains(&says), "{said}");
    let log = logged(&place.folder("other"), "warning");
    assert!(log.contains(&says), "{log}");
}
