//! What a pack turned out to be: realised sieve curve, packing fraction, whole and over the height.
//!
//! In: grains and their container. Out: numbers of the pack alone; those of its contacts are in [`crate::measure`].

use std::f64::consts::PI;

use crate::assembly::Grain;
use crate::geometry::{Container, HalfPlane, Polygon, Vector};
use crate::ids::PerGrain;
use crate::packing::Mass;

/// Realised sieve curve: the share of the mass of all grains in those up to each `diameter`, which rise.
///
/// P(d) = Σ dᵖ over the grains with 2·R ≤ d, by the sum over all; p as [`Mass`] says.
pub fn sieve_curve(grains: &PerGrain<Grain>, diameter: &[f64], mass: Mass) -> Vec<f64> {
    let mut caught = vec![0.0; diameter.len() + 1];
    for grain in grains.values() {
        let own = 2.0 * grain.radius;
        caught[diameter.partition_point(|&limit| limit < own)] += mass.of(own);
    }
    for sieve in 1..caught.len() {
        caught[sieve] += caught[sieve - 1];
    }
    let total = caught[diameter.len()];
    caught.truncate(diameter.len());
    caught.iter().map(|passing| passing / total).collect()
}

/// Diameters below which given shares of the mass lie, each that of a grain: the smallest d with P(d) at least the
/// share; those of equal grains once. `[length]`
pub fn quantile_diameters(grains: &PerGrain<Grain>, shares: &[f64], mass: Mass) -> Vec<f64> {
    let mut diameters: Vec<f64> = grains.values().iter().map(|g| 2.0 * g.radius).collect();
    diameters.sort_unstable_by(f64::total_cmp);
    let mut sum = 0.0;
    let add = |&diameter: &f64| {
        sum += mass.of(diameter);
        sum
    };
    let passing: Vec<f64> = diameters.iter().map(add).collect();
    let total = passing.last().copied().unwrap_or_default();
    let mut quantiles: Vec<f64> = shares
        .iter()
        .map(|share| passing.partition_point(|&below| below < share * total))
        .filter_map(|at| diameters.get(at).copied())
        .collect();
    quantiles.dedup();
    quantiles
}

/// A horizontal strip of a container, and what of it the grains fill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strip {
    /// Height where it begins, `[length]`.
    pub from: f64,
    /// Height where it ends, `[length]`.
    pub to: f64,
    /// Area of the container within it, `[length²]`.
    pub area: f64,
    /// Area of the discs within it, `[length²]`.
    pub solid: f64,
}

impl Strip {
    /// Area of the discs by that of the container.
    pub fn packing_fraction(&self) -> f64 {
        self.solid / self.area
    }
}

/// Packing fraction over the height: `count` strips of equal height from the floor of the container up to the
/// highest grain. Discs are cut exactly, each by the strips it meets; none reaches beyond the container.
pub fn strips(grains: &PerGrain<Grain>, container: &Container, count: usize) -> Vec<Strip> {
    let polygon = Polygon::from(container);
    let floor = polygon.heights().map_or(0.0, |[low, _]| low);
    let height = (top(grains) - floor) / count as f64;
    let level = |k: usize| floor + height * k as f64;
    let strip = |k: usize| Strip {
        from: level(k),
        to: level(k + 1),
        area: polygon.between_heights(level(k), level(k + 1)).area(),
        solid: 0.0,
    };
    let mut strips: Vec<Strip> = (0..count).map(strip).collect();
    let strip_at = |y: f64| (((y - floor) / height).max(0.0) as usize).min(count - 1);
    for &Grain { centre, radius } in grains.values() {
        let lowest = strip_at(centre.y - radius);
        let highest = strip_at(centre.y + radius);
        let mut above = PI * radius * radius;
        for strip in &mut strips[lowest..highest] {
            let beyond = segment(strip.to - centre.y, radius);
            strip.solid += above - beyond;
            above = beyond;
        }
        strips[highest].solid += above;
    }
    strips
}

/// Height of the highest point of any grain, `[length]`.
pub fn top(grains: &PerGrain<Grain>) -> f64 {
    let tops = grains.values().iter().map(|g| g.centre.y + g.radius);
    tops.fold(f64::NEG_INFINITY, f64::max)
}

/// How far the inside of a pack is from the sides of its container and from its surface, in largest radii.
pub const INSIDE: f64 = 3.0;

/// Packing fraction of the inside of a pack: at least [`INSIDE`] largest radii away from every side, and as far below
/// the lowest place of its surface. None where this leaves nothing.
pub fn inner_packing_fraction(grains: &PerGrain<Grain>, container: &Container) -> Option<f64> {
    let radii = grains.values().iter().map(|grain| grain.radius);
    let largest = radii.fold(0.0, f64::max);
    let margin = INSIDE * largest;
    let whole = Polygon::from(container);
    let below_surface = HalfPlane {
        point: Vector::new(0.0, lowest_surface(grains, &whole, largest) - margin),
        outward: Vector::new(0.0, 1.0),
    };
    let within = |polygon: Polygon, side: &HalfPlane| {
        polygon.cut(HalfPlane {
            point: side.point - side.outward * margin,
            outward: side.outward,
        })
    };
    let inside = container
        .sides()
        .iter()
        .fold(whole.cut(below_surface), within);
    let discs = grains.values().iter().map(|g| (g.centre, g.radius));
    let area = inside.area();
    (area > 0.0).then(|| inside.area_of_discs(discs) / area)
}

/// Width of the columns in which the surface is looked for, in largest radii.
const COLUMN: f64 = 4.0;

/// The lowest of the highest points of columns. Columns in which the container ends below the highest grain have no
/// surface, as those beside the peak of a triangle.
fn lowest_surface(grains: &PerGrain<Grain>, container: &Polygon, largest: f64) -> f64 {
    let highest = top(grains);
    let Some([left, right]) = container.widths() else {
        return highest;
    };
    let count = (((right - left) / (COLUMN * largest)) as usize).max(1);
    let width = (right - left) / count as f64;
    let mut tops = vec![f64::NEG_INFINITY; count];
    for grain in grains.values() {
        let column = (((grain.centre.x - left) / width).max(0.0) as usize).min(count - 1);
        tops[column] = tops[column].max(grain.centre.y + grain.radius);
    }
    let is_open = |column: usize| {
        let from = left + width * column as f64;
        let heights = container.between_widths(from, from + width).heights();
        heights.is_some_and(|[_, high]| high >= highest - largest)
    };
    let open = (0..count).filter(|&column| is_open(column));
    open.map(|column| tops[column]).fold(highest, f64::min)
}

/// Packing fraction: the area of the discs within a rectangle by the area of the rectangle. Discs are cut exactly.
pub fn packing_fraction(grains: &PerGrain<Grain>, lower_left: Vector, upper_right: Vector) -> f64 {
    let solid: f64 = grains
        .values()
        .iter()
        .map(|grain| {
            let from = lower_left - grain.centre;
            let to = upper_right - grain.centre;
            let corner = |x, y| area_beyond(x, y, grain.radius);
            corner(from.x, from.y) - corner(to.x, from.y) - corner(from.x, to.y)
                + corner(to.x, to.y)
        })
        .sum();
    let size = upper_right - lower_left;
    solid / (size.x * size.y)
}

/// Area of the disc x² + y² ≤ r² to the right of x = a and above y = b.
fn area_beyond(a: f64, b: f64, r: f64) -> f64 {
    let right = segment(a, r);
    let above = segment(b, r);
    if a * a + b * b < r * r {
        return 0.5 * (right + above) - 0.25 * PI * r * r + a * b;
    }
    match (a < 0.0, b < 0.0) {
        (false, false) => 0.0,
        (true, false) => above,
        (false, true) => right,
        (true, true) => (right + above - PI * r * r).max(0.0),
    }
}

/// Area of the disc of radius r beyond a line at distance a from its centre: r²·acos(a/r) − a·√(r² − a²).
fn segment(a: f64, r: f64) -> f64 {
    if a >= r {
        0.0
    } else if a <= -r {
        PI * r * r
    } else {
        r * r * libm::acos(a / r) - a * (r * r - a * a).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn discs(discs: &[[f64; 3]]) -> PerGrain<Grain> {
        let grain = |&[x, y, radius]: &[f64; 3]| Grain {
            centre: Vector::new(x, y),
            radius,
        };
        discs.iter().map(grain).collect()
    }

    #[test]
    fn a_disc_is_cut_by_the_window() {
        let disc = discs(&[[0.0, 0.0, 1.0]]);
        let fraction = |a: [f64; 2], b: [f64; 2]| {
            packing_fraction(&disc, Vector::new(a[0], a[1]), Vector::new(b[0], b[1]))
        };
        // Whole, half, quarter of a disc, a square inside it, nothing.
        assert!((fraction([-1.0, -1.0], [1.0, 1.0]) - PI / 4.0).abs() < 1e-15);
        assert!((fraction([0.0, -2.0], [2.0, 2.0]) - PI / 16.0).abs() < 1e-15);
        assert!((fraction([0.0, 0.0], [1.0, 1.0]) - PI / 4.0).abs() < 1e-15);
        assert!((fraction([-0.5, -0.5], [0.5, 0.5]) - 1.0).abs() < 1e-15);
        assert!(fraction([0.8, 0.8], [2.0, 2.0]).abs() < 1e-15);
    }

    fn box_of(width: f64, height: f64) -> Container {
        let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
        Container::polygon(&corners.map(|(x, y)| Vector::new(x, y)))
    }

    #[test]
    fn strips_of_one_disc_add_up_to_it() {
        let disc = discs(&[[1.5, 1.25, 1.0]]);
        for count in [1, 2, 3, 7, 1000] {
            let strips = strips(&disc, &box_of(4.0, 9.0), count);
            let solid: f64 = strips.iter().map(|strip| strip.solid).sum();
            let area: f64 = strips.iter().map(|strip| strip.area).sum();
            assert!((solid - PI).abs() < 1e-13);
            // Up to the top of the disc, not of the box.
            assert!((area - 4.0 * 2.25).abs() < 1e-12);
            assert!(strips.iter().all(|strip| strip.solid >= -1e-15));
        }
    }

    #[test]
    fn a_strip_is_cut_exactly() {
        // A unit disc on the floor, cut at ½: the cap of height ½ is π/3 − √3/4.
        let cap = PI / 3.0 - 3.0_f64.sqrt() / 4.0;
        let strips = strips(&discs(&[[1.0, 1.0, 1.0]]), &box_of(2.0, 2.0), 4);
        assert!((strips[0].solid - cap).abs() < 1e-15);
        assert!((strips[1].packing_fraction() - (0.5 * PI - cap)).abs() < 1e-15);
        assert!((strips[3].solid - cap).abs() < 1e-15);
    }

    #[test]
    fn a_strip_is_as_wide_as_its_container() {
        let corners = [(0.0, 0.0), (4.0, 0.0), (2.0, 4.0)].map(|(x, y)| Vector::new(x, y));
        let triangle = Container::polygon(&corners);
        let strips = strips(&discs(&[[2.0, 1.0, 1.0]]), &triangle, 2);
        // 4 wide at the floor, 3 at height 1, 2 at height 2.
        assert_eq!([strips[0].area, strips[1].area], [3.5, 2.5]);
    }

    #[test]
    fn the_inside_of_a_lattice_is_as_dense_as_the_lattice() {
        // 40 × 40 unit discs in a square arrangement: π/4 in whole cells.
        let rows = (0..40).flat_map(|j| (0..40).map(move |i| (i, j)));
        let lattice: Vec<[f64; 3]> = rows
            .map(|(i, j)| [1.0 + 2.0 * f64::from(i), 1.0 + 2.0 * f64::from(j), 1.0])
            .collect();
        let fraction = |height| inner_packing_fraction(&discs(&lattice), &box_of(80.0, height));
        // Three radii from the sides, the floor and the top, whether the box ends there or above.
        let corners = [3.0, 77.0].map(|at| Vector::new(at, at));
        let exact = packing_fraction(&discs(&lattice), corners[0], corners[1]);
        assert!((fraction(80.0).unwrap() - exact).abs() < 1e-13);
        assert!((fraction(800.0).unwrap() - exact).abs() < 1e-13);
        assert_eq!(
            inner_packing_fraction(&discs(&[[1.0, 1.0, 1.0]]), &box_of(2.0, 2.0)),
            None
        );
    }

    #[test]
    fn the_surface_is_found_where_the_container_is_open() {
        // Two columns of a box, a tower in one of them; and under the flanks of a triangle there is no surface.
        let tower = discs(&[[1.0, 1.0, 1.0], [1.0, 3.0, 1.0], [7.0, 1.0, 1.0]]);
        let surface = |container: &Container| lowest_surface(&tower, &container.into(), 1.0);
        assert_eq!(surface(&box_of(8.0, 9.0)), 2.0);
        let corners = [(0.0, 0.0), (8.0, 0.0), (0.0, 4.5)].map(|(x, y)| Vector::new(x, y));
        assert_eq!(surface(&Container::polygon(&corners)), 4.0);
    }

    #[test]
    fn quantiles_are_diameters_of_grains() {
        // Masses 1, 4, 9, 16 of 30.
        let four = discs(&[
            [0.0, 0.0, 2.0],
            [9.0, 0.0, 0.5],
            [3.0, 9.0, 1.5],
            [9.0, 9.0, 1.0],
        ]);
        let shares = [1.0 / 30.0, 0.25, 0.5, 1.0];
        assert_eq!(
            quantile_diameters(&four, &shares, Mass::Disc),
            [1.0, 3.0, 4.0]
        );
        let equal = discs(&[[0.0, 0.0, 1.0], [3.0, 0.0, 1.0]]);
        assert_eq!(quantile_diameters(&equal, &shares, Mass::Disc), [2.0]);
    }

    #[test]
    fn the_realised_curve_counts_mass() {
        let three = discs(&[[0.0, 0.0, 1.0], [3.0, 0.0, 1.0], [9.0, 0.0, 2.0]]);
        // Masses 1, 1, 4 of 6 (discs) and 1, 1, 8 of 10 (spheres).
        let disc = sieve_curve(&three, &[1.0, 2.0, 4.0], Mass::Disc);
        assert_eq!(disc, [0.0, 2.0 / 6.0, 1.0]);
        let sphere = sieve_curve(&three, &[1.0, 2.0, 4.0], Mass::Sphere);
        assert_eq!(sphere, [0.0, 0.2, 1.0]);
    }
}
