//! What `run.json` tells of the packing: what no table of grains can.

use kavics::assembly;
use kavics::packing::{Mass, SieveCurve};
use kavics::scene::Scene;
use serde::{Deserialize, Serialize};

/// The container of the grains and the sieve curve that they were to have.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PackingRecord {
    /// Corners of the container, counter-clockwise, `[length]`.
    pub container: Vec<[f64; 2]>,
    /// The wanted sieve curve; none where the scene gives none.
    pub wanted_curve: Option<CurveRecord>,
}

/// A sieve curve: the share of the mass that passes, linear in the logarithm of the diameter between those given.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CurveRecord {
    /// Diameters, rising, `[length]`.
    pub diameter: Vec<f64>,
    /// Share of the mass in grains up to each.
    pub passing: Vec<f64>,
    /// Whether mass grows as d² (`disc`) or d³ (`sphere`).
    pub mass: MassRecord,
}

/// How mass grows with the diameter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MassRecord {
    /// As d².
    #[default]
    Disc,
    /// As d³.
    Sphere,
}

impl PackingRecord {
    pub(crate) fn of(scene: &Scene) -> Self {
        let container = assembly::container(&scene.assembly.sides);
        let corners = container.corners().iter();
        Self {
            container: corners.map(|corner| [corner.x, corner.y]).collect(),
            wanted_curve: scene.wanted_curve.clone().map(CurveRecord::from),
        }
    }
}

impl From<SieveCurve> for CurveRecord {
    fn from(curve: SieveCurve) -> Self {
        Self {
            diameter: curve.diameter,
            passing: curve.passing,
            mass: match curve.mass {
                Mass::Disc => MassRecord::Disc,
                Mass::Sphere => MassRecord::Sphere,
            },
        }
    }
}

impl From<CurveRecord> for SieveCurve {
    fn from(curve: CurveRecord) -> Self {
        Self {
            diameter: curve.diameter,
            passing: curve.passing,
            mass: match curve.mass {
                MassRecord::Disc => Mass::Disc,
                MassRecord::Sphere => Mass::Sphere,
            },
        }
    }
}
