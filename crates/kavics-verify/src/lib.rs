//! The validation cases that come with the program.
//!
//! In: the folders of `validation/`, kept in the program, and the program itself, which runs their scenes. Out: what
//! was expected of each table, what was found, and whether it holds. The numbers are read back from the tables or
//! recomputed from them alone; no mechanics is shared with the program.

mod case;
mod embedded;
mod expected;
mod identities;
mod packed;
mod page;
mod run;
mod tables;

pub use case::{Case, Verifier, VerifyError, case_names};
pub use embedded::FILES;
pub use expected::Finding;
pub use page::page;
pub use run::Run;
pub use tables::{ContactRow, GrainRow, Half, Tables, Vector};
