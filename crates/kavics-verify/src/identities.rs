//! Identities recomputed from the tables alone. Each answers one number, relative where it can be.

use crate::run::Run;
use crate::tables::{ContactRow, Half, Tables, Vector};

/// The value of an identity at a load step; `key` holds its parameters.
///
/// # Errors
/// Tables that cannot be read, in words.
pub fn value(name: &str, run: &Run, step: usize, key: &str) -> Result<f64, String> {
    let tables = || Tables::read(run, step);
    Ok(match name {
        "balance_of_reactions" => balance_of_reactions(&tables()?, &numbers(key)),
        "balance_of_grains" => balance_of_grains(&tables()?),
        "boundary_moment" => boundary_moment(run, &tables()?, step)?,
        "work_of_contacts" => work_of_contacts(run, &tables()?, step)?,
        "virtual_work" => virtual_work(&tables()?),
        "stress_parts" => stress_parts(run, &tables()?, step)?,
        "sum_of_grain_stresses" => sum_of_grain_stresses(run, &tables()?, step)?,
        "asymmetry" => asymmetry(&tables()?),
        "bending_part" => bending_part(&tables()?),
        "cells_fill" => cells_fill(&tables()?, &numbers(key)),
        "cells_close" => cells_close(&tables()?, &numbers(key)),
        "contacts_are_edges" => contacts_are_edges(&tables()?),
        "order" => order(run, step)?,
        "contraction" => contraction(run, step)?,
        "largest_motion" => largest_motion(&tables()?),
        "voigt_ratio" => voigt_ratio(&tables()?, &numbers(key)),
        other => panic!("no identity is called {other}"),
    })
}

fn numbers(key: &str) -> Vec<f64> {
    let number = |text: &str| text.parse().expect("a number in the key");
    key.split_whitespace().map(number).collect()
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().map(f64::abs).fold(0.0, f64::max)
}

/// A column of `steps` at a load step.
fn at_step(run: &Run, step: usize, column: &str) -> Result<f64, String> {
    let steps = run.steps("step")?;
    let row = steps.iter().position(|other| *other == step as f64);
    let row = row.ok_or_else(|| format!("there is no load step {step}"))?;
    Ok(run.steps(column)?[row])
}

/// Loads and reactions of all grains and sides (of a box width × height) balance.
fn balance_of_reactions(tables: &Tables, size: &[f64]) -> f64 {
    let [width, height] = *size else {
        panic!("width and height expected");
    };
    let middles = [
        Vector(0.0, 0.5 * height),
        Vector(width, 0.5 * height),
        Vector(0.5 * width, 0.0),
        Vector(0.5 * width, height),
    ];
    let grains = tables.grains.iter().map(|g| (g.centre, g.force, g.moment));
    let sides = tables.sides.iter().zip(middles);
    let sides = sides.map(|((force, moment, _, _), at)| (at, *force, *moment));
    let (mut force, mut moment) = (Vector::default(), 0.0);
    for (at, f, m) in grains.chain(sides) {
        force = force + f;
        moment += at.cross(f) + m;
    }
    largest([force.0, force.1, moment / width]) / tables.largest_force()
}

/// External forces and those of contacts balance on each grain.
fn balance_of_grains(tables: &Tables) -> f64 {
    let mut sums: Vec<(Vector, f64)> = tables.grains.iter().map(|g| (g.force, g.moment)).collect();
    for half in tables.halves() {
        let (force, moment) = &mut sums[half.grain];
        *force = *force + half.force;
        *moment += half.lever.cross(half.force) + half.moment;
    }
    let left = sums.iter().zip(&tables.grains);
    let worst = largest(left.flat_map(|((f, m), g)| [f.0, f.1, m / g.radius]));
    worst / tables.largest_force()
}

fn product(a: Vector, b: Vector) -> [f64; 4] {
    [a.0 * b.0, a.0 * b.1, a.1 * b.0, a.1 * b.1]
}

fn sum(tensors: impl IntoIterator<Item = [f64; 4]>) -> [f64; 4] {
    let mut total = [0.0; 4];
    for tensor in tensors {
        (0..4).for_each(|k| total[k] += tensor[k]);
    }
    total
}

fn difference(a: [f64; 4], b: [f64; 4]) -> f64 {
    let scale = largest(a.into_iter().chain(b));
    largest((0..4).map(|k| a[k] - b[k])) / scale
}

fn stress(run: &Run, step: usize, prefix: &str) -> Result<[f64; 4], String> {
    let part = |part| at_step(run, step, &format!("{prefix}_{part}"));
    Ok([part("xx")?, part("xy")?, part("yx")?, part("yy")?])
}

/// Love and Weber's stress of the whole assembly is the moment of external forces: A·σ = Σ x f.
fn boundary_moment(run: &Run, tables: &Tables, step: usize) -> Result<f64, String> {
    let loads = tables.grains.iter().map(|g| product(g.centre, g.force));
    let at_sides = tables.contacts.iter().filter(|c| c.second.is_none());
    let from_sides = at_sides.map(|c| product(c.point, c.force));
    let moments = sum(loads.chain(from_sides));
    let area = at_step(run, step, "window_area")?;
    let stress = stress(run, step, "stress")?;
    Ok(difference(stress.map(|s| s * area), moments))
}

/// Hill: Σ F·Δu is the work of stress on strain and the boundary term, for the columns and for the tables.
fn work_of_contacts(run: &Run, tables: &Tables, step: usize) -> Result<f64, String> {
    let between = tables.contacts.iter().filter_map(|c| Some((c, c.second?)));
    let work: f64 = between
        .map(|(c, second)| {
            let opening = tables.grains[second].translation - tables.grains[c.first].translation;
            c.force.dot(opening)
        })
        .sum();
    let contact = at_step(run, step, "contact_work")?;
    let macroscopic = at_step(run, step, "macroscopic_work")?;
    let boundary = at_step(run, step, "boundary_work")?;
    Ok(largest([contact - work, macroscopic + boundary - work]) / work.abs())
}

/// Σ Q·v over contacts is Σ f·u over grains and sides.
fn virtual_work(tables: &Tables) -> f64 {
    let inner: f64 = tables
        .contacts
        .iter()
        .map(|c| {
            let [opening, shear, rotation] = c.displacement;
            c.normal_force * opening + c.shear_force * shear + c.moment * rotation
        })
        .sum();
    let grains = tables.grains.iter();
    let grains = grains.map(|g| g.force.dot(g.translation) + g.moment * g.rotation);
    let sides = tables.sides.iter();
    let sides = sides.map(|(force, moment, u, rotation)| force.dot(*u) + moment * rotation);
    let outer: f64 = grains.chain(sides).sum();
    (inner - outer).abs() / inner.abs()
}

/// The parts of the stress after Cundall and Strack, on touching discs, over all grains.
fn stress_parts(run: &Run, tables: &Tables, step: usize) -> Result<f64, String> {
    let active: Vec<Half> = tables
        .halves()
        .into_iter()
        .filter(|half| half.force.length() > 0.0)
        .collect();
    let mut means = vec![(0.0, 0.0); tables.grains.len()];
    for half in &active {
        means[half.grain].0 += half.force.dot(half.normal);
        means[half.grain].1 += 1.0;
    }
    let area = at_step(run, step, "window_area")?;
    let mut parts = [[0.0; 4]; 4];
    for half in &active {
        let radius = tables.grains[half.grain].radius / area;
        let normal = half.force.dot(half.normal);
        let mean = means[half.grain].0 / means[half.grain].1;
        let nn = product(half.normal, half.normal);
        let whole = product(half.normal, half.force);
        for k in 0..4 {
            let unit = if k == 0 || k == 3 { 0.5 } else { 0.0 };
            parts[0][k] += radius * (whole[k] - normal * nn[k]);
            parts[1][k] += radius * (normal - mean) * nn[k];
            parts[2][k] += radius * mean * (nn[k] - unit);
            parts[3][k] += radius * normal * unit;
        }
    }
    let isotropic = at_step(run, step, "isotropic_stress")?;
    let read = [
        stress(run, step, "shear_stress")?,
        stress(run, step, "variation_stress")?,
        stress(run, step, "fabric_stress")?,
        [isotropic, 0.0, 0.0, isotropic],
    ];
    let scale = isotropic.abs();
    let errors = (0..4).flat_map(|i| (0..4).map(move |k| (i, k)));
    Ok(largest(
        errors.map(|(i, k)| (parts[i][k] - read[i][k]) / scale),
    ))
}

/// Σ A_p σ_p over all grains is A·σ.
fn sum_of_grain_stresses(run: &Run, tables: &Tables, step: usize) -> Result<f64, String> {
    let grains = tables.grains.iter();
    let total = sum(grains.map(|g| g.stress.map(|s| s * g.cell_area)));
    let area = at_step(run, step, "window_area")?;
    let stress = stress(run, step, "stress")?;
    Ok(difference(total, stress.map(|s| s * area)))
}

/// Moments of contacts and external moment on each grain.
fn moments(tables: &Tables) -> Vec<f64> {
    let mut moments: Vec<f64> = tables.grains.iter().map(|g| g.moment).collect();
    for half in tables.halves() {
        moments[half.grain] += half.moment;
    }
    moments
}

/// A_p (σ_xy − σ_yx) is −(ΣM + m) on each grain.
fn asymmetry(tables: &Tables) -> f64 {
    let errors = tables.grains.iter().zip(moments(tables));
    let worst = errors.map(|(g, moment)| g.cell_area * (g.stress[1] - g.stress[2]) + moment);
    largest(worst) / tables.largest_force()
}

/// With −Σ M t⊗n added, the stress of each grain without external moment is symmetric.
fn bending_part(tables: &Tables) -> f64 {
    let mut errors: Vec<f64> = tables
        .grains
        .iter()
        .map(|g| g.cell_area * (g.stress[1] - g.stress[2]) + g.moment)
        .collect();
    for half in tables.halves() {
        let part = product(half.normal.quarter_turn(), half.normal);
        errors[half.grain] -= half.moment * (part[1] - part[2]);
    }
    largest(errors) / tables.largest_force()
}

/// The cells fill the box.
fn cells_fill(tables: &Tables, size: &[f64]) -> f64 {
    tables.area() / (size[0] * size[1]) - 1.0
}

/// Distance from a centre to the common edge, for the first grain or the second.
fn height(tables: &Tables, contact: &ContactRow, grain: usize) -> f64 {
    let other = contact.first + contact.second.unwrap_or(contact.first) - grain;
    let [own, foreign] = [grain, other].map(|g| tables.grains[g].radius);
    let l = contact.branch_length;
    (l * l + own * own - foreign * foreign) / (2.0 * l)
}

/// Around grains farther than `margin` from a box width × height: Σ s n = 0, ½ Σ s h = A_p, Σ s h n⊗n + … = A_p.
fn cells_close(tables: &Tables, key: &[f64]) -> f64 {
    let [width, top, margin] = *key else {
        panic!("width, height, margin expected");
    };
    let inner = |at: Vector| {
        let (x, y) = (at.0.min(width - at.0), at.1.min(top - at.1));
        x > margin && y > margin
    };
    let mut sums = vec![(Vector::default(), 0.0); tables.grains.len()];
    for contact in &tables.contacts {
        let Some(second) = contact.second else {
            continue;
        };
        for (grain, sign) in [(contact.first, 1.0), (second, -1.0)] {
            let s = contact.dual_length_full;
            let (closure, area) = &mut sums[grain];
            *closure = *closure + contact.normal * (s * sign);
            *area += 0.5 * s * height(tables, contact, grain);
        }
    }
    let pairs = sums.iter().zip(&tables.grains);
    let inside = pairs.filter(|(_, g)| inner(g.centre));
    largest(inside.flat_map(|((closure, area), g)| {
        let scale = g.radius;
        [
            closure.0 / scale,
            closure.1 / scale,
            area / g.cell_area - 1.0,
        ]
    }))
}

/// Share of touching pairs that have no edge with a length.
fn contacts_are_edges(tables: &Tables) -> f64 {
    let touching = |a: usize, b: usize| {
        let (first, second) = (&tables.grains[a], &tables.grains[b]);
        (second.centre - first.centre).length() - first.radius - second.radius < 1e-7
    };
    let count = tables.grains.len();
    let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
    let touching = pairs.filter(|(a, b)| touching(*a, *b)).count();
    let edges = tables.contacts.iter().filter(|c| {
        let gap = |second: usize| {
            c.branch_length - tables.grains[c.first].radius - tables.grains[second].radius
        };
        c.dual_length_full > 0.0 && c.second.is_some_and(|second| gap(second) < 1e-7)
    });
    touching as f64 - edges.count() as f64
}

/// Residuals of the iterates of a load step that are above the floor of rounding.
fn residuals(run: &Run, step: usize) -> Result<Vec<f64>, String> {
    let table = run.table("iterations", 0)?;
    let numbers = |column| table.numbers(column).map_err(|error| error.to_string());
    let (steps, residuals) = (numbers("step")?, numbers("residual")?);
    let pairs = steps.into_iter().zip(residuals);
    Ok(pairs
        .filter(|(other, residual)| *other == step as f64 && *residual > 1e-14)
        .map(|(_, residual)| residual)
        .collect())
}

/// Order of convergence from the last three residuals.
fn order(run: &Run, step: usize) -> Result<f64, String> {
    let residuals = residuals(run, step)?;
    let [.., a, b, c] = residuals[..] else {
        return Err(format!("three residuals expected: {residuals:?}"));
    };
    Ok((c / b).ln() / (b / a).ln())
}

/// Ratio of the last two residuals.
fn contraction(run: &Run, step: usize) -> Result<f64, String> {
    let residuals = residuals(run, step)?;
    let [.., a, b] = residuals[..] else {
        return Err(format!("two residuals expected: {residuals:?}"));
    };
    Ok(b / a)
}

fn largest_motion(tables: &Tables) -> f64 {
    let grains = tables.grains.iter();
    largest(grains.flat_map(|g| [g.translation.0, g.translation.1, g.rotation]))
}

/// Energy of the contacts over the energy that they had if all grains followed the strain: E, G of the layer, xx, yy.
fn voigt_ratio(tables: &Tables, key: &[f64]) -> f64 {
    let [e, g, xx, yy] = key[..] else {
        panic!("normal and shear modulus, xx and yy expected");
    };
    let energy = |contact: &ContactRow, [opening, shear]: [f64; 2]| {
        0.5 * contact.dual_length * (e * opening * opening + g * shear * shear)
    };
    let affine = |contact: &ContactRow| {
        let n = contact.normal;
        let motion = Vector(xx * n.0, yy * n.1) * contact.branch_length;
        energy(contact, [motion.dot(n), motion.dot(n.quarter_turn())])
    };
    let inner: f64 = tables
        .contacts
        .iter()
        .map(|c| {
            let [opening, shear, rotation] = c.displacement;
            energy(c, [opening, shear]) + 0.5 * c.moment * rotation
        })
        .sum();
    inner / tables.contacts.iter().map(affine).sum::<f64>()
}
