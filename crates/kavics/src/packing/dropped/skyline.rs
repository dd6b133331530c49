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
    /// Highest centre in its stack up to here, rounded up.
    highest: f32,
}

/// Grains of radii up to `largest`, by columns of equal width.
struct Level {
    largest: f64,
    left: f64,
    column_width: f64,
    columns_a_length: f64,
    /// Highest centre of each column, kept apart so that most columns are dismissed from here.
    highest: Vec<f32>,
    columns: Vec<Vec<Resting>>,
}

/// All grains at rest.
pub(super) struct Skyline {
    /// The largest grains first.
    levels: Vec<Level>,
    /// The largest radius of each.
    sizes: Vec<f64>,
    count: usize,
}

/// Ratio of the largest radii of neighbouring levels.
const LEVEL_RATIO: f64 = 4.0;
/// Width of a column over the largest radius of its level.
const COLUMN_WIDTH: f64 = 1.75;

impl Skyline {
    /// An empty container between two abscissas, for grains of these radii.
    pub(super) fn new(extent: [f64; 2], radii: impl Iterator<Item = f64> + Clone) -> Self {
        let limits = [f64::INFINITY, 0.0];
        let [smallest, largest] = radii.clone().fold(limits, |[low, high], radius| {
            [low.min(radius), high.max(radius)]
        });
        let sizes = std::iter::successors(Some(largest), |size| Some(size / LEVEL_RATIO));
        let sizes: Vec<f64> = sizes.take_while(|&size| size >= smallest).collect();
        let mut counts = vec![0; sizes.len()];
        for radius in radii {
            counts[level_of(radius, &sizes)] += 1;
        }
        let levels = sizes.iter().zip(counts);
        Self {
            levels: levels
                .map(|(&size, count)| Level::new(extent, size, count))
                .collect(),
            sizes,
            count: 0,
        }
    }

    /// Adds a grain; its id is the number of grains before it.
    pub(super) fn push(&mut self, grain: Grain) {
        let id = GrainId::from_index(self.count);
        self.count += 1;
        let level = level_of(grain.radius, &self.sizes);
        self.levels[level].push(grain, id);
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

/// The finest level that a grain belongs to.
fn level_of(radius: f64, sizes: &[f64]) -> usize {
    let level = sizes.iter().rposition(|&size| radius <= size);
    level.expect("radii are those given at the start")
}

impl Level {
    fn new([left, right]: [f64; 2], largest: f64, count: usize) -> Self {
        let width = right - left;
        // A box that is wide beside its grains needs no more columns than grains.
        let most = 4.0 * count as f64 + 16.0;
        let columns = (width / (COLUMN_WIDTH * largest)).ceil().clamp(1.0, most);
        // Stacks that grow by doubling would be copied; a little more than the mean is enough for most.
        let expected = 1.125 * count as f64 / columns;
        Self {
            largest,
            left,
            column_width: width / columns,
            columns_a_length: columns / width,
            highest: vec![f32::NEG_INFINITY; columns as usize],
            columns: (0..columns as usize)
                .map(|_| Vec::with_capacity(expected as usize))
                .collect(),
        }
    }

    fn column(&self, x: f64) -> usize {
        // The cast saturates.
        (((x - self.left) * self.columns_a_length) as usize).min(self.columns.len() - 1)
    }

    fn push(&mut self, grain: Grain, id: GrainId) {
        let column = self.column(grain.centre.x);
        let highest = self.highest[column].max((grain.centre.y as f32).next_up());
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
            if f64::from(self.highest[column]) + reach < bound {
                continue;
            }
            let gap = self.gap(column, [from, to]);
            let rise = (reach * reach - gap * gap).max(0.0).sqrt();
            for resting in self.columns[column].iter().rev() {
                if f64::from(resting.highest) + rise < bound {
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
