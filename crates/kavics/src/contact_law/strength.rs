//! Strength of a bond: limits of the force components, and how near a force is to them.

use super::{ContactForce, ContactGeometry, Mode, Softening, Strength, StrengthKind};

/// Limits of the force components of one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Of tension, `[force]`.
    pub tension: f64,
    /// Of compression, `[force]`.
    pub compression: f64,
    /// Of shear, `[force]`.
    pub shear: f64,
    /// Of bending, `[force·length]`.
    pub bending: f64,
}

impl Limits {
    /// Never reached.
    pub const UNBREAKABLE: Self = Self {
        tension: f64::INFINITY,
        compression: f64::INFINITY,
        shear: f64::INFINITY,
        bending: f64::INFINITY,
    };

    /// All limits multiplied by a factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            tension: self.tension * factor,
            compression: self.compression * factor,
            shear: self.shear * factor,
            bending: self.bending * factor,
        }
    }

    /// Utilisation: the largest share of its limit that a component has reached, and which; above 1 the bond breaks.
    ///
    /// ```math
    /// \rho = \max(\langle N\rangle/N_t,\; \langle -N\rangle/N_c,\; |T|/T_{\lim},\; |M|/M_{\lim})
    /// ```
    pub fn utilisation(&self, force: ContactForce) -> (f64, Mode) {
        [
            (share(force.normal.max(0.0), self.tension), Mode::Tension),
            (
                share((-force.normal).max(0.0), self.compression),
                Mode::Compression,
            ),
            (share(force.shear.abs(), self.shear), Mode::Shear),
            (share(force.moment.abs(), self.bending), Mode::Bending),
        ]
        .into_iter()
        .reduce(|worst, next| if next.0 > worst.0 { next } else { worst })
        .expect("four components")
    }
}

/// A limit of zero is exceeded by any force, and by none when there is no force.
fn share(force: f64, limit: f64) -> f64 {
    if force == 0.0 { 0.0 } else { force / limit }
}

impl Strength {
    /// Limits of one contact: σ·s, τ·s and σ·s²/6 times the thickness where strengths are stresses.
    pub fn limits(&self, geometry: &ContactGeometry, factor: f64) -> Limits {
        let (area, modulus) = match self.kind {
            StrengthKind::Force => (factor, factor),
            StrengthKind::Stress => {
                let s = geometry.dual_length();
                (
                    factor * s * geometry.thickness,
                    factor * s * s / 6.0 * geometry.thickness,
                )
            }
        };
        Limits {
            tension: self.tension * area,
            compression: self.compression * area,
            shear: self.shear * area,
            bending: self.bending * modulus,
        }
    }

    /// How a bond of strength factor 1 softens, G_f·s·H its energy; none where it breaks at once.
    pub fn softening(&self, geometry: &ContactGeometry) -> Option<Softening> {
        let area = geometry.dual_length() * geometry.thickness;
        self.fracture_energy.map(|energy| Softening {
            limits: self.limits(geometry, 1.0),
            energy: energy * area,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_component_nearest_to_its_limit_names_the_mode() {
        let limits = Limits {
            tension: 1.0,
            compression: 10.0,
            shear: 2.0,
            bending: f64::INFINITY,
        };
        let force = ContactForce {
            normal: -5.0,
            shear: 0.5,
            moment: 100.0,
        };
        assert_eq!(limits.utilisation(force), (0.5, Mode::Compression));
    }

    #[test]
    fn stresses_become_forces_over_the_dual_edge() {
        let strength = Strength {
            kind: StrengthKind::Stress,
            tension: 3.0,
            bending: 6.0,
            ..Strength::UNBREAKABLE
        };
        let geometry = ContactGeometry {
            dual_parts: [1.0, 1.0],
            branch_length: 2.0,
            thickness: 0.5,
        };
        let limits = strength.limits(&geometry, 2.0);
        assert_eq!((limits.tension, limits.bending), (6.0, 4.0));
        assert_eq!(limits.shear, f64::INFINITY);
    }
}
