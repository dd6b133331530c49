//! Scenes run by the command, and what they leave behind.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use kavics_results::{Columns, ResultsFolder, RunState};

/// A cemented block of 32 discs under vertical compression.
const BLOCK: &str = r#"
title = "Block of 32 discs"

[box]
width = 10.0
height = 12.4

[grains.hexagonal]
radius = 1.0
rows = [5, 4, 5, 4, 5, 4, 5]

[contact.mortar.cemented]
stiffness.layer = { normal = 3000.0, shear = 1650.0 }
strength.stress = { tension = 30.0 }

[[zone]]
contact = "mortar"

[[support]]
grains = { edge = "bottom" }
fix = ["y"]
[[support]]
grains = { ids = [2] }
fix = ["x"]

[[load]]
name = "traffic"
edge = "top"
normal = [-30.0, -30.0]

[[stage]]
name = "compression"
factors = [1.0, 1.2, 1.4]
"#;

/// The same with bonds so weak that the block falls apart.
const WEAK: &str = "contact.mortar.cemented.strength.stress={ tension = 0.1, shear = 0.1 }";

fn place_with(scene: &str) -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("a temporary folder");
    fs::write(place.path().join("block.toml"), scene).expect("room on the disk");
    place
}

fn kavics(place: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::cargo_bin("kavics").expect("the command is built");
    command.current_dir(place).args(arguments);
    command.output().expect("the command runs")
}

fn status(output: &Output) -> i32 {
    output.status.code().expect("no signal")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn names(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).expect("a folder").flatten();
    entries
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect()
}

#[test]
fn a_run_leaves_the_files_of_the_contract_and_a_report() {
    let place = place_with(BLOCK);
    let output = kavics(place.path(), &["run", "block.toml"]);
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    let results = place.path().join("block.results");
    let files = [
        "actions.parquet",
        "contacts",
        "events.parquet",
        "grains",
        "log.ndjson",
        "report.html",
        "run.json",
        "scene.toml",
        "sides",
        "steps.parquet",
    ];
    assert_eq!(names(&results), files.map(str::to_owned).into());
    assert!(text(&output.stderr).ends_with("report: block.results/report.html\n"));
    assert!(output.stdout.is_empty());
}

#[test]
fn a_summary_fits_into_eighty_columns() {
    let place = place_with(BLOCK);
    let output = kavics(place.path(), &["run", "block.toml"]);
    for line in text(&output.stderr).lines() {
        assert!(line.chars().count() <= 80, "{line}");
    }
}

#[test]
fn a_json_line_is_written_for_each_load_step() {
    let place = place_with(BLOCK);
    let output = kavics(place.path(), &["run", "block.toml", "--json"]);
    let lines = text(&output.stdout);
    let steps: Vec<serde_json::Value> = lines
        .lines()
        .map(|line| serde_json::from_str(line).expect("a JSON object"))
        .collect();
    let factors: Vec<f64> = steps
        .iter()
        .filter_map(|step| step["load_factor"].as_f64())
        .collect();
    assert_eq!(factors, [1.0, 1.2, 1.4]);
}

#[test]
fn the_number_of_threads_changes_no_table() {
    let place = place_with(BLOCK);
    for threads in ["1", "2"] {
        kavics(
            place.path(),
            &["run", "block.toml", "--threads", threads, "-o", threads],
        );
    }
    for table in [
        "steps.parquet",
        "events.parquet",
        "grains/000003.parquet",
        "contacts/000003.parquet",
    ] {
        let [one, two] = ["1", "2"].map(|folder| fs::read(place.path().join(folder).join(table)));
        assert_eq!(one.expect("a table"), two.expect("a table"), "{table}");
    }
}

#[test]
fn an_override_stands_in_the_scene_of_the_results() {
    let place = place_with(BLOCK);
    kavics(
        place.path(),
        &["run", "block.toml", "--set", "stage.0.factors=[2.0]"],
    );
    let results = ResultsFolder::open(&place.path().join("block.results")).expect("results");
    assert!(
        results
            .scene()
            .expect("a scene")
            .contains("factors = [2.0]")
    );
    assert_eq!(
        results
            .steps()
            .expect("steps")
            .numbers("load_factor")
            .expect("a column"),
        [2.0]
    );
}

#[test]
fn a_wrong_scene_leaves_nothing_behind() {
    let place = place_with(&BLOCK.replace("radius = 1.0", "radius = -1.0"));
    let output = kavics(place.path(), &["run", "block.toml"]);
    assert_eq!(status(&output), 2);
    assert_eq!(names(place.path()), ["block.toml".to_owned()].into());
}

#[test]
fn finished_results_are_replaced_by_force_alone() {
    let place = place_with(BLOCK);
    kavics(place.path(), &["run", "block.toml"]);
    let again = ["run", "block.toml", "--set", "stage.0.factors=[2.0]"];
    assert_eq!(status(&kavics(place.path(), &again)), 2);
    let steps = || Columns::read(&place.path().join("block.results/steps.parquet")).expect("steps");
    assert_eq!(steps().len(), 3);
    assert_eq!(
        status(&kavics(place.path(), &[&again[..], &["--force"]].concat())),
        0
    );
    assert_eq!(steps().len(), 1);
}

#[test]
fn without_equilibrium_the_results_so_far_are_kept() {
    let place = place_with(BLOCK);
    let output = kavics(place.path(), &["run", "block.toml", "--set", WEAK]);
    assert_eq!(status(&output), 3, "{}", text(&output.stderr));
    let results = place.path().join("block.results");
    let record = ResultsFolder::open(&results).and_then(|folder| folder.record());
    assert_eq!(record.expect("run.json").state, RunState::NoEquilibrium);
    assert!(results.join("report.html").is_file());
    assert!(
        text(&output.stderr).contains("the results in block.results are valid up to load step")
    );
}

#[test]
fn measuring_again_in_the_same_window_gives_the_same_table() {
    let place = place_with(BLOCK);
    kavics(place.path(), &["run", "block.toml"]);
    let output = kavics(
        place.path(),
        &["measure", "block.results", "-o", "again.parquet"],
    );
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    let read = |name: &str| fs::read(place.path().join(name)).expect("a table");
    assert_eq!(read("again.parquet"), read("block.results/steps.parquet"));
}

#[test]
fn measuring_in_another_window_changes_its_area() {
    let place = place_with(BLOCK);
    kavics(place.path(), &["run", "block.toml"]);
    for (window, file) in [
        ("all", "all.parquet"),
        ("{ ids = [14, 15] }", "two.parquet"),
    ] {
        let output = kavics(
            place.path(),
            &["measure", "block.results", "--window", window, "-o", file],
        );
        assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    }
    let area = |name: &str| {
        let table = Columns::read(&place.path().join(name)).expect("a table");
        table.numbers("window_area").expect("a column")[0]
    };
    // The cells of all grains tile the box, 10 by 12.4.
    assert!((area("all.parquet") - 124.0).abs() < 1e-9);
    assert!(area("two.parquet") < 10.0);
}

#[test]
fn iterates_are_written_when_asked_for() {
    let place = place_with(BLOCK);
    let every = "measure.every=iteration";
    let output = kavics(place.path(), &["run", "block.toml", "--set", every]);
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    let path = place.path().join("block.results/iterations.parquet");
    let iterates = Columns::read(&path).expect("a table");
    let steps = Columns::read(&place.path().join("block.results/steps.parquet")).expect("a table");
    let solves: f64 = steps.numbers("iterations").expect("a column").iter().sum();
    assert_eq!(iterates.len() as f64, solves);
    assert!(iterates.integers("iteration").is_ok());
}

#[test]
fn check_says_what_would_run() {
    let place = place_with(BLOCK);
    let output = kavics(place.path(), &["check", "block.toml"]);
    insta::assert_snapshot!(text(&output.stdout));
    assert_eq!(names(place.path()), ["block.toml".to_owned()].into());
}

#[test]
fn a_pack_is_summed_up_in_eighty_columns() {
    let dropped = "seed = 1\n[box]\nwidth = 40.0\nheight = \"fit\"\n[grains.dropped]\ncount = 400\n\
                   sieve = { diameter = [1.0, 2.0, 4.0], passing = [0.0, 0.6, 1.0] }\n";
    let mut all = String::new();
    for scene in [BLOCK, dropped] {
        let place = place_with(scene);
        let output = kavics(place.path(), &["pack", "block.toml", "--summary"]);
        assert_eq!(status(&output), 0, "{}", text(&output.stderr));
        all += &text(&output.stdout);
        all.push('\n');
    }
    assert!(all.lines().all(|line| line.chars().count() <= 80));
    insta::assert_snapshot!(all);
}

#[test]
fn a_written_pack_can_be_listed() {
    let place = place_with(BLOCK);
    for file in ["pack.csv", "pack.parquet", "pack2.CSV"] {
        let output = kavics(place.path(), &["pack", "block.toml", "-o", file]);
        assert_eq!(status(&output), 0, "{}", text(&output.stderr));
        let listed = BLOCK.replace(
            "[grains.hexagonal]\nradius = 1.0\nrows = [5, 4, 5, 4, 5, 4, 5]",
            &format!("[grains.listed]\nfile = \"{file}\""),
        );
        fs::write(place.path().join("listed.toml"), listed).expect("room on the disk");
        let run = kavics(place.path(), &["run", "listed.toml", "--force"]);
        assert_eq!(status(&run), 0, "{}", text(&run.stderr));
        let measured = kavics(place.path(), &["measure", "listed.results"]);
        assert_eq!(status(&measured), 0, "{}", text(&measured.stderr));
    }
}

#[test]
fn a_compared_table_stands_in_the_summary() {
    let place = place_with(&format!("{BLOCK}\n[compare]\nfile = \"table.csv\"\n"));
    let table = "# made up\nload_factor,stress_yy\n1.2,-36.0\n";
    fs::write(place.path().join("table.csv"), table).expect("room on the disk");
    let output = kavics(place.path(), &["run", "block.toml"]);
    let summary = text(&output.stderr);
    assert_eq!(status(&output), 0, "{summary}");
    assert!(summary.contains("# made up"), "{summary}");
    assert!(summary.contains("-36.000000"), "{summary}");
}

#[test]
fn force_replaces_nothing_that_the_run_needs_or_the_user_wrote() {
    let place = place_with(BLOCK);
    let results = place.path().join("block.results");
    assert_eq!(status(&kavics(place.path(), &["run", "block.toml"])), 0);
    let before = names(&results);
    let scene = ["run", "block.results/scene.toml", "--force"];
    let own = kavics(
        place.path(),
        &[&scene[..], &["-o", "block.results"]].concat(),
    );
    assert_eq!(status(&own), 2, "{}", text(&own.stderr));
    let here = kavics(&results, &["run", "../block.toml", "--force", "-o", "."]);
    assert_eq!(status(&here), 2, "{}", text(&here.stderr));
    assert_eq!(names(&results), before);
    fs::write(results.join("notes.txt"), "all of it").expect("room on the disk");
    let forced = kavics(place.path(), &["run", "block.toml", "--force"]);
    assert_eq!(status(&forced), 2, "{}", text(&forced.stderr));
    assert!(text(&forced.stderr).contains("notes.txt"));
    assert!(results.join("steps.parquet").is_file());
}

#[test]
fn the_scene_of_the_results_runs_again() {
    let listed = BLOCK.replace(
        "[grains.hexagonal]\nradius = 1.0\nrows = [5, 4, 5, 4, 5, 4, 5]",
        "[grains.listed]\nfile = \"pack.csv\"",
    );
    let place = place_with(BLOCK);
    kavics(place.path(), &["pack", "block.toml", "-o", "pack.csv"]);
    let listed = format!("{listed}\n[compare]\nfile = \"table.csv\"\n");
    fs::write(place.path().join("listed.toml"), listed).expect("room on the disk");
    let table = "load_factor,stress_yy\n1.2,-36.0\n";
    fs::write(place.path().join("table.csv"), table).expect("room on the disk");
    for arguments in [
        ["run", "listed.toml", "-o", "one"],
        ["run", "one/scene.toml", "-o", "two"],
    ] {
        let run = kavics(place.path(), &arguments);
        assert_eq!(status(&run), 0, "{}", text(&run.stderr));
    }
    for file in ["scene.toml", "steps.parquet", "compare.csv"] {
        let [one, two] =
            ["one", "two"].map(|folder| fs::read(place.path().join(folder).join(file)));
        assert_eq!(one.expect("a file"), two.expect("a file"), "{file}");
    }
}

fn compared(place: &Path, table: &str) -> Output {
    fs::write(place.join("table.csv"), table).expect("room on the disk");
    kavics(place, &["run", "block.toml", "--force"])
}

#[test]
fn a_table_that_cannot_be_compared_ends_before_the_run() {
    let place = place_with(&format!("{BLOCK}\n[compare]\nfile = \"table.csv\"\n"));
    for (table, reason) in [
        (
            "load_factor,stress_yy\n1.2,abc\n",
            "table.csv: line 2, column `stress_yy`: \"abc\" is not a number",
        ),
        ("pressure\n1.0\n", "table.csv: no column has the name"),
    ] {
        let output = compared(place.path(), table);
        let message = text(&output.stderr);
        assert_eq!(status(&output), 2, "{message}");
        assert!(message.contains(reason), "{message}");
        assert!(message.contains("--> block.toml:36:8"), "{message}");
        assert!(!place.path().join("block.results").exists());
    }
}

#[test]
fn rows_and_columns_that_are_not_compared_are_in_the_record() {
    let place = place_with(&format!("{BLOCK}\n[compare]\nfile = \"table.csv\"\n"));
    let output = compared(
        place.path(),
        "load_factor,stress_yy,stres_xx\n1.2,-36.0,1.0\n7.0,1.0,1.0\n",
    );
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    let results = ResultsFolder::open(&place.path().join("block.results")).expect("results");
    let warnings = results.record().expect("run.json").warnings.join("\n");
    assert!(warnings.contains("`stres_xx`"), "{warnings}");
    assert!(warnings.contains("line 3 has no load step"), "{warnings}");
}

#[test]
fn places_in_messages_are_those_of_the_file_or_of_the_command() {
    let place = place_with(&BLOCK.replace("fix = [\"x\"]", "fixx = [\"x\"]"));
    let tolerance = "equilibrium.tolernce=1";
    let output = kavics(
        place.path(),
        &["check", "block.toml", "--set", "thickness=2.0"],
    );
    assert!(
        text(&output.stderr).contains("--> block.toml:24:1"),
        "{}",
        text(&output.stderr)
    );
    fs::write(place.path().join("block.toml"), BLOCK).expect("room on the disk");
    let output = kavics(place.path(), &["check", "block.toml", "--set", tolerance]);
    let message = text(&output.stderr);
    assert!(
        message.contains("--> --set equilibrium.tolernce=1"),
        "{message}"
    );
    assert!(!message.contains("block.toml"), "{message}");
}

#[test]
fn a_reader_of_json_that_leaves_does_not_end_the_run() {
    let place = place_with(BLOCK);
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("kavics"));
    let mut run = command
        .current_dir(place.path())
        .args(["run", "block.toml", "--json"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::null())
        .spawn()
        .expect("the command runs");
    drop(run.stdout.take());
    assert!(run.wait().expect("the command runs").success());
    let results = place.path().join("block.results");
    let record = ResultsFolder::open(&results).and_then(|folder| folder.record());
    assert_eq!(record.expect("run.json").state, RunState::Done);
    assert!(results.join("report.html").is_file());
}

#[test]
fn both_tables_of_the_summary_say_their_power_of_ten() {
    let place = place_with(BLOCK);
    let small = "load.0.normal=[-3e-5, -3e-5]";
    let output = kavics(place.path(), &["run", "block.toml", "--set", small]);
    let summary = text(&output.stderr);
    assert_eq!(
        summary.matches("(stresses in 1e-6)").count(),
        2,
        "{summary}"
    );
}

#[test]
fn a_list_with_another_ending_is_refused() {
    let listed = BLOCK.replace(
        "[grains.hexagonal]\nradius = 1.0\nrows = [5, 4, 5, 4, 5, 4, 5]",
        "[grains.listed]\nfile = \"pack.txt\"",
    );
    let place = place_with(&listed);
    fs::write(place.path().join("pack.txt"), "x,y,radius\n").expect("room on the disk");
    let output = kavics(place.path(), &["check", "block.toml"]);
    assert_eq!(status(&output), 2);
    let message = text(&output.stderr);
    assert!(message.contains("ends in .csv, .parquet"), "{message}");
}

#[test]
fn results_that_lack_a_table_are_not_reported() {
    let place = place_with(BLOCK);
    kavics(place.path(), &["run", "block.toml"]);
    let table = place.path().join("block.results/grains/000003.parquet");
    fs::remove_file(table).expect("a table");
    for task in ["report", "measure"] {
        let output = kavics(place.path(), &[task, "block.results"]);
        assert_eq!(status(&output), 4);
        let message = text(&output.stderr);
        assert!(
            message.contains("grains/000003.parquet is missing"),
            "{message}"
        );
    }
}

#[test]
fn measuring_a_run_that_is_not_finished_says_so() {
    let place = place_with(BLOCK);
    kavics(place.path(), &["run", "block.toml"]);
    let path = place.path().join("block.results/run.json");
    let record = fs::read_to_string(&path).expect("run.json");
    let running = record.replace("\"done\"", "\"running\"");
    fs::write(&path, running).expect("room on the disk");
    let output = kavics(place.path(), &["measure", "block.results"]);
    assert_eq!(status(&output), 0);
    let said = text(&output.stderr);
    let words: Vec<&str> = said.split_whitespace().collect();
    assert!(
        words.join(" ").contains("tables end with load step 3"),
        "{said}"
    );
}
