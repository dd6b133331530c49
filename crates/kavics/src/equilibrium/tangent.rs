//! The tangent of an assembly at an equilibrium, from the tangents of its contacts.

use super::configuration::Configuration;
use super::kinematics::{ALL_FREEDOMS, ContactFrame, FREEDOMS};
use super::sparsity::{Numbers, Sparsity, Stored};
use super::system::System;
use super::{Displacement, Iteration, Load};
use crate::assembly::Assembly;
use crate::contact_law::{ContactForce, Matrix};
use crate::ids::{Id, PerBody, PerContact, PerGrain};
use crate::solver::{GeneralSolver, Singular, SymmetricSolver, minimum_degree};

impl System<'_> {
    /// ∂Q/∂v of each contact; nothing where it is open or broken into nothing.
    pub(crate) fn contact_tangents(&self, configuration: &Configuration) -> PerContact<Matrix> {
        configuration.bonds.map(|bond| {
            if bond.is_active() {
                self.stiffness_of(bond, Iteration::Tangent)
            } else {
                Matrix::default()
            }
        })
    }
}

/// ½(k + kᵀ).
pub(super) fn symmetric_part(k: &Matrix) -> Matrix {
    let mut symmetric = *k;
    for (i, row) in symmetric.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            *value = 0.5 * (k[i][j] + k[j][i]);
        }
    }
    symmetric
}

/// Numbers of the free freedoms, in the order of the bodies.
pub(super) fn numbered(free: impl Iterator<Item = [bool; FREEDOMS]>) -> Vec<Numbers> {
    let mut next = 0;
    free.map(|body| {
        body.map(|free| {
            free.then(|| {
                next += 1;
                next - 1
            })
        })
    })
    .collect()
}

/// A sparse stiffness of the free freedoms.
pub(super) struct Stiffness {
    pub sparsity: Sparsity,
    pub values: Vec<f64>,
}

impl Stiffness {
    /// Σ Bᵀ·k·B over the contacts; of their symmetric parts where the lower triangle is stored.
    pub fn new(
        numbers: &[Numbers],
        frames: &[ContactFrame],
        tangents: &PerContact<Matrix>,
        stored: Stored,
    ) -> Self {
        let sparsity = Sparsity::new(numbers, frames, stored);
        let mut values = vec![0.0; sparsity.pattern.row.len()];
        for (contact, (frame, k)) in frames.iter().zip(tangents.values()).enumerate() {
            let blocks = match stored {
                Stored::Lower => frame.stiffness(&symmetric_part(k)),
                Stored::Full => frame.stiffness(k),
            };
            sparsity.add(&mut values, contact, frame, numbers, &blocks);
        }
        Self { sparsity, values }
    }

    /// Puts 1 on the diagonal where nothing stands, so that a freedom without stiffness stays where it is.
    fn hold_what_is_loose(&mut self) {
        let pattern = &self.sparsity.pattern;
        for column in 0..pattern.order() {
            let diagonal = &mut self.values[pattern.diagonal(column)];
            if *diagonal == 0.0 {
                *diagonal = 1.0;
            }
        }
    }
}

/// Displacements in which the contacts balance on the free grains, with their tangents, while all other bodies keep
/// the displacements of the fields.
///
/// Of each field, the free grains change from where they are; `free` says which they are. With a floppy mode, one of
/// many answers.
///
/// # Errors
/// Where the free grains are a mechanism, and the tangents are not symmetric.
pub fn relax(
    assembly: &Assembly,
    tangents: &PerContact<Matrix>,
    free: &PerGrain<bool>,
    fields: &mut [PerBody<Displacement>],
) -> Result<(), Singular> {
    let contacts = assembly.contacts.values().iter();
    let frames: Vec<_> = contacts.map(|c| ContactFrame::new(assembly, c)).collect();
    let of_sides = assembly.sides.ids().map(|_| [false; FREEDOMS]);
    let of_grains = free.values().iter().map(|&free| [free; FREEDOMS]);
    let numbers = numbered(of_grains.chain(of_sides));
    if !free.values().contains(&true) {
        return Ok(());
    }
    let mut solve = solver(&numbers, &frames, tangents)?;
    for field in fields {
        let mut step = unbalanced(&numbers, &frames, tangents, field);
        solve(&mut step);
        if !step.iter().all(|value| value.is_finite()) {
            return Err(Singular);
        }
        add_step(field, &numbers, &step);
    }
    Ok(())
}

type Solve = Box<dyn FnMut(&mut [f64])>;

/// Solves with the stiffness of the free freedoms.
fn solver(
    numbers: &[Numbers],
    frames: &[ContactFrame],
    tangents: &PerContact<Matrix>,
) -> Result<Solve, Singular> {
    let symmetric = tangents.values().iter().all(|k| *k == symmetric_part(k));
    let stored = if symmetric {
        Stored::Lower
    } else {
        Stored::Full
    };
    let mut stiffness = Stiffness::new(numbers, frames, tangents, stored);
    stiffness.hold_what_is_loose();
    let pattern = &stiffness.sparsity.pattern;
    if symmetric {
        let mut solver = SymmetricSolver::new(pattern, &minimum_degree(pattern)?)?;
        solver.factorise(pattern, &stiffness.values)?;
        Ok(Box::new(move |x| solver.solve(x)))
    } else {
        let mut solver = GeneralSolver::new(pattern)?;
        solver.factorise(pattern, &stiffness.values)?;
        Ok(Box::new(move |x| solver.solve(x)))
    }
}

/// What the contacts leave unbalanced at the free freedoms.
fn unbalanced(
    numbers: &[Numbers],
    frames: &[ContactFrame],
    tangents: &PerContact<Matrix>,
    field: &PerBody<Displacement>,
) -> Vec<f64> {
    let mut loads = PerBody::filled(Load::default(), numbers.len());
    for (frame, k) in frames.iter().zip(tangents.values()) {
        let v = frame.relative_displacement(field[frame.first], field[frame.second]);
        let [first, second] = frame.loads(ContactForce::linear(k, v));
        loads[frame.first] += first;
        loads[frame.second] += second;
    }
    let components = loads.values().iter().map(|load| load.components());
    let pairs = numbers.iter().flatten().zip(components.flatten());
    pairs
        .filter_map(|(number, value)| number.map(|_| value))
        .collect()
}

fn add_step(field: &mut PerBody<Displacement>, numbers: &[Numbers], step: &[f64]) {
    for (displacement, numbers) in field.values_mut().iter_mut().zip(numbers) {
        for (freedom, number) in ALL_FREEDOMS.into_iter().zip(numbers) {
            if let Some(number) = number {
                *displacement.component_mut(freedom) += step[*number as usize];
            }
        }
    }
}

/// As displacements of the bodies; what has no number does not move.
pub(super) fn as_displacements(numbers: &[Numbers], x: &[f64]) -> PerBody<Displacement> {
    let mut field = PerBody::filled(Displacement::default(), numbers.len());
    add_step(&mut field, numbers, x);
    field
}

/// D of the free freedoms: 1 for translations, the square of the arm for rotations.
pub(super) fn weights(assembly: &Assembly, numbers: &[Numbers]) -> Vec<f64> {
    let mut weights = Vec::new();
    for (body, numbers) in numbers.iter().enumerate() {
        let arm = assembly.moment_arm(assembly.partner(Id::from_index(body)));
        let own = [1.0, 1.0, arm * arm];
        let free = own
            .iter()
            .zip(numbers)
            .filter(|(_, number)| number.is_some());
        weights.extend(free.map(|(weight, _)| *weight));
    }
    weights
}
