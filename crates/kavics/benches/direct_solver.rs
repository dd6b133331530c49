//! Time of the direct solver for two blocks of cemented grains: `cargo bench -p kavics --bench direct_solver`.
//!
//! With a folder as argument it writes the matrices there too; `benches/cholmod/compare` gives them to CHOLMOD.

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::time::Instant;

use kavics::geometry::{Container, Vector, power_diagram};
use kavics::packing::random::{Purpose, stream};
use kavics::solver::ordering::{Graph, cost, elimination_order, unknowns_in_order};
use kavics::solver::{Pattern, SymmetricSolver};

const GRAINS: usize = 100_000;
const REPEATS: usize = 9;
const SEED: u64 = 1;
/// Stiffnesses of a contact of length l: normal, shear, and of rotation l²/12.
const NORMAL: f64 = 1.0;
const SHEAR: f64 = 0.4;

type Block = [[f64; 3]; 3];

/// Grains that touch; those of the lowest row are held.
struct Network {
    name: &'static str,
    centres: Vec<Vector>,
    held: Vec<bool>,
    contacts: Vec<[u32; 2]>,
}

/// Rows of grains, each row shifted by half a grain.
fn rows(grains: usize) -> (Vec<Vector>, Vec<bool>) {
    let per_row = grains.isqrt();
    let place = |grain: usize| {
        let (row, column) = (grain / per_row, grain % per_row);
        let x = column as f64 + 0.5 * (row % 2) as f64;
        Vector {
            x,
            y: row as f64 * 0.75_f64.sqrt(),
        }
    };
    let held = (0..grains).map(|grain| grain < per_row).collect();
    ((0..grains).map(place).collect(), held)
}

/// Pairs whose cells in the Voronoi diagram are neighbours, shortest first, with their distances.
fn neighbours(centres: &[Vector]) -> Vec<(f64, [u32; 2])> {
    let far = 2.0 * (centres.len() as f64).sqrt();
    let corner = |x: f64, y: f64| Vector { x, y };
    let corners = [
        corner(-2.0, -2.0),
        corner(far, -2.0),
        corner(far, far),
        corner(-2.0, far),
    ];
    let radii = vec![0.1; centres.len()];
    let diagram = power_diagram(centres, &radii, &Container::polygon(&corners), &[]);
    let pairs = diagram.edges.iter().map(|edge| [edge.first, edge.second]);
    let length = |[a, b]: [u32; 2]| (centres[b as usize] - centres[a as usize]).length();
    let mut pairs: Vec<_> = pairs.map(|pair| (length(pair), pair)).collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    pairs
}

fn hexagonal() -> Network {
    let (centres, held) = rows(GRAINS);
    let pairs = neighbours(&centres).into_iter();
    let contacts = pairs
        .filter(|(length, _)| *length < 1.1)
        .map(|(_, pair)| pair);
    Network {
        name: "hexagonal",
        contacts: contacts.collect(),
        centres,
        held,
    }
}

/// The same with grains shifted and shuffled; the shortest three quarters of the neighbours touch.
fn random() -> Network {
    let (places, on_floor) = rows(GRAINS);
    let mut source = stream(SEED, Purpose::Positions);
    let mut shift = |size: f64| size * (source.unit() - 0.5);
    let places: Vec<Vector> = places
        .iter()
        .map(|place| Vector {
            x: place.x + shift(0.7),
            y: place.y + shift(0.6),
        })
        .collect();
    let mut order: Vec<usize> = (0..places.len()).collect();
    stream(SEED, Purpose::Order).shuffle(&mut order);
    let centres: Vec<Vector> = order.iter().map(|&grain| places[grain]).collect();
    let pairs = neighbours(&centres);
    let touching = pairs.len() * 3 / 4;
    Network {
        name: "random",
        contacts: pairs[..touching].iter().map(|&(_, pair)| pair).collect(),
        held: order.iter().map(|&grain| on_floor[grain]).collect(),
        centres,
    }
}

/// The stiffness of a network, without the grains that are held or that nothing joins to them.
struct System {
    name: &'static str,
    contacts: Vec<[u32; 2]>,
    positions: Vec<Option<[f64; 2]>>,
    numbers: Vec<[Option<u32>; 3]>,
    pattern: Pattern,
    values: Vec<f64>,
    right: Vec<f64>,
}

impl System {
    fn new(network: Network) -> Self {
        let contacts = network.contacts.iter().copied();
        let graph = Graph::from_edges(network.centres.len(), contacts);
        let mut next = 0;
        let mut number = |free: bool| {
            let own = free.then_some(next);
            next += u32::from(free);
            own
        };
        let free = free(&network, &graph).into_iter();
        let numbers = free.map(|free| [(); 3].map(|()| number(free))).collect();
        let mut system = Self {
            name: network.name,
            numbers,
            positions: network
                .centres
                .iter()
                .map(|centre| Some([centre.x, centre.y]))
                .collect(),
            contacts: Vec::new(),
            pattern: Pattern {
                column_start: vec![0],
                row: Vec::new(),
            },
            values: Vec::new(),
            right: Vec::new(),
        };
        for grain in 0..network.centres.len() as u32 {
            system.add_columns(grain, &graph, &network.centres);
        }
        // Weight, and something of every freedom.
        let mut source = stream(SEED, Purpose::Coins);
        let load = |unknown: usize| if unknown % 3 == 1 { -1.0 } else { 0.0 };
        let unknowns = system.pattern.order();
        system.right = (0..unknowns)
            .map(|n| load(n) + 0.1 * (source.unit() - 0.5))
            .collect();
        system.contacts = network.contacts;
        system
    }

    fn add_columns(&mut self, grain: u32, graph: &Graph, centres: &[Vector]) {
        if self.numbers[grain as usize][0].is_none() {
            return;
        }
        let mut own = Block::default();
        let mut others = Vec::new();
        for &other in graph.neighbours(grain) {
            let [to_own, to_other] = blocks(centres[other as usize] - centres[grain as usize]);
            for (sum, row) in own.as_flattened_mut().iter_mut().zip(to_own.as_flattened()) {
                *sum += row;
            }
            if other > grain && self.numbers[other as usize][0].is_some() {
                others.push((other, to_other));
            }
        }
        for column in 0..3 {
            let mut add = |body: u32, row: usize, block: &Block| {
                let number = self.numbers[body as usize][row];
                self.pattern.row.extend(number.map(|n| n as usize));
                self.values.push(block[row][column]);
            };
            (column..3).for_each(|row| add(grain, row, &own));
            for (other, block) in &others {
                (0..3).for_each(|row| add(*other, row, block));
            }
            self.pattern.column_start.push(self.pattern.row.len());
        }
    }

    fn graph(&self) -> Graph {
        Graph::from_edges(self.numbers.len(), self.contacts.iter().copied())
    }

    fn weights(&self) -> Vec<u8> {
        let count = |numbers: &[Option<u32>; 3]| numbers.iter().flatten().count() as u8;
        self.numbers.iter().map(count).collect()
    }

    /// Largest component of Kx − f over the sum of those of |K||x| and |f|.
    fn backward_error(&self, x: &[f64]) -> f64 {
        let (mut residual, mut size) = (self.right.clone(), vec![0.0; x.len()]);
        for column in 0..x.len() {
            for entry in self.pattern.column_start[column]..self.pattern.column_start[column + 1] {
                let (row, value) = (self.pattern.row[entry], self.values[entry]);
                residual[row] -= value * x[column];
                size[row] += (value * x[column]).abs();
                if row != column {
                    residual[column] -= value * x[row];
                    size[column] += (value * x[row]).abs();
                }
            }
        }
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        largest(&residual) / (largest(&size) + largest(&self.right))
    }

    /// Little-endian: number of unknowns, of entries, starts of the columns and rows (32-bit), values, right-hand side.
    fn write(&self, folder: &Path) -> io::Result<()> {
        let mut file = io::BufWriter::new(fs::File::create(folder.join(self.name))?);
        let counts = [self.pattern.order(), self.values.len()];
        let numbers = counts
            .iter()
            .chain(&self.pattern.column_start)
            .chain(&self.pattern.row);
        for &number in numbers {
            file.write_all(&(number as u32).to_le_bytes())?;
        }
        for value in self.values.iter().chain(&self.right) {
            file.write_all(&value.to_le_bytes())?;
        }
        file.flush()
    }
}

/// Grains that are not held, but joined to held ones.
fn free(network: &Network, graph: &Graph) -> Vec<bool> {
    let mut reached = network.held.clone();
    let grains = 0..reached.len() as u32;
    let mut open: Vec<u32> = grains.filter(|&grain| reached[grain as usize]).collect();
    while let Some(grain) = open.pop() {
        for &next in graph.neighbours(grain) {
            if !std::mem::replace(&mut reached[next as usize], true) {
                open.push(next);
            }
        }
    }
    reached
        .iter()
        .zip(&network.held)
        .map(|(reached, held)| *reached && !held)
        .collect()
}

/// Stiffness of a contact between its first grain and itself, and between the second and the first.
fn blocks(branch: Vector) -> [Block; 2] {
    let length = branch.length();
    let normal = branch * (1.0 / length);
    let arm = -0.5 * length;
    let relative = |sign: f64| -> Block {
        let (x, y) = (sign * normal.x, sign * normal.y);
        [[x, y, 0.0], [-y, x, arm], [0.0, 0.0, sign]]
    };
    let stiffness = [NORMAL, SHEAR, length * length / 12.0];
    let product = |left: Block, right: Block| {
        let entry = |row: usize, column: usize| -> f64 {
            (0..3)
                .map(|k| left[k][row] * stiffness[k] * right[k][column])
                .sum()
        };
        [0, 1, 2].map(|row| [0, 1, 2].map(|column| entry(row, column)))
    };
    let (first, second) = (relative(-1.0), relative(1.0));
    [product(first, first), product(second, first)]
}

/// Seconds of the processor that the main thread took, where the system tells.
fn processor_seconds() -> Option<f64> {
    let text = fs::read_to_string("/proc/self/schedstat").ok()?;
    Some(1e-9 * text.split(' ').next()?.parse::<f64>().ok()?)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Times of ordering, analysis, factorisation, one solve; all of them, and of the processor.
fn timed(system: &System) -> ([f64; 6], Vec<f64>) {
    let (start, processor) = (Instant::now(), processor_seconds());
    let order = elimination_order(&system.graph(), &system.positions, &system.weights());
    let order = unknowns_in_order(&order, &system.numbers);
    let ordered = start.elapsed().as_secs_f64();
    let mut solver = SymmetricSolver::new(&system.pattern, &order).expect("memory");
    let analysed = start.elapsed().as_secs_f64();
    solver
        .factorise(&system.pattern, &system.values)
        .expect("a factor");
    let factorised = start.elapsed().as_secs_f64();
    let mut x = system.right.clone();
    solver.solve(&mut x);
    let solved = start.elapsed().as_secs_f64();
    let processor = processor_seconds()
        .zip(processor)
        .map_or(solved, |(to, from)| to - from);
    let steps = [
        ordered,
        analysed - ordered,
        factorised - analysed,
        solved - factorised,
    ];
    (
        [steps[0], steps[1], steps[2], steps[3], solved, processor],
        x,
    )
}

fn report(system: &System) {
    let order = elimination_order(&system.graph(), &system.positions, &system.weights());
    let cost = cost(&system.graph(), &order, &system.weights());
    let (first, x) = timed(system);
    let mut times = vec![first];
    times.extend((1..REPEATS).map(|_| timed(system).0));
    let medians: Vec<String> = (0..first.len())
        .map(|step| {
            format!(
                "{:.3}",
                median(times.iter().map(|times| times[step]).collect())
            )
        })
        .collect();
    println!(
        "{} kavics {} {:.2e} {:.2e} {:.1e}",
        system.name,
        medians.join(" "),
        cost.entries,
        cost.operations,
        system.backward_error(&x),
    );
}

fn main() -> io::Result<()> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread();
    pool.build_global().expect("one thread");
    println!(
        "matrix solver ordering analysis factorisation solve total processor entries operations error"
    );
    let folder = std::env::args()
        .skip(1)
        .find(|argument| !argument.starts_with("--"));
    for network in [hexagonal(), random()] {
        let system = System::new(network);
        if let Some(folder) = &folder {
            system.write(Path::new(folder))?;
        }
        report(&system);
    }
    Ok(())
}
