//! Work of contact forces, of average stress on average strain, and what lies between them.
//!
//! For any displacements u, any forces in equilibrium and any tensor e the work of the contacts within a window is
//! that of its average stress on e and a boundary term: A·H·σ_ij·e_ij plus [`boundary_work`]. Displacements are
//! those of the centres, and whole: there is no ½ and no porosity in it.

use crate::assembly::Partner;
use crate::geometry::Vector;
use crate::ids::ContactId;
use crate::measure::half_contact::{HalfContact, each_half_contact};
use crate::measure::{Snapshot, Tensor, Window, window_area};

/// Work of the contact forces within the window on the displacements of the centres.
///
/// ```math
/// W_c = \sum_c F \cdot (u^j - u^i)
/// ```
///
/// Over active contacts with both grains i and j in the window, F the force on the first, i. `[force·length]`.
pub fn contact_work(snapshot: &Snapshot<'_>, window: &Window) -> f64 {
    let mut work = 0.0;
    each_half_contact(snapshot, window, |contact| {
        work += half_of_work(snapshot, window, contact);
    });
    work
}

/// What one of its two grains adds to the work of a contact; nothing where the contact leaves the window.
pub(super) fn half_of_work(snapshot: &Snapshot<'_>, window: &Window, contact: &HalfContact) -> f64 {
    match contact.partner {
        Partner::Grain(other) if window.contains(other) => {
            let opening = snapshot.translation(other) - snapshot.translation(contact.grain);
            0.5 * contact.force().dot(opening)
        }
        _ => 0.0,
    }
}

/// Work of an average stress on an average strain, A·H·σ_ij·e_ij, `[force·length]`.
///
/// A area of the window, H thickness.
pub fn macroscopic_work(
    snapshot: &Snapshot<'_>,
    window: &Window,
    stress: Tensor,
    strain: Tensor,
) -> f64 {
    window_area(snapshot, window) * snapshot.assembly.thickness * stress.inner(strain)
}

/// Hill's boundary term for a window and a displacement gradient e_ij = ∂_i u_j.
///
/// ```math
/// W_b = \sum_p f_j^p (u_j^p - e_{kj} x_k^p) + \sum_{p} \sum_{c \in \partial p} F_j (u_j^p - e_{kj} x_k^c)
/// ```
///
/// f external load and reaction on grain p at its centre; the second sum over active contacts, at x^c, with bodies
/// outside the window, F the force on the grain. In equilibrium [`contact_work`] less [`macroscopic_work`], whatever
/// u and e; zero where loaded grains and contacts across the boundary follow e. `[force·length]`.
/// Hill (1963), for contacts.
pub fn boundary_work(snapshot: &Snapshot<'_>, window: &Window, gradient: Tensor) -> f64 {
    let mut work = work_of_loads(snapshot, window, gradient);
    each_half_contact(snapshot, window, |contact| {
        work += work_across(snapshot, window, gradient, contact);
    });
    work
}

/// The first sum of [`boundary_work`], over loads and reactions.
pub(super) fn work_of_loads(snapshot: &Snapshot<'_>, window: &Window, gradient: Tensor) -> f64 {
    let mut work = 0.0;
    for &grain in window.grains() {
        let (load, centre) = (snapshot.external(grain), snapshot.centre(grain));
        let fluctuation = snapshot.translation(grain) - gradient.at(centre);
        work += Vector::new(load.x, load.y).dot(fluctuation);
    }
    work
}

/// What a contact adds to the second sum of [`boundary_work`]; nothing where it lies within the window.
pub(super) fn work_across(
    snapshot: &Snapshot<'_>,
    window: &Window,
    gradient: Tensor,
    contact: &HalfContact,
) -> f64 {
    if !leaves(contact, window) {
        return 0.0;
    }
    let point = snapshot.centre(contact.grain) + contact.lever;
    let fluctuation = snapshot.translation(contact.grain) - gradient.at(point);
    contact.force().dot(fluctuation)
}

/// Work of the mean stress and mean strain of the kite of one contact: ½·F·Δu.
///
/// ```math
/// A^c H\, \sigma^c_{ij}\, \varepsilon^c_{ij} = \tfrac12 F_j\, \Delta u_j, \qquad
/// A^c = \tfrac12 s l, \quad \sigma^c_{ij} = \frac{n_i F_j}{s H}, \quad \varepsilon^c_{ij} = \frac{n_i \Delta u_j}{l}
/// ```
///
/// The ½ comes from the area of the kite. Mean stresses of kites average to half the stress of the assembly, so the
/// identity holds for each contact and for sums over contacts, not for macroscopic tensors. `[force·length]`; none
/// for a contact with a side. Bojtár & Bagi (1989), eq. 6.
pub fn contact_mean_work(snapshot: &Snapshot<'_>, contact: ContactId) -> Option<f64> {
    let shape = &snapshot.assembly.contacts[contact];
    let (Partner::Grain(first), Partner::Grain(second)) = (shape.first, shape.second) else {
        return None;
    };
    let place = snapshot.place(shape);
    let (n, force) = (place.normal, snapshot.state.contacts[contact].force);
    let force = n * force.normal + n.quarter_turn() * force.shear;
    let opening = snapshot.translation(second) - snapshot.translation(first);
    let (dual, branch) = (shape.dual_length_full, place.branch_length);
    let thickness = snapshot.assembly.thickness;
    let stress = Tensor::product(n, force) * (1.0 / (dual * thickness));
    let strain = Tensor::product(n, opening) * (1.0 / branch);
    Some(0.5 * dual * branch * thickness * stress.inner(strain))
}

/// Whether the other body of a contact is a side or a grain outside the window.
fn leaves(contact: &HalfContact, window: &Window) -> bool {
    match contact.partner {
        Partner::Grain(grain) => !window.contains(grain),
        Partner::Side(_) => true,
    }
}
