//! Room for a results folder: what may be replaced, and what is never touched.

use std::fs::{self, DirEntry};
use std::path::{Path, PathBuf};

use crate::ResultsError;
use crate::checkpoint::{CHECKPOINT, is_generation};
use crate::folder::has_record;
use crate::lock::LOCK;

/// Folders of tables, a file a recorded load step.
pub(crate) const RECORDED: [&str; 3] = ["grains", "contacts", "sides"];

/// Folders of tables that are written when asked for.
pub(crate) const ASKED_FOR: [&str; 3] = [VOIDS, CRACKS, MODES];
/// Void cells.
pub(crate) const VOIDS: &str = "voids";
/// Cracks.
pub(crate) const CRACKS: &str = "cracks";
/// Lowest modes of the tangent.
pub(crate) const MODES: &str = "modes";

/// The other files of a run.
const FILES: [&str; 9] = [
    "scene.toml",
    "run.json",
    "steps.parquet",
    "iterations.parquet",
    "actions.parquet",
    "events.parquet",
    "compare.csv",
    "log.ndjson",
    "report.html",
];

/// Whether results can be written to `folder`: it is not there, or empty, or results that are to be replaced and
/// nothing else. Nothing is touched.
///
/// # Errors
/// A results folder that is not to be replaced, or holds files of something else; any other folder with
/// something in it; a file.
pub fn check_room(folder: &Path, replace: bool) -> Result<(), ResultsError> {
    if is_empty(folder) {
        return Ok(());
    }
    if !has_record(folder)? {
        return Err(ResultsError::NotResults {
            folder: folder.to_owned(),
        });
    }
    if !replace {
        return Err(ResultsError::Exists {
            folder: folder.to_owned(),
        });
    }
    files_of_a_run(folder).map(|_| ())
}

/// Whether results that are to be replaced hold none of the files that the run reads, and not the working folder.
/// Nothing is touched.
///
/// # Errors
/// The first of `read` that lies in `folder`.
pub fn check_apart(folder: &Path, read: &[PathBuf]) -> Result<(), ResultsError> {
    let Ok(place) = fs::canonicalize(folder) else {
        return Ok(());
    };
    if is_empty(folder) {
        return Ok(());
    }
    let within = |path: &Path| fs::canonicalize(path).is_ok_and(|path| path.starts_with(&place));
    let in_use = |path: &Path| ResultsError::InUse {
        folder: folder.to_owned(),
        path: path.to_owned(),
    };
    match read.iter().find(|path| within(path)) {
        Some(path) => Err(in_use(path)),
        None if within(Path::new(".")) => Err(in_use(Path::new("the working folder"))),
        None => Ok(()),
    }
}

/// Whether a run may go on in `folder`: it is not there, or holds files of a run and nothing else. Nothing is touched.
///
/// # Errors
/// A folder that holds anything else, or is a file.
pub fn check_own(folder: &Path) -> Result<(), ResultsError> {
    if is_empty(folder) {
        return Ok(());
    }
    let not_results = |error| match error {
        ResultsError::NotOfARun { .. } if !folder.join("run.json").is_file() => {
            ResultsError::NotResults {
                folder: folder.to_owned(),
            }
        }
        other => other,
    };
    files_of_a_run(folder).map_err(not_results).map(|_| ())
}

/// Takes away what a run left that was broken off before it wrote `run.json`, or with nothing to go on from.
///
/// # Errors
/// A folder that holds anything else; files that cannot be removed.
pub fn clear_unfinished(folder: &Path) -> Result<(), ResultsError> {
    check_own(folder)?;
    if is_empty(folder) {
        return Ok(());
    }
    remove(files_of_a_run(folder)?)?;
    for name in RECORDED.iter().chain(&ASKED_FOR).chain([&CHECKPOINT]) {
        // What is not there need not go.
        let _ = fs::remove_dir(folder.join(name));
    }
    Ok(())
}

/// Takes away the files of an earlier run, and nothing else; the folder itself stays.
pub(crate) fn make_room(folder: &Path, replace: bool) -> Result<(), ResultsError> {
    check_room(folder, replace)?;
    if is_empty(folder) {
        return Ok(());
    }
    remove(files_of_a_run(folder)?)
}

/// Takes away what writing left that was broken off, and tables of load steps that are not to be recorded.
pub(crate) fn clear_leftovers(
    folder: &Path,
    is_recorded: impl Fn(usize) -> bool,
) -> Result<(), ResultsError> {
    let is_left = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let number = name.strip_suffix(".parquet").and_then(|n| n.parse().ok());
        name.starts_with('.') || number.is_some_and(|step| !is_recorded(step))
    };
    remove(
        files_of_a_run(folder)?
            .into_iter()
            .filter(is_left)
            .collect(),
    )
}

/// Takes away what is left in the folder itself of files that were not published: a run that has ended, and was killed
/// while it wrote its report, leaves no more than that.
///
/// # Errors
/// Files that cannot be removed.
pub fn clear_unpublished(folder: &Path) -> Result<(), ResultsError> {
    remove(unpublished(folder)?)
}

/// Whether there is something for [`clear_unpublished`] to take away.
///
/// # Errors
/// A folder that cannot be listed.
pub fn has_unpublished(folder: &Path) -> Result<bool, ResultsError> {
    unpublished(folder).map(|left| !left.is_empty())
}

fn unpublished(folder: &Path) -> Result<Vec<PathBuf>, ResultsError> {
    let is_left = |entry: &DirEntry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        name.starts_with('.') && is_file_of_a_run(&name)
    };
    let left = entries(folder)?.into_iter().filter(is_left);
    Ok(left.map(|entry| entry.path()).collect())
}

fn remove(mut files: Vec<PathBuf>) -> Result<(), ResultsError> {
    // Without run.json the rest would be taken for something else, so it goes last.
    files.sort_by_key(|path| path.ends_with("run.json"));
    for file in files {
        fs::remove_file(&file).map_err(ResultsError::unwritable(&file))?;
    }
    Ok(())
}

/// Whether there is nothing in a folder but what is held by the run that is to write there.
fn is_empty(folder: &Path) -> bool {
    let only = |folder: &Path, may_be: &dyn Fn(&DirEntry) -> bool| {
        let entries = fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
        entries.map(|entries| entries.iter().all(may_be))
    };
    let is_lock = |entry: &DirEntry| entry.file_name() == LOCK;
    let holds_a_lock = |entry: &DirEntry| {
        entry.file_name() == CHECKPOINT && only(&entry.path(), &is_lock).unwrap_or(false)
    };
    only(folder, &holds_a_lock).unwrap_or_else(|_| fs::symlink_metadata(folder).is_err())
}

/// All files in `folder` but its lock, where all are of a run.
fn files_of_a_run(folder: &Path) -> Result<Vec<PathBuf>, ResultsError> {
    let mut files = Vec::new();
    for entry in entries(folder)? {
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        let name = entry.file_name().to_string_lossy().into_owned();
        let is_recorded = RECORDED
            .iter()
            .chain(&ASKED_FOR)
            .any(|known| *known == name);
        let is_known: Option<fn(&str) -> bool> = match name.as_str() {
            CHECKPOINT => Some(is_generation),
            _ => is_recorded.then_some(is_table),
        };
        if let Some(is_known) = is_known.filter(|_| is_folder) {
            for table in entries(&entry.path())? {
                let name = table.file_name().to_string_lossy().into_owned();
                if name == LOCK && entry.file_name() == CHECKPOINT {
                    continue;
                }
                take(folder, &table, is_known(&name), &mut files)?;
            }
        } else {
            take(folder, &entry, is_file_of_a_run(&name), &mut files)?;
        }
    }
    Ok(files)
}

fn entries(folder: &Path) -> Result<Vec<DirEntry>, ResultsError> {
    let listed = fs::read_dir(folder).and_then(Iterator::collect);
    listed.map_err(ResultsError::unreadable(folder))
}

fn take(
    folder: &Path,
    entry: &DirEntry,
    known: bool,
    files: &mut Vec<PathBuf>,
) -> Result<(), ResultsError> {
    if known && entry.file_type().is_ok_and(|kind| kind.is_file()) {
        files.push(entry.path());
        return Ok(());
    }
    Err(ResultsError::NotOfARun {
        folder: folder.to_owned(),
        path: entry.path(),
    })
}

pub(crate) fn is_file_of_a_run(name: &str) -> bool {
    FILES
        .iter()
        .any(|file| *file == name || is_left_of(name, file))
}

fn is_table(name: &str) -> bool {
    let name = name.strip_prefix('.').unwrap_or(name);
    let number = name.split_once(".parquet").map(|(number, _)| number);
    number.is_some_and(|n| n.len() >= 6 && n.bytes().all(|byte| byte.is_ascii_digit()))
}

/// Whether `name` is what a run that was broken off while it published `file` may leave: `.file.random`.
fn is_left_of(name: &str, file: &str) -> bool {
    name.strip_prefix('.')
        .and_then(|name| name.strip_prefix(file))
        .is_some_and(|rest| rest.starts_with('.'))
}
