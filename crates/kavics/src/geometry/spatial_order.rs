//! Points in an order in which neighbours come near each other.

use rayon::prelude::*;

use crate::geometry::Vector;

/// The numbers of points along rows of cells with about two points each: neighbours come near each other.
pub fn spatial_order(points: &[Vector]) -> Vec<u32> {
    let (low, high) = extent(points.iter().copied());
    let (width, height) = (high.x - low.x, high.y - low.y);
    let cells = 0.5 * points.len() as f64;
    let side = (width * height / cells)
        .sqrt()
        .max(width.max(height) / cells);
    let scale = if side > 0.0 { 1.0 / side } else { 0.0 };
    let along = |offset: f64, extent: f64| (offset.max(0.0) * scale).min(extent * scale) as usize;
    let columns = along(width, width) + 1;
    let rows = along(height, height) + 1;
    // Infinite coordinates are beyond every cell, NaN is before.
    let cell =
        |p: &Vector| (along(p.y - low.y, height) * columns + along(p.x - low.x, width)) as u32;
    let cell_of_point: Vec<u32> = points.par_iter().map(cell).collect();
    by_cells(&cell_of_point, columns * rows).1
}

/// The lowest and highest coordinates of the finite points.
pub(super) fn extent(points: impl Iterator<Item = Vector>) -> (Vector, Vector) {
    let mut extent = Extent::default();
    points.for_each(|point| extent.add(&Extent::of(point)));
    extent.ends()
}

/// Lowest and highest coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    low: Vector,
    high: Vector,
}

impl Default for Extent {
    fn default() -> Self {
        let most = Vector::new(f64::INFINITY, f64::INFINITY);
        Self {
            low: most,
            high: -most,
        }
    }
}

impl Extent {
    /// Of one point, if it is finite.
    pub(super) fn of(point: Vector) -> Self {
        if point.x.is_finite() && point.y.is_finite() {
            Self {
                low: point,
                high: point,
            }
        } else {
            Self::default()
        }
    }

    pub(super) fn add(&mut self, other: &Self) {
        let (low, high) = (other.low, other.high);
        self.low = Vector::new(self.low.x.min(low.x), self.low.y.min(low.y));
        self.high = Vector::new(self.high.x.max(high.x), self.high.y.max(high.y));
    }

    /// The origin twice, where there was no point.
    pub(super) fn ends(&self) -> (Vector, Vector) {
        if self.low.x <= self.high.x {
            (self.low, self.high)
        } else {
            (Vector::default(), Vector::default())
        }
    }
}

/// Counting sort, stable: where each cell starts, and the numbers of what lies in the cells one after the other.
pub(super) fn by_cells(cell_of: &[u32], cells: usize) -> (Vec<u32>, Vec<u32>) {
    let mut start = vec![0_u32; cells + 1];
    for &cell in cell_of {
        start[cell as usize + 1] += 1;
    }
    for cell in 0..cells {
        start[cell + 1] += start[cell];
    }
    let mut order = vec![0; cell_of.len()];
    for (number, &cell) in (0..).zip(cell_of) {
        // Starts move to the ends, which are the starts of the next cells.
        let place = &mut start[cell as usize];
        order[*place as usize] = number;
        *place += 1;
    }
    start.rotate_right(1);
    start[0] = 0;
    (start, order)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spatial_order_goes_along_rows() {
        let points: Vec<_> = (0..64)
            .map(|k| Vector::new(f64::from(k / 8), f64::from(k % 8)))
            .collect();
        let order = spatial_order(&points);
        let rows: Vec<f64> = order.iter().map(|&k| points[k as usize].y).collect();
        assert!(rows.windows(2).all(|pair| pair[1] > pair[0] - 1.5));
        let odd = [Vector::new(f64::NAN, 1.0), Vector::new(3.0, f64::INFINITY)];
        assert_eq!(spatial_order(&odd).len(), 2);
        assert!(spatial_order(&[]).is_empty());
    }
}
