//! A table read back, column by column.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::{Float32Type, Float64Type, Int32Type, Int64Type};
use arrow_array::{Array, ArrowPrimitiveType, RecordBatch, RecordBatchReader};
use arrow_schema::{DataType, Schema, SchemaRef};
use parquet::arrow::ProjectionMask;
use parquet::errors::ParquetError;

use crate::ResultsError;
use crate::guard::guarded;
use crate::table_file::TableFile;

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
    pub(crate) fn of_file(
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

    /// The same columns, with those that it leaves out since they stand in the table before loading.
    pub(crate) fn beside(self, unchanging: Self) -> Self {
        Self {
            unchanging: Some(Box::new(unchanging)),
            ..self
        }
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
