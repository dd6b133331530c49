//! Dump files of LAMMPS: grains as atoms, active contacts between grains as a local dump of bonds.
//!
//! LAMMPS counts from 1: `id` is the number of the grain plus 1, in both files; `grain` and `contact` are ours.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use kavics::geometry::Vector;
use kavics_pictures::PictureError;
use kavics_results::{Columns, ResultsError, publish_by};

use crate::frames::{Frame, Frames, make_folder};
use crate::words::{Numbers, Words, write_words};

/// Writes all load steps into a file of grains and one of bonds.
pub(crate) fn write(frames: &Frames<'_>, folder: &Path) -> Result<Vec<PathBuf>, PictureError> {
    make_folder(folder)?;
    let of_grains = Words::of(frames, |step| frames.results.grains(step))?;
    let of_contacts = Words::of(frames, |step| frames.results.contacts(step))?;
    let grains = folder.join("grains.dump");
    write_dump(&grains, frames, |file, frame| {
        write_grains(file, frames, frame, &of_grains)
    })?;
    let bonds = folder.join("bonds.dump");
    write_dump(&bonds, frames, |file, frame| {
        write_bonds(file, frames, frame, &of_contacts)
    })?;
    write_words(
        folder,
        &[("grains", &of_grains), ("contacts", &of_contacts)],
    )?;
    Ok(vec![grains, bonds])
}

type Buffered<'a> = BufWriter<&'a mut (dyn Write + Send)>;

/// Writes a file frame by frame.
fn write_dump(
    path: &Path,
    frames: &Frames<'_>,
    write: impl Fn(&mut Buffered<'_>, &Frame<'_>) -> Result<io::Result<()>, ResultsError>,
) -> Result<(), ResultsError> {
    publish_by(path, |file| {
        let mut file = BufWriter::new(file);
        for &step in &frames.steps {
            let written = write(&mut file, &frames.read(step)?)?;
            written.map_err(ResultsError::unwritable(path))?;
        }
        file.flush().map_err(ResultsError::unwritable(path))
    })
}

fn write_grains(
    file: &mut impl Write,
    frames: &Frames<'_>,
    frame: &Frame<'_>,
    words: &Words,
) -> Result<io::Result<()>, ResultsError> {
    let table = Table::read(&frame.grains, words, |name| match name {
        // LAMMPS knows these as places now; the tables have those before loading.
        "x" => "x_before",
        "y" => "y_before",
        // A force on an atom; here external loads.
        "fx" => "load_x",
        "fy" => "load_y",
        name => name,
    })?;
    let mut lines = || -> io::Result<()> {
        write_head(file, frames, frame, "NUMBER OF ATOMS", frame.grains.len())?;
        writeln!(file, "ITEM: ATOMS id type x y z{}", table.names())?;
        for (row, Vector { x, y }) in frame.centres().into_iter().enumerate() {
            write!(file, "{} 1 {x:?} {y:?} 0.0", row + 1)?;
            table.write(file, row)?;
        }
        Ok(())
    };
    Ok(lines())
}

fn write_bonds(
    file: &mut impl Write,
    frames: &Frames<'_>,
    frame: &Frame<'_>,
    words: &Words,
) -> Result<io::Result<()>, ResultsError> {
    let table = Table::read(&frame.contacts, words, |name| name)?;
    let bonds = frame.bonds();
    let mut lines = || -> io::Result<()> {
        write_head(file, frames, frame, "NUMBER OF ENTRIES", bonds.len())?;
        writeln!(file, "ITEM: ENTRIES batom1 batom2{}", table.names())?;
        for (row, [a, b]) in &bonds {
            write!(file, "{} {}", a + 1, b + 1)?;
            table.write(file, *row)?;
        }
        Ok(())
    };
    Ok(lines())
}

fn write_head(
    file: &mut impl Write,
    frames: &Frames<'_>,
    frame: &Frame<'_>,
    counted: &str,
    count: usize,
) -> io::Result<()> {
    let [low, high] = frames.bounds();
    writeln!(
        file,
        "ITEM: TIMESTEP\n{}\nITEM: {counted}\n{count}",
        frame.step
    )?;
    writeln!(file, "ITEM: BOX BOUNDS ff ff ff")?;
    writeln!(
        file,
        "{:?} {:?}\n{:?} {:?}\n-0.5 0.5",
        low.x, high.x, low.y, high.y
    )
}

/// Columns as numbers.
struct Table {
    columns: Vec<(String, Numbers)>,
}

impl Table {
    fn read(
        table: &Columns,
        words: &Words,
        rename: impl Fn(&str) -> &str,
    ) -> Result<Self, ResultsError> {
        let column = |name: &str| Ok((rename(name).to_owned(), words.numbers(table, name)?));
        let names = table.names().into_iter().filter(|name| *name != "step");
        let columns = names.map(column).collect::<Result<_, ResultsError>>()?;
        Ok(Self { columns })
    }

    fn names(&self) -> String {
        let names = self.columns.iter().map(|(name, _)| format!(" {name}"));
        names.collect()
    }

    fn write(&self, file: &mut impl Write, row: usize) -> io::Result<()> {
        for (_, column) in &self.columns {
            match column {
                Numbers::Whole(numbers) => write!(file, " {}", numbers[row])?,
                Numbers::Real(numbers) => write!(file, " {:?}", numbers[row])?,
            }
        }
        writeln!(file)
    }
}
