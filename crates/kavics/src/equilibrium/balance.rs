//! Balance of forces while every contact keeps its phase: Newton iteration on the assembled stiffness.

use super::bond::Bond;
use super::direct::{GeneralSolver, Singular, SymmetricSolver};
use super::kinematics::{ALL_FREEDOMS, ContactFrame};
use super::pieces::Pieces;
use super::sparsity::{Numbers, Sparsity, Stored};
use super::{Displacement, Freedom, Iterate, Iteration, Load, Settings, SolveError, State};
use crate::assembly::{Assembly, Partner};
use crate::contact_law::{ContactForce, Law, Matrix, Property, RelativeDisplacement};
use crate::ids::{BodyId, ContactId, GrainId, Id, PerBody, PerContact, PerProperty};

/// What acts on the assembly.
#[derive(Clone, Debug, Default)]
pub struct Action {
    /// External load on each body.
    pub loads: PerBody<Load>,
    /// Values of the moved freedoms.
    pub moved: Vec<(BodyId, Freedom, f64)>,
}

/// Displacements and bonds, and how well they balance.
#[derive(Clone, Debug, Default)]
pub struct Configuration {
    /// Displacement of each body.
    pub displacements: PerBody<Displacement>,
    /// Each contact.
    pub bonds: PerContact<Bond>,
}

impl Configuration {
    /// As a result.
    pub fn state(&self) -> State {
        State {
            displacements: self.displacements.clone(),
            contacts: self.bonds.map(Bond::state),
        }
    }
}

/// Why a configuration does not balance; the load path adds load step and factor.
#[derive(Clone, Debug)]
pub enum Failure {
    /// The iteration did not settle.
    NotConverged {
        /// Linear solves.
        iterations: usize,
        /// Last residual.
        residual: f64,
        /// Body with the largest unbalanced force.
        at: BodyId,
    },
    /// Loads move grains that nothing holds.
    Mechanism {
        /// Those that move most.
        grains: Vec<GrainId>,
    },
    /// Contacts change phase without end.
    Chatter {
        /// Which.
        contacts: Vec<ContactId>,
    },
    /// The shear modulus of a contact is not positive.
    ShearLost {
        /// Which.
        contact: ContactId,
    },
}

impl Failure {
    /// With load step and factor, as the user sees it.
    pub fn at(
        self,
        step: usize,
        load_factor: f64,
        assembly: &Assembly,
        tolerance: f64,
    ) -> SolveError {
        match self {
            Self::NotConverged {
                iterations,
                residual,
                at,
            } => SolveError::NotConverged {
                step,
                load_factor,
                iterations,
                residual,
                tolerance,
                at: match assembly.partner(at) {
                    Partner::Grain(grain) => format!("grain {grain}"),
                    Partner::Side(side) => format!("side {}", assembly.sides[side].name),
                },
            },
            Self::Mechanism { grains } => SolveError::Mechanism {
                step,
                load_factor,
                grains,
            },
            Self::Chatter { contacts } => SolveError::Chatter {
                step,
                load_factor,
                contacts,
            },
            Self::ShearLost { contact } => SolveError::ShearLost {
                step,
                load_factor,
                contact,
            },
        }
    }
}

/// How an iteration with fixed phases ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settled {
    /// In balance.
    Balanced,
    /// A mechanism: the configuration was moved along it by a proximal step.
    Drifting,
}

/// Counts of one search for equilibrium.
#[derive(Clone, Debug, Default)]
pub struct Progress {
    /// Linear solves.
    pub iterations: usize,
    /// Last residual.
    pub residual: f64,
    /// Floppy modes held in the last factorisation.
    pub held_pivots: usize,
    /// The way, when asked for.
    pub iterates: Vec<Iterate>,
}

/// Linear solves with one set of phases before the iteration is given up.
const MOST_ITERATIONS: usize = 400;
/// A secant iteration that falls slower than this goes on with the tangent.
const SLOW: f64 = 0.7;
/// From this many unknowns on, a factor is kept while the residual falls faster than [`LAG`].
const LARGE: usize = 10_000;
const LAG: f64 = 0.3;
/// Weight of the proximal term that carries over a mechanism, as a share of the diagonal.
const PROXIMAL: f64 = 1e-6;

/// The assembly as a system of equations, with all that is kept from one equilibrium to the next.
pub struct System<'a> {
    pub assembly: &'a Assembly,
    pub properties: &'a PerProperty<Property>,
    pub settings: Settings,
    pub frames: Vec<ContactFrame>,
    numbers: Vec<Numbers>,
    /// Bodies with a held or moved freedom.
    pub anchored: Vec<bool>,
    lower: Sparsity,
    full: Option<Sparsity>,
    symmetric: Option<SymmetricSolver>,
    general: Option<GeneralSolver>,
    /// Values that the symmetric factor belongs to, and how many floppy modes it holds.
    factored: Option<(Vec<f64>, usize)>,
    /// Bodies left out: nothing holds and nothing loads their piece.
    pub set_aside: Vec<bool>,
    /// Largest contact force of any equilibrium so far: below its rounding there is no force.
    pub largest_force: f64,
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
            .iter()
            .map(|c| ContactFrame::new(assembly, c))
            .collect();
        let mut free = vec![[true; ALL_FREEDOMS.len()]; assembly.body_count()];
        for &(body, freedom) in bound {
            free[body.index()][freedom.index()] = false;
        }
        let mut next = 0;
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
        let lower = Sparsity::new(&numbers, &frames, Stored::Lower);
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
            lower,
            full: None,
            symmetric: None,
            general: None,
            factored: None,
            largest_force: 0.0,
        }
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.lower.order()
    }

    /// Whether a freedom is held or moved.
    pub fn is_bound(&self, body: BodyId, freedom: Freedom) -> bool {
        self.numbers[body.index()][freedom.index()].is_none()
    }

    /// Below this a force is rounding.
    pub fn noise(&self) -> f64 {
        1e-12 * self.largest_force
    }

    /// Finds the pieces that nothing holds and nothing loads, and leaves them out.
    pub fn leave_out_loose_pieces(&mut self, bonds: &PerContact<Bond>, loads: &PerBody<Load>) {
        let active = self
            .frames
            .iter()
            .zip(bonds.values())
            .filter(|(_, bond)| bond.is_active())
            .map(|(f, _)| f);
        let pieces = Pieces::new(self.assembly.body_count(), active);
        let wanted =
            pieces.any(|body| self.anchored[body] || loads.values()[body] != Load::default());
        for (set_aside, wanted) in self.set_aside.iter_mut().zip(wanted) {
            *set_aside = !wanted;
        }
    }

    /// Relative displacement and force of every contact at the present displacements.
    pub fn respond(&self, configuration: &mut Configuration) {
        let Configuration {
            displacements,
            bonds,
        } = configuration;
        for (frame, bond) in self.frames.iter().zip(bonds.values_mut()) {
            bond.displacement = frame
                .relative_displacement(displacements[frame.first], displacements[frame.second]);
            bond.force = bond.respond(bond.displacement, self.properties).force;
        }
    }

    /// What the loads and the contact forces leave unbalanced.
    pub fn imbalance(&self, configuration: &Configuration, loads: &PerBody<Load>) -> Imbalance {
        let forces = configuration.bonds.values().iter().map(|bond| bond.force);
        self.imbalance_of(forces, loads)
    }

    fn imbalance_of(
        &self,
        forces: impl Iterator<Item = ContactForce>,
        loads: &PerBody<Load>,
    ) -> Imbalance {
        let mut unbalanced = loads.clone();
        let mut force: f64 = 0.0;
        for (frame, q) in self.frames.iter().zip(forces) {
            let [first, second] = frame.loads(q);
            unbalanced[frame.first] += first;
            unbalanced[frame.second] += second;
            force = force.max(q.normal.hypot(q.shear));
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

    fn moment_arm(&self, body: BodyId) -> f64 {
        self.assembly.moment_arm(self.assembly.partner(body))
    }

    /// The components of a load at freedoms that are unknown.
    fn free_part(&self, body: BodyId, load: Load) -> Load {
        if self.set_aside[body.index()] {
            return Load::default();
        }
        let mut components = load.components();
        for (component, number) in components.iter_mut().zip(&self.numbers[body.index()]) {
            if number.is_none() {
                *component = 0.0;
            }
        }
        Load::from_components(components)
    }

    /// Brings the moved freedoms to their values; the loads that the move causes at the other freedoms are those
    /// of the linear contacts, and the first linear solve answers them.
    fn predict(&self, configuration: &mut Configuration, action: &Action) -> PerBody<Load> {
        self.respond(configuration);
        for &(body, freedom, value) in &action.moved {
            *configuration.displacements[body].component_mut(freedom) = value;
        }
        let u = &configuration.displacements;
        let forces = self
            .frames
            .iter()
            .zip(configuration.bonds.values())
            .map(|(frame, bond)| {
                let v = frame.relative_displacement(u[frame.first], u[frame.second]);
                linear_force(bond, v, &self.stiffness_of(bond, Iteration::Secant))
            });
        self.imbalance_of(forces, &action.loads).unbalanced
    }

    fn stiffness_of(&self, bond: &Bond, iteration: Iteration) -> Matrix {
        let response = bond.respond(bond.displacement, self.properties);
        match iteration {
            Iteration::Secant => response.secant,
            Iteration::Tangent => response.tangent,
        }
    }

    /// Iterates to balance with every contact in its phase. `moves`: the moved freedoms are not yet at their values.
    ///
    /// # Errors
    /// Where the iteration does not settle.
    pub fn settle(
        &mut self,
        configuration: &mut Configuration,
        action: &Action,
        moves: bool,
        progress: &mut Progress,
    ) -> Result<Settled, Failure> {
        let mut iteration = self.settings.iteration;
        let mut history = History::default();
        if moves {
            let unbalanced = self.predict(configuration, action);
            if let Ok(step) =
                self.solve(configuration, &unbalanced, Iteration::Secant, 0.0, progress)
            {
                self.advance(configuration, &step);
            }
        }
        let start = configuration.displacements.clone();
        loop {
            self.respond(configuration);
            let imbalance = self.imbalance(configuration, &action.loads);
            progress.residual = imbalance.residual(self.noise());
            self.keep_iterate(configuration, progress);
            if progress.residual <= self.settings.tolerance {
                if self.is_rounding(&imbalance, action) {
                    self.try_undeformed(configuration, action);
                }
                return Ok(Settled::Balanced);
            }
            let falls = history.push(imbalance.largest);
            let hopeless = history.len() > MOST_ITERATIONS
                || !imbalance.largest.is_finite()
                || iteration == Iteration::Tangent && history.is_hopeless();
            let floppy = progress.held_pivots > 0 && history.len() > 1 && falls > SLOW;
            if hopeless || floppy {
                if hopeless && !self.has_phases(configuration) {
                    return Err(not_converged(progress, &imbalance));
                }
                configuration.displacements = start;
                let iteration = if floppy { Iteration::Secant } else { iteration };
                return self.drift(configuration, action, iteration, progress);
            }
            if falls > SLOW && history.len() > 3 {
                iteration = Iteration::Tangent;
            }
            if falls > LAG {
                self.factored = None;
            }
            match self.solve(
                configuration,
                &imbalance.unbalanced,
                iteration,
                0.0,
                progress,
            ) {
                Ok(step) => self.advance(configuration, &step),
                Err(_) if !self.has_phases(configuration) => {
                    return Err(not_converged(progress, &imbalance));
                }
                Err(_) => {
                    configuration.displacements = start;
                    return self.drift(configuration, action, iteration, progress);
                }
            }
        }
    }

    /// Whether nothing acts and what is left of the forces is rounding.
    fn is_rounding(&self, imbalance: &Imbalance, action: &Action) -> bool {
        imbalance.force > 0.0
            && imbalance.force <= self.noise()
            && action
                .loads
                .values()
                .iter()
                .all(|load| *load == Load::default())
            && action.moved.iter().all(|moved| moved.2 == 0.0)
    }

    /// Where nothing acts any more, the undeformed assembly is the equilibrium that rounding stands for, if it is one.
    fn try_undeformed(&self, configuration: &mut Configuration, action: &Action) {
        let mut undeformed = configuration.clone();
        for (body, set_aside) in self.set_aside.iter().enumerate() {
            if !set_aside {
                undeformed.displacements[BodyId::from_index(body)] = Displacement::default();
            }
        }
        self.respond(&mut undeformed);
        let imbalance = self.imbalance(&undeformed, &action.loads);
        if imbalance.largest == 0.0 && imbalance.force == 0.0 {
            *configuration = undeformed;
        }
    }

    fn keep_iterate(&self, configuration: &Configuration, progress: &mut Progress) {
        if self.settings.keep_iterates && progress.iterations > 0 {
            let (iteration, residual) = (progress.iterations, progress.residual);
            progress.iterates.push(Iterate {
                iteration,
                residual,
                state: configuration.state(),
            });
        }
    }

    /// A proximal step along a mechanism that the loads move.
    fn drift(
        &mut self,
        configuration: &mut Configuration,
        action: &Action,
        iteration: Iteration,
        progress: &mut Progress,
    ) -> Result<Settled, Failure> {
        self.respond(configuration);
        let imbalance = self.imbalance(configuration, &action.loads);
        // A tangent may be singular even so; the secant is not.
        let step = self
            .solve(
                configuration,
                &imbalance.unbalanced,
                iteration,
                PROXIMAL,
                progress,
            )
            .or_else(|_| {
                self.solve(
                    configuration,
                    &imbalance.unbalanced,
                    Iteration::Secant,
                    PROXIMAL,
                    progress,
                )
            })
            .map_err(|_| not_converged(progress, &imbalance))?;
        if !self.has_phases(configuration) {
            return Err(Failure::Mechanism {
                grains: self.moving(&step),
            });
        }
        self.advance(configuration, &step);
        self.respond(configuration);
        Ok(Settled::Drifting)
    }

    fn has_phases(&self, configuration: &Configuration) -> bool {
        configuration
            .bonds
            .values()
            .iter()
            .any(|bond| bond.law(self.properties).is_some_and(Law::has_phases))
    }

    /// The grains that a step moves most, at most ten.
    pub fn moving(&self, step: &[f64]) -> Vec<GrainId> {
        let grains = self.assembly.grains.len();
        let size = |body: usize| {
            let arm = self.moment_arm(BodyId::from_index(body));
            let component =
                |freedom: usize| self.numbers[body][freedom].map_or(0.0, |n| step[n as usize]);
            component(0)
                .hypot(component(1))
                .max(component(2).abs() * arm)
        };
        let mut sizes: Vec<(f64, usize)> = (0..grains).map(|grain| (size(grain), grain)).collect();
        sizes.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let most = sizes.first().map_or(0.0, |s| s.0);
        sizes
            .iter()
            .take(10)
            .filter(|s| s.0 > 0.1 * most)
            .map(|s| GrainId::from_index(s.1))
            .collect()
    }

    fn advance(&self, configuration: &mut Configuration, step: &[f64]) {
        for (body, numbers) in self.numbers.iter().enumerate() {
            if self.set_aside[body] {
                continue;
            }
            let u = &mut configuration.displacements[BodyId::from_index(body)];
            for (freedom, number) in ALL_FREEDOMS.into_iter().zip(numbers) {
                if let Some(number) = number {
                    *u.component_mut(freedom) += step[*number as usize];
                }
            }
        }
    }

    /// One linear solve: the step that the iteration matrix answers the unbalanced loads with.
    fn solve(
        &mut self,
        configuration: &Configuration,
        unbalanced: &PerBody<Load>,
        iteration: Iteration,
        proximal: f64,
        progress: &mut Progress,
    ) -> Result<Vec<f64>, Singular> {
        let mut right = vec![0.0; self.unknowns()];
        for body in unbalanced.ids() {
            let load = self.free_part(body, unbalanced[body]).components();
            for (value, number) in load.into_iter().zip(&self.numbers[body.index()]) {
                if let Some(number) = number {
                    right[*number as usize] = value;
                }
            }
        }
        progress.iterations += 1;
        if right.is_empty() {
            return Ok(right);
        }
        let general = iteration == Iteration::Tangent && self.is_unsymmetric(configuration);
        let solved = if general {
            self.solve_general(configuration, proximal, &mut right)
        } else {
            self.solve_symmetric(configuration, iteration, proximal, &mut right, progress)
        };
        match solved {
            Ok(()) if right.iter().all(|value| value.is_finite()) => Ok(right),
            _ => Err(Singular),
        }
    }

    fn is_unsymmetric(&self, configuration: &Configuration) -> bool {
        configuration.bonds.values().iter().any(|bond| {
            let tangent = self.stiffness_of(bond, Iteration::Tangent);
            tangent[0][1] != tangent[1][0]
                || tangent[0][2] != tangent[2][0]
                || tangent[1][2] != tangent[2][1]
        })
    }

    fn solve_symmetric(
        &mut self,
        configuration: &Configuration,
        iteration: Iteration,
        proximal: f64,
        right: &mut [f64],
        progress: &mut Progress,
    ) -> Result<(), Singular> {
        if self.symmetric.is_none() {
            self.symmetric = Some(SymmetricSolver::new(&self.lower)?);
        }
        let lagging = self.unknowns() >= LARGE && self.factored.is_some() && proximal == 0.0;
        if !lagging {
            let values = self.values(configuration, iteration, proximal, &self.lower);
            if self.factored.as_ref().is_none_or(|(old, _)| *old != values) {
                let solver = self.symmetric.as_mut().ok_or(Singular)?;
                let held = solver.factorise(&self.lower, &values)?;
                self.factored = Some((values, held));
            }
        }
        progress.held_pivots = self.factored.as_ref().map_or(0, |(_, held)| *held);
        self.symmetric.as_mut().ok_or(Singular)?.solve(right);
        if proximal > 0.0 {
            self.factored = None;
        }
        Ok(())
    }

    fn solve_general(
        &mut self,
        configuration: &Configuration,
        proximal: f64,
        right: &mut [f64],
    ) -> Result<(), Singular> {
        let full = match self.full.take() {
            Some(full) => full,
            None => Sparsity::new(&self.numbers, &self.frames, Stored::Full),
        };
        if self.general.is_none() {
            self.general = Some(GeneralSolver::new(&full)?);
        }
        let values = self.values(configuration, Iteration::Tangent, proximal, &full);
        let solver = self.general.as_mut().ok_or(Singular)?;
        let factorised = solver.factorise(&full, &values);
        self.full = Some(full);
        factorised?;
        solver.solve(right);
        Ok(())
    }

    /// The stiffness of the assembly; 1 on the diagonal of what is set aside.
    fn values(
        &self,
        configuration: &Configuration,
        iteration: Iteration,
        proximal: f64,
        sparsity: &Sparsity,
    ) -> Vec<f64> {
        let mut values = vec![0.0; sparsity.row.len()];
        for (contact, (frame, bond)) in self
            .frames
            .iter()
            .zip(configuration.bonds.values())
            .enumerate()
        {
            if bond.is_active() && !self.set_aside[frame.first.index()] {
                let k = self.stiffness_of(bond, iteration);
                sparsity.add(
                    &mut values,
                    contact,
                    frame,
                    &self.numbers,
                    &frame.stiffness(&k),
                );
            }
        }
        for (body, numbers) in self.numbers.iter().enumerate() {
            for number in numbers.iter().flatten() {
                let diagonal = sparsity.diagonal(*number as usize);
                if self.set_aside[body] {
                    values[diagonal] = 1.0;
                } else if proximal > 0.0 {
                    values[diagonal] += proximal * self.closed_stiffness(configuration);
                }
            }
        }
        values
    }

    /// A stiffness that every freedom would have if its contacts were closed: the mean normal stiffness.
    fn closed_stiffness(&self, configuration: &Configuration) -> f64 {
        let bonds = configuration.bonds.values();
        bonds.iter().map(|bond| bond.stiffness.normal).sum::<f64>() / bonds.len().max(1) as f64
    }
}

fn linear_force(bond: &Bond, v: RelativeDisplacement, k: &Matrix) -> ContactForce {
    let step = [
        v.normal - bond.displacement.normal,
        v.shear - bond.displacement.shear,
        v.rotation - bond.displacement.rotation,
    ];
    let change = k.map(|row| row[0] * step[0] + row[1] * step[1] + row[2] * step[2]);
    ContactForce {
        normal: bond.force.normal + change[0],
        shear: bond.force.shear + change[1],
        moment: bond.force.moment + change[2],
    }
}

fn not_converged(progress: &Progress, imbalance: &Imbalance) -> Failure {
    Failure::NotConverged {
        iterations: progress.iterations,
        residual: progress.residual,
        at: imbalance.at,
    }
}

/// Largest unbalanced forces of an iteration.
#[derive(Default)]
struct History {
    largest: Vec<f64>,
}

impl History {
    /// Adds one; answers by which factor it fell (at first 0).
    fn push(&mut self, largest: f64) -> f64 {
        let before = self.largest.last().copied();
        self.largest.push(largest);
        before.map_or(0.0, |before| largest / before)
    }

    fn len(&self) -> usize {
        self.largest.len()
    }

    /// No better than twelve iterations ago.
    fn is_hopeless(&self) -> bool {
        let n = self.largest.len();
        n > 12 && self.largest[n - 1] > 0.5 * self.largest[n - 13]
    }
}
