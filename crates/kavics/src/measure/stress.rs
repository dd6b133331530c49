//! Average stress of a window and its parts.
//!
//! The window is the power cells of its grains. Their boundaries cut solid at contact points only, so the sum over
//! contacts is the average over the window's area and no estimate. For grain p and its contact c: n leaves the
//! grain, t is n turned by a quarter counter-clockwise, r = a·n + b·t leads from the centre to the contact point,
//! F = F_n·n + F_t·t is the force on the grain, H the thickness of the assembly. Tension is positive.
//! Cundall & Strack (1983); Bojtár & Bagi (1989), eqs. 8–13.

use crate::ids::PerGrain;
use crate::measure::half_contact::{HalfContact, each_half_contact, each_half_contact_of_all};
use crate::measure::{Snapshot, SymmetricTensor, Tensor, Window, window_area};

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
    let mut sums = StressSums::new(snapshot.assembly.grains.len());
    each_half_contact(snapshot, window, |contact| sums.add(contact));
    sums.over(window_area(snapshot, window) * snapshot.assembly.thickness)
}

/// Sums over half contacts, not yet divided by the volume.
#[derive(Clone, Debug)]
pub(super) struct StressSums {
    total: Tensor,
    shear: Tensor,
    /// Σ a F_n n_i n_j: normal variation and fabric part, with the isotropic stress of the latter.
    normal: Tensor,
    isotropic: f64,
    of_grains: PerGrain<NormalSums>,
}

/// Sums over the contacts of one grain.
#[derive(Clone, Copy, Debug, Default)]
struct NormalSums {
    /// Σ a n_i n_j.
    directed: SymmetricTensor,
    /// Σ a F_n.
    force: f64,
}

impl StressSums {
    /// No contact yet, of so many grains.
    pub fn new(grains: usize) -> Self {
        Self {
            total: Tensor::default(),
            shear: Tensor::default(),
            normal: Tensor::default(),
            isotropic: 0.0,
            of_grains: PerGrain::filled(NormalSums::default(), grains),
        }
    }

    pub fn add(&mut self, contact: &HalfContact) {
        let (a, b) = (contact.normal_arm(), contact.tangent_arm());
        let (normal, tangent, force) = (contact.normal, contact.tangent(), contact.force());
        self.total += Tensor::product(contact.lever, force);
        self.shear += Tensor::product(normal, tangent) * (a * contact.shear_force)
            + Tensor::product(tangent, force) * b
            + Tensor::isotropic(-0.5 * b * contact.shear_force);
        self.normal += Tensor::product(normal, normal) * (a * contact.normal_force);
        self.isotropic += 0.5 * (a * contact.normal_force + b * contact.shear_force);
        let of_grain = &mut self.of_grains[contact.grain];
        of_grain.directed += SymmetricTensor::square(normal) * a;
        of_grain.force += a * contact.normal_force;
    }

    /// The stress of a window with this volume, and its parts.
    pub fn over(&self, volume: f64) -> Option<StressPartition> {
        let (mut mean, mut fabric) = (Tensor::default(), Tensor::default());
        for NormalSums { directed, force } in self.of_grains.values() {
            // F̄ of the grain; Σ a is the trace of Σ a n_i n_j.
            let arms = directed.trace();
            if arms != 0.0 {
                let part = directed.full() * (force / arms);
                mean += part;
                fabric += part + Tensor::isotropic(-0.5 * force);
            }
        }
        let per_volume = |part: Tensor| part * (1.0 / volume);
        (volume > 0.0).then(|| StressPartition {
            total: per_volume(self.total),
            shear: per_volume(self.shear),
            variation: per_volume(self.normal + mean * -1.0),
            fabric: per_volume(fabric),
            isotropic: self.isotropic / volume,
        })
    }
}

/// Average stress of each grain over its own power cell, `[force/length²]`; zero where the cell is empty.
pub fn grain_stress(snapshot: &Snapshot<'_>) -> PerGrain<Tensor> {
    let mut stress = PerGrain::filled(Tensor::default(), snapshot.assembly.grains.len());
    each_half_contact_of_all(snapshot, |contact| {
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
    let mut contacts = 0.0;
    each_half_contact(snapshot, window, |contact| contacts += contact.moment);
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
    each_half_contact(snapshot, window, |contact| sum += term(contact));
    let volume = window_area(snapshot, window) * snapshot.assembly.thickness;
    (volume > 0.0).then(|| sum * (1.0 / volume))
}
