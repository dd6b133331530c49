//! Graph porosity: how much of the window the contact graph covers.

use crate::measure::half_contact::{HalfContact, each_half_contact};
use crate::measure::{Snapshot, Window, window_area};

/// The two readings of the graph porosity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GraphPorosity {
    /// Each contact counted once.
    pub once: f64,
    /// As printed.
    pub printed: f64,
}

/// Graph porosity: the share of the window's area A that the contact graph covers.
///
/// A contact covers the kite between its two centres and its dual edge, ½·s·l in all; each grain p is given the
/// part on its own side, with a the arm from its centre to the contact point along the normal.
///
/// ```math
/// \nu = \frac{1}{A} \sum_p \sum_{c \in p} \tfrac12\, s^c a_p^c
/// \qquad
/// \nu_{\text{printed}} = \frac{1}{A} \sum_p m_p \cdot \tfrac12\, \bar s\, \bar l
/// ```
///
/// Dimensionless; 1 for a hexagonal packing, where the printed form gives 2. None in an empty window, 0 without an
/// active contact. s is the full dual length, and means are taken over the same double sum. Bojtár & Bagi (1989),
/// eqs. 4–5 (decision 0002).
pub fn graph_porosity(snapshot: &Snapshot<'_>, window: &Window) -> Option<GraphPorosity> {
    let mut sums = PorositySums::default();
    each_half_contact(snapshot, window, |contact| sums.add(contact));
    sums.over(window_area(snapshot, window))
}

/// Sums over half contacts.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PorositySums {
    covered: f64,
    dual: f64,
    branch: f64,
    count: f64,
}

impl PorositySums {
    pub fn add(&mut self, contact: &HalfContact) {
        self.covered += 0.5 * contact.dual_length * contact.normal_arm();
        self.dual += contact.dual_length;
        self.branch += contact.branch_length;
        self.count += 1.0;
    }

    /// The graph porosity of a window with this area.
    pub fn over(self, area: f64) -> Option<GraphPorosity> {
        (area > 0.0).then(|| GraphPorosity {
            once: self.covered / area,
            // Σm · ½ s̄ l̄ with s̄ = Σs/Σm and l̄ = Σl/Σm; the bound keeps 0/0 away.
            printed: 0.5 * self.dual * self.branch / (f64::max(self.count, 1.0) * area),
        })
    }
}
