//! Whether a recorded table is that of its load step and run, as far as the footer of its file tells: neither its load
//! step, nor the number of its rows, nor the ranges of what does not change are those of another.

use std::path::Path;

use parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaData, RowGroupMetaData};
use parquet::file::statistics::Statistics;

use crate::ResultsError;
use crate::chosen_columns::unchanging;

/// Checks that all rows of a table are of a load step.
pub(crate) fn check_step(
    path: &Path,
    metadata: &ParquetMetaData,
    step: usize,
) -> Result<(), ResultsError> {
    let ends = columns(metadata, "step").filter_map(ends);
    let mut others = ends.flatten().filter(|found| *found != step as i64);
    match others.next() {
        Some(other) => Err(misplaced(
            path,
            format!("its rows are of load step {other}"),
        )),
        None => Ok(()),
    }
}

/// Checks the number of rows of a table.
pub(crate) fn check_rows(
    path: &Path,
    metadata: &ParquetMetaData,
    expected: usize,
) -> Result<(), ResultsError> {
    let found = metadata.file_metadata().num_rows();
    if found == expected as i64 {
        return Ok(());
    }
    let reason = format!("{found} rows, where the run has {expected}");
    Err(misplaced(path, reason))
}

/// Checks that a table has the rows and the unchanging columns of the same table before loading.
pub(crate) fn check_alike(
    path: &Path,
    table: &str,
    metadata: &ParquetMetaData,
    before: &ParquetMetaData,
) -> Result<(), ResultsError> {
    check_rows(path, metadata, before.file_metadata().num_rows() as usize)?;
    let differs = |column: &&&str| {
        let [here, there] = [metadata, before].map(|m| columns(m, column).collect::<Vec<_>>());
        let pairs = here.iter().zip(&there);
        let is_known = here.len() == there.len();
        is_known
            && pairs
                .into_iter()
                .any(|(a, b)| are_apart(a.statistics(), b.statistics()))
    };
    match unchanging(table).iter().find(differs) {
        Some(column) => {
            let reason = format!("\"{column}\" is not that of the same table before loading");
            Err(misplaced(path, reason))
        }
        None => Ok(()),
    }
}

fn are_apart(one: Option<&Statistics>, other: Option<&Statistics>) -> bool {
    let ends = |of: Option<&Statistics>| {
        let of = of?;
        Some([of.min_bytes_opt()?.to_vec(), of.max_bytes_opt()?.to_vec()])
    };
    matches!((ends(one), ends(other)), (Some(one), Some(other)) if one != other)
}

/// The parts of a column, one of each row group.
fn columns<'m>(
    metadata: &'m ParquetMetaData,
    name: &'m str,
) -> impl Iterator<Item = &'m ColumnChunkMetaData> {
    let all = metadata
        .row_groups()
        .iter()
        .flat_map(RowGroupMetaData::columns);
    all.filter(move |column| column.column_path().string() == name)
}

/// The least and the largest of a column of whole numbers.
fn ends(column: &ColumnChunkMetaData) -> Option<[i64; 2]> {
    match column.statistics()? {
        Statistics::Int64(range) => Some([*range.min_opt()?, *range.max_opt()?]),
        _ => None,
    }
}

fn misplaced(path: &Path, reason: String) -> ResultsError {
    ResultsError::Misplaced {
        path: path.to_owned(),
        reason,
    }
}
