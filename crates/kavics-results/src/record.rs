//! `run.json`: what ran, and how it ended.

use kavics::warning::WarningKind;
use serde::{Deserialize, Serialize};

use crate::packing_record::PackingRecord;
use crate::recorded_tables::RecordedTables;

/// Version of the tables; rises when a column changes its meaning.
pub const SCHEMA_VERSION: u32 = 1;

/// How far a run has come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RunState {
    /// Under way, or broken off without a word.
    #[default]
    Running,
    /// Every load step done.
    Done,
    /// A load step has no equilibrium; the steps before it are valid.
    NoEquilibrium,
    /// Stopped from outside.
    Stopped,
}

impl RunState {
    /// The state in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Done => "done",
            Self::NoEquilibrium => "no equilibrium",
            Self::Stopped => "stopped",
        }
    }

    /// The warning that load steps after `last` are missing, where the run has not ended.
    pub fn unfinished(self, last: usize) -> Option<String> {
        let how = match self {
            Self::Done | Self::NoEquilibrium => return None,
            Self::Running => "is under way or was broken off",
            Self::Stopped => "was stopped, and run --resume goes on",
        };
        let what = format!("the run {how}; its tables end with load step {last}");
        Some(WarningKind::RunUnfinished.says(what))
    }
}

/// What ran, and how it ended.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// Version of kavics.
    pub version: String,
    /// Version of the tables.
    pub schema_version: u32,
    /// Title of the scene.
    pub title: String,
    /// Seed of the scene.
    pub seed: u64,
    /// Threads.
    pub threads: usize,
    /// Number of grains.
    pub grains: usize,
    /// Number of contacts.
    pub contacts: usize,
    /// Grains of the window.
    pub window_grains: usize,
    /// How far it has come.
    pub state: RunState,
    /// Why there is no equilibrium.
    pub failure: Option<String>,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Container and wanted sieve curve; none in the results of versions that did not keep them.
    #[serde(default)]
    pub packing: Option<PackingRecord>,
    /// What is recorded of the load steps; none in the results of versions that did not tell.
    #[serde(default)]
    pub recorded: Option<RecordedTables>,
}
