//! Lists of grains: x, y and radius, read from and written to csv, Parquet, extended XYZ or a dump of LAMMPS.

use std::fmt::Write;
use std::path::Path;

use kavics::assembly::Grain;

use crate::column::{Column, Unit};
use crate::encode::{publish, publish_table};
use crate::{Columns, ResultsError, grain_list_dump, grain_list_xyz};

/// Format of a list of grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Csv,
    Parquet,
    ExtendedXyz,
    LammpsDump,
}

/// Endings of files, without the dot.
const ENDINGS: [(&str, Format); 7] = [
    ("csv", Format::Csv),
    ("parquet", Format::Parquet),
    ("xyz", Format::ExtendedXyz),
    ("extxyz", Format::ExtendedXyz),
    ("dump", Format::LammpsDump),
    ("lammpstrj", Format::LammpsDump),
    ("lammps", Format::LammpsDump),
];
/// The same in a sentence.
const EXPECTED: &str = ".csv, .parquet, .xyz, .extxyz, .dump, .lammpstrj or .lammps";

impl Format {
    fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?;
        let mut known = ENDINGS.iter();
        let found = known.find(|(name, _)| ending.eq_ignore_ascii_case(name));
        found.map(|(_, format)| *format)
    }
}

/// Reads x, y and radius of grains from a Parquet file with columns of these names, from extended XYZ or from a dump of
/// LAMMPS, by the ending of the file.
///
/// Files of several frames give the last, or `frame`, counted from 0.
///
/// # Errors
/// A sentence that says what is wrong with the file.
pub fn read_grains(path: &Path, frame: Option<usize>) -> Result<Vec<[f64; 3]>, String> {
    match Format::of(path) {
        Some(Format::Parquet) if frame.is_some() => Err("a Parquet file has no frames".to_owned()),
        Some(Format::Parquet) => read_parquet(path),
        Some(Format::ExtendedXyz) => grain_list_xyz::read(&read_text(path)?, frame),
        Some(Format::LammpsDump) => grain_list_dump::read(&read_text(path)?, frame),
        Some(Format::Csv) | None => Err(format!("expected a file that ends in {EXPECTED}")),
    }
}

fn read_text(path: &Path) -> Result<String, String> {
    let bytes = std::fs::read(path).map_err(|error| format!("cannot be read: {error}"))?;
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = before.split(|byte| *byte == b'\n').count();
        format!("line {line}: this is not text in UTF-8")
    })
}

fn read_parquet(path: &Path) -> Result<Vec<[f64; 3]>, String> {
    let table = Columns::read(path).map_err(|error| error.without_path())?;
    let column = |name: &str| table.numbers(name).map_err(|error| error.without_path());
    let (x, y, radius) = (column("x")?, column("y")?, column("radius")?);
    Ok((0..table.len())
        .map(|row| [x[row], y[row], radius[row]])
        .collect())
}

/// Writes x, y and radius of grains to a file, its format by its ending.
///
/// # Errors
/// Another ending; a file that cannot be written.
pub fn write_grains(path: &Path, grains: &[Grain]) -> Result<(), ResultsError> {
    let text = match Format::of(path) {
        Some(Format::Parquet) => return publish_table(path, &columns(), grains),
        Some(Format::Csv) => grains_csv(grains),
        Some(Format::ExtendedXyz) => grain_list_xyz::written(grains),
        Some(Format::LammpsDump) => grain_list_dump::written(grains),
        None => {
            return Err(ResultsError::UnknownEnding {
                path: path.to_owned(),
                expected: EXPECTED,
            });
        }
    };
    publish(path, text.as_bytes())
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
