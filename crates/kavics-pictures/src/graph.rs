//! The contact graph: grains as nodes, contacts as lines.

use kavics::ids::Id;

use crate::PictureError;
use crate::colouring::Colouring;
use crate::draw::Sheet;
use crate::groups::Groups;
use crate::ink::Ink;
use crate::legend::{Entry, cross};
use crate::picture::{Pen, Shape};
use crate::scenery::{Scenery, Standing};

/// Width of a line in mean branch lengths, and its bounds, mm.
const LINE: f64 = 0.045;
const LINE_BOUNDS: [f64; 2] = [0.05, 0.45];

/// Nodes of a smaller radius are not drawn, mm.
const SMALLEST_NODE: f64 = 0.12;

/// Draws the contact graph.
pub(crate) fn draw(sheet: &mut Sheet<'_>, scenery: &Scenery<'_>) -> Result<(), PictureError> {
    let colouring = contact_colouring(sheet, scenery)?;
    let width = sheet.thickness(scenery.typical_length(), LINE, LINE_BOUNDS);
    let mut active = Groups::default();
    let mut open = Vec::new();
    for (id, contact) in scenery.contacts() {
        let line = Shape::Line(sheet.view.line(scenery.branch(contact)));
        match scenery.standing(id) {
            Standing::Active => active.add(ink_of(colouring.as_ref(), id.index()), line),
            Standing::Open => open.push(line),
            Standing::Broken => {}
        }
    }
    let dashed = Pen {
        dash: Some([3.0 * width, 2.5 * width]),
        ..Pen::of(0.7 * width)
    };
    let has_open = !open.is_empty();
    sheet.picture.stroke(open, Ink::Idle, dashed);
    active.stroke(
        &mut sheet.picture,
        Pen {
            round: true,
            ..Pen::of(width)
        },
    );
    draw_nodes(sheet, scenery, width);
    match &colouring {
        Some(colouring) => sheet.explain(colouring),
        None => sheet.entries.push(Entry::Line(
            Ink::Contact,
            Pen::of(0.3),
            "contact".to_owned(),
        )),
    }
    if has_open {
        let pen = Pen {
            dash: Some([0.9, 0.75]),
            ..Pen::of(0.3)
        };
        sheet
            .entries
            .push(Entry::Line(Ink::Idle, pen, "open contact".to_owned()));
    }
    let lines = broken_lines(sheet, scenery);
    draw_broken(sheet, scenery, lines);
    Ok(())
}

fn draw_nodes(sheet: &mut Sheet<'_>, scenery: &Scenery<'_>, width: f64) {
    let radius = 1.6 * width;
    if radius >= SMALLEST_NODE {
        let centres = scenery.centres.iter().filter(|centre| centre.x.is_finite());
        let dot = |&centre| Shape::Circle(sheet.view.point(centre), radius);
        let nodes = centres.map(dot).collect();
        sheet.picture.fill(nodes, Ink::Contact);
    }
}

/// The colours of the contacts, where a column is wanted.
pub(crate) fn contact_colouring(
    sheet: &Sheet<'_>,
    scenery: &Scenery<'_>,
) -> Result<Option<Colouring>, PictureError> {
    let Some(column) = &sheet.request.colour else {
        return Ok(None);
    };
    let table = scenery.folder.contacts(scenery.step)?;
    Colouring::by(&table, "contacts", column, sheet.request.range).map(Some)
}

/// The ink of a contact.
pub(crate) fn ink_of(colouring: Option<&Colouring>, contact: usize) -> Ink {
    match colouring {
        Some(colouring) => colouring
            .inks
            .get(contact)
            .copied()
            .flatten()
            .unwrap_or(Ink::Idle),
        None => Ink::Contact,
    }
}

/// Contacts whose bond broke: those that are gone, and all of them.
pub(crate) struct BrokenLines {
    gone: Vec<Shape>,
    crosses: Vec<Shape>,
}

/// Lines that are gone, and a cross where a bond broke.
pub(crate) fn broken_lines(sheet: &Sheet<'_>, scenery: &Scenery<'_>) -> BrokenLines {
    let arm = sheet.thickness(scenery.typical_length(), 0.1, [0.25, 1.2]);
    let mut lines = BrokenLines {
        gone: Vec::new(),
        crosses: Vec::new(),
    };
    for (id, contact) in scenery.contacts() {
        let standing = scenery.standing(id);
        if standing != Standing::Broken && !scenery.has_broken(id) {
            continue;
        }
        let ends = sheet.view.line(scenery.branch(contact));
        if standing == Standing::Broken {
            lines.gone.push(Shape::Line(ends));
        }
        lines.crosses.extend(cross((ends[0] + ends[1]) * 0.5, arm));
    }
    lines
}

/// Draws what broke.
pub(crate) fn draw_broken(sheet: &mut Sheet<'_>, scenery: &Scenery<'_>, lines: BrokenLines) {
    if lines.crosses.is_empty() {
        return;
    }
    let width = sheet.thickness(scenery.typical_length(), 0.03, [0.07, 0.3]);
    let dashed = Pen {
        dash: Some([3.0 * width, 2.5 * width]),
        ..Pen::of(0.8 * width)
    };
    sheet.picture.stroke(lines.gone, Ink::Broken, dashed);
    sheet
        .picture
        .stroke(lines.crosses, Ink::Broken, Pen::of(1.3 * width));
    sheet.entries.push(Entry::Cross("broken".to_owned()));
}
