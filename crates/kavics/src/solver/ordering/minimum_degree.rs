//! Orders by approximate minimum degree.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

use super::graph::Graph;

/// Order of the nodes of a graph by approximate minimum degree.
///
/// Amestoy, P. R., Davis, T. A. & Duff, I. S. (1996). An approximate minimum degree ordering algorithm. *SIAM J. Matrix
/// Anal. Appl.* 17, 886–905.
pub(super) fn minimum_degree(graph: &Graph) -> Vec<u32> {
    let nodes = graph.nodes();
    if graph.neighbour.is_empty() {
        return (0..nodes as u32).collect();
    }
    let pattern = SymbolicSparseColMatRef::new_unsorted_checked(
        nodes,
        nodes,
        &graph.start,
        None,
        &graph.neighbour,
    );
    let scratch = amd::order_maybe_unsorted_scratch::<u32>(nodes, graph.neighbour.len());
    let (mut order, mut place) = (vec![0; nodes], vec![0; nodes]);
    let ordered = amd::order_maybe_unsorted(
        &mut order,
        &mut place,
        pattern,
        amd::Control::default(),
        MemStack::new(&mut MemBuffer::new(scratch)),
    );
    // It fails only where the edges are too many for their index type.
    ordered.map_or_else(|_| (0..nodes as u32).collect(), |_| order)
}
