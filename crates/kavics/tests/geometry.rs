//! Identities of the power diagram and the contact graph, on random packs and exact lattices.

use std::collections::HashMap;

use kavics::assembly::{
    Between, Bodies, ContactGraph, ContactPoint, DualLength, Grain, Partner, Shaping, Side, Site,
    box_sides, contact_graph, envelope,
};
use kavics::geometry::{Container, Grid, HalfPlane, NearPair, PowerDiagram, Vector, power_diagram};
use kavics::ids::{GrainId, PerGrain, PerSide, PropertyId, SideId};
use kavics::packing::Sizes;
use kavics::packing::dropped::{self, Bed, Shape};
use kavics::packing::random::{Purpose, stream};
use proptest::prelude::*;

/// Relative to the area or size of the box.
const TOLERANCE: f64 = 1e-10;
const ROOT_3: f64 = 1.732_050_807_568_877_2;

/// Discs in a box with its lower left corner at the origin.
#[derive(Clone, Debug)]
struct Pack {
    centres: Vec<Vector>,
    radii: Vec<f64>,
    width: f64,
    height: f64,
}

impl Pack {
    fn new(width: f64, height: f64, discs: &[(f64, f64, f64)]) -> Self {
        Self {
            centres: discs.iter().map(|d| Vector::new(d.0, d.1)).collect(),
            radii: discs.iter().map(|d| d.2).collect(),
            width,
            height,
        }
    }

    fn sides(&self) -> PerSide<Side> {
        box_sides(self.width, self.height, [true; 4])
    }

    fn diagram(&self) -> PowerDiagram {
        let near = Grid::new(&self.centres, &self.radii).near_pairs(1e-9);
        self.diagram_of(&near)
    }

    fn diagram_of(&self, near: &[NearPair]) -> PowerDiagram {
        let half_plane = |s: &Side| HalfPlane {
            point: s.start,
            outward: s.outward,
        };
        let container = Container::new(self.sides().map(half_plane).values());
        power_diagram(&self.centres, &self.radii, &container, near)
    }

    fn grains(&self) -> PerGrain<Grain> {
        let grain = |(&centre, &radius): (&Vector, &f64)| Grain { centre, radius };
        self.centres.iter().zip(&self.radii).map(grain).collect()
    }

    fn graph(&self, between: Between) -> ContactGraph {
        let reach = PerSide::filled(0.0, 4);
        contact_graph(&self.grains(), &self.sides(), between, &reach, 1e-7)
    }

    fn area(&self) -> f64 {
        self.width * self.height
    }

    /// Unit normal and length of the branch.
    fn branch(&self, first: u32, second: u32) -> (Vector, f64) {
        let branch = self.centres[second as usize] - self.centres[first as usize];
        let l = branch.length();
        (branch * (1.0 / l), l)
    }

    fn triangle_area(&self, triangle: &[u32; 3]) -> f64 {
        let [a, b, c] = triangle.map(|i| self.centres[i as usize]);
        0.5 * (b - a).cross(c - a)
    }
}

/// A disc in each square of a lattice, placed and sized at random within it.
fn jittered(columns: usize, rows: usize, random: &[(f64, f64, f64)]) -> Pack {
    let disc = |(k, &(u, v, w)): (usize, &(f64, f64, f64))| {
        let radius = 0.05 + 0.45 * w;
        let free = 0.5 - radius;
        let (x, y) = ((k % columns) as f64 + 0.5, (k / columns) as f64 + 0.5);
        (x + free * u, y + free * v, radius)
    };
    let discs: Vec<_> = random.iter().enumerate().map(disc).collect();
    Pack::new(columns as f64, rows as f64, &discs)
}

/// Random discs one after the other, each as large as fits: it touches one before it, or a side.
fn sequential(random: &[(f64, f64)], width: f64, height: f64) -> Pack {
    let mut pack = Pack::new(width, height, &[]);
    for &(u, v) in random {
        let centre = Vector::new(u * width, v * height);
        let to_x = centre.x.min(width - centre.x);
        let to_y = centre.y.min(height - centre.y);
        let placed = pack.centres.iter().zip(&pack.radii);
        let gaps = placed.map(|(&x, r)| (x - centre).length() - r);
        let radius = gaps.fold(to_x.min(to_y).min(1.0), f64::min);
        if radius > 0.02 {
            pack.centres.push(centre);
            pack.radii.push(radius);
        }
    }
    pack
}

/// A dropped pack from which grains were taken out: rings, tails, and islands inside loops remain.
fn with_holes(count: usize, seed: u64, kept: f64) -> Pack {
    let sizes = Sizes::Uniform { from: 0.2, to: 1.5 };
    let radii = sizes.radii(count, seed).unwrap();
    let width = 30.0;
    let bed = Bed {
        shape: Shape::Box { width },
        resting: &[],
        top: None,
        layer: 0,
    };
    let grains = dropped::drop(&bed, &radii, 1, seed).unwrap().grains;
    let mut draws = stream(seed, Purpose::Zones);
    let grains = grains.values().iter().filter(|_| draws.unit() < kept);
    let discs: Vec<_> = grains.map(|g| (g.centre.x, g.centre.y, g.radius)).collect();
    let height = discs.iter().map(|d| d.1 + d.2).fold(1.0, f64::max);
    Pack::new(width, height, &discs)
}

/// Rows of discs of radius 1, in turn `longest` and one less.
fn hexagonal(longest: usize, rows: usize) -> Pack {
    let mut discs = Vec::new();
    for row in 0..rows {
        for k in 0..longest - row % 2 {
            let x = 1.0 + (row % 2) as f64 + 2.0 * k as f64;
            discs.push((x, 1.0 + row as f64 * ROOT_3, 1.0));
        }
    }
    let height = 2.0 + (rows - 1) as f64 * ROOT_3;
    Pack::new(2.0 * longest as f64, height, &discs)
}

fn square(columns: usize, rows: usize) -> Pack {
    let at = |k: usize| 1.0 + 2.0 * k as f64;
    let disc = |k: usize| (at(k % columns), at(k / columns), 1.0);
    let discs: Vec<_> = (0..columns * rows).map(disc).collect();
    Pack::new(2.0 * columns as f64, 2.0 * rows as f64, &discs)
}

/// ΣA is the area of the box, and each cell closes: Σ s n = 0.
fn check_tiling(pack: &Pack, diagram: &PowerDiagram) {
    let sum: f64 = diagram.cell_area.iter().sum();
    assert!((sum / pack.area() - 1.0).abs() < TOLERANCE, "areas {sum}");
    let mut open = vec![Vector::default(); pack.centres.len()];
    for edge in &diagram.edges {
        let (n, _) = pack.branch(edge.first, edge.second);
        let s = edge.parts[0] + edge.parts[1];
        assert!(s >= 0.0);
        let (i, j) = (edge.first as usize, edge.second as usize);
        open[i] = open[i] + n * s;
        open[j] = open[j] - n * s;
    }
    let sides = pack.sides();
    for edge in &diagram.side_edges {
        let i = edge.disc as usize;
        open[i] = open[i] + sides[SideId(edge.side)].outward * (edge.parts[0] + edge.parts[1]);
    }
    let size = pack.width.max(pack.height);
    for rest in open {
        assert!(rest.length() < TOLERANCE * size, "cell open by {rest:?}");
    }
}

/// Σ s l n⊗n over the edges and Σ s N⊗(x_mid − x) over the sides is A·I.
fn check_identity(pack: &Pack, diagram: &PowerDiagram) {
    let mut columns = [Vector::default(); 2];
    let mut add = |s: f64, a: Vector, b: Vector| {
        columns[0] = columns[0] + a * (s * b.x);
        columns[1] = columns[1] + a * (s * b.y);
    };
    for edge in &diagram.edges {
        let (n, l) = pack.branch(edge.first, edge.second);
        add((edge.parts[0] + edge.parts[1]) * l, n, n);
    }
    let sides = pack.sides();
    for edge in &diagram.side_edges {
        let side = &sides[SideId(edge.side)];
        let n = side.outward;
        let offset = 0.5 * (edge.parts[1] - edge.parts[0]);
        let distance = side.distance(pack.centres[edge.disc as usize]);
        let to_middle = n * distance + n.quarter_turn() * offset;
        add(edge.parts[0] + edge.parts[1], n, to_middle);
    }
    let area = pack.area();
    let unit = [Vector::new(area, 0.0), Vector::new(0.0, area)];
    for (column, expected) in columns.iter().zip(unit) {
        let rest = *column - expected;
        assert!(rest.length() < TOLERANCE * area, "{columns:?}");
    }
}

/// Triangles turn counter-clockwise and no two lie on the same side of an edge.
fn check_triangles(pack: &Pack, diagram: &PowerDiagram) {
    let mut directed = HashMap::new();
    for triangle in &diagram.triangles {
        assert!(triangle[0] < triangle[1].min(triangle[2]));
        assert!(pack.triangle_area(triangle) > 0.0);
        for k in 0..3 {
            let edge = (triangle[k], triangle[(k + 1) % 3]);
            *directed.entry(edge).or_insert(0) += 1;
        }
    }
    assert!(directed.values().all(|&times| times == 1));
}

/// Euler's relations, where no two radical centres coincide: V − E + T = 1, and 2E − 3T edges end on the sides, which
/// so many cut into S pieces at all but the four corners.
fn check_counts(diagram: &PowerDiagram) {
    let cells = diagram.cell_area.len();
    let (edges, triangles) = (diagram.edges.len(), diagram.triangles.len());
    assert_eq!(cells + triangles, edges + 1);
    assert_eq!(2 * edges - 3 * triangles, diagram.side_edges.len() - 4);
}

fn check_all(pack: &Pack) {
    let diagram = pack.diagram();
    check_tiling(pack, &diagram);
    check_identity(pack, &diagram);
    check_triangles(pack, &diagram);
}

fn is_between_grains(site: &Site) -> bool {
    matches!(site.second, Partner::Grain(_))
}

/// Every touching pair has an edge, and the tangent point lies on it.
fn check_contact_theorem(pack: &Pack) {
    let graph = pack.graph(Between::Touching);
    let near = Grid::new(&pack.centres, &pack.radii).near_pairs(1e-7);
    let between = graph.sites.iter().filter(|s| is_between_grains(s));
    assert_eq!(between.count(), near.len());
    for site in &graph.sites {
        assert!(site.edge_parts.iter().all(|&p| p > -1e-9), "{site:?}");
        assert!(site.edge_parts[0] + site.edge_parts[1] > 0.0);
    }
}

fn random_discs(count: usize) -> impl Strategy<Value = Vec<(f64, f64, f64)>> {
    prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64, 0.0..1.0_f64), count)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 60,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn jittered_packs_keep_the_identities(random in random_discs(12 * 9)) {
        let pack = jittered(12, 9, &random);
        check_all(&pack);
        check_counts(&pack.diagram());
    }

    #[test]
    fn sequential_packs_keep_the_identities(
        random in prop::collection::vec((0.0..1.0_f64, 0.0..1.0_f64), 10..400)
    ) {
        let pack = sequential(&random, 9.0, 6.0);
        check_all(&pack);
        check_counts(&pack.diagram());
        check_contact_theorem(&pack);
    }

    /// Faces of the contact graph, with islands inside loops, give what cutting every cell out gives.
    #[test]
    fn faces_give_the_same_diagram_as_cutting(
        seed in 0..u64::MAX,
        kept in 0.3..1.0_f64,
        reach in prop_oneof![Just(1e-9), Just(1e-3), Just(0.3)],
    ) {
        let pack = with_holes(300, seed, kept);
        let near = Grid::new(&pack.centres, &pack.radii).near_pairs(reach);
        let by_faces = pack.diagram_of(&near);
        let by_cutting = pack.diagram_of(&[]);
        let all = |diagram: &PowerDiagram| {
            let mut all = [&diagram.triangles[..], &diagram.outer_triangles].concat();
            all.sort_unstable();
            all
        };
        prop_assert_eq!(all(&by_faces), all(&by_cutting));
        let pairs = |diagram: &PowerDiagram| -> Vec<_> {
            diagram.edges.iter().map(|e| (e.first, e.second)).collect()
        };
        prop_assert_eq!(pairs(&by_faces), pairs(&by_cutting));
        for (a, b) in by_faces.edges.iter().zip(&by_cutting.edges) {
            prop_assert!((a.parts[0] - b.parts[0]).abs() < 1e-9, "{:?} {:?}", a, b);
            prop_assert!((a.parts[1] - b.parts[1]).abs() < 1e-9, "{:?} {:?}", a, b);
        }
        for (a, b) in by_faces.cell_area.iter().zip(&by_cutting.cell_area) {
            prop_assert!((a - b).abs() < 1e-9 * (1.0 + b), "{} {}", a, b);
        }
        check_tiling(&pack, &by_faces);
        check_identity(&pack, &by_faces);
    }

    #[test]
    fn near_pairs_are_those_of_all_pairs(random in random_discs(60), reach in -0.1..3.0_f64) {
        let pack = jittered(10, 6, &random);
        let found = Grid::new(&pack.centres, &pack.radii).near_pairs(reach);
        let mut expected = Vec::new();
        for i in 0..60 {
            for j in i + 1..60 {
                let (_, l) = pack.branch(i, j);
                if l - (pack.radii[i as usize] + pack.radii[j as usize]) <= reach {
                    expected.push((i, j));
                }
            }
        }
        let found: Vec<_> = found.iter().map(|p| (p.first, p.second)).collect();
        prop_assert_eq!(found, expected);
    }

    #[test]
    fn cells_of_overlapping_and_repeated_discs_tile_the_box(
        random in prop::collection::vec((-3.0..5.0_f64, -3.0..5.0_f64, 0.0..3.0_f64), 1..30),
        repeats in 0_usize..10,
    ) {
        let discs = random.iter().chain(random.iter().take(repeats));
        let discs: Vec<_> = discs.map(|d| (d.0.round(), d.1.round(), d.2.round())).collect();
        let pack = Pack::new(2.0, 3.0, &discs);
        let sum: f64 = pack.diagram().cell_area.iter().sum();
        prop_assert!((sum - 6.0).abs() < 1e-9, "{}", sum);
        pack.graph(Between::Neighbours);
    }

    #[test]
    fn the_envelope_is_the_first_grain_met(
        random in prop::collection::vec((0.0..1.0_f64, 0.0..1.0_f64), 1..60),
        side in 0_u32..4,
    ) {
        let pack = sequential(&random, 9.0, 6.0);
        let (grains, sides) = (pack.grains(), pack.sides());
        let side = &sides[SideId(side)];
        let parts = envelope(&grains, side);
        let direction = (side.end - side.start) * (1.0 / side.length());
        for k in 0..500 {
            let at = (f64::from(k) + 0.5) / 500.0 * side.length();
            let depth = |g: &Grain| {
                let u = (g.centre - side.start).dot(direction) - at;
                let squared = g.radius * g.radius - u * u;
                (squared > 0.0).then(|| side.distance(g.centre) - squared.sqrt())
            };
            let met = grains.iter().filter_map(|(id, g)| Some((depth(g)?, id)));
            let first = met.min_by(|a, b| a.0.total_cmp(&b.0)).map(|m| m.1);
            let part = parts.iter().find(|p| p.from < at && at < p.to);
            prop_assert_eq!(first, part.map(|p| p.grain));
        }
    }

    #[test]
    fn nearly_square_lattices_have_one_diagonal_a_square(
        random in random_discs(13 * 11),
        digits in 9_i32..18,
    ) {
        let mut pack = square(13, 11);
        for (k, &(u, v, w)) in random.iter().enumerate() {
            let shift = Vector::new(u, v) * 10.0_f64.powi(-digits);
            pack.centres[k] = pack.centres[k] + shift;
            pack.radii[k] -= w * 10.0_f64.powi(-digits);
        }
        check_all(&pack);
        let diagram = pack.diagram();
        prop_assert_eq!(diagram.triangles.len(), 2 * 12 * 10);
        prop_assert_eq!(13 * 11 + diagram.triangles.len(), diagram.edges.len() + 1);
    }

    #[test]
    fn lengths_follow_the_unit(random in random_discs(30), exponent in -200_i32..200) {
        let pack = jittered(6, 5, &random);
        let unit = 2.0_f64.powi(exponent);
        let scaled = Pack {
            centres: pack.centres.iter().map(|&x| x * unit).collect(),
            radii: pack.radii.iter().map(|&r| r * unit).collect(),
            width: pack.width * unit,
            height: pack.height * unit,
        };
        let (one, other) = (pack.diagram(), scaled.diagram());
        prop_assert_eq!(&one.triangles, &other.triangles);
        let parts: Vec<_> = one.edges.iter().map(|e| e.parts.map(|p| p * unit)).collect();
        let scaled: Vec<_> = other.edges.iter().map(|e| e.parts).collect();
        prop_assert_eq!(parts, scaled);
    }
}

#[test]
fn hexagonal_lattices_have_their_dual_length() {
    let pack = hexagonal(8, 9);
    check_all(&pack);
    check_contact_theorem(&pack);
    let graph = pack.graph(Between::Touching);
    let (grains, sides) = (&pack.grains(), &pack.sides());
    let inner = |s: &&Site| {
        let p = s.tangent_point(Bodies { grains, sides });
        p.x > 2.6 && p.x < pack.width - 2.6 && p.y > 1.5 && p.y < pack.height - 1.5
    };
    let inner: Vec<_> = graph.sites.iter().filter(inner).collect();
    assert!(inner.len() > 80);
    for part in inner.iter().flat_map(|s| s.edge_parts) {
        // s = 2R/√3, half of it on each side.
        assert!((part - 1.0 / ROOT_3).abs() < 1e-12);
    }
}

#[test]
fn a_notch_of_a_hexagonal_block_has_its_triangle_on_both_sides() {
    for (longest, rows) in [(5, 7), (6, 4), (9, 3), (10, 33)] {
        let pack = hexagonal(longest, rows);
        let diagram = pack.diagram();
        check_triangles(&pack, &diagram);
        // The radical centre of a notch lies on the side of the box.
        let notches = 2 * ((rows - 1) / 2);
        let between_rows = (rows - 1) * (2 * longest - 3);
        assert_eq!(diagram.triangles.len(), between_rows + notches);
    }
}

#[test]
fn square_lattices_have_their_dual_length_and_one_diagonal_a_square() {
    for (columns, rows) in [(2, 2), (7, 5), (16, 16)] {
        let pack = square(columns, rows);
        check_all(&pack);
        let diagram = pack.diagram();
        let squares = (columns - 1) * (rows - 1);
        assert_eq!(diagram.triangles.len(), 2 * squares);
        let areas = diagram.triangles.iter().map(|t| pack.triangle_area(t));
        assert!((areas.sum::<f64>() - 4.0 * squares as f64).abs() < 1e-9);
        // Euler: V − E + F = 1.
        let vertices = columns * rows + diagram.triangles.len();
        assert_eq!(vertices, diagram.edges.len() + 1);
        let touching = pack.graph(Between::Touching).sites;
        for part in touching.iter().flat_map(|s| s.edge_parts) {
            assert!((part - 1.0).abs() < 1e-12);
        }
        assert_eq!(touching, pack.graph(Between::Neighbours).sites);
    }
}

#[test]
fn a_ring_about_a_hole_is_triangulated_once() {
    let mut pack = hexagonal(9, 9);
    let whole = pack.diagram().triangles.len();
    let centre = Vector::new(9.0, 1.0 + 4.0 * ROOT_3);
    let hole = pack
        .centres
        .iter()
        .position(|&c| (c - centre).length() < 0.1);
    let hole = hole.expect("a grain in the middle");
    pack.centres.remove(hole);
    pack.radii.remove(hole);
    check_all(&pack);
    assert_eq!(pack.diagram().triangles.len(), whole - 2);
}

#[test]
fn the_tangents_of_three_touching_grains_meet_at_the_incentre() {
    // Sides 3, 4, 5: a right triangle.
    let discs = [(10.0, 10.0, 1.0), (13.0, 10.0, 2.0), (10.0, 14.0, 3.0)];
    let pack = Pack::new(30.0, 30.0, &discs);
    let inradius = (6.0_f64 / 6.0).sqrt();
    let graph = pack.graph(Between::Touching);
    assert_eq!(graph.triangles.len(), 1);
    // The incentre lies on +t of (0, 1), on −t of (0, 2), on +t of (1, 2).
    for (site, side) in graph.sites.iter().zip([1, 0, 1]) {
        assert!((site.edge_parts[side] - inradius).abs() < 1e-12, "{site:?}");
    }
}

#[test]
fn one_and_two_threads_give_the_same_bits() {
    let wave = |k: u32, a: f64| (a * f64::from(k)).fract();
    let random = |k| {
        let (u, v) = (wave(k, 0.618_034), wave(k, 0.414_214));
        (2.0 * u - 1.0, 2.0 * v - 1.0, wave(k, 0.732_051))
    };
    let pack = jittered(60, 50, &(0..3000).map(random).collect::<Vec<_>>());
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a pool").install(|| pack.diagram())
    };
    assert_eq!(with(1), with(2));
}

#[test]
fn sites_come_in_their_order() {
    let graph = hexagonal(5, 4).graph(Between::Neighbours);
    let key = |s: &Site| (!is_between_grains(s), s.first, s.second);
    assert!(graph.sites.windows(2).all(|w| key(&w[0]) < key(&w[1])));
    let at_sides = graph.sites.iter().filter(|s| !is_between_grains(s)).count();
    // Five grains at the bottom, four at the top, two long rows at left and right.
    assert_eq!(at_sides, 5 + 4 + 2 + 2);
}

#[test]
fn reach_joins_grains_near_a_present_side() {
    let pack = Pack::new(10.0, 10.0, &[(2.0, 5.0, 1.0), (7.0, 5.0, 2.0)]);
    let mut sides = pack.sides();
    sides[SideId(1)].present = false;
    // Gaps: 1 and 4 to the left, 7 and 1 to the right, 4 and 3 to bottom and top.
    let reach = PerSide::from(vec![1.5, 1.5, 2.5, 3.5]);
    let graph = contact_graph(&pack.grains(), &sides, Between::Touching, &reach, 1e-7);
    let bodies = Bodies {
        grains: &pack.grains(),
        sides: &sides,
    };
    let found: Vec<_> = graph
        .sites
        .iter()
        .map(|s| (s.first, s.second, s.branch(bodies).gap))
        .collect();
    let grain = |k| Partner::Grain(GrainId(k));
    let side = |k| Partner::Side(SideId(k));
    assert_eq!(found, [(grain(0), side(0), 1.0), (grain(1), side(3), 3.0)]);
}

#[test]
fn shapings_of_a_pair_in_a_wide_box() {
    let pack = Pack::new(30.0, 30.0, &[(10.0, 12.0, 1.0), (15.0, 12.0, 4.0)]);
    let site = pack.graph(Between::Touching).sites[0];
    assert_eq!(site.edge_parts, [12.0, 18.0]);
    let bodies = Bodies {
        grains: &pack.grains(),
        sides: &pack.sides(),
    };
    assert_eq!(site.tangent_point(bodies), Vector::new(11.0, 12.0));
    let contact = |dual_length, contact_point| {
        let shaping = Shaping {
            dual_length,
            contact_point,
        };
        site.contact(shaping, bodies, PropertyId(0), 1.0)
    };
    // g = √(1·4) = 2.
    let capped = contact(DualLength::Capped, ContactPoint::Tangent);
    assert_eq!(capped.dual_parts, [2.0, 2.0]);
    assert_eq!(capped.dual_length_full, 30.0);
    let full = contact(DualLength::Full, ContactPoint::Midpoint);
    assert_eq!(full.dual_parts, [15.0, 15.0]);
    assert_eq!(full.point, Vector::new(11.0, 15.0));
    let number = contact(DualLength::Number(1.0), ContactPoint::Midpoint);
    assert_eq!(number.dual_parts, [0.5, 0.5]);
    assert_eq!(number.point, Vector::new(11.0, 15.0));
    let number = contact(DualLength::Number(1.0), ContactPoint::Tangent);
    assert_eq!(number.point, Vector::new(11.0, 12.0));
}

#[test]
fn odd_input_does_not_panic() {
    let packs = [
        vec![],
        vec![(f64::NAN, 0.0, 1.0), (1.0, 1.0, f64::INFINITY)],
        vec![
            (1e300, 1e300, 1e299),
            (-1e300, 1.0, 1e-300),
            (1.0, 1.0, 0.5),
        ],
        vec![(1e-310, 0.0, 1e-311), (0.0, 1e-310, 0.0), (1.0, 1.0, 0.0)],
        vec![(1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 0.5)],
    ];
    let boxes = [(2.0, 2.0), (0.0, 0.0), (f64::NAN, 1.0), (1e300, 1e-300)];
    for discs in packs {
        for (width, height) in boxes {
            let graph = Pack::new(width, height, &discs).graph(Between::Neighbours);
            assert_eq!(graph.cell_area.len(), discs.len());
        }
    }
}

/// A cell that grows by a rounding with each cut would be cut for ever.
#[test]
fn discs_that_nearly_coincide_come_to_an_end() {
    let step = |start: f64, count: usize| -> Vec<(f64, f64, f64)> {
        let mut values = (0..3 * count).map(|k| start - k as f64 * start * f64::EPSILON);
        let mut next = || values.next().unwrap_or(start);
        (0..count).map(|_| (next(), next(), next())).collect()
    };
    let mut discs = vec![(202.0, 202.0, 202.0); 3];
    discs.push((202.0, 6.0 * ROOT_3, 6.0 * ROOT_3));
    discs.extend(vec![(6.0 * ROOT_3, 6.0 * ROOT_3, 6.0 * ROOT_3); 6]);
    discs.extend(step(6.0 * ROOT_3, 6));
    discs.extend([
        (6.0 * ROOT_3, 202.0, 202.0),
        (202.0, 202.0, 202.0),
        (202.0, 202.0, 40.0),
    ]);
    discs.extend([(10.0, 1.0, 1.0), (1.0, 1.0, 0.999_999_999)]);
    discs.extend([
        (
            0.999_999_998_000_000_1,
            0.999_999_997_000_000_1,
            0.999_999_996_000_000_1,
        ),
        (
            0.999_999_995_000_000_1,
            0.999_999_994_000_000_2,
            0.999_999_993_000_000_2,
        ),
        (0.999_999_993_000_000_2, 0.999_999_993_000_000_3, 1.0),
    ]);
    discs.extend([(1.0, 5.0, 1.0), (5.0, 1.0, 7.0)]);
    let pack = Pack::new(202.0, 202.0, &discs);
    for between in [Between::Touching, Between::Neighbours] {
        assert_eq!(pack.graph(between).cell_area.len(), discs.len());
    }
}
