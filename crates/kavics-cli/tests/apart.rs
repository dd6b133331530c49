//! What is written never takes the place of results, or of what it is made from.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const SCENE: &str = "[box]\nwidth = 10.0\nheight = \"fit\"\n[grains.listed]\nfile = \"list.csv\"\n";

fn kavics(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kavics"));
    let done = command.current_dir(folder).args(arguments).output();
    done.expect("the command runs")
}

fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.insert(path.clone(), fs::read(&path).expect("a file"));
        }
    }
    found
}

#[test]
fn no_output_replaces_results_or_what_it_is_made_from() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let block = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/block-32.toml");
    let block = block.to_str().expect("words");
    assert!(
        kavics(room.path(), &["run", "-q", block, "-o", "R"])
            .status
            .success()
    );
    assert!(
        kavics(room.path(), &["pack", block, "-o", "list.csv"])
            .status
            .success()
    );
    fs::write(room.path().join("listed.toml"), SCENE).expect("room");
    let before = files(room.path());
    for arguments in [
        &["measure", "R", "-o", "R/steps.parquet"][..],
        &["measure", "R", "-o", "R/grains/000001.parquet"],
        &["measure", "R", "-o", "R/../R/events.parquet"],
        &["measure", "R", "-o", "R/compare.csv"],
        &["report", "R", "-o", "R/run.json"],
        &["report", "R", "-o", "R/scene.toml"],
        &["draw", "R", "-o", "R/grains/000001.png"],
        &["export", "R", "--to", "vtp", "-o", "R"],
        &["export", "R", "--to", "vtp", "-o", "R/grains"],
        &["pack", "listed.toml", "-o", "list.csv"],
        &["pack", "listed.toml", "-o", "./R/../list.csv"],
        &["pack", block, "-o", "R/contacts/000001.parquet"],
    ] {
        let refused = kavics(room.path(), arguments);
        let said = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(
            said.contains(": not written, as it "),
            "{arguments:?}: {said}"
        );
        assert!(files(room.path()) == before, "{arguments:?}");
    }
    for arguments in [
        &["report", "R", "-o", "R/report.html"][..],
        &["measure", "R", "-o", "steps.parquet"],
        &["pack", "listed.toml", "-o", "other.csv"],
        &["export", "R", "--to", "vtp", "-o", "out"],
    ] {
        let done = kavics(room.path(), arguments);
        assert!(done.status.success(), "{arguments:?}");
    }
}
