//! The assembly as an elastic network: answers of its factorised stiffness, two at a time, and changes of the factor
//! where a contact goes.
//!
//! A quantity that is linear in a factor x, a + x·b, is the pair `[a, b]`.

use super::Displacement;
use super::configuration::Configuration;
use super::kinematics::{ALL_FREEDOMS, Block, FREEDOMS};
use super::sparsity::Sparsity;
use super::system::System;
use super::{Iteration, Load};
use crate::contact_law::ContactForce;
use crate::ids::{BodyId, ContactId, Id};
use crate::solver::Singular;

/// Without a contact that leaves 1 − kC no larger than this the factor is better made anew.
const HARDLY_HELD: f64 = 1e-6;

/// Rows of a sparse right-hand side: number of the unknown, values.
pub type Entries<const R: usize> = Vec<(usize, [f64; R])>;

impl System<'_> {
    /// Factorises the stiffness of the bonds as they are; answers how many floppy modes are held.
    ///
    /// # Errors
    /// Where there is no factor, not even with floppy modes held.
    pub fn factorise_bonds(&mut self, configuration: &Configuration) -> Result<usize, Singular> {
        // The factor will be changed in place: no iteration may take it for that of its values.
        self.factored = None;
        if self.unknowns() == 0 {
            return Ok(0);
        }
        let lower = self.take_lower();
        let held = self.factorise_lower(&lower, configuration);
        self.lower = Some(lower);
        held
    }

    fn factorise_lower(
        &mut self,
        lower: &Sparsity,
        configuration: &Configuration,
    ) -> Result<usize, Singular> {
        self.make_symmetric_solver(lower)?;
        let values = self.values(configuration, Iteration::Secant, 0.0, lower);
        let solver = self.symmetric.as_mut().ok_or(Singular)?;
        Ok(solver.factorise(&lower.pattern, &values)?.held)
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
        if let Some(solver) = self.symmetric.as_mut() {
            solver.solve_many(&mut right);
        }
        right
    }

    /// Answers to what given forces of contacts do to their bodies, by unknown.
    pub fn answer_entries<const R: usize>(
        &mut self,
        entries: &Entries<R>,
        answer: &mut Vec<[f64; R]>,
    ) {
        answer.resize(self.unknowns(), [0.0; R]);
        if let Some(solver) = self.symmetric.as_mut() {
            solver.solve_sparse(entries, answer);
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

    /// Takes BᵀLLᵀB of a contact out of the factor, L given by its columns. False, with the factor as it was or lost:
    /// what is left would hardly hold, or the change cannot be made in place.
    pub fn take_out(&mut self, contact: ContactId, columns: [ContactForce; FREEDOMS]) -> bool {
        let mut entries = Entries::new();
        self.entries(contact, columns, &mut entries);
        let Some(solver) = self.symmetric.as_mut() else {
            return entries.is_empty();
        };
        entries.is_empty()
            || holds_without(solver.flexibility(&entries)) && solver.remove(&entries).is_ok()
    }

    /// Adds the answers to the displacements, a single one to the part that varies; nothing that is set aside moves.
    pub fn add_answer<const R: usize>(
        &self,
        displacements: &mut [[Displacement; 2]],
        answer: &[[f64; R]],
    ) {
        for (body, numbers) in self.numbers.iter().enumerate() {
            if self.set_aside[body] {
                continue;
            }
            for (freedom, number) in ALL_FREEDOMS.into_iter().zip(numbers) {
                if let Some(number) = number {
                    let step = answer[*number as usize];
                    for (u, step) in displacements[body][2 - R..].iter_mut().zip(step) {
                        *u.component_mut(freedom) += step;
                    }
                }
            }
        }
    }
}

/// Whether an assembly holds well without a contact of which F = Lᵀ·C·L, C its flexibility in the assembly: whether the
/// eigenvalues of F, those of k·C, stay below 1. At 1 what is left is a mechanism.
fn holds_without(flexibility: Block) -> bool {
    let mut rest = flexibility.map(|row| row.map(|value| -value));
    for (place, row) in rest.iter_mut().enumerate() {
        row[place] += 1.0;
    }
    for pivot in 0..FREEDOMS {
        let own = rest[pivot];
        // A value that is not a number must not pass.
        if own[pivot].is_nan() || own[pivot] < HARDLY_HELD {
            return false;
        }
        for row in &mut rest[pivot + 1..] {
            let factor = row[pivot] / own[pivot];
            for (value, above) in row.iter_mut().zip(own) {
                *value -= factor * above;
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_eigenvalue_of_one_is_a_mechanism() {
        // Eigenvalues 1, 0.5 and 0.2: ½·(1 ± ½) off the diagonal in the first two components.
        let critical = [[0.75, 0.25, 0.0], [0.25, 0.75, 0.0], [0.0, 0.0, 0.2]];
        let held = critical.map(|row| row.map(|value| 0.99 * value));
        assert!(!holds_without(critical));
        assert!(holds_without(held));
    }
}
