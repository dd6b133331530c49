//! What can go wrong with a picture.

use std::path::PathBuf;

use kavics_results::ResultsError;
use thiserror::Error;

/// A picture could not be made.
#[derive(Debug, Error)]
pub enum PictureError {
    /// The results could not be read, or the picture not written.
    #[error("{0}")]
    Results(#[from] ResultsError),
    /// The results do not tell the container.
    #[error("{}: run.json keeps no container", folder.display())]
    NoContainer {
        /// Results folder.
        folder: PathBuf,
    },
    /// A table names a grain, side or contact that is not there.
    #[error("{}: {table} names {what} {id}, which is not there", folder.display())]
    NotThere {
        /// Results folder.
        folder: PathBuf,
        /// Table.
        table: &'static str,
        /// Grain, side or contact.
        what: &'static str,
        /// Its number as the table has it.
        id: i64,
    },
}
