//! The sum over the grains of a window and the active contacts of each.
//!
//! A contact between two grains of the window is met twice, one that leaves the window once, one with a side once.

use crate::assembly::{Contact, Partner};
use crate::equilibrium::{ContactState, Place};
use crate::geometry::Vector;
use crate::ids::GrainId;
use crate::measure::{Snapshot, Window};

/// An active contact as one of its grains sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfContact {
    /// The grain.
    pub grain: GrainId,
    /// The other body.
    pub partner: Partner,
    /// Unit normal n that leaves the grain.
    pub normal: Vector,
    /// From the grain's centre to the contact point: r = a·n + b·t, `[length]`.
    pub lever: Vector,
    /// Normal force F_n on the grain, tension positive, `[force]`.
    pub normal_force: f64,
    /// Shear force F_t on the grain along t, `[force]`.
    pub shear_force: f64,
    /// Bending moment on the grain, counter-clockwise, `[force·length]`.
    pub moment: f64,
    /// Branch length l, `[length]`.
    pub branch_length: f64,
    /// Dual length s in full, `[length]`.
    pub dual_length: f64,
}

impl HalfContact {
    /// Unit tangent t: the normal turned by a quarter, counter-clockwise.
    pub fn tangent(&self) -> Vector {
        self.normal.quarter_turn()
    }

    /// Arm a of the contact point along the normal; the radius where discs touch, `[length]`.
    pub fn normal_arm(&self) -> f64 {
        self.lever.dot(self.normal)
    }

    /// Arm b of the contact point along the tangent, `[length]`.
    pub fn tangent_arm(&self) -> f64 {
        self.lever.dot(self.tangent())
    }

    /// Force F on the grain, `[force]`.
    pub fn force(&self) -> Vector {
        self.normal * self.normal_force + self.tangent() * self.shear_force
    }
}

/// The active contacts of the window's grains in the order of the contact ids, first partner before second.
pub(super) fn half_contacts<'a>(
    snapshot: &Snapshot<'a>,
    window: &'a Window,
) -> impl Iterator<Item = HalfContact> + 'a {
    all_half_contacts(snapshot).filter(|half| window.contains(half.grain))
}

/// The active contacts of all grains, in the same order.
pub(super) fn all_half_contacts<'a>(
    snapshot: &Snapshot<'a>,
) -> impl Iterator<Item = HalfContact> + use<'a> {
    let snapshot = *snapshot;
    let contacts = snapshot.assembly.contacts.values().iter();
    let active = contacts
        .zip(snapshot.state.contacts.values())
        .filter(|(_, state)| state.is_active());
    active
        .flat_map(move |(contact, state)| halves(contact, snapshot.place(contact), state))
        .flatten()
        .map(move |mut half| {
            half.lever = half.lever - snapshot.centre(half.grain);
            half
        })
}

/// Both ends of a contact, the lever still the contact point itself; none for a side.
fn halves(contact: &Contact, place: Place, state: &ContactState) -> [Option<HalfContact>; 2] {
    let half = |own: Partner, partner: Partner, sign: f64| {
        let Partner::Grain(grain) = own else {
            return None;
        };
        Some(HalfContact {
            grain,
            partner,
            // With n and t both reversed, F_n and F_t are the same at both ends.
            normal: place.normal * sign,
            lever: place.point,
            normal_force: state.force.normal,
            shear_force: state.force.shear,
            moment: state.force.moment * sign,
            branch_length: place.branch_length,
            dual_length: contact.dual_length_full,
        })
    };
    [
        half(contact.first, contact.second, 1.0),
        half(contact.second, contact.first, -1.0),
    ]
}
