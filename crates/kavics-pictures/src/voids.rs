//! The void cells of the contact graph.

use kavics::geometry::Vector;
use kavics::ids::Id;
use kavics::measure::{VoidCell, VoidCells};

use crate::PictureError;
use crate::colouring::{Colouring, Key};
use crate::draw::Sheet;
use crate::ground::draw_rims;
use crate::groups::Groups;
use crate::ink::{ColourMap, Ink, SHADES};
use crate::picture::{Pen, Shape};
use crate::scenery::{Scenery, Standing};

/// A number of a void cell.
type Number = fn(&VoidCell) -> f64;

/// What colours void cells: names of columns of the table `voids`, and their numbers.
const COLUMNS: [(&str, Number); 6] = [
    ("order", |cell| cell.order as f64),
    ("area", |cell| cell.area),
    ("void_area", |cell| cell.void_area),
    ("islands", |cell| cell.islands as f64),
    ("rattlers", |cell| cell.rattlers as f64),
    ("anisotropy", |cell| cell.shape.deviator()),
];

/// Orders with a colour of their own, from 3 on; the last one stands for all above.
const ORDERS: usize = 6;

/// Draws the void cells, in colours of their order where nothing else is wanted.
pub(crate) fn draw(sheet: &mut Sheet<'_>, scenery: &Scenery<'_>) -> Result<(), PictureError> {
    let cells = scenery.layout.void_cells(&scenery.state);
    let colouring = match sheet.request.colour.as_deref() {
        None | Some("order") => by_order(&cells.cells),
        Some(column) => by_column(sheet, &cells.cells, column)?,
    };
    let mut areas: Vec<usize> = (0..cells.cells.len()).collect();
    // Islands lie on top of the cells around them.
    areas.sort_by(|&a, &b| size(scenery, &cells, b).total_cmp(&size(scenery, &cells, a)));
    let mut drawn = Groups::default();
    let mut last = None;
    for cell in areas {
        let ink = colouring.inks[cell].unwrap_or(Ink::Idle);
        let has_island = cells.cells[cell].islands > 0;
        if has_island || last == Some(true) {
            std::mem::take(&mut drawn).fill(&mut sheet.picture);
        }
        last = Some(has_island);
        drawn.add(ink, Shape::Polygon(outline(sheet, scenery, &cells, cell)));
    }
    drawn.fill(&mut sheet.picture);
    draw_contacts(sheet, scenery);
    draw_rims(sheet, scenery);
    sheet.explain(&colouring);
    Ok(())
}

/// Area within the loop of a cell, islands not taken out, `[length²]`.
fn size(scenery: &Scenery<'_>, cells: &VoidCells, cell: usize) -> f64 {
    let points: Vec<Vector> = cells
        .around(cell)
        .map(|grain| scenery.centres[grain.index()])
        .collect();
    kavics::assembly::twice_area(&points)
}

fn outline(
    sheet: &Sheet<'_>,
    scenery: &Scenery<'_>,
    cells: &VoidCells,
    cell: usize,
) -> Vec<Vector> {
    let around = cells.around(cell);
    around
        .map(|grain| sheet.view.point(scenery.centres[grain.index()]))
        .collect()
}

fn draw_contacts(sheet: &mut Sheet<'_>, scenery: &Scenery<'_>) {
    let active = scenery.contacts().filter(|(id, contact)| {
        scenery.standing(*id) == Standing::Active && !contact.touches_side()
    });
    let line = |(_, contact)| Shape::Line(sheet.view.line(scenery.branch(contact)));
    let lines = active.map(line).collect();
    let width = sheet.thickness(scenery.typical_length(), 0.03, [0.03, 0.25]);
    sheet.picture.stroke(
        lines,
        Ink::Paper,
        Pen {
            round: true,
            ..Pen::of(width)
        },
    );
}

fn by_order(cells: &[VoidCell]) -> Colouring {
    let class = |cell: &VoidCell| cell.order.saturating_sub(3).min(ORDERS - 1);
    let ink = |class: usize| {
        let shade = class * usize::from(SHADES - 1) / (ORDERS - 1);
        Ink::Shade(ColourMap::Depth, shade as u8)
    };
    let name = |class: usize| match class {
        5 => "8 and more".to_owned(),
        class => (class + 3).to_string(),
    };
    let largest = cells.iter().map(class).max();
    let classes = 0..largest.map_or(0, |class| class + 1);
    Colouring {
        title: "contacts around a void cell".to_owned(),
        inks: cells.iter().map(|cell| Some(ink(class(cell)))).collect(),
        key: Key::Words(classes.map(|class| (ink(class), name(class))).collect()),
    }
}

fn by_column(
    sheet: &Sheet<'_>,
    cells: &[VoidCell],
    column: &str,
) -> Result<Colouring, PictureError> {
    let known = COLUMNS.map(|(name, _)| name);
    let found = COLUMNS.iter().find(|(name, _)| *name == column);
    let (name, number) = found.ok_or_else(|| PictureError::no_column("voids", column, &known))?;
    let numbers: Vec<f64> = cells.iter().map(number).collect();
    let title = format!("{} of a void cell", name.replace('_', " "));
    Ok(Colouring::of_numbers(title, &numbers, sheet.request.range))
}
