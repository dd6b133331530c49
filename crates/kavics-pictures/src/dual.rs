//! The dual graph: the edges of the power diagram, those of contacts before the others.

use kavics::ids::Id;

use crate::PictureError;
use crate::draw::Sheet;
use crate::graph::{contact_colouring, ink_of};
use crate::groups::Groups;
use crate::ink::Ink;
use crate::legend::Entry;
use crate::picture::{Pen, Shape};
use crate::scenery::{Scenery, Standing};

/// Width of a line in mean branch lengths, and its bounds, mm.
const LINE: f64 = 0.06;
const LINE_BOUNDS: [f64; 2] = [0.06, 0.5];

/// Draws the dual graph; edges move with the mean displacement of their partners.
pub(crate) fn draw(sheet: &mut Sheet<'_>, scenery: &Scenery<'_>) -> Result<(), PictureError> {
    let colouring = contact_colouring(sheet, scenery)?;
    let width = sheet.thickness(scenery.typical_length(), LINE, LINE_BOUNDS);
    let edges = scenery.layout.dual_edges();
    let mut active = Groups::default();
    // Displaced, edges without a contact would not meet the others.
    let mut others = if sheet.request.deformation == 0.0 {
        scenery.layout.other_edges()
    } else {
        Vec::new()
    };
    for (id, contact) in scenery.contacts() {
        let ends = scenery.dual(contact, edges[id]);
        match scenery.standing(id) {
            Standing::Active => {
                let seen = sheet.view.clip(ends).map(|ends| sheet.view.line(ends));
                if let Some(ends) = seen {
                    active.add(ink_of(colouring.as_ref(), id.index()), Shape::Line(ends));
                }
            }
            Standing::Open | Standing::Broken => others.push(ends),
        }
    }
    let others = others.into_iter().filter_map(|ends| sheet.view.clip(ends));
    let others: Vec<Shape> = others
        .map(|ends| Shape::Line(sheet.view.line(ends)))
        .collect();
    let has_others = !others.is_empty();
    sheet
        .picture
        .stroke(others, Ink::Idle, Pen::of(0.7 * width));
    active.stroke(
        &mut sheet.picture,
        Pen {
            round: true,
            ..Pen::of(width)
        },
    );
    if let Some(colouring) = &colouring {
        sheet.explain(colouring);
    } else {
        let entry = Entry::Line(Ink::Contact, Pen::of(0.4), "edge of a contact".to_owned());
        sheet.entries.push(entry);
    }
    if has_others {
        let entry = Entry::Line(Ink::Idle, Pen::of(0.3), "edge without contact".to_owned());
        sheet.entries.push(entry);
    }
    Ok(())
}
