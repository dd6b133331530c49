//! The tables of box and grains of the scene file, word for word.

use serde::Deserialize;

use super::value::{Described, ListOr, Number, Placed, ValueOr, optional_table};

/// The container: a box whose lower left corner is the origin, or a convex polygon.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BoxFile {
    /// Width `[length]`.
    pub width: Option<Number>,
    /// Height `[length]`, or "fit": the box ends at the top of the highest grain.
    pub height: Option<Number>,
    /// Corners (x, y) of a convex container, one after the other, in place of width and height `[length]`.
    pub polygon: Option<Placed<Vec<Placed<Vec<Number>>>>>,
}

/// A layer of grains: exactly one of the tables says how they are placed.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GrainsFile {
    /// Rows of equal discs, each row in the gaps of the one below.
    #[serde(default, deserialize_with = "optional_table")]
    pub hexagonal: Option<Placed<LatticeFile>>,
    /// Rows of equal discs, each disc above one of the row below.
    #[serde(default, deserialize_with = "optional_table")]
    pub square: Option<Placed<LatticeFile>>,
    /// Discs that fall one after another and roll until they rest.
    #[serde(default, deserialize_with = "optional_table")]
    pub dropped: Option<Placed<DroppedFile>>,
    /// Discs that are added one after another, each at two others, from the middle outwards.
    #[serde(
        default,
        rename = "advancing-front",
        deserialize_with = "optional_table"
    )]
    pub advancing_front: Option<Placed<FrontFile>>,
    /// Discs of a wanted packing fraction.
    #[serde(default, deserialize_with = "optional_table")]
    pub target: Option<Placed<TargetFile>>,
    /// Discs from a table.
    #[serde(default, deserialize_with = "optional_table")]
    pub listed: Option<Placed<ListedFile>>,
    /// Height up to which the layer is filled; that of the container when absent in the last layer `[length]`.
    pub top: Option<Number>,
}

/// Regular rows of equal discs.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LatticeFile {
    /// Radius `[length]`.
    pub radius: Number,
    /// Number of grains in each row from the bottom, or number of rows and length of the longest.
    pub rows: Placed<ListOr<i64, RowCountFile>>,
}

/// Rows by their number.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RowCountFile {
    /// Number of rows.
    pub count: Placed<i64>,
    /// Grains in the longest row, which is the lowest.
    pub longest: Placed<i64>,
}

impl Described for RowCountFile {
    const EXPECTED: &'static str =
        "a list of row lengths such as `[5, 4, 5]`, or `{ count = 3, longest = 5 }`";
}

/// Grains that are dropped into the box.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DroppedFile {
    /// Number of grains; until the box is full when absent.
    pub count: Option<Placed<i64>>,
    /// Radius, or the limits between which it is uniform `[length]`.
    pub radius: Option<Placed<ValueOr<RadiiFile>>>,
    /// Sieve curve, in place of a radius.
    #[serde(default, deserialize_with = "optional_table")]
    pub sieve: Option<Placed<SieveFile>>,
    /// Each grain rests at the lowest place of so many drops; 1 when absent.
    pub tries: Option<Placed<i64>>,
}

/// Grains that are added one after another.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FrontFile {
    /// Number of grains; until the container is full when absent.
    pub count: Option<Placed<i64>>,
    /// Radius, or the limits between which it is uniform `[length]`.
    pub radius: Option<Placed<ValueOr<RadiiFile>>>,
    /// Sieve curve, in place of a radius.
    #[serde(default, deserialize_with = "optional_table")]
    pub sieve: Option<Placed<SieveFile>>,
}

/// Grains of a wanted packing fraction.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TargetFile {
    /// Area of the grains over that of the container.
    pub packing_fraction: Number,
    /// Radius, or the limits between which it is uniform `[length]`.
    pub radius: Option<Placed<ValueOr<RadiiFile>>>,
    /// Sieve curve, in place of a radius.
    #[serde(default, deserialize_with = "optional_table")]
    pub sieve: Option<Placed<SieveFile>>,
}

/// Radii between two limits.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RadiiFile {
    /// Smallest radius `[length]`.
    pub from: Number,
    /// Largest radius `[length]`.
    pub to: Number,
}

impl Described for RadiiFile {
    const EXPECTED: &'static str = "a radius, or `{ from = 0.5, to = 1.5 }`";
}

/// A sieve curve.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SieveFile {
    /// Diameters, growing `[length]`.
    pub diameter: Placed<Vec<Number>>,
    /// Share of the mass with a smaller diameter, from 0 to 1.
    pub passing: Placed<Vec<Number>>,
    /// "disc": mass as diameter squared (when absent); "sphere": cubed.
    pub mass: Option<Placed<String>>,
}

/// Grains from a table.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ListedFile {
    /// A csv or parquet file with columns x, y, radius, an extended XYZ file or a dump of LAMMPS.
    pub file: Placed<String>,
    /// Frame of a file that has several, from 0; the last when absent.
    pub frame: Option<Placed<i64>>,
    /// First and last of the grains taken, from 0; all when absent.
    pub rows: Option<Placed<Vec<Placed<i64>>>>,
}
