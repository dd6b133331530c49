//! The commands that the pages of docs/ show are run, each page in a folder of its own, and they say what stands there.
//!
//! `block.toml` is the example of docs/scene-file.md, the scenes with mistakes are that with changes, `large.toml` is a scene
//! that takes some time.
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

/// A scene with a mistake: its file, and what of the example gives way to what.
struct Mistake(&'static str, &'static [(&'static str, &'static str)]);

const MISTAKES: [Mistake; 8] = [
    Mistake("layer.toml", &[(LAYER, MODULUS)]),
    Mistake("nosup.toml", &[(r#"fix    = ["x"]"#, r#"fix    = ["y"]"#)]),
    Mistake("zone2.toml", &[("[[support]]", ZONE_AND_SUPPORT)]),
    Mistake(
        "topgap.toml",
        &[(FIT, "height = 12.4"), ("\"bottom\"", "\"top\"")],
    ),
    Mistake(
        "side.toml",
        &[(FIT, "height = 12.5"), ("[contact.", SIDE_AND_CONTACT)],
    ),
    Mistake(
        "sideheld.toml",
        &[
            ("[[load]]", SIDE_AND_LOAD),
            ("edge   =", "side ="),
            (PRESSURE, FORCE),
        ],
    ),
    Mistake("tens.toml", &[("tension = 0.5", "tension = 0.9")]),
    Mistake(
        "nostage.toml",
        &[
            ("[[stage]]", ""),
            ("name    = \"compression\"", ""),
            (FACTORS, ""),
        ],
    ),
];
const FIT: &str = r#"height = "fit""#;
const LAYER: &str = "stiffness.layer = { normal = 1.0, shear = 0.55 }";
const MODULUS: &str = r#"stiffness.modulus = { normal = "1 GPa/m", shear = "0.5 GPa/m" }"#;
const PRESSURE: &str = "normal = [-0.05, -0.05]            # down: against the outward normal";
const FORCE: &str = "force = { y = -1.0 }";
const FACTORS: &str = "factors = { to = 1.0, steps = 4 }";
const ZONE_AND_SUPPORT: &str = "[[zone]]
contact = \"mortar\"
strip = { y = [0.0, 2.0] }

[[support]]";
const SIDE_AND_CONTACT: &str = "[side.top]
contact = \"mortar\"
reach = 0.1

[contact.";
const SIDE_AND_LOAD: &str = "[side.top]
contact = \"mortar\"

[[load]]";

fn furnish(room: &Path) {
    for block in blocks(SCENE_FILE) {
        write(&block, room);
    }
    for Mistake(file, changes) in MISTAKES {
        fs::write(room.join(file), changed(&room.join("block.toml"), changes)).expect("a scene");
    }
    let large = room.join("scenes/disordered-block.toml");
    fs::copy(large, room.join("large.toml")).expect("a scene");
    fs::create_dir_all(room.join(".local/share/bash-completion/completions")).expect("a folder");
}

/// The text of a scene with changes.
fn changed(scene: &Path, changes: &[(&str, &str)]) -> String {
    let scene = fs::read_to_string(scene).expect("a scene");
    changes.iter().fold(scene, |scene, (from, to)| {
        assert!(scene.contains(from), "{from}");
        scene.replacen(from, to, 1)
    })
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
