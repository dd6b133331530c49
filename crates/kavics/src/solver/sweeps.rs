//! Solutions with the factor: sweeps forward (with L) and backward (with D and Lᵀ).
//!
//! A panel's rows are copied into a narrow vector, so that what costs time, the values of the factor, is read once and
//! in order, several columns together.

use std::array::from_fn;

use super::panels::{Panel, Panels};

/// Sums that are carried side by side, for the processor to add several numbers at once.
const LANES: usize = 8;

/// Values of a panel that are fetched ahead.
const AHEAD: usize = 8192;
/// Values that memory hands over together.
const LINE: usize = 8;

/// Reads into the panel to come, in order. Short columns side by side are too short for the processor to see where they
/// go, and it would wait for each of them.
pub(super) fn fetch(values: &[f64]) {
    let ahead = &values[..values.len().min(AHEAD)];
    let mut sums = [0.0; 4];
    for lines in ahead.as_chunks::<{ 4 * LINE }>().0 {
        for (line, sum) in sums.iter_mut().enumerate() {
            *sum += lines[LINE * line];
        }
    }
    std::hint::black_box(sums);
}

/// Eliminates the columns of a panel from its part of R vectors: x ← L⁻¹x.
pub(super) fn forward<const R: usize>(panel: &Panel, values: &[f64], local: &mut [f64]) {
    let mut column = 0;
    while column < panel.columns {
        let width = width(panel.columns - column);
        for x in local.chunks_exact_mut(panel.rows).take(R) {
            match width {
                4 => forward_columns::<4>(panel.rows, column, values, x),
                3 => forward_columns::<3>(panel.rows, column, values, x),
                2 => forward_columns::<2>(panel.rows, column, values, x),
                _ => forward_columns::<1>(panel.rows, column, values, x),
            }
        }
        column += width;
    }
}

/// How many columns are taken together.
fn width(left: usize) -> usize {
    match left {
        1..=3 => left,
        5 | 6 | 9 => 3,
        _ => 4,
    }
}

fn forward_columns<const W: usize>(rows: usize, first: usize, values: &[f64], x: &mut [f64]) {
    let below = first + W;
    let (own, x) = x.split_at_mut(below);
    let own = &mut own[first..];
    for j in 0..W {
        for i in j + 1..W {
            own[i] -= values[(first + j) * rows + first + i] * own[j];
        }
    }
    let columns: [&[f64]; W] = from_fn(|j| &values[(first + j) * rows + below..][..x.len()]);
    subtract(x, &columns, from_fn(|j| own[j]));
}

/// x ← x − Σ column · factor.
fn subtract<const W: usize>(x: &mut [f64], columns: &[&[f64]; W], factors: [f64; W]) {
    let rows = x.len();
    let columns = columns.map(|column| &column[..rows]);
    // By number, as the compiler makes the best of.
    for i in 0..rows {
        let mut sum = x[i];
        for j in 0..W {
            sum -= columns[j][i] * factors[j];
        }
        x[i] = sum;
    }
}

/// The way back through a panel: x ← L⁻ᵀD⁻¹x.
pub(super) fn backward<const R: usize>(panel: &Panel, values: &[f64], local: &mut [f64]) {
    for column in (0..panel.columns).rev() {
        let values = &values[column * panel.rows + column..(column + 1) * panel.rows];
        for x in local.chunks_exact_mut(panel.rows).take(R) {
            let known = product(&values[1..], &x[column + 1..]);
            x[column] = x[column] / values[0] - known;
        }
    }
}

fn product(column: &[f64], x: &[f64]) -> f64 {
    let ((column, column_rest), (x, x_rest)) =
        (column.as_chunks::<LANES>(), x.as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (column, x) in column.iter().zip(x) {
        for lane in 0..LANES {
            sums[lane] += column[lane] * x[lane];
        }
    }
    let rest = column_rest.iter().zip(x_rest).map(|(l, x)| l * x);
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + e) + (c + g)) + ((b + f) + (d + h)) + rest.sum::<f64>()
}

/// Solves with L for R vectors of the whole length, one behind the other.
pub(super) fn forward_all<const R: usize>(
    panels: &Panels,
    factor: &[f64],
    x: &mut [f64],
    local: &mut [f64],
) {
    let order = x.len() / R;
    for (index, panel) in panels.list.iter().enumerate() {
        if let Some(next) = panels.list.get(index + 1) {
            fetch(&factor[next.values()]);
        }
        gather::<R>(panels, panel, order, x, local);
        forward::<R>(panel, &factor[panel.values()], local);
        scatter::<R>(panels, panel, order, local, x);
    }
}

/// Solves with DLᵀ for R vectors of the whole length, one behind the other.
pub(super) fn backward_all<const R: usize>(
    panels: &Panels,
    factor: &[f64],
    x: &mut [f64],
    local: &mut [f64],
) {
    let order = x.len() / R;
    for (index, panel) in panels.list.iter().enumerate().rev() {
        if index > 0 {
            fetch(&factor[panels.list[index - 1].values()]);
        }
        gather::<R>(panels, panel, order, x, local);
        backward::<R>(panel, &factor[panel.values()], local);
        for (x, local) in x
            .chunks_exact_mut(order)
            .zip(local.chunks_exact(panel.rows))
        {
            x[panel.own()].copy_from_slice(&local[..panel.columns]);
        }
    }
}

/// Copies the rows of a panel out of R vectors.
pub(super) fn gather<const R: usize>(
    panels: &Panels,
    panel: &Panel,
    order: usize,
    x: &[f64],
    local: &mut [f64],
) {
    let parts = local.chunks_exact_mut(panel.rows).take(R);
    for (local, x) in parts.zip(x.chunks_exact(order)) {
        panels.gather(panel, x, local);
    }
}

/// Copies them back.
pub(super) fn scatter<const R: usize>(
    panels: &Panels,
    panel: &Panel,
    order: usize,
    local: &[f64],
    x: &mut [f64],
) {
    let parts = local.chunks_exact(panel.rows).take(R);
    for (local, x) in parts.zip(x.chunks_exact_mut(order)) {
        panels.scatter(panel, local, x);
    }
}
