//! Rows of equal height.

use crate::geometry::Vector;

/// The rows of a drawing, from the bottom.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows {
    low: Vector,
    per_length: f64,
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
            count: (height * per_length) as usize + 1,
        }
    }

    /// The row of a height.
    pub fn row(&self, y: f64) -> usize {
        (((y - self.low.y) * self.per_length).max(0.0) as usize).min(self.count - 1)
    }
}
