//! Time to make and to measure assemblies of dropped grains, radii 0.5 to 1.5: `cargo bench -p kavics`, or a part of it
//! by name: `cargo bench -p kavics -- contact`. `RAYON_NUM_THREADS=1` keeps it to one thread.

use std::hint::black_box;
use std::path::Path;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use kavics::assembly::{Between, contact_graph};
use kavics::ids::PerSide;
use kavics::measure::{Snapshot, Window, geometric_measures, measures, void_cells};
use kavics::packing::{Bed, Sizes, dropped};
use kavics::scene::{Scene, read_text};

const COUNTS: [usize; 3] = [10_000, 100_000, 1_000_000];
const SEED: u64 = 1;

/// Width of a box whose height is about twice its width.
fn width(count: usize) -> f64 {
    1.5 * (count as f64).sqrt()
}

/// `scenes/million.toml` with fewer grains in a narrower box.
fn scene(count: usize) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/million.toml");
    let text = read_text(&path).expect("the scene");
    let text = text
        .replace("count = 1000000", &format!("count = {count}"))
        .replace("width = 1500.0", &format!("width = {:?}", width(count)));
    let no_lists = |_: &Path, _: Option<usize>| Err(String::new());
    Scene::parse(&text, "million", Path::new(""), &no_lists).expect("a right scene")
}

fn drop(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("drop");
    for count in COUNTS {
        let sizes = Sizes::Uniform { from: 0.5, to: 1.5 };
        let radii = sizes.radii(count, SEED).expect("radii");
        let bed = Bed::empty_box(width(count));
        group.throughput(Throughput::Elements(count as u64));
        group.bench_function(BenchmarkId::from_parameter(count), |bencher| {
            bencher.iter(|| dropped::drop(&bed, black_box(&radii), 1, SEED));
        });
    }
}

fn graph(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("near pairs, contact graph and power diagram");
    for count in COUNTS {
        let assembly = scene(count).assembly;
        let reach = PerSide::filled(0.0, assembly.sides.len());
        group.throughput(Throughput::Elements(count as u64));
        group.bench_function(BenchmarkId::from_parameter(count), |bencher| {
            bencher.iter(|| {
                let grains = black_box(&assembly.grains);
                contact_graph(grains, &assembly.sides, Between::Touching, &reach, 1e-6)
            });
        });
    }
}

/// All measures, those that need no equilibrium, and the void cells, in the state before loading.
fn all_measures(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("measures");
    for count in COUNTS {
        let scene = scene(count);
        let unloaded = scene.load_path().next().expect("the start");
        let unloaded = unloaded.expect("an equilibrium");
        let snapshot = Snapshot::new(&scene.assembly, &unloaded);
        let window = Window::new(scene.window.clone(), count);
        group.throughput(Throughput::Elements(count as u64));
        group.bench_function(BenchmarkId::new("all", count), |bencher| {
            bencher.iter(|| measures(black_box(&snapshot), &window));
        });
        group.bench_function(BenchmarkId::new("without equilibrium", count), |bencher| {
            bencher.iter(|| geometric_measures(black_box(&snapshot), &window));
        });
        group.bench_function(BenchmarkId::new("void cells", count), |bencher| {
            bencher.iter(|| void_cells(black_box(&snapshot)));
        });
    }
}

fn short() -> Criterion {
    Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(3))
}

criterion_group! {
    name = assemblies;
    config = short();
    targets = drop, graph, all_measures
}
criterion_main!(assemblies);
