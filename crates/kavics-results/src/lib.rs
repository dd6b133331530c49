//! The results folder of a run: columns, writing, reading.
//!
//! In: a scene and its equilibria with their measures. Out: a folder of tables in which units stand in the field
//! metadata, and the same tables read back by column name. No mechanics is computed here.

mod actions;
mod apart;
mod checkpoint;
mod checkpoint_file;
mod checkpoint_frame;
mod checksums;
mod chosen_columns;
mod column;
mod columns;
mod contacts;
mod cracks;
mod encode;
mod error;
mod events;
mod folder;
mod grain_list;
mod grain_list_dump;
mod grain_list_text;
mod grain_list_xyz;
mod grains;
mod guard;
mod lock;
mod log;
mod modes;
mod packing_record;
mod record;
mod recorded;
mod recorded_tables;
mod results;
mod resume;
mod room;
mod sides;
mod stability;
mod steps;
mod table_file;
mod table_place;
mod voids;
mod warning;

pub use actions::ActionRow;
pub use apart::{check_output, check_output_folder};
pub use checkpoint::{
    CHECKPOINT_VERSION, Checkpoint, CheckpointHeader, check_same, clear_checkpoints,
};
pub use column::{Column, Unit};
pub use columns::{Columns, TableHead};
pub use contacts::ContactRow;
pub use cracks::CrackRow;
pub use encode::{publish, publish_by};
pub use error::ResultsError;
pub use events::EventRow;
pub use folder::ResultsFolder;
pub use grain_list::{grains_csv, read_grains, write_grains};
pub use grains::GrainRow;
pub use guard::is_guarded;
pub use lock::Lock;
pub use log::note_refusal;
pub use modes::ModeRow;
pub use packing_record::{CurveRecord, MassRecord, PackingRecord};
pub use record::{RunRecord, RunState, SCHEMA_VERSION};
pub use recorded::Recorded;
pub use recorded_tables::RecordedTables;
pub use results::{Options, Results};
pub use room::{
    check_apart, check_own, check_room, clear_unfinished, clear_unpublished, has_unpublished,
};
pub use sides::SideRow;
pub use steps::{StepRow, step_columns, write_steps, write_steps_csv};
pub use voids::VoidRow;
