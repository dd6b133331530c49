//! What the page does without, as the scene leaves out columns that it needs.

use kavics_pictures::PictureError;
use kavics_results::ResultsError;

use crate::ReportError;

/// A part of the page, or nothing and a note where a table has not the columns for it.
///
/// # Errors
/// All other errors as they are.
pub(crate) fn or_note<T: Default>(
    what: &str,
    made: Result<T, ReportError>,
    notes: &mut Vec<String>,
) -> Result<T, ReportError> {
    match made {
        Err(ReportError::Results(ResultsError::NoColumn { column, .. })) => {
            notes.push(format!(
                "{what}: left out, as the scene does not record the column {column}"
            ));
            Ok(T::default())
        }
        Err(ReportError::Picture(PictureError::NoContainer { .. })) => {
            notes.push(format!("{what}: left out, as run.json keeps no container"));
            Ok(T::default())
        }
        made => made,
    }
}
