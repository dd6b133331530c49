//! The assembly as an elastic network: answers of its factorised stiffness, two at a time, and changes of the factor
//! where a contact goes.
//!
//! A quantity that is linear in a factor x, a + x·b, is the pair `[a, b]`.

use super::Displacement;
use super::configuration::Configuration;
use super::kinematics::{ALL_FREEDOMS, FREEDOMS};
use super::system::System;
use super::{Iteration, Load};
use crate::contact_law::ContactForce;
use crate::ids::{BodyId, ContactId, Id};
use crate::solver::{Singular, SymmetricSolver};

/// Rows of a sparse right-hand side: number of the unknown, values.
pub type Entries<const R: usize> = Vec<(usize, [f64; R])>;

impl System<'_> {
    /// Factorises the stiffness of the bonds as they are; answers how many floppy modes are held.
    ///
    /// # Errors
    /// Where there is no factor, not even with floppy modes held.
    pub fn factorise_bonds(&mut self, configuration: &Configuration) -> Result<usize, Singular> {
        if self.unknowns() == 0 {
            return Ok(0);
        }
        self.factored = None;
        if self.symmetric.is_none() {
            self.symmetric = Some(SymmetricSolver::new(&self.lower.pattern)?);
        }
        let values = self.values(configuration, Iteration::Secant, 0.0, &self.lower);
        let solver = self.symmetric.as_mut().ok_or(Singular)?;
        solver.factorise(&self.lower.pattern, &values)
    }

    /// Answers to two sets of loads, by unknown.
    pub fn answer(&mut self, unbalanced: &[[Load; 2]]) -> Vec<[f64; 2]> {
        let mut right = vec![[0.0; 2]; self.unknowns()];
        for (body, loads) in unbalanced.iter().enumerate() {
            let parts = loads.map(|load| self.free_part(BodyId::from_index(body), load));
            let parts = parts.map(Load::components);
            for (freedom, number) in self.numbers[body].iter().enumerate() {
                if let Some(number) = number {
                    right[*number as usize] = parts.map(|part| part[freedom]);
                }
            }
        }
        self.solve_pair(&mut right);
        right
    }

    /// Answers to what given forces of contacts do to their bodies.
    pub fn answer_entries(&mut self, entries: &Entries<2>) -> Vec<[f64; 2]> {
        let mut right = vec![[0.0; 2]; self.unknowns()];
        for (number, values) in entries {
            for (sum, value) in right[*number].iter_mut().zip(values) {
                *sum += value;
            }
        }
        self.solve_pair(&mut right);
        right
    }

    fn solve_pair(&mut self, right: &mut [[f64; 2]]) {
        let Some(solver) = self.symmetric.as_mut() else {
            return;
        };
        for side in 0..2 {
            let mut x: Vec<f64> = right.iter().map(|pair| pair[side]).collect();
            solver.solve(&mut x);
            for (pair, value) in right.iter_mut().zip(x) {
                pair[side] = value;
            }
        }
    }

    /// Bᵀ·Q of a contact at the unknowns: the loads that its bodies need to bear the forces `q`.
    pub fn entries<const R: usize>(
        &self,
        contact: ContactId,
        q: [ContactForce; R],
        entries: &mut Entries<R>,
    ) {
        let frame = &self.frames[contact.index()];
        let loads = q.map(|force| frame.loads(force).map(Load::components));
        for (end, body) in [frame.first, frame.second].into_iter().enumerate() {
            if self.set_aside[body.index()] {
                continue;
            }
            for (freedom, number) in self.numbers[body.index()].iter().enumerate() {
                if let Some(number) = number {
                    let row = loads.map(|ends| -ends[end][freedom]);
                    entries.push((*number as usize, row));
                }
            }
        }
    }

    /// Takes BᵀLLᵀB of a contact out of the factor, L given by its columns. False: the factor stays as it is, as
    /// the rest would not hold, or the change cannot be made in place.
    pub fn take_out(&mut self, _contact: ContactId, _columns: [ContactForce; FREEDOMS]) -> bool {
        false
    }

    /// Adds the answers to the displacements; nothing that is set aside moves.
    pub fn add_answer(&self, displacements: &mut [[Displacement; 2]], answer: &[[f64; 2]]) {
        for (body, numbers) in self.numbers.iter().enumerate() {
            if self.set_aside[body] {
                continue;
            }
            for (freedom, number) in ALL_FREEDOMS.into_iter().zip(numbers) {
                if let Some(number) = number {
                    let step = answer[*number as usize];
                    for (u, step) in displacements[body].iter_mut().zip(step) {
                        *u.component_mut(freedom) += step;
                    }
                }
            }
        }
    }
}
