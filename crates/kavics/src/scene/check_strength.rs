//! Checks of strengths and their scatter.

use super::checker::{Bound, Checker};
use super::diagnostic::Problem;
use super::file_contacts::{
    LimitsFile, LognormalFile, ScatterFile, StrengthFile, UniformFile, WeibullFile,
};
use super::scatter::Scatter;
use super::unit::Dimension;
use super::value::{Number, Placed};
use crate::contact_law::{Strength, StrengthKind};

/// Limits and their scatter.
pub fn strength(
    table: &Placed<StrengthFile>,
    checker: &mut Checker,
) -> Option<(Strength, Option<Scatter>)> {
    let file = &table.value;
    let scatter = match &file.scatter {
        None => Some(None),
        Some(table) => self::scatter(table, checker).map(Some),
    };
    let alternatives = [
        (
            "stress",
            file.stress
                .as_ref()
                .map(|t| ((StrengthKind::Stress, &t.value), &t.span)),
        ),
        (
            "force",
            file.force
                .as_ref()
                .map(|t| ((StrengthKind::Force, &t.value), &t.span)),
        ),
    ];
    let (kind, limits) = checker.exactly_one(&table.span, "the strength", alternatives)?;
    Some((self::limits(kind, limits, checker)?, scatter?))
}

fn limits(kind: StrengthKind, file: &LimitsFile, checker: &mut Checker) -> Option<Strength> {
    let (force, moment) = match kind {
        StrengthKind::Stress => (Dimension::Stress, Dimension::Stress),
        StrengthKind::Force => (Dimension::Force, Dimension::Moment),
    };
    let mut limit = |number: &Option<Number>, key: &str, dimension: Dimension| {
        checker.number_or(
            f64::INFINITY,
            number.as_ref(),
            key,
            dimension,
            Bound::Positive,
        )
    };
    let tension = limit(&file.tension, "tension", force);
    let compression = limit(&file.compression, "compression", force);
    let shear = limit(&file.shear, "shear", force);
    let bending = limit(&file.bending, "bending", moment);
    Some(Strength {
        kind,
        tension: tension?,
        compression: compression?,
        shear: shear?,
        bending: bending?,
        fracture_energy: None,
    })
}

fn scatter(table: &Placed<ScatterFile>, checker: &mut Checker) -> Option<Scatter> {
    enum Kind {
        Weibull,
        Uniform,
        Lognormal,
    }
    let ScatterFile {
        weibull,
        uniform,
        lognormal,
    } = &table.value;
    let alternatives = [
        (
            "weibull",
            weibull.as_ref().map(|t| (Kind::Weibull, &t.span)),
        ),
        (
            "uniform",
            uniform.as_ref().map(|t| (Kind::Uniform, &t.span)),
        ),
        (
            "lognormal",
            lognormal.as_ref().map(|t| (Kind::Lognormal, &t.span)),
        ),
    ];
    let kind = checker.exactly_one(&table.span, "the scatter of the strength", alternatives)?;
    match kind {
        Kind::Weibull => self::weibull(&weibull.as_ref()?.value, checker),
        Kind::Uniform => self::uniform(&uniform.as_ref()?.value, checker),
        Kind::Lognormal => self::lognormal(&lognormal.as_ref()?.value, checker),
    }
}

fn positive(
    default: f64,
    number: Option<&Number>,
    key: &str,
    checker: &mut Checker,
) -> Option<f64> {
    checker.number_or(default, number, key, Dimension::Number, Bound::Positive)
}

/// Below it the weakest contacts have no strength that a number can hold beside the others.
const LEAST_SHAPE: f64 = 0.1;

fn weibull(file: &WeibullFile, checker: &mut Checker) -> Option<Scatter> {
    let shape = positive(1.0, Some(&file.shape), "shape", checker);
    if shape.is_some_and(|shape| shape < LEAST_SHAPE) {
        checker.push(Problem::at(
            &file.shape.span,
            "`shape` is so small that strengths vanish",
            format!("expected at least {LEAST_SHAPE}"),
        ));
        return None;
    }
    let scale = positive(1.0, file.scale.as_ref(), "scale", checker);
    Some(Scatter::Weibull {
        shape: shape?,
        scale: scale?,
    })
}

fn lognormal(file: &LognormalFile, checker: &mut Checker) -> Option<Scatter> {
    let deviation = positive(1.0, Some(&file.deviation), "deviation", checker);
    let median = positive(1.0, file.median.as_ref(), "median", checker);
    Some(Scatter::Lognormal {
        deviation: deviation?,
        median: median?,
    })
}

fn uniform(file: &UniformFile, checker: &mut Checker) -> Option<Scatter> {
    let (number, bound) = (Dimension::Number, Bound::NonNegative);
    let from = checker.number(&file.from, "from", number, bound);
    let to = positive(1.0, Some(&file.to), "to", checker);
    let (from, to) = (from?, to?);
    if from > to {
        checker.push(Problem::at(
            &file.to.span,
            format!("the scatter runs backwards, from {from} to {to}"),
            format!("expected at least {from}"),
        ));
        return None;
    }
    Some(Scatter::Uniform { from, to })
}
