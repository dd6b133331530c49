//! Checks of rows of equal grains.

use std::ops::Range;

use super::checker::{Bound, Checker};
use super::diagnostic::Problem;
use super::file_grains::LatticeFile;
use super::unit::Dimension;
use super::value::{ListOr, Placed};

/// Rows as they are given.
enum Rows {
    /// Row lengths, each with its place.
    Listed(Vec<Placed<usize>>),
    /// Number of rows and length of the longest: there may be too many to give each a place.
    Counted { count: usize, longest: usize },
}

fn rows(file: &LatticeFile, shorter: usize, checker: &mut Checker) -> Option<Rows> {
    match &file.rows.value {
        ListOr::List(list) if list.is_empty() => {
            checker.push(Problem::at(
                &file.rows.span,
                "`rows` is empty",
                "expected the number of grains in each row, such as `[5, 4, 5]`",
            ));
            None
        }
        ListOr::List(list) => {
            let length = |row: &Placed<i64>| {
                Some(Placed {
                    value: checker.count(row, "rows", 1)?,
                    span: row.span.clone(),
                })
            };
            list.iter()
                .map(length)
                .collect::<Option<_>>()
                .map(Rows::Listed)
        }
        ListOr::Table(table) => {
            let count = checker.count(&table.count, "count", 1);
            let longest = checker.count(&table.longest, "longest", 1 + shorter as i64);
            let (count, longest) = (count?, longest?);
            if count.saturating_mul(longest) > MOST_GRAINS {
                checker.push(Problem::at(
                    &file.rows.span,
                    format!("{count} rows of {longest} grains are too many"),
                    format!("expected at most {MOST_GRAINS} grains"),
                ));
                return None;
            }
            Some(Rows::Counted { count, longest })
        }
    }
}

/// More grains than any machine holds.
const MOST_GRAINS: usize = 100_000_000;

/// Radius and grains of each row.
pub fn hexagonal_rows(file: &LatticeFile, checker: &mut Checker) -> Option<(f64, Vec<usize>)> {
    let radius = checker.number(&file.radius, "radius", Dimension::Length, Bound::Positive);
    let rows = match rows(file, 1, checker)? {
        Rows::Counted { count, longest } => {
            let rows = (0..count).map(|row| longest - row % 2).collect();
            return Some((radius?, rows));
        }
        Rows::Listed(rows) => rows,
    };
    for (number, pair) in rows.windows(2).enumerate() {
        if pair[0].value.abs_diff(pair[1].value) % 2 == 0 {
            checker.push(
                Problem::at(
                    &pair[1].span,
                    format!(
                        "rows {} and {} have {} and {} grains",
                        number + 1,
                        number + 2,
                        pair[0].value,
                        pair[1].value
                    ),
                    "expected a length that differs from the row below by an odd number",
                )
                .help("a row of a hexagonal arrangement lies in the gaps of the row below"),
            );
            return None;
        }
    }
    total(&rows, &file.rows.span, checker)?;
    let rows = rows.iter().map(|row| row.value).collect();
    Some((radius?, rows))
}

/// Radius, grains of a row, rows.
pub fn square_rows(file: &LatticeFile, checker: &mut Checker) -> Option<(f64, usize, usize)> {
    let radius = checker.number(&file.radius, "radius", Dimension::Length, Bound::Positive);
    let rows = match rows(file, 0, checker)? {
        Rows::Counted { count, longest } => return Some((radius?, longest, count)),
        Rows::Listed(rows) => rows,
    };
    let first = rows.first()?.value;
    if let Some(other) = rows.iter().find(|row| row.value != first) {
        checker.push(Problem::at(
            &other.span,
            format!("rows of {first} and of {} grains", other.value),
            "expected rows of the same length in a square arrangement",
        ));
        return None;
    }
    total(&rows, &file.rows.span, checker)?;
    Some((radius?, first, rows.len()))
}

fn total(rows: &[Placed<usize>], span: &Range<usize>, checker: &mut Checker) -> Option<()> {
    if rows
        .iter()
        .fold(0, |sum: usize, row| sum.saturating_add(row.value))
        <= MOST_GRAINS
    {
        return Some(());
    }
    checker.push(Problem::at(
        span,
        "`rows` has too many grains",
        format!("expected at most {MOST_GRAINS} grains"),
    ));
    None
}
