//! A linear contact: its forces along the line of a load step, and the factors at which it holds.

use crate::contact_law::{ContactForce, Limits, Mode, RelativeDisplacement};
use crate::equilibrium::FREEDOMS;
use crate::equilibrium::bond::Bond;

/// Stiffness and limits of a linear contact; all zero and without limits where it broke into nothing.
#[derive(Clone, Copy, Debug)]
pub struct Spring {
    normal: f64,
    shear: f64,
    moment: f64,
    coupling: f64,
    /// Shear and rotation at which it came to be.
    origin: [f64; 2],
    /// Its limits.
    pub limits: Limits,
}

/// Factors at which a contact holds: from the lower to the upper one; none where the upper is the lesser.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub lower: f64,
    /// Upper end.
    pub upper: f64,
}

impl Interval {
    /// All factors.
    pub const ALL: Self = Self {
        lower: f64::NEG_INFINITY,
        upper: f64::INFINITY,
    };

    /// The factors at which a force [a, b] lies between −`low` and `high`.
    fn between(force: [f64; 2], low: f64, high: f64) -> Self {
        let [constant, rate] = force;
        if rate == 0.0 {
            let holds = (-low..=high).contains(&constant);
            return if holds { Self::ALL } else { Self::NONE };
        }
        let (at_low, at_high) = ((-low - constant) / rate, (high - constant) / rate);
        let (lower, upper) = if rate > 0.0 {
            (at_low, at_high)
        } else {
            (at_high, at_low)
        };
        Self { lower, upper }
    }

    const NONE: Self = Self {
        lower: f64::INFINITY,
        upper: f64::NEG_INFINITY,
    };

    fn and(self, other: Self) -> Self {
        Self {
            lower: self.lower.max(other.lower),
            upper: self.upper.min(other.upper),
        }
    }
}

impl Spring {
    /// The contact as it is now.
    pub fn new(bond: &Bond) -> Self {
        let k = bond.stiffness;
        let on = f64::from(u8::from(bond.is_active()));
        Self {
            normal: on * k.normal,
            shear: on * k.shear,
            moment: on * k.moment,
            coupling: on * k.coupling,
            origin: [bond.memory.slip, bond.memory.rotation_origin],
            limits: bond.limits,
        }
    }

    /// Forces along the line.
    pub fn forces(&self, v: [RelativeDisplacement; 2]) -> [ContactForce; 2] {
        let felt = RelativeDisplacement {
            normal: v[0].normal,
            shear: v[0].shear - self.origin[0],
            rotation: v[0].rotation - self.origin[1],
        };
        [self.force_by(felt), self.force_by(v[1])]
    }

    /// Force by the relative displacement since it came to be.
    pub fn force_by(&self, v: RelativeDisplacement) -> ContactForce {
        ContactForce {
            normal: self.normal * v.normal + self.coupling * v.rotation,
            shear: self.shear * v.shear,
            moment: self.coupling * v.normal + self.moment * v.rotation,
        }
    }

    /// Where the contact holds under given forces; `direction` −1 counts factors the other way.
    pub fn interval(&self, q: [ContactForce; 2], direction: f64) -> Interval {
        let line = |component: fn(&ContactForce) -> f64| {
            let [constant, rate] = [component(&q[0]), component(&q[1])];
            [constant, direction * rate]
        };
        let Limits {
            tension,
            compression,
            shear,
            bending,
        } = self.limits;
        Interval::between(line(|q| q.normal), compression, tension)
            .and(Interval::between(line(|q| q.shear), shear, shear))
            .and(Interval::between(line(|q| q.moment), bending, bending))
    }

    /// Which component a force reaches first.
    pub fn mode(&self, force: ContactForce) -> Mode {
        self.limits.utilisation(force).1
    }

    /// L with L·Lᵀ = k − k′, by columns, k′ that of `other`; none where this is not positive.
    pub fn less(&self, other: &Self) -> Option<[ContactForce; FREEDOMS]> {
        let normal = self.normal - other.normal;
        let shear = self.shear - other.shear;
        let coupling = self.coupling - other.coupling;
        let lean = if coupling == 0.0 {
            0.0
        } else {
            coupling / normal.sqrt()
        };
        let moment = self.moment - other.moment - lean * lean;
        let least = normal.min(shear).min(moment);
        (least >= 0.0).then(|| {
            let none = ContactForce::default();
            [
                ContactForce {
                    normal: normal.sqrt(),
                    moment: lean,
                    ..none
                },
                ContactForce {
                    shear: shear.sqrt(),
                    ..none
                },
                ContactForce {
                    moment: moment.sqrt(),
                    ..none
                },
            ]
        })
    }
}

/// Less, component by component.
pub fn less(a: ContactForce, b: ContactForce) -> ContactForce {
    ContactForce {
        normal: a.normal - b.normal,
        shear: a.shear - b.shear,
        moment: a.moment - b.moment,
    }
}

/// The force at x.
pub fn force_at(q: [ContactForce; 2], x: f64) -> ContactForce {
    ContactForce {
        normal: q[0].normal + x * q[1].normal,
        shear: q[0].shear + x * q[1].shear,
        moment: q[0].moment + x * q[1].moment,
    }
}

/// The relative displacement at x.
pub fn relative_at(v: [RelativeDisplacement; 2], x: f64) -> RelativeDisplacement {
    RelativeDisplacement {
        normal: v[0].normal + x * v[1].normal,
        shear: v[0].shear + x * v[1].shear,
        rotation: v[0].rotation + x * v[1].rotation,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_that_grows_holds_between_its_limits() {
        let found = Interval::between([1.0, 2.0], 3.0, 5.0);
        assert_eq!((found.lower, found.upper), (-2.0, 2.0));
    }

    #[test]
    fn a_force_that_falls_holds_between_the_same_limits() {
        let found = Interval::between([1.0, -2.0], 3.0, 5.0);
        assert_eq!((found.lower, found.upper), (-2.0, 2.0));
    }

    #[test]
    fn a_constant_force_holds_at_all_factors_or_at_none() {
        assert_eq!(Interval::between([1.0, 0.0], 0.0, 1.0), Interval::ALL);
        assert_eq!(Interval::between([1.5, 0.0], 0.0, 1.0), Interval::NONE);
    }

    #[test]
    fn without_limits_all_factors_are_admissible() {
        let found = Interval::between([1.0, -2.0], f64::INFINITY, f64::INFINITY);
        assert_eq!(found, Interval::ALL);
    }
}
