//! Checks of moves and loads.

use std::ops::Range;

use super::check_choice::choice;
use super::check_contacts::FREEDOMS;
use super::checker::{Bound, Checker};
use super::diagnostic::Problem;
use super::file::{ChoiceFile, ForceFile, LoadFile, MoveFile, StrainFile};
use super::loading_plan::{LoadKind, LoadPlan, MotionPlan, MovePlan, TargetPlan};
use super::unit::Dimension;
use super::value::{Number, Placed, Quantity};
use crate::equilibrium::{Freedom, Load};

fn side(word: &Placed<String>, checker: &mut Checker) -> Option<TargetPlan> {
    let index = checker.side(word, "side")?;
    Some(TargetPlan::Side(index, word.span.clone()))
}

/// A prescribed motion.
pub fn motion(table: &Placed<MoveFile>, checker: &mut Checker) -> Option<MovePlan> {
    let file = &table.value;
    let target = target(
        &table.span,
        file.side.as_ref(),
        file.grains.as_ref(),
        checker,
    );
    let motion = match &file.strain {
        Some(strain) => affine(file, strain, checker),
        None => rigid(table, checker),
    };
    Some(MovePlan {
        name: file.name.clone(),
        target: target?,
        motion: motion?,
    })
}

fn target(
    table: &Range<usize>,
    side: Option<&Placed<String>>,
    grains: Option<&Placed<ChoiceFile>>,
    checker: &mut Checker,
) -> Option<TargetPlan> {
    enum Target<'a> {
        Side(&'a Placed<String>),
        Grains(&'a Placed<ChoiceFile>),
    }
    let alternatives = [
        ("side", side.map(|s| (Target::Side(s), &s.span))),
        ("grains", grains.map(|g| (Target::Grains(g), &g.span))),
    ];
    match checker.exactly_one(table, "what moves", alternatives)? {
        Target::Side(word) => self::side(word, checker),
        Target::Grains(grains) => choice(grains, checker).map(TargetPlan::Grains),
    }
}

fn rigid(table: &Placed<MoveFile>, checker: &mut Checker) -> Option<MotionPlan> {
    let file = &table.value;
    let dimensions = [Dimension::Length, Dimension::Length, Dimension::Angle];
    let numbers = [&file.x, &file.y, &file.rotation];
    if numbers.iter().all(|number| number.is_none()) {
        checker.push(Problem::at(
            &table.span,
            format!("move `{}` moves nothing", file.name.value),
            "expected `x`, `y`, `rotation` or `strain`",
        ));
        return None;
    }
    let mut freedoms = Vec::new();
    for (((key, freedom), number), dimension) in FREEDOMS.into_iter().zip(numbers).zip(dimensions) {
        if let Some(number) = number {
            let value = checker.number(number, key, dimension, Bound::Any)?;
            freedoms.push((freedom, value, number.span.clone()));
        }
    }
    Some(MotionPlan::Freedoms(freedoms))
}

fn affine(
    file: &MoveFile,
    strain: &Placed<StrainFile>,
    checker: &mut Checker,
) -> Option<MotionPlan> {
    strain_alone(file, strain, checker)?;
    let free_rotation = match &file.rotation {
        None => false,
        Some(number) if matches!(&number.value, Quantity::Text(text) if text == "free") => true,
        Some(number) => {
            checker.push(Problem::at(
                &number.span,
                "beside a strain, `rotation` is held at (xy − yx)/2",
                "expected \"free\" or no `rotation`",
            ));
            return None;
        }
    };
    let StrainFile { xx, xy, yx, yy } = &strain.value;
    if [xx, xy, yx, yy].iter().all(|part| part.is_none()) {
        checker.push(Problem::at(
            &strain.span,
            "a strain without a value",
            "expected some of `xx`, `xy`, `yx` and `yy`",
        ));
        return None;
    }
    let mut part = |number: &Option<Number>, key: &str| {
        checker.number_or(0.0, number.as_ref(), key, Dimension::Number, Bound::Any)
    };
    let (xx, xy, yx, yy) = (
        part(xx, "xx"),
        part(xy, "xy"),
        part(yx, "yx"),
        part(yy, "yy"),
    );
    Some(MotionPlan::Strain {
        xx: xx?,
        xy: xy?,
        yx: yx?,
        yy: yy?,
        free_rotation,
        span: strain.span.clone(),
    })
}

/// A strain stands beside neither a side nor single displacements.
fn strain_alone(file: &MoveFile, strain: &Placed<StrainFile>, checker: &mut Checker) -> Option<()> {
    if let Some(side) = &file.side {
        checker.push(Problem::at(
            &side.span,
            "a side cannot follow a strain",
            "expected `grains` beside `strain`",
        ));
        return None;
    }
    for (number, key) in [(&file.x, "x"), (&file.y, "y")] {
        if let Some(number) = number {
            checker.push(
                Problem::at(
                    &number.span,
                    format!("move `{}` has both `{key}` and `strain`", file.name.value),
                    "expected only one of them",
                )
                .and(&strain.span, "the strain"),
            );
            return None;
        }
    }
    Some(())
}

/// A load.
pub fn load(table: &Placed<LoadFile>, checker: &mut Checker) -> Option<LoadPlan> {
    enum Kind<'a> {
        Edge(&'a Placed<String>),
        Side(&'a Placed<String>),
        Grains(&'a Placed<ChoiceFile>),
    }
    let file = &table.value;
    let alternatives = [
        ("edge", file.edge.as_ref().map(|e| (Kind::Edge(e), &e.span))),
        (
            "grains",
            file.grains.as_ref().map(|g| (Kind::Grains(g), &g.span)),
        ),
        ("side", file.side.as_ref().map(|s| (Kind::Side(s), &s.span))),
    ];
    let what = format!("what load `{}` acts on", file.name.value);
    let kind = match checker.exactly_one(&table.span, &what, alternatives)? {
        Kind::Edge(edge) => edge_load(table, edge, checker),
        Kind::Side(word) => {
            let target = side(word, checker);
            force(table, checker)
                .and_then(|(load, spans)| Some(LoadKind::Force(target?, load, spans)))
        }
        Kind::Grains(grains) => {
            let target = choice(grains, checker).map(TargetPlan::Grains);
            force(table, checker)
                .and_then(|(load, spans)| Some(LoadKind::Force(target?, load, spans)))
        }
    };
    Some(LoadPlan {
        name: file.name.clone(),
        kind: kind?,
    })
}

fn edge_load(
    table: &Placed<LoadFile>,
    edge: &Placed<String>,
    checker: &mut Checker,
) -> Option<LoadKind> {
    let file = &table.value;
    if let Some(force) = &file.force {
        checker.push(
            Problem::at(
                &force.span,
                format!("load `{}` on an edge has a `force`", file.name.value),
                "expected `normal` and `shear`, which are forces per length",
            )
            .and(&edge.span, "distributed along this edge"),
        );
        return None;
    }
    if file.normal.is_none() && file.shear.is_none() {
        checker.push(Problem::at(
            &table.span,
            format!("load `{}` has no value", file.name.value),
            "expected `normal` or `shear`, such as `normal = [-1.0, -1.0]`",
        ));
        return None;
    }
    let index = checker.side(edge, "edge");
    let mut values = |list: &Option<Placed<Vec<Number>>>, key: &str| {
        list.as_ref().map_or(Some([0.0; 2]), |list| {
            checker.pair(list, key, Dimension::ForcePerLength)
        })
    };
    let normal = values(&file.normal, "normal");
    let shear = values(&file.shear, "shear");
    if let (Some([0.0, 0.0]), Some([0.0, 0.0])) = (normal, shear) {
        checker.push(Problem::at(
            &table.span,
            format!("load `{}` is zero", file.name.value),
            "expected `normal` or `shear` other than zero",
        ));
    }
    Some(LoadKind::Edge {
        edge: index?,
        span: edge.span.clone(),
        normal: normal?,
        shear: shear?,
    })
}

type ForcePlan = (Load, Vec<(Freedom, Range<usize>)>);

fn force(table: &Placed<LoadFile>, checker: &mut Checker) -> Option<ForcePlan> {
    let file = &table.value;
    for (list, key) in [(&file.normal, "normal"), (&file.shear, "shear")] {
        if let Some(list) = list {
            checker.push(Problem::at(
                &list.span,
                format!("`{key}` belongs to a load on an `edge`"),
                "expected `force = { x = …, y = …, moment = … }`",
            ));
            return None;
        }
    }
    let Some(force) = &file.force else {
        checker.push(Problem::at(
            &table.span,
            format!("load `{}` has no value", file.name.value),
            "expected `force = { x = …, y = …, moment = … }`",
        ));
        return None;
    };
    let ForceFile { x, y, moment } = &force.value;
    let mut spans = Vec::new();
    let mut part = |number: &Option<Number>, key: &str, dimension, freedom| {
        let value = checker.number_or(0.0, number.as_ref(), key, dimension, Bound::Any);
        if let (Some(number), Some(value)) = (number, value)
            && value != 0.0
        {
            spans.push((freedom, number.span.clone()));
        }
        value
    };
    let x = part(x, "x", Dimension::Force, Freedom::X);
    let y = part(y, "y", Dimension::Force, Freedom::Y);
    let moment = part(moment, "moment", Dimension::Moment, Freedom::Rotation);
    let load = Load {
        x: x?,
        y: y?,
        moment: moment?,
    };
    if spans.is_empty() {
        checker.push(Problem::at(
            &force.span,
            format!("load `{}` is zero", file.name.value),
            "expected `x`, `y` or `moment` other than zero",
        ));
        return None;
    }
    Some((load, spans))
}
