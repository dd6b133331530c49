//! Rows of equal height, and square cells along them.

use crate::geometry::Vector;

/// The rows of a drawing, from the bottom.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows {
    low: Vector,
    per_length: f64,
    columns: usize,
    /// How many rows.
    pub count: usize,
}

impl Rows {
    /// Rows as high as nodes are apart in the mean.
    pub fn new(centres: &[Vector]) -> Self {
        let mut low = Vector::new(f64::INFINITY, f64::INFINITY);
        let mut high = -low;
        for c in centres {
            low = Vector::new(low.x.min(c.x), low.y.min(c.y));
            high = Vector::new(high.x.max(c.x), high.y.max(c.y));
        }
        let nodes = centres.len() as f64;
        let (width, height) = (high.x - low.x, high.y - low.y);
        let row = (width * height / nodes)
            .sqrt()
            .max(width.max(height) / nodes);
        let per_length = if row > 0.0 { 1.0 / row } else { 0.0 };
        Self {
            low,
            per_length,
            columns: (width * per_length) as usize + 1,
            count: (height * per_length) as usize + 1,
        }
    }

    /// The row of a height.
    pub fn row(&self, y: f64) -> usize {
        (((y - self.low.y) * self.per_length).max(0.0) as usize).min(self.count - 1)
    }

    fn cell(&self, point: Vector) -> usize {
        let column = ((point.x - self.low.x) * self.per_length).max(0.0) as usize;
        self.row(point.y) * self.columns + column.min(self.columns - 1)
    }
}

/// The numbers of the points along rows from the bottom, cell by cell from the left: near points get near places.
pub(super) fn along_rows(points: &[Vector]) -> Vec<u32> {
    if points.is_empty() {
        return Vec::new();
    }
    let rows = Rows::new(points);
    let mut place = vec![0_u32; rows.columns * rows.count + 1];
    for &point in points {
        place[rows.cell(point) + 1] += 1;
    }
    for cell in 1..place.len() {
        place[cell] += place[cell - 1];
    }
    let mut sorted = vec![0; points.len()];
    for (number, &point) in points.iter().enumerate() {
        let next = &mut place[rows.cell(point)];
        sorted[*next as usize] = number as u32;
        *next += 1;
    }
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_lattice_are_taken_row_by_row() {
        let points: Vec<Vector> = [(2, 1), (0, 0), (1, 1), (1, 0), (2, 0), (0, 1)]
            .map(|(x, y)| Vector::new(f64::from(x), f64::from(y)))
            .to_vec();
        assert_eq!(along_rows(&points), [1, 3, 4, 5, 2, 0]);
    }

    #[test]
    fn every_point_has_a_place_wherever_it_lies() {
        let odd = [(0.0, 0.0), (1e9, 0.0), (1e9, 1e-9), (5.0, 0.0), (5.0, 0.0)];
        let odd = odd.map(|(x, y)| Vector::new(x, y));
        let mut sorted = along_rows(&odd);
        sorted.sort_unstable();
        assert_eq!(sorted, [0, 1, 2, 3, 4]);
        assert_eq!(along_rows(&odd[..1]), [0]);
        assert!(along_rows(&[]).is_empty());
    }
}
