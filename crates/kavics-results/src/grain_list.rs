//! Lists of grains: x, y and radius, read from and written to csv or Parquet.

use std::fmt::Write;
use std::path::Path;

use kavics::assembly::Grain;

use crate::column::{Column, Unit};
use crate::encode::{publish, publish_table};
use crate::{Columns, ResultsError};

/// Reads x, y and radius of grains from a Parquet file with columns of these names.
///
/// # Errors
/// A sentence that says what is wrong with the file.
pub fn read_grains(path: &Path) -> Result<Vec<[f64; 3]>, String> {
    if !ends_in(path, "parquet") {
        return Err("expected a file that ends in .csv or .parquet".to_owned());
    }
    let table = Columns::read(path).map_err(|error| without_path(&error, path))?;
    let column = |name: &str| {
        table
            .numbers(name)
            .map_err(|error| without_path(&error, path))
    };
    let (x, y, radius) = (column("x")?, column("y")?, column("radius")?);
    Ok((0..table.len())
        .map(|row| [x[row], y[row], radius[row]])
        .collect())
}

fn ends_in(path: &Path, ending: &str) -> bool {
    path.extension()
        .is_some_and(|found| found.eq_ignore_ascii_case(ending))
}

/// What is wrong, without the path that the caller names.
fn without_path(error: &ResultsError, path: &Path) -> String {
    let sentence = error.to_string();
    match sentence.strip_prefix(&format!("{}: ", path.display())) {
        Some(rest) => rest.to_owned(),
        None => sentence,
    }
}

/// Writes x, y and radius of grains to a file, csv or parquet by its ending.
///
/// # Errors
/// Another ending; a file that cannot be written.
pub fn write_grains(path: &Path, grains: &[Grain]) -> Result<(), ResultsError> {
    if ends_in(path, "parquet") {
        publish_table(path, &columns(), grains)
    } else if ends_in(path, "csv") {
        publish(path, grains_csv(grains).as_bytes())
    } else {
        Err(ResultsError::UnknownEnding {
            path: path.to_owned(),
        })
    }
}

/// Grains as csv, with a line of names; every number reads back as the same bits.
pub fn grains_csv(grains: &[Grain]) -> String {
    let mut text = String::from("x,y,radius\n");
    for Grain { centre, radius } in grains {
        let _ = writeln!(text, "{:?},{:?},{radius:?}", centre.x, centre.y);
    }
    text
}

fn columns() -> Vec<Column<Grain>> {
    vec![
        Column::number("x", Unit::Length, |g: &Grain| g.centre.x),
        Column::number("y", Unit::Length, |g: &Grain| g.centre.y),
        Column::number("radius", Unit::Length, |g: &Grain| g.radius),
    ]
}
