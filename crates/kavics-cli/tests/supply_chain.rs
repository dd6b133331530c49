//! What the program is built from: licences, registries, versions, and no unsafe code of our own. Read from
//! `cargo metadata`, without a network.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// Licences that leave the user free to do what MIT lets them do.
const LICENCES: [&str; 10] = [
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "Unicode-3.0",
    "Zlib",
];

/// Packages that are there in several versions, with who holds the older one.
#[cfg(target_os = "linux")]
const SEVERAL_VERSIONS: [(&str, &str); 5] = [
    ("equator", "faer's parts"),
    ("equator-macro", "faer's parts"),
    ("getrandom", "dependencies of tests and of hashing"),
    ("miniz_oxide", "pictures as PNG"),
    ("syn", "macros of dependencies"),
];

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The packages that the lock file resolves to on this system, ours and others'.
fn packages() -> Vec<Value> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["metadata", "--offline", "--locked", "--format-version", "1"]);
    // What other systems need may never have been fetched here.
    cargo.args(["--filter-platform", &system()]);
    let answer = cargo.current_dir(workspace()).output().expect("cargo runs");
    let errors = String::from_utf8_lossy(&answer.stderr).into_owned();
    assert!(answer.status.success(), "{errors}");
    let mut metadata: Value = serde_json::from_slice(&answer.stdout).expect("JSON");
    let nodes = metadata["resolve"]["nodes"].as_array().expect("a graph");
    let resolved: BTreeSet<String> = nodes
        .iter()
        .map(|node| text(node, "id").to_owned())
        .collect();
    let Value::Array(mut packages) = metadata["packages"].take() else {
        panic!("no packages");
    };
    packages.retain(|package| resolved.contains(text(package, "id")));
    packages
}

/// The system that this test was built on.
fn system() -> String {
    let answer = Command::new("rustc").arg("-vV").output();
    let answer = String::from_utf8(answer.expect("rustc runs").stdout).expect("text");
    let mut lines = answer.lines();
    let host = lines.find_map(|line| line.strip_prefix("host: "));
    host.expect("a host").to_owned()
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_default()
}

/// Whether a licence expression leaves a choice that is allowed: OR binds less than AND; `/` is an older OR.
fn is_allowed(expression: &str) -> bool {
    let expression = expression.trim();
    let any = parts(expression, &[" OR ", "/"]);
    if any.len() > 1 {
        return any.into_iter().any(is_allowed);
    }
    let all = parts(expression, &[" AND "]);
    if all.len() > 1 {
        return all.into_iter().all(is_allowed);
    }
    let within = expression
        .strip_prefix('(')
        .and_then(|e| e.strip_suffix(')'));
    within.map_or_else(|| LICENCES.contains(&expression), is_allowed)
}

/// The parts of an expression between separators that no parenthesis holds.
fn parts<'a>(expression: &'a str, separators: &[&str]) -> Vec<&'a str> {
    let (mut parts, mut begin, mut depth) = (Vec::new(), 0, 0);
    for (at, letter) in expression.char_indices() {
        match letter {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        let rest = &expression[at..];
        let separator = separators.iter().find(|s| rest.starts_with(**s));
        if let Some(separator) = separator.filter(|_| depth == 0 && at >= begin) {
            parts.push(&expression[begin..at]);
            begin = at + separator.len();
        }
    }
    parts.push(&expression[begin..]);
    parts
}

#[test]
fn expressions_are_read_as_they_are_meant() {
    for allowed in [
        "MIT/Apache-2.0",
        "LGPL-3.0 OR MIT",
        "(MIT OR Apache-2.0) AND Unicode-3.0",
        "Apache-2.0 WITH LLVM-exception OR GPL-3.0",
    ] {
        assert!(is_allowed(allowed), "{allowed}");
    }
    for refused in [
        "GPL-3.0",
        "MIT AND GPL-3.0",
        "(MIT OR Zlib) AND LGPL-3.0",
        "",
    ] {
        assert!(!is_allowed(refused), "{refused}");
    }
}

#[test]
fn every_licence_is_permissive() {
    for package in packages() {
        let licence = text(&package, "license");
        let (name, version) = (text(&package, "name"), text(&package, "version"));
        assert!(is_allowed(licence), "{name} {version}: {licence}");
    }
}

#[test]
fn everything_comes_from_one_registry_or_from_here() {
    let packages = packages();
    let sources: BTreeSet<&str> = packages
        .iter()
        .map(|package| text(package, "source"))
        .filter(|source| !source.is_empty())
        .collect();
    assert!(sources.len() <= 1, "{sources:?}");
    assert!(sources.iter().all(|source| source.starts_with("registry+")));
}

/// Of what this system needs; others need other packages.
#[cfg(target_os = "linux")]
#[test]
fn no_package_is_there_twice_without_a_reason() {
    let mut versions = std::collections::BTreeMap::<String, usize>::new();
    for package in packages() {
        *versions
            .entry(text(&package, "name").to_owned())
            .or_default() += 1;
    }
    for (name, count) in &versions {
        let known = SEVERAL_VERSIONS.iter().any(|(known, _)| known == name);
        assert!(*count == 1 || known, "{name} is there in {count} versions");
    }
    for (name, _) in SEVERAL_VERSIONS {
        let several = versions.get(name).is_some_and(|count| *count > 1);
        assert!(several, "{name} is there once: take it off the list");
    }
}

#[test]
fn no_crate_of_ours_may_be_unsafe() {
    let read = |path: PathBuf| fs::read_to_string(&path).expect("a manifest");
    let root = read(workspace().join("Cargo.toml"));
    assert!(root.contains("unsafe_code = \"forbid\""));
    for entry in fs::read_dir(workspace().join("crates")).expect("crates/") {
        let path = entry.expect("an entry").path();
        let manifest = read(path.join("Cargo.toml"));
        let takes = manifest.contains("[lints]\nworkspace = true");
        assert!(takes, "{} has lints of its own", path.display());
    }
}
