//! Keeps ARCHITECTURE.md true: a module names only modules upstream of it.

use std::fs;
use std::path::{Path, PathBuf};

/// Module and what it may use, as in the table of ARCHITECTURE.md.
const MAY_USE: [(&str, &[&str]); 11] = [
    ("ids", &[]),
    ("geometry", &[]),
    ("contact_law", &["ids"]),
    ("assembly", &["ids", "geometry"]),
    ("packing", &["ids", "geometry", "assembly"]),
    ("solver", &[]),
    ("warning", &[]),
    (
        "equilibrium",
        &[
            "ids",
            "geometry",
            "assembly",
            "contact_law",
            "solver",
            "warning",
        ],
    ),
    (
        "loading",
        &["ids", "assembly", "contact_law", "solver", "equilibrium"],
    ),
    (
        "measure",
        &["ids", "geometry", "assembly", "contact_law", "equilibrium"],
    ),
    (
        "scene",
        &[
            "ids",
            "geometry",
            "assembly",
            "contact_law",
            "packing",
            "equilibrium",
            "loading",
            "warning",
        ],
    ),
];

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder of sources") {
        let path = entry.expect("a readable entry").path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn source_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// The module that a file belongs to.
fn module(file: &Path) -> String {
    let inner = file
        .strip_prefix(source_folder())
        .expect("a file of this crate");
    let first = inner.iter().next().expect("a name").to_string_lossy();
    first.trim_end_matches(".rs").to_owned()
}

/// The modules of this crate that a text names after `crate::`.
fn named(text: &str) -> Vec<String> {
    let code = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    code.flat_map(|line| line.split("crate::").skip(1))
        .map(|rest| {
            rest.chars()
                .take_while(|c| c.is_alphanumeric() || *c == '_')
                .collect()
        })
        .collect()
}

#[test]
fn a_module_names_only_what_is_upstream() {
    for file in sources(&source_folder()) {
        let module = module(&file);
        let Some((_, allowed)) = MAY_USE.iter().find(|(name, _)| *name == module) else {
            assert_eq!(
                module,
                "lib",
                "{} belongs to no station of the path",
                file.display()
            );
            continue;
        };
        for used in named(&fs::read_to_string(&file).expect("a readable source")) {
            let fine = used == module || allowed.contains(&used.as_str());
            assert!(
                fine,
                "{} names {used}, which is not upstream of {module}",
                file.display()
            );
        }
    }
}

#[test]
fn architecture_md_shows_the_same_table() {
    let page = fs::read_to_string(source_folder().join("../../../ARCHITECTURE.md"))
        .expect("ARCHITECTURE.md");
    for (module, uses) in MAY_USE {
        let uses = if uses.is_empty() {
            "nothing".to_owned()
        } else {
            uses.join(", ")
        };
        let row = page
            .lines()
            .find(|line| line.starts_with(&format!("| `{module}` |")));
        let row = row.unwrap_or_else(|| panic!("ARCHITECTURE.md has no row for {module}"));
        assert!(
            row.trim_end().ends_with(&format!("| {uses} |")),
            "{module}: expected `{uses}` in `{row}`"
        );
    }
}

/// The plane and three freedoms a body may be assumed only where they belong.
#[test]
fn freedoms_are_counted_in_kinematics_alone() {
    for file in sources(&source_folder().join("equilibrium"))
        .into_iter()
        .chain(sources(&source_folder().join("loading")))
    {
        let text = fs::read_to_string(&file).expect("a readable source");
        if !file.ends_with("kinematics.rs") {
            assert!(
                !text.contains("; 3]") && !text.contains("quarter_turn"),
                "{}",
                file.display()
            );
        }
    }
}

#[test]
fn the_library_reads_no_tables_and_parses_no_arguments() {
    let manifest = fs::read_to_string(source_folder().join("../Cargo.toml")).expect("the manifest");
    for heavy in ["arrow", "parquet", "clap", "minijinja"] {
        assert!(
            !manifest.contains(heavy),
            "{heavy} is no dependency of the mechanics"
        );
    }
}
