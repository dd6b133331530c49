//! The ground of every picture: grains and the sides of the container.

use crate::PictureError;
use crate::colouring::Colouring;
use crate::draw::{Sheet, What};
use crate::groups::Groups;
use crate::ink::Ink;
use crate::legend::Entry;
use crate::picture::{Pen, Shape};
use crate::scenery::Scenery;

/// Grains of a smaller mean radius on the sheet have no outline, mm.
const SMALLEST_OUTLINED: f64 = 0.25;

/// Grains of a smaller mean radius on the sheet are not drawn at all, unless a column colours them, mm.
const SMALLEST_DRAWN: f64 = 0.06;

/// Draws sides and grains.
pub(crate) fn draw_ground(
    sheet: &mut Sheet<'_>,
    scenery: &Scenery<'_>,
) -> Result<(), PictureError> {
    draw_sides(sheet, scenery);
    match &sheet.request.grains {
        Some(column) => draw_coloured(sheet, scenery, column),
        // Void cells cover the grains.
        None if sheet.request.what == What::Voids => Ok(()),
        None => draw_plain(sheet, scenery),
    }
}

/// Outlines of the grains, where they are large enough to be seen.
pub(crate) fn draw_rims(sheet: &mut Sheet<'_>, scenery: &Scenery<'_>) {
    let radius = scenery.layout.assembly.mean_radius();
    if sheet.view.length(radius) >= SMALLEST_OUTLINED {
        let width = sheet.thickness(radius, 0.03, [0.05, 0.2]);
        let discs = discs(sheet, scenery, |_| true);
        sheet.picture.stroke(discs, Ink::Rim, Pen::of(width));
    }
}

fn draw_plain(sheet: &mut Sheet<'_>, scenery: &Scenery<'_>) -> Result<(), PictureError> {
    let radius = sheet.view.length(scenery.layout.assembly.mean_radius());
    if radius < SMALLEST_DRAWN {
        return Ok(());
    }
    let table = scenery.folder.some_of_grains(scenery.step, &["state"])?;
    let states = table.texts("state")?;
    let is_held = |grain: usize| states.get(grain) == Some(&"held");
    let free = discs(sheet, scenery, |grain| !is_held(grain));
    sheet.picture.fill(free, Ink::Grain);
    let held = discs(sheet, scenery, is_held);
    if !held.is_empty() {
        sheet
            .entries
            .push(Entry::Disc(Ink::Held, "held".to_owned()));
    }
    sheet.picture.fill(held, Ink::Held);
    draw_rims(sheet, scenery);
    Ok(())
}

fn draw_coloured(
    sheet: &mut Sheet<'_>,
    scenery: &Scenery<'_>,
    column: &str,
) -> Result<(), PictureError> {
    let table = scenery.folder.grains(scenery.step)?;
    let colouring = Colouring::by(&table, "grains", column, sheet.request.range)?;
    let mut groups = Groups::default();
    for (grain, shape) in discs(sheet, scenery, |_| true).into_iter().enumerate() {
        let ink = colouring.inks.get(grain).copied().flatten();
        groups.add(ink.unwrap_or(Ink::Grain), shape);
    }
    groups.fill(&mut sheet.picture);
    sheet.explain(&colouring);
    draw_rims(sheet, scenery);
    Ok(())
}

fn discs(sheet: &Sheet<'_>, scenery: &Scenery<'_>, wanted: impl Fn(usize) -> bool) -> Vec<Shape> {
    let grains = scenery.grains().iter().zip(&scenery.centres).enumerate();
    grains
        .filter(|(grain, (_, centre))| wanted(*grain) && centre.x.is_finite())
        .map(|(_, (grain, &centre))| {
            Shape::Circle(sheet.view.point(centre), sheet.view.length(grain.radius))
        })
        .collect()
}

/// Sides that grains can touch are thick; the others only bound the dual graph.
fn draw_sides(sheet: &mut Sheet<'_>, scenery: &Scenery<'_>) {
    let (mut present, mut absent) = (Vec::new(), Vec::new());
    for (ends, is_present) in scenery.sides() {
        if let Some(ends) = sheet.view.clip(ends) {
            let line = Shape::Line(sheet.view.line(ends));
            if is_present {
                &mut present
            } else {
                &mut absent
            }
            .push(line);
        }
    }
    sheet.picture.stroke(absent, Ink::Grid, Pen::of(0.12));
    let pen = Pen {
        width: 0.45,
        round: true,
        dash: None,
    };
    sheet.picture.stroke(present, Ink::Side, pen);
}
