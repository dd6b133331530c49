//! Checks of supports, weight, moves and loads.

use super::check_actions;
use super::check_choice::choice;
use super::check_contacts::freedoms;
use super::checker::{Bound, Checker};
use super::diagnostic::Problem;
use super::file::{SceneFile, SupportFile, WeightFile};
use super::loading_plan::{LoadingPlan, SupportPlan, WeightPlan};
use super::unit::Dimension;
use super::value::Placed;

/// Supports, weight, moves and loads.
pub fn loading(file: &SceneFile, checker: &mut Checker) -> Option<LoadingPlan> {
    let supports: Vec<_> = file.support.iter().map(|s| support(s, checker)).collect();
    let weight = match &file.weight {
        None => Some(None),
        Some(table) => weight(&table.value, checker),
    };
    let moves: Vec<_> = file
        .moves
        .iter()
        .map(|m| check_actions::motion(m, checker))
        .collect();
    let loads: Vec<_> = file
        .load
        .iter()
        .map(|l| check_actions::load(l, checker))
        .collect();
    names_differ(file, checker);
    Some(LoadingPlan {
        supports: supports.into_iter().collect::<Option<_>>()?,
        weight: weight?,
        moves: moves.into_iter().collect::<Option<_>>()?,
        loads: loads.into_iter().collect::<Option<_>>()?,
    })
}

fn names_differ(file: &SceneFile, checker: &mut Checker) {
    let moves = file.moves.iter().map(|table| &table.value.name);
    let loads = file.load.iter().map(|table| &table.value.name);
    let mut seen: Vec<&Placed<String>> = Vec::new();
    for name in moves.chain(loads) {
        let first = seen.iter().find(|other| other.value == name.value);
        if name.value.is_empty() {
            checker.push(Problem::at(
                &name.span,
                "a name is empty",
                "expected a name for stages",
            ));
        } else if name.value == "weight" {
            checker.push(Problem::at(
                &name.span,
                "only the weight of the grains is called `weight`",
                "expected another name",
            ));
        } else if let Some(first) = first {
            checker.push(
                Problem::at(
                    &name.span,
                    format!("two loads or moves are called `{}`", name.value),
                    "expected another name",
                )
                .and(&first.span, "the first is here"),
            );
        }
        seen.push(name);
    }
}

fn support(table: &Placed<SupportFile>, checker: &mut Checker) -> Option<SupportPlan> {
    let file = &table.value;
    let grains = choice(&file.grains, checker);
    if file.fix.value.is_empty() {
        checker.push(Problem::at(
            &file.fix.span,
            "a support that fixes nothing",
            "expected some of `x`, `y` and `rotation`",
        ));
    }
    let fix = freedoms(&file.fix.value, "fix", checker);
    Some(SupportPlan {
        grains: grains?,
        fix: fix?,
        span: table.span.clone(),
    })
}

#[expect(clippy::option_option, reason = "wrong, absent, there")]
fn weight(file: &WeightFile, checker: &mut Checker) -> Option<Option<WeightPlan>> {
    let non_negative = Bound::NonNegative;
    let density = checker.number(&file.density, "density", Dimension::Density, non_negative);
    let gravity = file.gravity.as_ref();
    let gravity = checker.number_or(
        9.81,
        gravity,
        "gravity",
        Dimension::Acceleration,
        non_negative,
    );
    let (density, gravity) = (density?, gravity?);
    Some((density * gravity > 0.0).then_some(WeightPlan { density, gravity }))
}
