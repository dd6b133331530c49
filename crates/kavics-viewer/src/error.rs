//! Why a piece of page data cannot be had.

use std::path::PathBuf;

use arrow_schema::ArrowError;
use kavics_pictures::PictureError;
use kavics_results::ResultsError;
use thiserror::Error;

/// A piece of page data cannot be had.
#[derive(Debug, Error)]
pub enum PageError {
    /// Nothing has this name.
    #[error("no page data are called \"{name}\"")]
    Unknown {
        /// What was asked for.
        name: String,
    },
    /// A load step of which there are no tables, or not all of them yet.
    #[error("there is no whole table \"{table}\" of load step {step}")]
    NotRecorded {
        /// The table.
        table: String,
        /// The load step.
        step: usize,
    },
    /// A load step that was named and has no tables.
    #[error("load step {step} is not recorded; those recorded are {recorded}")]
    Unrecorded {
        /// The load step.
        step: usize,
        /// Those that are.
        recorded: String,
    },
    /// A table lacks a column.
    #[error("the table \"{table}\" has no column called \"{column}\"")]
    NoColumn {
        /// The table.
        table: String,
        /// The column asked for.
        column: String,
    },
    /// A table is shorter.
    #[error("the table \"{table}\" of load step {step} has no row {row}")]
    NoRow {
        /// The table.
        table: String,
        /// The load step.
        step: usize,
        /// The row asked for.
        row: usize,
    },
    /// A link in the results folder leads out of it.
    #[error("{} leads out of the results folder", path.display())]
    Outside {
        /// The link.
        path: PathBuf,
    },
    /// A file of the results cannot be read.
    #[error("{0}")]
    Results(#[from] ResultsError),
    /// The assembly cannot be drawn from the results.
    #[error("{0}")]
    Picture(#[from] PictureError),
    /// A table does not become an Arrow stream.
    #[error("page data: {0}")]
    Arrow(#[from] ArrowError),
}

impl PageError {
    /// Whether what was asked for is not there, rather than broken.
    pub fn is_absence(&self) -> bool {
        match self {
            Self::Results(ResultsError::Unreadable { source, .. }) => {
                source.kind() == std::io::ErrorKind::NotFound
            }
            Self::Results(_) | Self::Picture(_) | Self::Arrow(_) => false,
            _ => true,
        }
    }
}
