//! The undeformed assembly: grains, the container and its sides, contacts, and the dual graph.
//!
//! In: discs and a container. Out: an [`Assembly`] that nothing downstream changes.

mod contact_graph;
mod container;
mod envelope;
mod outer_face;
mod site;
mod touching;

pub use contact_graph::{Between, ContactGraph, contact_graph};
pub use container::{box_sides, extents, middle, outside, overlaps, polygon_sides, twice_area};
pub use envelope::{EnvelopePart, envelope};
pub use outer_face::outer_grains;
pub use site::{Bodies, Branch, ContactPoint, DualLength, Shaping, Site};
pub use touching::{Touching, container, touching};

use crate::geometry::Vector;
use crate::ids::{BodyId, GrainId, Id, PerContact, PerGrain, PerSide, PropertyId, SideId};

/// A disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grain {
    /// Centre, `[length]`.
    pub centre: Vector,
    /// Radius, `[length]`.
    pub radius: f64,
}

/// One of the two bodies of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Partner {
    /// A grain.
    Grain(GrainId),
    /// A side of the container, a rigid body.
    Side(SideId),
}

/// A straight side of the container: a rigid body where grains touch it.
///
/// The sides of a box run left to right and bottom to top, those of a polygon from corner to corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Side {
    /// `left`, `right`, `bottom`, `top`; of a polygon the number of the side.
    pub name: String,
    /// Where the side starts, `[length]`.
    pub start: Vector,
    /// Where the side ends, `[length]`.
    pub end: Vector,
    /// Unit normal that leaves the container.
    pub outward: Vector,
    /// Whether grains can touch it; an absent side only bounds the dual graph.
    pub present: bool,
}

impl Side {
    /// The middle of the side: the point its displacement and the moment on it refer to.
    pub fn middle(&self) -> Vector {
        (self.start + self.end) * 0.5
    }

    /// Length of the side.
    pub fn length(&self) -> f64 {
        (self.end - self.start).length()
    }

    /// Distance of a point from the side's line, positive inside the container.
    pub fn distance(&self, point: Vector) -> f64 {
        (self.start - point).dot(self.outward)
    }
}

/// Where two bodies meet, before loading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// First partner: always a grain, of two grains the one with the lower id.
    pub first: Partner,
    /// Second partner.
    pub second: Partner,
    /// Unit normal n from first to second.
    pub normal: Vector,
    /// Branch length l: between the centres, or from the centre to the side, `[length]`.
    pub branch_length: f64,
    /// The point where the contact force acts, `[length]`.
    pub point: Vector,
    /// Dual length s for the stiffness, on the side of −t and of +t of the contact point, `[length]`.
    pub dual_parts: [f64; 2],
    /// Dual length in full, for the measures: the common edge of two power cells, `[length]`.
    pub dual_length_full: f64,
    /// Contact property at the start.
    pub property: PropertyId,
    /// Factor on all its strengths, dimensionless.
    pub strength_factor: f64,
}

impl Contact {
    /// Dual length s for the stiffness, `[length]`.
    pub fn dual_length(&self) -> f64 {
        self.dual_parts[0] + self.dual_parts[1]
    }

    /// The grains of this contact.
    pub fn grains(&self) -> impl Iterator<Item = GrainId> + use<> {
        [self.first, self.second]
            .into_iter()
            .filter_map(|p| match p {
                Partner::Grain(grain) => Some(grain),
                Partner::Side(_) => None,
            })
    }

    /// Whether a side is one of the partners.
    pub fn touches_side(&self) -> bool {
        matches!(self.second, Partner::Side(_))
    }
}

/// Grains in a container with their contacts and power cells, undeformed.
#[derive(Clone, Debug, Default)]
pub struct Assembly {
    /// The grains.
    pub grains: PerGrain<Grain>,
    /// The sides of the container: left, right, bottom, top of a box, or those of a polygon in their order.
    pub sides: PerSide<Side>,
    /// The contacts: between grains by (first, second), then those with sides by (first, second).
    pub contacts: PerContact<Contact>,
    /// Area of each grain's power cell within the container, `[length²]`.
    pub cell_area: PerGrain<f64>,
    /// Triangles of the regular triangulation up to its hull, counter-clockwise.
    pub triangles: Vec<[GrainId; 3]>,
    /// Thickness out of the plane, `[length]`.
    pub thickness: f64,
}

impl Assembly {
    /// Number of grains and sides.
    pub fn body_count(&self) -> usize {
        self.grains.len() + self.sides.len()
    }

    /// The body that a partner is.
    pub fn body(&self, partner: Partner) -> BodyId {
        match partner {
            Partner::Grain(grain) => BodyId(grain.0),
            Partner::Side(side) => BodyId(self.grains.len() as u32 + side.0),
        }
    }

    /// The partner that a body is.
    pub fn partner(&self, body: BodyId) -> Partner {
        match body.index().checked_sub(self.grains.len()) {
            None => Partner::Grain(GrainId(body.0)),
            Some(side) => Partner::Side(SideId::from_index(side)),
        }
    }

    /// The point that the displacement of a body refers to: a grain's centre, a side's middle.
    pub fn reference_point(&self, partner: Partner) -> Vector {
        match partner {
            Partner::Grain(grain) => self.grains[grain].centre,
            Partner::Side(side) => self.sides[side].middle(),
        }
    }

    /// Length that turns a moment on a body into a force: a grain's radius, half of a side.
    pub fn moment_arm(&self, partner: Partner) -> f64 {
        match partner {
            Partner::Grain(grain) => self.grains[grain].radius,
            Partner::Side(side) => 0.5 * self.sides[side].length(),
        }
    }

    /// Mean radius of the grains, `[length]`.
    pub fn mean_radius(&self) -> f64 {
        self.grains.values().iter().map(|g| g.radius).sum::<f64>() / self.grains.len() as f64
    }
}
