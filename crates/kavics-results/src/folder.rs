//! Reading a results folder back, by column name.

use std::fs;
use std::io::ErrorKind;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::{Float32Type, Float64Type, Int32Type, Int64Type};
use arrow_array::{Array, ArrowPrimitiveType, RecordBatch, RecordBatchReader};
use arrow_schema::{DataType, Schema, SchemaRef};
use parquet::arrow::ProjectionMask;
use parquet::errors::ParquetError;
use serde::Deserialize;

use crate::ResultsError;
use crate::chosen_columns::unchanging;
use crate::guard::guarded;
use crate::record::{RunRecord, SCHEMA_VERSION};
use crate::room::{CRACKS, MODES, RECORDED, VOIDS};
use crate::table_file::TableFile;
use crate::table_place;

/// A table read back, column by column.
#[derive(Debug)]
pub struct Columns {
    path: PathBuf,
    schema: SchemaRef,
    batches: Vec<RecordBatch>,
    rows: usize,
    /// Columns that this table leaves out since they stand in the table before loading.
    unchanging: Option<Box<Columns>>,
}

impl Columns {
    /// Reads a Parquet file.
    ///
    /// # Errors
    /// A file that cannot be read, or holds something else.
    pub fn read(path: &Path) -> Result<Self, ResultsError> {
        Self::read_some(path, None)
    }

    /// Reads the named columns only, where there are names; names that the table lacks are passed over.
    ///
    /// # Errors
    /// A file that cannot be read, or holds something else.
    pub fn read_some(path: &Path, names: Option<&[&str]>) -> Result<Self, ResultsError> {
        Self::read_rows(path, names, 0..usize::MAX)
    }

    /// Reads some rows of the named columns, or of all, as far as the table reaches.
    ///
    /// # Errors
    /// A file that cannot be read, or holds something else.
    pub fn read_rows(
        path: &Path,
        names: Option<&[&str]>,
        rows: Range<usize>,
    ) -> Result<Self, ResultsError> {
        Self::of_file(TableFile::open(path)?, names, &rows)
    }

    /// Some rows of the named columns of a file that is open.
    fn of_file(
        mut table: TableFile,
        names: Option<&[&str]>,
        rows: &Range<usize>,
    ) -> Result<Self, ResultsError> {
        let mask = names.map_or_else(ProjectionMask::all, |names| {
            ProjectionMask::columns(table.builder.parquet_schema(), names.iter().copied())
        });
        table.check_columns(&mask, rows)?;
        let path = table.path;
        let builder = table.builder.with_projection(mask).with_batch_size(1 << 16);
        let builder = builder.with_offset(rows.start).with_limit(rows.len());
        let read = guarded(|| {
            let reader = builder.build()?;
            let schema = reader.schema();
            let batches: Result<Vec<RecordBatch>, _> = reader.collect();
            Ok((schema, batches?))
        });
        let (schema, batches) = read.map_err(ResultsError::table::<ParquetError>(&path))?;
        Ok(Self {
            schema,
            rows: batches.iter().map(RecordBatch::num_rows).sum(),
            batches,
            path,
            unchanging: None,
        })
    }

    /// The columns of rows that stand in memory; `path` is for messages.
    pub(crate) fn of(path: &Path, rows: RecordBatch) -> Self {
        Self {
            path: path.to_owned(),
            schema: rows.schema(),
            rows: rows.num_rows(),
            batches: vec![rows],
            unchanging: None,
        }
    }

    /// What the columns are called and hold; their units stand in the metadata of the fields under `unit`.
    pub fn schema(&self) -> &Schema {
        &self.schema
    }

    /// The rows, in their order, in pieces.
    pub fn batches(&self) -> &[RecordBatch] {
        &self.batches
    }

    /// The names of the columns in their order.
    pub fn names(&self) -> Vec<&str> {
        let fields = self.schema.fields().iter();
        fields.map(|field| field.name().as_str()).collect()
    }

    /// Whether a column holds counts or ids.
    pub fn is_whole(&self, column: &str) -> bool {
        let field = self.schema.field_with_name(column);
        field.is_ok_and(|field| *field.data_type() == DataType::Int64)
    }

    /// Whether a column holds words.
    pub fn is_text(&self, column: &str) -> bool {
        let field = self.schema.field_with_name(column);
        field.is_ok_and(|field| *field.data_type() == DataType::Utf8)
    }

    /// The dimension of a column, as in the metadata of its field; none where there is no such column.
    pub fn unit(&self, column: &str) -> Option<&str> {
        let field = self.schema.field_with_name(column).ok()?;
        field.metadata().get("unit").map(String::as_str)
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// A column of numbers; NaN where there is none.
    ///
    /// # Errors
    /// No such column, or one of words.
    pub fn numbers(&self, column: &str) -> Result<Vec<f64>, ResultsError> {
        self.gather(column, "numbers", |array| match array.data_type() {
            DataType::Float64 => Some(values::<Float64Type, _>(array, f64::NAN, |v| v)),
            DataType::Float32 => Some(values::<Float32Type, _>(array, f64::NAN, f64::from)),
            DataType::Int64 => Some(values::<Int64Type, _>(array, f64::NAN, |v| v as f64)),
            DataType::Int32 => Some(values::<Int32Type, _>(array, f64::NAN, f64::from)),
            _ => None,
        })
    }

    /// A column of counts or ids.
    ///
    /// # Errors
    /// No such column, or one of other values.
    pub fn integers(&self, column: &str) -> Result<Vec<Option<i64>>, ResultsError> {
        self.gather(column, "whole numbers", |array| match array.data_type() {
            DataType::Int64 => Some(values::<Int64Type, _>(array, None, Some)),
            _ => None,
        })
    }

    /// A column of words; empty where there is none.
    ///
    /// # Errors
    /// No such column, or one of numbers.
    pub fn texts(&self, column: &str) -> Result<Vec<&str>, ResultsError> {
        self.gather(column, "words", |array| {
            let words = array.as_string_opt::<i32>()?;
            Some(words.iter().map(Option::unwrap_or_default).collect())
        })
    }

    fn gather<'a, T>(
        &'a self,
        column: &str,
        wanted: &'static str,
        read: impl Fn(&'a dyn Array) -> Option<Vec<T>>,
    ) -> Result<Vec<T>, ResultsError> {
        if self.schema.field_with_name(column).is_err() {
            let has_it = |other: &Self| other.schema.field_with_name(column).is_ok();
            if let Some(unchanging) = self.unchanging.as_deref().filter(|other| has_it(other)) {
                return unchanging.gather(column, wanted, read);
            }
            return Err(ResultsError::NoColumn {
                path: self.path.clone(),
                column: column.to_owned(),
            });
        }
        let mut all = Vec::with_capacity(self.rows);
        for batch in &self.batches {
            let array = &batch[column];
            all.extend(
                read(array.as_ref()).ok_or_else(|| ResultsError::WrongColumn {
                    path: self.path.clone(),
                    column: column.to_owned(),
                    wanted,
                })?,
            );
        }
        Ok(all)
    }
}

fn values<A: ArrowPrimitiveType, T: Clone>(
    array: &dyn Array,
    none: T,
    turn: impl Fn(A::Native) -> T,
) -> Vec<T> {
    let array = array.as_primitive::<A>();
    array
        .iter()
        .map(|value| value.map_or_else(|| none.clone(), &turn))
        .collect()
}

/// What stands at the end of a table's file: its columns, and how many rows there are.
#[derive(Clone, Debug)]
pub struct TableHead {
    /// What the columns are called and hold.
    pub schema: SchemaRef,
    /// Number of rows.
    pub rows: usize,
}

impl TableHead {
    /// Reads the head of a Parquet file, and no row.
    ///
    /// # Errors
    /// A file that cannot be read, or holds something else.
    pub fn read(path: &Path) -> Result<Self, ResultsError> {
        let builder = TableFile::open(path)?.builder;
        Ok(Self {
            schema: Arc::clone(builder.schema()),
            rows: builder.metadata().file_metadata().num_rows() as usize,
        })
    }
}

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
        let mut columns = self.table(table, step, names, 0..usize::MAX)?;
        let known = columns.names();
        let mut missing = unchanging(table).to_vec();
        missing.retain(|name| !known.contains(name) && names.is_none_or(|n| n.contains(name)));
        if step > 0 && !missing.is_empty() {
            let unchanging = self.table(table, 0, Some(&missing), 0..usize::MAX)?;
            let whole = unchanging.len() == columns.len();
            columns.unchanging = whole.then(|| Box::new(unchanging));
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
