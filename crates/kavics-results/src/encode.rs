//! From rows and columns to Parquet, and from bytes to a file published whole.

use std::collections::HashMap;
use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow_schema::{DataType, Field, Schema};
use atomic_write_file::AtomicWriteFile;
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::properties::WriterProperties;
use parquet::schema::types::ColumnPath;

use crate::ResultsError;
use crate::column::{Column, Read};

/// Rows that are encoded together: few enough that long tables need little memory beside their file.
const ROWS_A_GROUP: usize = 1 << 16;

/// The rows as a Parquet file: the same bytes for the same rows.
pub(crate) fn encode<R>(
    path: &Path,
    columns: &[Column<R>],
    rows: &[R],
) -> Result<Vec<u8>, ResultsError> {
    let fields: Vec<Field> = columns.iter().map(field).collect();
    let schema = Arc::new(Schema::new(fields));
    let mut writer =
        ArrowWriter::try_new(Vec::new(), Arc::clone(&schema), Some(properties(columns)))
            .map_err(ResultsError::table(path))?;
    for some in rows.chunks(ROWS_A_GROUP) {
        let arrays = columns.iter().map(|column| array(column, some)).collect();
        let batch =
            RecordBatch::try_new(Arc::clone(&schema), arrays).map_err(ResultsError::table(path))?;
        writer.write(&batch).map_err(ResultsError::table(path))?;
    }
    writer.into_inner().map_err(ResultsError::table(path))
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

fn array<R>(column: &Column<R>, rows: &[R]) -> ArrayRef {
    match &column.read {
        Read::Integer(read) => Arc::new(rows.iter().map(read).collect::<Int64Array>()),
        Read::Number(read) => Arc::new(rows.iter().map(read).collect::<Float64Array>()),
        Read::Text(read) => Arc::new(rows.iter().map(read).collect::<StringArray>()),
    }
}

/// Words repeat and are kept in a dictionary; numbers hardly ever do.
fn properties<R>(columns: &[Column<R>]) -> WriterProperties {
    let mut properties = WriterProperties::builder()
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
    let write = || match (fs::metadata(path), fs::symlink_metadata(path)) {
        (Ok(found), _) if !found.is_file() => {
            OpenOptions::new().write(true).open(path)?.write_all(bytes)
        }
        (Ok(_), _) => replace(&fs::canonicalize(path)?, bytes),
        (Err(_), Ok(_)) => fs::write(path, bytes),
        (Err(_), Err(_)) => replace(path, bytes),
    };
    write().map_err(ResultsError::unwritable(path))
}

fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = AtomicWriteFile::open(path)?;
    file.write_all(bytes)?;
    file.commit()
}

/// Encodes rows and publishes them.
pub(crate) fn publish_table<R>(
    path: &Path,
    columns: &[Column<R>],
    rows: &[R],
) -> Result<(), ResultsError> {
    publish(path, &encode(path, columns, rows)?)
}
