//! Extended XYZ: a frame a load step, with a count, a line of keys and a line a grain.
//!
//! After libAtoms' specification: `Lattice`, `Origin`, `pbc`, `Properties`, and what else the frame is known by.

use std::fmt::Write as _;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use kavics::geometry::Vector;
use kavics_pictures::PictureError;
use kavics_results::{Columns, ResultsError, publish_by};

use crate::frames::{Frame, Frames, make_folder};

/// Columns that stand at the start of each line under names that readers know.
const KNOWN: [&str; 2] = ["grain", "radius"];

/// A column as words of a line.
enum Words<'a> {
    Whole(Vec<Option<i64>>),
    Real(Vec<f64>),
    Text(Vec<&'a str>),
}

/// Writes all load steps into one file.
pub(crate) fn write(frames: &Frames<'_>, folder: &Path) -> Result<Vec<PathBuf>, PictureError> {
    make_folder(folder)?;
    let path = folder.join("grains.extxyz");
    publish_by(&path, |file| {
        let mut file = BufWriter::new(file);
        for &step in &frames.steps {
            let written = write_frame(&mut file, frames, &frames.read(step)?)?;
            written.map_err(ResultsError::unwritable(&path))?;
        }
        file.flush().map_err(ResultsError::unwritable(&path))
    })?;
    Ok(vec![path])
}

fn write_frame(
    file: &mut impl Write,
    frames: &Frames<'_>,
    frame: &Frame<'_>,
) -> Result<io::Result<()>, ResultsError> {
    let table = &frame.grains;
    let names = table.names();
    let others: Vec<&str> = names
        .into_iter()
        .filter(|name| !KNOWN.contains(name))
        .collect();
    let columns = others.iter().map(|name| Words::read(table, name));
    let columns = columns.collect::<Result<Vec<_>, _>>()?;
    let (ids, radii) = (table.integers("grain")?, table.numbers("radius")?);
    let mut header = format!("{}\n{}", table.len(), keys(frames.bounds(), frame));
    for (name, column) in others.iter().zip(&columns) {
        // `x` and `y` are the places before loading; `pos` has the displaced ones.
        let _ = write!(header, ":{name}:{}:1", column.kind());
    }
    let mut lines = || -> io::Result<()> {
        writeln!(file, "{header}")?;
        for (row, Vector { x, y }) in frame.centres().into_iter().enumerate() {
            let id = ids[row].unwrap_or(-1);
            write!(file, "G {x:?} {y:?} 0.0 {:?} {id}", radii[row])?;
            for column in &columns {
                column.write(file, row)?;
            }
            writeln!(file)?;
        }
        Ok(())
    };
    Ok(lines())
}

/// The line of keys up to the columns that every list of grains has.
fn keys([low, high]: [Vector; 2], frame: &Frame<'_>) -> String {
    let (size, depth) = (high - low, 1.0);
    format!(
        "Lattice=\"{:?} 0.0 0.0 0.0 {:?} 0.0 0.0 0.0 {depth:?}\" Origin=\"{:?} {:?} -0.5\" pbc=\"F F F\" \
         step={} load_factor={:?} Properties=species:S:1:pos:R:3:radius:R:1:id:I:1",
        size.x, size.y, low.x, low.y, frame.step, frame.load_factor
    )
}

impl<'a> Words<'a> {
    fn read(table: &'a Columns, name: &str) -> Result<Self, ResultsError> {
        Ok(if table.is_text(name) {
            Self::Text(table.texts(name)?)
        } else if table.is_whole(name) {
            Self::Whole(table.integers(name)?)
        } else {
            Self::Real(table.numbers(name)?)
        })
    }

    fn kind(&self) -> char {
        match self {
            Self::Whole(_) => 'I',
            Self::Real(_) => 'R',
            Self::Text(_) => 'S',
        }
    }

    fn write(&self, file: &mut impl Write, row: usize) -> io::Result<()> {
        match self {
            Self::Whole(numbers) => write!(file, " {}", numbers[row].unwrap_or(-1)),
            Self::Real(numbers) => write!(file, " {:?}", numbers[row]),
            Self::Text(words) if words[row].is_empty() => write!(file, " none"),
            Self::Text(words) => write!(file, " {}", words[row].replace(char::is_whitespace, "_")),
        }
    }
}
