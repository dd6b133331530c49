//! The table that a scene is compared with, read before anything runs.

use std::fs;
use std::path::Path;

use kavics::scene::SceneError;
use kavics_report::ComparedTable;
use kavics_results::ResultsError;
use toml_edit::Document;

use crate::failure::Failure;

/// Reads the table at `path`, which the scene `text` called `name` compares its run with.
///
/// # Errors
/// A table that cannot be read, or compared: with the place in the scene.
pub fn read(path: &Path, text: &str, name: &str) -> Result<ComparedTable, Failure> {
    let bytes = fs::read(path).map_err(|source| ResultsError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    let wrong = |what: &str| {
        let what = format!("{}: {what}", path.display());
        Failure::Scene(SceneError::Wrong(shown(&what, text, name)))
    };
    let table = String::from_utf8(bytes).map_err(|_| wrong("not text in UTF-8"))?;
    ComparedTable::parse(&table).map_err(|error| wrong(&error.to_string()))
}

/// The mistake with its line of the scene, as the scene's own check shows mistakes.
fn shown(what: &str, text: &str, name: &str) -> String {
    let span = Document::parse(text)
        .ok()
        .and_then(|scene| scene.get("compare")?.get("file")?.span())
        .unwrap_or(0..0);
    let before = &text[..span.start];
    let line = before.matches('\n').count() + 1;
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let source = text[start..].lines().next().unwrap_or_default();
    let column = before[start..].chars().count();
    let gutter = " ".repeat(line.to_string().len());
    let marks = "^".repeat(text[span].chars().count().max(1));
    format!(
        "error: the table to compare with is wrong\n{gutter}--> {name}:{line}:{}\n{gutter} |\n\
         {line} | {source}\n{gutter} | {}{marks} {what}",
        column + 1,
        " ".repeat(column),
    )
}

#[cfg(test)]
mod tests {
    use super::shown;

    #[test]
    fn the_line_of_the_scene_is_marked() {
        let text = "seed = 1\n[compare]\nfile = \"t.csv\"\n";
        assert_eq!(
            shown("no", text, "a.toml"),
            "error: the table to compare with is wrong\n --> a.toml:3:8\n  |\n\
             3 | file = \"t.csv\"\n  |        ^^^^^^^ no"
        );
    }
}
