//! Where the work went: energies over the load path, one on top of the other.

use std::fmt::Write;

use kavics_results::Columns;

use crate::ReportError;
use crate::axis::Axis;
use crate::curves::{Abscissa, Figure, LegendEntry};
use crate::number::brief;
use crate::plot::{
    LEFT, RIGHT, WIDTH, draw_abscissa, draw_heights, draw_labels, escape, height, start,
};

/// What stands above the figures.
pub(crate) const NOTE: &str = "Since the start of the run. The areas lie on one another, what was given back below \
    zero; together they are the external work, up to the ledger error.";

/// Column, name and colour of what the work goes into, from the lowest.
const PARTS: [(&str, &str, usize); 5] = [
    ("elastic_energy", "elastic", 2),
    ("nonpotential_work", "non-potential", 6),
    ("friction_work", "friction", 3),
    ("release_energy", "release", 5),
    ("fracture_energy", "fracture", 1),
];
/// Less than this share of the largest is hardly seen.
const SLIGHT: f64 = 0.02;
/// Colour of the external work.
const WORK: usize = 4;

/// One of several energies that are drawn on one another.
struct Part {
    name: &'static str,
    colour: usize,
    values: Vec<f64>,
}

/// Energies over the load path: all of them, and those that are not given back.
pub(crate) fn figures(steps: &Columns, over: &Abscissa) -> Result<Vec<Figure>, ReportError> {
    let mut parts = Vec::new();
    for (column, name, colour) in PARTS {
        let values = from_zero(steps.numbers(column)?);
        if values.iter().any(|&value| value != 0.0) {
            parts.push(Part {
                name,
                colour,
                values,
            });
        }
    }
    let work = from_zero(steps.numbers("external_work")?);
    let errors = from_zero(steps.numbers("ledger_error")?);
    let places = from_zero(over.values.clone());
    let mut all = figure("Work and energy", over.label, &places, &parts, Some(&work));
    all.note = ledger_note(&work, &errors);
    let lost: Vec<Part> = parts.into_iter().filter(|p| p.name != "elastic").collect();
    let mut figures = vec![all];
    if !lost.is_empty() {
        let title = "Beside the elastic energy";
        figures.push(figure(title, over.label, &places, &lost, None));
    }
    Ok(figures)
}

/// Load step 0, before which nothing was done, goes first.
fn from_zero(values: Vec<f64>) -> Vec<f64> {
    [0.0].into_iter().chain(values).collect()
}

/// The largest ledger error, over the largest work until then.
fn ledger_note(work: &[f64], errors: &[f64]) -> String {
    let mut done = 0.0_f64;
    let shares = work.iter().zip(errors).map(|(work, error)| {
        done = done.max(work.abs());
        if *error == 0.0 {
            0.0
        } else {
            error.abs() / done
        }
    });
    let largest = shares.fold(0.0, f64::max);
    format!(
        "Ledger error at most {} of the external work.",
        brief(largest)
    )
}

fn figure(
    title: &str,
    x_label: &str,
    places: &[f64],
    parts: &[Part],
    work: Option<&[f64]>,
) -> Figure {
    let mut legend: Vec<LegendEntry> = work
        .iter()
        .map(|_| LegendEntry {
            name: "external work".to_owned(),
            colour: WORK,
            dashed: false,
            filled: false,
        })
        .collect();
    legend.extend(parts.iter().rev().map(|part| LegendEntry {
        name: part.name.to_owned(),
        colour: part.colour,
        dashed: false,
        filled: true,
    }));
    Figure {
        title: title.to_owned(),
        svg: draw(x_label, places, parts, work),
        legend,
        note: String::new(),
    }
}

/// The lower and upper edge of each part: what is positive goes up from zero, what is negative down.
fn edges(parts: &[Part], count: usize) -> Vec<[Vec<f64>; 2]> {
    let mut reached = [vec![0.0; count], vec![0.0; count]];
    let mut all = Vec::new();
    for part in parts {
        for (sense, sign) in [1.0, -1.0].into_iter().enumerate() {
            let from = reached[sense].clone();
            for (reached, value) in reached[sense].iter_mut().zip(&part.values) {
                *reached += sign * (sign * value).max(0.0);
            }
            all.push([from, reached[sense].clone()]);
        }
    }
    all
}

/// The axes, and the load path along the horizontal one.
struct Frame<'a> {
    x: Axis,
    y: Axis,
    places: &'a [f64],
}

impl Frame<'_> {
    fn left(&self, place: f64) -> f64 {
        LEFT + self.x.share(place) * (WIDTH - LEFT - RIGHT)
    }

    fn points(&self, values: &[f64]) -> Vec<String> {
        let pairs = self.places.iter().zip(values);
        pairs
            .map(|(&place, &value)| {
                format!("{:.1} {:.1}", self.left(place), height(&self.y, value))
            })
            .collect()
    }
}

fn draw(x_label: &str, places: &[f64], parts: &[Part], work: Option<&[f64]>) -> String {
    let edges = edges(parts, places.len());
    let heights = edges.iter().flatten().flatten();
    let heights = heights.chain(work.into_iter().flatten()).copied();
    let most = heights.clone().map(f64::abs).fold(0.0, f64::max);
    // What would hardly be seen below zero makes no room there.
    let seen = heights.filter(|height| height.abs() >= SLIGHT * most);
    let frame = Frame {
        x: Axis::over(places.iter().copied(), 5.0),
        y: Axis::over(seen.chain([0.0]), 5.0),
        places,
    };
    let mut svg = start(x_label, "force × length");
    draw_heights(&mut svg, &frame.y);
    for (pair, part) in edges.chunks(2).zip(parts) {
        for edges in pair.iter().filter(|[from, to]| from != to) {
            draw_area(&mut svg, &frame, edges, part);
        }
    }
    if let Some(work) = work {
        let line = frame.points(work).join("L");
        let _ = write!(
            svg,
            "<path class=\"line c{WORK}\" stroke-width=\"1.8\" d=\"M{line}\"/>"
        );
    }
    for tick in frame.x.ticks() {
        draw_abscissa(&mut svg, frame.left(tick.value), &tick.label, "v5");
    }
    // The line of zero stands before what is given back.
    let _ = write!(
        svg,
        "<path class=\"zero\" d=\"M{LEFT} {:.1}H{}\"/>",
        height(&frame.y, 0.0),
        WIDTH - RIGHT
    );
    draw_labels(&mut svg, x_label, "force × length");
    svg.push_str("</svg>");
    svg
}

fn draw_area(svg: &mut String, frame: &Frame<'_>, [from, to]: &[Vec<f64>; 2], part: &Part) {
    let mut outline = frame.points(to);
    outline.extend(frame.points(from).into_iter().rev());
    let _ = write!(
        svg,
        "<path class=\"area f{}\" d=\"M{}Z\"><title>{}</title></path>",
        part.colour,
        outline.join("L"),
        escape(part.name)
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(values: &[f64]) -> Part {
        Part {
            name: "part",
            colour: 0,
            values: values.to_vec(),
        }
    }

    #[test]
    fn what_is_given_back_goes_below_zero() {
        let parts = [part(&[0.0, 2.0]), part(&[0.0, -1.0]), part(&[0.0, 3.0])];
        let ends: Vec<[f64; 2]> = edges(&parts, 2)
            .iter()
            .map(|[from, to]| [from[1], to[1]])
            .collect();
        assert_eq!(
            ends,
            [
                [0.0, 2.0],
                [0.0, 0.0],
                [2.0, 2.0],
                [0.0, -1.0],
                [2.0, 5.0],
                [-1.0, -1.0]
            ]
        );
    }

    #[test]
    fn the_ledger_error_is_told_over_the_work_done_so_far() {
        let note = ledger_note(&[0.0, 4.0, 1.0], &[0.0, 1e-9, -2e-8]);
        assert_eq!(note, "Ledger error at most 5e−9 of the external work.");
    }
}
