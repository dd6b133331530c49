//! `kavics export`: results for other programs.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use kavics_export::{Format, Options};
use kavics_results::{ResultsFolder, check_output_folder};

use crate::failure::Failure;
use crate::scene_file::say;

#[derive(Debug, Args)]
pub struct ExportArguments {
    /// Results folder
    pub results: PathBuf,
    /// Format
    #[arg(long, value_enum)]
    pub to: To,
    /// Folder to write into; NAME-FORMAT in the working folder when absent
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Recorded load step, any number of times; all of them when absent
    #[arg(long, value_name = "N")]
    pub step: Vec<usize>,
    /// Displacements so many times as large as they are; 1 when absent, 0 for the places before loading
    #[arg(
        long,
        value_name = "TIMES",
        default_value_t = 1.0,
        hide_default_value = true,
        value_parser = crate::draw_arguments::finite,
        allow_hyphen_values = true
    )]
    pub scale: f64,
}

/// Formats.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum To {
    /// VTK's polygonal data, for ParaView and OVITO
    Vtp,
    /// Extended XYZ
    Extxyz,
    /// Dump files of LAMMPS, grains and bonds
    Lammps,
}

pub fn export(arguments: &ExportArguments) -> Result<(), Failure> {
    let results = ResultsFolder::open(&arguments.results)?;
    // Refuses tables of a later version.
    results.record()?;
    let (format, name) = match arguments.to {
        To::Vtp => (Format::Vtp, "vtp"),
        To::Extxyz => (Format::ExtendedXyz, "extxyz"),
        To::Lammps => (Format::Lammps, "lammps"),
    };
    let usual = || usual_folder(&arguments.results, name);
    let folder = arguments.output.clone().unwrap_or_else(usual);
    check_output_folder(&folder)?;
    let options = Options {
        format,
        steps: arguments.step.clone(),
        deformation: arguments.scale,
    };
    for file in kavics_export::export(&results, &folder, &options)? {
        say(&format!("{}\n", file.display()));
    }
    Ok(())
}

/// `NAME-FORMAT` in the working folder, for results in `NAME.results`.
fn usual_folder(results: &Path, format: &str) -> PathBuf {
    let name = results.file_stem().unwrap_or_default().to_string_lossy();
    let name = if name.is_empty() {
        "results".into()
    } else {
        name
    };
    PathBuf::from(format!("{name}-{format}"))
}
