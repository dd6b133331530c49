//! The table `actions`: a row an action at every load step, its displacement and the force that goes with it.
//!
//! Displacement d and force P of a load or move are conjugate: P·δd is the work of the action.

use kavics::equilibrium::{Displacement, Equilibrium, Freedom, Load};
use kavics::ids::BodyId;
use kavics::loading::Program;

use crate::column::{Column, Unit};

/// A row of `actions`.
#[derive(Clone, Debug, PartialEq)]
pub struct ActionRow {
    /// Load step; 0 before loading.
    pub step: usize,
    /// Name of the load or move.
    pub name: String,
    /// Its factor.
    pub factor: f64,
    /// How far the bodies it acts on have gone in its direction, weighted by the size of the action on each,
    /// `[length]`; a rotation, where the action is of moments or rotations alone.
    pub displacement: f64,
    /// The whole force of the action in its direction, `[force]`; a moment, where it is of these alone.
    pub force: f64,
}

/// The columns of `actions`, in their order.
pub(crate) fn action_columns() -> Vec<Column<ActionRow>> {
    vec![
        Column::integer("step", |r: &ActionRow| r.step as i64),
        Column::text("action", |r: &ActionRow| Some(&r.name)),
        Column::number("factor", Unit::Dimensionless, |r: &ActionRow| r.factor),
        Column::number("displacement", Unit::Length, |r: &ActionRow| r.displacement),
        Column::number("force", Unit::Force, |r: &ActionRow| r.force),
    ]
}

/// One freedom on which an action acts, and its size at factor 1.
#[derive(Clone, Copy, Debug)]
struct Part {
    body: BodyId,
    freedom: Freedom,
    size: f64,
}

/// What each action acts on.
#[derive(Debug)]
pub(crate) struct Actions {
    loads: Vec<Vec<Part>>,
    moves: Vec<Vec<Part>>,
}

impl Actions {
    pub(crate) fn new(program: &Program) -> Self {
        let count = program.actions.len();
        let mut actions = Self {
            loads: vec![Vec::new(); count],
            moves: vec![Vec::new(); count],
        };
        let mut loads = vec![Vec::new(); count];
        for applied in &program.loads {
            loads[applied.action].push((applied.body, applied.load));
        }
        for (parts, loads) in actions.loads.iter_mut().zip(loads) {
            let together = together(loads).into_iter();
            parts.extend(together.flat_map(|(body, load)| load_parts(body, load)));
        }
        for moved in &program.prescribed {
            actions.moves[moved.action].push(Part {
                body: moved.body,
                freedom: moved.freedom,
                size: moved.amplitude,
            });
        }
        for parts in actions.loads.iter_mut().chain(&mut actions.moves) {
            keep_one_dimension(parts);
        }
        actions
    }

    /// The rows of the load step that `equilibrium` ends.
    pub(crate) fn rows(&self, program: &Program, equilibrium: &Equilibrium) -> Vec<ActionRow> {
        let named = program.actions.iter().enumerate();
        named
            .map(|(action, named)| {
                let factor = equilibrium.factors.get(action).copied().unwrap_or_default();
                let [displacement, force] = self.conjugates(action, factor, equilibrium);
                ActionRow {
                    step: equilibrium.step,
                    name: named.name.clone(),
                    factor,
                    displacement,
                    force,
                }
            })
            .collect()
    }

    fn conjugates(&self, action: usize, factor: f64, equilibrium: &Equilibrium) -> [f64; 2] {
        let (loads, moves) = (&self.loads[action], &self.moves[action]);
        if !loads.is_empty() {
            let whole: f64 = sizes(loads).sum();
            let work = |part: &Part| part.size * displaced(equilibrium, *part);
            return [ratio(loads.iter().map(work).sum(), whole), factor * whole];
        }
        let mean = ratio(sizes(moves).sum(), sizes(moves).count() as f64);
        let work = |part: &Part| part.size * reaction(equilibrium, *part);
        [factor * mean, ratio(moves.iter().map(work).sum(), mean)]
    }
}

/// The size of an action on each body: the length of a vector, whatever the axes.
fn sizes(parts: &[Part]) -> impl Iterator<Item = f64> {
    let of_bodies = parts.chunk_by(|a, b| a.body == b.body);
    of_bodies.map(|parts| {
        let squares = parts.iter().map(|part| part.size * part.size);
        squares.sum::<f64>().sqrt()
    })
}

/// One load a body.
fn together(mut loads: Vec<(BodyId, Load)>) -> Vec<(BodyId, Load)> {
    loads.sort_by_key(|(body, _)| *body);
    loads.dedup_by(|next, kept| {
        let is_same = next.0 == kept.0;
        if is_same {
            kept.1 += next.1;
        }
        is_same
    });
    loads
}

fn load_parts(body: BodyId, load: Load) -> impl Iterator<Item = Part> {
    let sizes = [
        (Freedom::X, load.x),
        (Freedom::Y, load.y),
        (Freedom::Rotation, load.moment),
    ];
    let acting = sizes.into_iter().filter(|(_, size)| *size != 0.0);
    acting.map(move |(freedom, size)| Part {
        body,
        freedom,
        size,
    })
}

/// Forces and moments cannot be added: rotations are left out where anything else is there.
fn keep_one_dimension(parts: &mut Vec<Part>) {
    parts.retain(|part| part.size != 0.0);
    if parts.iter().any(|part| part.freedom != Freedom::Rotation) {
        parts.retain(|part| part.freedom != Freedom::Rotation);
    }
}

fn displaced(equilibrium: &Equilibrium, part: Part) -> f64 {
    let Displacement { x, y, rotation } = equilibrium.state.displacements[part.body];
    match part.freedom {
        Freedom::X => x,
        Freedom::Y => y,
        Freedom::Rotation => rotation,
    }
}

fn reaction(equilibrium: &Equilibrium, part: Part) -> f64 {
    let Load { x, y, moment } = equilibrium.reactions[part.body];
    match part.freedom {
        Freedom::X => x,
        Freedom::Y => y,
        Freedom::Rotation => moment,
    }
}

fn ratio(above: f64, below: f64) -> f64 {
    if below == 0.0 { 0.0 } else { above / below }
}
