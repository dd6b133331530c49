//! What stands behind `kavics draw` on the command line.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

const ABOUT: &str = "\
Draws the assembly at a load step (--what), or curves (--curve). Vector graphics (.svg) or pixels (.png), by the ending \
of the file.";

#[derive(Debug, Args)]
#[command(long_about = ABOUT)]
pub struct DrawArguments {
    /// Results folder
    pub results: PathBuf,
    /// File to write, .svg or .png
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// What is drawn of the assembly; forces when absent
    #[arg(long, value_enum, conflicts_with = "curve")]
    pub what: Option<What>,
    /// Recorded load step; the last one when absent
    #[arg(long, value_name = "N", value_parser = step, conflicts_with = "curve")]
    pub step: Option<Step>,
    /// Colour what is drawn by a column: of contacts (forces, graph, dual), of voids, of events (damage)
    #[arg(long, value_name = "COLUMN", conflicts_with = "curve")]
    pub colour: Option<String>,
    /// Colour grains by a column of grains
    #[arg(long, value_name = "COLUMN", conflicts_with = "curve")]
    pub grains: Option<String>,
    /// Numbers where the colours begin and end; those of the column when absent
    #[arg(long, value_name = "LOW,HIGH", value_parser = range, conflicts_with = "curve", allow_hyphen_values = true)]
    pub range: Option<Range>,
    /// Draw displacements so many times as large as they are; 0 when absent
    #[arg(long, value_name = "TIMES", value_parser = finite, conflicts_with = "curve", allow_hyphen_values = true)]
    pub scale: Option<f64>,
    /// Force of the widest line, to compare pictures; the largest of the load step when absent
    #[arg(long, value_name = "FORCE", value_parser = positive, conflicts_with = "curve")]
    pub largest: Option<f64>,
    /// Mark broken contacts among the forces
    #[arg(long, conflicts_with = "curve")]
    pub broken: bool,
    /// Draw a column of steps, or NAME.force, NAME.displacement or NAME.factor of a load or move; any number of times
    #[arg(long, value_name = "COLUMN")]
    pub curve: Vec<String>,
    /// What the curves are drawn over; step when absent
    #[arg(long, value_name = "COLUMN", requires = "curve")]
    pub against: Option<String>,
    /// Width of the picture, e.g. 90mm, 19cm, 3.5in, 1200px; 140mm of an assembly, 90mm of curves when absent
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub width: Option<Length>,
    /// Pixels an inch, of .png; 300 when absent
    #[arg(long, value_name = "N", value_parser = positive)]
    pub dpi: Option<f64>,
    /// Unit of length of the scene, as the picture says it
    #[arg(
        long,
        value_name = "UNIT",
        default_value = "",
        hide_default_value = true
    )]
    pub length_unit: String,
    /// Unit of force of the scene, as the picture says it
    #[arg(
        long,
        value_name = "UNIT",
        default_value = "",
        hide_default_value = true
    )]
    pub force_unit: String,
    /// Dark on white, or light on black
    #[arg(long, value_enum, default_value = "light", hide_default_value = true)]
    pub theme: Theme,
}

/// What is drawn of the assembly.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum What {
    /// Contacts as wide as their normal forces are large
    Forces,
    /// The contact graph
    Graph,
    /// The dual graph: edges of the power diagram
    Dual,
    /// Void cells of the contact graph
    Voids,
    /// Broken contacts in the order of their breaks
    Damage,
}

/// Colours of the sheet.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Theme {
    /// Dark on white
    Light,
    /// Light on nearly black
    Dark,
}

/// A load step.
#[derive(Clone, Copy, Debug)]
pub enum Step {
    /// The last one that is recorded.
    Last,
    /// By its number.
    Number(usize),
}

/// From a number to another.
pub type Range = [f64; 2];

/// The width of a picture.
#[derive(Clone, Copy, Debug)]
pub enum Length {
    /// On paper.
    Millimetres(f64),
    /// On a screen.
    Pixels(f64),
}

fn step(text: &str) -> Result<Step, String> {
    if text == "last" {
        return Ok(Step::Last);
    }
    let number = text.parse().map(Step::Number);
    number.map_err(|_| "expected a load step, or last".to_owned())
}

fn range(text: &str) -> Result<Range, String> {
    let ends = text
        .split_once(',')
        .and_then(|(low, high)| Some([low.trim().parse().ok()?, high.trim().parse().ok()?]));
    let is_right = |ends: &Range| ends[0] < ends[1] && ends.iter().all(|end: &f64| end.is_finite());
    let expected = || "expected two rising numbers, e.g. -0.5,0.5".to_owned();
    ends.filter(is_right).ok_or_else(expected)
}

/// A number that is one.
pub fn finite(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| "expected a number".to_owned())
}

fn positive(text: &str) -> Result<f64, String> {
    let number = finite(text).ok().filter(|number| *number > 0.0);
    number.ok_or_else(|| "expected a positive number".to_owned())
}

/// How a number is a length.
type ToLength = fn(f64) -> Length;

fn length(text: &str) -> Result<Length, String> {
    let units: [(&str, ToLength); 5] = [
        ("mm", Length::Millimetres),
        ("cm", |value| Length::Millimetres(10.0 * value)),
        ("in", |value| Length::Millimetres(25.4 * value)),
        ("px", Length::Pixels),
        ("", Length::Millimetres),
    ];
    let mut found = units.iter().filter_map(|(unit, length)| {
        let number = text.strip_suffix(unit)?.trim();
        positive(number).ok().map(length)
    });
    let expected = || "expected a length, e.g. 90mm, 19cm, 3.5in or 1200px".to_owned();
    let length = found.next().ok_or_else(expected)?;
    match length {
        Length::Millimetres(30.0..=2000.0) | Length::Pixels(200.0..=20_000.0) => Ok(length),
        _ => Err("expected 30 to 2000 mm, or 200 to 20000 px".to_owned()),
    }
}
