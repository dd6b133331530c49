//! From rows and columns to Parquet, and from bytes to a file published whole.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow_schema::{DataType, Field, Schema};
use atomic_write_file::AtomicWriteFile;
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_writer::{ArrowColumnChunk, ArrowColumnWriter, compute_leaves};
use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::schema::types::ColumnPath;
use rayon::prelude::*;

use crate::ResultsError;
use crate::checksums::{KEY, Summed, WRITER};
use crate::column::{Column, Read};

/// Rows that are encoded together: few enough that long tables need little memory beside their file.
const ROWS_A_GROUP: usize = 1 << 16;

/// Writes rows as a Parquet file, the same bytes for the same rows; `some` gives the values of a column in a range of
/// them. Columns are encoded side by side.
fn encode<R: Sync, F: Fn(usize) -> ArrayRef + Sync>(
    path: &Path,
    to: impl Write + Send,
    columns: &[Column<R>],
    count: usize,
    some: impl Fn(Range<usize>) -> F,
) -> Result<(), ResultsError> {
    let schema = schema(columns);
    let write = || {
        let to = Summed::new(to);
        let writer = ArrowWriter::try_new(to, Arc::clone(&schema), Some(properties(columns)))?;
        let (mut file, factory) = writer.into_serialized_writer()?;
        for (number, first) in (0..count).step_by(ROWS_A_GROUP).enumerate() {
            let values = some(first..count.min(first + ROWS_A_GROUP));
            let writers = factory.create_column_writers(number)?;
            let chunks = encoded_columns(&schema, values, writers)?;
            let mut group = file.next_row_group()?;
            for chunk in chunks {
                chunk.append_to_row_group(&mut group)?;
            }
            group.close()?;
        }
        file.flush()?;
        let checksums = file.inner_mut().seal();
        file.append_key_value_metadata(KeyValue::new(KEY.to_owned(), checksums));
        Ok(file.into_inner()?.finish()?)
    };
    write().map_err(ResultsError::table::<ParquetError>(path))
}

/// The columns of some rows, each encoded.
fn encoded_columns(
    schema: &Schema,
    values: impl Fn(usize) -> ArrayRef + Sync,
    writers: Vec<ArrowColumnWriter>,
) -> Result<Vec<ArrowColumnChunk>, ParquetError> {
    let tasks = schema.fields().par_iter().enumerate();
    tasks
        .zip(writers)
        .map(|((column, field), mut writer)| {
            for leaf in compute_leaves(field, &values(column))? {
                writer.write(&leaf)?;
            }
            writer.close()
        })
        .collect()
}

fn field<R>(column: &Column<R>) -> Field {
    let kind = match column.read {
        Read::Integer(_) => DataType::Int64,
        Read::Number(_) => DataType::Float64,
        Read::Text(_) => DataType::Utf8,
    };
    let unit = HashMap::from([("unit".to_owned(), column.unit.name().to_owned())]);
    Field::new(&column.name, kind, true).with_metadata(unit)
}

/// The schema of a table.
pub(crate) fn schema<R>(columns: &[Column<R>]) -> Arc<Schema> {
    let fields: Vec<Field> = columns.iter().map(field).collect();
    Arc::new(Schema::new(fields))
}

/// The values of a column.
pub(crate) fn array<R>(column: &Column<R>, rows: &[R]) -> ArrayRef {
    match &column.read {
        Read::Integer(read) => Arc::new(rows.iter().map(read).collect::<Int64Array>()),
        Read::Number(read) => Arc::new(rows.iter().map(read).collect::<Float64Array>()),
        Read::Text(read) => Arc::new(rows.iter().map(read).collect::<StringArray>()),
    }
}

/// The values of a column of which the first stand in an array already, made for a column of the same kind.
pub(crate) fn array_after<R>(column: &Column<R>, first: &dyn Array, rows: &[R]) -> ArrayRef {
    match &column.read {
        Read::Integer(read) => {
            let first = first.as_primitive::<Int64Type>().iter();
            Arc::new(first.chain(rows.iter().map(read)).collect::<Int64Array>())
        }
        Read::Number(read) => {
            let first = first.as_primitive::<Float64Type>().iter();
            Arc::new(first.chain(rows.iter().map(read)).collect::<Float64Array>())
        }
        Read::Text(read) => {
            let first = first.as_string::<i32>().iter();
            Arc::new(first.chain(rows.iter().map(read)).collect::<StringArray>())
        }
    }
}

/// Words repeat and are kept in a dictionary; numbers hardly ever do.
fn properties<R>(columns: &[Column<R>]) -> WriterProperties {
    let mut properties = WriterProperties::builder()
        .set_created_by(format!("{WRITER}{}", env!("CARGO_PKG_VERSION")))
        .set_compression(Compression::SNAPPY)
        .set_dictionary_enabled(false)
        .set_max_row_group_row_count(Some(ROWS_A_GROUP));
    for column in columns {
        if matches!(column.read, Read::Text(_)) {
            let path = ColumnPath::from(column.name.as_str());
            properties = properties.set_column_dictionary_enabled(path, true);
        }
    }
    properties.build()
}

/// Format of a table, by the ending of its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Csv,
    Parquet,
}

impl Format {
    /// The format of the file at `path`.
    ///
    /// # Errors
    /// Another ending.
    pub(crate) fn of(path: &Path) -> Result<Self, ResultsError> {
        let ending = path.extension().unwrap_or_default();
        if ending.eq_ignore_ascii_case("csv") {
            Ok(Self::Csv)
        } else if ending.eq_ignore_ascii_case("parquet") {
            Ok(Self::Parquet)
        } else {
            Err(ResultsError::UnknownEnding {
                path: path.to_owned(),
                expected: ".csv or .parquet",
            })
        }
    }
}

/// Writes a file aside, syncs it and renames it to `path`. A link stays and what it leads to is written; what is
/// no regular file, such as a device or a pipe, is written to as it is.
///
/// # Errors
/// A file that cannot be written.
pub fn publish(path: &Path, bytes: &[u8]) -> Result<(), ResultsError> {
    publish_by(path, |file| {
        file.write_all(bytes)
            .map_err(ResultsError::unwritable(path))
    })
}

/// The same for a file that `write` writes.
///
/// # Errors
/// Those of `write`; a file that cannot be written.
pub fn publish_by(
    path: &Path,
    write: impl FnOnce(&mut (dyn Write + Send)) -> Result<(), ResultsError>,
) -> Result<(), ResultsError> {
    let unwritable = || ResultsError::unwritable(path);
    match (fs::metadata(path), fs::symlink_metadata(path)) {
        (Ok(found), _) if !found.is_file() => {
            let file = OpenOptions::new().write(true).open(path);
            write(&mut file.map_err(unwritable())?)
        }
        (Err(_), Ok(_)) => write(&mut File::create(path).map_err(unwritable())?),
        (found, _) => {
            let target = found.and_then(|_| fs::canonicalize(path));
            let target = target.unwrap_or_else(|_| path.to_owned());
            let mut file = AtomicWriteFile::open(&target).map_err(unwritable())?;
            write(&mut file)?;
            file.commit().map_err(unwritable())
        }
    }
}

/// Encodes rows and publishes them.
pub(crate) fn publish_table<R: Sync>(
    path: &Path,
    columns: &[Column<R>],
    rows: &[R],
) -> Result<(), ResultsError> {
    publish_rows(path, columns, rows.len(), |range| &rows[range])
}

/// Encodes and publishes rows of which only some stand in memory at a time: `some` gives those of a range.
pub(crate) fn publish_rows<R: Sync, G: AsRef<[R]> + Sync>(
    path: &Path,
    columns: &[Column<R>],
    count: usize,
    some: impl Fn(Range<usize>) -> G,
) -> Result<(), ResultsError> {
    let values = |range| {
        let rows = some(range);
        move |column: usize| array(&columns[column], rows.as_ref())
    };
    publish_by(path, |file| encode(path, file, columns, count, values))
}

/// Encodes and publishes rows that come after others, which are encoded already.
pub(crate) fn publish_after<R: Sync>(
    path: &Path,
    columns: &[Column<R>],
    before: Option<&RecordBatch>,
    rows: &[R],
) -> Result<(), ResultsError> {
    let Some(before) = before else {
        return publish_table(path, columns, rows);
    };
    let first = before.num_rows();
    let values = |range: Range<usize>| {
        let [start, end] = [range.start, range.end].map(|row| row.min(first));
        let rows = &rows[range.start.max(first) - first..range.end.max(first) - first];
        move |column: usize| {
            let part = before.column(column).slice(start, end - start);
            array_after(&columns[column], part.as_ref(), rows)
        }
    };
    let count = first + rows.len();
    publish_by(path, |file| encode(path, file, columns, count, values))
}
