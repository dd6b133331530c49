//! Checks of a choice of grains.

use super::check_contacts::{Ranges, optional_range};
use super::checker::Checker;
use super::diagnostic::Problem;
use super::file::ChoiceFile;
use super::loading_plan::{ChoiceKind, ChoicePlan};
use super::value::Placed;

/// A choice of grains.
pub fn choice(table: &Placed<ChoiceFile>, checker: &mut Checker) -> Option<ChoicePlan> {
    enum Kind<'a> {
        Edge(&'a Placed<String>),
        Ids(&'a Placed<Vec<Placed<i64>>>),
        Ranges,
        Boundary(&'a Placed<bool>),
    }
    let ChoiceFile {
        edge,
        ids,
        x,
        y,
        boundary,
    } = &table.value;
    let alternatives = [
        ("edge", edge.as_ref().map(|e| (Kind::Edge(e), &e.span))),
        ("ids", ids.as_ref().map(|i| (Kind::Ids(i), &i.span))),
        (
            "x, y",
            x.as_ref().or(y.as_ref()).map(|r| (Kind::Ranges, &r.span)),
        ),
        (
            "boundary",
            boundary.as_ref().map(|b| (Kind::Boundary(b), &b.span)),
        ),
    ];
    let kind = match checker.exactly_one(&table.span, "the choice of grains", alternatives)? {
        Kind::Edge(edge) => ChoiceKind::Edge(checker.side(edge, "edge")?),
        Kind::Ids(ids) if ids.value.is_empty() => {
            checker.push(Problem::at(
                &ids.span,
                "`ids` names no grain",
                "expected ids of grains",
            ));
            return None;
        }
        Kind::Ids(ids) => ChoiceKind::Ids(ids.value.clone()),
        Kind::Ranges => {
            let x = optional_range(x.as_ref(), "x", checker);
            let y = optional_range(y.as_ref(), "y", checker);
            ChoiceKind::Within(Ranges { x: x?, y: y? })
        }
        Kind::Boundary(boundary) if boundary.value => ChoiceKind::Boundary,
        Kind::Boundary(boundary) => {
            checker.push(Problem::at(
                &boundary.span,
                "`boundary = false` names no grain",
                "expected `true`",
            ));
            return None;
        }
    };
    Some(ChoicePlan {
        kind,
        span: table.span.clone(),
    })
}
