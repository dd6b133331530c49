//! A block of discs in hexagonal rows with made-up displacements and forces: something to write and to draw.
#![allow(dead_code, reason = "each test uses a part of it")]

use std::fs;
use std::path::Path;

use kavics::assembly::{Assembly, Contact, Grain, Partner, Side};
use kavics::contact_law::{
    Cemented, ContactForce, Law, Mode, Phase, Property, Reading, RelativeDisplacement,
    StiffnessRule, Strength,
};
use kavics::equilibrium::{
    ContactState, Displacement, EigenMode, Energy, Equilibrium, Event, EventKind, Freedom, Load,
    Settings, Stability, StabilitySummary, State, Warning,
};
use kavics::geometry::Vector;
use kavics::ids::{BodyId, ContactId, GrainId, Id, PerBody, PerGrain, PropertyId, SideId};
use kavics::loading::{Action, AppliedLoad, Breakage, Held, Program, Stage};
use kavics::measure::{
    ElasticityTensor, Measures, Moduli, StressPartition, SymmetricTensor, Tensor,
};
use kavics::scene::{RecordColumns, Scene};
use kavics_results::{Options, Results, RunState};

/// Rows of `long` and `long − 1` discs of radius 1, from the bottom; a side below them.
pub fn scene(rows: usize, long: usize) -> Scene {
    let grains = hexagonal(rows, long);
    let contacts = touching(&grains);
    let cell_area = vec![2.0 * 3f64.sqrt(); grains.len()];
    let bodies = grains.len();
    let last_row = bodies - long;
    let held = |body: usize| Held {
        body: BodyId::from_index(body),
        freedom: Freedom::Y,
    };
    let load = |body: usize| AppliedLoad {
        body: BodyId::from_index(body),
        load: Load {
            x: 0.0,
            y: -60.0,
            moment: 0.0,
        },
        action: 0,
    };
    Scene {
        title: "Block of discs, pressed from above".to_owned(),
        seed: 1,
        layers: vec![grains.len()],
        assembly: Assembly {
            grains: grains.into(),
            sides: sides(rows, long).into(),
            contacts: contacts.into(),
            cell_area: cell_area.into(),
            triangles: Vec::new(),
            thickness: 1.0,
        },
        wanted_curve: None,
        properties: vec![mortar()].into(),
        program: Program {
            actions: vec![Action {
                name: "traffic".to_owned(),
            }],
            held: (0..long).map(held).collect(),
            prescribed: Vec::new(),
            loads: (last_row..bodies).map(load).collect(),
            stages: vec![Stage {
                name: "compression".to_owned(),
                actions: vec![0],
                factors: vec![1.0, 1.2, 1.4, 1.6, 1.8],
            }],
        },
        settings: Settings::default(),
        breakage: Breakage::default(),
        control: kavics::loading::PathControl::default(),
        window: (long..bodies).map(GrainId::from_index).collect(),
        record_every: 1,
        record_voids: false,
        record_columns: RecordColumns::default(),
        record_cracks: false,
        compare: None,
        warnings: vec!["0.73 of the top side carries no load: no grain is met there".to_owned()],
        text: "title = \"Block of discs, pressed from above\"\n".to_owned(),
    }
}

fn hexagonal(rows: usize, long: usize) -> Vec<Grain> {
    let mut grains = Vec::new();
    for row in 0..rows {
        let shift = (row % 2) as f64;
        for place in 0..long - row % 2 {
            let x = 1.0 + shift + 2.0 * place as f64;
            let y = 1.0 + 3f64.sqrt() * row as f64;
            grains.push(Grain {
                centre: Vector::new(x, y),
                radius: 1.0,
            });
        }
    }
    grains
}

fn touching(grains: &[Grain]) -> Vec<Contact> {
    let mut contacts = Vec::new();
    for first in 0..grains.len() {
        let near = grains.len().min(first + 2000);
        for second in first + 1..near {
            let branch = grains[second].centre - grains[first].centre;
            if branch.length() < 2.0 + 1e-9 {
                contacts.push(contact(grains, first, second));
            }
        }
    }
    for (grain, disc) in grains.iter().enumerate() {
        if disc.centre.y < 1.0 + 1e-9 {
            contacts.push(with_bottom(grains, grain));
        }
    }
    contacts
}

fn contact(grains: &[Grain], first: usize, second: usize) -> Contact {
    let branch = grains[second].centre - grains[first].centre;
    Contact {
        first: Partner::Grain(GrainId::from_index(first)),
        second: Partner::Grain(GrainId::from_index(second)),
        normal: branch * (1.0 / branch.length()),
        branch_length: branch.length(),
        point: grains[first].centre + branch * 0.5,
        dual_parts: [0.577, 0.577],
        dual_length_full: 1.155,
        property: PropertyId(0),
        strength_factor: 1.0,
    }
}

fn with_bottom(grains: &[Grain], grain: usize) -> Contact {
    let centre = grains[grain].centre;
    Contact {
        second: Partner::Side(SideId(2)),
        normal: Vector::new(0.0, -1.0),
        branch_length: 1.0,
        point: Vector::new(centre.x, 0.0),
        ..contact(grains, grain, (grain + 1) % grains.len())
    }
}

fn sides(rows: usize, long: usize) -> Vec<Side> {
    let (width, height) = (2.0 * long as f64, 2.0 + 3f64.sqrt() * (rows - 1) as f64);
    let side = |name: &str, start, end, outward| Side {
        name: name.to_owned(),
        start,
        end,
        outward,
        present: name == "bottom",
    };
    let corner = Vector::new;
    vec![
        side(
            "left",
            corner(0.0, 0.0),
            corner(0.0, height),
            corner(-1.0, 0.0),
        ),
        side(
            "right",
            corner(width, 0.0),
            corner(width, height),
            corner(1.0, 0.0),
        ),
        side(
            "bottom",
            corner(0.0, 0.0),
            corner(width, 0.0),
            corner(0.0, -1.0),
        ),
        side(
            "top",
            corner(0.0, height),
            corner(width, height),
            corner(0.0, 1.0),
        ),
    ]
}

fn mortar() -> Property {
    Property {
        name: "mortar".to_owned(),
        law: Law::Cemented(Cemented {
            stiffness: StiffnessRule::Layer {
                normal: 1000.0,
                shear: 550.0,
            },
            shear_hardening: 0.75,
            reading: Reading::Printed,
            shear_floor: None,
            eccentric: false,
            strength: Strength::UNBREAKABLE,
            after_breakage: None,
        }),
    }
}

/// Load factors of the made-up run; step 0 first.
pub const FACTORS: [f64; 6] = [0.0, 1.0, 1.2, 1.4, 1.6, 1.8];

/// Contacts that break at step 5: the horizontal ones of two grains in the middle.
fn breaking(scene: &Scene) -> Vec<ContactId> {
    let contacts = scene.assembly.contacts.iter();
    let level = contacts.filter(|(_, contact)| contact.normal.y == 0.0);
    let middle = scene.assembly.sides[SideId(3)].middle() * 0.5;
    let near = level.filter(|(_, contact)| (contact.point - middle * 1.0).length() < 4.0);
    near.map(|(id, _)| id).take(3).collect()
}

/// A made-up equilibrium of load step `step`.
pub fn equilibrium(scene: &Scene, step: usize) -> Equilibrium {
    let factor = FACTORS[step];
    let broken = if step == 5 {
        breaking(scene)
    } else {
        Vec::new()
    };
    let contacts = scene.assembly.contacts.iter();
    let states: Vec<ContactState> = contacts
        .map(|(id, contact)| contact_state(contact, factor, broken.contains(&id)))
        .collect();
    let bodies = scene.assembly.body_count();
    let mut loads = PerBody::filled(Load::default(), bodies);
    for applied in &scene.program.loads {
        loads[applied.body].y += applied.load.y * factor;
    }
    let mut reactions = PerBody::filled(Load::default(), bodies);
    for held in &scene.program.held {
        reactions[held.body].y = 60.0 * factor;
    }
    let event = |contact| Event {
        iteration: 3,
        load_factor: factor,
        kind: EventKind::Broke {
            contact,
            mode: Mode::Tension,
            fracture_energy: 0.012,
            release_energy: 0.034,
        },
        avalanche: None,
        drive: None,
    };
    Equilibrium {
        step,
        stage: 0,
        load_factor: factor,
        factors: vec![factor; scene.program.actions.len()],
        complete: true,
        iterations: if step == 0 { 0 } else { 4 + step },
        work_iterations: 0,
        residual: 3.1e-12 * factor,
        cuts: 0,
        state: State {
            displacements: displacements(scene, factor, step == 5),
            contacts: states.into(),
        },
        loads,
        reactions,
        set_aside: PerGrain::filled(false, scene.assembly.grains.len()),
        energy: energy(factor, step == 5),
        events: broken.into_iter().map(event).collect(),
        warnings: if step == 5 {
            vec![Warning::SecondOrderWork { contacts: 1 }]
        } else {
            Vec::new()
        },
        stability: (step > 0 && scene.settings.modes > 0).then(|| stability(scene)),
        ..Equilibrium::default()
    }
}

/// One made-up mode: all rows slide, the farther up the more.
fn stability(scene: &Scene) -> Stability {
    let height = scene.assembly.sides[SideId(3)].middle().y;
    let grains = scene.assembly.grains.values().iter();
    let slide = grains.map(|grain| Displacement {
        x: grain.centre.y / (height - 1.0),
        y: 0.0,
        rotation: 0.0,
    });
    let sides = scene.assembly.sides.values().iter();
    Stability {
        summary: StabilitySummary {
            lowest_eigenvalue: Some(0.125),
            static_indeterminacy: 90,
            second_order_work: 0.5,
            ..StabilitySummary::default()
        },
        modes: vec![EigenMode {
            eigenvalue: 0.125,
            participation: 20.0,
            foremost: Vec::new(),
            displacements: slide
                .chain(sides.map(|_| Displacement::default()))
                .collect(),
        }],
    }
}

fn displacements(scene: &Scene, factor: f64, broken: bool) -> PerBody<Displacement> {
    let give = if broken { 1.08 } else { 1.0 };
    let grains = scene.assembly.grains.values().iter();
    let mut all: Vec<Displacement> = grains
        .map(|grain| Displacement {
            x: 0.004 * factor * give * (grain.centre.x - 5.0),
            y: -0.011 * factor * give * grain.centre.y,
            rotation: 0.0,
        })
        .collect();
    all.resize(scene.assembly.body_count(), Displacement::default());
    all.into()
}

fn contact_state(contact: &Contact, factor: f64, broken: bool) -> ContactState {
    let n = contact.normal;
    let wave = 1.0 + 0.35 * (3.0 * contact.point.x).sin() * (2.0 * contact.point.y).cos();
    let normal = factor * wave * (9.0 * n.x * n.x - 45.0 * n.y * n.y);
    let shear = factor * wave * 14.0 * n.x * n.y;
    let carried = if broken { 0.0 } else { 1.0 };
    ContactState {
        displacement: RelativeDisplacement {
            normal: normal / 1155.0,
            shear: shear / 635.0,
            rotation: 0.0,
        },
        force: ContactForce {
            normal: normal * carried,
            shear: shear * carried,
            moment: 0.0,
        },
        property: (!broken).then_some(PropertyId(0)),
        broken,
        phase: if broken { Phase::Open } else { Phase::Closed },
    }
}

fn energy(factor: f64, broken: bool) -> Energy {
    let lost = if broken { 1.0 } else { 0.0 };
    let nonpotential_work = 0.02 * factor * factor * factor;
    let elastic_energy = 4.2 * factor * factor;
    Energy {
        external_work: elastic_energy + nonpotential_work + 0.138 * lost + 2e-4 * factor,
        elastic_energy,
        fracture_energy: 0.036 * lost,
        friction_work: 0.0,
        nonpotential_work,
        release_energy: 0.102 * lost,
    }
}

/// Made-up measures: the stress parts of Bojtár & Bagi (1989), section 5, at their five load factors.
pub fn measures(step: usize) -> Measures {
    let shear = [0.0, 5.305, 6.459, 7.628, 8.811, 10.363][step];
    let variation = [0.0, 8.843, 10.530, 12.203, 13.865, 13.651][step];
    let fabric = [0.0, 0.744, 0.892, 1.039, 1.186, 2.784][step];
    let isotropic = [0.0, -15.180, -18.206, -21.231, -24.255, -27.333][step];
    let part = |value: f64| Tensor {
        xx: value,
        xy: 0.0,
        yx: 0.0,
        yy: -value,
    };
    let along = shear + variation + fabric;
    let damage = if step == 5 { 0.035 } else { 0.0 };
    let spread = |xx: f64| SymmetricTensor {
        xx,
        xy: 0.01 * damage,
        yy: 1.0 - xx,
    };
    Measures {
        window_area: 93.53,
        coordination_number: Some(4.6 - 4.0 * damage),
        void_ratio: Some(0.103),
        graph_porosity: Some(0.87 - damage),
        graph_porosity_printed: Some(1.74 - 2.0 * damage),
        fabric: Some(spread(0.475 - damage)),
        fabric_length: Some(spread(0.475 - damage)),
        branch: Some(spread(0.475 - damage)),
        contact: Some(spread(0.48 - damage)),
        stress: Some(StressPartition {
            total: Tensor {
                xx: isotropic + along,
                xy: 0.0,
                yx: 0.0,
                yy: isotropic - along,
            },
            shear: part(shear),
            variation: part(variation),
            fabric: part(fabric),
            isotropic,
        }),
        strain: Some(Tensor {
            xx: 0.004 * FACTORS[step],
            xy: 0.0,
            yx: 0.0,
            yy: -0.011 * FACTORS[step],
        }),
        contact_work: Some(8.4 * FACTORS[step] * FACTORS[step]),
        macroscopic_work: Some(8.1 * FACTORS[step] * FACTORS[step]),
        boundary_work: Some(0.3 * FACTORS[step] * FACTORS[step]),
        moduli: Some(Moduli {
            tangent: ElasticityTensor::isotropic(40.0, 20.0),
            voigt: ElasticityTensor::isotropic(50.0, 40.0),
        }),
    }
}

/// Writes the whole made-up run to `folder`.
pub fn write(folder: &Path, scene: &Scene) {
    let options = Options {
        threads: 1,
        replace: false,
    };
    let mut results = Results::create(folder, scene, options).expect("an empty place");
    let stress = PerGrain::filled(Tensor::default(), scene.assembly.grains.len());
    for step in 0..FACTORS.len() {
        results
            .push(&equilibrium(scene, step), &measures(step), &stress)
            .expect("room on the disk");
    }
    results
        .finish(RunState::Done, None)
        .expect("room on the disk");
}

/// Every file under `folder` with its bytes, in the order of the names, but the log.
pub fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.path().is_dir() {
            let inner = files(&entry.path()).into_iter();
            found.extend(inner.map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
        } else if name != "log.ndjson" {
            found.push((name, fs::read(entry.path()).expect("a file")));
        }
    }
    found.sort();
    found
}
