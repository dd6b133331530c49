//! The power diagram against an independent construction: the hull of the discs lifted to three dimensions, by SciPy.
//!
//! Passes without a look, and says so, where there is no Python with SciPy.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::process::{Command, Stdio};

use kavics::geometry::{Container, Grid, PowerDiagram, Vector, power_diagram};
use kavics::packing::dropped::{self, Bed, Shape};
use kavics::packing::{Mass, SieveCurve, Sizes};

/// Shorter dual edges may be there or not: where four cells meet, it is a matter of rounding.
const NO_LENGTH: f64 = 1e-7;

type Discs = Vec<(f64, f64, f64)>;

fn has_scipy() -> bool {
    let scipy = Command::new("python3")
        .args(["-c", "import scipy"])
        .output();
    let found = scipy.is_ok_and(|output| output.status.success());
    if !found {
        eprintln!("skipped: no python3 with scipy");
    }
    found
}

/// Edges between triangles and their lengths; none: an edge of the hull of all centres.
fn by_hull(discs: &Discs) -> BTreeMap<(u32, u32), Option<f64>> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/lifted_hull.py");
    let mut python = Command::new("python3")
        .arg(script)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("python3 starts");
    let mut table = String::new();
    for (x, y, radius) in discs {
        writeln!(table, "{x:?},{y:?},{radius:?}").expect("a string takes it");
    }
    let mut input = python.stdin.take().expect("stdin is piped");
    input.write_all(table.as_bytes()).expect("python reads");
    drop(input);
    let output = python.wait_with_output().expect("python ends");
    assert!(output.status.success());
    let edge = |line: &str| {
        let mut fields = line.split(',');
        let mut id = || {
            fields
                .next()
                .and_then(|field| field.parse().ok())
                .expect("an id")
        };
        let pair = (id(), id());
        (pair, fields.next().and_then(|field| field.parse().ok()))
    };
    String::from_utf8(output.stdout)
        .expect("text")
        .lines()
        .map(edge)
        .collect()
}

fn diagram(discs: &Discs, margin: f64) -> PowerDiagram {
    let (low, high) = extent(discs, margin);
    let corners = [
        (low.0, low.1),
        (high.0, low.1),
        (high.0, high.1),
        (low.0, high.1),
    ];
    let container = Container::polygon(&corners.map(|(x, y)| Vector::new(x, y)));
    let centres: Vec<_> = discs.iter().map(|d| Vector::new(d.0, d.1)).collect();
    let radii: Vec<_> = discs.iter().map(|d| d.2).collect();
    let near = Grid::new(&centres, &radii).near_pairs(1e-3);
    power_diagram(&centres, &radii, &container, &near)
}

fn extent(discs: &Discs, margin: f64) -> ((f64, f64), (f64, f64)) {
    let fold = |value: fn(&(f64, f64, f64)) -> f64, pick: fn(f64, f64) -> f64, start: f64| {
        discs.iter().map(value).fold(start, pick)
    };
    let infinity = f64::INFINITY;
    let low = (
        fold(|d| d.0, f64::min, infinity),
        fold(|d| d.1, f64::min, infinity),
    );
    let high = (
        fold(|d| d.0, f64::max, -infinity),
        fold(|d| d.1, f64::max, -infinity),
    );
    (
        (low.0 - margin, low.1 - margin),
        (high.0 + margin, high.1 + margin),
    )
}

/// Every edge of the hull within the container has its length in the diagram, and the other way round.
fn check(name: &str, discs: &Discs) {
    if !has_scipy() {
        return;
    }
    // Far enough that the container cuts off few edges, and those near the rim alone.
    let diagram = diagram(discs, 2.0);
    let hull = by_hull(discs);
    let on_side: Vec<u32> = diagram.side_edges.iter().map(|edge| edge.disc).collect();
    let inner = |&(a, b): &(u32, u32)| !on_side.contains(&a) && !on_side.contains(&b);
    let own: BTreeMap<_, _> = diagram
        .edges
        .iter()
        .map(|edge| ((edge.first, edge.second), edge.parts[0] + edge.parts[1]))
        .collect();
    let mut compared = 0;
    for (pair, length) in hull.iter().filter(|(pair, _)| inner(pair)) {
        let length = length.expect("an inner edge is not on the hull");
        let found = own.get(pair).copied().unwrap_or_default();
        assert!(
            (found - length).abs() < NO_LENGTH,
            "{name}: {pair:?} {found} {length}"
        );
        compared += 1;
    }
    for (pair, length) in own.iter().filter(|(pair, _)| inner(pair)) {
        assert!(
            hull.contains_key(pair) || *length < NO_LENGTH,
            "{name}: {pair:?} {length}"
        );
    }
    assert!(compared > discs.len(), "{name}: {compared} edges compared");
    let triangles = diagram.triangles.len() + diagram.outer_triangles.len();
    let on_hull = hull.values().filter(|length| length.is_none()).count();
    // Those too flat to matter are left out.
    let all = 2 * discs.len() - 2 - on_hull;
    assert!(
        triangles <= all && (triangles == all || name.contains("e-")),
        "{name}"
    );
}

fn dropped(sizes: &Sizes, count: usize, width: f64, seed: u64) -> Discs {
    let radii = sizes.radii(count, seed).expect("sizes are right");
    let bed = Bed {
        shape: Shape::Box { width },
        resting: &[],
        top: None,
        layer: 0,
    };
    let pack = dropped::drop(&bed, &radii, 1, seed).expect("they fit");
    let disc = |g: &kavics::assembly::Grain| (g.centre.x, g.centre.y, g.radius);
    pack.grains.values().iter().map(disc).collect()
}

#[test]
fn dropped_packs_have_the_dual_edges_of_the_hull() {
    check(
        "1:3",
        &dropped(&Sizes::Uniform { from: 0.5, to: 1.5 }, 5000, 100.0, 1),
    );
    let wide = Sizes::Sieve(SieveCurve {
        diameter: vec![0.2, 0.6, 2.0, 6.0],
        passing: vec![0.0, 0.3, 0.6, 1.0],
        mass: Mass::Disc,
    });
    check("1:30", &dropped(&wide, 5000, 60.0, 2));
}

#[test]
fn packs_with_holes_have_the_dual_edges_of_the_hull() {
    let mut discs = dropped(&Sizes::Uniform { from: 0.5, to: 1.5 }, 3000, 80.0, 3);
    let mut number = 0;
    discs.retain(|_| {
        number += 7;
        number % 17 > 6
    });
    check("holes", &discs);
}

#[test]
fn lattices_have_the_dual_edges_of_the_hull() {
    let row = |k: usize| (k % 40, k / 40);
    for jitter in [0.0, 1e-12, 1e-9] {
        let shifted = |k: usize| jitter * ((k * 7919) % 101) as f64 / 101.0;
        let hexagonal = |k: usize| {
            let (i, j) = row(k);
            let x = 2.0 * i as f64 + (j % 2) as f64 + shifted(k);
            (x, 3.0_f64.sqrt() * j as f64 - shifted(k + 1), 1.0 - jitter)
        };
        check(
            &format!("hexagonal {jitter:e}"),
            &(0..1600).map(hexagonal).collect(),
        );
        let square = |k: usize| {
            let (i, j) = row(k);
            (
                2.0 * i as f64 + shifted(k),
                2.0 * j as f64 - shifted(k + 1),
                1.0 - jitter,
            )
        };
        check(
            &format!("square {jitter:e}"),
            &(0..1600).map(square).collect(),
        );
    }
}

#[test]
fn cocircular_rings_have_the_dual_edges_of_the_hull() {
    let mut discs = Discs::new();
    for k in 0..49 {
        let (x, y) = (10.0 * f64::from(k % 7), 10.0 * f64::from(k / 7));
        discs.push((x, y, 1.0));
        for m in 0..12 {
            let angle = std::f64::consts::TAU * f64::from(m) / 12.0;
            discs.push((x + 3.5 * angle.cos(), y + 3.5 * angle.sin(), 0.5));
        }
    }
    check("rings", &discs);
}
