//! The table that a scene sets beside its run: csv, checked before anything is compared.

use csv::StringRecord;
use kavics_results::{StepRow, step_columns};
use thiserror::Error;

/// Relative difference below which load factors are the same.
const SAME_FACTOR: f64 = 1e-6;

/// Why a table cannot be compared with.
#[derive(Debug, Error)]
pub enum ComparedError {
    /// It is no csv.
    #[error("{0}")]
    Csv(#[from] csv::Error),
    /// It shares no column with `steps`.
    #[error("no column has the name of a column of steps")]
    NothingToCompare,
    /// A value is none.
    #[error("line {line}, column `{column}`: \"{found}\" is not a number")]
    NotANumber {
        /// Line, from 1.
        line: u64,
        /// Column.
        column: String,
        /// What stands there.
        found: String,
    },
}

/// How rows of the table find their load step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatchedBy {
    /// By the number of the load step.
    Step,
    /// By the load factor.
    LoadFactor,
    /// The first row with the first load step, and so on.
    Row,
}

impl MatchedBy {
    /// Name of the column, or `row`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Step => "step",
            Self::LoadFactor => "load_factor",
            Self::Row => "row",
        }
    }
}

/// A row of the run and the row of the table that belongs to it.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    pub(crate) label: String,
    pub(crate) run: usize,
    pub(crate) table: usize,
}

/// Columns of numbers with the names of columns of `steps`; a value that is left out is NaN.
#[derive(Clone, Debug)]
pub struct ComparedTable {
    notes: Vec<String>,
    columns: Vec<(String, Vec<f64>)>,
    lines: Vec<u64>,
    warnings: Vec<String>,
}

impl ComparedTable {
    /// Reads csv with a line of names; lines that start with `#` are notes.
    ///
    /// # Errors
    /// What is no csv; no column to compare; a value that is no finite number.
    pub fn parse(text: &str) -> Result<Self, ComparedError> {
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let header = reader.headers()?.clone();
        let (places, warnings) = places(&header);
        let records = reader.records().collect::<Result<Vec<_>, _>>()?;
        let mut columns = Vec::new();
        for place in places {
            let name = &header[place];
            let values = records.iter().map(|record| number(record, place, name));
            columns.push((name.to_owned(), values.collect::<Result<Vec<_>, _>>()?));
        }
        if columns.iter().all(|(name, _)| is_key(name)) {
            return Err(ComparedError::NothingToCompare);
        }
        let notes = text.lines().filter_map(|line| line.strip_prefix('#'));
        Ok(Self {
            notes: notes.map(|note| note.trim().to_owned()).collect(),
            columns,
            lines: records.iter().map(line).collect(),
            warnings,
        })
    }

    /// Lines that start with `#`.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Columns that are not compared, and why.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// How its rows find their load step.
    pub fn matched_by(&self) -> MatchedBy {
        let known = [MatchedBy::Step, MatchedBy::LoadFactor].into_iter();
        let mut keys = known.filter(|by| self.columns.iter().any(|(name, _)| name == by.name()));
        keys.next().unwrap_or(MatchedBy::Row)
    }

    /// Rows that no load step of a run belongs to, a sentence each.
    pub fn unmatched(&self, steps: &[StepRow]) -> Vec<String> {
        let by = self.matched_by();
        let value = |row: &StepRow| match by {
            MatchedBy::Step => row.step as f64,
            MatchedBy::LoadFactor => row.load_factor,
            MatchedBy::Row => f64::NAN,
        };
        let mine: Vec<f64> = steps.iter().map(value).collect();
        let pairs = self.matched(&mine);
        let lone = |row: &usize| pairs.iter().all(|pair| pair.table != *row);
        let lone: Vec<String> = (0..self.lines.len())
            .filter(lone)
            .map(|row| self.lines[row].to_string())
            .collect();
        match lone.as_slice() {
            [] => Vec::new(),
            [line] => vec![format!(
                "line {line} has no load step, matched by {}",
                by.name()
            )],
            lines => vec![format!(
                "lines {} have no load step, matched by {}",
                lines.join(", "),
                by.name()
            )],
        }
    }

    /// The columns beside those that find the load step.
    pub(crate) fn columns(&self) -> impl Iterator<Item = (&str, &[f64])> {
        let columns = self.columns.iter().filter(|(name, _)| !is_key(name));
        columns.map(|(name, values)| (name.as_str(), values.as_slice()))
    }

    /// Each row with the first load step after the last match that has its value: a load factor may come back
    /// when a load is taken off. `mine` holds the values of the run.
    pub(crate) fn matched(&self, mine: &[f64]) -> Vec<Pair> {
        let key = self.matched_by().name();
        let Some((_, values)) = self.columns.iter().find(|(name, _)| name == key) else {
            let both = mine.len().min(self.lines.len());
            let pair = |row: usize| Pair {
                label: (row + 1).to_string(),
                run: row,
                table: row,
            };
            return (0..both).map(pair).collect();
        };
        let mut pairs = Vec::new();
        let mut from = 0;
        for (table, &value) in values.iter().enumerate() {
            let same = |other: &f64| (other - value).abs() <= SAME_FACTOR * value.abs().max(1.0);
            if let Some(offset) = mine[from..].iter().position(same) {
                pairs.push(Pair {
                    label: value.to_string(),
                    run: from + offset,
                    table,
                });
                from += offset + 1;
            }
        }
        pairs
    }
}

/// Whether a column finds the load step.
fn is_key(name: &str) -> bool {
    name == "step" || name == "load_factor"
}

/// The columns that can be compared, and what is to be said of the others.
fn places(header: &StringRecord) -> (Vec<usize>, Vec<String>) {
    let known = step_columns();
    let mut places: Vec<usize> = Vec::new();
    let mut warnings = Vec::new();
    for (place, name) in header.iter().enumerate() {
        let column = known.iter().find(|column| column.name == name);
        if !column.is_some_and(kavics_results::Column::is_numeric) {
            warnings.push(format!(
                "column `{name}` is no column of numbers of steps, and not compared"
            ));
        } else if places.iter().any(|&other| &header[other] == name) {
            warnings.push(format!(
                "column `{name}` stands there again; the first is compared"
            ));
        } else {
            places.push(place);
        }
    }
    (places, warnings)
}

fn number(record: &StringRecord, place: usize, column: &str) -> Result<f64, ComparedError> {
    let found = record.get(place).unwrap_or_default();
    if found.is_empty() && !is_key(column) {
        return Ok(f64::NAN);
    }
    match found.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(ComparedError::NotANumber {
            line: line(record),
            column: column.to_owned(),
            found: found.to_owned(),
        }),
    }
}

fn line(record: &StringRecord) -> u64 {
    record.position().map_or(0, csv::Position::line)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        let refused = ComparedTable::parse(text).expect_err("a wrong table");
        refused.to_string()
    }

    fn steps(factors: &[f64]) -> Vec<StepRow> {
        let row = |(i, &load_factor): (usize, &f64)| StepRow {
            step: i + 1,
            load_factor,
            ..StepRow::default()
        };
        factors.iter().enumerate().map(row).collect()
    }

    #[test]
    fn what_is_no_number_is_named_with_its_place() {
        let message = "line 3, column `stress_yy`: \"abc\" is not a number";
        assert_eq!(
            refused("load_factor,stress_yy\n1.0,2.0\n1.2,abc\n"),
            message
        );
        assert!(refused("load_factor,stress_yy\n1.0,nan\n").contains("\"nan\""));
        assert!(refused("load_factor,stress_yy\n,1.0\n").contains("`load_factor`"));
    }

    #[test]
    fn columns_that_are_not_compared_are_named() {
        let text = "load_factor,stress_yy,stres_xx,stress_yy,stage\n1.0,2.0,x,3.0,press\n";
        let table = ComparedTable::parse(text).expect("a right table");
        let warnings = table.warnings().join("; ");
        assert_eq!(table.warnings().len(), 3, "{warnings}");
        assert!(warnings.contains("`stress_yy` stands there again"));
    }

    #[test]
    fn rows_without_a_load_step_are_named() {
        let twice = "load_factor,stress_yy\n1.0,2.0\n1.0,2.5\n1.4,3.0\n9.0,3.0\n";
        let table = ComparedTable::parse(twice).expect("a right table");
        assert_eq!(
            table.unmatched(&steps(&[1.0, 1.2, 1.4])),
            ["lines 3, 5 have no load step, matched by load_factor"]
        );
        let rows = ComparedTable::parse("stress_yy\n2.0\n2.5\n").expect("a right table");
        assert_eq!(
            rows.unmatched(&steps(&[1.0])),
            ["line 3 has no load step, matched by row"]
        );
    }
}
