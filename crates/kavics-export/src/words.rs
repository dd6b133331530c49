//! Columns as numbers: words become the numbers of a list that is the same for all load steps.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use kavics_results::{Columns, ResultsError, publish};

use crate::frames::Frames;

/// The words of the columns of a table.
#[derive(Debug, Default)]
pub(crate) struct Words {
    /// Columns with their words, sorted.
    columns: Vec<(String, Vec<String>)>,
}

/// A column as numbers.
pub(crate) enum Numbers {
    /// Counts, ids, numbers of words; −1 where there is none.
    Whole(Vec<i64>),
    /// Numbers; NaN where there is none.
    Real(Vec<f64>),
}

impl Words {
    /// The words of all load steps in a table.
    pub fn of(
        frames: &Frames<'_>,
        table: impl Fn(usize) -> Result<Columns, ResultsError>,
    ) -> Result<Self, ResultsError> {
        let mut found: Vec<(String, BTreeSet<String>)> = Vec::new();
        for &step in &frames.steps {
            let table = table(step)?;
            for name in table.names().into_iter().filter(|name| table.is_text(name)) {
                let words = table.texts(name)?.into_iter().map(str::to_owned);
                match found.iter_mut().find(|(known, _)| known == name) {
                    Some((_, all)) => all.extend(words),
                    None => found.push((name.to_owned(), words.collect())),
                }
            }
        }
        let columns = found.into_iter();
        Ok(Self {
            columns: columns
                .map(|(name, words)| (name, words.into_iter().collect()))
                .collect(),
        })
    }

    /// A column as numbers.
    pub fn numbers(&self, table: &Columns, name: &str) -> Result<Numbers, ResultsError> {
        if table.is_text(name) {
            let known = self.columns.iter().find(|(known, _)| known == name);
            let place = |word: &&str| {
                let words = known.map(|(_, words)| words.as_slice()).unwrap_or_default();
                words
                    .binary_search_by(|known| known.as_str().cmp(word))
                    .map_or(-1, |k| k as i64)
            };
            return Ok(Numbers::Whole(
                table.texts(name)?.iter().map(place).collect(),
            ));
        }
        if table.is_whole(name) {
            let numbers = table.integers(name)?.into_iter();
            return Ok(Numbers::Whole(
                numbers.map(|number| number.unwrap_or(-1)).collect(),
            ));
        }
        Ok(Numbers::Real(table.numbers(name)?))
    }
}

/// Writes `words.csv`: what the numbers of words mean.
pub(crate) fn write_words(
    folder: &Path,
    tables: &[(&str, &Words)],
) -> Result<PathBuf, ResultsError> {
    let mut text = String::from("table,column,number,word\n");
    for (table, words) in tables {
        for (column, words) in &words.columns {
            for (number, word) in words.iter().enumerate() {
                let _ = writeln!(
                    text,
                    "{table},{column},{number},\"{}\"",
                    word.replace('"', "\"\"")
                );
            }
        }
    }
    let path = folder.join("words.csv");
    publish(&path, text.as_bytes())?;
    Ok(path)
}
