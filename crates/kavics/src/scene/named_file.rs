//! Files that a scene names.

use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::checker::Checker;
use super::diagnostic::Problem;
use super::value::Placed;

/// The path of a named file that can be read; `expected` says what it should hold.
pub fn named_file(
    file: &Placed<String>,
    folder: &Path,
    expected: &str,
    checker: &mut Checker,
) -> Option<PathBuf> {
    let path = folder.join(&file.value);
    let wrong = match fs::metadata(&path) {
        Ok(found) if found.is_dir() => format!("`{}` is a folder", file.value),
        Ok(found) if !found.is_file() => format!("`{}` is not a file", file.value),
        Err(error) if is_absent(error.kind()) => format!("there is no file `{}`", file.value),
        found => match found.and_then(|_| File::open(&path)) {
            Ok(_) => return Some(path),
            Err(error) => {
                checker.unreadable = Some((path, error));
                return None;
            }
        },
    };
    checker.push(Problem::at(
        &file.span,
        wrong,
        format!("expected {expected}, its name relative to the scene's folder"),
    ));
    None
}

fn is_absent(kind: ErrorKind) -> bool {
    matches!(kind, ErrorKind::NotFound | ErrorKind::NotADirectory)
}
