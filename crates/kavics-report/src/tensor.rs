//! Eigenvalues of a symmetric tensor of the plane, for showing.

use kavics_results::Columns;

use crate::ReportError;

/// Deviators below this share of the trace have no direction.
const ISOTROPIC: f64 = 1e-9;

/// The principal values of a symmetric tensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Principal {
    pub(crate) larger: f64,
    pub(crate) smaller: f64,
    /// Direction of the larger value, from the x axis, in [−90, 90]; NaN where both are the same.
    pub(crate) degrees: f64,
}

impl Principal {
    pub(crate) fn of(xx: f64, xy: f64, yy: f64) -> Self {
        let mean = 0.5 * (xx + yy);
        let half = 0.5 * (xx - yy);
        let radius = half.hypot(xy);
        let isotropic = radius <= ISOTROPIC * mean.abs();
        let angle = 0.5 * xy.atan2(half).to_degrees();
        Self {
            larger: mean + radius,
            smaller: mean - radius,
            degrees: if isotropic { f64::NAN } else { angle },
        }
    }

    /// One for each row of a table with the columns `NAME_xx`, `NAME_xy`, `NAME_yy`.
    pub(crate) fn of_column(table: &Columns, name: &str) -> Result<Vec<Self>, ReportError> {
        let component = |which: &str| table.numbers(&format!("{name}_{which}"));
        let (xx, xy, yy) = (component("xx")?, component("xy")?, component("yy")?);
        Ok((0..table.len())
            .map(|row| Self::of(xx[row], xy[row], yy[row]))
            .collect())
    }

    /// Larger value less smaller value.
    pub(crate) fn deviator(&self) -> f64 {
        self.larger - self.smaller
    }
}

/// The same direction as `degrees`, at most a quarter turn from `reference`: −89 and 91 are one direction, and a
/// curve must not jump between them.
pub(crate) fn near(degrees: f64, reference: f64) -> f64 {
    degrees - 180.0 * ((degrees - reference) / 180.0).round()
}

#[cfg(test)]
mod tests {
    use super::{Principal, near};

    #[test]
    fn a_direction_has_two_names() {
        assert_eq!(near(-89.0, 90.0), 91.0);
        assert_eq!(near(85.0, 90.0), 85.0);
    }

    #[test]
    fn a_pure_shear_points_along_the_diagonal() {
        let principal = Principal::of(0.0, 1.0, 0.0);
        assert_eq!(principal.larger, 1.0);
        assert_eq!(principal.smaller, -1.0);
        assert!((principal.degrees - 45.0).abs() < 1e-12);
    }

    #[test]
    fn an_isotropic_tensor_has_no_direction() {
        assert!(Principal::of(0.5, 0.0, 0.5).degrees.is_nan());
    }
}
