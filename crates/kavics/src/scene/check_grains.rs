//! Checks of box and grains.

use std::ops::Range;

use super::check_dropped::{can_be_filled, dropped_plan};
use super::checker::{Bound, Checker};
use super::diagnostic::Problem;
use super::file::{BoxFile, DroppedFile, GrainsFile, LatticeFile, ListedFile, SceneFile};
use super::unit::Dimension;
use super::value::{ListOr, Placed};

/// The box and how it is filled.
#[derive(Clone, Debug)]
pub struct GrainsPlan {
    /// Width of the box, `[length]`.
    pub width: f64,
    /// Height of the box; none: it ends at the highest grain, `[length]`.
    pub height: Option<f64>,
    /// Where the box stands in the file.
    pub box_span: Range<usize>,
    /// Where the grains stand in the file.
    pub span: Range<usize>,
    /// Where the grains come from.
    pub source: GrainSource,
}

/// Where grains come from.
#[derive(Clone, Debug)]
pub enum GrainSource {
    /// Rows in the gaps of each other: radius and grains of each row.
    Hexagonal(f64, Vec<usize>),
    /// Rows above each other: radius, grains of a row, rows.
    Square(f64, usize, usize),
    /// Dropped.
    Dropped(DroppedPlan),
    /// From a file.
    Listed(ListedPlan),
}

/// Grains from a file.
#[derive(Clone, Debug)]
pub struct ListedPlan {
    /// Its name.
    pub file: Placed<String>,
    /// Its frame, from 0; none: the last.
    pub frame: Option<Placed<usize>>,
}

/// Grains that are dropped.
#[derive(Clone, Debug)]
pub struct DroppedPlan {
    /// How many; none: until the box is full.
    pub count: Option<usize>,
    /// Their sizes.
    pub sizes: SizesPlan,
    /// Each at the lowest of so many places.
    pub tries: usize,
}

/// Sizes of grains.
#[derive(Clone, Debug)]
pub enum SizesPlan {
    /// Radii between two limits, `[length]`.
    Uniform(f64, f64),
    /// A sieve curve.
    Sieve {
        /// Diameters, `[length]`.
        diameters: Vec<f64>,
        /// Share of the mass that passes.
        passing: Vec<f64>,
        /// Mass as the cube of the diameter, not its square.
        sphere: bool,
    },
}

/// Box and grains.
pub fn grains(file: &SceneFile, checker: &mut Checker) -> Option<GrainsPlan> {
    let container = table(file.container.as_ref(), "box", "[box]", checker);
    let grains = match &file.layer {
        Some(layer) => {
            checker.refuse(&layer.span, "`[[layer]]`");
            None
        }
        None => table(
            file.grains.as_ref(),
            "grains",
            "[grains.hexagonal]",
            checker,
        ),
    };
    let size = container.and_then(|container| box_size(container, checker));
    let grains = grains?;
    let source = source(grains, checker);
    let ((width, height), (source, span)) = (size?, source?);
    let filled = matches!(&source, GrainSource::Dropped(dropped) if dropped.count.is_none());
    if filled && height.is_none() {
        let key = container?.value.height.as_ref()?;
        checker.push(
            Problem::at(
                &key.span,
                "a box that is filled with grains needs a height",
                "expected a length",
            )
            .and(&span, "no `count`: grains fall until the box is full"),
        );
        return None;
    }
    if let (GrainSource::Dropped(dropped), Some(height), true) = (&source, height, filled) {
        can_be_filled(dropped, width, height, &span, checker)?;
    }
    Some(GrainsPlan {
        width,
        height,
        box_span: container?.span.clone(),
        span,
        source,
    })
}

fn table<'a, T>(
    table: Option<&'a Placed<T>>,
    what: &str,
    name: &str,
    checker: &mut Checker,
) -> Option<&'a Placed<T>> {
    if table.is_none() {
        checker.push(Problem::at(
            &(0..0),
            format!("the scene has no {what}"),
            format!("expected a table such as `{name}` in this file"),
        ));
    }
    table
}

fn box_size(container: &Placed<BoxFile>, checker: &mut Checker) -> Option<(f64, Option<f64>)> {
    let BoxFile {
        width,
        height,
        polygon,
    } = &container.value;
    if let Some(polygon) = polygon {
        checker.refuse(&polygon.span, "a `polygon` as box");
        return None;
    }
    let mut missing = |key: &str| {
        checker.push(Problem::at(
            &container.span,
            format!("missing key `{key}`"),
            format!("`{key}` is missing here"),
        ));
    };
    if width.is_none() {
        missing("width");
    }
    if height.is_none() {
        missing("height");
    }
    let width = width
        .as_ref()
        .and_then(|w| checker.number(w, "width", Dimension::Length, Bound::Positive));
    let height = height.as_ref().and_then(|h| match Checker::as_word(h) {
        Some(word) => checker.word_or(&word, "height", &[("fit", None)], " or a length"),
        None => checker
            .number(h, "height", Dimension::Length, Bound::Positive)
            .map(Some),
    });
    Some((width?, height?))
}

fn source(
    grains: &Placed<GrainsFile>,
    checker: &mut Checker,
) -> Option<(GrainSource, Range<usize>)> {
    enum Table<'a> {
        Hexagonal(&'a LatticeFile),
        Square(&'a LatticeFile),
        Dropped(&'a Placed<DroppedFile>),
        Listed(&'a ListedFile),
    }
    let GrainsFile {
        hexagonal,
        square,
        dropped,
        listed,
    } = &grains.value;
    let alternatives = [
        (
            "hexagonal",
            hexagonal
                .as_ref()
                .map(|t| ((Table::Hexagonal(&t.value), &t.span), &t.span)),
        ),
        (
            "square",
            square
                .as_ref()
                .map(|t| ((Table::Square(&t.value), &t.span), &t.span)),
        ),
        (
            "dropped",
            dropped
                .as_ref()
                .map(|t| ((Table::Dropped(t), &t.span), &t.span)),
        ),
        (
            "listed",
            listed
                .as_ref()
                .map(|t| ((Table::Listed(&t.value), &t.span), &t.span)),
        ),
    ];
    let what = "the way grains are placed";
    let (table, span) = checker.exactly_one(&grains.span, what, alternatives)?;
    let source = match table {
        Table::Hexagonal(table) => hexagonal_rows(table, checker),
        Table::Square(table) => square_rows(table, checker),
        Table::Dropped(table) => dropped_plan(table, checker).map(GrainSource::Dropped),
        Table::Listed(file) => listed_plan(file, checker).map(GrainSource::Listed),
    };
    Some((source?, span.clone()))
}

fn listed_plan(file: &ListedFile, checker: &mut Checker) -> Option<ListedPlan> {
    let frame = match &file.frame {
        None => None,
        Some(frame) => Some(Placed {
            value: checker.count(frame, "frame", 0)?,
            span: frame.span.clone(),
        }),
    };
    Some(ListedPlan {
        file: file.file.clone(),
        frame,
    })
}

/// Row lengths, each with its place.
fn rows(file: &LatticeFile, shorter: usize, checker: &mut Checker) -> Option<Vec<Placed<usize>>> {
    let placed = |value, span: &Range<usize>| Placed {
        value,
        span: span.clone(),
    };
    match &file.rows.value {
        ListOr::List(list) if list.is_empty() => {
            checker.push(Problem::at(
                &file.rows.span,
                "`rows` is empty",
                "expected the number of grains in each row, such as `[5, 4, 5]`",
            ));
            None
        }
        ListOr::List(list) => list
            .iter()
            .map(|row| Some(placed(checker.count(row, "rows", 1)?, &row.span)))
            .collect(),
        ListOr::Table(table) => {
            let count = checker.count(&table.count, "count", 1);
            let longest = checker.count(&table.longest, "longest", 1 + shorter as i64);
            let (count, longest) = (count?, longest?);
            if count.saturating_mul(longest) > MOST_GRAINS {
                checker.push(Problem::at(
                    &file.rows.span,
                    format!("{count} rows of {longest} grains are too many"),
                    format!("expected at most {MOST_GRAINS} grains"),
                ));
                return None;
            }
            let length = |row: usize| longest - shorter * (row % 2);
            Some(
                (0..count)
                    .map(|row| placed(length(row), &file.rows.span))
                    .collect(),
            )
        }
    }
}

/// More grains than any machine holds.
const MOST_GRAINS: usize = 100_000_000;

fn hexagonal_rows(file: &LatticeFile, checker: &mut Checker) -> Option<GrainSource> {
    let radius = checker.number(&file.radius, "radius", Dimension::Length, Bound::Positive);
    let rows = rows(file, 1, checker)?;
    for (number, pair) in rows.windows(2).enumerate() {
        if pair[0].value.abs_diff(pair[1].value) % 2 == 0 {
            checker.push(
                Problem::at(
                    &pair[1].span,
                    format!(
                        "rows {} and {} have {} and {} grains",
                        number + 1,
                        number + 2,
                        pair[0].value,
                        pair[1].value
                    ),
                    "expected a length that differs from the row below by an odd number",
                )
                .help("a row of a hexagonal arrangement lies in the gaps of the row below"),
            );
            return None;
        }
    }
    total(&rows, &file.rows.span, checker)?;
    let rows = rows.iter().map(|row| row.value).collect();
    Some(GrainSource::Hexagonal(radius?, rows))
}

fn square_rows(file: &LatticeFile, checker: &mut Checker) -> Option<GrainSource> {
    let radius = checker.number(&file.radius, "radius", Dimension::Length, Bound::Positive);
    let rows = rows(file, 0, checker)?;
    let first = rows.first()?.value;
    if let Some(other) = rows.iter().find(|row| row.value != first) {
        checker.push(Problem::at(
            &other.span,
            format!("rows of {first} and of {} grains", other.value),
            "expected rows of the same length in a square arrangement",
        ));
        return None;
    }
    total(&rows, &file.rows.span, checker)?;
    Some(GrainSource::Square(radius?, first, rows.len()))
}

fn total(rows: &[Placed<usize>], span: &Range<usize>, checker: &mut Checker) -> Option<()> {
    if rows.iter().map(|row| row.value).sum::<usize>() <= MOST_GRAINS {
        return Some(());
    }
    checker.push(Problem::at(
        span,
        "`rows` has too many grains",
        format!("expected at most {MOST_GRAINS} grains"),
    ));
    None
}
