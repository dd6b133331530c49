//! The report of a run: one self-contained page, made from the results folder alone.
//!
//! In: a results folder. Out: an HTML file without scripts and without network.

mod bars;
mod compared_table;
mod comparison;
mod curves;
mod discs;
mod energy;
mod error;
mod fracture;
mod modes;
mod moduli;
mod packing;
mod page;
mod plot;
mod rose;
mod tensor;

use std::path::{Path, PathBuf};

pub use compared_table::{ComparedError, ComparedTable, MatchedBy};
pub use comparison::{Compared, ComparedColumn, Comparison};
pub use error::ReportError;
use kavics_pictures::{axis, number};
use kavics_results::ResultsFolder;

/// Writes the report of the results in `folder`, to `report.html` there when `output` says nothing else.
///
/// # Errors
/// Results that cannot be read; a page that cannot be written.
pub fn write(folder: &Path, output: Option<&Path>) -> Result<PathBuf, ReportError> {
    let results = ResultsFolder::open(folder)?;
    results.check_whole()?;
    let page = page::page(&results)?;
    let usual = || folder.join("report.html");
    let path = output.map_or_else(usual, Path::to_owned);
    kavics_results::publish(&path, page.as_bytes())?;
    Ok(path)
}
