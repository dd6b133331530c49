//! A table of page data as an Arrow stream: one record batch, not compressed.

use std::sync::Arc;

use arrow_array::{ArrayRef, RecordBatch, RecordBatchOptions};
use arrow_ipc::writer::StreamWriter;
use arrow_schema::{ArrowError, Field, Schema};

use crate::column::PageColumn;

/// The columns as an Arrow stream; all have `rows` rows.
pub(crate) fn stream(columns: Vec<PageColumn>, rows: usize) -> Result<Vec<u8>, ArrowError> {
    let fields: Vec<Field> = columns.iter().map(PageColumn::field).collect();
    let schema = Arc::new(Schema::new(fields));
    let arrays: Vec<ArrayRef> = columns.into_iter().map(PageColumn::into_array).collect();
    let options = RecordBatchOptions::new().with_row_count(Some(rows));
    let batch = RecordBatch::try_new_with_options(Arc::clone(&schema), arrays, &options)?;
    let mut bytes = Vec::with_capacity(batch.get_array_memory_size() + (1 << 12));
    let mut writer = StreamWriter::try_new(&mut bytes, &schema)?;
    writer.write(&batch)?;
    writer.finish()?;
    drop(writer);
    Ok(bytes)
}
