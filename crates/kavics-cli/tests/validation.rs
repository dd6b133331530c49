//! Every folder of `validation/`: its scenes run by the command, what is expected held against their tables, and the
//! page that shows both.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use kavics_verify::{Case, FILES, Finding, Verifier, case_names, page};

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn all_findings() -> Vec<Finding> {
    let verifier = Verifier::new(Path::new(env!("CARGO_BIN_EXE_kavics"))).expect("room");
    let cases = Case::all().into_iter();
    cases
        .flat_map(|case| verifier.verify(case).expect("runs"))
        .collect()
}

/// With `KAVICS_WRITE_PAGES` set the page is written instead of compared.
#[test]
fn every_case_holds_and_the_page_shows_what_is_found() {
    let findings = all_findings();
    let wrong: Vec<&Finding> = findings.iter().filter(|f| !f.holds).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    let (path, found) = (workspace().join("docs/validation.md"), page(&findings));
    if std::env::var_os("KAVICS_WRITE_PAGES").is_some() {
        fs::write(&path, &found).expect("docs/");
    }
    let written = fs::read_to_string(&path).expect("docs/validation.md");
    for (number, (written, found)) in written.lines().zip(found.lines()).enumerate() {
        assert_eq!(written, found, "line {} of docs/validation.md", number + 1);
    }
    assert_eq!(written.lines().count(), found.lines().count());
}

#[test]
fn the_program_has_every_file_of_every_case() {
    let known: BTreeSet<&str> = FILES.iter().map(|(path, _)| *path).collect();
    let folders = fs::read_dir(workspace().join("validation")).expect("validation/");
    for folder in folders.map(|entry| entry.expect("an entry").path()) {
        let Ok(files) = fs::read_dir(&folder) else {
            continue;
        };
        let folder = folder.file_name().expect("a name").to_string_lossy();
        for file in files {
            let file = file.expect("an entry").file_name();
            let path = format!("validation/{folder}/{}", file.to_string_lossy());
            assert!(
                known.contains(path.as_str()),
                "{path} is not in the program"
            );
        }
    }
}

#[test]
fn every_run_is_expected_of_and_every_case_is_explained() {
    for case in Case::all() {
        let (runs, expected) = (case.runs(), case.runs_expected());
        for run in &expected {
            assert!(
                runs.iter().any(|name| name == run),
                "no run is called {run}"
            );
        }
        for run in &runs {
            let used = expected.contains(&run.as_str());
            assert!(used, "nothing is expected of run {run}");
        }
        assert_ne!(case.title(), case.name, "{} has no README.md", case.name);
    }
    assert!(case_names().is_sorted());
}
