//! Regular arrangements of equal grains: hexagonal and square rows, centred in the box.
//!
//! Row j from the bottom (from 0) has its centres at y = R + j·p, with the pitch p = √3·R of a hexagonal and 2·R of a
//! square arrangement; grain i of a row of n lies at x = W/2 + (2·i − (n − 1))·R. Ids run from left to right, row by row.

use crate::assembly::Grain;
use crate::geometry::Vector;
use crate::ids::PerGrain;
use crate::packing::{PackingError, check_box, check_count, check_radius, check_resolution};

/// Grains of equal `radius` in hexagonal rows in a box of the given `width`; `rows` has the grains of each row from the
/// bottom, and neighbours differ by an odd number.
///
/// # Errors
/// A row that is empty, longer than the box is wide, or does not fit into the gaps of the row below.
pub fn hexagonal(radius: f64, width: f64, rows: &[usize]) -> Result<PerGrain<Grain>, PackingError> {
    if rows.is_empty() {
        return Err(PackingError::NoGrains);
    }
    if let Some(row) = rows.iter().position(|&grains| grains == 0) {
        return Err(PackingError::EmptyRow { row: row + 1 });
    }
    for (row, pair) in rows.windows(2).enumerate() {
        let (lower, upper) = (pair[0], pair[1]);
        if lower.abs_diff(upper) % 2 == 0 {
            let row = row + 1;
            return Err(PackingError::RowsMismatch { row, lower, upper });
        }
    }
    place(radius, width, 3_f64.sqrt() * radius, rows)
}

/// Grains of equal `radius` in `rows` rows of `columns` grains, each right above the other.
///
/// # Errors
/// Rows that are empty or longer than the box is wide.
pub fn square(
    radius: f64,
    width: f64,
    columns: usize,
    rows: usize,
) -> Result<PerGrain<Grain>, PackingError> {
    check_count(columns.saturating_mul(rows))?;
    place(radius, width, 2.0 * radius, &vec![columns; rows])
}

fn place(
    radius: f64,
    width: f64,
    pitch: f64,
    rows: &[usize],
) -> Result<PerGrain<Grain>, PackingError> {
    check(radius, width, rows)?;
    let count = rows
        .iter()
        .fold(0_usize, |sum, &row| sum.saturating_add(row));
    check_count(count)?;
    let mut grains = Vec::with_capacity(count);
    for (number, &row) in rows.iter().enumerate() {
        let y = radius + number as f64 * pitch;
        for place in 0..row {
            let from_middle = 2.0 * place as f64 - (row - 1) as f64;
            grains.push(Grain {
                centre: Vector::new(0.5 * width + from_middle * radius, y),
                radius,
            });
        }
    }
    Ok(grains.into())
}

fn check(radius: f64, width: f64, rows: &[usize]) -> Result<(), PackingError> {
    check_radius(radius)?;
    check_box(width)?;
    check_resolution(&[radius], width)?;
    for (number, &grains) in rows.iter().enumerate() {
        let length = 2.0 * radius * grains as f64;
        // Decimal numbers of the scene may miss each other by a rounding.
        if length > width + 1e-9 * radius {
            return Err(PackingError::RowTooLong {
                row: number + 1,
                grains,
                radius,
                length,
                width,
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn abscissas(grains: &PerGrain<Grain>) -> Vec<f64> {
        grains.values().iter().map(|g| g.centre.x).collect()
    }

    #[test]
    fn rows_of_five_and_four_fill_a_box_five_diameters_wide() {
        let grains = hexagonal(1.0, 10.0, &[5, 4]).unwrap();
        assert_eq!(
            abscissas(&grains),
            [1.0, 3.0, 5.0, 7.0, 9.0, 2.0, 4.0, 6.0, 8.0]
        );
        assert_eq!(grains.values()[4].centre.y, 1.0);
        assert_eq!(grains.values()[5].centre.y, 1.0 + 3_f64.sqrt());
    }

    #[test]
    fn a_row_above_touches_two_grains_below() {
        let grains = hexagonal(0.7, 20.0, &[6, 5]).unwrap();
        let gap = |a: usize, b: usize| {
            let (a, b) = (grains.values()[a], grains.values()[b]);
            (b.centre - a.centre).length() - 1.4
        };
        for upper in 0..5 {
            assert!(gap(upper, 6 + upper).abs() < 1e-14);
            assert!(gap(upper + 1, 6 + upper).abs() < 1e-14);
        }
    }

    #[test]
    fn square_rows_lie_above_each_other() {
        let grains = square(0.5, 3.0, 3, 2).unwrap();
        assert_eq!(abscissas(&grains), [0.5, 1.5, 2.5, 0.5, 1.5, 2.5]);
        assert_eq!(grains.values()[5].centre.y, 1.5);
    }

    #[test]
    fn rows_that_cannot_be_placed_say_why() {
        let long = hexagonal(1.0, 9.0, &[5, 4]).unwrap_err();
        assert_eq!(
            long.to_string(),
            "row 1 of 5 grains of radius 1 is 10 long, the box 9 wide"
        );
        let even = hexagonal(1.0, 20.0, &[5, 4, 6]).unwrap_err();
        assert_eq!(
            even.to_string(),
            "rows 2 and 3 have 4 and 6 grains; they must differ by an odd number"
        );
        assert_eq!(
            hexagonal(1.0, 20.0, &[1, 0, 1]).unwrap_err(),
            PackingError::EmptyRow { row: 2 }
        );
    }
}
