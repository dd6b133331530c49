//! What the command says and answers, without a scene that runs.

use std::fs;
use std::path::Path;

use assert_cmd::Command;

fn kavics(place: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("kavics").expect("the command is built");
    command.current_dir(place).args(arguments);
    command
}

/// Exit status, then stdout, then stderr.
fn answer(place: &Path, arguments: &[&str]) -> String {
    let output = kavics(place, arguments).output().expect("the command runs");
    format!(
        "status {}\n{}{}",
        output.status.code().expect("no signal"),
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    )
}

fn place() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

#[test]
fn help_names_the_tasks_and_the_exit_status() {
    insta::assert_snapshot!(answer(place().path(), &["--help"]));
}

#[test]
fn every_task_has_a_help() {
    let tasks = [
        "check",
        "pack",
        "run",
        "measure",
        "report",
        "view",
        "verify",
        "draw",
        "export",
        "schema",
        "completions",
        "man",
    ];
    let helps = tasks.map(|task| answer(place().path(), &[task, "--help"]));
    insta::assert_snapshot!(helps.join("\n"));
}

#[test]
fn a_task_that_does_not_exist_is_wrong_usage() {
    insta::assert_snapshot!(answer(place().path(), &["ran", "block.toml"]));
}

#[test]
fn no_threads_are_wrong_usage() {
    insta::assert_snapshot!(answer(
        place().path(),
        &["run", "block.toml", "--threads", "0"]
    ));
}

#[test]
fn more_threads_than_can_start_are_wrong_usage() {
    let many = ["run", "block.toml", "--threads", "100000"];
    let answer = answer(place().path(), &many);
    assert!(answer.starts_with("status 2"), "{answer}");
    assert!(answer.contains("from 1 to 1024"), "{answer}");
}

#[test]
fn a_missing_scene_is_named() {
    let place = place();
    insta::assert_snapshot!(answer(place.path(), &["run", "block.toml"]));
    assert_eq!(fs::read_dir(place.path()).expect("a folder").count(), 0);
}

#[test]
fn results_that_are_there_are_left_alone() {
    let place = place();
    let results = place.path().join("block.results");
    fs::create_dir(&results).expect("room on the disk");
    fs::write(results.join("run.json"), "{}").expect("room on the disk");
    fs::write(place.path().join("block.toml"), "title = \"Block\"\n").expect("room on the disk");
    insta::assert_snapshot!(answer(place.path(), &["run", "block.toml"]));
    assert_eq!(fs::read_dir(&results).expect("a folder").count(), 1);
}

#[test]
fn a_folder_of_something_else_is_left_alone_even_with_force() {
    let place = place();
    fs::create_dir(place.path().join("thesis")).expect("room on the disk");
    fs::write(place.path().join("thesis/thesis.tex"), "all of it").expect("room on the disk");
    insta::assert_snapshot!(answer(
        place.path(),
        &["run", "block.toml", "-o", "thesis", "--force"]
    ));
    assert!(place.path().join("thesis/thesis.tex").exists());
}

#[test]
fn an_override_without_a_value_is_wrong_usage() {
    let place = place();
    fs::write(place.path().join("block.toml"), "title = \"Block\"\n").expect("room on the disk");
    insta::assert_snapshot!(answer(
        place.path(),
        &["check", "block.toml", "--set", "seed"]
    ));
}

#[test]
fn an_override_of_an_element_that_is_not_there_says_so() {
    let place = place();
    fs::write(
        place.path().join("block.toml"),
        "[[stage]]\nname = \"press\"\n",
    )
    .expect("room on the disk");
    insta::assert_snapshot!(answer(
        place.path(),
        &["check", "block.toml", "--set", "stage.1.factors=[1]"]
    ));
}

#[test]
fn a_report_of_no_results_is_refused() {
    let place = place();
    fs::create_dir(place.path().join("empty")).expect("room on the disk");
    insta::assert_snapshot!(answer(place.path(), &["report", "empty"]));
    insta::assert_snapshot!(answer(place.path(), &["measure", "absent"]));
}

#[test]
fn a_view_of_no_results_is_refused() {
    let place = place();
    let answer = answer(place.path(), &["view", ".", "--no-open"]);
    assert_eq!(
        answer,
        "status 2\n. is not a results folder (it has no run.json)\n"
    );
}

#[test]
fn completions_and_manual_page_go_to_stdout() {
    let place = place();
    kavics(place.path(), &["completions", "bash"])
        .assert()
        .success();
    let manual = answer(place.path(), &["man"]);
    assert!(manual.contains(".TH kavics 1"), "{manual}");
    let run = answer(place.path(), &["man", "run"]);
    assert!(run.contains(".TH kavics-run 1"), "{run}");
    assert!(run.contains("force"), "{run}");
}

#[test]
fn the_schema_is_json_and_knows_the_tables_of_a_scene() {
    let place = place();
    let output = kavics(place.path(), &["schema"])
        .output()
        .expect("the command runs");
    let schema: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert!(schema["properties"]["stage"].is_object());
}
