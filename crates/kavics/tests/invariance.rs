//! Moving, turning, scaling and renumbering an assembly changes its equilibrium and its measures only as it must.

use kavics::assembly::{
    Assembly, Between, Bodies, ContactGraph, Grain, Shaping, Side, contact_graph,
};
use kavics::contact_law::{Cemented, Law, Property, Reading, StiffnessRule, Strength};
use kavics::equilibrium::{Equilibrium, Freedom, Load, Settings};
use kavics::geometry::Vector;
use kavics::ids::{BodyId, GrainId, Id, PerGrain, PerProperty, PerSide, PropertyId};
use kavics::loading::{Action, AppliedLoad, Breakage, Held, LoadPath, Program, Stage};
use kavics::measure::{Measures, Snapshot, Tensor, Window, measures};
use kavics::packing::{Bed, dropped};
use proptest::prelude::*;

const GRAINS: usize = 40;
/// Grains that are held, of the first.
const HELD: usize = 6;
const TIGHT: f64 = 1e-7;

/// What is done to an assembly.
#[derive(Clone, Debug)]
struct Change {
    scale: f64,
    angle: f64,
    shift: Vector,
    /// New id of each grain.
    ids: Vec<usize>,
}

impl Change {
    fn none() -> Self {
        Self {
            scale: 1.0,
            angle: 0.0,
            shift: Vector::new(0.0, 0.0),
            ids: (0..GRAINS).collect(),
        }
    }

    fn turned(&self, v: Vector) -> Vector {
        let (s, c) = (libm::sin(self.angle), libm::cos(self.angle));
        Vector::new(c * v.x - s * v.y, s * v.x + c * v.y)
    }

    fn grains(&self, grains: &PerGrain<Grain>) -> PerGrain<Grain> {
        let mut changed: Vec<Grain> = grains.values().to_vec();
        for (grain, &id) in grains.values().iter().zip(&self.ids) {
            changed[id] = Grain {
                centre: self.turned(grain.centre) * self.scale + self.shift,
                radius: self.scale * grain.radius,
            };
        }
        changed.into()
    }

    fn id(&self, grain: usize) -> GrainId {
        GrainId::from_index(self.ids[grain])
    }
}

fn grains(seed: u64) -> PerGrain<Grain> {
    let radii: Vec<f64> = (0..GRAINS)
        .map(|k| 0.5 + (k * 7 % GRAINS) as f64 / GRAINS as f64)
        .collect();
    let bed = dropped::drop(&Bed::empty_box(12.0), &radii, 1, seed);
    bed.expect("a pack").grains
}

fn assembly(grains: PerGrain<Grain>) -> Assembly {
    let sides: PerSide<Side> = Vec::new().into();
    let ContactGraph {
        sites,
        cell_area,
        triangles,
    } = contact_graph(
        &grains,
        &sides,
        Between::Neighbours,
        &PerSide::filled(0.0, 0),
        1e-7,
    );
    let bodies = Bodies {
        grains: &grains,
        sides: &sides,
    };
    let contacts = sites
        .iter()
        .map(|s| s.contact(Shaping::default(), bodies, PropertyId(0), 1.0))
        .collect();
    Assembly {
        grains,
        sides,
        contacts,
        cell_area,
        triangles,
        thickness: 1.0,
    }
}

/// E·s, G·s and E·s³/12: grow with the scale, and with its cube.
fn cement() -> PerProperty<Property> {
    let law = Law::Cemented(Cemented {
        stiffness: StiffnessRule::Layer {
            normal: 100.0,
            shear: 60.0,
        },
        shear_hardening: 0.0,
        reading: Reading::Printed,
        shear_floor: None,
        eccentric: false,
        strength: Strength::UNBREAKABLE,
        after_breakage: None,
    });
    vec![Property {
        name: "cement".into(),
        law,
    }]
    .into()
}

/// The last grain pushed, the first ones held.
fn solve(assembly: &Assembly, change: &Change, push: Vector) -> Equilibrium {
    let properties = cement();
    let freedoms = [Freedom::X, Freedom::Y, Freedom::Rotation];
    let body = |grain: usize| BodyId(change.id(grain).0);
    let force = change.turned(push);
    let program = Program {
        actions: vec![Action {
            name: "push".into(),
        }],
        held: (0..HELD)
            .flat_map(|grain| {
                freedoms.map(|freedom| Held {
                    body: body(grain),
                    freedom,
                })
            })
            .collect(),
        loads: vec![AppliedLoad {
            body: body(GRAINS - 1),
            load: Load {
                x: force.x,
                y: force.y,
                moment: 0.0,
            },
            action: 0,
        }],
        stages: vec![Stage {
            name: "push".into(),
            actions: vec![0],
            factors: vec![1.0],
        }],
        ..Program::default()
    };
    let path = LoadPath::new(
        assembly,
        &properties,
        &program,
        Breakage::WorstFirst,
        Settings::default(),
    );
    path.last().expect("a load step").expect("an equilibrium")
}

fn measured(assembly: &Assembly, equilibrium: &Equilibrium, change: &Change) -> Measures {
    let window = (HELD..GRAINS - 1).map(|grain| change.id(grain)).collect();
    let snapshot = Snapshot {
        assembly,
        state: &equilibrium.state,
        loads: &equilibrium.loads,
        reactions: &equilibrium.reactions,
    };
    measures(&snapshot, &Window::new(window, GRAINS))
}

fn close(found: f64, expected: f64, size: f64) -> bool {
    (found - expected).abs() <= TIGHT * size
}

fn turned_back(change: &Change, tensor: Tensor) -> Tensor {
    let back = Change {
        angle: -change.angle,
        ..Change::none()
    };
    // Q·a·Qᵀ, column by column, then row by row.
    let columns = [
        back.turned(Vector::new(tensor.xx, tensor.yx)),
        back.turned(Vector::new(tensor.xy, tensor.yy)),
    ];
    let first = back.turned(Vector::new(columns[0].x, columns[1].x));
    let second = back.turned(Vector::new(columns[0].y, columns[1].y));
    Tensor {
        xx: first.x,
        xy: first.y,
        yx: second.x,
        yy: second.y,
    }
}

fn same(found: Tensor, expected: Tensor) -> bool {
    let size = [expected.xx, expected.xy, expected.yx, expected.yy]
        .into_iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    close(found.xx, expected.xx, size)
        && close(found.xy, expected.xy, size)
        && close(found.yx, expected.yx, size)
        && close(found.yy, expected.yy, size)
}

fn changes() -> impl Strategy<Value = Change> {
    let ids = Just((0..GRAINS).collect::<Vec<_>>()).prop_shuffle();
    (
        0.2..5.0_f64,
        -3.0..3.0_f64,
        -50.0..50.0_f64,
        -50.0..50.0_f64,
        ids,
    )
        .prop_map(|(scale, angle, x, y, ids)| Change {
            scale,
            angle,
            shift: Vector::new(x, y),
            ids,
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn an_equilibrium_goes_with_its_assembly(seed in 0_u64..1000, change in changes(), x in -1.0..1.0, y in 0.1..1.0) {
        let (before, push) = (grains(seed), Vector::new(x, y));
        let (one, none) = (assembly(before.clone()), Change::none());
        let other = assembly(change.grains(&before));
        prop_assert_eq!(one.contacts.len(), other.contacts.len());
        let [here, there] = [(&one, &none), (&other, &change)]
            .map(|(assembly, change)| solve(assembly, change, push));
        let size = here.state.displacements.values().iter().map(|u| u.x.hypot(u.y)).fold(0.0, f64::max);
        for grain in 0..GRAINS {
            let u = here.state.displacements[BodyId::from_index(grain)];
            let v = there.state.displacements[BodyId(change.id(grain).0)];
            let expected = change.turned(Vector::new(u.x, u.y)) * (1.0 / change.scale);
            prop_assert!(close(v.x, expected.x, size / change.scale), "{} {}", v.x, expected.x);
            prop_assert!(close(v.y, expected.y, size / change.scale));
            let rotation = u.rotation / (change.scale * change.scale);
            prop_assert!(close(v.rotation, rotation, size / (change.scale * change.scale)));
        }
    }

    #[test]
    fn measures_go_with_their_assembly(seed in 0_u64..1000, change in changes(), x in -1.0..1.0, y in 0.1..1.0) {
        let (before, push) = (grains(seed), Vector::new(x, y));
        let (one, none) = (assembly(before.clone()), Change::none());
        let other = assembly(change.grains(&before));
        let [here, there] = [(&one, &none), (&other, &change)]
            .map(|(assembly, change)| measured(assembly, &solve(assembly, change, push), change));
        let scale = change.scale;
        prop_assert!(close(there.window_area, scale * scale * here.window_area, scale * scale * here.window_area));
        for (found, expected) in [
            (there.coordination_number, here.coordination_number),
            (there.void_ratio, here.void_ratio),
            (there.graph_porosity, here.graph_porosity),
        ] {
            let (found, expected) = (found.expect("a measure"), expected.expect("a measure"));
            prop_assert!(close(found, expected, expected.abs()));
        }
        let full = |t: kavics::measure::SymmetricTensor| Tensor { xx: t.xx, xy: t.xy, yx: t.xy, yy: t.yy };
        let [fabric, was] = [there.fabric, here.fabric].map(|f| full(f.expect("a fabric tensor")));
        prop_assert!(same(turned_back(&change, fabric), was));
        let [stress, was] = [there.stress, here.stress].map(|s| s.expect("a stress").total);
        // The same forces, on sides that are longer.
        prop_assert!(same(turned_back(&change, stress), was * (1.0 / scale)));
        let [strain, was] = [there.strain, here.strain].map(|s| s.expect("a strain"));
        prop_assert!(same(turned_back(&change, strain), was * (1.0 / (scale * scale))));
    }
}
