//! The linear systems: assembly of the stiffness, choice of the solver.

use std::sync::Arc;

use super::Iteration;
use super::Load;
use super::configuration::{Configuration, Progress};
use super::sparsity::{Sparsity, Stored};
use super::system::System;
use super::tangent::weights;
use crate::ids::{Id, PerBody};
use crate::solver::{GeneralSolver, Singular, SymmetricSolver};

/// From this many unknowns on, a factor is kept until the iteration drops it.
pub(super) const LARGE: usize = 10_000;

impl System<'_> {
    /// One linear solve: the step that the iteration matrix answers the unbalanced loads with.
    pub(super) fn solve(
        &mut self,
        configuration: &Configuration,
        unbalanced: &PerBody<Load>,
        iteration: Iteration,
        proximal: f64,
        progress: &mut Progress,
    ) -> Result<Vec<f64>, Singular> {
        let mut right = self.right_side(unbalanced);
        progress.iterations += 1;
        if right.is_empty() {
            return Ok(right);
        }
        let general = iteration == Iteration::Tangent && self.is_unsymmetric(configuration);
        // A proximal step is asked for where the matrix is singular or nearly so.
        if proximal == 0.0 && self.iterates() {
            progress.held_pivots = 0;
            match self.solve_by_iteration(configuration, iteration, general, &mut right) {
                Ok(()) => {
                    progress.uncounted = true;
                    return Ok(right);
                }
                Err(breakdown) => self.breakdown = Some(breakdown),
            }
        }
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

    /// Two right sides with one iteration matrix: the steps that answer `unbalanced` and `other`.
    pub(super) fn solve_pair(
        &mut self,
        configuration: &Configuration,
        [unbalanced, other]: [&PerBody<Load>; 2],
        iteration: Iteration,
        progress: &mut Progress,
    ) -> Result<[Vec<f64>; 2], Singular> {
        // A factor of an earlier matrix would not do for both.
        self.factored = None;
        let first = self.solve(configuration, unbalanced, iteration, 0.0, progress)?;
        let mut second = self.right_side(other);
        if second.is_empty() {
            return Ok([first, second]);
        }
        let general = iteration == Iteration::Tangent && self.is_unsymmetric(configuration);
        if general {
            self.general.as_ref().ok_or(Singular)?.solve(&mut second);
        } else {
            self.symmetric.as_mut().ok_or(Singular)?.solve(&mut second);
        }
        let finite = second.iter().all(|value| value.is_finite());
        finite.then_some([first, second]).ok_or(Singular)
    }

    fn right_side(&self, unbalanced: &PerBody<Load>) -> Vec<f64> {
        let mut right = vec![0.0; self.unknowns()];
        for body in unbalanced.ids() {
            let load = self.free_part(body, unbalanced[body]).components();
            for (value, number) in load.into_iter().zip(&self.numbers[body.index()]) {
                if let Some(number) = number {
                    right[*number as usize] = value;
                }
            }
        }
        right
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
        let lower = self.take_lower();
        let solved =
            self.solve_by_factor(&lower, configuration, iteration, proximal, right, progress);
        self.lower = Some(lower);
        solved
    }

    /// The pattern of the lower triangle, to be given back.
    pub(super) fn take_lower(&mut self) -> Sparsity {
        let lower = self.lower.take();
        lower.unwrap_or_else(|| Sparsity::new(&self.numbers, &self.frames, Stored::Lower))
    }

    fn solve_by_factor(
        &mut self,
        lower: &Sparsity,
        configuration: &Configuration,
        iteration: Iteration,
        proximal: f64,
        right: &mut [f64],
        progress: &mut Progress,
    ) -> Result<(), Singular> {
        self.make_symmetric_solver(lower)?;
        let lagging = self.unknowns() >= LARGE && self.factored.is_some() && proximal == 0.0;
        if !lagging {
            let values = self.values(configuration, iteration, proximal, lower);
            if self
                .factored
                .as_ref()
                .is_none_or(|(old, _)| **old != values)
            {
                let solver = self.symmetric.as_mut().ok_or(Singular)?;
                // A factorisation that fails leaves no factor behind.
                self.factored = None;
                let inertia = solver.factorise(&lower.pattern, &values)?;
                self.factored = Some((Arc::new(values), inertia));
            }
        }
        progress.held_pivots = self
            .factored
            .as_ref()
            .map_or(0, |(_, inertia)| inertia.held);
        self.symmetric.as_mut().ok_or(Singular)?.solve(right);
        if proximal > 0.0 {
            self.factored = None;
        }
        Ok(())
    }

    /// The pattern analysed, once.
    pub(super) fn make_symmetric_solver(&mut self, lower: &Sparsity) -> Result<(), Singular> {
        if self.symmetric.is_none() {
            let order = self.order_of_elimination();
            self.symmetric = Some(SymmetricSolver::new(&lower.pattern, &order)?);
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
            self.general = Some(GeneralSolver::new(&full.pattern)?);
        }
        let values = self.values(configuration, Iteration::Tangent, proximal, &full);
        let solver = self.general.as_mut().ok_or(Singular)?;
        let factorised = solver.factorise(&full.pattern, &values);
        self.full = Some(full);
        factorised?;
        solver.solve(right);
        Ok(())
    }

    /// The stiffness of the assembly; 1 on the diagonal of what is set aside.
    pub(super) fn values(
        &self,
        configuration: &Configuration,
        iteration: Iteration,
        proximal: f64,
        sparsity: &Sparsity,
    ) -> Vec<f64> {
        let mut values = self.values_without(configuration, iteration, sparsity, &self.set_aside);
        if proximal > 0.0 {
            let spring = proximal * closed_stiffness(configuration);
            let weights = weights(self.assembly, &self.numbers);
            for (body, numbers) in self.numbers.iter().enumerate() {
                for number in numbers.iter().flatten().filter(|_| !self.set_aside[body]) {
                    let number = *number as usize;
                    values[sparsity.pattern.diagonal(number)] += spring * weights[number];
                }
            }
        }
        values
    }

    /// The stiffness without the bodies that are set aside, for which 1 stands on the diagonal.
    pub(super) fn values_without(
        &self,
        configuration: &Configuration,
        iteration: Iteration,
        sparsity: &Sparsity,
        set_aside: &[bool],
    ) -> Vec<f64> {
        let mut values = vec![0.0; sparsity.pattern.row.len()];
        for (contact, (frame, bond)) in self
            .frames
            .iter()
            .zip(configuration.bonds.values())
            .enumerate()
        {
            if bond.is_active() && !set_aside[frame.first.index()] {
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
            for number in numbers.iter().flatten().filter(|_| set_aside[body]) {
                values[sparsity.pattern.diagonal(*number as usize)] = 1.0;
            }
        }
        values
    }
}

/// A stiffness that every freedom would have if its contacts were closed: the mean normal stiffness.
fn closed_stiffness(configuration: &Configuration) -> f64 {
    let bonds = configuration.bonds.values();
    bonds.iter().map(|bond| bond.stiffness.normal).sum::<f64>() / bonds.len().max(1) as f64
}
