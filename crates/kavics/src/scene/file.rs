//! The scene file word for word: tables, keys and their types. Nothing is checked here but names and types.

use serde::Deserialize;

use super::file_contacts::{ContactsFile, PropertyFile, SideFile, ZoneFile};
use super::file_grains::{BoxFile, GrainsFile};
use super::value::{
    Described, ListOr, Named, Number, Placed, Quantity, ValueOr, optional_table, table, tables,
};

/// A scene file of kavics.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SceneFile {
    /// Title for the report.
    pub title: Option<String>,
    /// Where every random choice comes from; 0 when absent.
    pub seed: Option<Placed<i64>>,
    /// Thickness out of the plane; 1 when absent `[length]`.
    pub thickness: Option<Number>,
    /// The container.
    #[serde(rename = "box")]
    #[serde(default, deserialize_with = "optional_table")]
    pub container: Option<Placed<BoxFile>>,
    /// One layer of grains.
    #[serde(default, deserialize_with = "optional_table")]
    pub grains: Option<Placed<GrainsFile>>,
    /// Several layers of grains, from the bottom, in place of `grains`.
    #[serde(default, deserialize_with = "tables")]
    pub layer: Vec<Placed<GrainsFile>>,
    /// Which grains carry a contact.
    #[serde(default, deserialize_with = "optional_table")]
    pub contacts: Option<Placed<ContactsFile>>,
    /// Contact properties by name.
    #[serde(default)]
    pub contact: Named<PropertyFile>,
    /// Which contact property where; a later zone wins.
    #[serde(default, deserialize_with = "tables")]
    pub zone: Vec<Placed<ZoneFile>>,
    /// The sides of the container that grains touch, by name; sides not named are absent.
    #[serde(default)]
    pub side: Named<SideFile>,
    /// Freedoms of grains that never move.
    #[serde(default, deserialize_with = "tables")]
    pub support: Vec<Placed<SupportFile>>,
    /// Weight of the grains.
    #[serde(default, deserialize_with = "optional_table")]
    pub weight: Option<Placed<WeightFile>>,
    /// Prescribed motions.
    #[serde(default, rename = "move", deserialize_with = "tables")]
    pub moves: Vec<Placed<MoveFile>>,
    /// Forces on edges, grains and sides.
    #[serde(default, deserialize_with = "tables")]
    pub load: Vec<Placed<LoadFile>>,
    /// The parts of the load path.
    #[serde(default, deserialize_with = "tables")]
    pub stage: Vec<Placed<StageFile>>,
    /// How equilibria are found.
    #[serde(default, deserialize_with = "optional_table")]
    pub equilibrium: Option<Placed<EquilibriumFile>>,
    /// What is measured.
    #[serde(default, deserialize_with = "optional_table")]
    pub measure: Option<Placed<MeasureFile>>,
    /// What is written.
    #[serde(default, deserialize_with = "optional_table")]
    pub record: Option<Placed<RecordFile>>,
    /// Table to set beside the run.
    #[serde(default, deserialize_with = "optional_table")]
    pub compare: Option<Placed<CompareFile>>,
}

/// Freedoms of grains that never move.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SupportFile {
    /// Which grains.
    #[serde(deserialize_with = "table")]
    pub grains: Placed<ChoiceFile>,
    /// Which freedoms, of "x", "y", "rotation".
    pub fix: Placed<Vec<Placed<String>>>,
}

/// A choice of grains: exactly one kind.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ChoiceFile {
    /// Grains that touch an edge of the box: "left", "right", "bottom" or "top"; of a polygon "0", "1", ….
    pub edge: Option<Placed<String>>,
    /// Grains by id.
    pub ids: Option<Placed<Vec<Placed<i64>>>>,
    /// Grains with their centre in a range of x `[length]`.
    pub x: Option<Placed<Vec<Number>>>,
    /// Grains with their centre in a range of y `[length]`.
    pub y: Option<Placed<Vec<Number>>>,
    /// true: grains on the boundary of the assembly.
    pub boundary: Option<Placed<bool>>,
}

/// Weight of the grains.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WeightFile {
    /// Density of the grains `[mass/length³]`.
    pub density: Number,
    /// Acceleration of gravity; 9.81 when absent `[length/time²]`.
    pub gravity: Option<Number>,
}

/// A prescribed motion of a side or of grains.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MoveFile {
    /// Name for stages.
    pub name: Placed<String>,
    /// A side that moves: "left", "right", "bottom" or "top"; of a polygon "0", "1", ….
    pub side: Option<Placed<String>>,
    /// Grains that move.
    #[serde(default, deserialize_with = "optional_table")]
    pub grains: Option<Placed<ChoiceFile>>,
    /// Displacement to the right at factor 1 `[length]`.
    pub x: Option<Number>,
    /// Displacement upwards at factor 1 `[length]`.
    pub y: Option<Number>,
    /// Rotation at factor 1 `[radian]`, or "free" beside a strain.
    pub rotation: Option<Number>,
    /// Affine motion of the grains about the centre of the box.
    #[serde(default, deserialize_with = "optional_table")]
    pub strain: Option<Placed<StrainFile>>,
}

/// Displacement gradient of an affine motion; a missing one is 0.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StrainFile {
    /// du_x/dx.
    pub xx: Option<Number>,
    /// du_y/dx.
    pub xy: Option<Number>,
    /// du_x/dy.
    pub yx: Option<Number>,
    /// du_y/dy.
    pub yy: Option<Number>,
}

/// A load: on an edge, on grains or on a side.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LoadFile {
    /// Name for stages.
    pub name: Placed<String>,
    /// Edge of the box along which the load is distributed.
    pub edge: Option<Placed<String>>,
    /// At the edge's start and end, positive along its outward normal `[force/length]`.
    pub normal: Option<Placed<Vec<Number>>>,
    /// At the edge's start and end, positive along the edge `[force/length]`.
    pub shear: Option<Placed<Vec<Number>>>,
    /// Grains that each carry the force.
    #[serde(default, deserialize_with = "optional_table")]
    pub grains: Option<Placed<ChoiceFile>>,
    /// Side that carries the force.
    pub side: Option<Placed<String>>,
    /// The force.
    #[serde(default, deserialize_with = "optional_table")]
    pub force: Option<Placed<ForceFile>>,
}

/// A force and a moment; a missing one is 0.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ForceFile {
    /// To the right `[force]`.
    pub x: Option<Number>,
    /// Upwards `[force]`.
    pub y: Option<Number>,
    /// Counter-clockwise `[force·length]`.
    pub moment: Option<Number>,
}

/// A part of the load path.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StageFile {
    /// Name in the results.
    pub name: Option<Placed<String>>,
    /// Loads, moves and "weight" that this stage drives; all of them when absent.
    pub apply: Option<Placed<Vec<Placed<String>>>>,
    /// The factor at the end of each load step.
    pub factors: Placed<ListOr<Quantity, SeriesFile>>,
}

/// Factors in equal steps from the last one.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SeriesFile {
    /// Last factor.
    pub to: Number,
    /// Number of load steps.
    pub steps: Placed<i64>,
}

impl Described for SeriesFile {
    const EXPECTED: &'static str =
        "a list of factors such as `[1.0, 1.2]`, or `{ to = 3.0, steps = 60 }`";
}

/// How equilibria are found.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EquilibriumFile {
    /// Bound on the residual; 1e-10 when absent.
    pub tolerance: Option<Number>,
    /// "secant" (when absent) or "tangent".
    pub iteration: Option<Placed<String>>,
    /// "worst-first" (when absent), "simultaneous" or "event-driven".
    pub breakage: Option<Placed<String>>,
    /// Relative difference of utilisations below which contacts break together, up to 0.1; 1e-9 when absent.
    pub tie_tolerance: Option<Number>,
    /// Bound on the error of work and energies in a load step, relative to its work, up to 1; 1e-6 when absent.
    pub work_tolerance: Option<Number>,
    /// "auto" (when absent), "direct" or "iterative".
    pub solver: Option<Placed<String>>,
    /// "load" (when absent), "displacement", "dissipation" or "auto".
    pub control: Option<Placed<String>>,
    /// Load steps that a stage may take beyond the number of its factors; 2000 when absent.
    pub most_steps: Option<Placed<i64>>,
}

/// What is measured.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MeasureFile {
    /// "undisturbed" (when absent), "all", ranges of x and y, or ids.
    pub window: Option<Placed<ValueOr<WindowFile>>>,
    /// "step" (when absent) or "iteration".
    pub every: Option<Placed<String>>,
    /// How many of the lowest modes of the tangent are sought at each load step; none when absent.
    pub stability: Option<Placed<i64>>,
    /// Whether the tangent moduli of the window are measured; not when absent.
    pub moduli: Option<bool>,
}

/// Grains of the window.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WindowFile {
    /// Grains with their centre in a range of x `[length]`.
    pub x: Option<Placed<Vec<Number>>>,
    /// Grains with their centre in a range of y `[length]`.
    pub y: Option<Placed<Vec<Number>>>,
    /// Grains by id.
    pub ids: Option<Placed<Vec<Placed<i64>>>>,
}

impl Described for WindowFile {
    const EXPECTED: &'static str =
        "`\"undisturbed\"`, `\"all\"`, `{ x = [0, 1], y = [0, 1] }` or `{ ids = [0, 1] }`";
}

/// What is written.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RecordFile {
    /// Grains and contacts of every k-th load step; 1 when absent.
    pub every: Option<Placed<i64>>,
    /// Whether the void cells of these load steps are recorded too; not when absent.
    pub voids: Option<bool>,
    /// Whether the cracks of these load steps are recorded too; not when absent.
    pub cracks: Option<bool>,
    /// Columns of the tables of grains after loading has begun, besides `step` and `grain`; all when absent.
    pub grains: Option<Vec<Placed<String>>>,
    /// Columns of the tables of contacts after loading has begun, besides `step` and `contact`; all when absent.
    pub contacts: Option<Vec<Placed<String>>>,
}

/// Table to set beside the run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CompareFile {
    /// A csv file with columns of `steps`.
    pub file: Placed<String>,
}
