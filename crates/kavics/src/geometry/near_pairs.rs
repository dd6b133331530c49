//! Near pairs of discs: cell grids, one for each two octaves of the radius, so that unequal discs cost little more than
//! equal ones.

use std::ops::Range;

use rayon::prelude::*;

use crate::geometry::Vector;

/// Discs that one task looks at; fixed, so that the result does not depend on the number of threads.
const DISCS_A_TASK: usize = 8192;

/// Octaves of the radius in one level.
const OCTAVES: u64 = 2;

/// A disc and its number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Centre, `[length]`.
    pub centre: Vector,
    /// Radius, `[length]`.
    pub radius: f64,
    /// Its place in the slices that the grid was made of.
    pub index: u32,
}

/// Two discs whose surfaces are near each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearPair {
    /// The disc with the lower number.
    pub first: u32,
    /// The other.
    pub second: u32,
    /// Distance of the surfaces; negative: overlap, `[length]`.
    pub gap: f64,
}

/// Discs of similar radii, sorted by square cells; a row of cells is one contiguous range of discs.
#[derive(Clone, Debug)]
pub(super) struct Level {
    origin: Vector,
    cells_a_length: f64,
    columns: usize,
    rows: usize,
    start: Vec<u32>,
    discs: Vec<Disc>,
    pub(super) largest_radius: f64,
}

impl Level {
    /// Counting sort by cells, stable.
    fn new(discs: &[Disc]) -> Self {
        let mut level = Self::cells(discs);
        let mut start = vec![0_u32; level.columns * level.rows + 1];
        for disc in discs {
            start[level.cell(disc) + 1] += 1;
        }
        for c in 1..start.len() {
            start[c] += start[c - 1];
        }
        let none = Disc {
            centre: Vector::default(),
            radius: 0.0,
            index: 0,
        };
        let mut sorted = vec![none; discs.len()];
        for disc in discs {
            // Starts move to the ends, which are the starts of the next cells.
            let place = &mut start[level.cell(disc)];
            sorted[*place as usize] = *disc;
            *place += 1;
        }
        start.rotate_right(1);
        start[0] = 0;
        level.start = start;
        level.discs = sorted;
        level
    }

    /// Cells of at least the largest diameter, not more than two a disc; yet without discs.
    fn cells(discs: &[Disc]) -> Self {
        let (low, high) = extent(discs.iter().map(|d| d.centre));
        let (width, height) = (high.x - low.x, high.y - low.y);
        let largest_radius = discs.iter().fold(0.0, |m: f64, d| m.max(d.radius));
        let cells = 2.0 * discs.len() as f64;
        // A little more than a diameter, so that what nearly touches lies in neighbouring cells.
        let cell = (2.05 * largest_radius)
            .max((width * height / cells).sqrt())
            .max(width.max(height) / cells);
        let cell = if cell > 0.0 { cell } else { 1.0 };
        Self {
            origin: low,
            cells_a_length: 1.0 / cell,
            columns: (width / cell) as usize + 1,
            rows: (height / cell) as usize + 1,
            start: Vec::new(),
            discs: Vec::new(),
            largest_radius,
        }
    }

    fn cell(&self, disc: &Disc) -> usize {
        self.row(disc.centre.y) * self.columns + self.column(disc.centre.x)
    }

    fn column(&self, x: f64) -> usize {
        (((x - self.origin.x) * self.cells_a_length).max(0.0) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.origin.y) * self.cells_a_length).max(0.0) as usize).min(self.rows - 1)
    }

    /// The discs with their centre in a square, and some around it, row by row.
    pub(super) fn around(&self, centre: Vector, distance: f64) -> impl Iterator<Item = &[Disc]> {
        let columns = (
            self.column(centre.x - distance),
            self.column(centre.x + distance),
        );
        (self.row(centre.y - distance)..=self.row(centre.y + distance)).map(move |row| {
            let first = row * self.columns;
            let from = self.start[first + columns.0] as usize;
            let to = self.start[first + columns.1 + 1] as usize;
            &self.discs[from..to]
        })
    }
}

/// Cell grids of discs, one for each two octaves of the radius.
#[derive(Clone, Debug)]
pub struct Grid {
    pub(super) discs: Vec<Disc>,
    pub(super) levels: Vec<Level>,
}

impl Grid {
    /// The grid of the discs with these centres and radii; O(N).
    pub fn new(centres: &[Vector], radii: &[f64]) -> Self {
        let disc = |(index, (&centre, &radius))| Disc {
            centre,
            radius,
            index: index as u32,
        };
        Self::of_discs(centres.iter().zip(radii).enumerate().map(disc).collect())
    }

    /// The grid of these discs, each with its place among them as number; O(N).
    pub fn of_discs(discs: Vec<Disc>) -> Self {
        let smallest = discs.iter().map(|disc| octave(disc.radius)).min();
        let size = |disc: &Disc| ((octave(disc.radius) - smallest.unwrap_or(0)) / OCTAVES) as usize;
        let mut counts = vec![0_usize; 1 << 12];
        for disc in &discs {
            counts[size(disc)] += 1;
        }
        let one_size = counts[0] == discs.len();
        let levels = if one_size && !discs.is_empty() {
            vec![Level::new(&discs)]
        } else {
            let mut sizes: Vec<_> = counts.iter().map(|&n| Vec::with_capacity(n)).collect();
            for disc in &discs {
                sizes[size(disc)].push(*disc);
            }
            sizes.retain(|discs| !discs.is_empty());
            sizes.par_iter().map(|discs| Level::new(discs)).collect()
        };
        Self { discs, levels }
    }

    /// All pairs whose gap is at most `reach`, by (first, second); O(N) for discs that hardly overlap, and the sort.
    pub fn near_pairs(&self, reach: f64) -> Vec<NearPair> {
        let mut pairs = self.near_pairs_by_cells(reach);
        pairs.par_sort_unstable_by_key(|pair| (pair.first, pair.second));
        pairs
    }

    /// The same pairs level by level in the order of their cells.
    pub fn near_pairs_by_cells(&self, reach: f64) -> Vec<NearPair> {
        let tasks: Vec<(usize, Range<usize>)> = self.tasks().collect();
        let of_task = |(level, rows): (usize, Range<usize>)| {
            let discs = self.levels[level].of_rows(&rows);
            let mut pairs = Vec::with_capacity(2 * discs.len() + 64);
            for row in rows {
                self.levels[level].near_pairs(row, reach, &mut pairs);
            }
            for coarser in &self.levels[level + 1..] {
                for disc in discs {
                    coarser.near_pairs_with(disc, reach, &mut pairs);
                }
            }
            pairs
        };
        let found: Vec<Vec<NearPair>> = tasks.into_par_iter().map(of_task).collect();
        found.concat()
    }

    /// The levels, in stretches of rows of cells with about the same number of discs.
    fn tasks(&self) -> impl Iterator<Item = (usize, Range<usize>)> {
        self.levels.iter().enumerate().flat_map(|(k, level)| {
            let rows_a_task = (level.rows * DISCS_A_TASK).div_ceil(level.discs.len().max(1));
            let firsts = (0..level.rows).step_by(rows_a_task.max(1));
            firsts.map(move |row| (k, row..(row + rows_a_task).min(level.rows)))
        })
    }
}

impl Level {
    /// The discs of some rows of cells.
    fn of_rows(&self, rows: &Range<usize>) -> &[Disc] {
        let [from, to] = [rows.start, rows.end].map(|row| self.start[row * self.columns] as usize);
        &self.discs[from..to]
    }

    /// The discs of the cells from `first` to `last` of a row.
    fn of_cells(&self, row: usize, first: usize, last: usize) -> Range<usize> {
        let cell = row * self.columns;
        self.start[cell + first] as usize..self.start[cell + last + 1] as usize
    }

    /// The pairs of the discs in a row of cells with those after them: in the row, and in the rows above.
    fn near_pairs(&self, row: usize, reach: f64, pairs: &mut Vec<NearPair>) {
        let farthest = (2.0 * self.largest_radius + reach).max(0.0) * (1.0 + 1e-9);
        let rings = (farthest * self.cells_a_length) as usize + 1;
        let last_row = row.saturating_add(rings).min(self.rows - 1);
        for column in 0..self.columns {
            let own = self.of_cells(row, column, column);
            if own.is_empty() {
                continue;
            }
            let first = column.saturating_sub(rings);
            let last = column.saturating_add(rings).min(self.columns - 1);
            let ahead = self.of_cells(row, column, last).end;
            for k in own {
                let disc = &self.discs[k];
                add_near(disc, &self.discs[k + 1..ahead], reach, pairs);
                for above in row + 1..=last_row {
                    let others = self.of_cells(above, first, last);
                    add_near(disc, &self.discs[others], reach, pairs);
                }
            }
        }
    }

    /// The pairs of one disc with those of this level.
    fn near_pairs_with(&self, disc: &Disc, reach: f64, pairs: &mut Vec<NearPair>) {
        let distance = (disc.radius + self.largest_radius + reach).max(0.0);
        for row in self.around(disc.centre, distance * (1.0 + 1e-9)) {
            add_near(disc, row, reach, pairs);
        }
    }
}

fn add_near(disc: &Disc, others: &[Disc], reach: f64, pairs: &mut Vec<NearPair>) {
    pairs.extend(
        others
            .iter()
            .filter_map(|other| near_pair(disc, other, reach)),
    );
}

/// The pair of two discs, if their gap is at most `reach`.
fn near_pair(disc: &Disc, other: &Disc, reach: f64) -> Option<NearPair> {
    let squared = (other.centre - disc.centre).length_squared();
    let radii = disc.radius + other.radius;
    let bound = radii + reach;
    if squared > bound * bound * (1.0 + 1e-9) {
        return None;
    }
    let gap = squared.sqrt() - radii;
    (gap <= reach).then(|| NearPair {
        first: disc.index.min(other.index),
        second: disc.index.max(other.index),
        gap,
    })
}

/// The binary exponent of a radius.
fn octave(radius: f64) -> u64 {
    radius.abs().to_bits() >> 52
}

/// The numbers of points along rows of cells with about two points each: neighbours come near each other.
pub fn spatial_order<'a>(points: impl ExactSizeIterator<Item = &'a Vector> + Clone) -> Vec<u32> {
    let (low, high) = extent(points.clone().copied());
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
    let cell = |p: &Vector| along(p.y - low.y, height) * columns + along(p.x - low.x, width);
    let mut next = vec![0_u32; columns * rows + 1];
    for point in points.clone() {
        next[cell(point) + 1] += 1;
    }
    for c in 1..next.len() {
        next[c] += next[c - 1];
    }
    let mut order = vec![0; points.len()];
    for (number, point) in (0..).zip(points) {
        let place = &mut next[cell(point)];
        order[*place as usize] = number;
        *place += 1;
    }
    order
}

/// The lowest and highest coordinates of the finite points.
pub(super) fn extent(points: impl Iterator<Item = Vector>) -> (Vector, Vector) {
    let mut low = Vector::new(f64::INFINITY, f64::INFINITY);
    let mut high = -low;
    for p in points.filter(|p| p.x.is_finite() && p.y.is_finite()) {
        low = Vector::new(low.x.min(p.x), low.y.min(p.y));
        high = Vector::new(high.x.max(p.x), high.y.max(p.y));
    }
    if low.x <= high.x {
        (low, high)
    } else {
        (Vector::default(), Vector::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs(discs: &[(f64, f64, f64)], reach: f64) -> Vec<(u32, u32)> {
        let centres: Vec<_> = discs.iter().map(|d| Vector::new(d.0, d.1)).collect();
        let radii: Vec<_> = discs.iter().map(|d| d.2).collect();
        let pairs = Grid::new(&centres, &radii).near_pairs(reach);
        pairs.iter().map(|p| (p.first, p.second)).collect()
    }

    #[test]
    fn discs_at_the_reach_are_near() {
        let row = [(0.0, 0.0, 1.0), (5.0, 0.0, 2.0), (9.0, 0.0, 1.0)];
        assert_eq!(pairs(&row, 2.0), [(0, 1), (1, 2)]);
        assert_eq!(pairs(&row, 1.9), [(1, 2)]);
        assert_eq!(pairs(&row, 100.0), [(0, 1), (0, 2), (1, 2)]);
    }

    #[test]
    fn a_negative_reach_finds_overlaps_alone() {
        let row = [(0.0, 0.0, 1.0), (1.5, 0.0, 1.0), (3.5, 0.0, 1.0)];
        assert_eq!(pairs(&row, -0.25), [(0, 1)]);
    }

    #[test]
    fn a_large_disc_meets_every_small_one_around_it() {
        let mut discs = vec![(0.0, 0.0, 100.0)];
        for k in 0..600 {
            let angle = std::f64::consts::TAU * f64::from(k) / 600.0;
            discs.push((101.0 * angle.cos(), 101.0 * angle.sin(), 1.0));
        }
        let around = pairs(&discs, 1e-9);
        assert_eq!(around.iter().filter(|p| p.0 == 0).count(), 600);
    }

    #[test]
    fn the_spatial_order_goes_along_rows() {
        let points: Vec<_> = (0..64)
            .map(|k| Vector::new(f64::from(k / 8), f64::from(k % 8)))
            .collect();
        let order = spatial_order(points.iter());
        let rows: Vec<f64> = order.iter().map(|&k| points[k as usize].y).collect();
        assert!(rows.windows(2).all(|pair| pair[1] > pair[0] - 1.5));
        assert_eq!(
            spatial_order([Vector::new(f64::NAN, 1.0), Vector::new(3.0, f64::INFINITY)].iter())
                .len(),
            2
        );
        assert!(spatial_order([].iter()).is_empty());
    }

    #[test]
    fn odd_numbers_are_no_trouble() {
        let discs = [
            (f64::NAN, 0.0, 1.0),
            (1e300, -1e300, 0.0),
            (0.0, f64::INFINITY, 1e-320),
            (3.0, 3.0, 1.0),
            (3.0, 3.0, 1.0),
        ];
        assert_eq!(pairs(&discs, 0.0), [(3, 4)]);
        assert!(pairs(&[], 1.0).is_empty());
    }
}
