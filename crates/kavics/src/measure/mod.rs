//! State variables of an equilibrium, in a window: fabric, graph porosity, stress and its parts, strain, work.
//!
//! In: a [`Snapshot`] and a [`Window`]. Out: one small value a measure.

use crate::assembly::Assembly;
use crate::equilibrium::{Load, State};
use crate::ids::{GrainId, PerBody, PerGrain};

/// All that a measure may read.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot<'a> {
    /// The undeformed assembly.
    pub assembly: &'a Assembly,
    /// Displacements and contacts.
    pub state: &'a State,
    /// External load on each body.
    pub loads: &'a PerBody<Load>,
    /// Reaction at held and moved freedoms.
    pub reactions: &'a PerBody<Load>,
}

/// The grains that are measured.
#[derive(Clone, Debug, Default)]
pub struct Window {
    grains: Vec<GrainId>,
    inside: PerGrain<bool>,
}

impl Window {
    /// The window of `grains`, in an assembly of `count` grains.
    pub fn new(mut grains: Vec<GrainId>, count: usize) -> Self {
        grains.sort_unstable();
        grains.dedup();
        let mut inside = PerGrain::filled(false, count);
        for &grain in &grains {
            inside[grain] = true;
        }
        Self { grains, inside }
    }

    /// The grains in the order of their ids.
    pub fn grains(&self) -> &[GrainId] {
        &self.grains
    }

    /// Whether a grain belongs to the window.
    pub fn contains(&self, grain: GrainId) -> bool {
        self.inside[grain]
    }
}

/// A symmetric tensor of the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SymmetricTensor {
    /// Component xx.
    pub xx: f64,
    /// Component xy.
    pub xy: f64,
    /// Component yy.
    pub yy: f64,
}

/// A tensor of the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tensor {
    /// Component xx.
    pub xx: f64,
    /// Component xy.
    pub xy: f64,
    /// Component yx.
    pub yx: f64,
    /// Component yy.
    pub yy: f64,
}

/// Average stress and its four parts after Cundall & Strack (1983), `[force/length²]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StressPartition {
    /// The whole.
    pub total: Tensor,
    /// Shear part.
    pub shear: Tensor,
    /// Normal variation part.
    pub variation: Tensor,
    /// Fabric part.
    pub fabric: Tensor,
    /// Isotropic part: both diagonal components.
    pub isotropic: f64,
}

/// Every measure of one window at one state; what does not exist is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measures {
    /// Area of the window: its grains' power cells, `[length²]`.
    pub window_area: f64,
    /// Active contacts a grain, rattlers counted.
    pub coordination_number: Option<f64>,
    /// Void area over solid area.
    pub void_ratio: Option<f64>,
    /// Share of the window that the contact graph covers, each contact once.
    pub graph_porosity: Option<f64>,
    /// The same by eqs. 4–5 as printed.
    pub graph_porosity_printed: Option<f64>,
    /// Fabric tensor φ.
    pub fabric: Option<SymmetricTensor>,
    /// Fabric tensor read with the branch vectors: Σ l_i·l_j / Σ l².
    pub fabric_length: Option<SymmetricTensor>,
    /// Branch tensor B.
    pub branch: Option<SymmetricTensor>,
    /// Contact tensor C.
    pub contact: Option<SymmetricTensor>,
    /// Average stress and its parts.
    pub stress: Option<StressPartition>,
    /// Average displacement gradient ∂_i u_j.
    pub strain: Option<Tensor>,
    /// Σ F·Δu over the contacts within the window, `[force·length]`.
    pub contact_work: Option<f64>,
    /// Area times stress times strain, `[force·length]`.
    pub macroscopic_work: Option<f64>,
    /// Hill's boundary term: contact work less macroscopic work, from the forces on the window's grains, `[force·length]`.
    pub boundary_work: Option<f64>,
}

/// Every measure of a window at a state.
pub fn measures(_snapshot: &Snapshot<'_>, _window: &Window) -> Measures {
    unimplemented!()
}

/// Average stress of each grain over its own power cell, `[force/length²]`.
pub fn grain_stress(_snapshot: &Snapshot<'_>) -> PerGrain<Tensor> {
    unimplemented!()
}
