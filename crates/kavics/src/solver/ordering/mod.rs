//! In which order unknowns are eliminated, so that few entries fill in.
//!
//! In: which nodes are connected, how many unknowns each has, where it is. Out: an order of the nodes, and of their
//! unknowns. All unknowns of a node are eliminated one after the other, so that the graph is that of the nodes, a tenth
//! of the matrix.

mod cut;
mod dissection;
mod fill;
mod flow;
mod graph;
mod leaf;
mod minimum_degree;
mod part;
mod postorder;

pub use fill::{Cost, cost};
pub use graph::Graph;

use dissection::nested_dissection;
use minimum_degree::minimum_degree;
use postorder::{elimination_tree, postorder};

/// Up to so many nodes without position are eliminated after all others; with more of them positions are not used.
const MOST_ANYWHERE: usize = 64;

/// How the nodes are put in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ordering {
    /// Approximate minimum degree.
    MinimumDegree,
    /// Nested dissection.
    Dissection,
}

/// Order to eliminate the nodes of a graph in: the nodes, first to last.
///
/// Nodes of weight 0 have no unknowns and are left out. Nodes with very many neighbours come last, and so do those
/// without position. The order is a postorder of its elimination tree: the nodes of every subtree stand together.
pub fn elimination_order(
    graph: &Graph,
    positions: &[Option<[f64; 2]>],
    weights: &[u8],
) -> Vec<u32> {
    let choice = if graph.nodes() < 1000 {
        Ordering::MinimumDegree
    } else {
        Ordering::Dissection
    };
    elimination_order_by(choice, graph, positions, weights)
}

/// The same in a way that is asked for.
pub fn elimination_order_by(
    ordering: Ordering,
    graph: &Graph,
    positions: &[Option<[f64; 2]>],
    weights: &[u8],
) -> Vec<u32> {
    let kept: Vec<u32> = nodes(graph)
        .filter(|&node| weights[node as usize] > 0)
        .collect();
    // The bound of approximate minimum degree on rows it calls dense.
    let many = (10.0 * (kept.len() as f64).sqrt()).max(16.0);
    let anywhere = kept
        .iter()
        .filter(|&&node| positions[node as usize].is_none())
        .count();
    let dissects = ordering == Ordering::Dissection && anywhere <= MOST_ANYWHERE;
    let is_last = |node: u32| {
        graph.degree(node) as f64 > many || dissects && positions[node as usize].is_none()
    };
    let (mut last, mut inner): (Vec<u32>, Vec<u32>) =
        kept.into_iter().partition(|&node| is_last(node));
    last.sort_by_key(|&node| (graph.degree(node), node));
    if dissects {
        sort_along_curve(&mut inner, positions);
    }
    let part = graph.induced(&inner);
    let order = if dissects {
        let position = |&node: &u32| positions[node as usize].unwrap_or_default();
        nested_dissection(&part, inner.iter().map(position).collect())
    } else {
        minimum_degree(&part)
    };
    inner = order.into_iter().map(|node| inner[node as usize]).collect();
    inner.append(&mut last);
    let whole = graph.induced(&inner);
    let order = postorder(&elimination_tree(&whole));
    order.into_iter().map(|node| inner[node as usize]).collect()
}

/// The unknowns in an order of their nodes.
pub fn expanded(order: &[u32], unknowns: impl Fn(u32) -> Vec<usize>) -> Vec<usize> {
    order.iter().flat_map(|&node| unknowns(node)).collect()
}

fn nodes(graph: &Graph) -> std::ops::Range<u32> {
    0..graph.nodes() as u32
}

/// Sorts nodes along a curve through their positions, so that neighbours are near in memory.
fn sort_along_curve(nodes: &mut [u32], positions: &[Option<[f64; 2]>]) {
    let position = |node: u32| positions[node as usize].unwrap_or_default();
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for &node in nodes.iter() {
        for axis in 0..2 {
            low[axis] = low[axis].min(position(node)[axis]);
            high[axis] = high[axis].max(position(node)[axis]);
        }
    }
    let extent = (high[0] - low[0]).max(high[1] - low[1]);
    let scale = if extent > 0.0 { 65535.0 / extent } else { 0.0 };
    nodes.sort_by_cached_key(|&node| {
        let [x, y] = position(node);
        let cell = |value: f64, low: f64| ((value - low) * scale) as u16;
        (interleaved(cell(x, low[0]), cell(y, low[1])), node)
    });
}

/// The bits of two numbers in turn: the place of a square on the curve of Morton.
fn interleaved(x: u16, y: u16) -> u32 {
    let spread = |value: u16| {
        let mut spread = u32::from(value);
        for (shift, mask) in [
            (8, 0x00ff_00ff),
            (4, 0x0f0f_0f0f),
            (2, 0x3333_3333),
            (1, 0x5555_5555),
        ] {
            spread = (spread | spread << shift) & mask;
        }
        spread
    };
    spread(x) | spread(y) << 1
}
