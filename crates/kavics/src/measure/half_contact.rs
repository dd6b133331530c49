//! The sum over the grains of a window and the active contacts of each.
//!
//! A contact between two grains of the window is met twice, one that leaves the window once, one with a side once.

use crate::assembly::Partner;
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

/// Visits the active contacts of the window's grains in the order of the contact ids, first partner before second.
pub(super) fn each_half_contact(
    snapshot: &Snapshot<'_>,
    window: &Window,
    visit: impl FnMut(&HalfContact),
) {
    visit_halves(snapshot, |grain| window.contains(grain), visit);
}

/// Visits the active contacts of all grains, in the same order.
pub(super) fn each_half_contact_of_all(snapshot: &Snapshot<'_>, visit: impl FnMut(&HalfContact)) {
    visit_halves(snapshot, |_| true, visit);
}

fn visit_halves(
    snapshot: &Snapshot<'_>,
    wanted: impl Fn(GrainId) -> bool,
    mut visit: impl FnMut(&HalfContact),
) {
    let contacts = snapshot.assembly.contacts.values().iter();
    let states = snapshot.state.contacts.values();
    for (contact, state) in contacts.zip(states).filter(|(_, state)| state.is_active()) {
        let place = snapshot.place(contact);
        let ends = [
            (contact.first, contact.second, 1.0),
            (contact.second, contact.first, -1.0),
        ];
        for (own, partner, sign) in ends {
            let Partner::Grain(grain) = own else {
                continue;
            };
            if wanted(grain) {
                visit(&HalfContact {
                    grain,
                    partner,
                    // With n and t both reversed, F_n and F_t are the same at both ends.
                    normal: place.normal * sign,
                    lever: place.point - snapshot.centre(grain),
                    normal_force: state.force.normal,
                    shear_force: state.force.shear,
                    moment: state.force.moment * sign,
                    branch_length: place.branch_length,
                    dual_length: contact.dual_length_full,
                });
            }
        }
    }
}
