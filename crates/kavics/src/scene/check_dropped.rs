//! Checks of grains that are dropped.

use std::ops::Range;

use super::check_grains::{DroppedPlan, SizesPlan};
use super::checker::{Bound, Checker};
use super::diagnostic::{Problem, short};
use super::file::{DroppedFile, RadiiFile, SieveFile};
use super::unit::Dimension;
use super::value::{Placed, ValueOr};

/// More drops than anybody waits for.
const MOST_DROPS: usize = 10_000_000;
/// The same where the number of grains is sought by filling the box several times.
const MOST_DROPS_OF_A_FILL: usize = 1_000_000;
/// More drops a grain than make a difference.
const MOST_TRIES: i64 = 10_000;

/// How grains are dropped.
pub fn dropped_plan(table: &Placed<DroppedFile>, checker: &mut Checker) -> Option<DroppedPlan> {
    enum Sizes<'a> {
        Radius(&'a Placed<ValueOr<RadiiFile>>),
        Sieve(&'a Placed<SieveFile>),
    }
    let file = &table.value;
    let count = match &file.count {
        None => Some(None),
        Some(count) => checker.count(count, "count", 1).map(Some),
    };
    let tries = match &file.tries {
        None => Some(1),
        Some(tries) => checker.count_up_to(tries, "tries", 1, MOST_TRIES),
    };
    let alternatives = [
        (
            "radius",
            file.radius.as_ref().map(|r| (Sizes::Radius(r), &r.span)),
        ),
        (
            "sieve",
            file.sieve.as_ref().map(|s| (Sizes::Sieve(s), &s.span)),
        ),
    ];
    let sizes = match checker.exactly_one(&table.span, "the size of the grains", alternatives)? {
        Sizes::Radius(radius) => radii(radius, checker),
        Sizes::Sieve(sieve) => sieve_curve(&sieve.value, checker),
    };
    let (count, tries) = (count?, tries?);
    if let (Some(count), Some(place)) = (count, &file.count)
        && count.saturating_mul(tries) > MOST_DROPS
    {
        checker.push(Problem::at(
            &place.span,
            format!("{count} grains of {tries} drops each are too many"),
            format!("expected at most {MOST_DROPS} drops"),
        ));
        return None;
    }
    Some(DroppedPlan {
        count,
        sizes: sizes?,
        tries,
    })
}

fn radii(radius: &Placed<ValueOr<RadiiFile>>, checker: &mut Checker) -> Option<SizesPlan> {
    let (length, positive) = (Dimension::Length, Bound::Positive);
    match &radius.value {
        ValueOr::Value(value) => {
            let radius = checker.quantity(value, &radius.span, "radius", length, positive)?;
            Some(SizesPlan::Uniform(radius, radius))
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
            Some(SizesPlan::Uniform(from, to))
        }
    }
}

fn sieve_curve(file: &SieveFile, checker: &mut Checker) -> Option<SizesPlan> {
    let sphere = file.mass.as_ref().map_or(Some(false), |mass| {
        checker.word(mass, "mass", &[("disc", false), ("sphere", true)])
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
    Some(SizesPlan::Sieve {
        diameters,
        passing,
        sphere: sphere?,
    })
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

/// Whether a box can be filled in a time that anybody waits for, by an estimate of the number of grains.
pub fn can_be_filled(
    dropped: &DroppedPlan,
    width: f64,
    height: f64,
    span: &Range<usize>,
    checker: &mut Checker,
) -> Option<()> {
    // Discs of one size cover about so much of the plane when dropped.
    const COVERED: f64 = 0.8;
    let grains = COVERED * width * height / mean_area(&dropped.sizes);
    if grains * dropped.tries as f64 <= MOST_DROPS_OF_A_FILL as f64 {
        return Some(());
    }
    checker.push(
        Problem::at(
            span,
            format!(
                "about {} grains of {} drops each would fill the box",
                short(grains),
                dropped.tries
            ),
            format!("expected at most {MOST_DROPS_OF_A_FILL} drops"),
        )
        .help("give larger grains, a smaller box or a `count`"),
    );
    None
}

/// Mean area of the grains, estimated for a sieve curve by one size a class, `[length²]`.
fn mean_area(sizes: &SizesPlan) -> f64 {
    use std::f64::consts::PI;
    match sizes {
        SizesPlan::Uniform(from, to) => PI / 3.0 * (from * from + from * to + to * to),
        SizesPlan::Sieve {
            diameters,
            passing,
            sphere,
        } => {
            let (mut number, mut area) = (0.0, 0.0);
            for (d, p) in diameters.windows(2).zip(passing.windows(2)) {
                let (square, mass) = (d[0] * d[1], p[1] - p[0]);
                let of_class = mass / square / if *sphere { square.sqrt() } else { 1.0 };
                number += of_class;
                area += of_class * 0.25 * PI * square;
            }
            area / number
        }
    }
}
