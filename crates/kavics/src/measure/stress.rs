//! Average stress of a window and its parts.
//!
//! The window is the power cells of its grains. Their boundaries cut solid at contact points only, so the sum over
//! contacts is the average over the window's area and no estimate. For grain p and its contact c: n leaves the
//! grain, t is n turned by a quarter counter-clockwise, r = a·n + b·t leads from the centre to the contact point,
//! F = F_n·n + F_t·t is the force on the grain, H the thickness of the assembly. Tension is positive.
//! Cundall & Strack (1983); Bojtár & Bagi (1989), eqs. 8–13.

use crate::ids::PerGrain;
use crate::measure::half_contact::{HalfContact, all_half_contacts, half_contacts};
use crate::measure::{Snapshot, Tensor, Window, window_area};

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

/// Average stress of the window.
///
/// ```math
/// \bar\sigma_{ij} = \frac{1}{A H} \sum_p \sum_{c \in p} r_i F_j
/// ```
///
/// `[force/length²]`; none in an empty window. Love and Weber; Bojtár & Bagi (1989), eq. 8.
pub fn average_stress(snapshot: &Snapshot<'_>, window: &Window) -> Option<Tensor> {
    per_volume(snapshot, window, |contact| {
        Tensor::product(contact.lever, contact.force())
    })
}

/// Average stress and its four parts: shear, normal variation, fabric, isotropic.
///
/// ```math
/// \begin{aligned}
/// \sigma^s_{ij} &= \tfrac{1}{AH} \textstyle\sum\sum \left( a F_t\, n_i t_j + b\, t_i F_j - \tfrac12 b F_t\, \delta_{ij} \right) &
/// \sigma^v_{ij} &= \tfrac{1}{AH} \textstyle\sum\sum a (F_n - \bar F)\, n_i n_j \\
/// \sigma^f_{ij} &= \tfrac{1}{AH} \textstyle\sum\sum a \bar F \left( n_i n_j - \tfrac12 \delta_{ij} \right) &
/// \sigma^i &= \tfrac{1}{2AH} \textstyle\sum\sum \left( a F_n + b F_t \right)
/// \end{aligned}
/// ```
///
/// F̄ = Σ a·F_n / Σ a over the active contacts of one grain. The parts add up to the average stress; the first three
/// have no trace. `[force/length²]`; none in an empty window. With contact points on the branches, a = R and b = 0,
/// they are Cundall & Strack's (1983); Bojtár & Bagi (1989), eqs. 10–13 (decision 0003).
pub fn stress_partition(snapshot: &Snapshot<'_>, window: &Window) -> Option<StressPartition> {
    let mean_forces = mean_normal_forces(snapshot);
    let mut parts = StressPartition::default();
    half_contacts(snapshot, window)
        .for_each(|contact| add_parts(&mut parts, &contact, mean_forces[contact.grain]));
    let volume = window_area(snapshot, window) * snapshot.assembly.thickness;
    (volume > 0.0).then(|| StressPartition {
        total: parts.total * (1.0 / volume),
        shear: parts.shear * (1.0 / volume),
        variation: parts.variation * (1.0 / volume),
        fabric: parts.fabric * (1.0 / volume),
        isotropic: parts.isotropic / volume,
    })
}

/// Average stress of each grain over its own power cell, `[force/length²]`; zero where the cell is empty.
pub fn grain_stress(snapshot: &Snapshot<'_>) -> PerGrain<Tensor> {
    let mut stress = PerGrain::filled(Tensor::default(), snapshot.assembly.grains.len());
    all_half_contacts(snapshot).for_each(|contact| {
        stress[contact.grain] += Tensor::product(contact.lever, contact.force());
    });
    let areas = snapshot.assembly.cell_area.values();
    for (tensor, area) in stress.values_mut().iter_mut().zip(areas) {
        let volume = area * snapshot.assembly.thickness;
        *tensor = if volume > 0.0 {
            *tensor * (1.0 / volume)
        } else {
            Tensor::default()
        };
    }
    stress
}

/// What contact moments add to the average stress: a fifth part beside the four.
///
/// ```math
/// \sigma^m_{ij} = -\frac{1}{A H} \sum_p \sum_{c \in p} M^{(p)} t_i n_j
/// ```
///
/// M⁽ᵖ⁾ moment on grain p, read as the first moment of normal tractions over the dual edge. Without trace; added to
/// the average stress it makes it symmetric where no external moment acts. `[force/length²]`; none in an empty window.
pub fn bending_stress(snapshot: &Snapshot<'_>, window: &Window) -> Option<Tensor> {
    per_volume(snapshot, window, |contact| {
        Tensor::product(contact.tangent(), contact.normal) * -contact.moment
    })
}

/// Asymmetry σ_xy − σ_yx of the average stress as the moments on the window's grains demand it.
///
/// ```math
/// \bar\sigma_{xy} - \bar\sigma_{yx} = -\frac{1}{A H} \sum_p \Big( m^p + \sum_{c \in p} M^{(p)} \Big)
/// ```
///
/// m external moment and reaction on grain p, M⁽ᵖ⁾ moment of contact c on it. Equal to the asymmetry of
/// [`average_stress`] where the moments on each grain balance. `[force/length²]`; none in an empty window.
pub fn moment_asymmetry(snapshot: &Snapshot<'_>, window: &Window) -> Option<f64> {
    let contacts: f64 = half_contacts(snapshot, window).map(|c| c.moment).sum();
    let grains = window.grains().iter();
    let external: f64 = grains.map(|&p| snapshot.external(p).moment).sum();
    let volume = window_area(snapshot, window) * snapshot.assembly.thickness;
    (volume > 0.0).then(|| -(contacts + external) / volume)
}

/// Σ of a tensor over the half contacts of the window, over its volume.
fn per_volume(
    snapshot: &Snapshot<'_>,
    window: &Window,
    term: impl Fn(&HalfContact) -> Tensor,
) -> Option<Tensor> {
    let mut sum = Tensor::default();
    half_contacts(snapshot, window).for_each(|contact| sum += term(&contact));
    let volume = window_area(snapshot, window) * snapshot.assembly.thickness;
    (volume > 0.0).then(|| sum * (1.0 / volume))
}

/// F̄ of each grain; zero where it has no active contact.
fn mean_normal_forces(snapshot: &Snapshot<'_>) -> PerGrain<f64> {
    let mut sums = PerGrain::filled((0.0, 0.0), snapshot.assembly.grains.len());
    all_half_contacts(snapshot).for_each(|contact| {
        let arm = contact.normal_arm();
        let (force, arms) = &mut sums[contact.grain];
        *force += arm * contact.normal_force;
        *arms += arm;
    });
    sums.map(|&(force, arms)| if arms == 0.0 { 0.0 } else { force / arms })
}

/// Adds what one half contact gives to each part, not yet divided by the volume.
fn add_parts(parts: &mut StressPartition, contact: &HalfContact, mean_force: f64) {
    let (a, b) = (contact.normal_arm(), contact.tangent_arm());
    let (normal, tangent, force) = (contact.normal, contact.tangent(), contact.force());
    let directed = Tensor::product(normal, normal);
    parts.total += Tensor::product(contact.lever, force);
    parts.shear += Tensor::product(normal, tangent) * (a * contact.shear_force)
        + Tensor::product(tangent, force) * b
        + Tensor::isotropic(-0.5 * b * contact.shear_force);
    parts.variation += directed * (a * (contact.normal_force - mean_force));
    parts.fabric += (directed + Tensor::isotropic(-0.5)) * (a * mean_force);
    parts.isotropic += 0.5 * (a * contact.normal_force + b * contact.shear_force);
}
