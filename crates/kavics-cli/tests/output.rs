//! A stdout that takes no more: a sentence and status 4 where a device is full, silence where a reader has left.
#![cfg(unix)]

use std::fs::OpenOptions;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

/// What writes to stdout.
const WRITERS: [&[&str]; 14] = [
    &["check", "SCENE"],
    &["check", "--json", "SCENE"],
    &["pack", "SCENE"],
    &["pack", "SCENE", "--summary"],
    &["run", "--json", "--force", "SCENE"],
    &["measure", "block-32.results"],
    &["verify", "three-discs"],
    &["verify", "three-discs", "--json"],
    &["schema"],
    &["completions", "bash"],
    &["man", "run"],
    &["run", "--help"],
    &["--help"],
    &["--version"],
];

fn scene() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/block-32.toml")
}

fn kavics(place: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kavics"));
    command.current_dir(place).stderr(Stdio::piped());
    for argument in arguments {
        match *argument {
            "SCENE" => command.arg(scene()),
            other => command.arg(other),
        };
    }
    command
}

fn finished() -> TempDir {
    let place = tempfile::tempdir().expect("a temporary folder");
    let done = kavics(place.path(), &["run", "-q", "SCENE"]).status();
    assert!(done.expect("the command runs").success());
    place
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn full() -> Stdio {
    let device = OpenOptions::new().write(true).open("/dev/full");
    device.expect("a device").into()
}

#[test]
fn a_full_device_is_told() {
    let place = finished();
    for writer in WRITERS {
        let child = kavics(place.path(), writer).stdout(full()).spawn();
        let done = child.and_then(std::process::Child::wait_with_output);
        let done = done.expect("the command runs");
        let said = said(&done);
        assert_eq!(done.status.code(), Some(4), "{writer:?}: {said}");
        let told = said.lines().last().unwrap_or_default();
        assert!(
            told.starts_with("stdout: No space left"),
            "{writer:?}: {said}"
        );
    }
}

#[test]
fn what_writes_nothing_to_stdout_does_not_miss_it() {
    let place = finished();
    for silent in [
        &["run", "--force", "SCENE"][..],
        &["report", "block-32.results"],
        &["pack", "SCENE", "-o", "pack.csv"],
    ] {
        let done = kavics(place.path(), silent).stdout(full()).status();
        assert_eq!(
            done.expect("the command runs").code(),
            Some(0),
            "{silent:?}"
        );
    }
}

#[test]
fn a_reader_that_leaves_is_no_failure() {
    let place = finished();
    for writer in WRITERS {
        let mut child = kavics(place.path(), writer)
            .stdout(Stdio::piped())
            .spawn()
            .expect("the command runs");
        drop(child.stdout.take());
        let done = child.wait_with_output().expect("a child");
        let said = said(&done);
        assert_eq!(done.status.code(), Some(0), "{writer:?}: {said}");
        assert!(!said.contains("pipe"), "{writer:?}: {said}");
    }
}
