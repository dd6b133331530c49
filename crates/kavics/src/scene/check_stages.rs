//! Checks of the stages: which actions take which factors.

use super::checker::{Bound, Checker};
use super::diagnostic::{Problem, either, likely};
use super::file::{SceneFile, SeriesFile, StageFile};
use super::loading_plan::LoadingPlan;
use super::unit::Dimension;
use super::value::{ListOr, Number, Placed};
use crate::loading::{Action, Stage};
use crate::warning::WarningKind;

/// The actions of a scene, moves first, then loads, then the weight.
pub fn actions(plan: &LoadingPlan) -> Vec<Action> {
    let moves = plan.moves.iter().map(|m| m.name.value.clone());
    let loads = plan.loads.iter().map(|l| l.name.value.clone());
    let weight = plan.weight.map(|_| "weight".to_owned());
    moves
        .chain(loads)
        .chain(weight)
        .map(|name| Action { name })
        .collect()
}

/// The stages in order.
pub fn stages(file: &SceneFile, actions: &[Action], checker: &mut Checker) -> Option<Vec<Stage>> {
    if file.stage.is_empty() && !actions.is_empty() {
        let load = file.load.first().map(|l| &l.value.name.span);
        let motion = file.moves.first().map(|m| &m.value.name.span);
        let weight = file.weight.as_ref().map(|w| &w.span);
        let span = motion.or(load).or(weight).cloned().unwrap_or(0..0);
        checker.push(
            Problem::at(
                &span,
                "the scene has no stage",
                "expected a `[[stage]]` that applies this",
            )
            .help("write `[[stage]]` with `factors = [1.0]` to apply all loads and moves once"),
        );
        return None;
    }
    let mut last = vec![0.0; actions.len()];
    let stages: Vec<Option<Stage>> = file
        .stage
        .iter()
        .enumerate()
        .map(|(number, table)| stage(number, table, actions, &mut last, checker))
        .collect();
    let stages: Vec<Stage> = stages.into_iter().collect::<Option<_>>()?;
    for (index, action) in actions.iter().enumerate() {
        if !stages.iter().any(|stage| stage.actions.contains(&index)) {
            checker.warn(
                WarningKind::ActionUnused,
                format!("no stage applies `{}`: it stays at zero", action.name),
            );
        }
    }
    Some(stages)
}

fn stage(
    number: usize,
    table: &Placed<StageFile>,
    actions: &[Action],
    last: &mut [f64],
    checker: &mut Checker,
) -> Option<Stage> {
    if actions.is_empty() {
        checker.push(Problem::at(
            &table.span,
            "a stage, but nothing that it could apply",
            "expected a `[[load]]`, a `[[move]]` or a `[weight]` in this file",
        ));
        return None;
    }
    let name = name(number, table, checker);
    let applied = applied(table, actions, checker);
    let factors = match &table.value.factors.value {
        ListOr::List(list) if list.is_empty() => {
            checker.push(Problem::at(
                &table.value.factors.span,
                "`factors` is empty",
                "expected at least one number, such as `[1.0]`",
            ));
            None
        }
        ListOr::List(list) => list
            .iter()
            .map(|factor| checker.number(factor, "factors", Dimension::Number, Bound::Any))
            .collect(),
        ListOr::Table(series) => {
            let applied = applied.as_deref().unwrap_or_default();
            self::series(series, actions, applied, last, checker)
        }
    };
    let (applied, factors): (Vec<usize>, Vec<f64>) = (applied?, factors?);
    for action in &applied {
        last[*action] = *factors.last()?;
    }
    Some(Stage {
        name: name?,
        actions: applied,
        factors,
    })
}

fn name(number: usize, table: &Placed<StageFile>, checker: &mut Checker) -> Option<String> {
    let Some(name) = &table.value.name else {
        return Some(format!("stage {}", number + 1));
    };
    if name.value.trim().is_empty() {
        checker.push(Problem::at(
            &name.span,
            "the name of a stage is empty",
            "expected a name for the results, or no `name`",
        ));
        return None;
    }
    Some(name.value.clone())
}

fn applied(
    table: &Placed<StageFile>,
    actions: &[Action],
    checker: &mut Checker,
) -> Option<Vec<usize>> {
    let Some(list) = &table.value.apply else {
        return Some((0..actions.len()).collect());
    };
    if list.value.is_empty() {
        checker.push(Problem::at(
            &list.span,
            "a stage that applies nothing",
            "expected names of loads or moves, or no `apply` for all of them",
        ));
        return None;
    }
    let mut found = Vec::new();
    let mut right = true;
    for name in &list.value {
        match actions.iter().position(|action| action.name == name.value) {
            Some(action) if found.contains(&action) => {
                right = false;
                checker.push(Problem::at(
                    &name.span,
                    format!("`{}` is applied twice in one stage", name.value),
                    "expected each name once",
                ));
            }
            Some(action) => found.push(action),
            None => {
                right = false;
                unknown_action(name, actions, checker);
            }
        }
    }
    right.then_some(found)
}

fn unknown_action(name: &Placed<String>, actions: &[Action], checker: &mut Checker) {
    let names = || actions.iter().map(|action| action.name.as_str());
    let message = if name.value == "weight" {
        "the grains have no weight".to_owned()
    } else {
        format!("no load or move is called `{}`", name.value)
    };
    checker.push(
        Problem::at(&name.span, message, format!("expected {}", either(names())))
            .suggest(likely(&name.value, names())),
    );
}

fn series(
    series: &SeriesFile,
    actions: &[Action],
    applied: &[usize],
    last: &[f64],
    checker: &mut Checker,
) -> Option<Vec<f64>> {
    let to = checker.number(&series.to, "to", Dimension::Number, Bound::Any);
    let steps = checker.count(&series.steps, "steps", 1);
    let (to, steps) = (to?, steps?);
    if steps > MOST_STEPS {
        checker.push(Problem::at(
            &series.steps.span,
            format!("`steps` cannot be {steps}"),
            format!("expected at most {MOST_STEPS} load steps"),
        ));
        return None;
    }
    let from = last[*applied.first()?];
    if let Some(other) = applied.iter().find(|action| last[**action] != from) {
        different_starts(
            &series.to,
            &actions[applied[0]],
            from,
            &actions[*other],
            last[*other],
            checker,
        );
        return None;
    }
    let factor = |step: usize| {
        if step == steps {
            to
        } else {
            from + (to - from) * step as f64 / steps as f64
        }
    };
    Some((1..=steps).map(factor).collect())
}

/// More load steps than any run has.
const MOST_STEPS: usize = 10_000_000;

fn different_starts(
    to: &Number,
    first: &Action,
    from: f64,
    second: &Action,
    other: f64,
    checker: &mut Checker,
) {
    checker.push(
        Problem::at(
            &to.span,
            format!(
                "`{}` stands at factor {from} and `{}` at {other}",
                first.name, second.name
            ),
            "expected actions that start from the same factor",
        )
        .help("give the factors as a list, or apply these in stages of their own"),
    );
}
