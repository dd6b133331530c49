//! Tensors of the plane.

use std::ops::{Add, AddAssign, Mul};

use crate::geometry::Vector;

/// A symmetric tensor of the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SymmetricTensor {
    /// Component xx.
    pub xx: f64,
    /// Component xy.
    pub xy: f64,
    /// Component yy.
    pub yy: f64,
}

/// A tensor of the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tensor {
    /// Component xx.
    pub xx: f64,
    /// Component xy.
    pub xy: f64,
    /// Component yx.
    pub yx: f64,
    /// Component yy.
    pub yy: f64,
}

impl SymmetricTensor {
    /// The tensor a_i·a_j.
    pub fn square(a: Vector) -> Self {
        Self {
            xx: a.x * a.x,
            xy: a.x * a.y,
            yy: a.y * a.y,
        }
    }

    /// The same tensor with both its components off the diagonal.
    pub(super) fn full(self) -> Tensor {
        Tensor {
            xx: self.xx,
            xy: self.xy,
            yx: self.xy,
            yy: self.yy,
        }
    }

    /// Sum of the diagonal.
    pub fn trace(self) -> f64 {
        self.xx + self.yy
    }

    /// Difference of the eigenvalues, λ₁ − λ₂ ≥ 0.
    ///
    /// ```math
    /// \lambda_1 - \lambda_2 = \sqrt{(a_{xx} - a_{yy})^2 + 4 a_{xy}^2}
    /// ```
    ///
    /// Of a fabric tensor, twice this is the amplitude a of the distribution of contact normals
    /// E(θ) = (1 + a·cos 2(θ − θ₁))/2π.
    pub fn deviator(self) -> f64 {
        libm::hypot(self.xx - self.yy, 2.0 * self.xy)
    }

    /// Eigenvalues, the larger first.
    pub fn eigenvalues(self) -> [f64; 2] {
        let (mean, half) = (0.5 * self.trace(), 0.5 * self.deviator());
        [mean + half, mean - half]
    }

    /// Angle θ₁ of the eigenvector of the larger eigenvalue from the x axis, counter-clockwise, in radians within
    /// (−π/2, π/2]; 0 where the eigenvalues are equal.
    pub fn principal_direction(self) -> f64 {
        0.5 * libm::atan2(2.0 * self.xy, self.xx - self.yy)
    }
}

impl Tensor {
    /// The tensor a_i·b_j.
    pub fn product(a: Vector, b: Vector) -> Self {
        Self {
            xx: a.x * b.x,
            xy: a.x * b.y,
            yx: a.y * b.x,
            yy: a.y * b.y,
        }
    }

    /// The tensor `value`·δ_ij.
    pub fn isotropic(value: f64) -> Self {
        Self {
            xx: value,
            yy: value,
            ..Self::default()
        }
    }

    /// Sum of the diagonal.
    pub fn trace(self) -> f64 {
        self.xx + self.yy
    }

    /// Component xy less component yx.
    pub fn asymmetry(self) -> f64 {
        self.xy - self.yx
    }

    /// The symmetric part, ½(a_ij + a_ji).
    pub fn symmetric(self) -> SymmetricTensor {
        SymmetricTensor {
            xx: self.xx,
            xy: 0.5 * (self.xy + self.yx),
            yy: self.yy,
        }
    }

    /// The inner product a_ij·b_ij.
    pub fn inner(self, other: Self) -> f64 {
        self.xx * other.xx + self.xy * other.xy + self.yx * other.yx + self.yy * other.yy
    }

    /// The vector x_k·a_kj: with a displacement gradient, the affine displacement at x.
    pub fn at(self, x: Vector) -> Vector {
        Vector::new(x.x * self.xx + x.y * self.yx, x.x * self.xy + x.y * self.yy)
    }
}

impl Add for SymmetricTensor {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            xx: self.xx + other.xx,
            xy: self.xy + other.xy,
            yy: self.yy + other.yy,
        }
    }
}

impl Add for Tensor {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            xx: self.xx + other.xx,
            xy: self.xy + other.xy,
            yx: self.yx + other.yx,
            yy: self.yy + other.yy,
        }
    }
}

impl AddAssign for SymmetricTensor {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl AddAssign for Tensor {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Mul<f64> for SymmetricTensor {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self {
            xx: self.xx * factor,
            xy: self.xy * factor,
            yy: self.yy * factor,
        }
    }
}

impl Mul<f64> for Tensor {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self {
            xx: self.xx * factor,
            xy: self.xy * factor,
            yx: self.yx * factor,
            yy: self.yy * factor,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// 3 along the direction 0.4, 1 across it.
    fn known() -> SymmetricTensor {
        let along = Vector::new(libm::cos(0.4), libm::sin(0.4));
        SymmetricTensor::square(along) * 3.0 + SymmetricTensor::square(along.quarter_turn())
    }

    #[test]
    fn eigenvalues_and_direction_come_back() {
        let [larger, smaller] = known().eigenvalues();
        assert!((larger - 3.0).abs() < 1e-14);
        assert!((smaller - 1.0).abs() < 1e-14);
        assert!((known().deviator() - 2.0).abs() < 1e-14);
        assert!((known().principal_direction() - 0.4).abs() < 1e-14);
    }

    #[test]
    fn a_tensor_larger_in_y_points_up() {
        let upright = SymmetricTensor {
            yy: 1.0,
            ..SymmetricTensor::default()
        };
        assert_eq!(upright.principal_direction(), FRAC_PI_2);
    }

    #[test]
    fn an_isotropic_tensor_has_no_deviator() {
        let round = Tensor::isotropic(0.5).symmetric();
        assert_eq!(round.deviator(), 0.0);
        assert_eq!(round.principal_direction(), 0.0);
    }

    #[test]
    fn the_first_index_of_a_gradient_is_that_of_the_place() {
        let shear = Tensor {
            xy: 0.1,
            ..Tensor::default()
        };
        assert_eq!(shear.at(Vector::new(2.0, 5.0)), Vector::new(0.0, 0.2));
    }
}
