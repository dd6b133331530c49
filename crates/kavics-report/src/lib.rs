//! The report of a run: one self-contained page, made from the results folder alone.
//!
//! In: a results folder. Out: an HTML file without network, with pictures that print and the viewer on some load steps.

mod bars;
mod compared_table;
mod comparison;
mod curves;
mod discs;
mod energy;
mod error;
mod fracture;
mod left_out;
mod modes;
mod moduli;
mod packing;
mod page;
mod plot;
mod rose;
mod tensor;
mod viewer;

use std::path::{Path, PathBuf};

pub use compared_table::{ComparedError, ComparedTable, MatchedBy};
pub use comparison::{Compared, ComparedColumn, Comparison};
pub use error::ReportError;
use kavics_pictures::{axis, number};
use kavics_results::ResultsFolder;
pub use kavics_viewer::{PageError, StepChoice};

/// Writes the report of the results in `folder`, to `report.html` there when `output` says nothing else.
///
/// # Errors
/// Results that cannot be read; a page that cannot be written.
pub fn write(folder: &Path, output: Option<&Path>) -> Result<PathBuf, ReportError> {
    write_steps(folder, output, &StepChoice::Fitting)
}

/// The same with chosen load steps in the viewer.
///
/// # Errors
/// Load steps that are not recorded; results that cannot be read; a page that cannot be written.
pub fn write_steps(
    folder: &Path,
    output: Option<&Path>,
    steps: &StepChoice,
) -> Result<PathBuf, ReportError> {
    let results = ResultsFolder::open(folder)?;
    results.check_whole()?;
    let page = viewer::with_viewer(&page::page(&results)?, folder, steps)?;
    let usual = || folder.join("report.html");
    let path = output.map_or_else(usual, Path::to_owned);
    kavics_results::publish(&path, page.as_bytes())?;
    Ok(path)
}
