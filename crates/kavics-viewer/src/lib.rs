//! The page data of a run, and the page that shows them.
//!
//! In: a results folder. Out: named pieces of data, JSON or Arrow streams, as `docs/page-data.md` says; the files of the
//! page; both in one for a report. No mechanics is computed here.

pub mod bundle;
mod choice;
mod column;
mod crosses;
mod embed;
mod error;
mod folder;
mod graphs;
mod made;
mod piece;
mod read;
mod row;
mod run;
mod script;
mod table;
mod words;

pub use choice::StepChoice;
pub use embed::{Embedded, embed};
pub use error::PageError;
pub use folder::{Content, PageFolder};
pub use piece::{Piece, RunTable, StepTable};
pub use run::{ColumnRecord, Has, PageRun};
pub use script::{admitted, script};
