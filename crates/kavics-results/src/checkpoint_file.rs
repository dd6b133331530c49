//! A checkpoint as the bytes of an Arrow file: one row, each column a list.

use std::collections::{BTreeMap, HashMap};
use std::io::Cursor;
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type, UInt8Type};
use arrow_array::{Array, ArrayRef, Float64Array, Int64Array, ListArray, RecordBatch, UInt8Array};
use arrow_buffer::OffsetBuffer;
use arrow_ipc::reader::FileReader;
use arrow_ipc::writer::FileWriter;
use arrow_schema::{ArrowError, DataType, Field, Schema};
use kavics::equilibrium::{Memory, MemoryColumn};

use crate::checkpoint::CheckpointHeader;
use crate::checkpoint_frame;

/// What the columns of the tables begin with.
const TABLE: &str = "table:";
/// Of the header in the metadata.
const HEADER: &str = "kavics";

/// The bytes of a checkpoint.
pub(crate) fn encode(
    header: &CheckpointHeader,
    memory: Memory,
    tables: &[(&str, RecordBatch)],
) -> Result<Vec<u8>, ArrowError> {
    let mut columns: Vec<(String, ArrayRef)> = Vec::new();
    for (name, column) in memory.columns {
        columns.push((name, values(column)));
    }
    for (table, rows) in tables {
        for (field, column) in rows.schema().fields().iter().zip(rows.columns()) {
            columns.push((
                format!("{TABLE}{table}.{}", field.name()),
                Arc::clone(column),
            ));
        }
    }
    let (fields, lists): (Vec<Field>, Vec<ArrayRef>) = columns.into_iter().map(as_list).unzip();
    let header = serde_json::to_string(header).expect("words and counts are JSON");
    let metadata = HashMap::from([(HEADER.to_owned(), header)]);
    let schema = Arc::new(Schema::new_with_metadata(fields, metadata));
    let row = RecordBatch::try_new(Arc::clone(&schema), lists)?;
    let mut writer = FileWriter::try_new(Vec::new(), &schema)?;
    writer.write(&row)?;
    writer.finish()?;
    writer.into_inner()
}

fn values(column: MemoryColumn) -> ArrayRef {
    match column {
        MemoryColumn::Numbers(values) => Arc::new(Float64Array::from(values)),
        MemoryColumn::Integers(values) => Arc::new(Int64Array::from(values)),
        MemoryColumn::Codes(values) => Arc::new(UInt8Array::from(values)),
    }
}

/// A column as a list in one row.
fn as_list((name, values): (String, ArrayRef)) -> (Field, ArrayRef) {
    let item = Arc::new(Field::new_list_field(values.data_type().clone(), true));
    let field = Field::new(name, DataType::List(Arc::clone(&item)), false);
    let offsets = OffsetBuffer::from_lengths([values.len()]);
    (field, Arc::new(ListArray::new(item, offsets, values, None)))
}

/// The header of a checkpoint.
pub(crate) fn header(bytes: &[u8]) -> Result<CheckpointHeader, ArrowError> {
    checkpoint_frame::check(bytes)?;
    let reader = FileReader::try_new(Cursor::new(bytes), None)?;
    let schema = reader.schema();
    let json = schema.metadata().get(HEADER).map_or("", String::as_str);
    serde_json::from_str(json).map_err(|error| ArrowError::ParseError(error.to_string()))
}

/// Memory and tables of a checkpoint whose header was read.
pub(crate) fn decode(bytes: &[u8]) -> Result<(Memory, BTreeMap<String, RecordBatch>), ArrowError> {
    let mut reader = FileReader::try_new(Cursor::new(bytes), None)?;
    let nothing = || ArrowError::ParseError("there is no row".to_owned());
    let row = reader.next().ok_or_else(nothing)??;
    let mut memory = Memory::default();
    let mut tables: BTreeMap<String, Vec<(String, ArrayRef)>> = BTreeMap::new();
    for (field, column) in row.schema().fields().iter().zip(row.columns()) {
        let list = column.as_list_opt::<i32>().ok_or_else(nothing)?;
        let values = list.iter().next().flatten().ok_or_else(nothing)?;
        match field
            .name()
            .strip_prefix(TABLE)
            .and_then(|n| n.split_once('.'))
        {
            Some((table, name)) => {
                let columns = tables.entry(table.to_owned()).or_default();
                columns.push((name.to_owned(), values));
            }
            None => {
                memory
                    .columns
                    .insert(field.name().clone(), remembered(&values)?);
            }
        }
    }
    let batch = |(name, columns)| Ok((name, RecordBatch::try_from_iter(columns)?));
    let tables: Result<_, ArrowError> = tables.into_iter().map(batch).collect();
    Ok((memory, tables?))
}

fn remembered(values: &ArrayRef) -> Result<MemoryColumn, ArrowError> {
    match values.data_type() {
        DataType::Float64 => {
            let values = values.as_primitive::<Float64Type>();
            Ok(MemoryColumn::Numbers(values.values().to_vec()))
        }
        DataType::Int64 => {
            let values = values.as_primitive::<Int64Type>();
            Ok(MemoryColumn::Integers(values.values().to_vec()))
        }
        DataType::UInt8 => {
            let values = values.as_primitive::<UInt8Type>();
            Ok(MemoryColumn::Codes(values.values().to_vec()))
        }
        other => Err(ArrowError::ParseError(format!("a column of {other}"))),
    }
}
