//! A million grains keep the identities that `geometry.rs` proves for few: `cargo nextest run --release -p kavics
//! --test million --run-ignored all --no-capture`.

use kavics::assembly::{
    Between, Bodies, Grain, Partner, Side, Site, box_sides, contact_graph, container,
};
use kavics::geometry::{Grid, Vector, power_diagram};
use kavics::ids::{PerGrain, PerSide, SideId};
use kavics::packing::{Bed, Sizes, dropped};

const COUNT: usize = 1_000_000;
const WIDTH: f64 = 1500.0;
const SEED: u64 = 1;
/// Of every identity, relative.
const TOLERANCE: f64 = 1e-10;

fn pack() -> (PerGrain<Grain>, PerSide<Side>) {
    let sizes = Sizes::Uniform { from: 0.5, to: 1.5 };
    let radii = sizes.radii(COUNT, SEED).expect("radii");
    let dropped = dropped::drop(&Bed::empty_box(WIDTH), &radii, 1, SEED).expect("a pack");
    let tops = dropped
        .grains
        .values()
        .iter()
        .map(|g| g.centre.y + g.radius);
    let sides = box_sides(WIDTH, tops.fold(0.0, f64::max), [true; 4]);
    (dropped.grains, sides)
}

/// Σ s·l·n⊗n over the dual edges, and over the sides Σ s·N⊗(x_mid − x); and what closes each cell, Σ s·n and Σ s.
struct Sums {
    columns: [Vector; 2],
    open: Vec<(Vector, f64)>,
}

impl Sums {
    fn add(&mut self, s: f64, normal: Vector, to_edge: Vector) {
        self.columns[0] = self.columns[0] + normal * (s * to_edge.x);
        self.columns[1] = self.columns[1] + normal * (s * to_edge.y);
    }

    fn close(&mut self, cell: u32, s: f64, normal: Vector) {
        let (open, length) = &mut self.open[cell as usize];
        *open = *open + normal * s;
        *length += s;
    }
}

#[test]
#[ignore = "ten seconds and a gigabyte"]
fn the_dual_graph_of_a_million_grains_keeps_its_identities() {
    let (grains, sides) = pack();
    let centres: Vec<Vector> = grains.values().iter().map(|g| g.centre).collect();
    let radii: Vec<f64> = grains.values().iter().map(|g| g.radius).collect();
    let near = Grid::new(&centres, &radii).near_pairs(1e-6);
    let container = container(&sides);
    let diagram = power_diagram(&centres, &radii, &container, &near);
    let mut sums = Sums {
        columns: [Vector::default(); 2],
        open: vec![Default::default(); COUNT],
    };
    for edge in &diagram.edges {
        let branch = centres[edge.second as usize] - centres[edge.first as usize];
        let normal = branch * (1.0 / branch.length());
        let s = edge.parts[0] + edge.parts[1];
        sums.add(s, normal, branch);
        sums.close(edge.first, s, normal);
        sums.close(edge.second, s, -normal);
    }
    for edge in &diagram.side_edges {
        let side = &sides[SideId(edge.side)];
        let offset = 0.5 * (edge.parts[1] - edge.parts[0]);
        let distance = side.distance(centres[edge.disc as usize]);
        let to_middle = side.outward * distance + side.outward.quarter_turn() * offset;
        let s = edge.parts[0] + edge.parts[1];
        sums.add(s, side.outward, to_middle);
        sums.close(edge.disc, s, side.outward);
    }
    let area = container.area();
    let cells: f64 = diagram.cell_area.iter().sum();
    let [xx, yy] = [sums.columns[0].x, sums.columns[1].y].map(|sum| sum / area - 1.0);
    let [xy, yx] = [sums.columns[0].y, sums.columns[1].x].map(|sum| sum / area);
    let openings = sums
        .open
        .iter()
        .map(|(open, length)| open.length() / length);
    let widest = openings.fold(0.0, f64::max);
    println!("areas {:.1e}", cells / area - 1.0);
    println!("Σ s·l·n⊗n and sides {xx:.1e} {xy:.1e} {yx:.1e} {yy:.1e}");
    println!("cells open by {widest:.1e}");
    let wrong = [cells / area - 1.0, xx, xy, yx, yy, widest];
    assert!(
        wrong.iter().all(|wrong| wrong.abs() < TOLERANCE),
        "{wrong:?}"
    );
}

#[test]
#[ignore = "five seconds and half a gigabyte"]
fn every_contact_of_a_million_grains_owns_an_edge() {
    let (grains, sides) = pack();
    let reach = PerSide::filled(0.0, sides.len());
    let graph = contact_graph(&grains, &sides, Between::Touching, &reach, 1e-6);
    let centres: Vec<Vector> = grains.values().iter().map(|g| g.centre).collect();
    let radii: Vec<f64> = grains.values().iter().map(|g| g.radius).collect();
    let near = Grid::new(&centres, &radii).near_pairs(1e-6);
    let pairs = near.iter().map(|pair| (pair.first, pair.second));
    let ids = |site: &Site| match (site.first, site.second) {
        (Partner::Grain(first), Partner::Grain(second)) => Some((first.0, second.0)),
        _ => None,
    };
    assert!(graph.sites.iter().filter_map(ids).eq(pairs));
    let bodies = Bodies {
        grains: &grains,
        sides: &sides,
    };
    for site in &graph.sites {
        assert!(site.edge_parts[0] + site.edge_parts[1] > 0.0, "{site:?}");
        assert!(site.branch(bodies).gap <= 1e-6, "{site:?}");
    }
}
