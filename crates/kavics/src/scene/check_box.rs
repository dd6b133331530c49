//! Checks of the container: a box, or a convex polygon.

use std::ops::Range;

use super::checker::{Bound, Checker};
use super::diagnostic::Problem;
use super::file_grains::BoxFile;
use super::unit::Dimension;
use super::value::{Number, Placed};
use crate::assembly::{Side, box_sides, extents, polygon_sides, twice_area};
use crate::geometry::{Container, Vector};
use crate::ids::PerSide;

/// The container and its place in the file.
#[derive(Clone, Debug)]
pub struct BoxPlan {
    /// Its shape.
    pub shape: ShapePlan,
    /// Where it stands in the file.
    pub span: Range<usize>,
}

/// The shape of the container.
#[derive(Clone, Debug)]
pub enum ShapePlan {
    /// A box with its lower left corner at the origin.
    Box {
        /// `[length]`.
        width: f64,
        /// None: it ends at the highest grain, `[length]`.
        height: Option<f64>,
        /// Where the height stands in the file.
        height_span: Range<usize>,
    },
    /// A convex polygon with these corners, in the order of the file.
    Polygon(Vec<Vector>),
}

impl BoxPlan {
    /// Height of its lowest point, `[length]`.
    pub fn floor(&self) -> f64 {
        self.extents()[0].y
    }

    /// Height of its highest point; none where that is not known yet, `[length]`.
    pub fn top(&self) -> Option<f64> {
        match self.shape {
            ShapePlan::Box { height, .. } => height,
            ShapePlan::Polygon(_) => Some(self.extents()[1].y),
        }
    }

    /// Lowest and highest coordinates, `[length]`; a box whose height is not known has none.
    pub fn extents(&self) -> [Vector; 2] {
        match &self.shape {
            ShapePlan::Box { width, height, .. } => [
                Vector::default(),
                Vector::new(*width, height.unwrap_or(0.0)),
            ],
            ShapePlan::Polygon(corners) => extents(corners.iter().copied()),
        }
    }

    /// The sides, of a box that ends at `highest` if it has no height.
    pub fn sides(&self, highest: f64, present: &[bool]) -> PerSide<Side> {
        match &self.shape {
            ShapePlan::Box { width, height, .. } => {
                let present = [0, 1, 2, 3].map(|side: usize| present[side]);
                box_sides(*width, height.unwrap_or(highest), present)
            }
            ShapePlan::Polygon(corners) => polygon_sides(corners, present),
        }
    }

    /// The part between two heights, `[length]`; none where there is none.
    pub fn part(&self, low: f64, high: f64) -> Option<Container> {
        let corners = match &self.shape {
            ShapePlan::Box { width, .. } => {
                let corners = [(0.0, low), (*width, low), (*width, high), (0.0, high)];
                corners.map(|(x, y)| Vector::new(x, y)).to_vec()
            }
            ShapePlan::Polygon(corners) => part(corners, low, high),
        };
        (high > low && corners.len() > 2).then(|| Container::polygon(&corners))
    }
}

/// The part of a convex polygon between two heights, its corners counter-clockwise.
fn part(corners: &[Vector], low: f64, high: f64) -> Vec<Vector> {
    let mut corners = corners.to_vec();
    if twice_area(&corners) < 0.0 {
        corners.reverse();
    }
    // Height above the lower and below the upper line.
    let heights: [&dyn Fn(Vector) -> f64; 2] = [&|p| p.y - low, &|p| high - p.y];
    for height in heights {
        let next = corners.iter().cycle().skip(1);
        let mut kept = Vec::new();
        for (&from, &to) in corners.iter().zip(next) {
            let (a, b) = (height(from), height(to));
            if a >= 0.0 {
                kept.push(from);
            }
            if a * b < 0.0 {
                kept.push(from + (to - from) * (a / (a - b)));
            }
        }
        corners = kept;
    }
    without_repeats(corners)
}

/// Corners that lie apart from the one before.
fn without_repeats(corners: Vec<Vector>) -> Vec<Vector> {
    let [low, high] = extents(corners.iter().copied());
    let least = LEAST * (high - low).length();
    let mut kept: Vec<Vector> = Vec::new();
    for corner in corners {
        let apart = |other: &Vector| (corner - *other).length() > least;
        if kept.last().is_none_or(apart) {
            kept.push(corner);
        }
    }
    while kept.len() > 1 && (kept[0] - kept[kept.len() - 1]).length() <= least {
        kept.pop();
    }
    kept
}

/// The container.
pub fn container(table: &Placed<BoxFile>, checker: &mut Checker) -> Option<BoxPlan> {
    let BoxFile {
        width,
        height,
        polygon,
    } = &table.value;
    let shape = match polygon {
        None => of_box(table, checker),
        Some(polygon) => {
            for (number, key) in [(width, "width"), (height, "height")] {
                if let Some(number) = number {
                    checker.push(
                        Problem::at(
                            &number.span,
                            format!("a box with both `polygon` and `{key}`"),
                            "expected only one of them",
                        )
                        .and(&polygon.span, "the polygon"),
                    );
                }
            }
            self::polygon(polygon, checker).map(ShapePlan::Polygon)
        }
    };
    Some(BoxPlan {
        shape: shape?,
        span: table.span.clone(),
    })
}

fn of_box(table: &Placed<BoxFile>, checker: &mut Checker) -> Option<ShapePlan> {
    let BoxFile { width, height, .. } = &table.value;
    let mut missing = |key: &str| {
        checker.push(Problem::at(
            &table.span,
            format!("missing key `{key}`"),
            format!("`{key}` is missing here"),
        ));
    };
    if width.is_none() {
        missing("width");
    }
    if height.is_none() {
        missing("height");
    }
    let width = width
        .as_ref()
        .and_then(|w| checker.number(w, "width", Dimension::Length, Bound::Positive));
    let height_span = height.as_ref().map(|h| h.span.clone());
    let height = height.as_ref().and_then(|h| match Checker::as_word(h) {
        Some(word) => checker.word_or(&word, "height", &[("fit", None)], " or a length"),
        None => checker
            .number(h, "height", Dimension::Length, Bound::Positive)
            .map(Some),
    });
    Some(ShapePlan::Box {
        width: width?,
        height: height?,
        height_span: height_span?,
    })
}

/// More corners than any container has.
const MOST_CORNERS: usize = 1000;
/// Sine of the least turn at a corner, and least length of a side as a share of the polygon's size: below, the lines
/// of neighbouring sides meet nowhere in particular.
const LEAST: f64 = 1e-6;

type CornersFile = Placed<Vec<Placed<Vec<Number>>>>;

fn polygon(list: &CornersFile, checker: &mut Checker) -> Option<Vec<Vector>> {
    let number = list.value.len();
    if !(3..=MOST_CORNERS).contains(&number) {
        checker.push(Problem::at(
            &list.span,
            format!("a polygon of {number} corners"),
            format!("expected 3 to {MOST_CORNERS} corners, such as `[[0, 0], [4, 0], [2, 3]]`"),
        ));
        return None;
    }
    let corners = list.value.iter().map(|corner| {
        let [x, y] = checker.pair(corner, "polygon", Dimension::Length)?;
        Some(Vector::new(x, y))
    });
    let corners: Vec<Option<Vector>> = corners.collect();
    let corners: Vec<Vector> = corners.into_iter().collect::<Option<_>>()?;
    if let Some((corner, message, expected)) = not_convex(&corners) {
        checker.push(Problem::at(&list.value[corner].span, message, expected));
        return None;
    }
    Some(corners)
}

/// The first corner at which a polygon is not convex, what is wrong there and what was expected.
fn not_convex(corners: &[Vector]) -> Option<(usize, String, &'static str)> {
    let [low, high] = extents(corners.iter().copied());
    let size = (high - low).length();
    let sense = twice_area(corners);
    let number = corners.len();
    let edge = |k: usize| corners[(k + 1) % number] - corners[k % number];
    for k in 0..number {
        if edge(k).length() <= LEAST * size {
            let message = format!(
                "corners {k} and {} of the polygon are one",
                (k + 1) % number
            );
            return Some(((k + 1) % number, message, "expected another point"));
        }
    }
    let mut rounds = 0;
    for k in 0..number {
        let (into, out) = (edge(k + number - 1), edge(k));
        let turn = into.cross(out) / (into.length() * out.length());
        if turn.abs() < LEAST {
            let message = format!("the polygon does not turn at corner {k}");
            return Some((
                k,
                message,
                "expected no corner on the line through its neighbours",
            ));
        }
        if turn * sense <= 0.0 {
            let message = format!("the polygon is not convex at corner {k}");
            return Some((
                k,
                message,
                "expected that it turns to the same side everywhere",
            ));
        }
        // A convex polygon turns from downwards to upwards, or back, once.
        rounds += usize::from(falls(into) && !falls(out));
        if rounds > 1 {
            let message = format!("the polygon goes round a second time at corner {k}");
            return Some((k, message, "expected that its sides do not cross"));
        }
    }
    None
}

/// Whether a direction points downwards, or straight to the left.
fn falls(direction: Vector) -> bool {
    direction.y < 0.0 || (direction.y == 0.0 && direction.x < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn plan(corners: &[(f64, f64)]) -> BoxPlan {
        BoxPlan {
            shape: ShapePlan::Polygon(corners.iter().map(|&(x, y)| Vector::new(x, y)).collect()),
            span: 0..0,
        }
    }

    /// A triangle of base 4 and height 4 is 3 wide at height 1 and 1 wide at height 3.
    #[test]
    fn the_middle_of_a_triangle_is_a_trapezoid() {
        for corners in [
            [(0.0, 0.0), (4.0, 0.0), (2.0, 4.0)],
            [(0.0, 0.0), (2.0, 4.0), (4.0, 0.0)],
        ] {
            let triangle = plan(&corners);
            assert_eq!(triangle.part(1.0, 3.0).unwrap().area(), 4.0);
            assert_eq!(triangle.part(0.0, 4.0).unwrap().area(), 8.0);
            assert!(triangle.part(4.0, 5.0).is_none());
            assert!(triangle.part(3.0, 1.0).is_none());
        }
    }

    proptest! {
        /// A line parts a polygon into two that make it up.
        #[test]
        fn parts_add_up_to_the_whole(
            x in prop::collection::vec(-9_i32..9, 3),
            y in prop::collection::vec(-9_i32..9, 3),
            line in -10_i32..10,
        ) {
            let corners: Vec<Vector> =
                x.iter().zip(&y).map(|(x, y)| Vector::new(f64::from(*x), f64::from(*y))).collect();
            prop_assume!(twice_area(&corners) != 0.0);
            let triangle = BoxPlan { shape: ShapePlan::Polygon(corners), span: 0..0 };
            let area = |low, high| triangle.part(low, high).map_or(0.0, |part| part.area());
            let line = f64::from(line);
            let (below, above, whole) = (area(-10.0, line), area(line, 10.0), area(-10.0, 10.0));
            prop_assert!((below + above - whole).abs() < 1e-12 * whole, "{below} {above} {whole}");
        }
    }

    #[test]
    fn a_star_is_not_convex_though_it_turns_to_one_side() {
        let star = [
            (0.0, 3.0),
            (-2.0, -2.0),
            (3.0, 1.0),
            (-3.0, 1.0),
            (2.0, -2.0),
        ];
        let ShapePlan::Polygon(corners) = plan(&star).shape else {
            return;
        };
        let (_, message, _) = not_convex(&corners).unwrap();
        assert!(message.contains("second time"), "{message}");
        let reversed: Vec<Vector> = corners.into_iter().rev().collect();
        let (_, message, _) = not_convex(&reversed).unwrap();
        assert!(message.contains("second time"), "{message}");
    }
}
