//! Checks of grains that are dropped, advance in a front, or are to meet a packing fraction.

use std::ops::Range;

use super::check_sizes::{mean_area, sizes};
use super::checker::{Bound, Checker};
use super::diagnostic::{Problem, short};
use super::file_grains::{DroppedFile, FrontFile, TargetFile};
use super::unit::Dimension;
use super::value::Placed;
use crate::packing::Sizes;

/// More drops than anybody waits for.
const MOST_DROPS: usize = 10_000_000;
/// The same where the number of grains is sought by filling the box several times.
const MOST_DROPS_OF_A_FILL: usize = 1_000_000;
/// More drops a grain than make a difference.
const MOST_TRIES: i64 = 10_000;
/// More grains of a front, and of a wanted packing fraction, than anybody waits for.
const MOST_IN_FRONT: usize = 10_000_000;
const MOST_IN_TARGET: usize = 1_000_000;

/// Grains that are dropped.
#[derive(Clone, Debug)]
pub struct DroppedPlan {
    /// How many; none: until the layer is full.
    pub count: Option<usize>,
    /// Their sizes.
    pub sizes: Sizes,
    /// Each at the lowest of so many places.
    pub tries: usize,
}

/// Grains that are added one after another at a front.
#[derive(Clone, Debug)]
pub struct FrontPlan {
    /// How many; none: until the layer is full.
    pub count: Option<usize>,
    /// Their sizes.
    pub sizes: Sizes,
}

/// Grains of a wanted packing fraction.
#[derive(Clone, Debug)]
pub struct TargetPlan {
    /// Area of the grains over that of their room.
    pub packing_fraction: f64,
    /// Their sizes.
    pub sizes: Sizes,
}

/// How grains are dropped.
pub fn dropped_plan(table: &Placed<DroppedFile>, checker: &mut Checker) -> Option<DroppedPlan> {
    let file = &table.value;
    let count = count(file.count.as_ref(), MOST_DROPS, checker);
    let tries = match &file.tries {
        None => Some(1),
        Some(tries) => checker.count_up_to(tries, "tries", 1, MOST_TRIES),
    };
    let sizes = sizes(
        file.radius.as_ref(),
        file.sieve.as_ref(),
        &table.span,
        checker,
    );
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

/// How grains advance in a front.
pub fn front_plan(table: &Placed<FrontFile>, checker: &mut Checker) -> Option<FrontPlan> {
    let FrontFile {
        count,
        radius,
        sieve,
    } = &table.value;
    let count = self::count(count.as_ref(), MOST_IN_FRONT, checker);
    let sizes = sizes(radius.as_ref(), sieve.as_ref(), &table.span, checker);
    Some(FrontPlan {
        count: count?,
        sizes: sizes?,
    })
}

/// Which packing fraction grains are to meet.
pub fn target_plan(table: &Placed<TargetFile>, checker: &mut Checker) -> Option<TargetPlan> {
    let TargetFile {
        packing_fraction: number,
        radius,
        sieve,
    } = &table.value;
    let key = "packing_fraction";
    let fraction = checker.number(number, key, Dimension::Number, Bound::Positive);
    let sizes = sizes(radius.as_ref(), sieve.as_ref(), &table.span, checker);
    let fraction = fraction?;
    if fraction >= 1.0 {
        checker.push(Problem::at(
            &number.span,
            format!("`{key}` cannot be {fraction}"),
            "expected a number above 0 and below 1",
        ));
        return None;
    }
    Some(TargetPlan {
        packing_fraction: fraction,
        sizes: sizes?,
    })
}

#[expect(clippy::option_option, reason = "wrong, absent, there")]
fn count(count: Option<&Placed<i64>>, most: usize, checker: &mut Checker) -> Option<Option<usize>> {
    match count {
        None => Some(None),
        Some(count) => checker
            .count_up_to(count, "count", 1, most as i64)
            .map(Some),
    }
}

/// What fills a layer up to its top.
#[derive(Clone, Copy, Debug)]
pub enum Fill<'a> {
    /// Dropped grains without a count.
    Dropped(&'a DroppedPlan),
    /// A front.
    Front(&'a FrontPlan),
    /// A packing fraction.
    Target(&'a TargetPlan),
}

impl Fill<'_> {
    /// About the number of grains that fill a layer of this area, `[length²]`.
    pub fn grains(self, area: f64) -> f64 {
        // Discs of one size cover about so much of the plane.
        const COVERED: f64 = 0.8;
        let (sizes, covered) = match self {
            Self::Dropped(plan) => (&plan.sizes, COVERED),
            Self::Front(plan) => (&plan.sizes, COVERED),
            Self::Target(plan) => (&plan.sizes, plan.packing_fraction),
        };
        covered * area / mean_area(sizes)
    }

    /// Whether a layer of this area, `[length²]`, is filled in a time that anybody waits for.
    pub fn can_be_done(self, area: f64, span: &Range<usize>, checker: &mut Checker) -> Option<()> {
        let number = self.grains(area);
        let (tries, most) = match self {
            Self::Dropped(plan) => (plan.tries, MOST_DROPS_OF_A_FILL),
            Self::Front(plan) if plan.count.is_some() => return Some(()),
            Self::Front(_) => (1, MOST_IN_FRONT),
            Self::Target(_) => (1, MOST_IN_TARGET),
        };
        if number * tries as f64 <= most as f64 {
            return Some(());
        }
        let (each, unit, or_count) = match self {
            Self::Dropped(_) => (format!(" of {tries} drops each"), "drops", " or a `count`"),
            Self::Front(_) => (String::new(), "grains", " or a `count`"),
            Self::Target(_) => (String::new(), "grains", ""),
        };
        checker.push(
            Problem::at(
                span,
                format!("about {} grains{each} would fill the box", short(number)),
                format!("expected at most {most} {unit}"),
            )
            .help(format!("give larger grains, a smaller box{or_count}")),
        );
        None
    }
}
