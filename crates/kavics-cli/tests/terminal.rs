//! What stands on a terminal, and what stands where there is none.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const SCENE: &str = r#"
[box]
width = 10.0
height = 12.4

[grains.hexagonal]
radius = 1.0
rows = [5, 4, 5, 4, 5, 4, 5]

[contact.mortar.cemented]
stiffness.layer = { normal = 3000.0, shear = 1650.0 }

[[support]]
grains = { edge = "bottom" }
fix = ["x", "y"]

[[load]]
name = "traffic"
edge = "top"
normal = [-3e7, -3e7]

[[stage]]
factors = [1.0, 1.2, -250.0]

[measure]
window = "all"
"#;

fn place() -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("a temporary folder");
    fs::write(place.path().join("block.toml"), SCENE).expect("room");
    place
}

fn kavics(place: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kavics"));
    command.current_dir(place).args(arguments);
    command.output().expect("the command runs")
}

/// What a terminal of 80 columns shows, escapes and all; none where `script` is not installed.
fn on_a_terminal(place: &Path, environment: &str, arguments: &str) -> Option<String> {
    let line = format!(
        "stty cols 80; {environment} {} {arguments}",
        env!("CARGO_BIN_EXE_kavics")
    );
    let mut script = Command::new("script");
    script.args(["-qec", &line, "/dev/null"]).current_dir(place);
    script.env_remove("NO_COLOR").env("TERM", "xterm");
    let shown = script.output().ok()?;
    Some(String::from_utf8_lossy(&shown.stdout).into_owned())
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("text in UTF-8")
}

/// Columns of the widest line, escapes not counted.
fn widest(text: &str) -> usize {
    let columns = |line: &str| {
        let mut escaped = false;
        let visible = line.chars().filter(|letter| {
            let hidden = escaped || *letter == '\u{1b}';
            escaped = hidden && !letter.is_ascii_alphabetic();
            !hidden
        });
        visible.count()
    };
    let lines = text.split(['\n', '\r']);
    lines.map(columns).max().unwrap_or(0)
}

#[test]
fn a_summary_fits_into_eighty_columns_and_has_no_escapes() {
    let place = place();
    let said = stderr(&kavics(place.path(), &["run", "block.toml"]));
    assert!(!said.contains('\u{1b}'), "{said}");
    let tables = said.lines().filter(|line| !line.starts_with("warning"));
    let tables: Vec<&str> = tables.collect();
    assert!(widest(&tables.join("\n")) <= 80, "{said}");
    assert!(said.contains("3 load steps"), "{said}");
}

#[test]
fn quiet_says_nothing_but_errors() {
    let place = place();
    let done = kavics(place.path(), &["run", "block.toml", "-q"]);
    assert!(done.status.success());
    assert_eq!(stderr(&done), "");
    let again = kavics(place.path(), &["run", "block.toml", "--quiet"]);
    assert!(stderr(&again).contains("exists already"));
}

#[test]
fn verbose_says_what_each_load_step_took() {
    let place = place();
    let said = stderr(&kavics(place.path(), &["run", "block.toml", "-v"]));
    assert!(said.contains("step 2: factor 1.2"), "{said}");
    assert!(said.contains("linear solves"), "{said}");
    assert!(said.contains("direct"), "{said}");
}

#[test]
fn quiet_and_verbose_are_not_both() {
    let place = place();
    let both = kavics(place.path(), &["check", "block.toml", "-q", "-v"]);
    assert_eq!(both.status.code(), Some(2));
}

#[test]
fn json_of_a_check_is_one_object() {
    let place = place();
    let checked = kavics(place.path(), &["check", "block.toml", "--json"]);
    let object: serde_json::Value = serde_json::from_slice(&checked.stdout).expect("a JSON object");
    assert_eq!(object["grains"], 32);
    assert_eq!(object["steps"], 3);
}

#[test]
fn a_terminal_shows_colours_and_a_line_of_progress_that_fits() {
    let place = place();
    let Some(shown) = on_a_terminal(place.path(), "", "run block.toml") else {
        return;
    };
    assert!(
        shown.contains("\u{1b}[1m\u{1b}[33mwarning") || shown.contains("\u{1b}[33m"),
        "{shown}"
    );
    assert!(widest(&shown) <= 80, "{shown}");
}

/// The line of progress still moves the cursor.
#[test]
fn no_color_takes_the_colours_away() {
    let place = place();
    let Some(shown) = on_a_terminal(place.path(), "NO_COLOR=1", "run block.toml") else {
        return;
    };
    assert!(
        !shown.contains("\u{1b}[1m") && !shown.contains("\u{1b}[33m"),
        "{shown:?}"
    );
}

#[test]
fn an_event_driven_load_step_shows_that_it_moves() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let bench = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/bench/fracture-10k.toml");
    let arguments = format!(
        "run {} --set stage.0.factors=[0.6] -o out.results",
        bench.display()
    );
    let Some(shown) = on_a_terminal(place.path(), "", &arguments) else {
        return;
    };
    let progress = shown.split('\r').filter(|line| line.contains("step 1/1"));
    let counts: std::collections::BTreeSet<&str> = progress
        .filter_map(|line| line.split(", ").find(|part| part.ends_with("broken")))
        .collect();
    assert!(counts.len() > 1, "{counts:?}");
    assert!(widest(&shown) <= 80);
}
