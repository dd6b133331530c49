//! docs/tutorial.md and README.md are followed as a reader would: the files shown are written, the commands run, in their
//! order, and they say what stands there.
//!
//! Commands of Python are passed over where there is no Python with pandas.
#![cfg(all(unix, feature = "view"))]

mod shown;

use std::process::{Command, Stdio};

use shown::{blocks, commands, line_matches, lines_match, room, shown, write};

const TUTORIAL: &str = include_str!("../../../docs/tutorial.md");
const README: &str = include_str!("../../../README.md");

fn has_pandas() -> bool {
    let mut python = Command::new("python3");
    python.args(["-c", "import pandas, pyarrow"]);
    python
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|s| s.success())
}

#[test]
fn the_tutorial_can_be_followed() {
    let (room, pandas) = (room(), has_pandas());
    for block in blocks(TUTORIAL) {
        write(&block, room.path());
        if block.language != "console" {
            continue;
        }
        for shown in shown(&block) {
            if shown.command.starts_with("python3") && !pandas {
                eprintln!("passed over, no python3 with pandas: {}", shown.command);
                continue;
            }
            shown.follow(room.path());
        }
    }
}

#[test]
fn the_commands_of_the_readme_work() {
    let (room, commands) = (room(), commands(README));
    for shown in &commands {
        shown.follow(room.path());
    }
    assert!(commands.len() > 5);
}

#[test]
fn every_block_of_the_tutorial_is_used() {
    for block in blocks(TUTORIAL) {
        let used = block.file.is_some() || block.language == "console";
        assert!(used, "{}", block.lines.join("\n"));
    }
}

#[test]
fn left_out_lines_and_words_are_passed_over() {
    assert!(line_matches("step … of …", "step 1 of 10"));
    assert!(!line_matches("step … of 9", "step 1 of 10"));
    assert!(lines_match(&["a", "…", "d"], &["a", "b", "c", "d"]));
    assert!(!lines_match(&["a", "d"], &["a", "b", "d"]));
    assert!(!lines_match(&["a"], &["a", "b"]));
}
