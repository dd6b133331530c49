//! What is held, moved and loaded, and in which order.

use crate::equilibrium::{Freedom, Load};
use crate::ids::BodyId;

/// A freedom that never moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Held {
    /// Grain or side.
    pub body: BodyId,
    /// Which of its freedoms.
    pub freedom: Freedom,
}

/// A freedom that follows a move: its value is `amplitude` times the factor of the action.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prescribed {
    /// Grain or side.
    pub body: BodyId,
    /// Which of its freedoms.
    pub freedom: Freedom,
    /// Value at factor 1, `[length]` or dimensionless.
    pub amplitude: f64,
    /// Index into [`Program::actions`].
    pub action: usize,
}

/// A load on a body: `load` times the factor of the action.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AppliedLoad {
    /// Grain or side.
    pub body: BodyId,
    /// Load at factor 1.
    pub load: Load,
    /// Index into [`Program::actions`].
    pub action: usize,
}

/// Something that stages drive by a factor: a named load, a named move, or the weight.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Action {
    /// Name in the scene; `weight` for the weight.
    pub name: String,
}

/// A part of the load path: some actions take a series of factors, the others keep their last value.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Name in the results.
    pub name: String,
    /// Indices into [`Program::actions`].
    pub actions: Vec<usize>,
    /// The factor at the end of each load step.
    pub factors: Vec<f64>,
}

/// When contacts break.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Breakage {
    /// The contact with the highest utilisation breaks (with its ties), then equilibrium is found again.
    #[default]
    WorstFirst,
    /// All contacts beyond their limits break, then equilibrium is found again.
    Simultaneous,
    /// One after the other, each at the factor at which it reaches its limit; the factor may fall.
    EventDriven,
}

/// All that acts on an assembly from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// What the stages drive.
    pub actions: Vec<Action>,
    /// Freedoms that never move. No freedom stands both here and in `prescribed`, none twice.
    pub held: Vec<Held>,
    /// Freedoms that follow a move.
    pub prescribed: Vec<Prescribed>,
    /// Loads.
    pub loads: Vec<AppliedLoad>,
    /// The stages in order.
    pub stages: Vec<Stage>,
}
