//! From the lengths of the scene to the sheet.

use kavics::assembly::{Grain, extents};
use kavics::geometry::Vector;

/// Empty border of the sheet, mm.
pub(crate) const MARGIN: f64 = 2.0;

/// Height of the tallest assembly on a sheet, mm.
const MOST_HEIGHT: f64 = 220.0;

/// How far beyond the undeformed assembly, in its extents, a displaced grain is still shown.
const BEYOND: f64 = 0.5;

/// Where points of the plane are on the sheet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    low: Vector,
    high: Vector,
    left: f64,
    /// Millimetres a length.
    pub scale: f64,
    /// Height of the sheet down to the lower border of the assembly, mm.
    pub bottom: f64,
}

impl View {
    /// The view of grains, before loading and where they are drawn, on a sheet so wide.
    pub fn of(grains: &[Grain], centres: &[Vector], width: f64) -> Self {
        let edges = |centre: Vector, radius: f64| {
            let corner = Vector::new(radius, radius);
            [centre - corner, centre + corner]
        };
        let before = grains.iter().flat_map(|g| edges(g.centre, g.radius));
        let [low, high] = not_empty(extents(before));
        let reach = (high - low) * BEYOND;
        let drawn = grains.iter().zip(centres);
        let drawn = drawn.flat_map(|(grain, &centre)| edges(centre, grain.radius));
        let [from, to] = not_empty(extents(
            drawn.filter(|p| p.x.is_finite() && p.y.is_finite()),
        ));
        let low = Vector::new(from.x.max(low.x - reach.x), from.y.max(low.y - reach.y));
        let high = Vector::new(to.x.min(high.x + reach.x), to.y.min(high.y + reach.y));
        let [across, upwards] = [high.x - low.x, high.y - low.y].map(|extent| extent.max(1e-300));
        let scale = ((width - 2.0 * MARGIN) / across).min(MOST_HEIGHT / upwards);
        Self {
            low,
            high,
            left: 0.5 * (width - across * scale),
            scale,
            bottom: 2.0 * MARGIN + upwards * scale,
        }
    }

    /// A point on the sheet.
    pub fn point(&self, point: Vector) -> Vector {
        Vector::new(
            self.left + (point.x - self.low.x) * self.scale,
            MARGIN + (self.high.y - point.y) * self.scale,
        )
    }

    /// A line on the sheet.
    pub fn line(&self, ends: [Vector; 2]) -> [Vector; 2] {
        ends.map(|end| self.point(end))
    }

    /// A length on the sheet, mm.
    pub fn length(&self, length: f64) -> f64 {
        length * self.scale
    }

    /// Width of what is seen, `[length]`.
    pub fn width(&self) -> f64 {
        self.high.x - self.low.x
    }

    /// The part of a line that is seen, with the border around it; Liang & Barsky (1984).
    pub fn clip(&self, [from, to]: [Vector; 2]) -> Option<[Vector; 2]> {
        let border = 0.75 * MARGIN / self.scale;
        let (low, high) = (self.low, self.high);
        let along = to - from;
        let mut span = [0.0_f64, 1.0_f64];
        let limits = [
            (-along.x, from.x - (low.x - border)),
            (along.x, high.x + border - from.x),
            (-along.y, from.y - (low.y - border)),
            (along.y, high.y + border - from.y),
        ];
        for (speed, room) in limits {
            if speed < 0.0 {
                span[0] = span[0].max(room / speed);
            } else if speed > 0.0 {
                span[1] = span[1].min(room / speed);
            } else if room < 0.0 {
                return None;
            }
        }
        (span[0] < span[1]).then(|| span.map(|share| from + along * share))
    }
}

fn not_empty([low, high]: [Vector; 2]) -> [Vector; 2] {
    if low.x <= high.x && low.y <= high.y {
        [low, high]
    } else {
        [Vector::default(), Vector::new(1.0, 1.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn view(width: f64) -> View {
        let grain = |x, y| Grain {
            centre: Vector::new(x, y),
            radius: 1.0,
        };
        let grains = [grain(1.0, 1.0), grain(9.0, 4.0)];
        let centres = grains.map(|grain| grain.centre);
        View::of(&grains, &centres, width)
    }

    #[test]
    fn grains_fill_the_width_between_the_borders() {
        let view = view(84.0);
        assert_eq!(view.scale, 8.0);
        assert_eq!(view.point(Vector::new(0.0, 5.0)), Vector::new(2.0, 2.0));
        assert_eq!(view.point(Vector::new(10.0, 0.0)), Vector::new(82.0, 42.0));
        assert_eq!(view.bottom, 44.0);
    }

    proptest! {
        #[test]
        fn what_is_left_of_a_line_lies_on_it_and_on_the_sheet(
            x in -50.0..50.0_f64, y in -50.0..50.0_f64, u in -50.0..50.0_f64, v in -50.0..50.0_f64,
        ) {
            let (from, to) = (Vector::new(x, y), Vector::new(u, v));
            let view = view(84.0);
            if let Some(ends) = view.clip([from, to]) {
                for end in ends {
                    prop_assert!((to - from).cross(end - from).abs() < 1e-9);
                    let at = view.point(end);
                    prop_assert!(at.x > 0.0 && at.x < 84.0 && at.y > 0.0 && at.y < view.bottom);
                }
            }
        }
    }
}
