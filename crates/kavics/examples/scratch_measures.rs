use kavics::assembly::{Assembly, Between, Shaping, box_sides, contact_graph};
use kavics::contact_law::{ContactForce, Phase, RelativeDisplacement};
use kavics::equilibrium::{ContactState, Displacement, Load, State};
use kavics::ids::{GrainId, Id, PerBody, PerSide, PropertyId};
use kavics::measure::*;
use kavics::packing::*;

fn cpu() -> f64 {
    let mut total = 0u64;
    for e in std::fs::read_dir("/proc/self/task").unwrap() {
        let p = e.unwrap().path().join("schedstat");
        if let Ok(s) = std::fs::read_to_string(p) {
            total += s.split_whitespace().next().unwrap().parse::<u64>().unwrap();
        }
    }
    total as f64 * 1e-9
}

fn main() {
    let n: usize = std::env::args().nth(1).map_or(1_000_000, |a| a.parse().unwrap());
    let width = 1500.0 * (n as f64 / 1e6).sqrt();
    let radii = Sizes::Uniform { from: 0.5, to: 1.5 }.radii(n, 1).unwrap();
    let dropped = kavics::packing::dropped::drop(&Bed::empty_box(width), &radii, 1, 1).unwrap();
    let grains = dropped.grains;
    let top = grains.values().iter().fold(0.0f64, |t, g| t.max(g.centre.y + g.radius));
    let sides = box_sides(width, top, [true; 4]);
    let g = contact_graph(&grains, &sides, Between::Touching, &PerSide::filled(0.0, 4), 1e-7);
    let contacts: Vec<_> = g.sites.iter().map(|s| s.contact(Shaping::default(), &grains, PropertyId(0), 1.0)).collect();
    let count = contacts.len();
    let assembly = Assembly { grains, sides, contacts: contacts.into(), cell_area: g.cell_area, triangles: g.triangles, thickness: 1.0 };
    let bodies = assembly.body_count();
    let state = State {
        displacements: PerBody::filled(Displacement::default(), bodies),
        contacts: vec![ContactState { displacement: RelativeDisplacement::default(), force: ContactForce::default(), property: Some(PropertyId(0)), broken: false, phase: Phase::Closed }; count].into(),
    };
    let loads = PerBody::filled(Load::default(), bodies);
    let snapshot = Snapshot { assembly: &assembly, state: &state, loads: &loads, reactions: &loads };
    let window = Window::new((0..n).map(GrainId::from_index).collect(), n);
    println!("{n} grains {count} contacts");
    println!("size contact {} state {}", size_of::<kavics::assembly::Contact>(), size_of::<ContactState>());
    let time = |name: &str, f: &dyn Fn()| {
        let best = (0..5).map(|_| { let t = cpu(); f(); cpu() - t }).fold(f64::INFINITY, f64::min);
        println!("{name:30} {:.1} ms", best * 1e3);
    };
    if std::env::args().nth(2).is_some() { time("void cells", &|| { std::hint::black_box(void_cells(&snapshot)); }); time("measures", &|| { std::hint::black_box(measures(&snapshot, &window)); });time("geometric", &|| { std::hint::black_box(geometric_measures(&snapshot, &window)); });time("void cells", &|| { std::hint::black_box(void_cells(&snapshot)); });return; }
    time("measures", &|| { std::hint::black_box(measures(&snapshot, &window)); });
    time("coordination", &|| { std::hint::black_box(coordination_number(&snapshot, &window)); });
    time("fabric", &|| { std::hint::black_box(fabric_tensor(&snapshot, &window)); });
    time("porosity", &|| { std::hint::black_box(graph_porosity(&snapshot, &window)); });
    time("strain", &|| { std::hint::black_box(strain(&snapshot, &window)); });
    time("stress", &|| { std::hint::black_box(stress_partition(&snapshot, &window)); });
    time("work", &|| { std::hint::black_box(contact_work(&snapshot, &window)); });
    time("boundary", &|| { std::hint::black_box(boundary_work(&snapshot, &window, Tensor::default())); });
    let points: Vec<_> = assembly.grains.values().iter().map(|g| g.centre).collect();
    let mut edges = vec![];
    time("atan2", &|| { let mut s = 0.0; for c in assembly.contacts.values() { s += libm::atan2(c.normal.y, c.normal.x); } std::hint::black_box(s); });
    for c in assembly.contacts.values() { if let (kavics::assembly::Partner::Grain(a), kavics::assembly::Partner::Grain(b)) = (c.first, c.second) { edges.push([a.0, b.0]); } }
    time("embedding", &|| { std::hint::black_box(kavics::geometry::Embedding::new(&points, &edges)); });
    time("void cells", &|| { std::hint::black_box(void_cells(&snapshot)); });
    let v = void_cells(&snapshot);
    println!("V {} E {} L {} C {} euler {} mean {:?} sum {} enclosed {} void {}", v.grains, v.contacts, v.cells.len(), v.components, v.euler(), v.mean_order(), v.cells.iter().map(|c| c.area).sum::<f64>(), v.enclosed_area, v.cells.iter().map(|c| c.void_area).sum::<f64>());
    println!("{:?}", loop_orders(&v.cells));
}
