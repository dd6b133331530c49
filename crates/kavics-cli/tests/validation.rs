//! Every folder of `validation/`: its scenes run by the command, its `expected.csv` held against their tables.

mod support;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use support::expected::Row;
use support::{Run, workspace};

/// A test for each folder; `_` stands for `-`.
macro_rules! cases {
    ($($name:ident),* $(,)?) => {
        $(#[test] fn $name() { check_case(stringify!($name)); })*
        const CASES: &[&str] = &[$(stringify!($name)),*];
    };
}

cases!(
    block_32_reference,
    block_32_table,
    brazilian_disc,
    chain_cantilever,
    contact_cycles,
    cut_identities,
    dropped_packing,
    friction_limits,
    hexagonal_lattice,
    iteration_order,
    patch_test,
    rigid_motion,
    square_lattice,
    tessellation,
    three_discs,
    unloading,
    voigt_bound,
);

#[test]
fn every_folder_is_a_case() {
    let mut found: Vec<String> = fs::read_dir(workspace().join("validation"))
        .expect("validation/")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.is_dir())
        .map(|path| {
            path.file_name()
                .unwrap()
                .to_string_lossy()
                .replace('-', "_")
        })
        .collect();
    found.sort();
    let mut cases = CASES.to_vec();
    cases.sort_unstable();
    assert_eq!(found, cases);
}

fn check_case(name: &str) {
    let folder = workspace().join("validation").join(name.replace('_', "-"));
    assert!(
        folder.join("README.md").is_file(),
        "{name} has no README.md"
    );
    let runs = runs(&folder);
    let expected = fs::read_to_string(folder.join("expected.csv")).expect("expected.csv");
    let rows: Vec<Row> = expected
        .lines()
        .skip(1)
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
        .map(Row::parse)
        .collect();
    for row in &rows {
        assert!(runs.contains_key(row.run), "no run is called {}", row.run);
    }
    for name in runs.keys() {
        let used = rows.iter().any(|row| row.run == name);
        assert!(used, "nothing is expected of run {name}");
    }
    let wrong: Vec<String> = rows
        .iter()
        .filter_map(|row| row.check(&runs).err())
        .collect();
    let texts: Vec<&str> = runs
        .values()
        .filter(|run| run.status != 0)
        .map(|run| run.stderr.as_str())
        .collect();
    assert!(
        wrong.is_empty(),
        "{name}\n{}\n{}",
        wrong.join("\n"),
        texts.join("\n")
    );
}

/// The runs of `runs.csv`: name, task, scene, values that are set; without it every scene of the folder as it is.
fn runs(folder: &Path) -> BTreeMap<String, Run> {
    let Ok(list) = fs::read_to_string(folder.join("runs.csv")) else {
        return scenes(folder)
            .into_iter()
            .map(|scene| {
                let name = scene.file_stem().unwrap().to_string_lossy().into_owned();
                (name, Run::of("run", &scene, &[]))
            })
            .collect();
    };
    list.lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<&str> = line.splitn(4, ',').map(str::trim).collect();
            let [name, task, scene, values] = cells[..] else {
                panic!("four cells expected: {line}");
            };
            let set = values.split_whitespace().flat_map(|value| ["--set", value]);
            let run = Run::of(task, &folder.join(scene), &set.collect::<Vec<_>>());
            (name.to_owned(), run)
        })
        .collect()
}

fn scenes(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut scenes: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|end| end == "toml"))
        .collect();
    scenes.sort();
    scenes
}
