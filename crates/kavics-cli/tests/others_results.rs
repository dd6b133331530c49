//! Results that something is wrong with: each gives a sentence and an exit status, never a trace.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Three grains in a heap, the upper one pressed.
const SCENE: &str = r#"
[box]
width = 4.0
height = 4.0

[grains.hexagonal]
radius = 1.0
rows = [2, 1]

[contact.cement.cemented]
stiffness.layer = { normal = 1.0, shear = 0.5 }

[[support]]
grains = { ids = [0, 1] }
fix = ["x", "y"]

[[load]]
name = "press"
grains = { ids = [2] }
force = { y = -0.01 }

[[stage]]
factors = [1.0, 2.0]
"#;

/// The tasks that read all of the results.
const WHOLE: [&[&str]; 2] = [&["measure", "heap.results"], &["report", "heap.results"]];

/// The tasks that read results, if only some.
const EVERY: [&[&str]; 4] = [
    &["measure", "heap.results"],
    &["report", "heap.results"],
    &["draw", "heap.results", "-o", "forces.svg"],
    &["export", "heap.results", "--to", "vtp"],
];

fn kavics(place: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kavics"));
    command.current_dir(place).args(arguments);
    command.output().expect("the command runs")
}

fn finished(scene: &str) -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("a temporary folder");
    fs::write(place.path().join("heap.toml"), scene).expect("room");
    let done = kavics(place.path(), &["run", "heap.toml", "-q"]);
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    place
}

/// The tasks answer with `status` and a sentence that holds `words`.
fn all_say(tasks: &[&[&str]], place: &Path, status: i32, words: &str) {
    for task in tasks {
        let done = kavics(place, task);
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        assert_eq!(done.status.code(), Some(status), "{task:?}: {said}");
        assert!(said.contains(words), "{task:?}: {said}");
        assert!(
            !said.contains("panicked") && said.lines().count() <= 3,
            "{task:?}: {said}"
        );
    }
}

fn change(place: &Path, file: &str, change: impl FnOnce(Vec<u8>) -> Vec<u8>) {
    let path = place.join("heap.results").join(file);
    let bytes = fs::read(&path).expect("a file of the results");
    fs::write(&path, change(bytes)).expect("room");
}

#[test]
fn there_is_nothing() {
    let place = tempfile::tempdir().expect("a temporary folder");
    all_say(&EVERY, place.path(), 4, "heap.results: No such file");
}

#[test]
fn a_file_stands_in_place_of_the_folder() {
    let place = tempfile::tempdir().expect("a temporary folder");
    fs::write(place.path().join("heap.results"), "results").expect("room");
    all_say(
        &EVERY,
        place.path(),
        2,
        "heap.results is not a results folder",
    );
}

#[test]
fn a_newer_version_wrote_the_tables() {
    let place = finished(SCENE);
    change(place.path(), "run.json", |bytes| {
        let text = String::from_utf8(bytes).expect("text");
        text.replace("\"schema_version\": 1", "\"schema_version\": 2")
            .into_bytes()
    });
    all_say(&EVERY, place.path(), 4, "tables of version 2");
}

/// Of versions before the first there is none; they had no `packing` in their record.
#[test]
fn an_older_version_wrote_the_tables() {
    let place = finished(SCENE);
    change(place.path(), "run.json", |bytes| {
        let text = String::from_utf8(bytes).expect("text");
        let text = text.replace("\"schema_version\": 1", "\"schema_version\": 0");
        let packing = text.find(",\n  \"packing\"").expect("a packing");
        format!("{}\n}}\n", &text[..packing]).into_bytes()
    });
    let [measure, report, draw, export] = EVERY;
    for task in [measure, report] {
        let done = kavics(place.path(), task);
        let said = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success(), "{task:?}: {said}");
    }
    all_say(
        &[draw, export],
        place.path(),
        4,
        "run.json keeps no container",
    );
}

#[test]
fn the_record_is_no_json() {
    let place = finished(SCENE);
    change(place.path(), "run.json", |bytes| {
        bytes[..bytes.len() / 2].to_vec()
    });
    all_say(&EVERY, place.path(), 4, "run.json");
}

#[test]
fn half_of_the_folder_is_there() {
    let record = "[record]\nvoids = true\ncracks = true\n[measure]\nstability = 1\n";
    for table in [
        "grains/000000.parquet",
        "grains/000001.parquet",
        "grains/000002.parquet",
        "contacts/000001.parquet",
        "contacts/000002.parquet",
        "sides/000002.parquet",
        "voids/000001.parquet",
        "cracks/000002.parquet",
        "modes/000001.parquet",
        "steps.parquet",
    ] {
        let place = finished(&format!("{SCENE}{record}"));
        fs::remove_file(place.path().join("heap.results").join(table)).expect("the table");
        all_say(&EVERY, place.path(), 4, table);
    }
}

/// What a run that is under way, or was killed, has not recorded yet is not missing; what comes before its last row is.
#[test]
fn an_unfinished_run_lacks_only_what_it_had_recorded() {
    let place = finished(SCENE);
    change(place.path(), "run.json", |bytes| {
        let text = String::from_utf8(bytes).expect("text");
        text.replace("\"done\"", "\"running\"").into_bytes()
    });
    let shorter = finished(&SCENE.replace("factors = [1.0, 2.0]", "factors = [1.0]"));
    let steps = "heap.results/steps.parquet";
    fs::copy(shorter.path().join(steps), place.path().join(steps)).expect("room");
    let remove = |table: &str| {
        fs::remove_file(place.path().join("heap.results").join(table)).expect("the table");
    };
    remove("sides/000002.parquet");
    for task in EVERY {
        let done = kavics(place.path(), task);
        let said = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success(), "{task:?}: {said}");
    }
    remove("contacts/000001.parquet");
    all_say(
        &EVERY,
        place.path(),
        4,
        "contacts/000001.parquet is missing",
    );
}

/// Tables of another load step, or of other grains, that stand in the place of a recorded one.
#[test]
fn a_table_was_put_in_the_place_of_another() {
    let others = finished(&SCENE.replace("radius = 1.0", "radius = 0.9"));
    let larger = SCENE.replace("rows = [2, 1]", "rows = [1, 2, 1]");
    let larger = finished(&larger.replace("height = 4.0", "height = 8.0"));
    for table in ["grains", "contacts"] {
        for (from, of) in [
            (None, 1),
            (Some(&others), 2),
            (Some(&larger), 2),
            (Some(&larger), 0),
        ] {
            let place = finished(SCENE);
            let from = from.unwrap_or(&place).path().join("heap.results");
            let name = |step| format!("{table}/{step:06}.parquet");
            let to = if of == 0 { 0 } else { 2 };
            let copied = fs::copy(
                from.join(name(of)),
                place.path().join("heap.results").join(name(to)),
            );
            copied.expect("room");
            all_say(&EVERY, place.path(), 4, &name(to));
            all_say(&EVERY, place.path(), 4, "it was put there from elsewhere");
        }
    }
}

#[test]
fn the_grains_folder_is_gone() {
    let place = finished(SCENE);
    fs::remove_dir_all(place.path().join("heap.results/grains")).expect("the tables");
    all_say(&WHOLE, place.path(), 4, "grains");
}

#[test]
fn a_table_is_cut_short() {
    for table in [
        "steps.parquet",
        "grains/000002.parquet",
        "contacts/000002.parquet",
    ] {
        let place = finished(SCENE);
        change(place.path(), table, |bytes| {
            bytes[..bytes.len() / 2].to_vec()
        });
        all_say(&WHOLE, place.path(), 4, table);
    }
}

/// Wherever a bit of a table has turned, the answer is a sentence or the numbers that were found, never a trace and never other
/// numbers.
#[test]
fn a_table_with_a_turned_bit_gives_a_sentence() {
    let place = finished(SCENE);
    let measured = kavics(place.path(), &["measure", "heap.results"]).stdout;
    for table in ["contacts/000002.parquet", "steps.parquet"] {
        let path = place.path().join("heap.results").join(table);
        let whole = fs::read(&path).expect("the table");
        for part in 0..24 {
            let mut bytes = whole.clone();
            let at = part * (whole.len() - 1) / 23;
            bytes[at] ^= 0x10;
            fs::write(&path, bytes).expect("room");
            let done = kavics(place.path(), &["measure", "heap.results"]);
            let said = String::from_utf8_lossy(&done.stderr).into_owned();
            match done.status.code() {
                Some(0) => assert!(done.stdout == measured, "byte {at} of {table}"),
                status => assert_eq!(status, Some(4), "byte {at} of {table}: {said}"),
            }
            assert!(!said.contains("panicked"), "byte {at} of {table}: {said}");
            assert!(done.status.success() || said.contains(table), "{said}");
        }
        fs::write(&path, whole).expect("room");
    }
}

#[test]
fn a_window_that_is_wrong_is_blamed_on_the_command() {
    let place = finished(SCENE);
    for window in ["{ x = [5, 1] }", "{ z = [1, 5] }", "nowhere"] {
        let done = kavics(
            place.path(),
            &["measure", "heap.results", "--window", window],
        );
        let said = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(2), "{said}");
        assert!(said.contains(&format!("--> --window {window}")), "{said}");
        assert!(!said.contains("scene.toml"), "{said}");
    }
}

#[test]
fn displacements_that_leave_no_picture_are_refused() {
    let place = finished(SCENE);
    for scale in ["1e300", "-1e9"] {
        let task = ["draw", "heap.results", "-o", "far.svg", "--scale", scale];
        all_say(&[&task], place.path(), 2, "leave no picture");
        assert!(!place.path().join("far.svg").exists());
    }
    let near = ["draw", "heap.results", "-o", "near.svg", "--scale", "10"];
    assert!(kavics(place.path(), &near).status.success());
}

#[test]
fn the_scene_is_another() {
    let place = finished(SCENE);
    change(place.path(), "scene.toml", |bytes| {
        let text = String::from_utf8(bytes).expect("text");
        text.replace("rows = [2, 1]", "rows = [1]")
            .replace("ids = [2]", "ids = [0]")
            .into_bytes()
    });
    let done = kavics(place.path(), &["measure", "heap.results"]);
    assert_eq!(
        done.status.code(),
        Some(2),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
}

#[test]
fn columns_that_are_not_recorded_are_named() {
    let record = "[record]\ngrains = [\"ux\"]\ncontacts = []\n";
    let place = finished(&format!("{SCENE}{record}"));
    let measured = kavics(place.path(), &["measure", "heap.results"]);
    let said = String::from_utf8_lossy(&measured.stderr);
    assert_eq!(measured.status.code(), Some(4));
    assert!(
        said.contains("no column is called") && said.contains("[record]"),
        "{said}"
    );
    let reported = kavics(place.path(), &["report", "heap.results"]);
    assert!(reported.status.success());
    let page = fs::read_to_string(place.path().join("heap.results/report.html")).expect("report");
    assert!(page.contains("the scene does not record the column"));
}

/// What a table leaves out and does not change is read from the state before loading.
#[test]
fn pictures_need_no_column_that_does_not_change() {
    let record = "[record]\ngrains = [\"ux\", \"uy\", \"rotation\", \"state\"]\n\
                  contacts = [\"normal_force\", \"state\"]\n";
    let place = finished(&format!("{SCENE}{record}"));
    let page = fs::read_to_string(place.path().join("heap.results/report.html")).expect("report");
    assert!(page.contains("contact forces at load step 2"));
    assert!(!page.contains("does not record"), "a picture is missing");
}
