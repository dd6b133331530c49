//! What stands behind `kavics` on the command line.

use std::path::PathBuf;
use std::time::Duration;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use kavics_report::StepChoice;

use crate::draw_arguments::DrawArguments;
use crate::export::ExportArguments;

use crate::terminal::Loudness;

const STATUS: &str = "\
Exit status:
  0  done
  1  a validation case does not hold
  2  wrong usage, or a wrong scene, or one that the machine has no memory for
  3  no equilibrium; the results are valid up to the load step named
  4  a file could not be read or written
  75 stopped by a signal; run again with --resume";

/// More threads than any machine has, and fewer than one can start.
const MOST_THREADS: usize = 1024;

/// Quasi-static mechanics of granular and cemented assemblies
#[derive(Debug, Parser)]
#[command(name = "kavics", version, after_help = STATUS)]
pub struct Arguments {
    #[command(subcommand)]
    pub task: Task,
    /// Say nothing but errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Say more: what the solver did at each load step, every quantity that is verified
    #[arg(short, long, global = true)]
    pub verbose: bool,
}

impl Arguments {
    /// How much is said.
    pub fn loudness(&self) -> Loudness {
        match (self.quiet, self.verbose) {
            (true, _) => Loudness::Quiet,
            (_, true) => Loudness::Verbose,
            _ => Loudness::Usual,
        }
    }
}

#[derive(Debug, Subcommand)]
pub enum Task {
    /// Read and check a scene, and say what would run
    Check(CheckArguments),
    /// Place the grains of a scene, and do nothing else
    Pack(PackArguments),
    /// Find the equilibria of a scene, load step by load step
    Run(RunArguments),
    /// Measure finished results again
    Measure(MeasureArguments),
    /// Write the report of finished results: one page, no network
    Report(ReportArguments),
    /// Show results in the browser: served to this machine only, until Ctrl-C
    #[cfg(feature = "view")]
    View(ViewArguments),
    /// Draw the assembly at a load step, or curves, for a paper
    Draw(DrawArguments),
    /// Write results for other programs
    Export(ExportArguments),
    /// Run the validation cases that come with the program, on this machine
    Verify(VerifyArguments),
    /// Write the JSON Schema of the scene file to stdout
    Schema,
    /// Write completions for a shell to stdout
    Completions(CompletionsArguments),
    /// Write a manual page to stdout
    Man(ManArguments),
}

/// A scene file, and what is different from it.
#[derive(Debug, Args)]
pub struct SceneArguments {
    /// Scene file (TOML)
    pub scene: PathBuf,
    /// Replace or add a value of the scene, e.g. --set equilibrium.tolerance=1e-12 or --set stage.0.factors=[1,2]
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

#[derive(Debug, Args)]
pub struct CheckArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// One JSON object on stdout instead of the table
    #[arg(long)]
    pub json: bool,
    /// Do not refuse what this machine seems to have no memory for
    #[arg(long)]
    pub any_size: bool,
}

#[derive(Debug, Args)]
pub struct PackArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Write x, y and radius to this file (csv, parquet, extended XYZ or a LAMMPS dump, by the ending); without it csv to stdout
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Number of threads; all processors when absent
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
    /// Say how many grains were placed and how densely, instead of listing them
    #[arg(long)]
    pub summary: bool,
    /// Do not refuse what this machine seems to have no memory for
    #[arg(long)]
    pub any_size: bool,
}

#[derive(Debug, Args)]
#[allow(clippy::struct_excessive_bools)] // Each is an option of its own.
pub struct RunArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Results folder; NAME.results in the working folder when absent
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Number of threads; all processors when absent
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
    /// Replace results that are there already
    #[arg(long)]
    pub force: bool,
    /// Go on with results that were broken off or stopped, from their last checkpoint
    #[arg(long, conflicts_with = "force")]
    pub resume: bool,
    /// Least time between two checkpoints in seconds; 0: after every load step; when absent 2, and less in the first minute
    #[arg(long, value_name = "SECONDS", value_parser = seconds, overrides_with = "checkpoint")]
    pub checkpoint: Option<Duration>,
    /// One JSON object per load step on stdout
    #[arg(long)]
    pub json: bool,
    /// Run even what this machine seems to have no memory for
    #[arg(long)]
    pub any_size: bool,
}

#[derive(Debug, Args)]
pub struct MeasureArguments {
    /// Results folder
    pub results: PathBuf,
    /// Window, as in the scene: all, undisturbed, "{ x = [0, 5], y = [0, 5] }" or "{ ids = [3, 4] }"
    #[arg(long)]
    pub window: Option<String>,
    /// Write the table of load steps to this file (csv or parquet, by the ending); without it csv to stdout
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct ReportArguments {
    /// Results folder
    pub results: PathBuf,
    /// File to write; DIR/report.html when absent
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Recorded load steps in the viewer, e.g. 0,10,last; as many as fit when absent
    #[arg(long, value_name = "STEPS", value_delimiter = ',', value_parser = load_step)]
    pub steps: Option<Vec<usize>>,
}

#[cfg(feature = "view")]
#[derive(Debug, Args)]
pub struct ViewArguments {
    /// Results folder, of a run that is finished or under way
    pub results: PathBuf,
    /// Port of 127.0.0.1; any free one when absent
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub port: u16,
    /// Only print the address, and open no browser
    #[arg(long)]
    pub no_open: bool,
}

#[derive(Debug, Args)]
pub struct VerifyArguments {
    /// Cases to run; all when absent
    #[arg(value_name = "CASE")]
    pub cases: Vec<String>,
    /// One JSON object per quantity on stdout instead of the table
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct CompletionsArguments {
    /// Shell
    pub shell: Shell,
}

#[derive(Debug, Args)]
pub struct ManArguments {
    /// Task whose page is written; that of kavics when absent
    #[arg(value_name = "COMMAND", value_parser = PossibleValuesParser::new(TASKS))]
    pub task: Option<String>,
}

/// The tasks that have a manual page.
const TASKS: &[&str] = &[
    "check",
    "pack",
    "run",
    "measure",
    "report",
    #[cfg(feature = "view")]
    "view",
    "draw",
    "export",
    "verify",
    "schema",
    "completions",
    "man",
];

fn load_step(text: &str) -> Result<usize, String> {
    match text.trim() {
        "last" => Ok(StepChoice::LAST),
        number => number.parse().map_err(|_| {
            "expected numbers of load steps or \"last\", with commas between".to_owned()
        }),
    }
}

fn seconds(text: &str) -> Result<Duration, String> {
    let wrong = || "expected a number of seconds, not negative".to_owned();
    let seconds: f64 = text.parse().map_err(|_| wrong())?;
    Duration::try_from_secs_f64(seconds).map_err(|_| wrong())
}

fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count @ 1..=MOST_THREADS) => Ok(count),
        _ => Err(format!("expected a whole number from 1 to {MOST_THREADS}")),
    }
}
