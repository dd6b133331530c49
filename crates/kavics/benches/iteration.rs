//! Time of the elastic step of `scenes/bench/dropped-1m.toml` with fewer grains, by iteration (the multigrid's set-up and
//! the solve) and by a factor: `cargo bench -p kavics --bench iteration`. `RAYON_NUM_THREADS=1` keeps it to one thread.

use std::path::Path;

use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use kavics::loading::LoadPath;
use kavics::scene::{Scene, read_text};

const COUNTS: [usize; 2] = [10_000, 100_000];

fn scene(count: usize, solver: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/bench/dropped-1m.toml");
    let text = read_text(&path).expect("the scene");
    let width = 1.5 * (count as f64).sqrt();
    let text = text
        .replace("count = 1000000", &format!("count = {count}"))
        .replace("width = 1500.0", &format!("width = {width:?}"));
    let text = format!("{text}\n[equilibrium]\nsolver = \"{solver}\"\n");
    let no_lists = |_: &Path, _: Option<usize>| Err(String::new());
    Scene::parse(&text, "dropped", Path::new(""), &no_lists).expect("a right scene")
}

fn undeformed(scene: &Scene) -> LoadPath<'_> {
    let mut path = scene.load_path();
    path.next().expect("the start").expect("an equilibrium");
    path
}

fn elastic_step(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("elastic step");
    group.sample_size(10);
    for count in COUNTS {
        for solver in ["iterative", "direct"] {
            let scene = scene(count, solver);
            group.bench_function(BenchmarkId::new(solver, count), |bencher| {
                let start = || undeformed(&scene);
                bencher.iter_batched_ref(start, LoadPath::next, BatchSize::PerIteration);
            });
        }
    }
}

criterion_group!(benches, elastic_step);
criterion_main!(benches);
