//! Where a part is cut.

use super::flow::{Flow, Middle, Side};
use super::graph::{Graph, NONE};
use super::part::Part;

/// Rows of nodes in the middle of a cut.
const ROWS: f64 = 20.0;
/// Largest share of the nodes that is in the middle of a cut.
const MIDDLE: f64 = 0.4;
/// Price of a side of one node against that of a separator of one: where the separators of halves shrink with the square
/// root of the nodes, all of them below cost 1/(1 - 1/√2) times the first.
const SIDES: f64 = 3.414;
/// Directions that cuts are tried across.
const DIRECTIONS: [[f64; 2]; 2] = [[1.0, 0.0], [0.0, 1.0]];

/// Sides of a good cut of a part; what is in the middle separates them. None where every cut is poor.
///
/// Along some directions the nodes that come first are one set, those that come last another; what is in between is cut
/// by the fewest nodes. Schild, A. & Sommer, C. (2015). On balanced separators in road networks. *Experimental Algorithms*,
/// LNCS 9125, 286–297. Here nodes are cut, not edges.
pub(super) fn best_cut(part: &Part) -> Option<Vec<Side>> {
    let mut best: Option<(f64, Vec<Side>)> = None;
    // Any planar graph has a separator of 2√2·√n nodes: Lipton, R. J. & Tarjan, R. E. (1979). A separator theorem for
    // planar graphs. *SIAM J. Appl. Math.* 36, 177–189.
    let mut most = (8.0 * part.nodes() as f64).sqrt() as usize;
    for direction in DIRECTIONS {
        let band = Band::new(part, direction);
        let middle = band.middle(part);
        let Some(flow) = Flow::new(&middle, most) else {
            continue;
        };
        most = most.min(flow.paths() + flow.paths() / 8);
        for sides in [flow.cut_near_first(), flow.cut_near_second()] {
            let price = band.price(&sides);
            if best.as_ref().is_none_or(|(least, _)| price < *least) {
                best = Some((price, band.sides(&sides)));
            }
        }
    }
    best.map(|(_, sides)| sides)
}

/// The nodes of a part by how far along a direction they are.
struct Band {
    ranked: Vec<(f64, u32)>,
    /// Number of nodes on each side of the middle.
    outer: usize,
}

impl Band {
    fn new(part: &Part, direction: [f64; 2]) -> Self {
        let along = |[x, y]: [f64; 2]| x * direction[0] + y * direction[1];
        let mut ranked: Vec<(f64, u32)> = part
            .position
            .iter()
            .zip(0..)
            .map(|(&position, node)| (along(position), node))
            .collect();
        let before = |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        let nodes = part.nodes() as f64;
        let middle = (ROWS * nodes.sqrt()).min(MIDDLE * nodes);
        let outer = ((part.nodes() - middle as usize) / 2).max(1);
        let inner_end = part.nodes() - outer;
        ranked.select_nth_unstable_by(outer, before);
        ranked[outer..].select_nth_unstable_by(inner_end - outer, before);
        ranked[outer..inner_end].sort_unstable_by(before);
        Self { ranked, outer }
    }

    fn inner(&self) -> &[(f64, u32)] {
        &self.ranked[self.outer..self.ranked.len() - self.outer]
    }

    fn middle(&self, part: &Part) -> Middle {
        const FIRST: u32 = NONE - 1;
        const SECOND: u32 = NONE - 2;
        let mut number = vec![NONE; part.original.len()];
        for &(_, node) in &self.ranked[..self.outer] {
            number[node as usize] = FIRST;
        }
        for &(_, node) in &self.ranked[self.ranked.len() - self.outer..] {
            number[node as usize] = SECOND;
        }
        for (new, &(_, node)) in self.inner().iter().enumerate() {
            number[node as usize] = new as u32;
        }
        let mut graph = Graph {
            start: vec![0],
            neighbour: Vec::new(),
        };
        let mut beside = Vec::with_capacity(self.inner().len());
        for &(_, node) in self.inner() {
            let from = graph.neighbour.len();
            let mut is_beside = [false; 2];
            for &neighbour in part.graph.neighbours(node) {
                match number[neighbour as usize] {
                    FIRST => is_beside[0] = true,
                    SECOND => is_beside[1] = true,
                    NONE => {}
                    new => graph.neighbour.push(new),
                }
            }
            graph.neighbour[from..].sort_unstable();
            graph.start.push(graph.neighbour.len() as u32);
            beside.push(is_beside);
        }
        Middle { graph, beside }
    }

    /// The sides of all nodes from those of the middle.
    fn sides(&self, of_middle: &[Side]) -> Vec<Side> {
        let mut sides = vec![Side::First; self.ranked.len()];
        for &(_, node) in &self.ranked[self.ranked.len() - self.outer..] {
            sides[node as usize] = Side::Second;
        }
        for (&(_, node), &side) in self.inner().iter().zip(of_middle) {
            sides[node as usize] = side;
        }
        sides
    }

    /// What a cut costs: the cube of its separator for the dense triangle it becomes, and the power 3/2 of each side for
    /// what the side will cost in its turn.
    fn price(&self, of_middle: &[Side]) -> f64 {
        let count = |wanted: Side| of_middle.iter().filter(|&&side| side == wanted).count();
        let separator = count(Side::Middle) as f64;
        let sides = [Side::First, Side::Second].map(|side| (self.outer + count(side)) as f64);
        separator * separator * separator + SIDES * sides.map(|n| n * n.sqrt()).iter().sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square lattice of n rows has n paths along its rows: no fewer nodes separate its ends, and a column does.
    #[test]
    fn a_square_lattice_is_cut_by_as_many_nodes_as_it_has_rows() {
        let rows = 15;
        let right = (0..rows * rows)
            .filter(|node| node % rows + 1 < rows)
            .map(|node| [node, node + 1]);
        let up = (0..rows * (rows - 1)).map(|node| [node, node + rows]);
        let nodes = 0..rows * rows;
        let part = Part {
            graph: Graph::from_edges(nodes.len(), right.chain(up)),
            original: nodes.clone().collect(),
            position: nodes
                .map(|node| [f64::from(node % rows), f64::from(node / rows)])
                .collect(),
        };
        let sides = best_cut(&part).expect("a cut");
        let separator = sides.iter().filter(|&&side| side == Side::Middle).count();
        assert_eq!(separator, rows as usize);
        let ([first, second], _) = part.divided(&sides);
        assert_eq!(first.nodes() + second.nodes() + separator, part.nodes());
        // Up to two fifths of the nodes may be cut; the others are sure to be on their sides.
        assert!(first.nodes().min(second.nodes()) >= part.nodes() * 3 / 10);
    }
}
