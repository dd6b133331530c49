//! Near pairs of discs: cell grids, one for each two octaves of the radius, so that unequal discs cost little more than
//! equal ones.

use std::ops::Range;

use rayon::prelude::*;

use crate::geometry::Vector;
use crate::geometry::spatial_order::{Extent, by_cells};

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

/// Square cells for discs of similar radii.
#[derive(Clone, Copy, Debug)]
pub(super) struct Level {
    origin: Vector,
    cells_a_length: f64,
    columns: usize,
    rows: usize,
    /// Its first cell among those of all levels.
    first_cell: usize,
    pub(super) largest_radius: f64,
}

impl Level {
    /// Cells of at least the largest diameter, not more than two a disc.
    fn new(span: &Span, first_cell: usize) -> Self {
        let (low, high) = span.extent.ends();
        let (width, height) = (high.x - low.x, high.y - low.y);
        let cells = 2.0 * span.discs as f64;
        // A little more than a diameter, so that what nearly touches lies in neighbouring cells.
        let cell = (2.05 * span.largest_radius)
            .max((width * height / cells).sqrt())
            .max(width.max(height) / cells);
        let cell = if cell > 0.0 { cell } else { 1.0 };
        Self {
            origin: low,
            cells_a_length: 1.0 / cell,
            columns: (width / cell) as usize + 1,
            rows: (height / cell) as usize + 1,
            first_cell,
            largest_radius: span.largest_radius,
        }
    }

    /// Among those of all levels.
    fn cell(&self, centre: Vector) -> usize {
        self.first_cell + self.row(centre.y) * self.columns + self.column(centre.x)
    }

    /// Whether all its cells are in a square.
    pub(super) fn is_all_within(&self, centre: Vector, distance: f64) -> bool {
        let (low, high) = (
            centre - Vector::new(distance, distance),
            centre + Vector::new(distance, distance),
        );
        let ends = [
            self.column(low.x),
            self.row(low.y),
            self.column(high.x),
            self.row(high.y),
        ];
        ends == [0, 0, self.columns - 1, self.rows - 1]
    }

    fn column(&self, x: f64) -> usize {
        (((x - self.origin.x) * self.cells_a_length).max(0.0) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.origin.y) * self.cells_a_length).max(0.0) as usize).min(self.rows - 1)
    }
}

/// How far the discs of one level reach.
#[derive(Clone, Copy, Debug, Default)]
struct Span {
    extent: Extent,
    discs: usize,
    largest_radius: f64,
}

impl Span {
    fn add(&mut self, other: &Self) {
        self.extent.add(&other.extent);
        self.discs += other.discs;
        self.largest_radius = self.largest_radius.max(other.largest_radius);
    }
}

/// Discs sorted by cells, one grid of cells for each two octaves of the radius; a row of cells is one contiguous
/// range of discs.
#[derive(Clone, Debug)]
pub struct Grid {
    pub(super) discs: Vec<Disc>,
    pub(super) levels: Vec<Level>,
    /// The first disc of each cell, level by level.
    start: Vec<u32>,
}

impl Grid {
    /// The grid of the discs with these centres and radii; O(N).
    pub fn new(centres: &[Vector], radii: &[f64]) -> Self {
        let disc = |index: u32| Disc {
            centre: centres[index as usize],
            radius: radii[index as usize],
            index,
        };
        Self::of(centres.len().min(radii.len()), disc).0
    }

    /// The grid of `count` discs, and which of them is at each of its places, so that neighbours come near each other;
    /// O(N).
    pub fn of(count: usize, disc: impl Fn(u32) -> Disc + Sync) -> (Self, Vec<u32>) {
        let all = 0..count as u32;
        let smallest = all.clone().into_par_iter().map(|k| octave(disc(k).radius));
        let smallest = smallest.min().unwrap_or(0);
        let size = |disc: &Disc| ((octave(disc.radius) - smallest) / OCTAVES) as usize;
        let spans = spans(&all, |k| {
            let disc = disc(k);
            (size(&disc), disc)
        });
        let mut levels: Vec<Level> = Vec::new();
        let mut level_of_size = vec![0; spans.len()];
        let mut cells = 0;
        for (size, span) in spans.iter().enumerate().filter(|(_, span)| span.discs > 0) {
            level_of_size[size] = levels.len();
            levels.push(Level::new(span, cells));
            cells += levels[levels.len() - 1].columns * levels[levels.len() - 1].rows;
        }
        let cell = |k| {
            let disc = disc(k);
            levels[level_of_size[size(&disc)]].cell(disc.centre) as u32
        };
        let cell_of_disc: Vec<u32> = all.into_par_iter().map(cell).collect();
        let (start, order) = by_cells(&cell_of_disc, cells);
        drop(cell_of_disc);
        let discs = order.par_iter().map(|&k| disc(k)).collect();
        let grid = Self {
            discs,
            levels,
            start,
        };
        (grid, order)
    }

    /// The same grid with discs that are known by their places in it.
    #[must_use]
    pub fn known_by_places(mut self) -> Self {
        let places = self.discs.par_iter_mut().enumerate();
        places.for_each(|(place, disc)| disc.index = place as u32);
        self
    }

    /// All pairs whose gap is at most `reach`, by (first, second); O(N) for discs that hardly overlap, and the sort.
    pub fn near_pairs(&self, reach: f64) -> Vec<NearPair> {
        let pair = |pairs: &mut Vec<NearPair>, disc: &Disc, other: &Disc, gap: f64| {
            pairs.push(NearPair {
                first: disc.index.min(other.index),
                second: disc.index.max(other.index),
                gap,
            });
        };
        let mut pairs = self.near(reach, pair).concat();
        pairs.par_sort_unstable_by_key(|pair| (pair.first, pair.second));
        pairs
    }

    /// What `visit` makes of the pairs whose gap is at most `reach`, task by task; of the two discs, the one at the
    /// lower place comes first, and rises.
    pub(super) fn near<T: Default + Send>(
        &self,
        reach: f64,
        visit: impl Fn(&mut T, &Disc, &Disc, f64) + Sync,
    ) -> Vec<T> {
        let of_task = |(level, rows): (usize, Range<usize>)| {
            let mut found = T::default();
            for row in rows {
                let visit = |disc: &Disc, other: &Disc, gap| visit(&mut found, disc, other, gap);
                self.near_of_row(level, row, reach, visit);
            }
            found
        };
        let tasks: Vec<(usize, Range<usize>)> = self.tasks().collect();
        tasks.into_par_iter().map(of_task).collect()
    }

    /// The levels, in stretches of rows of cells with about the same number of discs.
    fn tasks(&self) -> impl Iterator<Item = (usize, Range<usize>)> {
        self.levels.iter().enumerate().flat_map(|(k, level)| {
            let discs = self.of_cells(level, 0, 0, level.columns * level.rows - 1);
            let rows_a_task = (level.rows * DISCS_A_TASK).div_ceil(discs.len().max(1));
            let firsts = (0..level.rows).step_by(rows_a_task.max(1));
            firsts.map(move |row| (k, row..(row + rows_a_task).min(level.rows)))
        })
    }

    /// The places of the discs in some cells of a row.
    fn of_cells(&self, level: &Level, row: usize, first: usize, last: usize) -> Range<usize> {
        let row = level.first_cell + row * level.columns;
        self.start[row + first] as usize..self.start[row + last + 1] as usize
    }

    /// The pairs of the discs in a row of cells with those after them: in the row, in the rows above, and in the
    /// coarser levels.
    fn near_of_row(
        &self,
        level: usize,
        row: usize,
        reach: f64,
        mut visit: impl FnMut(&Disc, &Disc, f64),
    ) {
        let (own_level, coarser) = (&self.levels[level], &self.levels[level + 1..]);
        let farthest = (2.0 * own_level.largest_radius + reach).max(0.0) * (1.0 + 1e-9);
        let rings = ((farthest * own_level.cells_a_length) as usize).saturating_add(1);
        let last_row = row.saturating_add(rings).min(own_level.rows - 1);
        for column in 0..own_level.columns {
            let first = column.saturating_sub(rings);
            let last = column.saturating_add(rings).min(own_level.columns - 1);
            let ahead = self.of_cells(own_level, row, column, last).end;
            for k in self.of_cells(own_level, row, column, column) {
                let disc = &self.discs[k];
                each_near(disc, &self.discs[k + 1..ahead], reach, &mut visit);
                for above in row + 1..=last_row {
                    let others = self.of_cells(own_level, above, first, last);
                    each_near(disc, &self.discs[others], reach, &mut visit);
                }
                for level in coarser {
                    let distance = (disc.radius + level.largest_radius + reach).max(0.0);
                    for others in self.around(level, disc.centre, distance * (1.0 + 1e-9)) {
                        each_near(disc, others, reach, &mut visit);
                    }
                }
            }
        }
    }

    /// The discs of a level with their centre in a square, and some around it, row by row.
    pub(super) fn around(
        &self,
        level: &Level,
        centre: Vector,
        distance: f64,
    ) -> impl Iterator<Item = &[Disc]> {
        let first = level.column(centre.x - distance);
        let last = level.column(centre.x + distance);
        let rows = level.row(centre.y - distance)..=level.row(centre.y + distance);
        rows.map(move |row| &self.discs[self.of_cells(level, row, first, last)])
    }
}

/// How far the discs of each size reach.
fn spans(all: &Range<u32>, disc: impl Fn(u32) -> (usize, Disc) + Sync) -> Vec<Span> {
    let of_task = |first: u32| {
        let mut spans = Vec::new();
        for k in first..(first + DISCS_A_TASK as u32).min(all.end) {
            let (size, disc) = disc(k);
            if size >= spans.len() {
                spans.resize(size + 1, Span::default());
            }
            spans[size].add(&Span {
                extent: Extent::of(disc.centre),
                discs: 1,
                largest_radius: disc.radius,
            });
        }
        spans
    };
    let firsts = all.clone().into_par_iter().step_by(DISCS_A_TASK);
    firsts.map(of_task).reduce(Vec::new, |mut one, other| {
        one.resize(one.len().max(other.len()), Span::default());
        for (span, other) in one.iter_mut().zip(&other) {
            span.add(other);
        }
        one
    })
}

fn each_near(disc: &Disc, others: &[Disc], reach: f64, visit: &mut impl FnMut(&Disc, &Disc, f64)) {
    for other in others {
        if let Some(gap) = gap_within(disc, other, reach) {
            visit(disc, other, gap);
        }
    }
}

/// The gap between two discs, if it is at most `reach`.
fn gap_within(disc: &Disc, other: &Disc, reach: f64) -> Option<f64> {
    let squared = (other.centre - disc.centre).length_squared();
    let radii = disc.radius + other.radius;
    let bound = radii + reach;
    if squared > bound * bound * (1.0 + 1e-9) {
        return None;
    }
    let gap = squared.sqrt() - radii;
    (gap <= reach).then_some(gap)
}

/// The binary exponent of a radius.
fn octave(radius: f64) -> u64 {
    radius.abs().to_bits() >> 52
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
    fn a_reach_beyond_all_counts_meets_all() {
        let row = [(0.0, 0.0, 1e-15), (1.0, 0.0, 1e-15), (1.0, 1.0, 1e-15)];
        assert_eq!(pairs(&row, 1e30), [(0, 1), (0, 2), (1, 2)]);
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
