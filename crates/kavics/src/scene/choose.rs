//! Choices of grains, found among the placed grains.

use super::checker::Checker;
use super::diagnostic::{Problem, short};
use super::loading_plan::{ChoiceKind, ChoicePlan};
use super::sides::edge_called;
use super::value::Placed;
use crate::assembly::{Assembly, Grain, outer_grains};
use crate::geometry::Vector;
use crate::ids::{GrainId, PerGrain, SideId};

/// The grains of a choice, in the order of their ids; none is an error.
pub fn choose(
    choice: &ChoicePlan,
    assembly: &Assembly,
    tolerance: f64,
    checker: &mut Checker,
) -> Vec<GrainId> {
    let grains = &assembly.grains;
    let chosen = match &choice.kind {
        ChoiceKind::Ids(ids) => return by_id(ids, grains, checker),
        ChoiceKind::Edge(edge) => touching(SideId(*edge as u32), assembly, tolerance),
        ChoiceKind::Within(ranges) => within(grains, |centre| ranges.contain(centre)),
        ChoiceKind::Boundary => outer_grains(assembly),
    };
    if chosen.is_empty() {
        let expected = match &choice.kind {
            ChoiceKind::Edge(edge) => nearest(SideId(*edge as u32), assembly),
            _ => where_centres_lie(grains),
        };
        checker.push(Problem::at(
            &choice.span,
            "this choice names no grain",
            expected,
        ));
    }
    chosen
}

/// Grains by id, each checked.
pub fn by_id(ids: &[Placed<i64>], grains: &PerGrain<Grain>, checker: &mut Checker) -> Vec<GrainId> {
    let mut chosen = Vec::new();
    for id in ids {
        match u32::try_from(id.value) {
            Ok(found) if (found as usize) < grains.len() => chosen.push(GrainId(found)),
            _ => checker.push(Problem::at(
                &id.span,
                format!("there is no grain {}", id.value),
                format!("expected an id from 0 to {}", grains.len() - 1),
            )),
        }
    }
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

/// Grains with their centre where it should be.
pub fn within(grains: &PerGrain<Grain>, contain: impl Fn(Vector) -> bool) -> Vec<GrainId> {
    grains
        .iter()
        .filter(|(_, grain)| contain(grain.centre))
        .map(|(id, _)| id)
        .collect()
}

/// What the centres of the grains span, as an expectation.
pub fn where_centres_lie(grains: &PerGrain<Grain>) -> String {
    let span = |value: fn(&Grain) -> f64| {
        grains
            .values()
            .iter()
            .map(value)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
                [low.min(v), high.max(v)]
            })
    };
    let ([left, right], [low, high]) = (span(|g| g.centre.x), span(|g| g.centre.y));
    format!(
        "centres of grains lie at x from {} to {}, y from {} to {}",
        short(left),
        short(right),
        short(low),
        short(high)
    )
}

fn gap(side: SideId, assembly: &Assembly, grain: &Grain) -> f64 {
    assembly.sides[side].distance(grain.centre) - grain.radius
}

fn touching(side: SideId, assembly: &Assembly, tolerance: f64) -> Vec<GrainId> {
    assembly
        .grains
        .iter()
        .filter(|(_, grain)| gap(side, assembly, grain) <= tolerance)
        .map(|(id, _)| id)
        .collect()
}

fn nearest(side: SideId, assembly: &Assembly) -> String {
    let gaps = assembly
        .grains
        .iter()
        .map(|(id, grain)| (gap(side, assembly, grain), id));
    let name = &assembly.sides[side].name;
    match gaps.min_by(|a, b| a.0.total_cmp(&b.0)) {
        Some((gap, id)) => {
            format!(
                "the grain nearest to {} is {id}, at a gap of {}",
                edge_called(name),
                short(gap)
            )
        }
        None => "there is no grain".to_owned(),
    }
}
