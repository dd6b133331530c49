//! How stable an equilibrium is: the lowest eigenvalues of its tangent with their modes, and how often it is
//! statically indeterminate.
//!
//! K is the symmetric part of the tangent at the free freedoms of the bodies that are not set aside, D is 1 for a
//! translation and the square of the radius (of a side: half its length) for a rotation. With K·x = λ·D·x an
//! eigenvalue is a stiffness `[force/length]`, and a rotation counts as what it moves at the rim.

use super::configuration::Configuration;
use super::kinematics::FREEDOMS;
use super::sparsity::{Numbers, Stored};
use super::system::System;
use super::tangent::{Stiffness, as_displacements, numbered, weights};
use super::{Displacement, State};
use crate::contact_law::Matrix;
use crate::ids::{BodyId, GrainId, Id, PerBody, PerContact};
use crate::solver::{EigenProblem, Eigenpairs, Singular};

/// An eigenvalue nearer to zero than this share of the mean normal stiffness is zero.
pub const ZERO_EIGENVALUE: f64 = 1e-11;

/// The stability of an equilibrium.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stability {
    /// In numbers.
    pub summary: StabilitySummary,
    /// The lowest modes, eigenvalues rising; as many as were asked for, or as there are freedoms.
    pub modes: Vec<EigenMode>,
}

/// The stability of an equilibrium in numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StabilitySummary {
    /// The lowest eigenvalue, `[force/length]`; none without a free freedom.
    pub lowest_eigenvalue: Option<f64>,
    /// Eigenvalues below zero, of all: the directions in which the equilibrium is unstable.
    pub negative_eigenvalues: usize,
    /// Eigenvalues that are zero, of all: floppy modes and rigid motions.
    pub zero_eigenvalues: usize,
    /// Force components that the contacts can carry less those that equilibrium determines:
    ///
    /// ```math
    /// \sum_c \mathrm{rank}\, k_c - \mathrm{rank}\, K
    /// ```
    ///
    /// 3·N_c − n for bonds with bending stiffness on a stiff assembly of n free freedoms.
    pub static_indeterminacy: i64,
    /// Second-order work of the load step, Σ ΔQ·Δv over all contacts, `[force·length]`: the work of the change of
    /// the loads in the change of the displacements. Where it is negative, the step could not be kept up at these
    /// loads. Hill (1958).
    pub second_order_work: f64,
}

/// A mode of the tangent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EigenMode {
    /// Eigenvalue λ, `[force/length]`.
    pub eigenvalue: f64,
    /// How many bodies take part: (Σ a²)²/Σ a⁴ of their amplitudes a, from 1 to all of them, dimensionless.
    pub participation: f64,
    /// The grains that move most: at most ten, none below a tenth of the largest amplitude.
    pub foremost: Vec<GrainId>,
    /// Displacement of each body, the largest amplitude 1.
    pub displacements: PerBody<Displacement>,
}

impl System<'_> {
    /// The stability of an equilibrium, its second-order work left out: the `count` lowest modes.
    ///
    /// # Errors
    /// Where the tangent is not finite or its modes are not found.
    pub(crate) fn stability(
        &self,
        configuration: &Configuration,
        count: usize,
    ) -> Result<Stability, Singular> {
        let tangents = self.contact_tangents(configuration);
        let numbers = self.numbers_in_use();
        let stiffness = Stiffness::new(&numbers, &self.frames, &tangents, Stored::Lower);
        let weights = weights(self.assembly, &numbers);
        let problem = EigenProblem {
            pattern: &stiffness.sparsity.pattern,
            values: &stiffness.values,
            weights: &weights,
            scale: mean_normal_stiffness(&tangents),
        };
        let pairs = problem.lowest(count)?;
        let [negative, zero] = low_counts(&problem, &pairs)?;
        let carried: usize = tangents.values().iter().map(rank).sum();
        let determined = weights.len() - zero;
        let modes = pairs.values.iter().zip(&pairs.vectors);
        Ok(Stability {
            summary: StabilitySummary {
                lowest_eigenvalue: pairs.values.first().copied(),
                negative_eigenvalues: negative,
                zero_eigenvalues: zero,
                static_indeterminacy: carried as i64 - determined as i64,
                second_order_work: 0.0,
            },
            modes: modes
                .map(|(&value, x)| self.mode(value, as_displacements(&numbers, x)))
                .collect(),
        })
    }

    /// Numbers of the free freedoms of the bodies that are not set aside.
    fn numbers_in_use(&self) -> Vec<Numbers> {
        let bodies = self.numbers.iter().zip(&self.set_aside);
        numbered(bodies.map(|(numbers, &aside)| {
            if aside {
                [false; FREEDOMS]
            } else {
                numbers.map(|number| number.is_some())
            }
        }))
    }

    fn mode(&self, eigenvalue: f64, mut displacements: PerBody<Displacement>) -> EigenMode {
        let amplitudes: Vec<f64> = displacements
            .iter()
            .map(|(body, u)| amplitude(*u, self.moment_arm(body)))
            .collect();
        let squares = amplitudes.iter().map(|a| a * a);
        let (sum, fourth) = squares.fold((0.0, 0.0), |(s, f), a| (s + a, f + a * a));
        let factor = 1.0 / self.largest_with_sign(&displacements, &amplitudes);
        for u in displacements.values_mut() {
            *u = Displacement::from_components(u.components().map(|value| value * factor));
        }
        EigenMode {
            eigenvalue,
            participation: sum * sum / fourth,
            foremost: self.foremost_grains(|grain| amplitudes[grain]),
            displacements,
        }
    }

    /// The largest amplitude, negative where the largest component of that body is: a mode has no sign of its own.
    fn largest_with_sign(&self, field: &PerBody<Displacement>, amplitudes: &[f64]) -> f64 {
        let larger = |a: usize, b: usize| if amplitudes[b] > amplitudes[a] { b } else { a };
        let body = BodyId::from_index((0..amplitudes.len()).reduce(larger).unwrap_or(0));
        let u = field[body];
        let parts = [u.x, u.y, u.rotation * self.moment_arm(body)];
        let largest = parts
            .into_iter()
            .fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
        amplitudes[body.index()].copysign(largest)
    }
}

/// √(u_x² + u_y² + (R·ω)²).
fn amplitude(u: Displacement, arm: f64) -> f64 {
    let rim = u.rotation * arm;
    (u.x * u.x + u.y * u.y + rim * rim).sqrt()
}

fn mean_normal_stiffness(tangents: &PerContact<Matrix>) -> f64 {
    let stiffnesses = tangents.values().iter().map(|k| k[0][0].abs());
    let (sum, count) = stiffnesses
        .filter(|k| *k > 0.0)
        .fold((0.0, 0), |(sum, count), k| (sum + k, count + 1));
    if count == 0 {
        1.0
    } else {
        sum / f64::from(count)
    }
}

/// How many eigenvalues are negative, and how many are zero: told by those that are known where the highest of
/// them is positive, else by the pivots.
fn low_counts(problem: &EigenProblem<'_>, known: &Eigenpairs) -> Result<[usize; 2], Singular> {
    let bound = ZERO_EIGENVALUE * problem.scale;
    let all = known.values.len() == problem.weights.len();
    let enough = all || known.values.last().is_some_and(|&highest| highest > bound);
    let below = |limit: f64| {
        if enough {
            Ok(known.values.iter().filter(|&&value| value < limit).count())
        } else {
            problem.count_below(limit)
        }
    };
    let negative = below(-bound)?;
    Ok([negative, below(bound)?.saturating_sub(negative)])
}

/// Rank of a contact's tangent: the force components that it can carry.
fn rank(k: &Matrix) -> usize {
    const NONE: f64 = 1e-12;
    let mut rows = *k;
    let scales = k.map(|row| row.iter().fold(0.0, |a: f64, b| a.max(b.abs())));
    let mut used = k.map(|_| false);
    for column in 0..k.len() {
        let pivot = (0..k.len()).find(|&i| !used[i] && rows[i][column].abs() > NONE * scales[i]);
        let Some(pivot) = pivot else {
            continue;
        };
        used[pivot] = true;
        let pivot_row = rows[pivot];
        for row in (0..k.len()).filter(|&row| !used[row]) {
            let share = rows[row][column] / pivot_row[column];
            for (value, of_pivot) in rows[row].iter_mut().zip(pivot_row) {
                *value -= share * of_pivot;
            }
        }
    }
    used.iter().filter(|used| **used).count()
}

/// Σ (Q₁ − Q₀)·(v₁ − v₀) over all contacts, `[force·length]`.
pub fn second_order_work(before: &State, after: &State) -> f64 {
    let pairs = before.contacts.values().iter().zip(after.contacts.values());
    let of_contact = pairs.map(|(from, to)| {
        let (q, p, v, w) = (to.force, from.force, to.displacement, from.displacement);
        (q.normal - p.normal) * (v.normal - w.normal)
            + (q.shear - p.shear) * (v.shear - w.shear)
            + (q.moment - p.moment) * (v.rotation - w.rotation)
    });
    of_contact.sum()
}
