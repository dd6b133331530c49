//! Places the grains: drops them, arranges them, or reads them from a table.

use std::collections::BTreeMap;
use std::path::Path;

use super::ReadGrains;
use super::check_grains::{DroppedPlan, GrainSource, GrainsPlan, SizesPlan};
use super::checker::Checker;
use super::diagnostic::{Problem, short};
use super::named_file::named_file;
use super::value::Placed;
use crate::assembly::{self, Grain, Side};
use crate::geometry::Vector;
use crate::ids::{GrainId, PerGrain, PerSide};
use crate::packing::{self, Mass, PackingError, SieveCurve, Sizes};

/// Grains in their box.
#[derive(Clone, Debug)]
pub struct PlacedGrains {
    /// The grains.
    pub grains: PerGrain<Grain>,
    /// Width of the box, `[length]`.
    pub width: f64,
    /// Height of the box, `[length]`.
    pub height: f64,
    /// Mean radius, `[length]`.
    pub mean_radius: f64,
    /// Sieve curve that the grains were to have, where the scene gives one.
    pub wanted_curve: Option<SieveCurve>,
}

/// Places the grains and checks that they neither overlap nor leave the box.
pub fn place(
    plan: &GrainsPlan,
    seed: u64,
    touching_tolerance: f64,
    folder: &Path,
    grain_lists: &ReadGrains<'_>,
    checker: &mut Checker,
) -> Option<PlacedGrains> {
    let grains = match &plan.source {
        GrainSource::Listed(file) => listed(file, folder, grain_lists, checker)?,
        _ => match packed(plan, seed) {
            Ok(grains) => grains,
            Err(error) => {
                checker.push(
                    Problem::at(
                        &plan.span,
                        format!("the grains cannot be placed: {error}"),
                        "expected grains that fit into the box",
                    )
                    .and(&plan.box_span, "the box"),
                );
                return None;
            }
        },
    };
    let top = |grain: &Grain| grain.centre.y + grain.radius;
    let highest = grains.values().iter().map(top).fold(0.0, f64::max);
    let mean = grains.values().iter().map(|g| g.radius).sum::<f64>() / grains.len() as f64;
    let placed = PlacedGrains {
        width: plan.width,
        height: plan.height.unwrap_or(highest),
        mean_radius: mean,
        wanted_curve: wanted_curve(&plan.source),
        grains,
    };
    if placed.height <= 0.0 {
        checker.push(Problem::at(
            &plan.span,
            "no grain reaches above the floor of the box",
            "expected grains inside the box",
        ));
        return None;
    }
    let tolerance = touching_tolerance * mean;
    let apart = overlaps(&placed, plan, tolerance, checker);
    let inside = outside(&placed, plan, tolerance, checker);
    (apart && inside).then_some(placed)
}

fn packed(plan: &GrainsPlan, seed: u64) -> Result<PerGrain<Grain>, PackingError> {
    match &plan.source {
        GrainSource::Hexagonal(radius, rows) => packing::rows::hexagonal(*radius, plan.width, rows),
        GrainSource::Square(radius, columns, rows) => {
            packing::rows::square(*radius, plan.width, *columns, *rows)
        }
        GrainSource::Dropped(dropped) => self::dropped(dropped, plan, seed),
        GrainSource::Listed(_) => Ok(PerGrain::default()),
    }
}

fn wanted_curve(source: &GrainSource) -> Option<SieveCurve> {
    match source {
        GrainSource::Dropped(dropped) => Some(sizes(&dropped.sizes).curve()),
        GrainSource::Hexagonal(..) | GrainSource::Square(..) | GrainSource::Listed(_) => None,
    }
}

fn sizes(plan: &SizesPlan) -> Sizes {
    match plan {
        SizesPlan::Uniform(from, to) => Sizes::Uniform {
            from: *from,
            to: *to,
        },
        SizesPlan::Sieve {
            diameters,
            passing,
            sphere,
        } => Sizes::Sieve(SieveCurve {
            diameter: diameters.clone(),
            passing: passing.clone(),
            mass: if *sphere { Mass::Sphere } else { Mass::Disc },
        }),
    }
}

fn dropped(
    dropped: &DroppedPlan,
    plan: &GrainsPlan,
    seed: u64,
) -> Result<PerGrain<Grain>, PackingError> {
    let sizes = sizes(&dropped.sizes);
    let pack = match (dropped.count, plan.height) {
        (Some(count), _) => {
            let radii = sizes.radii(count, seed)?;
            packing::dropped::drop(plan.width, &radii, dropped.tries, None, seed)?
        }
        (None, height) => {
            let height = height.unwrap_or_default();
            packing::dropped::fill(plan.width, height, &sizes, dropped.tries, seed)?
        }
    };
    Ok(pack.grains)
}

fn listed(
    file: &Placed<String>,
    folder: &Path,
    grain_lists: &ReadGrains<'_>,
    checker: &mut Checker,
) -> Option<PerGrain<Grain>> {
    let path = named_file(file, folder, "a list of grains", checker)?;
    let is_csv = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("csv"));
    let rows = if is_csv {
        super::grain_list::read_csv(&path)
    } else {
        grain_lists(&path)
    };
    let rows = rows.and_then(|rows| super::grain_list::check(&rows).map(|()| rows));
    match rows {
        Ok(rows) => rows
            .into_iter()
            .map(|[x, y, radius]| {
                Some(Grain {
                    centre: Vector::new(x, y),
                    radius,
                })
            })
            .collect(),
        Err(what) => {
            checker.push(Problem::at(
                &file.span,
                format!("`{}`: {what}", file.value),
                "expected a table with columns `x`, `y` and `radius`",
            ));
            None
        }
    }
}

/// How many of a list are told.
const TOLD: usize = 5;

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
    if let Some((first, second)) = same_place(&placed.grains) {
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
    let mut seen = BTreeMap::new();
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
    let sides: PerSide<Side> = assembly::box_sides(placed.width, placed.height, [false; 4]);
    let grains = assembly::outside(&placed.grains, &sides, tolerance);
    if grains.is_empty() {
        return true;
    }
    let told = grains
        .iter()
        .take(TOLD)
        .map(|(grain, side, depth)| {
            format!(
                "grain {grain} beyond the {} side by {}",
                sides[*side].name,
                short(*depth)
            )
        })
        .collect();
    checker.push(
        Problem::at(
            &plan.box_span,
            format!("grains lie outside the box: {}", list(told, grains.len())),
            format!(
                "the box is {} wide and {} high",
                placed.width, placed.height
            ),
        )
        .and(&plan.span, "expected grains inside the box"),
    );
    false
}
