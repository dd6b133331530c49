//! Where a part is cut.

use super::flow::{Flow, Side};
use super::part::Part;

/// Share of the nodes that surely is on each side of a cut.
const SURE: f64 = 0.3;
/// Directions that cuts are tried across.
const DIRECTIONS: [[f64; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, -1.0]];

/// The sides of a good cut of a part; what is in the middle separates them. None where every cut is poor.
///
/// Along some directions the nodes that come first are one set, those that come last another; what is in between is cut
/// by the fewest nodes. Schild, A. & Sommer, C. (2015). On balanced separators in road networks. *Experimental Algorithms*,
/// LNCS 9125, 286–297. Here nodes are cut, not edges.
pub(super) fn best_cut(part: &Part) -> Option<Vec<Side>> {
    let mut best: Option<(f64, Vec<Side>)> = None;
    let mut most = part.nodes() / 4;
    for direction in DIRECTIONS {
        let outer = outer_sides(part, direction);
        let Some(mut flow) = Flow::new(&part.graph, &outer).saturate(most) else {
            continue;
        };
        most = most.min(flow.paths() + flow.paths() / 8);
        for sides in [flow.cut_near_first(), flow.cut_near_second()] {
            let price = price(&sides[..part.nodes()]);
            if best.as_ref().is_none_or(|(least, _)| price < *least) {
                best = Some((price, sides));
            }
        }
    }
    best.map(|(_, sides)| sides)
}

/// The outer thirds of a part along a direction as its sides.
fn outer_sides(part: &Part, direction: [f64; 2]) -> Vec<Side> {
    let nodes = part.nodes();
    let along = |node: u32| {
        let [x, y] = part.position[node as usize];
        x * direction[0] + y * direction[1]
    };
    let mut ranked: Vec<(f64, u32)> = (0..nodes as u32).map(|node| (along(node), node)).collect();
    let before = |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
    let sure = ((SURE * nodes as f64) as usize).max(1);
    ranked.select_nth_unstable_by(sure, before);
    ranked[sure..].select_nth_unstable_by(nodes - 2 * sure, before);
    let mut side = vec![Side::Outside; part.original.len()];
    for (rank, &(_, node)) in ranked.iter().enumerate() {
        side[node as usize] = if rank < sure {
            Side::First
        } else if rank < nodes - sure {
            Side::Middle
        } else {
            Side::Second
        };
    }
    side
}

/// What a cut costs: the cube of its separator for the dense triangle it becomes, and the power 3/2 of each side for
/// what the side will cost in its turn.
fn price(sides: &[Side]) -> f64 {
    let count = |wanted: Side| sides.iter().filter(|&&side| side == wanted).count() as f64;
    let (first, second, separator) = (count(Side::First), count(Side::Second), count(Side::Middle));
    separator * separator * separator + 3.4 * (first * first.sqrt() + second * second.sqrt())
}
