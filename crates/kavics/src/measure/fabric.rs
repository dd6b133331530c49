//! Fabric, branch and contact tensors: where contact normals point, weighted by 1, l and s.
//!
//! Bojtár & Bagi (1989), eqs. 1–3, over the grains of the window and the active contacts of each, those with sides
//! included: a contact within the window counts twice, one that leaves it and one with a side once.

use crate::geometry::Vector;
use crate::measure::half_contact::{HalfContact, each_half_contact};
use crate::measure::{Snapshot, SymmetricTensor, Window};

/// The four readings of where contacts point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FabricTensors {
    pub fabric: Option<SymmetricTensor>,
    pub fabric_length: Option<SymmetricTensor>,
    pub branch: Option<SymmetricTensor>,
    pub contact: Option<SymmetricTensor>,
}

/// The sums of all four.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FabricSums(Weighted<4>);

impl FabricSums {
    pub fn add(&mut self, c: &HalfContact) {
        let weights = [1.0, squared_length(c), c.branch_length, c.dual_length];
        self.0.add(c.normal, weights);
    }

    pub fn tensors(self) -> FabricTensors {
        let [fabric, fabric_length, branch, contact] = self.0.tensors();
        FabricTensors {
            fabric,
            fabric_length,
            branch,
            contact,
        }
    }
}

/// Fabric tensor: how contact normals n are spread over directions.
///
/// ```math
/// \varphi_{ij} = \frac{\sum_p \sum_{c \in p} n_i^c n_j^c}{\sum_p m_p}
/// ```
///
/// Symmetric, trace 1, dimensionless; none without an active contact. Satake (1982); Bojtár & Bagi (1989), eq. 1,
/// first form.
pub fn fabric_tensor(snapshot: &Snapshot<'_>, window: &Window) -> Option<SymmetricTensor> {
    let [tensor] = weighted(snapshot, window, |_| [1.0]);
    tensor
}

/// Fabric tensor read with the branch vectors l: every contact weighs its squared branch length.
///
/// ```math
/// \varphi^l_{ij} = \frac{\sum_p \sum_{c \in p} l_i^c l_j^c}{\sum_p \sum_{c \in p} (l^c)^2}
/// ```
///
/// Symmetric, trace 1, dimensionless; none without an active contact. Bojtár & Bagi (1989), eq. 1, second form,
/// whose printed denominator Σ l has not this trace (decision 0001).
pub fn fabric_length_tensor(snapshot: &Snapshot<'_>, window: &Window) -> Option<SymmetricTensor> {
    let [tensor] = weighted(snapshot, window, |c| [squared_length(c)]);
    tensor
}

/// Branch tensor: contact normals n weighted by branch length l.
///
/// ```math
/// B_{ij} = \frac{\sum_p \sum_{c \in p} l^c n_i^c n_j^c}{\sum_p \sum_{c \in p} l^c}
/// ```
///
/// Symmetric, trace 1, dimensionless; none without an active contact; φ where all branches are equal.
/// Bojtár & Bagi (1989), eq. 2.
pub fn branch_tensor(snapshot: &Snapshot<'_>, window: &Window) -> Option<SymmetricTensor> {
    let [tensor] = weighted(snapshot, window, |c| [c.branch_length]);
    tensor
}

/// Contact tensor: contact normals n weighted by the full dual length s.
///
/// ```math
/// C_{ij} = \frac{\sum_p \sum_{c \in p} s^c n_i^c n_j^c}{\sum_p \sum_{c \in p} s^c}
/// ```
///
/// Symmetric, trace 1, dimensionless; none without an active contact. Bojtár & Bagi (1989), eq. 3.
pub fn contact_tensor(snapshot: &Snapshot<'_>, window: &Window) -> Option<SymmetricTensor> {
    let [tensor] = weighted(snapshot, window, |c| [c.dual_length]);
    tensor
}

fn squared_length(contact: &HalfContact) -> f64 {
    contact.branch_length * contact.branch_length
}

/// Fabric tensor of contacts that are given by their normals alone, each once.
///
/// ```math
/// \varphi_{ij} = \frac{1}{M} \sum_c n_i^c n_j^c
/// ```
///
/// [`fabric_tensor`] of all M contacts where none of them is with a side; none without a contact.
pub fn fabric_of_normals(normals: impl Iterator<Item = Vector>) -> Option<SymmetricTensor> {
    let mut sums = Weighted::default();
    normals.for_each(|normal| sums.add(normal, [1.0]));
    let [tensor] = sums.tensors();
    tensor
}

/// Σ w n_i n_j / Σ w over the contacts of a window, for each of several weights w.
fn weighted<const N: usize>(
    snapshot: &Snapshot<'_>,
    window: &Window,
    weights: impl Fn(&HalfContact) -> [f64; N],
) -> [Option<SymmetricTensor>; N] {
    let mut sums = Weighted::default();
    each_half_contact(snapshot, window, |contact| {
        sums.add(contact.normal, weights(contact));
    });
    sums.tensors()
}

/// Σ w n_i n_j and Σ w for each of several weights w.
#[derive(Clone, Copy, Debug)]
struct Weighted<const N: usize>([(SymmetricTensor, f64); N]);

impl<const N: usize> Default for Weighted<N> {
    fn default() -> Self {
        Self([(SymmetricTensor::default(), 0.0); N])
    }
}

impl<const N: usize> Weighted<N> {
    fn add(&mut self, normal: Vector, weights: [f64; N]) {
        let directed = SymmetricTensor::square(normal);
        for ((tensor, total), weight) in self.0.iter_mut().zip(weights) {
            *tensor += directed * weight;
            *total += weight;
        }
    }

    fn tensors(self) -> [Option<SymmetricTensor>; N] {
        let ratio =
            |(tensor, total): (SymmetricTensor, f64)| (total > 0.0).then(|| tensor * (1.0 / total));
        self.0.map(ratio)
    }
}
