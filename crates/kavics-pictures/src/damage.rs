//! Broken contacts in the order of their breaks, each a line along its dual edge.

use std::collections::HashSet;

use kavics::geometry::Vector;

use crate::PictureError;
use crate::breaks::Break;
use crate::colouring::Colouring;
use crate::draw::Sheet;
use crate::groups::Groups;
use crate::ink::{ColourMap, Ink};
use crate::legend::Entry;
use crate::picture::{Pen, Shape};
use crate::scenery::Scenery;

/// Width of a broken contact in mean branch lengths, and its bounds, mm.
const WIDTH: f64 = 0.24;
const BOUNDS: [f64; 2] = [0.35, 1.4];

/// Contacts that have not broken, about at most: no more can be told apart.
const INTACT_DRAWN: usize = 200_000;

/// What colours breaks: columns of the table `events`.
const COLUMNS: [&str; 4] = ["event", "load_factor", "step", "mode"];

/// Draws what broke over what did not.
pub(crate) fn draw(sheet: &mut Sheet<'_>, scenery: &Scenery<'_>) -> Result<(), PictureError> {
    let breaks = first_breaks(&scenery.breaks);
    let colouring = colouring(sheet, &breaks)?;
    draw_intact(sheet, scenery);
    if breaks.is_empty() {
        sheet
            .entries
            .push(Entry::Words("no contact has broken".to_owned()));
        return Ok(());
    }
    let edges = scenery.layout.dual_edges();
    let mut lines = Groups::default();
    for (bond, ink) in breaks.iter().zip(&colouring.inks) {
        let Some(contact) = scenery.layout.assembly.contacts.values().get(bond.contact) else {
            continue;
        };
        let edge = edges.values()[bond.contact];
        let ends = scenery.dual(contact, no_longer(edge, contact.branch_length));
        let line = Shape::Line(sheet.view.line(ends));
        lines.add(ink.unwrap_or(Ink::Broken), line);
    }
    let width = sheet.thickness(scenery.typical_length(), WIDTH, BOUNDS);
    lines.stroke(&mut sheet.picture, Pen::of(width));
    sheet.explain(&colouring);
    Ok(())
}

/// Each contact once.
fn first_breaks(breaks: &[Break]) -> Vec<&Break> {
    let mut known = HashSet::new();
    breaks
        .iter()
        .filter(|bond| known.insert(bond.contact))
        .collect()
}

/// A dual edge at the rim of the assembly can be long; more than the branch would hide its neighbours.
fn no_longer([from, to]: [Vector; 2], most: f64) -> [Vector; 2] {
    let length = (to - from).length();
    if length <= most {
        return [from, to];
    }
    let (middle, half) = ((from + to) * 0.5, (to - from) * (0.5 * most / length));
    [middle - half, middle + half]
}

fn draw_intact(sheet: &mut Sheet<'_>, scenery: &Scenery<'_>) {
    let intact = scenery
        .contacts()
        .filter(|(id, _)| !scenery.has_broken(*id));
    let line = |(_, contact)| Shape::Line(sheet.view.line(scenery.branch(contact)));
    let all = scenery.contacts().len();
    let lines = intact
        .step_by(all.div_ceil(INTACT_DRAWN).max(1))
        .map(line)
        .collect();
    let width = sheet.thickness(scenery.typical_length(), 0.05, [0.04, 0.3]);
    sheet.picture.stroke(lines, Ink::Idle, Pen::of(width));
    sheet.entries.push(Entry::Line(
        Ink::Idle,
        Pen::of(width.max(0.15)),
        "not broken".to_owned(),
    ));
}

/// By place in the order, unless a column is wanted.
fn colouring(sheet: &Sheet<'_>, breaks: &[&Break]) -> Result<Colouring, PictureError> {
    let range = sheet.request.range;
    let numbers = |title: &str, number: &dyn Fn(usize, &Break) -> f64| {
        let numbers = breaks.iter().enumerate();
        let numbers: Vec<f64> = numbers.map(|(place, bond)| number(place, bond)).collect();
        let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
        let most = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let [low, high] = range.unwrap_or([least, most]);
        Colouring::over(title.to_owned(), &numbers, ColourMap::Order, low..=high)
    };
    Ok(match sheet.request.colour.as_deref() {
        None | Some("event") => numbers("order of breaking", &|place, _| place as f64 + 1.0),
        Some("load_factor") => numbers("broken at load factor", &|_, bond| bond.load_factor),
        Some("step") => numbers("broken in load step", &|_, bond| bond.step as f64),
        Some("mode") => {
            let modes: Vec<&str> = breaks.iter().map(|bond| bond.mode.as_str()).collect();
            Colouring::of_words("broken by".to_owned(), &modes)
        }
        Some(other) => return Err(PictureError::no_column("events", other, &COLUMNS)),
    })
}
