//! Reading a results folder back, by column name.

use std::fs;
use std::io::ErrorKind;
use std::ops::Range;
use std::path::{Path, PathBuf};

use parquet::arrow::ProjectionMask;
use serde::Deserialize;

use crate::ResultsError;
use crate::chosen_columns::unchanging;
use crate::columns::Columns;
use crate::record::{RunRecord, SCHEMA_VERSION};
use crate::room::{CRACKS, MODES, RECORDED, VOIDS};
use crate::table_file::TableFile;
use crate::table_place;

/// What every version of `run.json` begins with.
#[derive(Deserialize)]
struct Head {
    version: String,
    schema_version: u32,
}

/// A results folder, read only.
#[derive(Clone, Debug)]
pub struct ResultsFolder {
    path: PathBuf,
}

impl ResultsFolder {
    /// The results folder at `path`.
    ///
    /// # Errors
    /// A folder without `run.json`.
    pub fn open(path: &Path) -> Result<Self, ResultsError> {
        if has_record(path)? {
            return Ok(Self {
                path: path.to_owned(),
            });
        }
        Err(match fs::metadata(path) {
            Ok(_) => ResultsError::NotResults {
                folder: path.to_owned(),
            },
            Err(source) => ResultsError::unreadable(path)(source),
        })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file of a table, such as `grains`, at a recorded load step, whether it is there or not.
    pub fn table_path(&self, table: &str, step: usize) -> PathBuf {
        recorded_path(&self.path, table, step)
    }

    /// What ran, and how it ended.
    ///
    /// # Errors
    /// A `run.json` that cannot be read.
    pub fn record(&self) -> Result<RunRecord, ResultsError> {
        let path = self.path.join("run.json");
        let text = self.text("run.json")?;
        let not_json = |source| ResultsError::Json {
            path: path.clone(),
            source,
        };
        let head: Head = serde_json::from_str(&text).map_err(not_json)?;
        if head.schema_version > SCHEMA_VERSION {
            return Err(ResultsError::OtherVersion {
                folder: self.path.clone(),
                found: head.schema_version,
                version: head.version,
            });
        }
        serde_json::from_str(&text).map_err(not_json)
    }

    /// The scene as it ran.
    ///
    /// # Errors
    /// A `scene.toml` that cannot be read.
    pub fn scene(&self) -> Result<String, ResultsError> {
        self.text("scene.toml")
    }

    /// The table that the scene sets beside the run.
    ///
    /// # Errors
    /// A `compare.csv` that is there and cannot be read.
    pub fn compared(&self) -> Result<Option<String>, ResultsError> {
        if self.path.join("compare.csv").exists() {
            self.text("compare.csv").map(Some)
        } else {
            Ok(None)
        }
    }

    /// The table `steps`.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub fn steps(&self) -> Result<Columns, ResultsError> {
        Columns::read(&self.path.join("steps.parquet"))
    }

    /// The table `events`.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub fn events(&self) -> Result<Columns, ResultsError> {
        Columns::read(&self.path.join("events.parquet"))
    }

    /// The table `actions`.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub fn actions(&self) -> Result<Columns, ResultsError> {
        Columns::read(&self.path.join("actions.parquet"))
    }

    /// The table `grains` at a recorded load step.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub fn grains(&self, step: usize) -> Result<Columns, ResultsError> {
        self.recorded("grains", step)
    }

    /// Some columns of the table `grains` at a recorded load step.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub fn some_of_grains(&self, step: usize, names: &[&str]) -> Result<Columns, ResultsError> {
        self.recorded_some("grains", step, Some(names))
    }

    /// Some columns of the table `contacts` at a recorded load step.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub fn some_of_contacts(&self, step: usize, names: &[&str]) -> Result<Columns, ResultsError> {
        self.recorded_some("contacts", step, Some(names))
    }

    /// The table `contacts` at a recorded load step.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub fn contacts(&self, step: usize) -> Result<Columns, ResultsError> {
        self.recorded("contacts", step)
    }

    /// The table `sides` at a recorded load step.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub fn sides(&self, step: usize) -> Result<Columns, ResultsError> {
        self.recorded("sides", step)
    }

    /// The table `cracks` at a recorded load step, of a scene that asks for it; none where there is no such table.
    ///
    /// # Errors
    /// A table that is there and cannot be read.
    pub fn cracks(&self, step: usize) -> Result<Option<Columns>, ResultsError> {
        self.recorded_or_none(CRACKS, step)
    }

    /// The table `voids` at a recorded load step, of a scene that asks for it.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub fn voids(&self, step: usize) -> Result<Columns, ResultsError> {
        self.recorded(VOIDS, step)
    }

    /// The table `modes` at a recorded load step, of a scene that asks for them; none where there is no such table.
    ///
    /// # Errors
    /// A table that is there and cannot be read.
    pub fn modes(&self, step: usize) -> Result<Option<Columns>, ResultsError> {
        self.recorded_or_none(MODES, step)
    }

    /// Some rows of the named columns, or of all, of a table at a recorded load step.
    ///
    /// # Errors
    /// A table that cannot be read, or is of another load step or run.
    pub fn table(
        &self,
        table: &str,
        step: usize,
        names: Option<&[&str]>,
        rows: Range<usize>,
    ) -> Result<Columns, ResultsError> {
        let file = TableFile::open(&self.table_path(table, step))?;
        self.check_place(&file, table, step)?;
        Columns::of_file(file, names, &rows)
    }

    /// Checks a table at a recorded load step that was written: all of it before loading, which everything is drawn on and
    /// measured by, else its footer.
    pub(crate) fn check_table(&self, table: &str, step: usize) -> Result<(), ResultsError> {
        let path = self.table_path(table, step);
        if !path.is_file() {
            return Err(ResultsError::Missing { path });
        }
        let mut file = TableFile::open(&path)?;
        self.check_place(&file, table, step)?;
        if step > 0 {
            return Ok(());
        }
        file.check_columns(&ProjectionMask::all(), &(0..usize::MAX))
    }

    /// Whether a table is that of its load step and of this run.
    fn check_place(&self, file: &TableFile, table: &str, step: usize) -> Result<(), ResultsError> {
        let (path, metadata) = (&file.path, file.builder.metadata());
        table_place::check_step(path, metadata, step)?;
        if !RECORDED.contains(&table) {
            return Ok(());
        }
        if step == 0 {
            let record = self.record()?;
            return match table {
                "grains" => table_place::check_rows(path, metadata, record.grains),
                "contacts" => table_place::check_rows(path, metadata, record.contacts),
                _ => Ok(()),
            };
        }
        let before = TableFile::open(&self.table_path(table, 0))?;
        self.check_place(&before, table, 0)?;
        table_place::check_alike(path, table, metadata, before.builder.metadata())
    }

    fn recorded(&self, table: &str, step: usize) -> Result<Columns, ResultsError> {
        self.recorded_some(table, step, None)
    }

    /// A recorded table; what the scene leaves out of it and does not change is taken from before loading.
    fn recorded_some(
        &self,
        table: &str,
        step: usize,
        names: Option<&[&str]>,
    ) -> Result<Columns, ResultsError> {
        let columns = self.table(table, step, names, 0..usize::MAX)?;
        let known = columns.names();
        let mut missing = unchanging(table).to_vec();
        missing.retain(|name| !known.contains(name) && names.is_none_or(|n| n.contains(name)));
        if step > 0 && !missing.is_empty() {
            let unchanging = self.table(table, 0, Some(&missing), 0..usize::MAX)?;
            if unchanging.len() == columns.len() {
                return Ok(columns.beside(unchanging));
            }
        }
        Ok(columns)
    }

    fn recorded_or_none(&self, table: &str, step: usize) -> Result<Option<Columns>, ResultsError> {
        let there = recorded_path(&self.path, table, step).is_file();
        there.then(|| self.recorded(table, step)).transpose()
    }

    fn text(&self, name: &str) -> Result<String, ResultsError> {
        let path = self.path.join(name);
        fs::read_to_string(&path).map_err(ResultsError::unreadable(&path))
    }
}

/// Whether there is a `run.json` in a folder.
///
/// # Errors
/// A folder that may not be looked into.
pub(crate) fn has_record(folder: &Path) -> Result<bool, ResultsError> {
    let path = folder.join("run.json");
    match fs::metadata(&path) {
        Ok(found) => Ok(found.is_file()),
        Err(error) if error.kind() == ErrorKind::PermissionDenied => {
            Err(ResultsError::unreadable(&path)(error))
        }
        Err(_) => Ok(false),
    }
}

/// The file of a table at a recorded load step.
pub(crate) fn recorded_path(folder: &Path, table: &str, step: usize) -> PathBuf {
    folder.join(table).join(format!("{step:06}.parquet"))
}
