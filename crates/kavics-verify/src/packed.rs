//! What is known of dropped grains, from their list alone.

use std::collections::HashMap;

struct Disc {
    x: f64,
    y: f64,
    radius: f64,
}

/// A property of packed grains; `key` begins with the width of the box.
pub fn value(name: &str, csv: &str, key: &str) -> f64 {
    let discs = read(csv);
    let key: Vec<f64> = key
        .split_whitespace()
        .map(|text| text.parse().expect("a number in the key"))
        .collect();
    let width = key[0];
    match name {
        "count" => discs.len() as f64,
        "deepest_overlap" => -smallest_gap(&discs, width),
        "contacts_beyond_two_each" => contacts_beyond_two_each(&discs, width),
        "unstable" => unstable(&discs, width),
        "solid_share" => solid_share(&discs, width),
        "sum_of_bits" => sum_of_bits(&discs),
        "sieve_error" => sieve_error(&discs, &key[1..]) * discs.len() as f64,
        other => panic!("no property is called {other}"),
    }
}

fn read(csv: &str) -> Vec<Disc> {
    let lines = csv.lines().skip(1);
    lines
        .map(|line| {
            let cells: Vec<f64> = line
                .split(',')
                .map(|cell| cell.parse().expect("a number"))
                .collect();
            Disc {
                x: cells[0],
                y: cells[1],
                radius: cells[2],
            }
        })
        .collect()
}

fn largest_radius(discs: &[Disc]) -> f64 {
    discs.iter().map(|disc| disc.radius).fold(0.0, f64::max)
}

/// Pairs of discs that are close, each once, with their gap.
fn near(discs: &[Disc]) -> Vec<(usize, usize, f64)> {
    let cell = 2.02 * largest_radius(discs);
    let place = |disc: &Disc| ((disc.x / cell) as i64, (disc.y / cell) as i64);
    let mut grid: HashMap<(i64, i64), Vec<usize>> = HashMap::new();
    for (id, disc) in discs.iter().enumerate() {
        grid.entry(place(disc)).or_default().push(id);
    }
    let mut pairs = Vec::new();
    for (a, disc) in discs.iter().enumerate() {
        let (column, row) = place(disc);
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| (column + i, row + j)));
        for &b in around.filter_map(|at| grid.get(&at)).flatten() {
            let other = &discs[b];
            if a < b {
                let distance = (disc.x - other.x).hypot(disc.y - other.y);
                pairs.push((a, b, distance - disc.radius - other.radius));
            }
        }
    }
    pairs
}

/// Smallest gap between discs or to a side, over the mean radius.
fn smallest_gap(discs: &[Disc], width: f64) -> f64 {
    let sides = discs.iter().map(|disc| side_gaps(disc, width));
    let sides = sides.flatten().fold(f64::INFINITY, f64::min);
    let pairs = near(discs).into_iter().map(|(_, _, gap)| gap);
    let mean = discs.iter().map(|d| d.radius).sum::<f64>() / discs.len() as f64;
    pairs.fold(sides, f64::min) / mean
}

/// Gaps to the left and right side and the floor.
fn side_gaps(disc: &Disc, width: f64) -> [f64; 3] {
    [disc.x, width - disc.x, disc.y].map(|distance| distance - disc.radius)
}

const TOUCH: f64 = 1e-7;

/// Contacts, with those of the sides, less 2 N − the discs that rest on the floor alone.
fn contacts_beyond_two_each(discs: &[Disc], width: f64) -> f64 {
    let pairs = near(discs).into_iter().filter(|(_, _, gap)| *gap < TOUCH);
    let sides = discs.iter().flat_map(|disc| side_gaps(disc, width));
    let sides = sides.filter(|gap| *gap < TOUCH).count();
    let floor_only = supports(discs, width)
        .iter()
        .filter(|s| s.on_floor && s.directions.is_empty())
        .count();
    (pairs.count() + sides) as f64 - (2 * discs.len() - floor_only) as f64
}

/// What was there before a disc and touches it.
#[derive(Clone, Default)]
struct Supports {
    on_floor: bool,
    /// Horizontal distance to each support, sides included, divided by the distance.
    directions: Vec<f64>,
}

fn supports(discs: &[Disc], width: f64) -> Vec<Supports> {
    let mut all = vec![Supports::default(); discs.len()];
    for (earlier, later, gap) in near(discs) {
        if gap < TOUCH {
            let (a, b) = (&discs[earlier], &discs[later]);
            all[later]
                .directions
                .push((a.x - b.x) / (a.radius + b.radius));
        }
    }
    for (disc, supports) in discs.iter().zip(&mut all) {
        let [left, right, floor] = side_gaps(disc, width);
        supports.on_floor = floor < TOUCH;
        supports.directions.extend((left < TOUCH).then_some(-1.0));
        supports.directions.extend((right < TOUCH).then_some(1.0));
    }
    all
}

/// Discs that neither lie on the floor nor between two supports.
fn unstable(discs: &[Disc], width: f64) -> f64 {
    let between = |s: &Supports| {
        s.directions.iter().any(|d| *d <= 1e-9) && s.directions.iter().any(|d| *d >= -1e-9)
    };
    let all = supports(discs, width);
    all.iter().filter(|s| !s.on_floor && !between(s)).count() as f64
}

/// Share of the middle of the box that discs cover, by points on a lattice.
fn solid_share(discs: &[Disc], width: f64) -> f64 {
    let top = discs.iter().map(|disc| disc.y).fold(0.0, f64::max);
    let cell = largest_radius(discs);
    let mut grid: HashMap<(i64, i64), Vec<&Disc>> = HashMap::new();
    for disc in discs {
        let at = ((disc.x / cell) as i64, (disc.y / cell) as i64);
        grid.entry(at).or_default().push(disc);
    }
    let covered = |x: f64, y: f64| {
        let (column, row) = ((x / cell) as i64, (y / cell) as i64);
        (-1..=1).any(|i| {
            (-1..=1).any(|j| {
                let near = grid.get(&(column + i, row + j)).into_iter().flatten();
                let mut near = near.filter(|d| (d.x - x).hypot(d.y - y) <= d.radius);
                near.next().is_some()
            })
        })
    };
    let points = 2000;
    let step = |from: f64, to: f64, i: usize| from + (to - from) * (i as f64 + 0.5) / points as f64;
    let inside: usize = (0..points)
        .map(|i| {
            let x = step(0.1 * width, 0.9 * width, i);
            (0..points)
                .filter(|j| covered(x, step(0.1 * top, 0.8 * top, *j)))
                .count()
        })
        .sum();
    inside as f64 / (points * points) as f64
}

/// Largest difference of the share by mass below a sieve; key: diameter and passing of each sieve.
fn sieve_error(discs: &[Disc], curve: &[f64]) -> f64 {
    let mass = |disc: &Disc| disc.radius * disc.radius;
    let total: f64 = discs.iter().map(mass).sum();
    let errors = curve.chunks(2).map(|sieve| {
        let below = discs
            .iter()
            .filter(|d| 2.0 * d.radius <= sieve[0] * (1.0 + 1e-12));
        (below.map(mass).sum::<f64>() / total - sieve[1]).abs()
    });
    errors.fold(0.0, f64::max)
}

/// A number that changes with any bit of any grain.
fn sum_of_bits(discs: &[Disc]) -> f64 {
    let bits = discs.iter().flat_map(|d| [d.x, d.y, d.radius]);
    let sum = bits.fold(0_u64, |sum, value| {
        sum.wrapping_mul(31).wrapping_add(value.to_bits())
    });
    (sum >> 12) as f64
}
