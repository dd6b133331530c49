//! Where all signs live: from displacements of two bodies to the relative displacement at their contact, and back
//! from contact force to loads. Bojtár & Bagi (1989), eqs. 17–19, with the signs that make a rigid turn open nothing.
//!
//! The normal n points from the first body to the second, t is n turned by +90°; opening and tension are positive,
//! rotation is counter-clockwise. For a body whose contact point lies at r = a·n + b·t from its reference point
//!
//! ```math
//! T = \begin{bmatrix} n_x & n_y & -b \\ t_x & t_y & a \\ 0 & 0 & 1 \end{bmatrix},\qquad v = T_2 u_2 - T_1 u_1
//! ```
//!
//! Small displacements: a frame is that of the undeformed assembly.

use super::{Displacement, Freedom, Load};
use crate::assembly::{Assembly, Contact, Grain};
use crate::contact_law::{ContactForce, Matrix, RelativeDisplacement};
use crate::geometry::Vector;
use crate::ids::BodyId;

/// Freedoms of a body in the plane.
pub const FREEDOMS: usize = 3;

/// The freedoms of a body in the order of its unknowns.
pub const ALL_FREEDOMS: [Freedom; FREEDOMS] = [Freedom::X, Freedom::Y, Freedom::Rotation];

/// A stiffness between the freedoms of two bodies.
pub type Block = [[f64; FREEDOMS]; FREEDOMS];

/// The four stiffnesses of a contact: rows first, first; first, second; second, first; second, second.
pub struct Blocks {
    /// ∂(force on the first taken)/∂u of the first.
    pub first_first: Block,
    /// By the second.
    pub first_second: Block,
    /// Of the second, by the first.
    pub second_first: Block,
    /// By the second.
    pub second_second: Block,
}

impl Freedom {
    /// Its place among the unknowns of a body.
    pub fn index(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
            Self::Rotation => 2,
        }
    }
}

impl Displacement {
    /// As unknowns.
    pub fn components(self) -> [f64; FREEDOMS] {
        [self.x, self.y, self.rotation]
    }

    /// From unknowns.
    pub fn from_components([x, y, rotation]: [f64; FREEDOMS]) -> Self {
        Self { x, y, rotation }
    }

    /// The component of one freedom, to be set.
    pub fn component_mut(&mut self, freedom: Freedom) -> &mut f64 {
        match freedom {
            Freedom::X => &mut self.x,
            Freedom::Y => &mut self.y,
            Freedom::Rotation => &mut self.rotation,
        }
    }
}

impl Load {
    /// As right-hand side of the unknowns.
    pub fn components(self) -> [f64; FREEDOMS] {
        [self.x, self.y, self.moment]
    }

    /// From the right-hand side of the unknowns.
    pub fn from_components([x, y, moment]: [f64; FREEDOMS]) -> Self {
        Self { x, y, moment }
    }

    /// Work on a displacement, `[force·length]`.
    pub fn work(self, u: Displacement) -> f64 {
        self.x * u.x + self.y * u.y + self.moment * u.rotation
    }

    /// The largest component as a force: moments over `arm`, `[force]`.
    pub fn largest_force(self, arm: f64) -> f64 {
        self.x.abs().max(self.y.abs()).max(self.moment.abs() / arm)
    }
}

impl Displacement {
    /// The largest component as a length: rotations times `arm`, `[length]`.
    pub fn largest_length(self, arm: f64) -> f64 {
        self.x.hypot(self.y).max(self.rotation.abs() * arm)
    }
}

impl Load {
    /// Every component without its sign.
    #[must_use]
    pub fn magnitude(self) -> Self {
        Self {
            x: self.x.abs(),
            y: self.y.abs(),
            moment: self.moment.abs(),
        }
    }
}

impl std::ops::Mul<f64> for Load {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
            moment: self.moment * factor,
        }
    }
}

impl std::ops::AddAssign for Load {
    fn add_assign(&mut self, other: Self) {
        self.x += other.x;
        self.y += other.y;
        self.moment += other.moment;
    }
}

impl std::ops::Sub for Load {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            moment: self.moment - other.moment,
        }
    }
}

impl std::ops::Sub for Displacement {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            rotation: self.rotation - other.rotation,
        }
    }
}

/// The contact point seen from a body's reference point: r = a·n + b·t.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Lever {
    along_normal: f64,
    along_tangent: f64,
}

/// A motion of bodies as one.
#[derive(Clone, Copy, Debug)]
pub struct RigidMotion {
    centre: Vector,
    displacement: Displacement,
}

impl RigidMotion {
    /// The nearest to the displacements of bodies at places with radii, each with the mass R²: it has their momentum and
    /// their moment of momentum,
    ///
    /// ```math
    /// \omega = \frac{\sum_p R_p^2\,[(x_p - \bar x)\times(u_p - \bar u) + \tfrac12 R_p^2\,\omega_p]}
    ///   {\sum_p R_p^2\,[(x_p - \bar x)^2 + \tfrac12 R_p^2]}
    /// ```
    pub fn nearest(bodies: &[(Vector, f64, Displacement)]) -> Self {
        let (mut mass, mut centre, mut mean) = (0.0, Vector::new(0.0, 0.0), Vector::new(0.0, 0.0));
        for &(place, radius, u) in bodies {
            mass += radius * radius;
            centre = centre + place * (radius * radius);
            mean = mean + Vector::new(u.x, u.y) * (radius * radius);
        }
        (centre, mean) = (centre * (1.0 / mass), mean * (1.0 / mass));
        let (mut moment, mut inertia) = (0.0, 0.0);
        for &(place, radius, u) in bodies {
            let (arm, square) = (place - centre, radius * radius);
            let way = Vector::new(u.x, u.y) - mean;
            moment += square * (arm.quarter_turn().dot(way) + 0.5 * square * u.rotation);
            inertia += square * (arm.dot(arm) + 0.5 * square);
        }
        Self {
            centre,
            displacement: Displacement {
                x: mean.x,
                y: mean.y,
                rotation: moment / inertia,
            },
        }
    }

    /// The displacement of a body at a place.
    pub fn at(&self, place: Vector) -> Displacement {
        let Displacement { x, y, rotation } = self.displacement;
        let turned = (place - self.centre).quarter_turn() * rotation;
        Displacement {
            x: x + turned.x,
            y: y + turned.y,
            rotation,
        }
    }
}

/// The frame of a contact: its bodies, normal and levers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactFrame {
    /// First body.
    pub first: BodyId,
    /// Second body.
    pub second: BodyId,
    normal: Vector,
    levers: [Lever; 2],
}

impl ContactFrame {
    /// The frame of a contact in the undeformed assembly.
    pub fn new(assembly: &Assembly, contact: &Contact) -> Self {
        let tangent = contact.normal.quarter_turn();
        let lever = |partner| {
            let r = contact.point - assembly.reference_point(partner);
            Lever {
                along_normal: r.dot(contact.normal),
                along_tangent: r.dot(tangent),
            }
        };
        Self {
            first: assembly.body(contact.first),
            second: assembly.body(contact.second),
            normal: contact.normal,
            levers: [lever(contact.first), lever(contact.second)],
        }
    }

    /// v = T₂·u₂ − T₁·u₁, eq. 17.
    pub fn relative_displacement(
        &self,
        first: Displacement,
        second: Displacement,
    ) -> RelativeDisplacement {
        let u = Vector::new(second.x - first.x, second.y - first.y);
        let [one, two] = self.levers;
        RelativeDisplacement {
            normal: u.dot(self.normal) - two.along_tangent * second.rotation
                + one.along_tangent * first.rotation,
            shear: u.dot(self.normal.quarter_turn()) + two.along_normal * second.rotation
                - one.along_normal * first.rotation,
            rotation: second.rotation - first.rotation,
        }
    }

    /// What the contact force does to the two bodies: T₁ᵀ·Q on the first, −T₂ᵀ·Q on the second.
    pub fn loads(&self, q: ContactForce) -> [Load; 2] {
        let force = self.normal * q.normal + self.normal.quarter_turn() * q.shear;
        let moment =
            |lever: Lever| lever.along_normal * q.shear - lever.along_tangent * q.normal + q.moment;
        [
            Load {
                x: force.x,
                y: force.y,
                moment: moment(self.levers[0]),
            },
            Load {
                x: -force.x,
                y: -force.y,
                moment: -moment(self.levers[1]),
            },
        ]
    }

    /// Bᵀ·k·B with B = [−T₁, T₂]: what a contact adds to the stiffness of the assembly.
    pub fn stiffness(&self, k: &Matrix) -> Blocks {
        let [one, two] = self.levers.map(|lever| self.map(lever));
        let minus = |block: Block| block.map(|row| row.map(|value| -value));
        Blocks {
            first_first: congruence(&one, k, &one),
            first_second: minus(congruence(&one, k, &two)),
            second_first: minus(congruence(&two, k, &one)),
            second_second: congruence(&two, k, &two),
        }
    }

    /// T of a body.
    fn map(&self, lever: Lever) -> Block {
        let (n, t) = (self.normal, self.normal.quarter_turn());
        [
            [n.x, n.y, -lever.along_tangent],
            [t.x, t.y, lever.along_normal],
            [0.0, 0.0, 1.0],
        ]
    }
}

/// Where a contact is and how it points in a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Unit normal n from the first body to the second.
    pub normal: Vector,
    /// The point where the contact force acts, `[length]`.
    pub point: Vector,
    /// Branch length l, `[length]`.
    pub branch_length: f64,
}

/// Where a contact is once its bodies are displaced: where it was, as displacements are small.
pub fn contact_place(contact: &Contact, _first: Displacement, _second: Displacement) -> Place {
    Place {
        normal: contact.normal,
        point: contact.point,
        branch_length: contact.branch_length,
    }
}

/// Where a grain's centre is once it is displaced: where it was, as displacements are small.
pub fn centre(grain: &Grain, _displacement: Displacement) -> Vector {
    grain.centre
}

/// Aᵀ·k·B.
fn congruence(a: &Block, k: &Matrix, b: &Block) -> Block {
    let mut kb = [[0.0; FREEDOMS]; 3];
    for (row, k_row) in kb.iter_mut().zip(k) {
        for (column, value) in row.iter_mut().enumerate() {
            *value = k_row[0] * b[0][column] + k_row[1] * b[1][column] + k_row[2] * b[2][column];
        }
    }
    let mut product = [[0.0; FREEDOMS]; FREEDOMS];
    for (row, values) in product.iter_mut().enumerate() {
        for (column, value) in values.iter_mut().enumerate() {
            *value =
                a[0][row] * kb[0][column] + a[1][row] * kb[1][column] + a[2][row] * kb[2][column];
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame() -> ContactFrame {
        ContactFrame {
            first: BodyId(0),
            second: BodyId(1),
            normal: Vector::new(0.6, 0.8),
            levers: [
                Lever {
                    along_normal: 1.5,
                    along_tangent: 0.2,
                },
                Lever {
                    along_normal: -0.7,
                    along_tangent: 0.2,
                },
            ],
        }
    }

    #[test]
    fn virtual_work_agrees() {
        let (first, second) = (
            Displacement {
                x: 0.3,
                y: -0.2,
                rotation: 0.7,
            },
            Displacement {
                x: -0.5,
                y: 0.4,
                rotation: -0.1,
            },
        );
        let q = ContactForce {
            normal: 2.0,
            shear: -3.0,
            moment: 0.5,
        };
        let v = frame().relative_displacement(first, second);
        let [on_first, on_second] = frame().loads(q);
        let inner = q.normal * v.normal + q.shear * v.shear + q.moment * v.rotation;
        assert!((inner + on_first.work(first) + on_second.work(second)).abs() < 1e-14);
    }

    #[test]
    fn a_rigid_motion_is_nearest_to_itself() {
        let turn = RigidMotion {
            centre: Vector::new(0.5, -2.0),
            displacement: Displacement {
                x: 0.3,
                y: -0.1,
                rotation: 0.02,
            },
        };
        let places = [(1.0, 2.0, 0.5), (4.0, -1.0, 1.5), (-2.0, 0.3, 1.0)];
        let bodies = places.map(|(x, y, radius)| {
            let place = Vector::new(x, y);
            (place, radius, turn.at(place))
        });
        let found = RigidMotion::nearest(&bodies);
        for (place, _, u) in bodies {
            let components = u.components().into_iter().zip(found.at(place).components());
            for (expected, found) in components {
                assert!((expected - found).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn a_rigid_turn_opens_nothing() {
        // The second body's reference point lies at n·(1.5 + 0.7) from the first's; turn about the first.
        let between = Vector::new(0.6, 0.8) * 2.2;
        let angle = 0.01;
        let moved = between.quarter_turn() * angle;
        let v = frame().relative_displacement(
            Displacement {
                x: 0.0,
                y: 0.0,
                rotation: angle,
            },
            Displacement {
                x: moved.x,
                y: moved.y,
                rotation: angle,
            },
        );
        assert!(v.normal.abs() < 1e-16 && v.shear.abs() < 1e-16 && v.rotation.abs() < 1e-16);
    }

    #[test]
    fn stiffness_is_the_load_of_a_linear_contact() {
        let k = [[2.0, 0.0, 0.1], [0.3, 1.0, 0.0], [0.1, 0.0, 0.5]];
        let u = [
            Displacement {
                x: 0.3,
                y: -0.2,
                rotation: 0.7,
            },
            Displacement {
                x: -0.5,
                y: 0.4,
                rotation: -0.1,
            },
        ];
        let v = frame().relative_displacement(u[0], u[1]);
        let v = [v.normal, v.shear, v.rotation];
        let q = k.map(|row: [f64; 3]| row.iter().zip(v).map(|(k, v)| k * v).sum::<f64>());
        let [on_first, _] = frame().loads(ContactForce {
            normal: q[0],
            shear: q[1],
            moment: q[2],
        });
        let blocks = frame().stiffness(&k);
        for (row, expected) in on_first.components().into_iter().enumerate() {
            let taken: f64 = (0..FREEDOMS)
                .map(|j| {
                    blocks.first_first[row][j] * u[0].components()[j]
                        + blocks.first_second[row][j] * u[1].components()[j]
                })
                .sum();
            assert!((taken + expected).abs() < 1e-14);
        }
    }
}
