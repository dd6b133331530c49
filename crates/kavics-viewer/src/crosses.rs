//! Principal directions of fabric and stress, averaged over squares of the assembly and over the window.
//!
//! The stress of a square is that of its grains, each weighted by its power cell, Σ A σ / Σ A; the fabric tensor
//! Σ n n / Σ m runs over the active contacts of its grains. Those of the window are measured by the run.

use std::f64::consts::FRAC_PI_2;

use kavics::geometry::Vector;
use kavics::measure::SymmetricTensor;
use kavics_results::Columns;

use crate::PageError;
use crate::column::{PageColumn, Values};

/// Squares across the longer side of the assembly, about, and grains in a square at least, about.
const ACROSS: f64 = 12.0;
const GRAINS_IN_SQUARE: f64 = 4.0;

/// Columns of the tables that are read.
pub(crate) const OF_GRAINS: [&str; 8] = [
    "x",
    "y",
    "cell_area",
    "stress_xx",
    "stress_xy",
    "stress_yx",
    "stress_yy",
    "window",
];
pub(crate) const OF_CONTACTS: [&str; 5] = ["first", "second", "nx", "ny", "state"];
pub(crate) const OF_STEPS: [&str; 8] = [
    "step",
    "fabric_xx",
    "fabric_xy",
    "fabric_yy",
    "stress_xx",
    "stress_xy",
    "stress_yx",
    "stress_yy",
];

/// What a cross is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Fabric,
    Stress,
}

/// A cross to be drawn.
#[derive(Clone, Copy, Debug)]
struct Cross {
    kind: Kind,
    whole: bool,
    centre: Vector,
    size: f64,
    tensor: SymmetricTensor,
}

impl Cross {
    /// Angle of the larger principal value, of stress the larger by magnitude; this value, and the other.
    fn principal(&self) -> [f64; 3] {
        let [larger, smaller] = self.tensor.eigenvalues();
        let angle = self.tensor.principal_direction();
        if self.kind == Kind::Fabric || larger.abs() >= smaller.abs() {
            return [angle, larger, smaller];
        }
        let turned = if angle > 0.0 {
            angle - FRAC_PI_2
        } else {
            angle + FRAC_PI_2
        };
        [turned, smaller, larger]
    }
}

/// The squares over the assembly.
#[derive(Clone, Copy, Debug)]
struct Squares {
    corner: Vector,
    size: f64,
    columns: usize,
    rows: usize,
}

impl Squares {
    fn over(x: &[f64], y: &[f64], area: &[f64]) -> Self {
        let ([left, right], [bottom, top]) = (extent(x), extent(y));
        let (width, height) = (right - left, top - bottom);
        let mean_area = area.iter().sum::<f64>() / area.len().max(1) as f64;
        let least = (GRAINS_IN_SQUARE * mean_area).sqrt();
        let size = (width.max(height) / ACROSS)
            .max(least)
            .max(f64::MIN_POSITIVE);
        let (columns, rows) = (count(width, size), count(height, size));
        let margin = |count: usize, extent: f64| 0.5 * (count as f64 * size - extent);
        Self {
            corner: Vector::new(left - margin(columns, width), bottom - margin(rows, height)),
            size,
            columns,
            rows,
        }
    }

    fn of(&self, x: f64, y: f64) -> usize {
        let place = |offset: f64, count: usize| ((offset / self.size) as usize).min(count - 1);
        let row = place(y - self.corner.y, self.rows);
        row * self.columns + place(x - self.corner.x, self.columns)
    }

    fn centre(&self, square: usize) -> Vector {
        let at = |number: usize| (number as f64 + 0.5) * self.size;
        let (row, column) = (square / self.columns, square % self.columns);
        self.corner + Vector::new(at(column), at(row))
    }
}

fn count(extent: f64, size: f64) -> usize {
    ((extent / size).ceil() as usize).max(1)
}

fn extent(values: &[f64]) -> [f64; 2] {
    let bounds = values
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &value| {
            [low.min(value), high.max(value)]
        });
    if bounds[0] > bounds[1] {
        [0.0; 2]
    } else {
        bounds
    }
}

/// A weighted sum of tensors.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    tensor: SymmetricTensor,
    weight: f64,
}

impl Sum {
    fn add(&mut self, tensor: SymmetricTensor, weight: f64) {
        self.tensor.xx += weight * tensor.xx;
        self.tensor.xy += weight * tensor.xy;
        self.tensor.yy += weight * tensor.yy;
        self.weight += weight;
    }

    fn mean(self) -> Option<SymmetricTensor> {
        (self.weight > 0.0).then(|| SymmetricTensor {
            xx: self.tensor.xx / self.weight,
            xy: self.tensor.xy / self.weight,
            yy: self.tensor.yy / self.weight,
        })
    }
}

/// The crosses at a load step, as columns and their number of rows.
pub(crate) fn crosses(
    step: usize,
    grains: &Columns,
    contacts: &Columns,
    steps: &Columns,
) -> Result<(Vec<PageColumn>, usize), PageError> {
    let [x, y, area] = ["x", "y", "cell_area"].map(|name| grains.numbers(name));
    let (x, y, area) = (x?, y?, area?);
    let squares = Squares::over(&x, &y, &area);
    let square: Vec<usize> = (0..x.len()).map(|row| squares.of(x[row], y[row])).collect();
    let mut found = Vec::new();
    let mut take = |kind: Kind, sums: Vec<Sum>| {
        let means = sums.into_iter().enumerate();
        found.extend(means.filter_map(|(number, sum)| {
            Some(Cross {
                kind,
                whole: false,
                centre: squares.centre(number),
                size: squares.size,
                tensor: sum.mean()?,
            })
        }));
    };
    let count = squares.columns * squares.rows;
    take(Kind::Fabric, fabric(contacts, &square, count)?);
    take(Kind::Stress, stress(grains, &area, &square, count)?);
    found.extend(of_window(step, grains, [&x, &y, &area], steps)?);
    Ok((columns(&found), found.len()))
}

fn fabric(contacts: &Columns, square: &[usize], count: usize) -> Result<Vec<Sum>, PageError> {
    let mut sums = vec![Sum::default(); count];
    let states = contacts.texts("state")?;
    let partners = [contacts.integers("first")?, contacts.integers("second")?];
    let (nx, ny) = (contacts.numbers("nx")?, contacts.numbers("ny")?);
    for row in 0..contacts.len() {
        if matches!(states[row], "open" | "broken") {
            continue;
        }
        let normal = SymmetricTensor::square(Vector::new(nx[row], ny[row]));
        for partner in &partners {
            let grain = partner[row].and_then(|grain| usize::try_from(grain).ok());
            if let Some(&square) = grain.and_then(|grain| square.get(grain)) {
                sums[square].add(normal, 1.0);
            }
        }
    }
    Ok(sums)
}

fn stress(
    grains: &Columns,
    area: &[f64],
    square: &[usize],
    count: usize,
) -> Result<Vec<Sum>, PageError> {
    let mut sums = vec![Sum::default(); count];
    let stress = symmetric_stress(grains)?;
    for ((&square, &area), stress) in square.iter().zip(area).zip(stress) {
        sums[square].add(stress, area);
    }
    Ok(sums)
}

fn symmetric_stress(table: &Columns) -> Result<Vec<SymmetricTensor>, PageError> {
    let (xx, yy) = (table.numbers("stress_xx")?, table.numbers("stress_yy")?);
    let (xy, yx) = (table.numbers("stress_xy")?, table.numbers("stress_yx")?);
    let tensor = |row: usize| SymmetricTensor {
        xx: xx[row],
        xy: 0.5 * (xy[row] + yx[row]),
        yy: yy[row],
    };
    Ok((0..table.len()).map(tensor).collect())
}

/// The crosses of the window, where it is known and measured.
fn of_window(
    step: usize,
    grains: &Columns,
    [x, y, area]: [&[f64]; 3],
    steps: &Columns,
) -> Result<Vec<Cross>, PageError> {
    let numbers = steps.integers("step")?;
    let row = numbers
        .iter()
        .position(|number| *number == Some(step as i64));
    let (Some(row), Ok(window)) = (row, grains.integers("window")) else {
        return Ok(Vec::new());
    };
    let within = (0..x.len()).filter(|&grain| window[grain] == Some(1));
    let (mut centre, mut whole) = (Vector::default(), 0.0);
    for grain in within {
        centre = centre + Vector::new(x[grain], y[grain]) * area[grain];
        whole += area[grain];
    }
    let fabric = SymmetricTensor {
        xx: steps.numbers("fabric_xx")?[row],
        xy: steps.numbers("fabric_xy")?[row],
        yy: steps.numbers("fabric_yy")?[row],
    };
    let cross = |kind, tensor: SymmetricTensor| Cross {
        kind,
        whole: true,
        centre: centre * (1.0 / whole),
        size: whole.sqrt(),
        tensor,
    };
    let both = [
        cross(Kind::Fabric, fabric),
        cross(Kind::Stress, symmetric_stress(steps)?[row]),
    ];
    let is_measured = |cross: &Cross| whole > 0.0 && cross.tensor.trace().is_finite();
    Ok(both.into_iter().filter(is_measured).collect())
}

fn columns(crosses: &[Cross]) -> Vec<PageColumn> {
    let single = |name, unit, value: &dyn Fn(&Cross) -> f64| {
        let values = crosses.iter().map(|cross| value(cross) as f32);
        PageColumn::new(name, unit, Values::Single(values.collect()))
    };
    let codes = crosses.iter().map(|cross| cross.kind as u16).collect();
    let names = ["fabric", "stress"].map(str::to_owned).to_vec();
    let whole = crosses.iter().map(|cross| i32::from(cross.whole)).collect();
    vec![
        PageColumn::new("kind", "", Values::Words(codes, names)),
        PageColumn::new("whole", "", Values::Integers(whole)),
        single("x", "length", &|cross| cross.centre.x),
        single("y", "length", &|cross| cross.centre.y),
        single("size", "length", &|cross| cross.size),
        single("angle", "1", &|cross| cross.principal()[0]),
        single("major", "", &|cross| cross.principal()[1]),
        single("minor", "", &|cross| cross.principal()[2]),
    ]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    use super::{Cross, Kind, Squares};
    use kavics::geometry::Vector;
    use kavics::measure::SymmetricTensor;

    fn cross(kind: Kind, xx: f64, xy: f64, yy: f64) -> Cross {
        Cross {
            kind,
            whole: false,
            centre: Vector::default(),
            size: 1.0,
            tensor: SymmetricTensor { xx, xy, yy },
        }
    }

    #[test]
    fn the_stress_of_larger_magnitude_leads() {
        // Compression along y, tension along x.
        assert_eq!(
            cross(Kind::Stress, 1.0, 0.0, -3.0).principal(),
            [FRAC_PI_2, -3.0, 1.0]
        );
        assert_eq!(
            cross(Kind::Fabric, 0.25, 0.0, 0.75).principal(),
            [FRAC_PI_2, 0.75, 0.25]
        );
        // Pure shear: tension along the diagonal.
        assert_eq!(
            cross(Kind::Stress, 0.0, 2.0, 0.0).principal(),
            [FRAC_PI_4, 2.0, -2.0]
        );
    }

    #[test]
    fn every_grain_lies_in_a_square_that_holds_it() {
        let x: Vec<f64> = (0..100).map(|i| f64::from(i % 10)).collect();
        let y: Vec<f64> = (0..100).map(|i| f64::from(i / 10) * 2.0).collect();
        let squares = Squares::over(&x, &y, &[2.0; 100]);
        for (&x, &y) in x.iter().zip(&y) {
            let centre = squares.centre(squares.of(x, y));
            let half = 0.5 * squares.size * (1.0 + 1e-12);
            assert!((x - centre.x).abs() <= half && (y - centre.y).abs() <= half);
        }
    }
}
