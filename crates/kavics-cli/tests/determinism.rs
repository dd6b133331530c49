//! Every scene of the project gives the same bytes: in two runs, in two folders, on one and on two threads.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A scene whose million grains are packed by a test of their own kind.
const ONLY_PACKED: [&str; 1] = ["million"];

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

fn run(scene: &str, place: &Path, threads: &str) -> PathBuf {
    let folder = place.join("out.results");
    fs::create_dir_all(place).expect("a folder");
    let output = Command::new(env!("CARGO_BIN_EXE_kavics"))
        .arg("run")
        .arg(scenes().join(format!("{scene}.toml")))
        .args(["-q", "-o", "out.results", "--threads", threads])
        .current_dir(place)
        .output()
        .expect("the program");
    let said = String::from_utf8_lossy(&output.stderr);
    // A scene may show that there is no equilibrium.
    assert!(matches!(output.status.code(), Some(0 | 3)), "{said}");
    folder
}

/// All files below a folder, by their names in it.
fn files(folder: &Path) -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    let mut left = vec![folder.to_owned()];
    while let Some(next) = left.pop() {
        for entry in fs::read_dir(next).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                left.push(path);
            } else {
                let name = path.strip_prefix(folder).expect("below the folder");
                found.insert(name.to_owned());
            }
        }
    }
    found
}

fn assert_same(one: &Path, other: &Path, but_for: &[&str]) {
    assert_eq!(files(one), files(other));
    for name in files(one) {
        if but_for.iter().any(|other| name == Path::new(other)) {
            continue;
        }
        let bytes = |folder: &Path| fs::read(folder.join(&name)).expect("a file");
        assert!(bytes(one) == bytes(other), "{} differs", name.display());
    }
}

fn assert_deterministic(scene: &str) {
    let room = tempfile::tempdir().expect("a folder");
    let one = run(scene, &room.path().join("one"), "1");
    let again = run(scene, &room.path().join("again"), "1");
    assert_same(&one, &again, &["log.ndjson"]);
    let two = run(scene, &room.path().join("two"), "2");
    // The number of threads stands in the record, and in the report with it.
    assert_same(&one, &two, &["log.ndjson", "run.json", "report.html"]);
}

macro_rules! deterministic {
    ($($name:ident: $scene:literal),* $(,)?) => {
        $(#[test] fn $name() { assert_deterministic($scene); })*

        #[test]
        fn no_scene_is_left_out() {
            let there = fs::read_dir(scenes()).expect("the scenes");
            let paths = there.map(|entry| entry.expect("an entry").path());
            let scenes = paths.filter(|path| path.extension().is_some_and(|e| e == "toml"));
            let names = scenes.map(|path| path.file_stem().expect("a name").to_owned());
            let names: BTreeSet<String> = names.map(|n| n.to_string_lossy().into_owned()).collect();
            let known: BTreeSet<String> = [$($scene),*].into_iter().chain(ONLY_PACKED).map(str::to_owned).collect();
            assert_eq!(names, known);
        }
    };
}

deterministic! {
    scene_advancing_front: "advancing-front",
    scene_biaxial: "biaxial",
    scene_block_32: "block-32",
    scene_brazilian: "brazilian",
    scene_cantilever: "cantilever",
    scene_disordered_block: "disordered-block",
    scene_dropped_1000: "dropped-1000",
    scene_fibre_bundle: "fibre-bundle",
    scene_hopper: "hopper",
    scene_layers: "layers",
    scene_oedometer: "oedometer",
    scene_patch: "patch",
    scene_polygon: "polygon",
    scene_sandbox: "sandbox",
    scene_sandbox_dropped: "sandbox-dropped",
    scene_shear: "shear",
    scene_softening: "softening",
    scene_stability: "stability",
    scene_target: "target",
    scene_tension: "tension",
    scene_three_discs: "three-discs",
}

#[test]
fn a_million_grains_are_packed_alike() {
    let room = tempfile::tempdir().expect("a folder");
    let pack = |threads: &str| {
        let file = room.path().join(format!("{threads}.parquet"));
        let status = Command::new(env!("CARGO_BIN_EXE_kavics"))
            .arg("pack")
            .arg(scenes().join("million.toml"))
            .args(["-q", "--threads", threads, "-o"])
            .arg(&file)
            .status()
            .expect("the program");
        assert!(status.success());
        fs::read(file).expect("a list of grains")
    };
    assert!(pack("1") == pack("2"));
}
