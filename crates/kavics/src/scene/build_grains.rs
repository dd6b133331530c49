//! Places the grains, layer by layer: drops them, arranges them, or reads them from a list.

use std::path::Path;

use super::ReadGrains;
use super::check_box::{BoxPlan, ShapePlan};
use super::check_dropped::DroppedPlan;
use super::check_grains::{GrainSource, ListedPlan};
use super::check_layers::{GrainsPlan, LayerPlan};
use super::checker::Checker;
use super::diagnostic::{Problem, short};
use super::fitting;
use super::named_file::named_file;
use crate::assembly::{Grain, Side};
use crate::geometry::{Container, Vector};
use crate::ids::{PerGrain, PerSide};
use crate::packing::{self, Bed, PackingError, Shape, SieveCurve, random::Source};

/// Grains in their container.
#[derive(Clone, Debug)]
pub struct PlacedGrains {
    /// The grains, layer by layer.
    pub grains: PerGrain<Grain>,
    /// Number of grains of each layer.
    pub layers: Vec<usize>,
    /// The container.
    pub container: BoxPlan,
    /// Height that the highest grain reaches, `[length]`.
    pub highest: f64,
    /// Mean radius, `[length]`.
    pub mean_radius: f64,
    /// Sieve curve that the grains were to have, where the scene gives one.
    pub wanted_curve: Option<SieveCurve>,
}

impl PlacedGrains {
    /// The sides of the container.
    pub fn sides(&self, present: &[bool]) -> PerSide<Side> {
        self.container.sides(self.highest, present)
    }
}

/// Places the grains and checks that they neither overlap nor leave the container.
pub fn place(
    plan: &GrainsPlan,
    seed: u64,
    touching_tolerance: f64,
    folder: &Path,
    grain_lists: &ReadGrains<'_>,
    checker: &mut Checker,
) -> Option<PlacedGrains> {
    let mut grains: Vec<Grain> = Vec::new();
    let mut layers = Vec::new();
    for (layer, number) in plan.layers.iter().zip(0..) {
        let placed = match &layer.source {
            GrainSource::Listed(list) => listed(list, folder, grain_lists, checker)?,
            _ => Filling::new(
                &plan.container,
                &grains,
                Source {
                    seed,
                    layer: number,
                },
            )
            .layer(layer, checker)?,
        };
        layers.push(placed.len());
        grains.extend(placed.values());
    }
    let placed = PlacedGrains {
        highest: highest(&grains, 0.0),
        mean_radius: grains.iter().map(|g| g.radius).sum::<f64>() / grains.len() as f64,
        container: plan.container.clone(),
        wanted_curve: wanted_curve(&plan.layers, &layers, &grains),
        layers,
        grains: grains.into(),
    };
    if placed.container.top().unwrap_or(placed.highest) <= placed.container.floor() {
        checker.push(Problem::at(
            &plan.span,
            "no grain reaches above the floor of the box",
            "expected grains inside the box",
        ));
        return None;
    }
    let tolerance = touching_tolerance * placed.mean_radius;
    fitting::check(&placed, plan, tolerance, checker).then_some(placed)
}

/// Height that the highest of some grains reaches, at least `floor`.
fn highest(grains: &[Grain], floor: f64) -> f64 {
    let top = |grain: &Grain| grain.centre.y + grain.radius;
    grains.iter().map(top).fold(floor, f64::max)
}

/// A layer above the grains of those below.
struct Filling<'a> {
    container: &'a BoxPlan,
    below: &'a [Grain],
    /// Height of the highest grain below, or of the floor.
    base: f64,
    source: Source,
}

impl<'a> Filling<'a> {
    fn new(container: &'a BoxPlan, below: &'a [Grain], source: Source) -> Self {
        Self {
            container,
            below,
            base: highest(below, container.floor()),
            source,
        }
    }

    fn layer(&self, plan: &LayerPlan, checker: &mut Checker) -> Option<PerGrain<Grain>> {
        if let Some(top) = plan.top.filter(|top| *top <= self.base) {
            checker.push(Problem::at(
                &plan.span,
                format!(
                    "no room is left for this layer: the grains below reach up to {}",
                    short(self.base)
                ),
                format!("expected a `top` or a box above that, not {}", short(top)),
            ));
            return None;
        }
        let placed = self.packed(plan);
        if let (
            Ok(placed),
            GrainSource::Dropped(DroppedPlan {
                count: Some(count), ..
            }),
        ) = (&placed, &plan.source)
            && placed.len() < *count
        {
            checker.push(Problem::at(
                &plan.span,
                format!("only {} of {count} grains fit into the box", placed.len()),
                "expected fewer or smaller grains, or a larger box",
            ));
            return None;
        }
        placed
            .map_err(|error| {
                checker.push(
                    Problem::at(
                        &plan.span,
                        format!("the grains cannot be placed: {error}"),
                        "expected grains that fit into the box",
                    )
                    .and(&self.container.span, "the box"),
                );
            })
            .ok()
    }

    fn packed(&self, plan: &LayerPlan) -> Result<PerGrain<Grain>, PackingError> {
        let [low, high] = self.container.extents();
        let (width, seed) = (high.x - low.x, self.seed());
        match &plan.source {
            GrainSource::Hexagonal(radius, rows) => {
                let rows = packing::rows::hexagonal(*radius, width, rows)?;
                Ok(self.lifted(&rows, low.x))
            }
            GrainSource::Square(radius, columns, rows) => {
                let rows = packing::rows::square(*radius, width, *columns, *rows)?;
                Ok(self.lifted(&rows, low.x))
            }
            GrainSource::Dropped(dropped) => self.dropped(plan, dropped),
            GrainSource::AdvancingFront(front) => {
                packing::advancing_front(&self.room(plan)?, &front.sizes, front.count, seed)
            }
            GrainSource::Target(target) => {
                let fraction = target.packing_fraction;
                packing::target(&self.room(plan)?, &target.sizes, fraction, seed)
            }
            GrainSource::Listed(_) => Ok(PerGrain::default()),
        }
    }

    fn dropped(
        &self,
        layer: &LayerPlan,
        plan: &DroppedPlan,
    ) -> Result<PerGrain<Grain>, PackingError> {
        let (bed, seed) = (self.bed(layer), self.source.seed);
        let dropped = if let Some(count) = plan.count {
            let radii = plan.sizes.radii(count, self.source)?;
            packing::dropped::drop(&bed, &radii, plan.tries, seed)?
        } else {
            packing::dropped::fill(&bed, &plan.sizes, plan.tries, seed)?
        };
        Ok(dropped.grains)
    }

    /// Seed of the layer, for what knows no layers.
    fn seed(&self) -> u64 {
        const APART: u64 = 0x9e37_79b9_7f4a_7c15;
        let Source { seed, layer } = self.source;
        seed.wrapping_add(APART.wrapping_mul(u64::from(layer)))
    }

    /// Grains that stand on y = 0 and begin at x = 0, put onto those below.
    fn lifted(&self, grains: &PerGrain<Grain>, left: f64) -> PerGrain<Grain> {
        let shift = Vector::new(left, self.base);
        grains.map(|grain| Grain {
            centre: grain.centre + shift,
            radius: grain.radius,
        })
    }

    fn bed(&self, plan: &LayerPlan) -> Bed<'a> {
        let shape = match &self.container.shape {
            ShapePlan::Box { width, .. } => Shape::Box { width: *width },
            ShapePlan::Polygon(_) => {
                let [low, high] = self.container.extents();
                let whole = self.container.part(low.y, high.y);
                Shape::Polygon(whole.unwrap_or_else(|| Container::polygon(&[])))
            }
        };
        Bed {
            shape,
            resting: self.below,
            top: plan.top,
            layer: self.source.layer,
        }
    }

    /// The part of the container that the layer is to fill.
    fn room(&self, plan: &LayerPlan) -> Result<Container, PackingError> {
        let top = plan.top.unwrap_or(self.base);
        let length = top - self.base;
        let part = self.container.part(self.base, top);
        part.ok_or(PackingError::BoxLength { length })
    }
}

/// The curve that the layers together were to have, if each was to have one.
fn wanted_curve(plans: &[LayerPlan], counts: &[usize], grains: &[Grain]) -> Option<SieveCurve> {
    let mut rest = grains;
    let mut kinds = Vec::new();
    for (plan, &count) in plans.iter().zip(counts) {
        let own;
        (own, rest) = rest.split_at(count);
        let curve = plan.source.sizes()?.curve();
        let mass = own
            .iter()
            .map(|g| curve.mass.of(2.0 * g.radius))
            .sum::<f64>();
        kinds.push((mass, curve));
    }
    match &mut kinds[..] {
        [(_, curve)] => Some(curve.clone()),
        _ => SieveCurve::mixture(&kinds),
    }
}

fn listed(
    plan: &ListedPlan,
    folder: &Path,
    grain_lists: &ReadGrains<'_>,
    checker: &mut Checker,
) -> Option<PerGrain<Grain>> {
    let ListedPlan { file, frame, rows } = plan;
    let path = named_file(file, folder, "a list of grains", checker)?;
    let is_csv = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("csv"));
    let list = match frame {
        Some(_) if is_csv => Err("a csv file has no frames".to_owned()),
        None if is_csv => super::grain_list::read_csv(&path),
        frame => grain_lists(&path, frame.as_ref().map(|frame| frame.value)),
    };
    let mut list = match list.and_then(|list| super::grain_list::check(&list).map(|()| list)) {
        Ok(list) => list,
        Err(what) => {
            let (span, expected) = match frame {
                None => (
                    &file.span,
                    "expected a list of grains with `x`, `y` and `radius`",
                ),
                Some(frame) => (&frame.span, "expected a frame of the file, or no `frame`"),
            };
            let message = format!("`{}`: {what}", file.value);
            checker.push(Problem::at(span, message, expected));
            return None;
        }
    };
    if let Some(rows) = rows {
        let [first, last] = rows.value;
        if last >= list.len() {
            checker.push(Problem::at(
                &rows.span,
                format!("`{}` has no row {last}", file.value),
                format!("expected rows from 0 to {}", list.len() - 1),
            ));
            return None;
        }
        list = list[first..=last].to_vec();
    }
    let grain = |[x, y, radius]: [f64; 3]| Grain {
        centre: Vector::new(x, y),
        radius,
    };
    Some(list.into_iter().map(grain).collect())
}
