//! Whether placed grains fit: beside each other, and into the container.

use std::collections::HashMap;

use super::build_grains::PlacedGrains;
use super::check_box::ShapePlan;
use super::check_grains::GrainSource;
use super::check_layers::{GrainsPlan, LayerPlan};
use super::checker::Checker;
use super::diagnostic::{Problem, short};
use super::sides::side_called;
use crate::assembly::{self, Grain};
use crate::ids::{GrainId, PerGrain};

/// How many of a list are told.
const TOLD: usize = 5;

/// Whether grains neither overlap nor leave the container by more than `tolerance`, `[length]`.
pub fn check(
    placed: &PlacedGrains,
    plan: &GrainsPlan,
    tolerance: f64,
    checker: &mut Checker,
) -> bool {
    let apart = overlaps(placed, plan, tolerance, checker);
    outside(placed, plan, tolerance, checker) && apart
}

fn list(mut told: Vec<String>, all: usize) -> String {
    if all > told.len() {
        told.push(format!("and {} more", all - told.len()));
    }
    told.join(", ")
}

fn overlaps(
    placed: &PlacedGrains,
    plan: &GrainsPlan,
    tolerance: f64,
    checker: &mut Checker,
) -> bool {
    // Grains that were packed here have no twins, and many twins would make many pairs.
    let is_listed = |layer: &LayerPlan| matches!(layer.source, GrainSource::Listed(_));
    if plan.layers.iter().any(is_listed)
        && let Some((first, second)) = same_place(&placed.grains)
    {
        checker.push(Problem::at(
            &plan.span,
            format!("grains {first} and {second} have the same centre"),
            "expected each grain once",
        ));
        return false;
    }
    let pairs = assembly::overlaps(&placed.grains, tolerance);
    if pairs.is_empty() {
        return true;
    }
    let told = pairs
        .iter()
        .take(TOLD)
        .map(|(first, second, depth)| format!("{first} and {second} by {}", short(*depth)))
        .collect();
    checker.push(
        Problem::at(
            &plan.span,
            format!("grains overlap: {}", list(told, pairs.len())),
            format!("expected no overlap above {}", short(tolerance)),
        )
        .help("`contacts.touching_tolerance` is the overlap allowed, in mean radii"),
    );
    false
}

/// Two grains with the same centre.
fn same_place(grains: &PerGrain<Grain>) -> Option<(GrainId, GrainId)> {
    let mut seen = HashMap::with_capacity(grains.len());
    grains.iter().find_map(|(id, grain)| {
        let key = (grain.centre.x.to_bits(), grain.centre.y.to_bits());
        seen.insert(key, id).map(|first| (first, id))
    })
}

fn outside(
    placed: &PlacedGrains,
    plan: &GrainsPlan,
    tolerance: f64,
    checker: &mut Checker,
) -> bool {
    let sides = placed.sides(&vec![false; checker.sides.count()]);
    let grains = assembly::outside(&placed.grains, &sides, tolerance);
    if grains.is_empty() {
        return true;
    }
    let told = grains
        .iter()
        .take(TOLD)
        .map(|(grain, side, depth)| {
            format!(
                "grain {grain} beyond {} by {}",
                side_called(&sides[*side].name),
                short(*depth)
            )
        })
        .collect();
    let size = match &placed.container.shape {
        ShapePlan::Box { width, height, .. } => {
            let height = height.unwrap_or(placed.highest);
            format!("the box is {width} wide and {height} high")
        }
        ShapePlan::Polygon(corners) => format!("the box is a polygon of {} sides", corners.len()),
    };
    checker.push(
        Problem::at(
            &plan.container.span,
            format!("grains lie outside the box: {}", list(told, grains.len())),
            size,
        )
        .and(&plan.span, "expected grains inside the box"),
    );
    false
}
