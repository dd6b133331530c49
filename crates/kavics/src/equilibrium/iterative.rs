//! Linear systems by iteration: when, with what matrix, how far, and what where it fails.

use rayon::prelude::*;

use super::block_stiffness::NodeOrder;
use super::configuration::Configuration;
use super::kinematics::FREEDOMS;
use super::system::{System, stiffness_of};
use super::{Breakdown, Iteration, SolverChoice};
use crate::ids::Id;
use crate::solver::{BlockSystem, Iterated, IterativeSolver};

/// From this many unknowns on, systems are solved by iteration unless the scene says otherwise.
const MANY: usize = 1_000_000;
/// An iteration is ended below this share of the bound on the residual.
const SHARE: f64 = 0.1;
/// Where the matrix depends on the state, a step need not be better than this.
const STEP: f64 = 1e-4;
/// An iteration has served if it left no more than this share of the residual.
const SERVED: f64 = 1e-3;

/// Contacts that are hashed together.
const CHUNK: usize = 4096;

/// What is kept from one solve by iteration to the next.
pub struct Iterating {
    order: NodeOrder,
    units: Vec<[f64; FREEDOMS]>,
    solver: Option<IterativeSolver<FREEDOMS>>,
    /// Of the matrix that the solver has.
    fingerprint: u64,
    /// Of the matrix that its hierarchy was made for.
    made_for: u64,
}

impl SolverChoice {
    /// Whether linear systems of so many unknowns are solved by iteration.
    pub fn iterates(self, unknowns: usize) -> bool {
        match self {
            Self::Auto => unknowns >= MANY,
            Self::Direct => false,
            Self::Iterative => true,
        }
    }
}

impl System<'_> {
    /// Whether linear systems are solved by iteration.
    pub(super) fn iterates(&self) -> bool {
        self.settings.solver.iterates(self.unknowns()) && self.breakdown.is_none()
    }

    /// Solves in place, the matrix being that of the secant or of the tangent.
    ///
    /// # Errors
    /// Where the iteration fails.
    pub(super) fn solve_by_iteration(
        &mut self,
        configuration: &Configuration,
        iteration: Iteration,
        general: bool,
        right: &mut [f64],
    ) -> Result<(), Breakdown> {
        let mut kept = self.take_iterating();
        // The multigrid is that of a symmetric matrix.
        let symmetric = if general {
            Iteration::Secant
        } else {
            iteration
        };
        self.prepare(&mut kept, configuration, symmetric)?;
        let general =
            general.then(|| self.block_system(&kept.order, configuration, Iteration::Tangent));
        let solved = self.run(&mut kept, configuration, general, right);
        self.iterating = Some(kept);
        solved
    }

    fn take_iterating(&mut self) -> Iterating {
        self.iterating.take().unwrap_or_else(|| {
            let order = self.node_order();
            Iterating {
                units: self.load_units(&order),
                order,
                solver: None,
                fingerprint: 0,
                made_for: 0,
            }
        })
    }

    /// Before a load step: a hierarchy of another stiffness than the present one is dropped, so that what is kept
    /// follows from the point where the load step begins.
    pub fn drop_old_hierarchy(&mut self, configuration: &Configuration) {
        if self.hierarchy(configuration).is_none()
            && let Some(kept) = &mut self.iterating
        {
            kept.solver = None;
        }
    }

    /// Iterations of the solver, if its hierarchy is that of the secants of a configuration.
    pub(super) fn hierarchy(&self, configuration: &Configuration) -> Option<[usize; 2]> {
        let kept = self.iterating.as_ref()?;
        let solver = kept.solver.as_ref()?;
        let present = self.fingerprint(configuration, Iteration::Secant);
        (kept.made_for == present).then(|| solver.counts())
    }

    /// Makes the hierarchy of the secants of a configuration, with the iterations that it has served.
    pub(super) fn make_hierarchy_again(
        &mut self,
        configuration: &Configuration,
        iterations: [usize; 2],
    ) {
        let mut kept = self.take_iterating();
        kept.solver = None;
        let made = self.prepare(&mut kept, configuration, Iteration::Secant);
        if let (Ok(()), Some(solver)) = (made, &mut kept.solver) {
            solver.go_on_counting(iterations);
        }
        self.iterating = Some(kept);
    }

    /// Gives the solver the matrix of a configuration, if it has not got it.
    fn prepare(
        &self,
        kept: &mut Iterating,
        configuration: &Configuration,
        iteration: Iteration,
    ) -> Result<(), Breakdown> {
        let fingerprint = self.fingerprint(configuration, iteration);
        let solver = kept.solver.take().filter(|solver| !solver.is_worn());
        let solver = match solver {
            Some(solver) if fingerprint == kept.fingerprint => Ok(solver),
            Some(mut solver) => {
                let system = self.block_system(&kept.order, configuration, iteration);
                solver.take(system, &kept.units).map(|()| solver)
            }
            None => {
                kept.made_for = fingerprint;
                let system = self.block_system(&kept.order, configuration, iteration);
                IterativeSolver::new(system, &self.rigid_modes(&kept.order), &kept.units)
            }
        };
        kept.solver = Some(solver.map_err(|_| Breakdown::NotPositive)?);
        kept.fingerprint = fingerprint;
        Ok(())
    }

    fn run(
        &self,
        kept: &mut Iterating,
        configuration: &Configuration,
        general: Option<BlockSystem<FREEDOMS>>,
        right: &mut [f64],
    ) -> Result<(), Breakdown> {
        let loads: Vec<[f64; FREEDOMS]> = self.by_nodes(&kept.order, right);
        let bound = self.bound(configuration, &loads, &kept.units);
        let solver = kept.solver.as_mut().ok_or(Breakdown::NotPositive)?;
        let solution = match general {
            Some(system) => solver.solve_general(&system, &loads, bound),
            None => solver.solve(&loads, bound),
        };
        match solution.end {
            Iterated::NegativeCurvature => return Err(Breakdown::NotPositive),
            // Along a floppy mode the iteration may think that it converged.
            _ if solution.gain.is_nan() || solution.gain > SERVED => {
                return Err(Breakdown::Stagnated);
            }
            _ => {}
        }
        for (&body, values) in kept.order.bodies.iter().zip(&solution.x) {
            for (number, &value) in self.numbers(body).iter().zip(values) {
                if let Some(number) = number {
                    right[*number as usize] = value;
                }
            }
        }
        Ok(())
    }

    fn by_nodes(&self, order: &NodeOrder, right: &[f64]) -> Vec<[f64; FREEDOMS]> {
        let bodies = order.bodies.iter();
        bodies
            .map(|&body| {
                self.numbers(body)
                    .map(|number| number.map_or(0.0, |n| right[n as usize]))
            })
            .collect()
    }

    /// Bound on what a solve leaves unbalanced, `[force]`.
    fn bound(
        &self,
        configuration: &Configuration,
        loads: &[[f64; FREEDOMS]],
        units: &[[f64; FREEDOMS]],
    ) -> f64 {
        let bonds = configuration.bonds.values();
        let forces = bonds.iter().map(|b| b.force.normal.hypot(b.force.shear));
        let force = forces.fold(0.0, f64::max);
        let loads = loads.iter().flatten().zip(units.iter().flatten());
        let load = loads.map(|(l, u)| (l * u).abs()).fold(0.0, f64::max);
        let last = SHARE * self.settings.tolerance * force.max(load);
        let changes = |bond| self.has_phases(bond);
        if bonds
            .iter()
            .any(|b| b.stiffness.hardening != 0.0 || changes(b))
        {
            last.max(STEP * load)
        } else {
            last
        }
    }

    /// A number that changes when the matrix does.
    fn fingerprint(&self, configuration: &Configuration, iteration: Iteration) -> u64 {
        let (properties, set_aside) = (self.properties, &self.set_aside);
        let frames = self.frames.par_chunks(CHUNK);
        let chunks = frames.zip(configuration.bonds.values().par_chunks(CHUNK));
        let parts: Vec<u64> = chunks
            .map(|(frames, bonds)| {
                let mut part = Fingerprint::default();
                for (frame, bond) in frames.iter().zip(bonds) {
                    if bond.is_active() && !set_aside[frame.first.index()] {
                        let stiffness = stiffness_of(bond, properties, iteration);
                        let words = stiffness.as_flattened().iter();
                        for value in words {
                            part.add(value.to_bits());
                        }
                    } else {
                        part.add(1);
                    }
                }
                part.0
            })
            .collect();
        let mut whole = Fingerprint::default();
        for part in parts {
            whole.add(part);
        }
        whole.0
    }
}

/// Fowler, Noll & Vo's hash, a word at a time.
struct Fingerprint(u64);

impl Default for Fingerprint {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fingerprint {
    fn add(&mut self, word: u64) {
        // The turn brings the high bits down, where the product does not reach.
        self.0 = (self.0 ^ word)
            .wrapping_mul(0x0000_0100_0000_01b3)
            .rotate_left(29);
    }
}
