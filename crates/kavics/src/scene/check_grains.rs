//! Checks of how one layer of grains is placed.

use std::ops::Range;

use super::check_dropped::{
    DroppedPlan, Fill, FrontPlan, TargetPlan, dropped_plan, front_plan, target_plan,
};
use super::check_rows::{hexagonal_rows, square_rows};
use super::checker::Checker;
use super::diagnostic::Problem;
use super::file_grains::{DroppedFile, FrontFile, GrainsFile, LatticeFile, ListedFile, TargetFile};
use super::value::Placed;
use crate::packing::Sizes;

/// Where grains come from.
#[derive(Clone, Debug)]
pub enum GrainSource {
    /// Rows in the gaps of each other: radius and grains of each row.
    Hexagonal(f64, Vec<usize>),
    /// Rows above each other: radius, grains of a row, rows.
    Square(f64, usize, usize),
    /// Dropped.
    Dropped(DroppedPlan),
    /// Added at a front.
    AdvancingFront(FrontPlan),
    /// Of a wanted packing fraction.
    Target(TargetPlan),
    /// From a file.
    Listed(ListedPlan),
}

impl GrainSource {
    /// The sizes that its grains are to have, where they are not given one by one.
    pub fn sizes(&self) -> Option<&Sizes> {
        match self {
            Self::Dropped(plan) => Some(&plan.sizes),
            Self::AdvancingFront(plan) => Some(&plan.sizes),
            Self::Target(plan) => Some(&plan.sizes),
            Self::Hexagonal(..) | Self::Square(..) | Self::Listed(_) => None,
        }
    }

    /// The number of grains, where it is given; a list has its own.
    pub fn count(&self) -> Option<usize> {
        match self {
            Self::Hexagonal(_, rows) => Some(rows.iter().sum()),
            Self::Square(_, columns, rows) => Some(columns * rows),
            Self::Dropped(plan) => plan.count,
            Self::AdvancingFront(plan) => plan.count,
            Self::Target(_) | Self::Listed(_) => None,
        }
    }

    /// What fills a layer up to its top; none where the number of grains or their places are given.
    pub fn fill(&self) -> Option<Fill<'_>> {
        match self {
            Self::Dropped(plan) if plan.count.is_none() => Some(Fill::Dropped(plan)),
            Self::AdvancingFront(plan) => Some(Fill::Front(plan)),
            Self::Target(plan) => Some(Fill::Target(plan)),
            _ => None,
        }
    }
}

/// Grains from a file.
#[derive(Clone, Debug)]
pub struct ListedPlan {
    /// Its name.
    pub file: Placed<String>,
    /// Its frame, from 0; none: the last.
    pub frame: Option<Placed<usize>>,
    /// First and last row taken, from 0; none: all.
    pub rows: Option<Placed<[usize; 2]>>,
}

/// Where the grains of a layer come from, and where that stands in the file.
pub fn source(
    grains: &Placed<GrainsFile>,
    checker: &mut Checker,
) -> Option<(GrainSource, Range<usize>)> {
    enum Table<'a> {
        Hexagonal(&'a LatticeFile),
        Square(&'a LatticeFile),
        Dropped(&'a Placed<DroppedFile>),
        Front(&'a Placed<FrontFile>),
        Target(&'a Placed<TargetFile>),
        Listed(&'a ListedFile),
    }
    type Given<'a> = (Table<'a>, &'a Range<usize>);
    fn given<'a, T>(
        table: Option<&'a Placed<T>>,
        kind: fn(&'a Placed<T>) -> Table<'a>,
    ) -> Option<(Given<'a>, &'a Range<usize>)> {
        table.map(|table| ((kind(table), &table.span), &table.span))
    }
    let file = &grains.value;
    let alternatives = [
        (
            "hexagonal",
            given(file.hexagonal.as_ref(), |t| Table::Hexagonal(&t.value)),
        ),
        (
            "square",
            given(file.square.as_ref(), |t| Table::Square(&t.value)),
        ),
        ("dropped", given(file.dropped.as_ref(), Table::Dropped)),
        (
            "advancing-front",
            given(file.advancing_front.as_ref(), Table::Front),
        ),
        ("target", given(file.target.as_ref(), Table::Target)),
        (
            "listed",
            given(file.listed.as_ref(), |t| Table::Listed(&t.value)),
        ),
    ];
    let what = "the way grains are placed";
    let (table, span) = checker.exactly_one(&grains.span, what, alternatives)?;
    let source = match table {
        Table::Hexagonal(table) => hexagonal_rows(table, checker)
            .map(|(radius, rows)| GrainSource::Hexagonal(radius, rows)),
        Table::Square(table) => square_rows(table, checker)
            .map(|(radius, columns, rows)| GrainSource::Square(radius, columns, rows)),
        Table::Dropped(table) => dropped_plan(table, checker).map(GrainSource::Dropped),
        Table::Front(table) => front_plan(table, checker).map(GrainSource::AdvancingFront),
        Table::Target(table) => target_plan(table, checker).map(GrainSource::Target),
        Table::Listed(table) => listed_plan(table, checker).map(GrainSource::Listed),
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
    let rows = match &file.rows {
        None => None,
        Some(rows) => Some(Placed {
            value: first_and_last(rows, checker)?,
            span: rows.span.clone(),
        }),
    };
    Some(ListedPlan {
        file: file.file.clone(),
        frame,
        rows,
    })
}

fn first_and_last(rows: &Placed<Vec<Placed<i64>>>, checker: &mut Checker) -> Option<[usize; 2]> {
    let [first, last] = rows.value.as_slice() else {
        checker.push(Problem::at(
            &rows.span,
            format!("`rows` needs two numbers, not {}", rows.value.len()),
            "expected the first and the last row taken, such as `[0, 99]`",
        ));
        return None;
    };
    let first = checker.count(first, "rows", 0)?;
    let last = checker.count(last, "rows", first as i64)?;
    Some([first, last])
}
