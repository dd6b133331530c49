//! Graph porosity: how much of the window the contact graph covers.

use crate::measure::half_contact::half_contacts;
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
    let area = window_area(snapshot, window);
    let (mut covered, mut dual, mut branch, mut count) = (0.0, 0.0, 0.0, 0.0);
    half_contacts(snapshot, window).for_each(|contact| {
        covered += 0.5 * contact.dual_length * contact.normal_arm();
        dual += contact.dual_length;
        branch += contact.branch_length;
        count += 1.0;
    });
    (area > 0.0).then(|| GraphPorosity {
        once: covered / area,
        // Σm · ½ s̄ l̄ with s̄ = Σs/Σm and l̄ = Σl/Σm; the bound keeps 0/0 away.
        printed: 0.5 * dual * branch / (f64::max(count, 1.0) * area),
    })
}
