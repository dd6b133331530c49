//! Why there is no report.

use kavics_results::ResultsError;
use thiserror::Error;

/// A report could not be made.
#[derive(Debug, Error)]
pub enum ReportError {
    /// The results could not be read, or the page not written.
    #[error("{0}")]
    Results(#[from] ResultsError),
    /// The table to compare with is no csv.
    #[error("compare.csv: {0}")]
    Compared(#[from] csv::Error),
    /// The table to compare with shares no column with `steps`.
    #[error("compare.csv: no column has the name of a column of steps")]
    NothingToCompare,
    /// The page could not be filled in: our own mistake.
    #[error("report: {0}")]
    Page(#[from] minijinja::Error),
}
