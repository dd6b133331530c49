//! From moduli and the dual edge to the stiffness of one contact. Bojtár & Bagi (1989), eq. 21.

use super::{Cemented, Cohesionless, ContactGeometry, Softening, StiffnessRule};

/// Stiffness of one contact in the undeformed assembly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stiffness {
    /// k_n, `[force/length]`.
    pub normal: f64,
    /// k_t at zero opening, `[force/length]`.
    pub shear: f64,
    /// k_m, `[force·length]`.
    pub moment: f64,
    /// k_nφ, which couples opening and rotation where the contact point is not the middle of the dual edge, `[force]`.
    pub coupling: f64,
    /// h = μ·k_n/s: the shear stiffness falls by this much per opening, `[force/length²]`.
    pub hardening: f64,
    /// The shear stiffness falls no lower, `[force/length]`; −∞ without a floor.
    pub shear_floor: f64,
    /// How the bond softens; none: not at all.
    pub softening: Option<Softening>,
}

impl Stiffness {
    /// With the limits at which the bond begins to soften multiplied by its strength factor.
    #[must_use]
    pub fn with_strength_factor(mut self, factor: f64) -> Self {
        if let Some(softening) = &mut self.softening {
            softening.limits = softening.limits.scaled(factor);
        }
        self
    }

    /// k_t at opening v_n: k_t = k_t0 − h·v_n, not below the floor.
    pub fn shear_at(&self, opening: f64) -> f64 {
        (self.shear - self.hardening * opening).max(self.shear_floor)
    }

    /// ∂k_t/∂v_n: −h, and 0 on the floor.
    pub fn shear_slope(&self, opening: f64) -> f64 {
        if self.on_floor(opening) {
            0.0
        } else {
            -self.hardening
        }
    }

    /// Whether the floor holds the shear stiffness at this opening.
    pub fn on_floor(&self, opening: f64) -> bool {
        self.shear - self.hardening * opening < self.shear_floor
    }
}

impl ContactGeometry {
    /// Dual length s.
    pub fn dual_length(&self) -> f64 {
        self.dual_parts[0] + self.dual_parts[1]
    }
}

impl StiffnessRule {
    /// Stiffness of a contact whose contact point is the middle of the dual edge.
    fn centred(&self, geometry: &ContactGeometry) -> Stiffness {
        let s = geometry.dual_length();
        let layer = |e: f64, g: f64| Stiffness {
            normal: e * s,
            shear: g * s,
            moment: e * s * s * s / 12.0,
            ..Stiffness::default()
        };
        match *self {
            Self::Layer { normal, shear } => {
                layer(normal * geometry.thickness, shear * geometry.thickness)
            }
            Self::Modulus { normal, shear } => {
                let depth = geometry.thickness / geometry.branch_length;
                layer(normal * depth, shear * depth)
            }
            Self::Direct {
                normal,
                shear,
                moment,
            } => Stiffness {
                normal,
                shear,
                moment,
                ..Stiffness::default()
            },
        }
    }

    /// Stiffness with the coupling of a contact point off the middle of the dual edge:
    /// k_nφ = −E/2·(s₂² − s₁²) and k_m = E/3·(s₁³ + s₂³), s₂ on the side of +t.
    fn eccentric(&self, geometry: &ContactGeometry) -> Stiffness {
        let centred = self.centred(geometry);
        if matches!(self, Self::Direct { .. }) {
            return centred;
        }
        let [right, left] = geometry.dual_parts;
        let modulus = centred.normal / geometry.dual_length();
        Stiffness {
            coupling: -0.5 * modulus * (left * left - right * right),
            moment: modulus / 3.0 * (right * right * right + left * left * left),
            ..centred
        }
    }
}

/// Adds what makes the shear stiffness depend on the opening.
fn hardened(
    plain: Stiffness,
    geometry: &ContactGeometry,
    factor: f64,
    floor: Option<f64>,
) -> Stiffness {
    let hardening = if factor == 0.0 {
        0.0
    } else {
        factor * plain.normal / geometry.dual_length()
    };
    Stiffness {
        hardening,
        shear_floor: floor.map_or(f64::NEG_INFINITY, |share| share * plain.shear),
        ..plain
    }
}

impl Cemented {
    /// Stiffness of a cemented contact; where it softens, with the limits at strength factor 1.
    pub fn stiffness(&self, geometry: &ContactGeometry) -> Stiffness {
        let rule = &self.stiffness;
        let plain = if self.eccentric {
            rule.eccentric(geometry)
        } else {
            rule.centred(geometry)
        };
        Stiffness {
            softening: self.strength.softening(geometry),
            ..hardened(plain, geometry, self.shear_hardening, self.shear_floor)
        }
    }
}

impl Cohesionless {
    /// Stiffness of a cohesionless contact: no moment.
    pub fn stiffness(&self, geometry: &ContactGeometry) -> Stiffness {
        let plain = Stiffness {
            moment: 0.0,
            ..self.stiffness.centred(geometry)
        };
        hardened(plain, geometry, self.shear_hardening, self.shear_floor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: ContactGeometry = ContactGeometry {
        dual_parts: [0.6, 0.6],
        branch_length: 2.0,
        thickness: 1.0,
    };

    #[test]
    fn a_layer_gives_the_stiffness_of_the_source() {
        let k = StiffnessRule::Layer {
            normal: 2.0,
            shear: 0.5,
        }
        .centred(&UNIT);
        assert_eq!((k.normal, k.shear), (2.4, 0.6));
        assert!((k.moment - 2.0 * 1.2_f64.powi(3) / 12.0).abs() < 1e-15);
    }

    #[test]
    fn a_centred_contact_point_couples_nothing() {
        let rule = StiffnessRule::Modulus {
            normal: 2.0,
            shear: 0.5,
        };
        let (centred, eccentric) = (rule.centred(&UNIT), rule.eccentric(&UNIT));
        assert_eq!(eccentric.coupling, 0.0);
        assert!((centred.moment - eccentric.moment).abs() < 1e-15);
    }

    #[test]
    fn an_eccentric_contact_point_moves_the_stiffness_to_the_middle_of_the_edge() {
        // Steiner: k_m = k_m(middle) + k_n·e², k_nφ = −k_n·e with e = (s₂ − s₁)/2.
        let rule = StiffnessRule::Layer {
            normal: 3.0,
            shear: 1.0,
        };
        let off = ContactGeometry {
            dual_parts: [0.4, 0.8],
            ..UNIT
        };
        let (centred, k) = (rule.centred(&off), rule.eccentric(&off));
        assert!((k.coupling + k.normal * 0.2).abs() < 1e-15);
        assert!((k.moment - centred.moment - k.normal * 0.04).abs() < 1e-15);
    }
}
