//! Why there is no report.

use kavics_pictures::PictureError;
use kavics_results::ResultsError;
use kavics_viewer::PageError;
use thiserror::Error;

use crate::ComparedError;

/// A report could not be made.
#[derive(Debug, Error)]
pub enum ReportError {
    /// The results could not be read, or the page not written.
    #[error("{0}")]
    Results(#[from] ResultsError),
    /// A picture could not be made.
    #[error("{0}")]
    Picture(PictureError),
    /// The table to compare with is wrong.
    #[error("compare.csv: {0}")]
    Compared(#[from] ComparedError),
    /// The viewer's data could not be read, or do not hold what was asked for.
    #[error("{0}")]
    Viewer(#[from] PageError),
    /// The page could not be filled in: our own mistake.
    #[error("report: {0}")]
    Page(#[from] minijinja::Error),
}

impl From<PictureError> for ReportError {
    fn from(error: PictureError) -> Self {
        match error {
            PictureError::Results(error) => Self::Results(error),
            other => Self::Picture(other),
        }
    }
}
