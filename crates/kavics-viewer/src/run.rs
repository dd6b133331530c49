//! `run.json` of the page: what ran, and what there is to be shown.

use std::collections::BTreeMap;

use serde::Serialize;

/// Version of the page data; rises when a piece changes its meaning.
pub const FORMAT: u32 = 1;

/// A column that can be asked for.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ColumnRecord {
    /// Its name.
    pub name: String,
    /// Its unit; empty for counts, ids and words.
    pub unit: String,
    /// `number`, `integer` or `word`.
    pub kind: &'static str,
    /// The words that it can hold, as far as they are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub values: Option<Vec<String>>,
}

/// What there is besides the tables that every load step has.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Has {
    /// Whether there are dual edges.
    pub dual: bool,
    /// Load steps with triangles of void cells.
    pub cells: Vec<usize>,
    /// Load steps with a table of void cells.
    pub voids: Vec<usize>,
    /// Load steps with a table of cracks.
    pub cracks: Vec<usize>,
    /// Load steps with modes.
    pub modes: Vec<usize>,
    /// Whether there are principal directions.
    pub crosses: bool,
}

/// What ran, and what there is to be shown.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PageRun {
    /// Version of the page data.
    pub format: u32,
    /// Title of the scene.
    pub title: String,
    /// Version of kavics.
    pub version: String,
    /// Version of the tables.
    pub schema_version: u32,
    /// Seed of the scene.
    pub seed: u64,
    /// `running`, `done`, `no-equilibrium` or `stopped`.
    pub state: kavics_results::RunState,
    /// Why there is no equilibrium.
    pub failure: Option<String>,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Number of grains.
    pub grains: usize,
    /// Number of contacts.
    pub contacts: usize,
    /// Another number whenever there is something new.
    pub change: usize,
    /// Load steps with tables of grains, contacts and sides.
    pub recorded: Vec<usize>,
    /// Rows of `steps`.
    pub load_steps: usize,
    /// Corners of the container, counter-clockwise, `[length]`.
    pub container: Vec<[f64; 2]>,
    /// The columns of each table.
    pub tables: BTreeMap<&'static str, Vec<ColumnRecord>>,
    /// What there is besides.
    pub has: Has,
    /// The scene as it ran.
    pub scene: String,
    /// Whether all data stand in the page itself.
    pub embedded: bool,
}
