//! Checks of the sizes of grains: a radius, two limits, or a sieve curve.

use std::ops::Range;

use super::checker::{Bound, Checker};
use super::diagnostic::Problem;
use super::file_grains::{RadiiFile, SieveFile};
use super::unit::Dimension;
use super::value::{Placed, ValueOr};
use crate::packing::{Mass, SieveCurve, Sizes};

/// Sizes by exactly one of `radius` and `sieve`, of the table at `span`.
pub fn sizes(
    radius: Option<&Placed<ValueOr<RadiiFile>>>,
    sieve: Option<&Placed<SieveFile>>,
    span: &Range<usize>,
    checker: &mut Checker,
) -> Option<Sizes> {
    enum Given<'a> {
        Radius(&'a Placed<ValueOr<RadiiFile>>),
        Sieve(&'a Placed<SieveFile>),
    }
    let alternatives = [
        ("radius", radius.map(|r| (Given::Radius(r), &r.span))),
        ("sieve", sieve.map(|s| (Given::Sieve(s), &s.span))),
    ];
    match checker.exactly_one(span, "the size of the grains", alternatives)? {
        Given::Radius(radius) => radii(radius, checker),
        Given::Sieve(sieve) => sieve_curve(&sieve.value, checker),
    }
}

fn radii(radius: &Placed<ValueOr<RadiiFile>>, checker: &mut Checker) -> Option<Sizes> {
    let (length, positive) = (Dimension::Length, Bound::Positive);
    match &radius.value {
        ValueOr::Value(value) => {
            let radius = checker.quantity(value, &radius.span, "radius", length, positive)?;
            Some(Sizes::Uniform {
                from: radius,
                to: radius,
            })
        }
        ValueOr::Table(limits) => {
            let from = checker.number(&limits.from, "from", length, positive);
            let to = checker.number(&limits.to, "to", length, positive);
            let (from, to) = (from?, to?);
            if from > to {
                checker.push(
                    Problem::at(
                        &limits.to.span,
                        format!("the largest radius {to} is below the smallest, {from}"),
                        format!("expected a radius of at least {from}"),
                    )
                    .and(&limits.from.span, "the smallest radius"),
                );
                return None;
            }
            Some(Sizes::Uniform { from, to })
        }
    }
}

fn sieve_curve(file: &SieveFile, checker: &mut Checker) -> Option<Sizes> {
    let mass = file.mass.as_ref().map_or(Some(Mass::Disc), |mass| {
        checker.word(
            mass,
            "mass",
            &[("disc", Mass::Disc), ("sphere", Mass::Sphere)],
        )
    });
    let diameters: Option<Vec<f64>> = file
        .diameter
        .value
        .iter()
        .map(|d| checker.number(d, "diameter", Dimension::Length, Bound::Positive))
        .collect();
    let passing: Option<Vec<f64>> = file
        .passing
        .value
        .iter()
        .map(|p| checker.number(p, "passing", Dimension::Number, Bound::NonNegative))
        .collect();
    let (diameters, passing) = (diameters?, passing?);
    sieve_lengths(file, checker)?;
    for i in 1..diameters.len() {
        if diameters[i] <= diameters[i - 1] {
            checker.push(Problem::at(
                &file.diameter.value[i].span,
                format!(
                    "diameter {} does not rise above {}",
                    diameters[i],
                    diameters[i - 1]
                ),
                "expected a larger diameter than the one before",
            ));
            return None;
        }
        if passing[i] < passing[i - 1] {
            checker.push(Problem::at(
                &file.passing.value[i].span,
                format!(
                    "the sieve curve falls from {} to {}",
                    passing[i - 1],
                    passing[i]
                ),
                "expected at least the share before",
            ));
            return None;
        }
    }
    sieve_ends(file, &passing, checker)?;
    Some(Sizes::Sieve(SieveCurve {
        diameter: diameters,
        passing,
        mass: mass?,
    }))
}

fn sieve_lengths(file: &SieveFile, checker: &mut Checker) -> Option<()> {
    let (diameters, passing) = (file.diameter.value.len(), file.passing.value.len());
    if diameters == passing && diameters >= 2 {
        return Some(());
    }
    checker.push(
        Problem::at(
            &file.passing.span,
            format!("a sieve curve with {diameters} diameters and {passing} shares"),
            "expected a share for each of at least two diameters",
        )
        .and(&file.diameter.span, "the diameters"),
    );
    None
}

fn sieve_ends(file: &SieveFile, passing: &[f64], checker: &mut Checker) -> Option<()> {
    let last = passing.len() - 1;
    for (i, expected) in [(0, 0.0), (last, 1.0)] {
        if passing[i] != expected {
            checker.push(
                Problem::at(
                    &file.passing.value[i].span,
                    format!(
                        "the sieve curve runs from {} to {}",
                        passing[0], passing[last]
                    ),
                    format!("expected {expected}"),
                )
                .help("the shares that pass run from 0 to 1"),
            );
            return None;
        }
    }
    Some(())
}

/// Mean area of the grains, estimated for a sieve curve by one size a class, `[length²]`.
pub fn mean_area(sizes: &Sizes) -> f64 {
    use std::f64::consts::PI;
    match sizes {
        Sizes::Uniform { from, to } => PI / 3.0 * (from * from + from * to + to * to),
        Sizes::Sieve(curve) => {
            let (mut number, mut area) = (0.0, 0.0);
            for (d, p) in curve.diameter.windows(2).zip(curve.passing.windows(2)) {
                let (square, mass) = (d[0] * d[1], p[1] - p[0]);
                let of_class = match curve.mass {
                    Mass::Disc => mass / square,
                    Mass::Sphere => mass / square / square.sqrt(),
                };
                number += of_class;
                area += of_class * 0.25 * PI * square;
            }
            area / number
        }
    }
}
