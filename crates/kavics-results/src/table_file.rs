//! A Parquet file that is opened, and whether its offsets stay within it: the library that reads it takes them as they are.

use std::fs::File;
use std::path::Path;

use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::errors::ParquetError;
use parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaData, RowGroupMetaData};

use crate::ResultsError;
use crate::guard::guarded;

/// Opens a Parquet file and reads its footer.
pub(crate) fn open(path: &Path) -> Result<ParquetRecordBatchReaderBuilder<File>, ResultsError> {
    let file = File::open(path).map_err(ResultsError::unreadable(path))?;
    let length = file
        .metadata()
        .map_err(ResultsError::unreadable(path))?
        .len();
    let builder = guarded(|| ParquetRecordBatchReaderBuilder::try_new(file));
    builder
        .and_then(|builder| check(builder.metadata(), length).map(|()| builder))
        .map_err(ResultsError::table(path))
}

fn check(metadata: &ParquetMetaData, length: u64) -> Result<(), ParquetError> {
    let groups = metadata.row_groups();
    let rows = groups.iter().try_fold(0_i64, |sum, group| {
        let rows = group.num_rows();
        (rows >= 0).then(|| sum.checked_add(rows)).flatten()
    });
    let mut columns = groups.iter().flat_map(RowGroupMetaData::columns);
    if rows == Some(metadata.file_metadata().num_rows()) && columns.all(|c| is_within(c, length)) {
        return Ok(());
    }
    let what = "the numbers in its footer do not fit together";
    Err(ParquetError::General(what.to_owned()))
}

fn is_within(column: &ColumnChunkMetaData, length: u64) -> bool {
    let first = column
        .dictionary_page_offset()
        .unwrap_or(column.data_page_offset());
    let bytes = column.compressed_size();
    let end = first.checked_add(bytes);
    let is_within = end.is_some_and(|end| end.cast_unsigned() <= length);
    first >= 0 && bytes >= 0 && column.num_values() >= 0 && is_within
}
