//! Results for other programs: ParaView, OVITO, and what reads extended XYZ or LAMMPS dumps.
//!
//! In: a results folder. Out: files with the same grains and contacts, columns by the names of the tables. No mechanics
//! is computed here.

mod extxyz;
mod frames;
mod lammps;
mod vtp;
mod words;

use std::path::{Path, PathBuf};

use kavics_pictures::PictureError;
use kavics_results::ResultsFolder;

use crate::frames::Frames;

/// A format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// VTK's polygonal data in XML: grains and contacts apart, with a `.pvd` series of each.
    Vtp,
    /// Extended XYZ: grains, one file with a frame a load step.
    ExtendedXyz,
    /// Dump files of LAMMPS: grains, and active contacts as bonds.
    Lammps,
}

/// What is exported.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Format.
    pub format: Format,
    /// Recorded load steps; all of them where none is given.
    pub steps: Vec<usize>,
    /// Displacements are so many times as large as they are; 0: the assembly before loading.
    pub deformation: f64,
}

/// Writes results into a folder, which is made where there is none, and answers with the files to open.
///
/// # Errors
/// Results that cannot be read; a load step that is not recorded; files that cannot be written.
pub fn export(
    results: &ResultsFolder,
    folder: &Path,
    options: &Options,
) -> Result<Vec<PathBuf>, PictureError> {
    let frames = Frames::of(results, options)?;
    match options.format {
        Format::Vtp => vtp::write(&frames, folder),
        Format::ExtendedXyz => extxyz::write(&frames, folder),
        Format::Lammps => lammps::write(&frames, folder),
    }
}
