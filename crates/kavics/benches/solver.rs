//! Time of the direct solver on the hexagonal block: `cargo bench -p kavics --bench solver`, or a part of it by name:
//! `cargo bench -p kavics --bench solver -- remove`.

#[path = "../tests/network/mod.rs"]
mod network;

use std::time::Duration;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use kavics::solver::{SymmetricSolver, minimum_degree};
use network::{Entries, Network};

/// Rows and grains in the longest of about 1e4 and 1e5 grains.
const BLOCKS: [(usize, usize); 2] = [(110, 92), (345, 290)];
/// A share of a contact that is removed and added again.
const SHARE: f64 = 0.5;

struct Case {
    grains: usize,
    network: Network,
    solver: SymmetricSolver,
    right: Vec<f64>,
}

fn cases() -> impl Iterator<Item = Case> {
    BLOCKS.into_iter().map(|(rows, longest)| {
        let network = Network::hexagonal(rows, longest);
        let order = minimum_degree(&network.pattern).expect("memory");
        let mut solver = SymmetricSolver::new(&network.pattern, &order).expect("memory");
        solver
            .factorise(&network.pattern, &network.values)
            .expect("a factor");
        Case {
            grains: network.unknowns() / 3,
            right: (0..network.unknowns()).map(|i| (i % 7) as f64).collect(),
            network,
            solver,
        }
    })
}

/// Half of the stiffness of twenty contacts, throughout the block.
fn halves(network: &Network) -> Vec<Entries> {
    let some = network.contacts.iter().step_by(network.contacts.len() / 20);
    let half = |entries: &Entries| {
        let rows = entries.iter();
        rows.map(|(i, w)| (*i, w.map(|w| SHARE.sqrt() * w)))
            .collect()
    };
    some.map(half).collect()
}

fn direct(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("direct solver");
    group
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500));
    for mut case in cases() {
        let (solver, network) = (&mut case.solver, &case.network);
        let named = |what: &str| BenchmarkId::new(what, case.grains);
        group.bench_function(named("factorise"), |bencher| {
            bencher.iter(|| solver.factorise(&network.pattern, &network.values));
        });
        let mut x = case.right.clone();
        group.bench_function(named("solve"), |bencher| {
            bencher.iter(|| {
                x.copy_from_slice(&case.right);
                solver.solve(&mut x);
            });
        });
        let mut pairs = vec![[1.0; 2]; x.len()];
        group.bench_function(named("solve two"), |bencher| {
            bencher.iter(|| {
                pairs.fill([1.0, 2.0]);
                solver.solve_many(&mut pairs);
            });
        });
        let some = halves(network);
        let mut one = vec![[0.0]; x.len()];
        let first: Vec<_> = some[10].iter().map(|(i, w)| (*i, [w[0]])).collect();
        group.bench_function(named("solve sparse"), |bencher| {
            bencher.iter(|| solver.solve_sparse(&first, &mut one));
        });
        let mut turn = some.iter().cycle();
        group.bench_function(named("flexibility"), |bencher| {
            bencher.iter(|| solver.flexibility(turn.next().expect("contacts")));
        });
        group.bench_function(named("remove and add"), |bencher| {
            bencher.iter(|| {
                let entries = turn.next().expect("contacts");
                solver.remove(entries).and_then(|()| solver.add(entries))
            });
        });
    }
}

criterion_group!(benches, direct);
criterion_main!(benches);
