//! Grains placed so far, by square cells: one layer of cells for each size range, so that unequal grains cost no more.

use crate::assembly::Grain;
use crate::geometry::Vector;

/// Ratio of the largest radii of neighbouring layers.
const LAYER_RATIO: f64 = 4.0;
/// Side of a cell over the largest radius of its layer.
const CELL_SIZE: f64 = 1.5;
/// No grain.
const END: u32 = u32::MAX;

/// Cells for grains of radii up to `largest`; a cell names its last grain, each grain the one before it.
struct Layer {
    largest: f64,
    origin: Vector,
    cells_a_length: f64,
    columns: usize,
    rows: usize,
    last: Vec<u32>,
}

/// A grain and the one placed before it in the same cell.
struct Placed {
    grain: Grain,
    before: u32,
}

/// The grains placed so far.
pub(super) struct Cells {
    placed: Vec<Placed>,
    /// The largest grains first.
    layers: Vec<Layer>,
    /// Overlap that is none, `[length]`.
    allowance: f64,
}

impl Cells {
    /// No grains yet, but room for those of the given radii between two corners.
    pub(super) fn new([low, high]: [Vector; 2], radii: &[f64], allowance: f64) -> Self {
        let (mut smallest, mut largest) = (f64::INFINITY, 0.0_f64);
        for &radius in radii {
            (smallest, largest) = (smallest.min(radius), largest.max(radius));
        }
        let sizes = std::iter::successors(Some(largest), |size| Some(size / LAYER_RATIO));
        let layer = |size: f64| {
            let held = |&&r: &&f64| r <= size && r > size / LAYER_RATIO;
            Layer::new([low, high], size, radii.iter().filter(held).count())
        };
        Self {
            placed: Vec::with_capacity(radii.len()),
            layers: sizes.take_while(|&s| s >= smallest).map(layer).collect(),
            allowance,
        }
    }

    pub(super) fn count(&self) -> usize {
        self.placed.len()
    }

    pub(super) fn grain(&self, number: u32) -> &Grain {
        &self.placed[number as usize].grain
    }

    pub(super) fn into_grains(self) -> Vec<Grain> {
        self.placed.iter().map(|placed| placed.grain).collect()
    }

    /// Adds a grain; its number is the number of grains before it.
    pub(super) fn push(&mut self, grain: Grain) -> u32 {
        let number = self.placed.len() as u32;
        let fits = |layer: &&mut Layer| grain.radius <= layer.largest;
        let layer = self.layers.iter_mut().rev().find(fits);
        let layer = layer.expect("radii are those given at the start");
        let cell = layer.row(grain.centre.y) * layer.columns + layer.column(grain.centre.x);
        let before = std::mem::replace(&mut layer.last[cell], number);
        self.placed.push(Placed { grain, before });
        number
    }

    /// Shows `look` every grain that a disc overlaps, the allowance aside, until it has seen enough (false).
    pub(super) fn overlapped(&self, disc: Grain, mut look: impl FnMut(u32, &Grain) -> bool) {
        let Grain { centre, radius } = disc;
        let own = radius - self.allowance;
        for layer in &self.layers {
            let reach = own + layer.largest;
            let columns = layer.column(centre.x - reach)..=layer.column(centre.x + reach);
            for row in layer.row(centre.y - reach)..=layer.row(centre.y + reach) {
                let first = row * layer.columns;
                for &last in &layer.last[first + columns.start()..=first + columns.end()] {
                    let mut number = last;
                    while number != END {
                        let Placed { grain, before } = &self.placed[number as usize];
                        let distance = own + grain.radius;
                        if (grain.centre - centre).length_squared() < distance * distance
                            && !look(number, grain)
                        {
                            return;
                        }
                        number = *before;
                    }
                }
            }
        }
    }
}

impl Layer {
    fn new([low, high]: [Vector; 2], largest: f64, count: usize) -> Self {
        let (width, height) = (high.x - low.x, high.y - low.y);
        // A layer needs no more cells than about twice its grains.
        let most = 4.0 * count as f64 + 16.0;
        let cell = (CELL_SIZE * largest)
            .max((width * height / most).sqrt())
            .max(width.max(height) / most);
        let columns = (width / cell) as usize + 1;
        let rows = (height / cell) as usize + 1;
        Self {
            largest,
            origin: low,
            cells_a_length: 1.0 / cell,
            columns,
            rows,
            last: vec![END; columns * rows],
        }
    }

    fn column(&self, x: f64) -> usize {
        // The cast saturates: what is outside belongs to the outermost cells.
        (((x - self.origin.x) * self.cells_a_length) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.origin.y) * self.cells_a_length) as usize).min(self.rows - 1)
    }
}
