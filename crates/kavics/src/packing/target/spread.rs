//! Discs spread over a container at random, large and small mixed evenly.
//!
//! The points of a sequence that fills the plane evenly (Roberts, 2018) from a random start, those outside left out,
//! take the radii from the largest to the smallest, so each size is everywhere. Then each is moved at random.

use crate::assembly::Grain;
use crate::geometry::{Container, Vector};
use crate::packing::random::{Purpose, stream};

/// Width of the square over which a disc is moved at random, in mean spacings.
const SHIFT: f64 = 3.0;
/// Steps of the sequence: 1/ρ and 1/ρ² with ρ³ = ρ + 1.
const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

/// Discs with these radii, in rows from the bottom; they overlap.
pub(super) fn spread(container: &Container, radii: &[f64], seed: u64) -> Vec<Grain> {
    let mut random = stream(seed, Purpose::Positions);
    let frame = Frame::new(container);
    let shift = SHIFT * (container.area() / radii.len() as f64).sqrt();
    let mut at = [random.unit(), random.unit()];
    let mut radii = radii.to_vec();
    radii.sort_by(|a, b| b.total_cmp(a));
    let place = |&radius: &f64| {
        let point = loop {
            at = [(at[0] + STEPS[0]) % 1.0, (at[1] + STEPS[1]) % 1.0];
            let point = frame.point(at);
            if container.depth(point) >= 0.0 {
                break point;
            }
        };
        let random = Vector::new(random.unit() - 0.5, random.unit() - 0.5);
        Grain {
            centre: point + random * shift,
            radius,
        }
    };
    let discs = radii.iter().map(place).collect();
    in_rows(discs)
}

/// Neighbours in the plane are neighbours in memory.
fn in_rows(mut discs: Vec<Grain>) -> Vec<Grain> {
    let height = 2.0 * discs.iter().map(|d| d.radius).sum::<f64>() / discs.len() as f64;
    let row = |d: &Grain| (d.centre.y / height).floor();
    discs.sort_by(|a, b| {
        row(a)
            .total_cmp(&row(b))
            .then(a.centre.x.total_cmp(&b.centre.x))
    });
    discs
}

/// The rectangle around a container along its longest diagonal, which is filled at least by half.
struct Frame {
    origin: Vector,
    along: Vector,
    across: Vector,
}

impl Frame {
    fn new(container: &Container) -> Self {
        let corners = container.corners();
        let [start, end] = farthest(corners);
        let along = end - start;
        let across = along.quarter_turn() * (1.0 / along.length());
        let heights = corners.iter().map(|&c| (c - start).dot(across));
        let low = heights.clone().fold(0.0_f64, f64::min);
        let high = heights.fold(0.0_f64, f64::max);
        Self {
            origin: start + across * low,
            along,
            across: across * (high - low),
        }
    }

    fn point(&self, [u, v]: [f64; 2]) -> Vector {
        self.origin + self.along * u + self.across * v
    }
}

fn farthest(corners: &[Vector]) -> [Vector; 2] {
    let mut best = [corners[0], corners[0]];
    for (k, &a) in corners.iter().enumerate() {
        for &b in &corners[k + 1..] {
            if (b - a).length_squared() > (best[1] - best[0]).length_squared() {
                best = [a, b];
            }
        }
    }
    best
}
