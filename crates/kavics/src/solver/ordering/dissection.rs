//! Orders by nested dissection.
//!
//! A separator cuts a part in two and is eliminated after both: George, A. (1973). Nested dissection of a regular finite
//! element mesh. *SIAM J. Numer. Anal.* 10, 345–363.

use super::cut::best_cut;
use super::graph::Graph;
use super::leaf::order_leaf;
use super::minimum_degree::minimum_degree;
use super::part::Part;

/// A part of no more nodes is not cut further.
const LEAF: usize = 96;
/// From so many nodes on, both sides are ordered at the same time.
const LARGE: usize = 4096;

/// Order of the nodes of a graph by nested dissection.
pub(super) fn nested_dissection(graph: &Graph, position: Vec<[f64; 2]>) -> Vec<u32> {
    let whole = Part {
        graph: graph.clone(),
        original: (0..graph.nodes() as u32).collect(),
        position,
    };
    let mut order = vec![0; graph.nodes()];
    dissect(&whole, &mut order);
    order
}

fn dissect(part: &Part, out: &mut [u32]) {
    if part.nodes() <= LEAF {
        return order_leaf(part, out);
    }
    let Some(side) = best_cut(part) else {
        for (place, node) in out.iter_mut().zip(minimum_degree(&part.inner_graph())) {
            *place = part.original[node as usize];
        }
        return;
    };
    let ([first, second], separator) = part.divided(&side);
    let (sides, last) = out.split_at_mut(part.nodes() - separator.len());
    last.copy_from_slice(&separator);
    let (of_first, of_second) = sides.split_at_mut(first.nodes());
    if part.nodes() >= LARGE {
        rayon::join(|| dissect(&first, of_first), || dissect(&second, of_second));
    } else {
        dissect(&first, of_first);
        dissect(&second, of_second);
    }
}
