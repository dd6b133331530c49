//! The elasticity tensor of the plane.

/// A plane elasticity tensor, `[force/length²]`: σ_a = Σ_b C_ab·ε_b with σ = (σ_xx, σ_yy, σ_xy) and
/// ε = (ε_xx, ε_yy, 2·ε_xy), the symmetric parts of stress and strain.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ElasticityTensor {
    /// C_ab, rows xx, yy, xy of the stress, columns xx, yy, xy of the strain.
    pub rows: [[f64; 3]; 3],
}

/// Factor of a component in which the tensor is a matrix with the tensor's own norm (Kelvin's notation).
const KELVIN: [f64; 3] = [1.0, 1.0, std::f64::consts::SQRT_2];

impl ElasticityTensor {
    /// The isotropic tensor with bulk modulus K and shear modulus G of the plane:
    /// C_xxxx = K + G, C_xxyy = K − G, C_xyxy = G.
    pub fn isotropic(bulk_modulus: f64, shear_modulus: f64) -> Self {
        let (sum, difference) = (bulk_modulus + shear_modulus, bulk_modulus - shear_modulus);
        Self {
            rows: [
                [sum, difference, 0.0],
                [difference, sum, 0.0],
                [0.0, 0.0, shear_modulus],
            ],
        }
    }

    /// Bulk modulus of the nearest isotropic tensor, mean stress over change of area, `[force/length²]`:
    ///
    /// ```math
    /// K = \tfrac14 (C_{xxxx} + C_{yyyy} + C_{xxyy} + C_{yyxx})
    /// ```
    pub fn bulk_modulus(&self) -> f64 {
        let [[xxxx, xxyy, _], [yyxx, yyyy, _], _] = self.rows;
        0.25 * (xxxx + yyyy + xxyy + yyxx)
    }

    /// Shear modulus of the nearest isotropic tensor, `[force/length²]`:
    ///
    /// ```math
    /// G = \tfrac18 (C_{xxxx} + C_{yyyy} - C_{xxyy} - C_{yyxx} + 4 C_{xyxy})
    /// ```
    pub fn shear_modulus(&self) -> f64 {
        let [[xxxx, xxyy, _], [yyxx, yyyy, _], [_, _, xyxy]] = self.rows;
        0.125 * (xxxx + yyyy - xxyy - yyxx + 4.0 * xyxy)
    }

    /// Young's modulus of the nearest isotropic tensor, 4·K·G/(K + G), `[force/length²]`.
    pub fn young_modulus(&self) -> f64 {
        let (bulk, shear) = (self.bulk_modulus(), self.shear_modulus());
        4.0 * bulk * shear / (bulk + shear)
    }

    /// Poisson's ratio of the nearest isotropic tensor, (K − G)/(K + G), dimensionless.
    pub fn poisson_ratio(&self) -> f64 {
        let (bulk, shear) = (self.bulk_modulus(), self.shear_modulus());
        (bulk - shear) / (bulk + shear)
    }

    /// How far the tensor is from isotropic: ‖C − C_iso‖/‖C‖ with the nearest isotropic tensor, the same in every
    /// frame; 0 for an isotropic tensor, below 1. None without stiffness.
    pub fn anisotropy(&self) -> Option<f64> {
        let nearest = Self::isotropic(self.bulk_modulus(), self.shear_modulus());
        self.share(&self.minus(&nearest))
    }

    /// How far the tensor is from symmetric: ‖½(C − Cᵀ)‖/‖C‖; 0 where the contacts have a potential. None without
    /// stiffness.
    pub fn asymmetry(&self) -> Option<f64> {
        self.share(&self.minus(&self.symmetric()))
    }

    /// The symmetric part, ½(C_ab + C_ba).
    #[must_use]
    pub fn symmetric(&self) -> Self {
        Self::from_fn(|a, b| 0.5 * (self.rows[a][b] + self.rows[b][a]))
    }

    /// The difference of two tensors.
    #[must_use]
    pub fn minus(&self, other: &Self) -> Self {
        Self::from_fn(|a, b| self.rows[a][b] - other.rows[a][b])
    }

    /// Norm ‖C‖ = √(C_ijkl·C_ijkl), `[force/length²]`.
    pub fn norm(&self) -> f64 {
        let kelvin = self.kelvin();
        kelvin.iter().flatten().map(|c| c * c).sum::<f64>().sqrt()
    }

    /// Whether no strain has a negative energy beyond `tolerance`: the symmetric part has no eigenvalue below
    /// −tolerance, `[force/length²]`.
    pub fn is_positive(&self, tolerance: f64) -> bool {
        let mut m = self.symmetric().kelvin();
        for (k, row) in m.iter_mut().enumerate() {
            row[k] += tolerance;
        }
        let minor = |i: usize, j: usize| m[i][i] * m[j][j] - m[i][j] * m[j][i];
        let determinant = m[0][0] * minor(1, 2) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
        let diagonal = (0..3).all(|k| m[k][k] >= 0.0);
        diagonal
            && [minor(0, 1), minor(0, 2), minor(1, 2), determinant]
                .iter()
                .all(|d| *d >= 0.0)
    }

    fn from_fn(value: impl Fn(usize, usize) -> f64) -> Self {
        Self {
            rows: [0, 1, 2].map(|a| [0, 1, 2].map(|b| value(a, b))),
        }
    }

    /// As the matrix of Kelvin's notation.
    fn kelvin(&self) -> [[f64; 3]; 3] {
        Self::from_fn(|a, b| KELVIN[a] * KELVIN[b] * self.rows[a][b]).rows
    }

    fn share(&self, part: &Self) -> Option<f64> {
        let norm = self.norm();
        (norm > 0.0).then(|| part.norm() / norm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_isotropic_tensor_gives_back_its_moduli() {
        let tensor = ElasticityTensor::isotropic(3.0, 1.0);
        assert_eq!((tensor.bulk_modulus(), tensor.shear_modulus()), (3.0, 1.0));
        assert_eq!(tensor.anisotropy(), Some(0.0));
        assert_eq!((tensor.young_modulus(), tensor.poisson_ratio()), (3.0, 0.5));
    }

    /// A square lattice pulled along its rows answers with k_n, sheared along them with k_t/2: with k_n = k_t it is
    /// isotropic, with k_t = 0 it is off by half of its norm.
    #[test]
    fn a_square_lattice_without_shear_is_half_anisotropic() {
        let lattice = |shear: f64| ElasticityTensor {
            rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.5 * shear]],
        };
        assert!(lattice(1.0).anisotropy().is_some_and(|a| a < 1e-15));
        // K = ½, G = ¼; ‖C − C_iso‖² = 4·(¼)² + (½)² = ½ and ‖C‖² = 2.
        let expected = 0.5;
        let anisotropy = lattice(0.0).anisotropy().expect("a stiff lattice");
        assert!((anisotropy - expected).abs() < 1e-15);
    }

    #[test]
    fn a_tensor_is_positive_down_to_its_lowest_eigenvalue() {
        // Eigenvalues 2K, 2G, 2G in Kelvin's notation.
        let tensor = ElasticityTensor::isotropic(1.0, -0.25);
        assert!(tensor.is_positive(0.500_001));
        assert!(!tensor.is_positive(0.499_999));
    }
}
