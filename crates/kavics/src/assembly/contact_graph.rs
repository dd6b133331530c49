//! Which bodies meet, and the dual graph: from grains and sides to contact sites, power cells and triangles.

use crate::assembly::{Contact, Grain, Partner, Side};
use crate::geometry::Vector;
use crate::ids::{GrainId, PerGrain, PerSide, PropertyId};

/// Which pairs of grains carry a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Between {
    /// Grains that touch.
    #[default]
    Touching,
    /// Every pair with a common edge of the power diagram.
    Neighbours,
}

/// The dual length that a stiffness uses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum DualLength {
    /// Each part of the edge at most √(R_i·R_j), at a side at most R.
    #[default]
    Capped,
    /// The edge of the power diagram as it is.
    Full,
    /// A number, the same for every contact, half on each side of the contact point, `[length]`.
    Number(f64),
}

/// Where on the dual edge the contact force acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactPoint {
    /// On the line between the centres.
    #[default]
    Tangent,
    /// In the middle of the dual edge.
    Midpoint,
}

/// Where two bodies meet: geometry alone, before it is given a contact property.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// First partner: a grain, of two grains the one with the lower id.
    pub first: Partner,
    /// Second partner.
    pub second: Partner,
    /// Unit normal n from first to second.
    pub normal: Vector,
    /// Distance of the centres, or for a side the radius, `[length]`.
    pub branch_length: f64,
    /// Where the dual edge's line meets the branch; for a side the grain's point nearest to it, `[length]`.
    pub tangent_point: Vector,
    /// The dual edge on the side of −t and of +t of the tangent point, `[length]`; one may be negative
    /// between grains that do not touch.
    pub edge_parts: [f64; 2],
    /// Distance between the surfaces; negative: overlap, `[length]`.
    pub gap: f64,
}

/// Sites, power cells and triangles of grains in a container.
#[derive(Clone, Debug, Default)]
pub struct ContactGraph {
    /// Between grains by (first, second), then those with sides by (first, second).
    pub sites: Vec<Site>,
    /// Area of each grain's power cell within the container, `[length²]`.
    pub cell_area: PerGrain<f64>,
    /// Triangles of the regular triangulation, counter-clockwise, lowest id first, whose power centre lies in the
    /// container (its boundary included).
    pub triangles: Vec<[GrainId; 3]>,
}

/// How a contact property shapes a contact at its site.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shaping {
    /// Dual length for the stiffness.
    pub dual_length: DualLength,
    /// Contact point.
    pub contact_point: ContactPoint,
}
