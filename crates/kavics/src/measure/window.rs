//! The grains that are measured, their area, voids and contacts.

use std::f64::consts::PI;

use crate::ids::{GrainId, PerGrain};
use crate::measure::Snapshot;
use crate::measure::half_contact::each_half_contact;

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

/// Area A of the window: the power cells of its grains, `[length²]`.
pub fn window_area(snapshot: &Snapshot<'_>, window: &Window) -> f64 {
    let cells = &snapshot.assembly.cell_area;
    window.grains().iter().map(|&grain| cells[grain]).sum()
}

/// Void ratio: void area over solid area; none in an empty window.
///
/// ```math
/// e = \frac{A - \sum_p \pi R_p^2}{\sum_p \pi R_p^2}
/// ```
pub fn void_ratio(snapshot: &Snapshot<'_>, window: &Window) -> Option<f64> {
    let grains = &snapshot.assembly.grains;
    let discs = window.grains().iter().map(|&p| grains[p].radius);
    let solid: f64 = discs.map(|radius| PI * radius * radius).sum();
    (solid > 0.0).then(|| (window_area(snapshot, window) - solid) / solid)
}

/// Coordination number Z = Σ m_p / N: active contacts a grain, those with sides and grains without contact
/// counted; none in an empty window.
pub fn coordination_number(snapshot: &Snapshot<'_>, window: &Window) -> Option<f64> {
    let mut contacts = 0;
    each_half_contact(snapshot, window, |_| contacts += 1);
    contacts_a_grain(contacts, window)
}

/// Half contacts over grains; none in an empty window.
pub(super) fn contacts_a_grain(contacts: usize, window: &Window) -> Option<f64> {
    let grains = window.grains().len();
    (grains > 0).then(|| contacts as f64 / grains as f64)
}
