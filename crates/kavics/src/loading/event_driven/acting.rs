//! What acts from outside along a load step, on a straight line.

use crate::equilibrium::configuration::Action;
use crate::equilibrium::{ALL_FREEDOMS, Displacement, Drive, Freedom, Load};
use crate::ids::{BodyId, Id};
use crate::loading::Program;
use crate::loading::advance;
use crate::loading::load_path::LoadStep;

/// Loads and moves as functions of a factor x: `[a, b]` stands for a + x·b.
///
/// Where all actions of the stage start from the same factor, x is the load factor, so that the line is that of the
/// whole stage; else it is the share of the load step.
#[derive(Clone, Debug, PartialEq)]
pub struct Acting {
    /// Factor of each action.
    factors: Vec<[f64; 2]>,
    /// The load factor.
    load_factor: [f64; 2],
    /// Loads on each body.
    pub loads: Vec<[Load; 2]>,
    /// Values of the moved freedoms.
    pub moved: Vec<(BodyId, Freedom, [f64; 2])>,
}

impl Acting {
    /// What acts along a load step.
    pub fn new(program: &Program, load_step: &LoadStep, bodies: usize) -> Self {
        let (factors, load_factor) = lines(program, load_step);
        let mut loads = vec![[Load::default(); 2]; bodies];
        for applied in &program.loads {
            let parts = factors[applied.action];
            for (sum, part) in loads[applied.body.index()].iter_mut().zip(parts) {
                *sum += applied.load * part;
            }
        }
        let moved = program.prescribed.iter();
        let moved = moved.map(|p| {
            let parts = factors[p.action].map(|part| p.amplitude * part);
            (p.body, p.freedom, parts)
        });
        Self {
            load_factor,
            loads,
            moved: moved.collect(),
            factors,
        }
    }

    /// Whether nothing acts at x = 0.
    pub fn is_proportional(&self) -> bool {
        self.loads.iter().all(|load| load[0] == Load::default())
            && self.moved.iter().all(|moved| moved.2[0] == 0.0)
    }

    /// The moved freedoms, as far as they go up to a factor of this size.
    pub fn largest_moves(&self, farthest: f64) -> Vec<(BodyId, Freedom, f64)> {
        let moved = self.moved.iter();
        let value = |[constant, rate]: [f64; 2]| constant.abs() + farthest * rate.abs();
        moved
            .map(|&(body, freedom, line)| (body, freedom, value(line)))
            .collect()
    }

    /// The load factor at x.
    pub fn load_factor(&self, x: f64) -> f64 {
        self.load_factor[0] + x * self.load_factor[1]
    }

    /// How far what varies has gone at x, by the displacements of all that is loaded and the reactions of all that is
    /// moved. None where both vary, or not from zero.
    pub fn drive(
        &self,
        x: f64,
        displacements: impl Iterator<Item = (BodyId, Displacement)>,
        reactions: impl Iterator<Item = f64>,
    ) -> Option<Drive> {
        if self.load_factor != [0.0, 1.0] {
            return None;
        }
        let loads = displacements.flat_map(|(body, u)| {
            let rates = self.loads[body.index()][1].components().into_iter();
            let parts = ALL_FREEDOMS.into_iter().zip(rates.zip(u.components()));
            parts.map(move |(freedom, (rate, with))| Part {
                body,
                freedom,
                rate,
                with,
            })
        });
        let moves = self.moved.iter().zip(reactions);
        let moves = moves.map(|(&(body, freedom, [_, rate]), with)| Part {
            body,
            freedom,
            rate,
            with,
        });
        let loads = Varying::of(loads.collect());
        let moves = Varying::of(moves.collect());
        match (loads.bodies, moves.bodies) {
            (1.., 0) => Some(Drive {
                displacement: loads.work / loads.size,
                force: x * loads.size,
            }),
            (0, 1..) => {
                let mean = moves.size / moves.bodies as f64;
                Some(Drive {
                    displacement: x * mean,
                    force: moves.work / mean,
                })
            }
            _ => None,
        }
    }

    /// The factor of each action at x.
    pub fn factors(&self, x: f64) -> Vec<f64> {
        self.factors.iter().map(|[a, b]| a + x * b).collect()
    }

    /// The action at x.
    pub fn at(&self, program: &Program, x: f64) -> Action {
        advance::action(program, &self.factors(x), self.loads.len())
    }
}

/// A component of what varies, and the displacement or reaction that belongs to it.
struct Part {
    body: BodyId,
    freedom: Freedom,
    rate: f64,
    with: f64,
}

/// What varies, as a whole.
struct Varying {
    /// Bodies it acts on.
    bodies: usize,
    /// Σ of its sizes on them: lengths of vectors, whatever the axes.
    size: f64,
    /// Σ of its components times what belongs to them.
    work: f64,
}

impl Varying {
    /// The sum of parts, body by body; of rotations only where nothing else varies.
    fn of(mut parts: Vec<Part>) -> Self {
        parts.retain(|part| part.rate != 0.0);
        if parts.iter().any(|part| part.freedom != Freedom::Rotation) {
            parts.retain(|part| part.freedom != Freedom::Rotation);
        }
        let of_bodies = parts.chunk_by(|a, b| a.body == b.body);
        let size = |parts: &[Part]| parts.iter().map(|part| part.rate * part.rate).sum::<f64>();
        Self {
            bodies: of_bodies.clone().count(),
            size: of_bodies.map(|parts| size(parts).sqrt()).sum(),
            work: parts.iter().map(|part| part.rate * part.with).sum(),
        }
    }
}

/// Where a load step starts and ends, in x.
pub fn ends(program: &Program, load_step: &LoadStep) -> [f64; 2] {
    if load_step.is_common(program) {
        load_step.load_factor
    } else {
        [0.0, 1.0]
    }
}

/// The largest size of x in a load step.
pub fn farthest(program: &Program, load_step: &LoadStep) -> f64 {
    let [start, target] = ends(program, load_step);
    start.abs().max(target.abs())
}

/// Factor of each action, and the load factor, as lines.
fn lines(program: &Program, load_step: &LoadStep) -> (Vec<[f64; 2]>, [f64; 2]) {
    let driven = &program.stages[load_step.stage].actions;
    if load_step.is_common(program) {
        let line = |(action, &from)| {
            if driven.contains(&action) {
                [0.0, 1.0]
            } else {
                [from, 0.0]
            }
        };
        let factors = load_step.from.iter().enumerate().map(line);
        return (factors.collect(), [0.0, 1.0]);
    }
    let between = |(&from, &to): (&f64, &f64)| [from, to - from];
    let factors = load_step.from.iter().zip(&load_step.to).map(between);
    let [from, to] = load_step.load_factor;
    (factors.collect(), [from, to - from])
}
