//! Pictures of a run: what is drawn of an assembly, and how.
//!
//! In: a results folder. Out: the drawn geometry (container, contacts, dual edges, void cells, breaks). No mechanics is
//! computed here.

mod breaks;
mod error;
mod layout;
mod sides;
mod void_triangles;

pub use breaks::{Break, breaks};
pub use error::PictureError;
pub use layout::{Layout, container};
pub use void_triangles::VoidTriangle;
