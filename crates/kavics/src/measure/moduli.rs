//! Tangent moduli of a window: how its average stress answers a uniform strain of its rim.
//!
//! The grains at the rim of the window follow the strain without rotation, those inside find their balance. With
//! the average stress over the power cells and the strain over the triangles of the window, Hill's condition holds
//! exactly: the moduli are the energy of the answer, symmetric where the contacts have a potential, never above the
//! moduli without relaxation, and those of the lattice for a lattice (decision 0014).

use std::collections::HashSet;

use crate::assembly::{Assembly, Contact, Partner};
use crate::contact_law::{ContactForce, Matrix, RelativeDisplacement};
use crate::equilibrium::{ContactFrame, Displacement, relax};
use crate::geometry::Vector;
use crate::ids::{GrainId, PerBody, PerContact, PerGrain};
use crate::measure::{ElasticityTensor, Tensor, Window};

/// Tangent moduli of a window.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moduli {
    /// The moduli C of the window.
    pub tangent: ElasticityTensor,
    /// Their bound: the moduli if every grain followed the strain without rotation.
    pub voigt: ElasticityTensor,
}

/// Tangent moduli of a window, and their bound.
///
/// ```math
/// C_{ab} = \frac{1}{A H} \sum_c w_c\; v^c_a \cdot k_c\, v'^c_b, \qquad
/// C^V_{ab} = \frac{1}{A H} \sum_c w_c\; v^c_a \cdot k_c\, v^c_b
/// ```
///
/// v_a relative displacement under the uniform unit strain a of all grains, v′_b under b of the rim while the grains
/// inside have found their balance, k tangent of the contact, w the share of the branch within the window: 1 between
/// its grains and at a side, a/l where the contact leaves it. `[force/length²]`; none in an empty window, or where the
/// tangent has no answer. Upper bound: Voigt; Bathurst & Rothenburg (1988).
pub fn moduli(
    assembly: &Assembly,
    tangents: &PerContact<Matrix>,
    window: &Window,
) -> Option<Moduli> {
    let area: f64 = window.grains().iter().map(|&g| assembly.cell_area[g]).sum();
    let volume = area * assembly.thickness;
    if volume <= 0.0 {
        return None;
    }
    let affine = uniform_strains(assembly);
    let mut relaxed = affine.clone();
    relax(assembly, tangents, &inside(assembly, window), &mut relaxed).ok()?;
    let sums = sums(assembly, tangents, window, [&affine, &relaxed]);
    let [voigt, tangent] = sums.map(|rows| ElasticityTensor {
        rows: rows.map(|row| row.map(|sum| sum / volume)),
    });
    Some(Moduli { tangent, voigt })
}

/// The unit strains ε_xx, ε_yy, 2·ε_xy as displacements.
pub fn uniform_strains(assembly: &Assembly) -> [PerBody<Displacement>; 3] {
    UNIT_STRAINS.map(|strain| {
        let of_grains = assembly
            .grains
            .values()
            .iter()
            .map(|grain| moved(strain, grain.centre));
        let of_sides = assembly
            .sides
            .values()
            .iter()
            .map(|side| moved(strain, side.middle()));
        of_grains.chain(of_sides).collect()
    })
}

const UNIT_STRAINS: [Tensor; 3] = [
    Tensor {
        xx: 1.0,
        xy: 0.0,
        yx: 0.0,
        yy: 0.0,
    },
    Tensor {
        xx: 0.0,
        xy: 0.0,
        yx: 0.0,
        yy: 1.0,
    },
    Tensor {
        xx: 0.0,
        xy: 0.5,
        yx: 0.5,
        yy: 0.0,
    },
];

fn moved(strain: Tensor, place: Vector) -> Displacement {
    let Vector { x, y } = strain.at(place);
    Displacement {
        x,
        y,
        rotation: 0.0,
    }
}

/// The grains of the window that are not at its rim: no contact leaves the window or is with a side, and the
/// triangles of the window close around them.
pub fn inside(assembly: &Assembly, window: &Window) -> PerGrain<bool> {
    let mut inside = PerGrain::filled(false, assembly.grains.len());
    let within = |triangle: &&[GrainId; 3]| triangle.iter().all(|&grain| window.contains(grain));
    let triangles: Vec<&[GrainId; 3]> = assembly.triangles.iter().filter(within).collect();
    let edges = || {
        triangles
            .iter()
            .flat_map(|[a, b, c]| [(*a, *b), (*b, *c), (*c, *a)])
    };
    for (from, _) in edges() {
        inside[from] = true;
    }
    let known: HashSet<(GrainId, GrainId)> = edges().collect();
    for (from, to) in edges().filter(|&(from, to)| !known.contains(&(to, from))) {
        inside[from] = false;
        inside[to] = false;
    }
    for contact in assembly.contacts.values() {
        if contact.touches_side() || contact.grains().any(|grain| !window.contains(grain)) {
            for grain in contact.grains() {
                inside[grain] = false;
            }
        }
    }
    inside
}

/// Σ w·v_a·k·v_b over the contacts of the window, with v_b of each of the answers.
fn sums(
    assembly: &Assembly,
    tangents: &PerContact<Matrix>,
    window: &Window,
    answers: [&[PerBody<Displacement>; 3]; 2],
) -> [[[f64; 3]; 3]; 2] {
    let mut sums = [[[0.0; 3]; 3]; 2];
    let uniform = answers[0];
    for (contact, k) in assembly.contacts.values().iter().zip(tangents.values()) {
        let share = share_within(assembly, contact, window);
        if share == 0.0 {
            continue;
        }
        let frame = ContactFrame::new(assembly, contact);
        let opened = |fields: &[PerBody<Displacement>; 3]| {
            [0, 1, 2].map(|a| relative(assembly, contact, &frame, &fields[a], UNIT_STRAINS[a]))
        };
        let by_strain = opened(uniform);
        for (sum, fields) in sums.iter_mut().zip(answers) {
            let forces = opened(fields).map(|v| ContactForce::linear(k, v));
            for (row, v) in sum.iter_mut().zip(by_strain) {
                for (value, q) in row.iter_mut().zip(forces) {
                    *value +=
                        share * (q.normal * v.normal + q.shear * v.shear + q.moment * v.rotation);
                }
            }
        }
    }
    sums
}

/// Share of a contact's branch that lies within the window.
fn share_within(assembly: &Assembly, contact: &Contact, window: &Window) -> f64 {
    let share = |partner: Partner, outward: Vector| match partner {
        Partner::Grain(grain) if window.contains(grain) => {
            (contact.point - assembly.grains[grain].centre).dot(outward) / contact.branch_length
        }
        _ => 0.0,
    };
    share(contact.first, contact.normal) + share(contact.second, -contact.normal)
}

/// Relative displacement at a contact; a side follows the strain where the grain touches it.
fn relative(
    assembly: &Assembly,
    contact: &Contact,
    frame: &ContactFrame,
    field: &PerBody<Displacement>,
    strain: Tensor,
) -> RelativeDisplacement {
    let first = field[assembly.body(contact.first)];
    let second = match contact.second {
        Partner::Grain(_) => field[assembly.body(contact.second)],
        Partner::Side(_) => moved(strain, contact.point),
    };
    frame.relative_displacement(first, second)
}
