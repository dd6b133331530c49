//! Checks of supports, weight, moves and loads.

use std::ops::Range;

use super::check_actions;
use super::check_contacts::{Ranges, SIDES, freedoms, optional_range};
use super::checker::{Bound, Checker};
use super::diagnostic::Problem;
use super::file::{ChoiceFile, SceneFile, SupportFile, WeightFile};
use super::unit::Dimension;
use super::value::Placed;
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
