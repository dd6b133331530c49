//! The order of elimination: what it must be, and what a factor in it costs.

use std::collections::BTreeSet;

use kavics::solver::ordering::{Graph, cost, elimination_order, unknowns_in_order};
use proptest::prelude::*;

/// A graph whose nodes have unknowns and places, or not.
#[derive(Clone, Debug)]
struct Nodes {
    graph: Graph,
    positions: Vec<Option<[f64; 2]>>,
    weights: Vec<u8>,
}

impl Nodes {
    fn order(&self) -> Vec<u32> {
        elimination_order(&self.graph, &self.positions, &self.weights)
    }
}

fn nodes() -> impl Strategy<Value = Nodes> {
    let place = (any::<bool>(), 0.0..1.0, 0.0..1.0);
    let place = place.prop_map(|(placed, x, y)| placed.then_some([x, y]));
    (0_u32..30).prop_flat_map(move |count| {
        let edges = prop::collection::vec([0..count.max(1), 0..count.max(1)], 0..60);
        let places = prop::collection::vec(place.clone(), count as usize);
        let weights = prop::collection::vec(0_u8..=3, count as usize);
        (edges, places, weights).prop_map(move |(mut edges, positions, weights)| {
            edges.retain(|_| count > 0);
            let graph = Graph::from_edges(count as usize, edges.into_iter());
            Nodes {
                graph,
                positions,
                weights,
            }
        })
    })
}

/// Points of a square grid, joined along its lines and along the diagonals of its squares.
fn square_grid(points: u32) -> Nodes {
    let number = |x: u32, y: u32| y * points + x;
    let pairs = (0..points).flat_map(|y| (0..points).map(move |x| (x, y)));
    let steps = [(1, 0), (0, 1), (1, 1), (-1, 1)];
    let edges = pairs.clone().flat_map(move |(x, y)| {
        let ends = steps.into_iter().map(move |(along, up)| {
            let (to_x, to_y) = (x.wrapping_add_signed(along), y + up);
            (to_x < points && to_y < points).then(|| [number(x, y), number(to_x, to_y)])
        });
        ends.flatten()
    });
    Nodes {
        graph: Graph::from_edges((points * points) as usize, edges),
        positions: pairs
            .map(|(x, y)| Some([f64::from(x), f64::from(y)]))
            .collect(),
        weights: vec![1; (points * points) as usize],
    }
}

/// Columns of the factor, as places of the order, by eliminating node after node.
fn columns(graph: &Graph, order: &[u32]) -> Vec<BTreeSet<usize>> {
    let place = |node: u32| order.iter().position(|&other| other == node);
    let mut columns: Vec<BTreeSet<usize>> = order
        .iter()
        .map(|&node| {
            graph
                .neighbours(node)
                .iter()
                .filter_map(|&n| place(n))
                .collect()
        })
        .collect();
    for column in 0..order.len() {
        let below: BTreeSet<usize> = columns[column].split_off(&column);
        if let Some(&parent) = below.first() {
            let joined: Vec<usize> = below.iter().copied().filter(|&row| row > parent).collect();
            columns[parent].extend(joined);
        }
        columns[column] = below;
    }
    columns
}

proptest! {
    #[test]
    fn every_node_with_unknowns_stands_in_the_order_once(nodes in nodes()) {
        let mut order = nodes.order();
        order.sort_unstable();
        let all = 0..nodes.graph.nodes() as u32;
        let wanted: Vec<u32> = all.filter(|&node| nodes.weights[node as usize] > 0).collect();
        prop_assert_eq!(order, wanted);
    }

    #[test]
    fn subtrees_of_the_elimination_tree_stand_together(nodes in nodes()) {
        let columns = columns(&nodes.graph, &nodes.order());
        let mut first: Vec<usize> = (0..columns.len()).collect();
        let mut size = vec![1; columns.len()];
        for (place, column) in columns.iter().enumerate() {
            prop_assert_eq!(first[place] + size[place], place + 1);
            if let Some(&parent) = column.first() {
                first[parent] = first[parent].min(first[place]);
                size[parent] += size[place];
            }
        }
    }

    #[test]
    fn the_cost_is_that_of_the_columns_of_the_factor(nodes in nodes()) {
        let order = nodes.order();
        let weight = |place: usize| u32::from(nodes.weights[order[place] as usize]);
        let (mut entries, mut operations) = (0, 0);
        for (place, column) in columns(&nodes.graph, &order).iter().enumerate() {
            let below: u32 = column.iter().map(|&row| weight(row)).sum();
            for unknown in 1..=weight(place) {
                entries += below + unknown;
                operations += (below + unknown).pow(2);
            }
        }
        let cost = cost(&nodes.graph, &order, &nodes.weights);
        prop_assert_eq!(cost.entries, f64::from(entries));
        prop_assert_eq!(cost.operations, f64::from(operations));
    }

    #[test]
    fn an_edge_stands_in_the_lists_of_both_ends(nodes in nodes()) {
        for node in 0..nodes.graph.nodes() as u32 {
            for &neighbour in nodes.graph.neighbours(node) {
                prop_assert_ne!(neighbour, node);
                prop_assert!(nodes.graph.neighbours(neighbour).contains(&node));
            }
        }
    }
}

/// Duff, Erisman & Reid (1976), On George's nested dissection method, SIAM J. Numer. Anal. 13, 686–695: on n × n points of
/// nine-point operators the dissection of George takes (829/84)n³ multiplications and 7.75n² log₂ n entries to first order.
#[test]
fn a_square_grid_costs_no_more_than_by_the_dissection_of_george() {
    let points = 100;
    let grid = square_grid(points);
    let cost = cost(&grid.graph, &grid.order(), &grid.weights);
    let n = f64::from(points);
    assert!(cost.operations / 2.0 < 829.0 / 84.0 * n * n * n);
    assert!(cost.entries < 7.75 * n * n * n.log2());
}

#[test]
fn a_tree_fills_nothing_in() {
    let nodes = 3000;
    let edges = (1..nodes).map(|node| [node, node / 2]);
    let graph = Graph::from_edges(nodes as usize, edges);
    let weights = vec![1; nodes as usize];
    let order = elimination_order(&graph, &vec![Some([0.0; 2]); nodes as usize], &weights);
    // One entry on the diagonal a node, and one an edge.
    assert_eq!(
        cost(&graph, &order, &weights).entries,
        f64::from(2 * nodes - 1)
    );
}

/// Fibres between two plates: each is joined to both, and to nothing else.
#[test]
fn nodes_that_touch_all_others_come_last_and_fill_nothing_in() {
    let fibres = 10_000;
    let edges = (0..fibres).flat_map(|fibre| [[fibre, fibres], [fibre, fibres + 1]]);
    let graph = Graph::from_edges(fibres as usize + 2, edges);
    let positions: Vec<_> = (0..fibres + 2)
        .map(|node| Some([f64::from(node), 0.0]))
        .collect();
    let weights = vec![1; fibres as usize + 2];
    let order = elimination_order(&graph, &positions, &weights);
    assert_eq!(order[fibres as usize..], [fibres, fibres + 1]);
    // Two entries below the diagonal a fibre, and that of the plates.
    assert_eq!(
        cost(&graph, &order, &weights).entries,
        f64::from(3 * fibres + 3)
    );
}

#[test]
fn a_node_without_position_comes_last_where_the_others_have_some() {
    let mut grid = square_grid(60);
    grid.positions[1234] = None;
    assert_eq!(grid.order().last(), Some(&1234));
}

/// Every cut by such positions is a poor one, and none is made.
#[test]
fn positions_that_tell_nothing_do_no_harm() {
    let mut grid = square_grid(50);
    let by_position = cost(&grid.graph, &grid.order(), &grid.weights);
    let places = grid.positions.clone();
    for (node, position) in grid.positions.iter_mut().enumerate() {
        // 1009 is prime and so reaches every place.
        *position = places[1009 * node % places.len()];
    }
    let without = cost(&grid.graph, &grid.order(), &grid.weights);
    assert!(without.operations < 3.0 * by_position.operations);
}

#[test]
fn the_order_is_the_same_on_any_number_of_threads() {
    let grid = square_grid(100);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(|| grid.order())
    };
    assert_eq!(on(1), on(2));
}

#[test]
fn no_nodes_have_an_empty_order() {
    assert!(elimination_order(&Graph::default(), &[], &[]).is_empty());
    let lone = Graph::from_edges(1, std::iter::empty());
    assert_eq!(elimination_order(&lone, &[None], &[2]), [0]);
}

#[test]
fn unknowns_follow_their_nodes() {
    let numbers = [[Some(0), None], [None, None], [Some(1), Some(2)]];
    assert_eq!(unknowns_in_order(&[2, 0], &numbers), [1, 2, 0]);
}
