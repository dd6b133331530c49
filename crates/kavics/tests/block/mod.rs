//! A block of discs between two sides, with any contact forces and the loads that balance them.

use kavics::assembly::{Assembly, Contact, Grain, Partner, Side};
use kavics::contact_law::{ContactForce, Phase};
use kavics::equilibrium::{ContactState, Displacement, Load, State};
use kavics::geometry::Vector;
use kavics::ids::{GrainId, Id, PerBody, PropertyId, SideId};
use kavics::measure::{Snapshot, Tensor, Window};
use proptest::prelude::*;

/// Discs in each row, from the bottom.
const ROWS: [usize; 5] = [5, 4, 5, 4, 5];
/// Discs in all.
pub const GRAINS: usize = 23;
/// The disc in the middle.
pub const INNER: GrainId = GrainId(11);
const SIDES: usize = 2;
const NUMBERS_A_GRAIN: usize = 8;
const NUMBERS_A_CONTACT: usize = 6;
const MOST_CONTACTS: usize = 60;

/// An assembly, a state of it, and the loads under which it is in equilibrium.
#[derive(Clone, Debug)]
pub struct Block {
    pub assembly: Assembly,
    pub state: State,
    loads: PerBody<Load>,
    reactions: PerBody<Load>,
}

/// The numbers in [−1, 1] that a random block is made of.
pub fn numbers() -> impl Strategy<Value = Vec<f64>> {
    let count = GRAINS * NUMBERS_A_GRAIN + MOST_CONTACTS * NUMBERS_A_CONTACT;
    prop::collection::vec(-1.0..=1.0, count)
}

/// Equal touching discs on a lattice, with forces and displacements that differ everywhere.
pub fn regular() -> Block {
    let grains: Vec<Grain> = lattice().map(|centre| disc(centre, 1.0)).collect();
    let contacts = contacts(&grains, |_| [0.0, 0.0]);
    let state = State {
        displacements: (0..GRAINS + SIDES).map(|k| drift(k as f64)).collect(),
        contacts: (0..contacts.len())
            .map(|k| active(wave(k as f64)))
            .collect(),
    };
    assemble(grains, contacts, state, 0.5)
}

/// A block of unequal discs off the lattice, contact points off the branches, some contacts inactive.
pub fn block(numbers: &[f64]) -> Block {
    let (of_grains, of_contacts) = numbers.split_at(GRAINS * NUMBERS_A_GRAIN);
    let own: Vec<&[f64]> = of_grains.chunks(NUMBERS_A_GRAIN).collect();
    let shared: Vec<&[f64]> = of_contacts.chunks(NUMBERS_A_CONTACT).collect();
    let grains: Vec<Grain> = lattice()
        .zip(&own)
        .map(|(c, x)| disc(c + Vector::new(x[0], x[1]) * 0.1, 0.9 + 0.1 * x[2]))
        .collect();
    let contacts = contacts(&grains, |k| [0.2 * shared[k][0], 0.5 * shared[k][1]]);
    let mut displacements: Vec<_> = own.iter().map(|x| moved(x[3], x[4], x[5])).collect();
    displacements.extend([moved(0.1, 0.2, 0.3); SIDES]);
    let states = shared[..contacts.len()].iter().map(|x| {
        let force = ContactForce {
            normal: x[2],
            shear: x[3],
            moment: x[4],
        };
        if x[5] > -0.7 { active(force) } else { open() }
    });
    let state = State {
        displacements: displacements.into(),
        contacts: states.collect(),
    };
    assemble(grains, contacts, state, 0.7)
}

impl Block {
    pub fn snapshot(&self) -> Snapshot<'_> {
        Snapshot {
            assembly: &self.assembly,
            state: &self.state,
            loads: &self.loads,
            reactions: &self.reactions,
        }
    }

    pub fn everything(&self) -> Window {
        self.some_grains(&[true; GRAINS])
    }

    /// The grains with all six neighbours.
    pub fn inner() -> Window {
        Window::new([6, 7, 10, 11, 12, 15, 16].map(GrainId).to_vec(), GRAINS)
    }

    pub fn some_grains(&self, chosen: &[bool]) -> Window {
        let grains = self.assembly.grains.ids().zip(chosen);
        let grains = grains.filter(|&(_, &yes)| yes).map(|(grain, _)| grain);
        Window::new(grains.collect(), GRAINS)
    }

    pub fn complement(&self, window: &Window) -> Window {
        let ids = self.assembly.grains.ids();
        Window::new(ids.filter(|&g| !window.contains(g)).collect(), GRAINS)
    }

    /// Outward normal and force on the grain of each of its active contacts.
    pub fn normals_and_forces(&self, grain: GrainId) -> Vec<(Vector, Vector)> {
        let contacts = self.assembly.contacts.iter();
        contacts
            .filter_map(|(id, contact)| {
                let sign = sign_at(contact, Partner::Grain(grain))?;
                let force = force_on_first(contact, &self.state.contacts[id]);
                Some((contact.normal * sign, force * sign))
            })
            .collect()
    }

    /// Each active contact as often as grains of the window have it.
    pub fn met(&self, window: &Window) -> Vec<Contact> {
        let contacts = self.assembly.contacts.iter();
        contacts
            .filter(|&(id, _)| self.state.contacts[id].is_active())
            .flat_map(|(_, contact)| {
                let times = contact.grains().filter(|&g| window.contains(g)).count();
                vec![*contact; times]
            })
            .collect()
    }

    /// Σ x_i f_j of the loads at the centres and the forces of the sides at their contact points.
    pub fn first_moment_of_outer_forces(&self) -> Tensor {
        let mut sum = Tensor::default();
        for (id, grain) in self.assembly.grains.iter() {
            let body = self.assembly.body(Partner::Grain(id));
            for load in [self.loads[body], self.reactions[body]] {
                sum += Tensor::product(grain.centre, Vector::new(load.x, load.y));
            }
        }
        for (id, contact) in self.assembly.contacts.iter() {
            if contact.touches_side() {
                let force = force_on_first(contact, &self.state.contacts[id]);
                sum += Tensor::product(contact.point, force);
            }
        }
        sum
    }

    pub fn external_moment(&self, window: &Window) -> f64 {
        let bodies = window.grains().iter().map(|g| g.index());
        bodies
            .map(|k| self.loads.values()[k].moment + self.reactions.values()[k].moment)
            .sum()
    }

    /// The same block with all its displacements those of the gradient ∂_i u_j, and a shift.
    pub fn affine(&self, gradient: Tensor) -> Self {
        let mut other = self.clone();
        for (id, grain) in self.assembly.grains.iter() {
            let u = gradient.at(grain.centre) + Vector::new(0.4, -0.7);
            let body = self.assembly.body(Partner::Grain(id));
            other.state.displacements[body] = moved(u.x, u.y, 0.2);
        }
        other
    }

    /// The same block turned about the origin, counter-clockwise, with all it carries.
    pub fn turned(&self, angle: f64) -> Self {
        let (c, s) = (libm::cos(angle), libm::sin(angle));
        let turn = |v: Vector| Vector::new(c * v.x - s * v.y, s * v.x + c * v.y);
        let mut other = self.clone();
        for grain in other.assembly.grains.values_mut() {
            grain.centre = turn(grain.centre);
        }
        for side in other.assembly.sides.values_mut() {
            (side.start, side.end) = (turn(side.start), turn(side.end));
            side.outward = turn(side.outward);
        }
        for contact in other.assembly.contacts.values_mut() {
            (contact.normal, contact.point) = (turn(contact.normal), turn(contact.point));
        }
        for u in other.state.displacements.values_mut() {
            let v = turn(Vector::new(u.x, u.y));
            (u.x, u.y) = (v.x, v.y);
        }
        for table in [&mut other.loads, &mut other.reactions] {
            for load in table.values_mut() {
                let f = turn(Vector::new(load.x, load.y));
                (load.x, load.y) = (f.x, f.y);
            }
        }
        other
    }
}

fn lattice() -> impl Iterator<Item = Vector> {
    let pitch = 3.0_f64.sqrt();
    ROWS.into_iter().enumerate().flat_map(move |(row, count)| {
        let left = (6 - count) as f64;
        (0..count).map(move |k| Vector::new(left + 2.0 * k as f64, 1.0 + pitch * row as f64))
    })
}

fn disc(centre: Vector, radius: f64) -> Grain {
    Grain { centre, radius }
}

/// Contacts of lattice neighbours and of the first and last row with the sides below and above; `place` gives the
/// contact point's offset along normal and tangent.
fn contacts(grains: &[Grain], place: impl Fn(usize) -> [f64; 2]) -> Vec<Contact> {
    let id = |k: usize| Partner::Grain(GrainId::from_index(k));
    let mut found = Vec::new();
    for (i, j) in pairs() {
        let branch = grains[j].centre - grains[i].centre;
        let share = grains[i].radius / (grains[i].radius + grains[j].radius);
        let point = grains[i].centre + branch * share;
        let offset = place(found.len());
        found.push(contact(id(i), id(j), branch, point, offset));
    }
    let last = GRAINS - ROWS[4]..GRAINS;
    for (k, side, outward) in (0..ROWS[0])
        .map(|k| (k, 0, -1.0))
        .chain(last.map(|k| (k, 1, 1.0)))
    {
        let to_side = Vector::new(0.0, outward * grains[k].radius);
        let point = grains[k].centre + to_side;
        let offset = place(found.len());
        let side = Partner::Side(SideId(side));
        found.push(contact(id(k), side, to_side, point, offset));
    }
    found
}

fn contact(
    first: Partner,
    second: Partner,
    branch: Vector,
    point: Vector,
    offset: [f64; 2],
) -> Contact {
    let normal = branch * (1.0 / branch.length());
    // The dual length of a hexagonal lattice, 2R/√3, and others where the contact point is elsewhere.
    let dual = (2.0 + offset[1]) / 3.0_f64.sqrt();
    Contact {
        first,
        second,
        normal,
        branch_length: branch.length(),
        point: point + normal * offset[0] + normal.quarter_turn() * offset[1],
        // Shorter than the full one, as behind a cap.
        dual_parts: [0.3 * dual, 0.4 * dual],
        dual_length_full: dual,
        property: PropertyId(0),
        strength_factor: 1.0,
    }
}

/// Neighbours on the lattice, the lower id first.
fn pairs() -> Vec<(usize, usize)> {
    let centres: Vec<Vector> = lattice().collect();
    let mut pairs = Vec::new();
    for i in 0..GRAINS {
        for j in i + 1..GRAINS {
            if (centres[j] - centres[i]).length() < 2.1 {
                pairs.push((i, j));
            }
        }
    }
    pairs
}

/// Three neighbours each, counter-clockwise.
fn triangles() -> Vec<[GrainId; 3]> {
    let centres: Vec<Vector> = lattice().collect();
    let pairs = pairs();
    let mut found = Vec::new();
    for &(i, j) in &pairs {
        for k in j + 1..GRAINS {
            if pairs.contains(&(i, k)) && pairs.contains(&(j, k)) {
                let turn = (centres[j] - centres[i]).cross(centres[k] - centres[i]);
                let corners = if turn > 0.0 { [i, j, k] } else { [i, k, j] };
                found.push(corners.map(GrainId::from_index));
            }
        }
    }
    found
}

fn sides() -> Vec<Side> {
    let side = |name: &str, y: f64, outward: f64| Side {
        name: name.into(),
        start: Vector::new(0.0, y),
        end: Vector::new(10.0, y),
        outward: Vector::new(0.0, outward),
        present: true,
    };
    vec![side("bottom", 0.0, -1.0), side("top", 9.0, 1.0)]
}

/// Loads and reactions take a part each of what balances the contact forces.
fn assemble(grains: Vec<Grain>, contacts: Vec<Contact>, state: State, share: f64) -> Block {
    let assembly = Assembly {
        cell_area: vec![2.0 * 3.0_f64.sqrt(); GRAINS].into(),
        grains: grains.into(),
        sides: sides().into(),
        contacts: contacts.into(),
        triangles: triangles(),
        thickness: 1.5,
    };
    let mut balance = PerBody::filled(Load::default(), assembly.body_count());
    for (id, contact) in assembly.contacts.iter() {
        let state = &state.contacts[id];
        if !state.is_active() {
            continue;
        }
        let on_first = force_on_first(contact, state);
        for partner in [contact.first, contact.second] {
            let sign = sign_at(contact, partner).unwrap();
            let lever = contact.point - assembly.reference_point(partner);
            let load = &mut balance[assembly.body(partner)];
            load.x -= sign * on_first.x;
            load.y -= sign * on_first.y;
            load.moment -= sign * (lever.cross(on_first) + state.force.moment);
        }
    }
    let part = |share: f64| {
        balance.map(|load| Load {
            x: share * load.x,
            y: share * load.y,
            moment: share * load.moment,
        })
    };
    Block {
        loads: part(share),
        reactions: part(1.0 - share),
        assembly,
        state,
    }
}

fn sign_at(contact: &Contact, partner: Partner) -> Option<f64> {
    if contact.first == partner {
        Some(1.0)
    } else if contact.second == partner {
        Some(-1.0)
    } else {
        None
    }
}

fn force_on_first(contact: &Contact, state: &ContactState) -> Vector {
    contact.normal * state.force.normal + contact.normal.quarter_turn() * state.force.shear
}

fn active(force: ContactForce) -> ContactState {
    ContactState {
        displacement: kavics::contact_law::RelativeDisplacement::default(),
        force,
        property: Some(PropertyId(0)),
        broken: false,
        phase: Phase::Closed,
    }
}

fn open() -> ContactState {
    ContactState {
        phase: Phase::Open,
        ..active(ContactForce::default())
    }
}

fn moved(x: f64, y: f64, rotation: f64) -> Displacement {
    Displacement { x, y, rotation }
}

fn drift(k: f64) -> Displacement {
    moved(0.01 * k, 0.02 * k * k, 0.03)
}

fn wave(k: f64) -> ContactForce {
    ContactForce {
        normal: libm::sin(k) - 1.0,
        shear: libm::cos(2.0 * k),
        moment: libm::sin(3.0 * k),
    }
}
