//! Motion that the theory of small displacements does not bear, in which frames are those of the undeformed assembly.

use super::kinematics::ContactFrame;
use super::system::System;
use super::{Displacement, State};
use crate::assembly::{Assembly, Contact, Partner};
use crate::ids::{ContactId, GrainId, PerGrain};

/// Displacements over branch lengths, and rotations, up to which they count as small: across a branch such a displacement
/// turns it by atan 0.1, some 6°, and makes it longer by √1.01, half a per cent.
pub const SMALL_MOTION: f64 = 0.1;

/// The largest motion of bodies that contacts join, where it is not small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargeMotion {
    /// How large it is, dimensionless.
    pub size: f64,
    /// What moves.
    pub motion: Motion,
}

/// What the largest motion is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// Displacement of the end of a branch relative to its start, over the branch length, abs(Δu)/l. The branch of a contact
    /// with a side keeps to the normal of the side, whose displacement and rotation it takes: hypot(Δu·n, ω·l)/l.
    Branch(ContactId),
    /// Displacement of a grain along the side that it meets, over the length of the side, abs(Δu·t)/L: a straight side is the
    /// same from place to place, but for its levers.
    Along(ContactId),
    /// Rotation of a grain, abs(ω).
    Turn(GrainId),
}

impl LargeMotion {
    /// The largest motion over all contacts that can carry a force, but those of grains that are set aside; none where it is
    /// small.
    pub(crate) fn of(
        system: &System<'_>,
        state: &State,
        set_aside: &PerGrain<bool>,
    ) -> Option<Self> {
        let mut large = None;
        let mut note = |size: f64, motion| {
            if size > large.map_or(SMALL_MOTION, |largest: Self| largest.size) {
                large = Some(Self { size, motion });
            }
        };
        for (frame, (id, contact)) in system.frames.iter().zip(system.assembly.contacts.iter()) {
            // What is set aside is so as a whole piece.
            let aside = contact.grains().any(|grain| set_aside[grain]);
            if aside || !state.contacts[id].is_active() {
                continue;
            }
            let [off, along] = motion_at(system.assembly, contact, frame, state);
            note(off, Motion::Branch(id));
            note(along, Motion::Along(id));
            for grain in contact.grains() {
                let u = state.displacements[system.assembly.body(Partner::Grain(grain))];
                note(u.rotation.abs(), Motion::Turn(grain));
            }
        }
        large
    }
}

/// How far a branch is off its place, and how far it has gone along the side that it ends on.
fn motion_at(
    assembly: &Assembly,
    contact: &Contact,
    frame: &ContactFrame,
    state: &State,
) -> [f64; 2] {
    let [first, second] = [frame.first, frame.second].map(|body| state.displacements[body]);
    let l = contact.branch_length;
    match contact.second {
        Partner::Grain(_) => {
            let v = frame.relative_displacement(straight(first), straight(second));
            [v.normal.hypot(v.shear) / l, 0.0]
        }
        Partner::Side(side) => {
            let v = frame.relative_displacement(straight(first), second);
            let off = (v.normal / l).hypot(second.rotation);
            [off, v.shear.abs() / assembly.sides[side].length()]
        }
    }
}

/// A displacement without its rotation.
fn straight(u: Displacement) -> Displacement {
    Displacement { rotation: 0.0, ..u }
}
