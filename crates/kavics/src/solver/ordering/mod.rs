//! In which order unknowns are eliminated, so that few entries fill in.
//!
//! In: which nodes are joined, how many unknowns each has, where it is. Out: an order of the nodes, and of their unknowns.
//! The unknowns of a node are eliminated one after the other, so that the graph is that of the nodes: a ninth of the
//! matrix where they have three each.

mod curve;
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

use curve::sort_along_curve;
use dissection::nested_dissection;
use minimum_degree::minimum_degree;
use postorder::{elimination_tree, postorder};

/// Fewest nodes that are dissected.
const FEWEST_DISSECTED: usize = 2000;
/// Fewest neighbours of a node, on average, where nodes are dissected.
const FEWEST_NEIGHBOURS: usize = 3;
/// Most nodes without position where the others are dissected.
const MOST_ANYWHERE: usize = 64;

/// Order to eliminate the nodes of a graph in, first to last. Positions are a hint: they change the work, not whether the
/// order is right.
///
/// Nodes of weight (number of unknowns) 0 are left out. Nodes with so many neighbours that minimum degree calls them dense
/// (more than 10√n) come after the others, and so do those without position if they are few. The others are dissected
/// where they are at least 2000 with three neighbours on average, else ordered by minimum degree. Why: in the plane
/// dissection here takes 0.5 to 0.8 of the operations of minimum degree for 1e5 nodes with four to six neighbours, and
/// about as many for 2000; where nodes have fewer than three neighbours, loose ends and chains are eliminated first and
/// minimum degree, which does so, is as good and takes half the time. Both costs are known before; computing both orders
/// would take longer than is won.
///
/// The order is a postorder of its elimination tree: the nodes of every subtree stand together.
///
/// # Panics
/// Where positions and weights are not as many as nodes.
pub fn elimination_order(
    graph: &Graph,
    positions: &[Option<[f64; 2]>],
    weights: &[u8],
) -> Vec<u32> {
    assert_eq!(positions.len(), graph.nodes());
    assert_eq!(weights.len(), graph.nodes());
    let (mut inner, mut last) = inner_and_last(graph, positions, weights);
    let position = |node: u32| positions[node as usize];
    let placed = inner.iter().all(|&node| position(node).is_some());
    if placed {
        sort_along_curve(&mut inner, |node| position(node).unwrap_or_default());
    }
    let part = graph.induced(&inner);
    let worthwhile = part.nodes() >= FEWEST_DISSECTED
        && part.neighbour.len() >= FEWEST_NEIGHBOURS * part.nodes();
    let order = if placed && worthwhile {
        let positions = inner.iter().map(|&node| position(node).unwrap_or_default());
        nested_dissection(&part, positions.collect())
    } else {
        minimum_degree(&part)
    };
    let mut nodes: Vec<u32> = order.iter().map(|&node| inner[node as usize]).collect();
    nodes.append(&mut last);
    let places = postorder(&elimination_tree(&graph.induced(&nodes)));
    places.iter().map(|&place| nodes[place as usize]).collect()
}

/// The nodes with unknowns, and of them those that are eliminated last, in their order.
fn inner_and_last(
    graph: &Graph,
    positions: &[Option<[f64; 2]>],
    weights: &[u8],
) -> (Vec<u32>, Vec<u32>) {
    let nodes = 0..graph.nodes() as u32;
    let kept: Vec<u32> = nodes.filter(|&node| weights[node as usize] > 0).collect();
    let dense = (10.0 * (kept.len() as f64).sqrt()).max(16.0) as usize;
    let is_anywhere = |node: u32| positions[node as usize].is_none();
    let anywhere = kept.iter().filter(|&&node| is_anywhere(node)).count();
    let is_last =
        |&node: &u32| graph.degree(node) > dense || anywhere <= MOST_ANYWHERE && is_anywhere(node);
    let (mut last, inner): (Vec<u32>, Vec<u32>) = kept.into_iter().partition(is_last);
    last.sort_by_key(|&node| (graph.degree(node), node));
    (inner, last)
}

/// The unknowns in an order of their nodes, from the numbers of each node's unknowns.
pub fn unknowns_in_order<const N: usize>(
    order: &[u32],
    numbers: &[[Option<u32>; N]],
) -> Vec<usize> {
    let unknowns = order.iter().flat_map(|&node| &numbers[node as usize]);
    unknowns.flatten().map(|&number| number as usize).collect()
}
