//! Checks of supports, weight, moves and loads.

use std::ops::Range;

use super::check_contacts::{FREEDOMS, Ranges, SIDES, freedoms, optional_range};
use super::checker::{Bound, Checker};
use super::diagnostic::Problem;
use super::file::{
    ChoiceFile, ForceFile, LoadFile, MoveFile, SceneFile, StrainFile, SupportFile, WeightFile,
};
use super::unit::Dimension;
use super::value::{Number, Placed, Quantity};
use crate::equilibrium::{Freedom, Load};

/// All that acts from outside, before the grains are known.
#[derive(Clone, Debug)]
pub struct LoadingPlan {
    /// Supports.
    pub supports: Vec<SupportPlan>,
    /// Weight, if grains have one.
    pub weight: Option<WeightPlan>,
    /// Moves.
    pub moves: Vec<MovePlan>,
    /// Loads.
    pub loads: Vec<LoadPlan>,
}

/// A support.
#[derive(Clone, Debug)]
pub struct SupportPlan {
    /// Of which grains.
    pub grains: ChoicePlan,
    /// Freedoms that are held.
    pub fix: Vec<Freedom>,
    /// Where it stands in the file.
    pub span: Range<usize>,
}

/// A choice of grains with its place.
#[derive(Clone, Debug)]
pub struct ChoicePlan {
    /// Which.
    pub kind: ChoiceKind,
    /// Where it stands in the file.
    pub span: Range<usize>,
}

/// A choice of grains.
#[derive(Clone, Debug)]
pub enum ChoiceKind {
    /// Grains that touch an edge of the box.
    Edge(usize),
    /// Grains by id, each with its place in the file.
    Ids(Vec<Placed<i64>>),
    /// Grains with their centre in ranges.
    Within(Ranges),
    /// Grains on the boundary of the assembly.
    Boundary,
}

/// The weight of the grains.
#[derive(Clone, Copy, Debug)]
pub struct WeightPlan {
    /// `[mass/length³]`.
    pub density: f64,
    /// `[length/time²]`.
    pub gravity: f64,
}

/// Side or grains.
#[derive(Clone, Debug)]
pub enum TargetPlan {
    /// A side of the box, with its place in the file.
    Side(usize, Range<usize>),
    /// Grains.
    Grains(ChoicePlan),
}

/// A prescribed motion.
#[derive(Clone, Debug)]
pub struct MovePlan {
    /// Its name.
    pub name: Placed<String>,
    /// What moves.
    pub target: TargetPlan,
    /// How.
    pub motion: MotionPlan,
}

/// How something moves at factor 1.
#[derive(Clone, Debug)]
pub enum MotionPlan {
    /// Some freedoms by given amounts, each with its place in the file.
    Freedoms(Vec<(Freedom, f64, Range<usize>)>),
    /// In an affine way about the centre of the box.
    Strain {
        /// ∂u_x/∂x.
        xx: f64,
        /// ∂u_y/∂x.
        xy: f64,
        /// ∂u_x/∂y.
        yx: f64,
        /// ∂u_y/∂y.
        yy: f64,
        /// Whether the rotation stays free; else it is (xy − yx)/2.
        free_rotation: bool,
        /// Its place in the file.
        span: Range<usize>,
    },
}

/// A load.
#[derive(Clone, Debug)]
pub struct LoadPlan {
    /// Its name.
    pub name: Placed<String>,
    /// What it is.
    pub kind: LoadKind,
}

/// Kinds of loads.
#[derive(Clone, Debug)]
pub enum LoadKind {
    /// Along an edge of the box, at its start and end, `[force/length]`.
    Edge {
        /// Which edge.
        edge: usize,
        /// Its place in the file.
        span: Range<usize>,
        /// Along the outward normal.
        normal: [f64; 2],
        /// Along the edge.
        shear: [f64; 2],
    },
    /// A force on a side or on each of some grains.
    Force(TargetPlan, Load, Vec<(Freedom, Range<usize>)>),
}

/// Supports, weight, moves and loads.
pub fn loading(file: &SceneFile, checker: &mut Checker) -> Option<LoadingPlan> {
    let supports: Vec<_> = file.support.iter().map(|s| support(s, checker)).collect();
    let weight = match &file.weight {
        None => Some(None),
        Some(table) => weight(&table.value, checker),
    };
    let moves: Vec<_> = file.moves.iter().map(|m| motion(m, checker)).collect();
    let loads: Vec<_> = file.load.iter().map(|l| load(l, checker)).collect();
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
        if name.value == "weight" {
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

fn choice(table: &Placed<ChoiceFile>, checker: &mut Checker) -> Option<ChoicePlan> {
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
        Kind::Edge(edge) => ChoiceKind::Edge(checker.word(edge, "edge", &SIDES)?),
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

fn side(word: &Placed<String>, checker: &mut Checker) -> Option<TargetPlan> {
    let index = checker.word(word, "side", &SIDES)?;
    Some(TargetPlan::Side(index, word.span.clone()))
}

fn motion(table: &Placed<MoveFile>, checker: &mut Checker) -> Option<MovePlan> {
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

fn load(table: &Placed<LoadFile>, checker: &mut Checker) -> Option<LoadPlan> {
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
    let index = checker.word(edge, "edge", &SIDES);
    let mut values = |list: &Option<Placed<Vec<Number>>>, key: &str| {
        list.as_ref().map_or(Some([0.0; 2]), |list| {
            checker.pair(list, key, Dimension::ForcePerLength)
        })
    };
    let normal = values(&file.normal, "normal");
    let shear = values(&file.shear, "shear");
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
