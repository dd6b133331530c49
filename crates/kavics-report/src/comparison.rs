//! A table of the user's set beside the run: the same columns, matched row by row.

use kavics_results::{Columns, ResultsFolder};
use serde::Serialize;

use crate::ReportError;

/// Relative difference below which load factors are the same.
const SAME_FACTOR: f64 = 1e-6;

/// Columns of `steps` beside the same columns of another table.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// `step`, `load_factor`, or `row` where the table has neither.
    pub matched_by: String,
    /// Lines of the table that start with `#`.
    pub notes: Vec<String>,
    /// The columns of both.
    pub columns: Vec<ComparedColumn>,
}

/// A column of the run beside the same column of the table.
#[derive(Clone, Debug, Serialize)]
pub struct ComparedColumn {
    /// Name of the column.
    pub name: String,
    /// The rows that both have.
    pub rows: Vec<Compared>,
}

/// A value of the run beside that of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Compared {
    /// Step, load factor or row.
    pub label: String,
    /// The run's.
    pub run: f64,
    /// The table's.
    pub compared: f64,
}

impl Compared {
    /// The run's value less the table's.
    pub fn difference(&self) -> f64 {
        self.run - self.compared
    }
}

impl ComparedColumn {
    /// The row with the largest difference.
    pub fn largest(&self) -> Option<&Compared> {
        let size = |row: &&Compared| row.difference().abs();
        self.rows.iter().max_by(|a, b| size(a).total_cmp(&size(b)))
    }
}

impl Comparison {
    /// Reads `compare.csv` of the results, where the scene names one.
    ///
    /// # Errors
    /// Tables that cannot be read, or share no column.
    pub fn read(folder: &ResultsFolder) -> Result<Option<Self>, ReportError> {
        let Some(text) = folder.compared()? else {
            return Ok(None);
        };
        Self::new(&text, &folder.steps()?).map(Some)
    }

    fn new(text: &str, steps: &Columns) -> Result<Self, ReportError> {
        let table = Table::parse(text)?;
        let (matched_by, pairs) = matched(&table, steps)?;
        let mut columns = Vec::new();
        for (index, name) in table.names.iter().enumerate() {
            if name == "step" || name == "load_factor" {
                continue;
            }
            let Ok(run) = steps.numbers(name) else {
                continue;
            };
            let row = |(label, mine, theirs): &(String, usize, usize)| Compared {
                label: label.clone(),
                run: run[*mine],
                compared: table.rows[*theirs][index],
            };
            let rows = pairs.iter().map(row);
            columns.push(ComparedColumn {
                name: name.clone(),
                rows: rows
                    .filter(|r| r.run.is_finite() && r.compared.is_finite())
                    .collect(),
            });
        }
        if columns.is_empty() {
            return Err(ReportError::NothingToCompare);
        }
        Ok(Self {
            matched_by,
            notes: table.notes,
            columns,
        })
    }
}

/// Label, row of the run, row of the table.
type Pairs = Vec<(String, usize, usize)>;

fn matched(table: &Table, steps: &Columns) -> Result<(String, Pairs), ReportError> {
    for name in ["step", "load_factor"] {
        if let Some(column) = table.names.iter().position(|other| other == name) {
            let mine = steps.numbers(name)?;
            return Ok((name.to_owned(), match_values(&mine, table, column)));
        }
    }
    let both = steps.len().min(table.rows.len());
    let pairs = (0..both).map(|row| ((row + 1).to_string(), row, row));
    Ok(("row".to_owned(), pairs.collect()))
}

/// Each row of the table with the first row of the run after the last match that has its value: a load factor
/// may come back when a load is taken off.
fn match_values(mine: &[f64], table: &Table, column: usize) -> Pairs {
    let mut pairs = Pairs::new();
    let mut from = 0;
    for (theirs, row) in table.rows.iter().enumerate() {
        let value = row[column];
        let same = |other: &f64| (other - value).abs() <= SAME_FACTOR * value.abs().max(1.0);
        if let Some(offset) = mine[from..].iter().position(same) {
            pairs.push((value.to_string(), from + offset, theirs));
            from += offset + 1;
        }
    }
    pairs
}

/// Names and numbers of a csv file; what is no number is NaN.
struct Table {
    notes: Vec<String>,
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn parse(text: &str) -> Result<Self, ReportError> {
        let notes = text.lines().filter_map(|line| line.strip_prefix('#'));
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let names = reader.headers()?.iter().map(str::to_owned).collect();
        let mut rows = Vec::new();
        for record in reader.records() {
            let values = record?;
            let number = |text: &str| text.parse().unwrap_or(f64::NAN);
            rows.push(values.iter().map(number).collect());
        }
        Ok(Self {
            notes: notes.map(|note| note.trim().to_owned()).collect(),
            names,
            rows,
        })
    }
}
