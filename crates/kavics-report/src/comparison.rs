//! A table of the user's set beside the run: the same columns, matched row by row.

use kavics_results::{Columns, ResultsFolder};
use serde::Serialize;

use crate::ReportError;
use crate::compared_table::{ComparedTable, MatchedBy};

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
        let table = ComparedTable::parse(text)?;
        let by = table.matched_by();
        let mine = match by {
            MatchedBy::Row => vec![f64::NAN; steps.len()],
            MatchedBy::Step | MatchedBy::LoadFactor => steps.numbers(by.name())?,
        };
        let pairs = table.matched(&mine);
        let mut columns = Vec::new();
        for (name, values) in table.columns() {
            let run = steps.numbers(name)?;
            let rows = pairs.iter().map(|pair| Compared {
                label: pair.label.clone(),
                run: run[pair.run],
                compared: values[pair.table],
            });
            columns.push(ComparedColumn {
                name: name.to_owned(),
                rows: rows
                    .filter(|r| r.run.is_finite() && r.compared.is_finite())
                    .collect(),
            });
        }
        Ok(Self {
            matched_by: by.name().to_owned(),
            notes: table.notes().to_vec(),
            columns,
        })
    }
}
