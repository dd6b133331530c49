//! The surface of a growing pack, made to find the grains near a place from above.
//!
//! Grains of similar size share a level; a level is a row of columns, a column a stack of the grains whose centres lie
//! in it, in the order of their arrival. Every grain in a stack knows the highest centre among itself and those below
//! it, so a search from the top of the stack ends as soon as nothing below can matter: the buried pack is never touched.

use crate::assembly::Grain;
use crate::ids::{GrainId, Id};

/// A grain at rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Resting {
    pub(super) grain: Grain,
    pub(super) id: GrainId,
    /// Highest centre in its stack up to here.
    highest: f64,
}

/// Grains of radii up to `largest`, by columns of equal width.
struct Level {
    largest: f64,
    left: f64,
    column_width: f64,
    /// Highest centre of each column, kept apart so that most columns are dismissed from here.
    highest: Vec<f64>,
    columns: Vec<Vec<Resting>>,
}

/// All grains at rest.
pub(super) struct Skyline {
    /// The largest grains first.
    levels: Vec<Level>,
    count: usize,
}

/// Ratio of the largest radii of neighbouring levels.
const LEVEL_RATIO: f64 = 4.0;
/// Width of a column over the largest radius of its level.
const COLUMN_WIDTH: f64 = 1.75;

impl Skyline {
    /// An empty container between two abscissas, for `count` grains with radii from `smallest` to `largest`.
    pub(super) fn new(extent: [f64; 2], smallest: f64, largest: f64, count: usize) -> Self {
        let sizes = std::iter::successors(Some(largest), |size| Some(size / LEVEL_RATIO));
        Self {
            levels: sizes
                .take_while(|&size| size >= smallest)
                .map(|size| Level::new(extent, size, count))
                .collect(),
            count: 0,
        }
    }

    /// Adds a grain; its id is the number of grains before it.
    pub(super) fn push(&mut self, grain: Grain) {
        let id = GrainId::from_index(self.count);
        self.count += 1;
        let level = self
            .levels
            .iter_mut()
            .rev()
            .find(|level| grain.radius <= level.largest)
            .expect("radii are within the range given at the start");
        level.push(grain, id);
    }

    /// Shows `look` every grain that a grain of `radius` could touch with its centre between the abscissas
    /// `from` and `to` and not below `bound`; `look` answers the bound from there on, never a lower one.
    pub(super) fn search(
        &self,
        [from, to]: [f64; 2],
        radius: f64,
        mut bound: f64,
        mut look: impl FnMut(&Resting) -> f64,
    ) {
        for level in &self.levels {
            bound = level.search([from, to], radius, bound, &mut look);
        }
    }
}

impl Level {
    fn new([left, right]: [f64; 2], largest: f64, count: usize) -> Self {
        let width = right - left;
        // A box that is wide beside its grains needs no more columns than grains.
        let most = 4.0 * count as f64 + 16.0;
        let columns = (width / (COLUMN_WIDTH * largest)).ceil().clamp(1.0, most);
        Self {
            largest,
            left,
            column_width: width / columns,
            highest: vec![f64::NEG_INFINITY; columns as usize],
            columns: vec![Vec::new(); columns as usize],
        }
    }

    fn column(&self, x: f64) -> usize {
        // The cast saturates.
        (((x - self.left) / self.column_width) as usize).min(self.columns.len() - 1)
    }

    fn push(&mut self, grain: Grain, id: GrainId) {
        let column = self.column(grain.centre.x);
        let highest = self.highest[column].max(grain.centre.y);
        self.highest[column] = highest;
        self.columns[column].push(Resting { grain, id, highest });
    }

    /// From the middle outwards, as the grains found first there raise the bound most.
    fn search(
        &self,
        [from, to]: [f64; 2],
        radius: f64,
        mut bound: f64,
        look: &mut impl FnMut(&Resting) -> f64,
    ) -> f64 {
        let reach = radius + self.largest;
        let first = self.column(from - reach);
        let middle = self.column(0.5 * (from + to));
        let last = self.column(to + reach);
        for column in (middle..=last).chain((first..middle).rev()) {
            if self.highest[column] + reach < bound {
                continue;
            }
            let gap = self.gap(column, [from, to]);
            let rise = (reach * reach - gap * gap).max(0.0).sqrt();
            for resting in self.columns[column].iter().rev() {
                if resting.highest + rise < bound {
                    break;
                }
                bound = look(resting);
            }
        }
        bound
    }

    /// Distance of a column from an interval of abscissas.
    fn gap(&self, column: usize, [from, to]: [f64; 2]) -> f64 {
        let left = self.left + column as f64 * self.column_width;
        (left - to).max(from - (left + self.column_width)).max(0.0)
    }
}
