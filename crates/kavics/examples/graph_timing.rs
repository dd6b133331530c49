//! Times.
use kavics::assembly::*;
use kavics::ids::*;
use kavics::packing::*;

fn cpu() -> f64 {
    std::fs::read_dir("/proc/self/task")
        .unwrap()
        .map(|t| {
            std::fs::read_to_string(t.unwrap().path().join("schedstat"))
                .unwrap()
                .split(' ')
                .next()
                .unwrap()
                .parse::<f64>()
                .unwrap()
        })
        .sum::<f64>()
        * 1e-9
}
struct T(f64);
impl T {
    fn elapsed(&self) -> S {
        S(cpu() - self.0)
    }
}
struct S(f64);
impl S {
    fn as_secs_f64(&self) -> f64 {
        self.0
    }
}
fn main() {
    let n: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    let kind = std::env::args().nth(2).unwrap_or("uni".into());
    rayon::ThreadPoolBuilder::new()
        .num_threads(std::env::var("T").map_or(1, |t| t.parse().unwrap()))
        .build_global()
        .unwrap();
    let t = T(cpu());
    let width;
    let grains = match kind.as_str() {
        "hex" => {
            let c = ((n as f64).sqrt()) as usize;
            width = 2.0 * c as f64 + 2.0;
            let rows: Vec<usize> = (0..c).map(|r| c - r % 2).collect();
            rows::hexagonal(1.0, width, &rows).unwrap()
        }
        "square" => {
            let c = ((n as f64).sqrt()) as usize;
            width = 2.0 * c as f64;
            rows::square(1.0, width, c, c).unwrap()
        }
        "uni" | "random" => {
            width = 1.5 * (n as f64).sqrt();
            let sizes = Sizes::Uniform { from: 0.5, to: 1.5 };
            let radii = sizes.radii(n, 1).unwrap();
            let mut g = dropped::drop(
                &dropped::Bed {
                    shape: dropped::Shape::Box { width },
                    resting: &[],
                    top: None,
                    layer: 0,
                },
                &radii,
                1,
                1,
            )
            .unwrap()
            .grains;
            if kind == "random" {
                random::stream(5, Purpose::Order).shuffle(g.values_mut());
            }
            g
        }
        _ => {
            width = 2.9 * (n as f64).sqrt();
            let k = 20;
            let d: Vec<f64> = (0..=k).map(|i| 100f64.powf(i as f64 / k as f64)).collect();
            let p: Vec<f64> = (0..=k).map(|i| i as f64 / k as f64).collect();
            let sizes = Sizes::Sieve(SieveCurve {
                diameter: d,
                passing: p,
                mass: Mass::Disc,
            });
            let radii = sizes.radii(n, 1).unwrap();
            dropped::drop(
                &dropped::Bed {
                    shape: dropped::Shape::Box { width },
                    resting: &[],
                    top: None,
                    layer: 0,
                },
                &radii,
                1,
                1,
            )
            .unwrap()
            .grains
        }
    };
    println!("pack {:.3}", t.elapsed().as_secs_f64());
    let top = grains
        .values()
        .iter()
        .map(|g| g.centre.y + g.radius)
        .fold(0.0, f64::max);
    let sides = box_sides(width, top, [true; 4]);
    let reach = PerSide::filled(0.0, 4);
    let mean = grains.values().iter().map(|g| g.radius).sum::<f64>() / n as f64;
    let centres: Vec<_> = grains.values().iter().map(|g| g.centre).collect();
    let radii: Vec<_> = grains.values().iter().map(|g| g.radius).collect();
    for _ in 0..3 {
        use kavics::geometry::*;
        let t = T(cpu());
        let mut last = 0.0;
        let mut lap = |name: &str| {
            let now = t.elapsed().as_secs_f64();
            print!("{name} {:.3}  ", now - last);
            last = now;
        };
        let order = spatial_order(&centres);
        lap("order");
        let planes: Vec<_> = sides
            .values()
            .iter()
            .map(|s| HalfPlane {
                point: s.start,
                outward: s.outward,
            })
            .collect();
        let container = Container::new(&planes);
        let scale = 1.0 / container.unit();
        let c: Vec<Vector> = order.iter().map(|&k| centres[k as usize] * scale).collect();
        let r: Vec<f64> = order.iter().map(|&k| radii[k as usize] * scale).collect();
        lap("permute");
        let grid = Grid::new(&c, &r);
        lap("grid");
        let near = grid.near_pairs(1e-3 * mean * scale);
        lap("near");
        let d = power_diagram_of(&grid, &container.scaled(scale), &near, Edges::OfNearPairs);
        lap("diagram");
        println!("{}", d.edges.len());
    }
    for _ in 0..3 {
        let t = T(cpu());
        let g = contact_graph(&grains, &sides, Between::Touching, &reach, 1e-7 * mean);
        let area: f64 = g.cell_area.values().iter().sum();
        println!(
            "contact_graph {:.3}  sites {} triangles {} area err {:.1e}",
            t.elapsed().as_secs_f64(),
            g.sites.len(),
            g.triangles.len(),
            area / (width * top) - 1.0
        );
    }
}
