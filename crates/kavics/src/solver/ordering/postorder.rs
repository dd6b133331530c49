//! The elimination tree, and orders in which every subtree stands together.

use super::graph::{Graph, NONE};

/// The elimination tree of a graph whose nodes are eliminated as they are numbered: the parent of each node, the first
/// later one its column of the factor reaches; `NONE` for a root.
///
/// Liu, J. W. H. (1990). The role of elimination trees in sparse factorization. *SIAM J. Matrix Anal. Appl.* 11,
/// 134–172, algorithm 4.2.
pub(super) fn elimination_tree(graph: &Graph) -> Vec<u32> {
    let mut parent = vec![NONE; graph.nodes()];
    let mut ancestor = vec![NONE; graph.nodes()];
    for node in 0..graph.nodes() as u32 {
        for &neighbour in graph.neighbours(node) {
            let mut below = neighbour;
            while below < node {
                let next = std::mem::replace(&mut ancestor[below as usize], node);
                if next == NONE {
                    parent[below as usize] = node;
                }
                below = next;
            }
        }
    }
    parent
}

/// Nodes in postorder: children before their parent, every subtree together, the largest child next to its parent, so
/// that the panels of both may become one.
pub(super) fn postorder(parent: &[u32]) -> Vec<u32> {
    let mut size = vec![1u32; parent.len()];
    for (node, &above) in parent.iter().enumerate() {
        if above != NONE {
            size[above as usize] += size[node];
        }
    }
    let largest = largest_children(parent, &size);
    // End of each subtree, and of what its smaller children have of it.
    let mut end = vec![0u32; parent.len()];
    let mut free = vec![0u32; parent.len()];
    let mut free_for_roots = parent.len() as u32;
    let mut order = vec![0; parent.len()];
    for node in (0..parent.len()).rev() {
        let above = parent[node] as usize;
        if parent[node] != NONE && largest[above] == node as u32 {
            end[node] = end[above] - 1;
        } else {
            let free = free.get_mut(above).unwrap_or(&mut free_for_roots);
            end[node] = *free;
            *free -= size[node];
        }
        order[end[node] as usize - 1] = node as u32;
        let reserved = size.get(largest[node] as usize).map_or(1, |size| size + 1);
        free[node] = end[node] - reserved;
    }
    order
}

fn largest_children(parent: &[u32], size: &[u32]) -> Vec<u32> {
    let mut largest = vec![NONE; parent.len()];
    for (node, &above) in parent.iter().enumerate() {
        if let Some(known) = largest.get_mut(above as usize)
            && (*known == NONE || size[*known as usize] <= size[node])
        {
            *known = node as u32;
        }
    }
    largest
}
