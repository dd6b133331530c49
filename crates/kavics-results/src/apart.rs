//! What is written apart from a run never takes the place of what is read.

use std::fs;
use std::path::{Path, PathBuf};

use crate::ResultsError;
use crate::checkpoint::CHECKPOINT;
use crate::folder::has_record;
use crate::room::{ASKED_FOR, RECORDED, is_file_of_a_run};

/// Whether a file may be written: it is none that a run wrote into its results, but for the report, and none of those
/// that are `read` to make it. Nothing is touched.
///
/// # Errors
/// A file that is.
pub fn check_output(file: &Path, read: &[PathBuf]) -> Result<(), ResultsError> {
    let place = place(file);
    let is_read = |path: &&PathBuf| fs::canonicalize(path).is_ok_and(|path| path == place);
    if read.iter().any(|path| is_read(&path)) {
        return Err(refused(file, "it is read to make what is written"));
    }
    if of_a_run(&place).is_some_and(|name| name != "report.html") {
        return Err(refused(file, "it belongs to the results of a run"));
    }
    Ok(())
}

/// Whether files may be written into a folder: it is no results folder, and no folder of tables in one. Nothing is
/// touched.
///
/// # Errors
/// A folder that is.
pub fn check_output_folder(folder: &Path) -> Result<(), ResultsError> {
    let place = place(folder);
    if has_record(&place)? || of_a_run(&place).is_some() {
        return Err(refused(folder, "it belongs to the results of a run"));
    }
    Ok(())
}

fn refused(path: &Path, reason: &'static str) -> ResultsError {
    ResultsError::NoOutput {
        path: path.to_owned(),
        reason,
    }
}

/// The whole path of a file, which need not be there.
fn place(path: &Path) -> PathBuf {
    if let Ok(place) = fs::canonicalize(path) {
        return place;
    }
    match (path.parent(), path.file_name()) {
        (Some(parent), Some(name)) if parent == Path::new("") => {
            fs::canonicalize(".").unwrap_or_default().join(name)
        }
        (Some(parent), Some(name)) => place(parent).join(name),
        _ => path.to_owned(),
    }
}

/// What a file or folder is called in the results folder that it is a part of.
fn of_a_run(place: &Path) -> Option<String> {
    let name = |within: &Path| Some(within.iter().next()?.to_str()?.to_owned());
    let results = place.ancestors().skip(1).filter(|folder| {
        // What may not be looked into will not be written to either.
        has_record(folder).unwrap_or(false)
    });
    let mut names = results.filter_map(|folder| name(place.strip_prefix(folder).ok()?));
    names.find(|name| {
        let tables = RECORDED.iter().chain(&ASKED_FOR).chain([&CHECKPOINT]);
        is_file_of_a_run(name) || tables.into_iter().any(|table| *table == name)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_no_output() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let within = |name: &str| room.path().join("a.results").join(name);
        fs::create_dir_all(within("grains")).expect("room");
        for name in ["run.json", "grains/000000.parquet"] {
            fs::write(within(name), "{}").expect("room");
        }
        for name in [
            "run.json",
            "scene.toml",
            "steps.parquet",
            "grains/000000.parquet",
            "grains/../steps.parquet",
            "contacts/new.csv",
            "checkpoint/a",
        ] {
            let refused = check_output(&within(name), &[]);
            assert!(
                matches!(refused, Err(ResultsError::NoOutput { .. })),
                "{name}: {refused:?}"
            );
        }
        for name in ["report.html", "mine.csv", "../steps.parquet"] {
            assert!(check_output(&within(name), &[]).is_ok(), "{name}");
        }
        for (name, free) in [("", false), ("grains", false), ("exported", true)] {
            assert_eq!(check_output_folder(&within(name)).is_ok(), free, "{name}");
        }
    }

    #[test]
    fn what_is_read_is_no_output() {
        let room = tempfile::tempdir().expect("a temporary folder");
        let [list, other] = ["list.csv", "other.csv"].map(|name| room.path().join(name));
        fs::write(&list, "x,y,radius\n").expect("room");
        let about = room.path().join("missing/../list.csv");
        assert!(check_output(&list, std::slice::from_ref(&list)).is_err());
        assert!(check_output(&other, std::slice::from_ref(&list)).is_ok());
        assert!(check_output(&about, &[]).is_ok());
    }
}
