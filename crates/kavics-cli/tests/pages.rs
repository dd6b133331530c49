//! The commands that the pages of docs/ show are run, each page in a folder of its own, and they say what stands there.
//!
//! `block.toml` is the example of docs/scene-file.md, `large.toml` a scene that takes some time.
#![cfg(all(unix, feature = "view"))]

mod shown;

use std::fs;
use std::path::Path;

use shown::{Shown, blocks, commands, has_program, listed, room, write};

const COMMAND: &str = include_str!("../../../docs/command.md");
const FRACTURE: &str = include_str!("../../../docs/fracture.md");
const PACKING: &str = include_str!("../../../docs/packing.md");
const PICTURES: &str = include_str!("../../../docs/pictures.md");
const RESULTS: &str = include_str!("../../../docs/results.md");
const SCENE_FILE: &str = include_str!("../../../docs/scene-file.md");
const VIEWER: &str = include_str!("../../../docs/viewer.md");
const WARNINGS: &str = include_str!("../../../docs/warnings.md");

fn furnish(room: &Path) {
    for block in blocks(SCENE_FILE) {
        write(&block, room);
    }
    fs::copy(
        room.join("scenes/disordered-block.toml"),
        room.join("large.toml"),
    )
    .expect("a scene");
    fs::create_dir_all(room.join(".local/share/bash-completion/completions")).expect("a folder");
}

/// Runs the commands of a page.
fn follow(page: &str) {
    let room = room();
    furnish(room.path());
    for shown in commands(page) {
        let program = shown.command.split(' ').next().expect("a word");
        if has_program(program) {
            shown.follow(room.path());
        } else {
            eprintln!("passed over, no {program}: {}", shown.command);
        }
    }
}

#[test]
fn the_commands_of_the_page_on_the_command_work() {
    follow(COMMAND);
}

#[test]
fn the_commands_of_the_page_on_fracture_work() {
    follow(FRACTURE);
}

#[test]
fn the_commands_of_the_page_on_pictures_work() {
    follow(PICTURES);
}

#[test]
fn the_commands_of_the_page_on_the_scene_file_work() {
    follow(SCENE_FILE);
}

#[test]
fn the_commands_of_the_other_pages_work() {
    for page in [PACKING, RESULTS, VIEWER, WARNINGS] {
        follow(page);
    }
}

#[test]
fn commands_stand_in_console_blocks_or_are_listed() {
    for page in [
        COMMAND, FRACTURE, PACKING, PICTURES, RESULTS, SCENE_FILE, VIEWER, WARNINGS,
    ] {
        for block in blocks(page).filter(|block| block.language != "console") {
            let lost = block.lines.iter().find(|line| line.starts_with("$ "));
            assert_eq!(lost, None);
        }
    }
    assert!(commands(COMMAND).len() > 15);
    assert!(commands(PICTURES).len() > 7);
}

#[test]
fn usages_are_no_commands() {
    let is_command = |line| listed(line).is_some();
    assert!(is_command("    kavics schema > kavics.schema.json"));
    assert!(!is_command(
        "    kavics check   SCENE        read and check a scene"
    ));
    assert!(!is_command(
        "    kavics verify  [CASE]…      run the validation cases"
    ));
    assert!(!is_command("    kavics draw block.results -o FILE.svg|png"));
    assert!(!is_command("kavics schema"));
}

#[test]
fn the_status_follows_from_what_is_said() {
    let status = |line| listed(line).as_ref().map(Shown::status);
    assert_eq!(status("    kavics run a.toml  ends with status 3"), Some(3));
    assert_eq!(status("    kavics run a.toml"), Some(0));
}
