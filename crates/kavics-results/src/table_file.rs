//! A Parquet file that is opened, and whether it is whole: its offsets stay within it, as the library that reads it takes
//! them as they are, and its bytes have their checksums.

use std::fs::File;
use std::ops::Range;
use std::path::{Path, PathBuf};

use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::errors::ParquetError;
use parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaData, RowGroupMetaData};

use crate::ResultsError;
use crate::checksums::Checksums;
use crate::guard::guarded;

/// A Parquet file whose footer is read and whole.
pub(crate) struct TableFile {
    pub(crate) path: PathBuf,
    file: File,
    checksums: Checksums,
    pub(crate) builder: ParquetRecordBatchReaderBuilder<File>,
}

impl TableFile {
    /// Opens a Parquet file and reads its footer.
    pub(crate) fn open(path: &Path) -> Result<Self, ResultsError> {
        let unreadable = || ResultsError::unreadable(path);
        let mut file = File::open(path).map_err(unreadable())?;
        let length = file.metadata().map_err(unreadable())?.len();
        let checksums = Checksums::read(&mut file, length).map_err(unreadable())?;
        if matches!(checksums, Checksums::Damaged) {
            return Err(damaged(path));
        }
        let again = file.try_clone().map_err(unreadable())?;
        let builder = guarded(|| ParquetRecordBatchReaderBuilder::try_new(again));
        let builder = builder
            .and_then(|builder| check(builder.metadata(), length).map(|()| builder))
            .map_err(ResultsError::table(path))?;
        Ok(Self {
            checksums,
            path: path.to_owned(),
            file,
            builder,
        })
    }

    /// Checks the bytes of some columns, in the row groups that have some of `rows`.
    ///
    /// # Errors
    /// Bytes that are not those that were written; a file that cannot be read.
    pub(crate) fn check_columns(
        &mut self,
        columns: &ProjectionMask,
        rows: &Range<usize>,
    ) -> Result<(), ResultsError> {
        let groups = groups_with(self.builder.metadata(), rows);
        let chunks = groups.flat_map(|group| group.columns().iter().enumerate());
        let wanted = chunks.filter(|(column, _)| columns.leaf_included(*column));
        let whole = self
            .checksums
            .hold(&mut self.file, wanted.map(|(_, chunk)| bytes_of(chunk)));
        if whole.map_err(ResultsError::unreadable(&self.path))? {
            Ok(())
        } else {
            Err(damaged(&self.path))
        }
    }
}

fn damaged(path: &Path) -> ResultsError {
    ResultsError::Damaged {
        path: path.to_owned(),
        reason: "damaged: its bytes are not those that were written".to_owned(),
    }
}

/// The row groups that have some of the rows.
fn groups_with<'m>(
    metadata: &'m ParquetMetaData,
    rows: &'m Range<usize>,
) -> impl Iterator<Item = &'m RowGroupMetaData> {
    let mut next = 0;
    metadata.row_groups().iter().filter(move |group| {
        let first = next;
        next += group.num_rows() as usize;
        first < rows.end && rows.start < next
    })
}

/// Where a column of a row group stands, in a file whose offsets were checked.
fn bytes_of(chunk: &ColumnChunkMetaData) -> Range<u64> {
    let (first, count) = chunk.byte_range();
    first..first + count
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
