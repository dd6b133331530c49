//! The force network: a line a contact, as wide as its normal force is large. Bojtár & Bagi (1989), figure 13.

use kavics::ids::Id;
use kavics_results::ResultsFolder;

use crate::PictureError;
use crate::axis::round_below;
use crate::colouring::Colouring;
use crate::draw::Sheet;
use crate::graph::{broken_lines, draw_broken};
use crate::groups::Groups;
use crate::ink::Ink;
use crate::legend::{Entry, Units};
use crate::picture::{Pen, Shape};
use crate::scenery::{Scenery, Standing};

/// Widths of lines.
const WIDTHS: usize = 24;

/// Width of the widest line in mean branch lengths, and the bounds of it, mm.
const WIDEST: f64 = 0.3;
const WIDEST_BOUNDS: [f64; 2] = [0.5, 3.0];

/// Width of the thinnest line that is still seen, mm.
const THINNEST: f64 = 0.03;

/// Forces below this share of the largest force of the run are rounding.
const ROUNDING: f64 = 1e-9;

/// The largest force that is none in a run, `[force]`: a small share of the largest normal force of a contact at the
/// recorded load steps and of the largest force of a load or move at all of them.
///
/// # Errors
/// Tables that cannot be read.
pub fn no_force(folder: &ResultsFolder) -> Result<f64, PictureError> {
    let mut largest = largest_of(&folder.actions()?.numbers("force")?);
    for step in folder.recorded_steps()? {
        largest = largest.max(largest_of(&forces(folder, step)?));
    }
    Ok(ROUNDING * largest)
}

/// The largest normal force, by size, at a recorded load step, `[force]`.
///
/// # Errors
/// A table that cannot be read.
pub fn largest_force(folder: &ResultsFolder, step: usize) -> Result<f64, PictureError> {
    Ok(largest_of(&forces(folder, step)?))
}

fn forces(folder: &ResultsFolder, step: usize) -> Result<Vec<f64>, PictureError> {
    let table = folder.some_of_contacts(step, &["normal_force"])?;
    Ok(table.numbers("normal_force")?)
}

fn largest_of(forces: &[f64]) -> f64 {
    forces
        .iter()
        .map(|force| force.abs())
        .filter(|f| f.is_finite())
        .fold(0.0, f64::max)
}

/// Forces and what they are compared with.
struct Forces {
    normal: Vec<f64>,
    /// That of the widest line.
    largest: f64,
    /// The largest that is none.
    none: f64,
    /// Width of the widest line, mm.
    widest: f64,
}

impl Forces {
    fn read(sheet: &Sheet<'_>, scenery: &Scenery<'_>) -> Result<Self, PictureError> {
        let normal = forces(scenery.folder, scenery.step)?;
        let none = no_force(scenery.folder)?;
        let mut largest = sheet.request.largest.unwrap_or_else(|| largest_of(&normal));
        if largest <= none {
            largest = 0.0;
        }
        let length = scenery.typical_length();
        Ok(Self {
            normal,
            largest,
            none,
            widest: sheet.thickness(length, WIDEST, WIDEST_BOUNDS),
        })
    }

    fn of(&self, contact: usize) -> f64 {
        self.normal.get(contact).copied().unwrap_or(f64::NAN)
    }

    /// Class of width; none for a force of no size.
    fn class(&self, force: f64) -> Option<usize> {
        let class = force.abs() / self.largest * WIDTHS as f64;
        (force.abs() > self.none).then_some((class as usize).min(WIDTHS - 1))
    }

    fn pen(&self, class: usize) -> Pen {
        let width = self.widest * (class as f64 + 0.5) / WIDTHS as f64;
        Pen {
            width: width.max(THINNEST),
            round: true,
            dash: None,
        }
    }
}

/// Draws the forces, small ones first.
pub(crate) fn draw(sheet: &mut Sheet<'_>, scenery: &Scenery<'_>) -> Result<(), PictureError> {
    let forces = Forces::read(sheet, scenery)?;
    let colouring = colouring(sheet, scenery)?;
    let mut classes: Vec<Groups> = (0..WIDTHS).map(|_| Groups::default()).collect();
    let mut idle = Vec::new();
    let mut any = [false; 2];
    for (id, contact) in scenery.contacts() {
        if scenery.standing(id) != Standing::Active {
            continue;
        }
        let line = Shape::Line(sheet.view.line(scenery.branch(contact)));
        let force = forces.of(id.index());
        let Some(class) = forces.class(force) else {
            idle.push(line);
            continue;
        };
        any[usize::from(force > 0.0)] = true;
        let given = colouring
            .as_ref()
            .map(|c| c.inks.get(id.index()).copied().flatten());
        let by_sign = if force > 0.0 {
            Ink::Tension
        } else {
            Ink::Compression
        };
        let ink = given.map_or(by_sign, |ink| ink.unwrap_or(Ink::Idle));
        classes[class].add(ink, line);
    }
    let thin = Pen::of(forces.pen(0).width.min(0.1));
    let has_idle = !idle.is_empty();
    sheet.picture.stroke(idle, Ink::Idle, thin);
    for (class, groups) in classes.into_iter().enumerate() {
        groups.stroke(&mut sheet.picture, forces.pen(class));
    }
    match &colouring {
        Some(colouring) => sheet.explain(colouring),
        None => explain_signs(sheet, any),
    }
    explain_widths(sheet, &forces);
    if has_idle && forces.largest > 0.0 {
        let pen = Pen::of(thin.width.max(0.12));
        sheet
            .entries
            .push(Entry::Line(Ink::Idle, pen, "no force".to_owned()));
    }
    if sheet.request.broken {
        let lines = broken_lines(sheet, scenery);
        draw_broken(sheet, scenery, lines);
    }
    Ok(())
}

/// Colours by a column of `contacts`, where one is wanted.
fn colouring(sheet: &Sheet<'_>, scenery: &Scenery<'_>) -> Result<Option<Colouring>, PictureError> {
    let Some(column) = &sheet.request.colour else {
        return Ok(None);
    };
    let table = scenery.folder.contacts(scenery.step)?;
    Colouring::by(&table, "contacts", column, sheet.request.range).map(Some)
}

fn explain_signs(sheet: &mut Sheet<'_>, [pressed, pulled]: [bool; 2]) {
    let mut explain = |ink, word: &str| {
        sheet
            .entries
            .push(Entry::Line(ink, Pen::of(1.0), word.to_owned()));
    };
    if pressed {
        explain(Ink::Compression, "compression");
    }
    if pulled {
        explain(Ink::Tension, "tension");
    }
    if pressed == pulled {
        return;
    }
    // Where one of them is missing, the legend still tells which.
    let other = if pressed {
        "no tension"
    } else {
        "no compression"
    };
    sheet.entries.push(Entry::Words(format!("({other})")));
}

/// Lines of two round forces.
fn explain_widths(sheet: &mut Sheet<'_>, forces: &Forces) {
    if forces.largest <= 0.0 {
        sheet
            .entries
            .push(Entry::Words("no contact carries a force".to_owned()));
        return;
    }
    let large = round_below(forces.largest);
    sheet.entries.push(Entry::Words("normal force:".to_owned()));
    for force in [0.25 * large, large] {
        let pen = Pen::of((forces.widest * force / forces.largest).max(THINNEST));
        let label = Units::with(&sheet.request.units.force, force);
        sheet.entries.push(Entry::Line(Ink::Side, pen, label));
    }
}
