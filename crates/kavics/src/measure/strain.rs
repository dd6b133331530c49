//! Average displacement gradient, from the triangles between the grains of a window.

use crate::geometry::Vector;
use crate::ids::GrainId;
use crate::measure::{Snapshot, Tensor, Window};

/// Average displacement gradient e_ij = ∂_i u_j: Bagi's strain over the triangles of the regular triangulation whose
/// three grains lie in the window.
///
/// ```math
/// \bar e_{ij} = \frac{\sum_T A_T\, e^T_{ij}}{\sum_T A_T}, \qquad
/// A_T\, e^T_{ij} = -\tfrac12 \sum_{k \in T} b_i^k u_j^k
/// ```
///
/// u^k displacement of the centre of grain k, b^k outward normal of the edge opposite k times its length.
/// Dimensionless; exact for affine displacements on every window; rotations of grains do not enter. None without
/// such a triangle. Bagi (1996); window: decision 0004.
pub fn strain(snapshot: &Snapshot<'_>, window: &Window) -> Option<Tensor> {
    let (mut sum, mut area) = (Tensor::default(), 0.0);
    let triangles = snapshot.assembly.triangles.iter();
    for triangle in triangles.filter(|t| t.iter().all(|&grain| window.contains(grain))) {
        let (part, twice) = twice_integrals(snapshot, triangle);
        sum += part;
        area += twice;
    }
    (area > 0.0).then(|| sum * (1.0 / area))
}

/// Twice the integral of ∂_i u_j over a triangle, and twice its area.
fn twice_integrals(snapshot: &Snapshot<'_>, triangle: &[GrainId; 3]) -> (Tensor, f64) {
    let centre = |k: usize| snapshot.centre(triangle[k]);
    let moved = |k: usize| snapshot.translation(triangle[k]);
    let (first, second) = (centre(1) - centre(0), centre(2) - centre(0));
    // Displacements relative to one corner: the three b add up to nothing.
    let opposite_first = outward(-second);
    let opposite_second = outward(first);
    let integral = Tensor::product(opposite_first, moved(1) - moved(0))
        + Tensor::product(opposite_second, moved(2) - moved(0));
    (integral * -1.0, first.cross(second))
}

/// Outward normal of an edge that runs counter-clockwise, times its length.
fn outward(edge: Vector) -> Vector {
    -edge.quarter_turn()
}
