//! The tables of contacts, zones and sides of the scene file, word for word.

use serde::Deserialize;

use super::value::{Number, Placed, optional_table, table};

/// Which grains carry a contact.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ContactsFile {
    /// "touching" (when absent) or "neighbours": every edge of the power diagram.
    pub between: Option<Placed<String>>,
    /// Gap up to which grains touch, and overlap that is allowed, in mean radii; 1e-7 when absent.
    pub touching_tolerance: Option<Number>,
}

/// A contact property: exactly one law.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PropertyFile {
    /// Normal force, shear force and moment; breaks.
    #[serde(default, deserialize_with = "optional_table")]
    pub cemented: Option<Placed<CementedFile>>,
    /// Compression and shear only; opens and closes.
    #[serde(default, deserialize_with = "optional_table")]
    pub cohesionless: Option<Placed<CohesionlessFile>>,
}

/// A cemented contact.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CementedFile {
    /// Stiffness: exactly one of the tables.
    #[serde(deserialize_with = "table")]
    pub stiffness: Placed<StiffnessFile>,
    /// Factor by which compression stiffens shear, G = G0 - mu*E*v_n/s; 0 when absent.
    pub shear_hardening: Option<Number>,
    /// "printed" (when absent), "potential" or "history".
    pub reading: Option<Placed<String>>,
    /// Share of G0 below which G does not fall.
    pub shear_floor: Option<Number>,
    /// "tangent" (when absent) or "midpoint" of the dual edge.
    pub contact_point: Option<Placed<String>>,
    /// Whether the contact point's place on the dual edge couples normal force and bending.
    pub eccentric: Option<bool>,
    /// "capped" (when absent), "full", or a length.
    pub dual_length: Option<Number>,
    /// Limits of the force components.
    #[serde(default, deserialize_with = "optional_table")]
    pub strength: Option<Placed<StrengthFile>>,
    /// Energy to break the bond, per area of the dual edge, so that it softens beyond its limits `[force/length]`;
    /// when absent it breaks at once.
    pub fracture_energy: Option<Number>,
    /// "void" (when absent) or the name of another contact.
    pub after_breakage: Option<Placed<String>>,
}

/// A contact without cement.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CohesionlessFile {
    /// Stiffness: exactly one of the tables.
    #[serde(deserialize_with = "table")]
    pub stiffness: Placed<StiffnessFile>,
    /// Factor by which compression stiffens shear; 0 when absent.
    pub shear_hardening: Option<Number>,
    /// "printed" (when absent), "potential" or "history".
    pub reading: Option<Placed<String>>,
    /// Share of G0 below which G does not fall.
    pub shear_floor: Option<Number>,
    /// "tangent" (when absent) or "midpoint" of the dual edge.
    pub contact_point: Option<Placed<String>>,
    /// "capped" (when absent), "full", or a length.
    pub dual_length: Option<Number>,
    /// Coulomb friction coefficient; the law as printed when absent.
    pub friction: Option<Number>,
}

/// Stiffness: exactly one of these.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StiffnessFile {
    /// k = E*s, G*s, E*s^3/12 `[force/length³]`.
    #[serde(default, deserialize_with = "optional_table")]
    pub layer: Option<Placed<ModuliFile>>,
    /// k = E*s/l, G*s/l, E*s^3/(12*l) `[force/length²]`.
    #[serde(default, deserialize_with = "optional_table")]
    pub modulus: Option<Placed<ModuliFile>>,
    /// The stiffnesses themselves `[force/length]`, moment [force*length].
    #[serde(default, deserialize_with = "optional_table")]
    pub direct: Option<Placed<DirectFile>>,
}

/// Moduli of a contact.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ModuliFile {
    /// Normal modulus E.
    pub normal: Number,
    /// Shear modulus G0.
    pub shear: Number,
}

/// Stiffnesses of a contact.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DirectFile {
    /// Normal stiffness `[force/length]`.
    pub normal: Number,
    /// Shear stiffness `[force/length]`.
    pub shear: Number,
    /// Bending stiffness `[force·length]`; for cemented contacts.
    pub moment: Option<Number>,
}

/// Strength of a bond: stresses or forces; a missing one never fails.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StrengthFile {
    /// Limits as stress over the dual edge `[force/length²]`.
    #[serde(default, deserialize_with = "optional_table")]
    pub stress: Option<Placed<LimitsFile>>,
    /// Limits as force `[force]`, bending as moment [force*length].
    #[serde(default, deserialize_with = "optional_table")]
    pub force: Option<Placed<LimitsFile>>,
    /// A factor on all limits, drawn for each contact.
    #[serde(default, deserialize_with = "optional_table")]
    pub scatter: Option<Placed<ScatterFile>>,
}

/// Limits of the force components, each positive.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LimitsFile {
    /// Limit of tension.
    pub tension: Option<Number>,
    /// Limit of compression.
    pub compression: Option<Number>,
    /// Limit of shear.
    pub shear: Option<Number>,
    /// Limit of bending.
    pub bending: Option<Number>,
}

/// How strengths scatter: exactly one of these.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ScatterFile {
    /// Weibull distribution.
    #[serde(default, deserialize_with = "optional_table")]
    pub weibull: Option<Placed<WeibullFile>>,
    /// Uniform distribution.
    #[serde(default, deserialize_with = "optional_table")]
    pub uniform: Option<Placed<UniformFile>>,
    /// Lognormal distribution.
    #[serde(default, deserialize_with = "optional_table")]
    pub lognormal: Option<Placed<LognormalFile>>,
}

/// Weibull distribution.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WeibullFile {
    /// Shape.
    pub shape: Number,
    /// Scale; 1 when absent.
    pub scale: Option<Number>,
}

/// Uniform distribution.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct UniformFile {
    /// Smallest factor.
    pub from: Number,
    /// Largest factor.
    pub to: Number,
}

/// Lognormal distribution.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LognormalFile {
    /// Standard deviation of the logarithm.
    pub deviation: Number,
    /// Median; 1 when absent.
    pub median: Option<Number>,
}

/// Which contact property where: everywhere, in a strip, or a random share.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ZoneFile {
    /// Name of a contact property.
    pub contact: Placed<String>,
    /// Contact points in a strip.
    #[serde(default, deserialize_with = "optional_table")]
    pub strip: Option<Placed<RangesFile>>,
    /// Share of all contacts, at random.
    pub share: Option<Number>,
}

/// Ranges of coordinates; either may be missing.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RangesFile {
    /// From and to `[length]`.
    pub x: Option<Placed<Vec<Number>>>,
    /// From and to `[length]`.
    pub y: Option<Placed<Vec<Number>>>,
}

/// A side of the container: a rigid body that grains touch.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SideFile {
    /// Name of the contact property of its contacts.
    pub contact: Placed<String>,
    /// Grains whose gap to the side is at most this are joined to it, in mean radii; 0 when absent.
    pub reach: Option<Number>,
    /// Its free freedoms, of "x", "y", "rotation"; none when absent.
    pub free: Option<Vec<Placed<String>>>,
}
