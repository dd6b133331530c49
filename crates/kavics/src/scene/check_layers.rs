//! Checks of box and grains: the container and its layers, from the bottom.

use std::ops::Range;

use super::check_box::{self, BoxPlan, ShapePlan};
use super::check_grains::{GrainSource, source};
use super::checker::{Bound, Checker};
use super::diagnostic::Problem;
use super::file::SceneFile;
use super::file_grains::GrainsFile;
use super::unit::Dimension;
use super::value::{Number, Placed};

/// The container and how it is filled.
#[derive(Clone, Debug)]
pub struct GrainsPlan {
    /// The container.
    pub container: BoxPlan,
    /// The layers, from the bottom.
    pub layers: Vec<LayerPlan>,
    /// Where the grains stand in the file.
    pub span: Range<usize>,
}

/// A layer of grains.
#[derive(Clone, Debug)]
pub struct LayerPlan {
    /// Where its grains come from.
    pub source: GrainSource,
    /// Height up to which it is filled, if it is, `[length]`.
    pub top: Option<f64>,
    /// Number of its grains, where it is filled about; none where a list has them.
    pub about: Option<f64>,
    /// Where its grains stand in the file.
    pub span: Range<usize>,
}

/// Box and grains.
pub fn grains(file: &SceneFile, checker: &mut Checker) -> Option<GrainsPlan> {
    let container = match &file.container {
        None => {
            missing("box", "[box]", checker);
            None
        }
        Some(table) => check_box::container(table, checker),
    };
    let tables = tables(file, checker)?;
    let sources: Vec<_> = tables.iter().map(|table| source(table, checker)).collect();
    let sources: Vec<_> = sources.into_iter().collect::<Option<_>>()?;
    let container = container?;
    let mut layers: Vec<LayerPlan> = Vec::new();
    let mut below = container.floor();
    for (number, (table, (source, span))) in tables.iter().zip(sources).enumerate() {
        let last = number + 1 == tables.len();
        let top = if source.fill().is_none() {
            without_top(table, checker)?;
            None
        } else {
            Some(top(table, &span, last, below, &container, checker)?)
        };
        let mut about = source.count().map(|count| count as f64);
        if let (Some(fill), Some(top)) = (source.fill(), top) {
            let area = container.part(below, top).map_or(0.0, |part| part.area());
            fill.can_be_done(area, &span, checker)?;
            about = about.or(Some(fill.grains(area)));
            below = top;
        }
        layers.push(LayerPlan {
            source,
            top,
            about,
            span,
        });
    }
    let span = layers.first()?.span.clone();
    Some(GrainsPlan {
        container,
        layers,
        span,
    })
}

fn missing(what: &str, name: &str, checker: &mut Checker) {
    checker.push(Problem::at(
        &(0..0),
        format!("the scene has no {what}"),
        format!("expected a table such as `{name}` in this file"),
    ));
}

/// The tables of the layers.
fn tables<'a>(file: &'a SceneFile, checker: &mut Checker) -> Option<Vec<&'a Placed<GrainsFile>>> {
    match (&file.grains, file.layer.first()) {
        (Some(grains), Some(layer)) => {
            let (first, second) = if grains.span.start < layer.span.start {
                (&grains.span, &layer.span)
            } else {
                (&layer.span, &grains.span)
            };
            checker.push(
                Problem::at(
                    second,
                    "a scene with both `grains` and `layer`",
                    "expected only one of them",
                )
                .and(first, "the first is here")
                .help("`[grains.…]` is the short form of one `[[layer]]`"),
            );
            None
        }
        (Some(grains), None) => Some(vec![grains]),
        (None, Some(_)) => Some(file.layer.iter().collect()),
        (None, None) => {
            missing("grains", "[grains.hexagonal]", checker);
            None
        }
    }
}

/// A layer whose number of grains or places are given ends where it ends.
fn without_top(table: &Placed<GrainsFile>, checker: &mut Checker) -> Option<()> {
    let Some(top) = &table.value.top else {
        return Some(());
    };
    checker.push(Problem::at(
        &top.span,
        "a `top` for grains that do not fill their layer",
        "expected `top` beside `dropped` without `count`, `advancing-front` or `target`",
    ));
    None
}

/// The height up to which a layer is filled.
fn top(
    table: &Placed<GrainsFile>,
    span: &Range<usize>,
    last: bool,
    below: f64,
    container: &BoxPlan,
    checker: &mut Checker,
) -> Option<f64> {
    match (&table.value.top, container.top()) {
        (Some(top), ceiling) => given_top(top, below, ceiling, checker),
        (None, Some(ceiling)) if last => Some(ceiling),
        (None, None) if last => {
            let ShapePlan::Box { height_span, .. } = &container.shape else {
                return None;
            };
            checker.push(
                Problem::at(
                    height_span,
                    "a box that is filled with grains needs a height",
                    "expected a length, or `top` for the last layer",
                )
                .and(span, "grains are placed until the box is full"),
            );
            None
        }
        (None, _) => {
            checker.push(Problem::at(
                span,
                "a layer that is filled below another has no `top`",
                "expected `top`, the height up to which it is filled",
            ));
            None
        }
    }
}

fn given_top(
    number: &Number,
    below: f64,
    ceiling: Option<f64>,
    checker: &mut Checker,
) -> Option<f64> {
    let top = checker.number(number, "top", Dimension::Length, Bound::Any)?;
    let expected = match ceiling {
        _ if top <= below => format!("expected more than {below}, where it begins at the least"),
        Some(ceiling) if top > ceiling => format!("expected at most {ceiling}, where the box ends"),
        _ => return Some(top),
    };
    checker.push(Problem::at(
        &number.span,
        format!("`top` cannot be {top}"),
        expected,
    ));
    None
}
