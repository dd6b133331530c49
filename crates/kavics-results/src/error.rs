//! What can go wrong with a results folder.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use parquet::errors::ParquetError;
use thiserror::Error;

/// A file of a results folder could not be read or written.
#[derive(Debug, Error)]
pub enum ResultsError {
    /// The folder is there already.
    #[error("{} exists already; --force replaces it, -o names another folder", folder.display())]
    Exists {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder holds something else, and is left alone.
    #[error("{} is not a results folder (it has no run.json)", folder.display())]
    NotResults {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder holds results and something else, which is left alone.
    #[error("{} holds {}, which is no file of a run; nothing there is replaced", folder.display(), path.display())]
    NotOfARun {
        /// The folder.
        folder: PathBuf,
        /// What is no file of a run.
        path: PathBuf,
    },
    /// The folder is to be replaced and holds what the run needs.
    #[error("{} holds {}, which the run needs; nothing there is replaced", folder.display(), path.display())]
    InUse {
        /// The folder.
        folder: PathBuf,
        /// What the run needs.
        path: PathBuf,
    },
    /// A file or folder is not to be written.
    #[error("{}: not written, as {reason}; -o names another", path.display())]
    NoOutput {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        reason: &'static str,
    },
    /// Another run writes to the folder.
    #[error("{} is being written by another run; wait for its end, or name another folder by -o", folder.display())]
    Locked {
        /// The folder.
        folder: PathBuf,
    },
    /// A file could not be read.
    #[error("{}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error("{}: cannot be written: {source}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A table could not be turned into Parquet, or back.
    #[error("{}: {source}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// Why.
        source: ParquetError,
    },
    /// A file of names and values could not be understood.
    #[error("{}: {source}", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// Why.
        source: serde_json::Error,
    },
    /// A table lacks a column.
    #[error("{}: no column is called \"{column}\"; [record] of the scene says which columns there are", path.display())]
    NoColumn {
        /// The file.
        path: PathBuf,
        /// The column looked for.
        column: String,
    },
    /// A column holds something else than looked for.
    #[error("{}: column \"{column}\" does not hold {wanted}", path.display())]
    WrongColumn {
        /// The file.
        path: PathBuf,
        /// The column.
        column: String,
        /// What it should hold.
        wanted: &'static str,
    },
    /// The tables are of another scene than the one beside them.
    #[error("{}: {table} has {found} rows where scene.toml makes {expected}", folder.display())]
    OtherScene {
        /// Results folder.
        folder: PathBuf,
        /// Table.
        table: &'static str,
        /// Its rows.
        found: usize,
        /// Rows that the scene makes.
        expected: usize,
    },
    /// A table stands where that of another load step or run belongs.
    #[error("{}: {reason}; it was put there from elsewhere", path.display())]
    Misplaced {
        /// The table.
        path: PathBuf,
        /// What tells so.
        reason: String,
    },
    /// The run to go on with was of another scene.
    #[error(
        "{}: the scene has changed since the run began, at line {line} of its scene.toml\n  then: {ran}\n  now:  {now}\n\
         a run goes on with the scene that it began with; --force begins it anew",
        folder.display()
    )]
    SceneChanged {
        /// Results folder.
        folder: PathBuf,
        /// The first line that differs, from 1.
        line: usize,
        /// That line when the run began.
        ran: String,
        /// That line now.
        now: String,
    },
    /// The run to go on with had other grains or contacts.
    #[error(
        "{}: the scene is the same, but its grains or contacts are not those of the run, which kavics {version} began: \
         a file that the scene reads has changed, or they are made in another way now; --force begins it anew",
        folder.display()
    )]
    OtherAssembly {
        /// Results folder.
        folder: PathBuf,
        /// The version that began it.
        version: String,
    },
    /// A checkpoint or a table is damaged.
    #[error("{}: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// No checkpoint can be used.
    #[error(
        "{reasons}\n{}: no checkpoint is whole; the tables are as they were, --force begins the run anew",
        folder.display()
    )]
    NoCheckpoint {
        /// Results folder.
        folder: PathBuf,
        /// What is wrong with each.
        reasons: String,
    },
    /// A checkpoint means something that this version does not know.
    #[error(
        "{}: a checkpoint of version {found}, which kavics {version} wrote; kavics {} reads version {}",
        path.display(), env!("CARGO_PKG_VERSION"), crate::CHECKPOINT_VERSION
    )]
    CheckpointVersion {
        /// The checkpoint.
        path: PathBuf,
        /// Its version.
        found: u32,
        /// The version of kavics that wrote it.
        version: String,
    },
    /// A checkpoint does not fit the scene.
    #[error("{}: the checkpoint cannot be gone on from: {source}", folder.display())]
    Memory {
        /// Results folder.
        folder: PathBuf,
        /// Why.
        source: kavics::equilibrium::MemoryError,
    },
    /// The tables were written by a later version.
    #[error(
        "{} holds tables of version {found}, written by kavics {version}; this is kavics {}, which reads them up to version {}",
        folder.display(), env!("CARGO_PKG_VERSION"), crate::SCHEMA_VERSION
    )]
    OtherVersion {
        /// The folder.
        folder: PathBuf,
        /// Version of its tables.
        found: u32,
        /// The kavics that wrote them.
        version: String,
    },
    /// Results lack a table.
    #[error("{} is missing: the results are not whole", path.display())]
    Missing {
        /// The table.
        path: PathBuf,
    },
    /// A file has an ending that no format belongs to.
    #[error("{}: expected a file that ends in {expected}", path.display())]
    UnknownEnding {
        /// The file.
        path: PathBuf,
        /// The endings that are known.
        expected: &'static str,
    },
}

impl ResultsError {
    /// Whether a file could not be read since it is not there.
    pub(crate) fn is_absence(&self) -> bool {
        matches!(self, Self::Unreadable { source, .. } if source.kind() == ErrorKind::NotFound)
    }

    /// What is wrong with a file, for a message that names the file itself.
    pub(crate) fn without_path(&self) -> String {
        match self {
            Self::Unreadable { source, .. } | Self::Unwritable { source, .. } => source.to_string(),
            Self::Table { source, .. } => format!("not a Parquet file: {source}"),
            Self::Damaged { reason, .. } => reason.clone(),
            Self::NoColumn { column, .. } => format!("no column is called \"{column}\""),
            Self::WrongColumn { column, wanted, .. } => {
                format!("column \"{column}\" does not hold {wanted}")
            }
            other => other.to_string(),
        }
    }

    /// A file that could not be read.
    pub fn unreadable(path: &Path) -> impl FnOnce(std::io::Error) -> Self + use<> {
        let path = path.to_owned();
        move |source| Self::Unreadable { path, source }
    }

    /// A file that could not be written.
    pub fn unwritable(path: &Path) -> impl FnOnce(std::io::Error) -> Self + use<> {
        let path = path.to_owned();
        move |source| Self::Unwritable { path, source }
    }

    pub(crate) fn table<E: Into<ParquetError>>(path: &Path) -> impl FnOnce(E) -> Self + use<E> {
        let path = path.to_owned();
        move |source| Self::Table {
            path,
            source: source.into(),
        }
    }
}
