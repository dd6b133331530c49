//! Rose of contact normals: how they are spread over classes of direction.

use std::f64::consts::{PI, TAU};

use crate::geometry::Vector;
use crate::measure::SymmetricTensor;

/// Contact normals by direction, each as an axis: n and −n are one.
///
/// The half circle is parted into equal classes; class k has its middle at k·Δθ from the x axis, counter-clockwise, so
/// that the directions of regular arrangements lie well inside of theirs. The other half of the circle is the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rose {
    /// Number of contacts in each class.
    pub contacts: Vec<usize>,
}

impl Rose {
    /// The rose of these unit normals in `classes` classes of the half circle.
    pub fn new(normals: impl Iterator<Item = Vector>, classes: usize) -> Self {
        let mut contacts = vec![0; classes];
        let width = PI / classes as f64;
        for normal in normals {
            // To the right or straight up, so that n and −n give the same bits.
            let turned = normal.x < 0.0 || (normal.x == 0.0 && normal.y < 0.0);
            let axis = if turned { -normal } else { normal };
            let class = (libm::atan2(axis.y, axis.x) / width).round() as isize;
            contacts[class.rem_euclid(classes as isize) as usize] += 1;
        }
        Self { contacts }
    }

    /// Width Δθ of a class, in radians.
    pub fn width(&self) -> f64 {
        PI / self.contacts.len() as f64
    }

    /// Distribution density E of directions in each class: its share of all contacts, counted with n and −n, over its
    /// width. The integral over the circle is 1, isotropic contacts have E = 1/2π; 0 without contacts.
    pub fn density(&self) -> Vec<f64> {
        let all = self.contacts.iter().sum::<usize>().max(1) as f64;
        let density = |&count: &usize| count as f64 / (2.0 * all * self.width());
        self.contacts.iter().map(density).collect()
    }
}

/// Distribution density of directions by its first harmonic, at an angle from the x axis, from the fabric tensor φ.
///
/// ```math
/// E(\theta) = \frac{1}{2\pi}\bigl(1 + a \cos 2(\theta - \theta_a)\bigr)
///           = \frac{4\,\varphi_{ij} n_i n_j - 1}{2\pi}
/// ```
///
/// with a twice the deviator of φ and θ_a its principal direction, n = (cos θ, sin θ): the two-term Fourier series that
/// has the same φ as all the contacts. Below zero where a > 1. Rothenburg & Bathurst (1989).
pub fn first_harmonic(fabric: SymmetricTensor, angle: f64) -> f64 {
    let n = Vector::new(libm::cos(angle), libm::sin(angle));
    let along = fabric.xx * n.x * n.x + 2.0 * fabric.xy * n.x * n.y + fabric.yy * n.y * n.y;
    (4.0 * along - fabric.trace()) / TAU
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::fabric_of_normals;
    use proptest::prelude::*;

    fn direction(degrees: f64) -> Vector {
        let angle = degrees.to_radians();
        Vector::new(libm::cos(angle), libm::sin(angle))
    }

    #[test]
    fn a_hexagonal_lattice_points_in_six_directions() {
        let normals = [0.0, 60.0, 120.0, 0.0, 60.0, 300.0].map(direction);
        let rose = Rose::new(normals.into_iter(), 18);
        let expected: Vec<usize> = (0..18).map(|k| if k % 6 == 0 { 2 } else { 0 }).collect();
        assert_eq!(rose.contacts, expected);
        // Each of 6 sectors of 36 holds a sixth: six times the isotropic density.
        assert!((rose.density()[6] - 6.0 / TAU).abs() < 1e-15);
    }

    #[test]
    fn vertical_is_one_class_from_above_and_below() {
        let nearly = [90.0, -90.0, 89.0, 91.0, -89.0, 274.0].map(direction);
        assert_eq!(Rose::new(nearly.into_iter(), 18).contacts[9], 6);
        let flat = [0.0, 180.0, -180.0, 4.0, -4.0, 176.0].map(direction);
        assert_eq!(Rose::new(flat.into_iter(), 18).contacts[0], 6);
        // Between two classes of five.
        let upright = [Vector::new(0.0, 1.0), Vector::new(-0.0, -1.0)];
        assert_eq!(Rose::new(upright.into_iter(), 5).contacts[3], 2);
    }

    /// Directions at equal steps of the distribution function of E with a = ½, θ_a = 30°.
    fn spread(count: u32) -> Vec<Vector> {
        let (a, theta_a) = (0.5, 30.0_f64.to_radians());
        let angle = |i: u32| {
            let wanted = (f64::from(i) + 0.5) / f64::from(count) * PI;
            let share = |x: f64| x + 0.5 * a * libm::sin(2.0 * x);
            let (mut low, mut high) = (0.0, PI);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if share(middle) < wanted {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            low + theta_a
        };
        (0..count)
            .map(|i| direction(angle(i).to_degrees()))
            .collect()
    }

    #[test]
    fn contacts_spread_by_a_first_harmonic_give_it_back() {
        let normals = spread(100_000);
        let fabric = fabric_of_normals(normals.iter().copied()).unwrap();
        // The deviator is half of the amplitude.
        assert!((fabric.deviator() - 0.25).abs() < 1e-6);
        assert!((fabric.principal_direction().to_degrees() - 30.0).abs() < 1e-3);
        let rose = Rose::new(normals.into_iter(), 180);
        for (k, density) in rose.density().into_iter().enumerate() {
            let expected = first_harmonic(fabric, k as f64 * rose.width());
            assert!((density - expected).abs() < 1e-3, "class {k}");
        }
    }

    #[test]
    fn without_contacts_there_is_no_density() {
        let nothing = Rose::new(std::iter::empty(), 6);
        assert_eq!(nothing.density(), [0.0; 6]);
        assert_eq!(fabric_of_normals(std::iter::empty()), None);
    }

    proptest! {
        #[test]
        fn a_normal_and_its_opposite_are_of_one_class(degrees in -360.0..360.0_f64, classes in 1_usize..90) {
            let of = |n: Vector| Rose::new(std::iter::once(n), classes);
            let n = direction(degrees);
            prop_assert_eq!(of(n), of(-n));
            prop_assert_eq!(of(n).contacts.iter().sum::<usize>(), 1);
            let density: f64 = of(n).density().iter().sum();
            prop_assert!((2.0 * density * of(n).width() - 1.0).abs() < 1e-12);
        }
    }
}
