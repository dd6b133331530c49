//! Supports, loads, stages, breakage schedules and the load path.
//!
//! In: an assembly, its contact properties and a [`Program`]. Out: one equilibrium per load step.

mod advance;
mod boundary;
mod control;
mod event_driven;
mod ledger;
mod load_path;
mod program;
mod refinement;
mod way_memory;
mod work;

pub use control::{Control, PathControl};
pub use load_path::{LoadPath, Station};
pub use program::{Action, AppliedLoad, Breakage, Held, Prescribed, Program, Stage};
