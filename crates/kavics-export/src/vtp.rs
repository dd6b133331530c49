//! VTP: polygonal data of VTK in XML, arrays inline in base64 and not compressed, which ParaView and OVITO both read.
//!
//! VTK File Formats, section XML: each array begins with its length in bytes.

use std::fmt::Write as _;
use std::io::Write;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use kavics::geometry::Vector;
use kavics_pictures::PictureError;
use kavics_results::{Columns, ResultsError, publish, publish_by};

use crate::frames::{Frame, Frames, make_folder};
use crate::words::{Numbers, Words, write_words};

/// Writes grains and contacts of each load step, and the series of both.
pub(crate) fn write(frames: &Frames<'_>, folder: &Path) -> Result<Vec<PathBuf>, PictureError> {
    let of_grains = Words::of(frames, |step| frames.results.grains(step))?;
    let of_contacts = Words::of(frames, |step| frames.results.contacts(step))?;
    for table in ["grains", "contacts"] {
        make_folder(&folder.join(table))?;
    }
    for &step in &frames.steps {
        let frame = frames.read(step)?;
        publish_document(&file(folder, "grains", step), &grains(&frame, &of_grains)?)?;
        publish_document(
            &file(folder, "contacts", step),
            &contacts(&frame, &of_contacts)?,
        )?;
    }
    let tables = [("grains", &of_grains), ("contacts", &of_contacts)];
    write_words(folder, &tables)?;
    let series = ["grains", "contacts"].map(|table| series(folder, table, &frames.steps));
    series.into_iter().collect()
}

fn file(folder: &Path, table: &str, step: usize) -> PathBuf {
    folder.join(table).join(format!("{step:06}.vtp"))
}

/// The files of a table by load step.
fn series(folder: &Path, table: &str, steps: &[usize]) -> Result<PathBuf, PictureError> {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for step in steps {
        let _ = writeln!(
            text,
            "<DataSet timestep=\"{step}\" part=\"0\" file=\"{table}/{step:06}.vtp\"/>"
        );
    }
    text.push_str("</Collection>\n</VTKFile>\n");
    let path = folder.join(format!("{table}.pvd"));
    publish(&path, text.as_bytes())?;
    Ok(path)
}

/// A document in pieces that are written one after the other.
#[derive(Default)]
struct Document {
    counts: String,
    points: String,
    point_data: String,
    lines: String,
    cell_data: String,
    field_data: String,
}

fn publish_document(path: &Path, document: &Document) -> Result<(), PictureError> {
    let parts = [
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<PolyData>\n<Piece ",
        &document.counts,
        ">\n<PointData>\n",
        &document.point_data,
        "</PointData>\n<CellData>\n",
        &document.cell_data,
        "</CellData>\n<Points>\n",
        &document.points,
        "</Points>\n",
        &document.lines,
        // OVITO wants nothing before the piece.
        "</Piece>\n<FieldData>\n",
        &document.field_data,
        "</FieldData>\n</PolyData>\n</VTKFile>\n",
    ];
    let write = |file: &mut (dyn Write + Send)| {
        let mut parts = parts.iter();
        let written = parts.try_for_each(|part| file.write_all(part.as_bytes()));
        written.map_err(ResultsError::unwritable(path))
    };
    Ok(publish_by(path, write)?)
}

fn grains(frame: &Frame<'_>, words: &Words) -> Result<Document, PictureError> {
    let centres = frame.centres();
    let mut document = Document::of(frame, &centres, [centres.len(), 0]);
    document.lines = cells("Verts", 1, 0..centres.len());
    document.point_data = columns(&frame.grains, words)?;
    let (ux, uy) = (frame.grains.numbers("ux")?, frame.grains.numbers("uy")?);
    let displacement = ux.into_iter().zip(uy).map(|(x, y)| Vector::new(x, y));
    let displacement: Vec<Vector> = displacement.collect();
    document.point_data += &vectors("displacement", &displacement);
    Ok(document)
}

fn contacts(frame: &Frame<'_>, words: &Words) -> Result<Document, PictureError> {
    let (points, lines) = frame.lines();
    let mut document = Document::of(frame, &points, [0, lines.len()]);
    let grains = frame.grains.len();
    let ids = (0..points.len()).map(|point| if point < grains { point as i64 } else { -1 });
    document.point_data = whole("grain", ids);
    document.cell_data = columns(&frame.contacts, words)?;
    document.lines = cells("Lines", 2, lines.into_iter().flatten());
    Ok(document)
}

/// Cells of so many points each.
fn cells(kind: &str, each: usize, points: impl Iterator<Item = usize>) -> String {
    let points: Vec<i64> = points.map(|point| point as i64).collect();
    let offsets = (1..=points.len() / each).map(|cell| (each * cell) as i64);
    let offsets = whole("offsets", offsets);
    let points = whole("connectivity", points.into_iter());
    format!("<{kind}>\n{points}{offsets}</{kind}>\n")
}

impl Document {
    fn of(frame: &Frame<'_>, points: &[Vector], [verts, lines]: [usize; 2]) -> Self {
        let number = |name: &str, kind: &str, bytes: [u8; 8]| {
            let head = format!("{name}\" NumberOfTuples=\"1");
            array(kind, &head, 1, bytes.into_iter())
        };
        Self {
            counts: format!(
                "NumberOfPoints=\"{}\" NumberOfVerts=\"{verts}\" NumberOfLines=\"{lines}\" \
                 NumberOfStrips=\"0\" NumberOfPolys=\"0\"",
                points.len()
            ),
            points: vectors("Points", points),
            field_data: number("step", "Int64", (frame.step as i64).to_le_bytes())
                + &number("load_factor", "Float64", frame.load_factor.to_le_bytes()),
            ..Self::default()
        }
    }
}

/// All columns of a table.
fn columns(table: &Columns, words: &Words) -> Result<String, PictureError> {
    let mut text = String::new();
    for name in table.names() {
        text += &match words.numbers(table, name)? {
            Numbers::Whole(numbers) => whole(name, numbers.into_iter()),
            Numbers::Real(numbers) => {
                let bytes = numbers.into_iter().flat_map(f64::to_le_bytes);
                array("Float64", name, 1, bytes)
            }
        };
    }
    Ok(text)
}

fn whole(name: &str, numbers: impl Iterator<Item = i64>) -> String {
    array("Int64", name, 1, numbers.flat_map(i64::to_le_bytes))
}

/// Vectors with a third component 0.
fn vectors(name: &str, vectors: &[Vector]) -> String {
    let components = vectors.iter().flat_map(|vector| [vector.x, vector.y, 0.0]);
    array("Float64", name, 3, components.flat_map(f64::to_le_bytes))
}

fn array(kind: &str, name: &str, components: usize, bytes: impl Iterator<Item = u8>) -> String {
    let mut all = vec![0_u8; 8];
    all.extend(bytes);
    let length = (all.len() - 8) as u64;
    all[..8].copy_from_slice(&length.to_le_bytes());
    format!(
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"binary\">{}</DataArray>\n",
        STANDARD.encode(all)
    )
}
