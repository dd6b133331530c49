//! The assembly as a system of equations: unknowns, pieces, forces and what they leave unbalanced.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::bond::Bond;
use super::configuration::Configuration;
use super::iterative::Iterating;
use super::kinematics::{ALL_FREEDOMS, ContactFrame, RigidMotion};
use super::side_sums::SideSums;
use super::sparsity::{Numbers, Sparsity};
use super::{Breakdown, Displacement, Freedom, Iteration, Load, Settings, Watch};
use crate::assembly::Assembly;
use crate::contact_law::{ContactForce, Law, Matrix, Property};
use crate::geometry::{Pieces, Vector};
use crate::ids::{BodyId, GrainId, Id, PerBody, PerContact, PerGrain, PerProperty};
use crate::solver::{GeneralSolver, Inertia, SymmetricSolver};

/// Fewer contacts are not worth a task of their own.
const LEAST_TASK: usize = 4096;

/// The assembly as a system of equations, with all that is kept from one equilibrium to the next.
pub struct System<'a> {
    pub assembly: &'a Assembly,
    pub properties: &'a PerProperty<Property>,
    pub settings: Settings,
    pub frames: Vec<ContactFrame>,
    pub(super) numbers: Vec<Numbers>,
    /// Bodies with a held or moved freedom.
    pub anchored: Vec<bool>,
    unknowns: usize,
    pub(super) lower: Option<Sparsity>,
    pub(super) full: Option<Sparsity>,
    pub(super) symmetric: Option<SymmetricSolver>,
    pub(super) general: Option<GeneralSolver>,
    pub(super) iterating: Option<Iterating>,
    /// Why systems are solved directly though they were to be solved by iteration.
    pub breakdown: Option<Breakdown>,
    /// Values that the symmetric factor belongs to, and the signs of its pivots.
    pub(super) factored: Option<(Arc<Vec<f64>>, Inertia)>,
    /// Bodies left out: nothing holds and nothing loads their piece.
    pub set_aside: Vec<bool>,
    /// Largest contact force of any equilibrium so far: below its rounding there is no force.
    pub largest_force: f64,
    /// Largest contact force if only the moved bodies moved, `[force]`.
    pub moved_force: f64,
    /// Set from outside: the search ends with its present iteration.
    pub stop: Option<Arc<AtomicBool>>,
    /// A search has ended so.
    pub stopped: bool,
    /// For who waits.
    pub watch: Arc<Watch>,
}

/// Unbalanced loads and the scale to see them by.
pub struct Imbalance {
    /// External loads plus those of the contacts.
    pub unbalanced: PerBody<Load>,
    /// Largest unbalanced force at a free freedom.
    pub largest: f64,
    /// The body that has it.
    pub at: BodyId,
    /// Largest contact force.
    pub force: f64,
}

impl Imbalance {
    /// Largest unbalanced force over largest contact force; 0 where there is neither.
    pub fn residual(&self, noise: f64) -> f64 {
        if self.force <= noise && self.largest <= noise {
            0.0
        } else {
            self.largest / self.force
        }
    }
}

impl<'a> System<'a> {
    /// The system in which the given freedoms are held or moved.
    pub fn new(
        assembly: &'a Assembly,
        properties: &'a PerProperty<Property>,
        settings: Settings,
        bound: &[(BodyId, Freedom)],
    ) -> Self {
        let frames: Vec<_> = assembly
            .contacts
            .values()
            .par_iter()
            .with_min_len(LEAST_TASK)
            .map(|c| ContactFrame::new(assembly, c))
            .collect();
        let mut free = vec![[true; ALL_FREEDOMS.len()]; assembly.body_count()];
        for &(body, freedom) in bound {
            free[body.index()][freedom.index()] = false;
        }
        let mut next = 0u32;
        let numbers: Vec<Numbers> = free
            .iter()
            .map(|body| {
                body.map(|free| {
                    free.then(|| {
                        next += 1;
                        next - 1
                    })
                })
            })
            .collect();
        Self {
            assembly,
            properties,
            settings,
            anchored: free
                .iter()
                .map(|body| body.iter().any(|free| !free))
                .collect(),
            set_aside: vec![false; assembly.body_count()],
            frames,
            numbers,
            unknowns: next as usize,
            lower: None,
            full: None,
            symmetric: None,
            general: None,
            iterating: None,
            breakdown: None,
            factored: None,
            largest_force: 0.0,
            moved_force: 0.0,
            stop: None,
            stopped: false,
            watch: Arc::default(),
        }
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// Whether the search is to end; what it finds then is no result.
    pub(super) fn ends_here(&mut self) -> bool {
        self.stopped |= is_set(self.stop.as_ref());
        self.stopped
    }

    /// Numbers of the unknowns of a body.
    pub(super) fn numbers(&self, body: BodyId) -> Numbers {
        self.numbers[body.index()]
    }

    /// Whether a freedom is held or moved.
    pub fn is_bound(&self, body: BodyId, freedom: Freedom) -> bool {
        self.numbers[body.index()][freedom.index()].is_none()
    }

    /// Below this a force is rounding.
    pub fn noise(&self) -> f64 {
        // A rigid motion leaves the rounding of its displacements.
        (1e-12 * self.largest_force).max(1e-14 * self.moved_force)
    }

    /// Finds the pieces that nothing holds and nothing loads, and leaves them out; and bodies without contact whose
    /// free freedoms nothing loads. Answers the loose pieces of more than one body.
    pub fn leave_out_loose_pieces(
        &mut self,
        bonds: &PerContact<Bond>,
        loads: &PerBody<Load>,
    ) -> Vec<Vec<BodyId>> {
        let mut touched = vec![false; self.assembly.body_count()];
        let active = self
            .frames
            .iter()
            .zip(bonds.values())
            .filter(|(_, bond)| bond.is_active());
        let active: Vec<&ContactFrame> = active.map(|(frame, _)| frame).collect();
        for frame in &active {
            touched[frame.first.index()] = true;
            touched[frame.second.index()] = true;
        }
        let edges = active.iter().map(|frame| [frame.first.0, frame.second.0]);
        let pieces = Pieces::new(self.assembly.body_count(), edges);
        let wanted = pieces.any(|body| {
            let load = loads.values()[body];
            let pushed = self.at_free_freedoms(BodyId::from_index(body), load) != Load::default();
            pushed || touched[body] && (self.anchored[body] || load != Load::default())
        });
        let mut loose: BTreeMap<usize, Vec<BodyId>> = BTreeMap::new();
        for (body, wanted) in wanted.into_iter().enumerate() {
            self.set_aside[body] = !wanted;
            if !wanted && touched[body] {
                let piece = loose.entry(pieces.of(body)).or_default();
                piece.push(BodyId::from_index(body));
            }
        }
        loose.into_values().collect()
    }

    /// What nothing holds and nothing loads carries no force: each loose piece keeps its place as a whole, and its
    /// contacts go back to where they are at rest.
    pub fn relax(&self, pieces: &[Vec<BodyId>], displacements: &mut PerBody<Displacement>) {
        for piece in pieces {
            let motion = self.rigid_motion(piece, |body| displacements[body]);
            for &body in piece {
                displacements[body] = motion.at(self.place(body));
            }
        }
    }

    /// The rigid motion of a piece that is nearest to the displacements of its bodies.
    pub fn rigid_motion(
        &self,
        piece: &[BodyId],
        displacement: impl Fn(BodyId) -> Displacement,
    ) -> RigidMotion {
        let bodies = piece.iter();
        let bodies =
            bodies.map(|&body| (self.place(body), self.moment_arm(body), displacement(body)));
        RigidMotion::nearest(&bodies.collect::<Vec<_>>())
    }

    /// Reference point of a body.
    pub fn place(&self, body: BodyId) -> Vector {
        self.assembly.reference_point(self.assembly.partner(body))
    }

    /// Grains that nothing holds and nothing loads.
    pub fn loose_grains(&self) -> PerGrain<bool> {
        let grains = 0..self.assembly.grains.len();
        grains
            .map(|grain| self.set_aside[grain] && !self.anchored[grain])
            .collect()
    }

    /// The grains with the largest sizes: at most ten, none below a tenth of the largest.
    pub(super) fn foremost_grains(&self, size: impl Fn(usize) -> f64) -> Vec<GrainId> {
        let mut sizes: Vec<(f64, usize)> = (0..self.assembly.grains.len())
            .map(|grain| (size(grain), grain))
            .collect();
        sizes.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let most = sizes.first().map_or(0.0, |s| s.0);
        let foremost = sizes.iter().take(10).filter(|s| s.0 > 0.1 * most);
        foremost.map(|s| GrainId::from_index(s.1)).collect()
    }

    /// Relative displacement and force of every contact at the present displacements.
    pub fn respond(&self, configuration: &mut Configuration) {
        let Configuration {
            displacements,
            bonds,
        } = configuration;
        let (u, properties) = (&*displacements, self.properties);
        let contacts = self.frames.par_iter().zip(bonds.values_mut());
        contacts.with_min_len(LEAST_TASK).for_each(|(frame, bond)| {
            bond.displacement = frame.relative_displacement(u[frame.first], u[frame.second]);
            bond.force = bond.respond(bond.displacement, properties).force;
        });
    }

    /// What the loads and the contact forces leave unbalanced.
    pub fn imbalance(&self, configuration: &Configuration, loads: &PerBody<Load>) -> Imbalance {
        let forces = configuration.bonds.values().iter().map(|bond| bond.force);
        self.imbalance_of(forces, loads)
    }

    pub(super) fn imbalance_of(
        &self,
        forces: impl Iterator<Item = ContactForce>,
        loads: &PerBody<Load>,
    ) -> Imbalance {
        let mut unbalanced = loads.clone();
        let mut force: f64 = 0.0;
        let mut sides = SideSums::new(self.assembly);
        for (frame, q) in self.frames.iter().zip(forces) {
            let [first, second] = frame.loads(q);
            unbalanced[frame.first] += first;
            sides.add(frame.second, &mut unbalanced[frame.second], second);
            force = force.max(q.normal.hypot(q.shear));
        }
        for (side, load) in sides.cut_off() {
            unbalanced[side] += load;
        }
        let (mut largest, mut at) = (0.0, BodyId(0));
        for body in unbalanced.ids() {
            let here = self
                .free_part(body, unbalanced[body])
                .largest_force(self.moment_arm(body));
            // A sum that is not a number must not pass for balance.
            if here > largest || here.is_nan() {
                (largest, at) = (here, body);
            }
        }
        Imbalance {
            unbalanced,
            largest,
            at,
            force,
        }
    }

    pub(super) fn moment_arm(&self, body: BodyId) -> f64 {
        self.assembly.moment_arm(self.assembly.partner(body))
    }

    /// The components of a load at freedoms that are unknown; none of a body that is set aside.
    pub(super) fn free_part(&self, body: BodyId, load: Load) -> Load {
        if self.set_aside[body.index()] {
            Load::default()
        } else {
            self.at_free_freedoms(body, load)
        }
    }

    /// The largest force of a load at unknown freedoms.
    pub fn free_size(&self, body: BodyId, load: Load) -> f64 {
        self.free_part(body, load)
            .largest_force(self.moment_arm(body))
    }

    fn at_free_freedoms(&self, body: BodyId, load: Load) -> Load {
        let mut components = load.components();
        for (component, number) in components.iter_mut().zip(&self.numbers[body.index()]) {
            if number.is_none() {
                *component = 0.0;
            }
        }
        Load::from_components(components)
    }

    pub(super) fn stiffness_of(&self, bond: &Bond, iteration: Iteration) -> Matrix {
        stiffness_of(bond, self.properties, iteration)
    }

    /// Whether a contact opens, closes, sticks and slides.
    pub(super) fn has_phases(&self, bond: &Bond) -> bool {
        bond.law(self.properties).is_some_and(Law::has_phases)
    }

    /// Whether any contact does.
    pub(crate) fn any_phases(&self, configuration: &Configuration) -> bool {
        configuration
            .bonds
            .values()
            .iter()
            .any(|bond| self.has_phases(bond))
    }
}

/// Whether somebody wants the search to end.
pub fn is_set(stop: Option<&Arc<AtomicBool>>) -> bool {
    stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
}

/// The secant or the tangent of a contact.
pub(super) fn stiffness_of(
    bond: &Bond,
    properties: &PerProperty<Property>,
    iteration: Iteration,
) -> Matrix {
    let response = bond.respond(bond.displacement, properties);
    match iteration {
        Iteration::Secant => response.secant,
        Iteration::Tangent => response.tangent,
    }
}
