//! Sites: where two bodies meet, and the contacts that contact properties make of them.

use crate::assembly::{Contact, Grain, Partner, Side};
use crate::geometry::Vector;
use crate::ids::{GrainId, PerGrain, PerSide, PropertyId};

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

/// Where two bodies meet: what the dual graph tells of it; the rest follows from the bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// First partner: a grain, of two grains the one with the lower id.
    pub first: Partner,
    /// Second partner.
    pub second: Partner,
    /// The dual edge on the side of −t and of +t of the tangent point, `[length]`; one may be negative
    /// between grains that do not touch.
    pub edge_parts: [f64; 2],
}

/// The bodies that sites are between.
#[derive(Clone, Copy, Debug)]
pub struct Bodies<'a> {
    /// The grains.
    pub grains: &'a PerGrain<Grain>,
    /// The sides of the container.
    pub sides: &'a PerSide<Side>,
}

/// The way from a grain's centre to that of another, or to a side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Branch {
    /// Unit normal n from first to second.
    pub normal: Vector,
    /// Distance of the centres, or for a side the radius, `[length]`.
    pub length: f64,
    /// Distance between the surfaces; negative: overlap, `[length]`.
    pub gap: f64,
}

/// How a contact property shapes a contact at its site.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shaping {
    /// Dual length for the stiffness.
    pub dual_length: DualLength,
    /// Contact point.
    pub contact_point: ContactPoint,
}

impl Site {
    /// What is not yet there.
    pub(super) const NOTHING: Self = Self {
        first: Partner::Grain(GrainId(0)),
        second: Partner::Grain(GrainId(0)),
        edge_parts: [0.0; 2],
    };

    /// The branch from the first body to the second.
    pub fn branch(&self, bodies: Bodies<'_>) -> Branch {
        let Bodies { grains, sides } = bodies;
        match (self.first, self.second) {
            (Partner::Grain(a), Partner::Grain(b)) => Branch::between(&grains[a], &grains[b]),
            (Partner::Grain(grain), Partner::Side(side)) => {
                let (Grain { centre, radius }, side) = (grains[grain], &sides[side]);
                Branch {
                    normal: side.outward,
                    length: radius,
                    gap: side.distance(centre) - radius,
                }
            }
            (Partner::Side(_), _) => unreachable!("a side is the second partner"),
        }
    }

    /// Where the dual edge's line meets the branch; for a side the grain's point nearest to it, `[length]`.
    pub fn tangent_point(&self, bodies: Bodies<'_>) -> Vector {
        self.tangent_point_on(&self.branch(bodies), bodies)
    }

    fn tangent_point_on(&self, branch: &Branch, Bodies { grains, .. }: Bodies<'_>) -> Vector {
        let grain = |partner| match partner {
            Partner::Grain(grain) => Some(grains[grain]),
            Partner::Side(_) => None,
        };
        let l = branch.length;
        let along = match (grain(self.first), grain(self.second)) {
            (Some(a), Some(b)) if l > 0.0 => {
                0.5 * (l + (a.radius - b.radius) * (a.radius + b.radius) / l)
            }
            (Some(_), Some(_)) => 0.0,
            _ => l,
        };
        let centre = grain(self.first).map_or(Vector::default(), |grain| grain.centre);
        centre + branch.normal * along
    }

    /// The contact that a contact property makes of this site.
    ///
    /// Capped, a part of the dual edge reaches at most g = √(R_i·R_j) from the tangent point, at a side g = R: where
    /// the tangent meets the hull of the two grains, so that s does not depend on the box.
    pub fn contact(
        &self,
        shaping: Shaping,
        bodies: Bodies<'_>,
        property: PropertyId,
        strength_factor: f64,
    ) -> Contact {
        let g = self.cap(bodies.grains);
        let branch = self.branch(bodies);
        let tangent_point = self.tangent_point_on(&branch, bodies);
        let kept = match shaping.dual_length {
            DualLength::Capped => self.edge_parts.map(|part| part.clamp(-g, g)),
            DualLength::Full | DualLength::Number(_) => self.edge_parts,
        };
        let s = match shaping.dual_length {
            DualLength::Number(s) => s,
            DualLength::Capped | DualLength::Full => kept[0] + kept[1],
        };
        let halves = [0.5 * s; 2];
        let (point, dual_parts) = match (shaping.contact_point, shaping.dual_length) {
            (ContactPoint::Tangent, DualLength::Number(_)) => (tangent_point, halves),
            (ContactPoint::Tangent, _) => (tangent_point, kept),
            (ContactPoint::Midpoint, _) => {
                let offset = 0.5 * (kept[1] - kept[0]);
                let tangent = branch.normal.quarter_turn();
                (tangent_point + tangent * offset, halves)
            }
        };
        Contact {
            first: self.first,
            second: self.second,
            normal: branch.normal,
            branch_length: branch.length,
            point,
            dual_parts,
            dual_length_full: self.edge_parts[0] + self.edge_parts[1],
            property,
            strength_factor,
        }
    }

    /// The length g of the cap.
    fn cap(&self, grains: &PerGrain<Grain>) -> f64 {
        let radius = |partner| match partner {
            Partner::Grain(grain) => Some(grains[grain].radius),
            Partner::Side(_) => None,
        };
        match (radius(self.first), radius(self.second)) {
            (Some(a), Some(b)) => (a * b).sqrt(),
            (Some(r), None) | (None, Some(r)) => r,
            (None, None) => f64::INFINITY,
        }
    }
}

impl Branch {
    fn between(a: &Grain, b: &Grain) -> Self {
        let branch = b.centre - a.centre;
        let length = branch.length();
        // Coincident centres, which the scene refuses, still get a finite normal.
        let normal = if length > 0.0 {
            branch * (1.0 / length)
        } else {
            Vector::new(1.0, 0.0)
        };
        Self {
            normal,
            length,
            gap: length - (a.radius + b.radius),
        }
    }
}
