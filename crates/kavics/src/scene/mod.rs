//! The scene file: read, checked, built into what can be solved.
//!
//! In: a TOML file. Out: a [`Scene`], or errors that name file, line, value and what was expected.

mod build;
mod build_contacts;
mod build_grains;
mod build_loading;
mod check_actions;
mod check_box;
mod check_choice;
mod check_contacts;
mod check_control;
mod check_dropped;
mod check_grains;
mod check_layers;
mod check_loading;
mod check_property;
mod check_rows;
mod check_run;
mod check_sizes;
mod check_softening;
mod check_stages;
mod check_strength;
mod checker;
mod choose;
mod diagnostic;
mod edge_load;
mod file;
mod file_contacts;
mod file_grains;
mod fitting;
mod grain_list;
mod loading_plan;
mod named_file;
mod record_columns;
mod rigid_motion;
mod scatter;
mod sides;
mod unit;
mod value;

pub use record_columns::{CONTACT_COLUMNS, GRAIN_COLUMNS, RecordColumns};

use std::path::{Path, PathBuf};

use crate::assembly::{Assembly, Grain, Side};
use crate::contact_law::Property;
use crate::equilibrium::Settings;
use crate::ids::{GrainId, PerGrain, PerProperty, PerSide};
use crate::loading::{Breakage, LoadPath, PathControl, Program};
use crate::packing::SieveCurve;

/// A scene, every name resolved, every number checked, grains placed.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Title for the report.
    pub title: String,
    /// Where every random choice comes from.
    pub seed: u64,
    /// Grains, sides, contacts, dual graph.
    pub assembly: Assembly,
    /// Number of grains of each layer, from the bottom.
    pub layers: Vec<usize>,
    /// Sieve curve that the grains were to have; none where the scene gives none.
    pub wanted_curve: Option<SieveCurve>,
    /// Contact properties in the order of the scene file.
    pub properties: PerProperty<Property>,
    /// Supports, loads, stages.
    pub program: Program,
    /// How equilibria are found.
    pub settings: Settings,
    /// When contacts break.
    pub breakage: Breakage,
    /// What steers the load steps.
    pub control: PathControl,
    /// Grains of the window of `[measure]`.
    pub window: Vec<GrainId>,
    /// Grains and contacts are recorded every so many load steps.
    pub record_every: usize,
    /// Whether void cells are recorded with them.
    pub record_voids: bool,
    /// Whether cracks are recorded with them.
    pub record_cracks: bool,
    /// Columns of grains and contacts that are recorded.
    pub record_columns: RecordColumns,
    /// Table to set beside the run.
    pub compare: Option<PathBuf>,
    /// What the user should know before the run.
    pub warnings: Vec<String>,
    /// The scene file's text, overrides included.
    pub text: String,
}

/// The grains of a scene in their container, before anything is known of contacts.
#[derive(Clone, Debug)]
pub struct Pack {
    /// The grains.
    pub grains: PerGrain<Grain>,
    /// The sides of the container, none present.
    pub sides: PerSide<Side>,
    /// Largest gap of grains that touch, `[length]`.
    pub touching_tolerance: f64,
    /// Sieve curve that the grains were to have; none where the scene gives none.
    pub wanted_curve: Option<SieveCurve>,
}

/// Reads the file of a `listed` grain list that is not csv; the library itself knows no other format.
///
/// The number is that of a frame, from 0, where the scene names one; otherwise the last frame is wanted. Answers rows of (x, y, radius), or a sentence that says what is wrong with the file.
pub type ReadGrains<'a> = dyn Fn(&Path, Option<usize>) -> Result<Vec<[f64; 3]>, String> + 'a;

impl Scene {
    /// Reads a scene file.
    ///
    /// # Errors
    /// All that is wrong with it, each with its place in the file.
    pub fn read(path: &Path, grain_lists: &ReadGrains<'_>) -> Result<Self, SceneError> {
        let text = read_text(path)?;
        Self::parse(
            &text,
            &path.display().to_string(),
            folder(path),
            grain_lists,
        )
    }

    /// Builds a scene from the text of a scene file; `name` stands in messages, file names in it are relative
    /// to `folder`.
    ///
    /// # Errors
    /// All that is wrong with it, each with its place in the text.
    pub fn parse(
        text: &str,
        name: &str,
        folder: &Path,
        grain_lists: &ReadGrains<'_>,
    ) -> Result<Self, SceneError> {
        let file = parse_file(text, name)?;
        build::scene(&file, text, folder, grain_lists).map_err(|checker| checker.error(text, name))
    }

    /// Only places the grains of a scene; contacts, loads and supports may be missing.
    ///
    /// # Errors
    /// What is wrong with box and grains, as [`Scene::parse`] has it.
    pub fn place_grains(
        text: &str,
        name: &str,
        folder: &Path,
        grain_lists: &ReadGrains<'_>,
    ) -> Result<Pack, SceneError> {
        let file = parse_file(text, name)?;
        build::grains(&file, folder, grain_lists).map_err(|checker| checker.error(text, name))
    }

    /// About the number of grains that placing them would give, before any is placed; those of lists do not count.
    ///
    /// None where the text is no scene file, or its box or grains are wrong.
    pub fn planned_grains(text: &str) -> Option<f64> {
        build::planned_grains(&parse_file(text, "").ok()?)
    }

    /// The equilibria of this scene, one load step after the other.
    pub fn load_path(&self) -> LoadPath<'_> {
        LoadPath::new(
            &self.assembly,
            &self.properties,
            &self.program,
            self.breakage,
            self.settings,
        )
        .steered_by(self.control)
    }
}

/// The text of a scene file.
///
/// # Errors
/// A file that cannot be read, or is not text in UTF-8.
pub fn read_text(path: &Path) -> Result<String, SceneError> {
    let bytes = std::fs::read(path).map_err(|source| SceneError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = before.split(|byte| *byte == b'\n').count();
        SceneError::Wrong(format!(
            "{}:{line}: this is not text in UTF-8",
            path.display()
        ))
    })
}

fn folder(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

fn parse_file(text: &str, name: &str) -> Result<file::SceneFile, SceneError> {
    toml::from_str(text).map_err(|error| {
        let mut problems = diagnostic::Problems::default();
        problems.push(diagnostic::from_toml(&error, text));
        SceneError::Wrong(problems.render(text, name))
    })
}

/// JSON Schema of the scene file.
#[cfg(feature = "schema")]
pub fn schema() -> String {
    let schema = schemars::schema_for!(file::SceneFile);
    format!("{:#}", schema.as_value())
}

/// What is wrong with a scene file. Its text shows the lines, marked; one block a mistake.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file, or one that the scene names, could not be read.
    #[error("{}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The scene is wrong; the text as it is shown to the user.
    #[error("{0}")]
    Wrong(String),
}
