//! Equilibrium of an assembly under given loads: kinematics, residual, tangent, Newton, linear solver.
//!
//! In: an assembly, contact states, loads and prescribed displacements. Out: displacements and contact forces.

mod balance;
mod block_stiffness;
pub(crate) mod bond;
pub(crate) mod configuration;
pub(crate) mod configuration_memory;
pub(crate) mod elastic;
mod elimination;
mod error;
mod iterative;
pub(crate) mod kept;
mod kinematics;
mod large_motion;
mod linear;
pub(crate) mod memory;
mod search;
pub(crate) mod side_sums;
mod sparsity;
mod stability;
pub(crate) mod steered;
pub(crate) mod system;
mod tangent;
mod watch;

pub use error::SolveError;
pub use kinematics::{ALL_FREEDOMS, ContactFrame, FREEDOMS, Place, centre, contact_place};
pub use large_motion::{LargeMotion, Motion, SMALL_MOTION};
pub use memory::{Memory, MemoryColumn, MemoryError};
pub use stability::{EigenMode, Stability, StabilitySummary, ZERO_EIGENVALUE, second_order_work};
pub use tangent::relax;
pub use watch::{Glance, Watch};

use crate::contact_law::{ContactForce, Matrix, Mode, Phase, RelativeDisplacement};
use crate::ids::{ContactId, GrainId, PerBody, PerContact, PerGrain, PropertyId};
use crate::warning::WarningKind;

/// Displacement of a grain or side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Displacement {
    /// To the right, `[length]`.
    pub x: f64,
    /// Upwards, `[length]`.
    pub y: f64,
    /// Rotation, counter-clockwise, dimensionless.
    pub rotation: f64,
}

/// Load on a grain or side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// To the right, `[force]`.
    pub x: f64,
    /// Upwards, `[force]`.
    pub y: f64,
    /// Moment about the reference point, counter-clockwise, `[force·length]`.
    pub moment: f64,
}

/// A freedom of a grain or side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Freedom {
    /// Displacement to the right.
    X,
    /// Displacement upwards.
    Y,
    /// Rotation.
    Rotation,
}

/// Which stiffness the iteration uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Iteration {
    /// The secant Q/v: symmetric, LDLᵀ.
    #[default]
    Secant,
    /// The tangent ∂Q/∂v: unsymmetric in general, LU.
    Tangent,
}

/// How linear systems are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SolverChoice {
    /// By iteration where there are many unknowns, else directly.
    #[default]
    Auto,
    /// By a factor: LDLᵀ, or LU where the tangent is not symmetric.
    Direct,
    /// By conjugate gradients with multigrid; by their stabilised biconjugate form where the tangent is not symmetric.
    Iterative,
}

/// How equilibria are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Bound on the residual.
    pub tolerance: f64,
    /// Which stiffness the iteration uses.
    pub iteration: Iteration,
    /// How linear systems are solved.
    pub solver: SolverChoice,
    /// Relative difference of utilisations below which contacts break together.
    pub tie_tolerance: f64,
    /// Bound on the error of work and energies in a load step, relative to the work in it.
    pub work_tolerance: f64,
    /// Whether the iterates are kept beside the equilibria.
    pub keep_iterates: bool,
    /// How many of the lowest modes of the tangent come with each equilibrium; with 0 its stability is not sought.
    pub modes: usize,
    /// Whether the tangents of the contacts come with each equilibrium.
    pub keep_tangents: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-10,
            iteration: Iteration::Secant,
            solver: SolverChoice::Auto,
            tie_tolerance: 1e-9,
            work_tolerance: 1e-6,
            keep_iterates: false,
            modes: 0,
            keep_tangents: false,
        }
    }
}

/// What has happened to a grain or contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Iteration of the load step after which it happened.
    pub iteration: usize,
    /// Load factor at which it happened.
    pub load_factor: f64,
    /// What it happened to, and what.
    pub kind: EventKind,
    /// Number of the avalanche it belongs to, over the whole run; only with event-driven breakage: events between
    /// two new maxima of the load factor.
    pub avalanche: Option<usize>,
    /// How far what drives the load path had gone; only of breaks with event-driven breakage where loads alone or moves
    /// alone drive it, from zero.
    pub drive: Option<Drive>,
}

/// How far the loads or moves that drive the load path have gone, and with what force: force times a small change of the
/// displacement is their work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Of loads: Σ f·u / Σ abs f, f the force on a body at factor 1; of moves: factor times the mean over the bodies of
    /// abs a, a the move of a body at factor 1, `[length]`; a rotation, where they are of these alone.
    pub displacement: f64,
    /// Of loads: factor times Σ abs f; of moves: Σ r·a over the mean abs a, r the reactions, `[force]`.
    pub force: f64,
}

/// The kinds of events.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EventKind {
    /// A bond broke.
    Broke {
        /// Which.
        contact: ContactId,
        /// The component that exceeded its limit.
        mode: Mode,
        /// Energy that the bond itself held less what its successor holds, `[force·length]`.
        fracture_energy: f64,
        /// Energy set free beyond that at fixed load, `[force·length]`.
        release_energy: f64,
    },
    /// A contact opened.
    Opened(ContactId),
    /// A contact closed.
    Closed(ContactId),
    /// A contact began to slide.
    Slid(ContactId),
    /// A sliding contact stuck.
    Stuck(ContactId),
    /// A grain that nothing holds and nothing loads was set aside.
    SetAside(GrainId),
    /// A grain that had been set aside is held or loaded again.
    TakenBack(GrainId),
}

/// The contact as it stands in a state of the assembly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactState {
    /// Relative displacement.
    pub displacement: RelativeDisplacement,
    /// Force.
    pub force: ContactForce,
    /// Its property now; none: broken into nothing.
    pub property: Option<PropertyId>,
    /// Whether a bond of it has broken.
    pub broken: bool,
    /// How it carries.
    pub phase: Phase,
}

impl ContactState {
    /// Whether the contact can carry a force in this state.
    pub fn is_active(&self) -> bool {
        self.property.is_some() && self.phase != Phase::Open
    }
}

/// Displacements and contacts of the assembly, in equilibrium or on the way to it.
#[derive(Clone, Debug, Default)]
pub struct State {
    /// Displacement of each grain and side.
    pub displacements: PerBody<Displacement>,
    /// Each contact.
    pub contacts: PerContact<ContactState>,
}

/// Work and energy since the start of the run, `[force·length]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Work of loads and moves.
    pub external_work: f64,
    /// Energy that the contacts hold now.
    pub elastic_energy: f64,
    /// Energy of bonds at the moment they broke, and what softening takes.
    pub fracture_energy: f64,
    /// Work of friction.
    pub friction_work: f64,
    /// Work that a law without potential took (positive) or gave (negative).
    pub nonpotential_work: f64,
    /// Energy set free at breakage beyond the bond's own.
    pub release_energy: f64,
}

impl Energy {
    /// External work less all it went into: rounding where stiffness is constant, else within the tolerance of work.
    pub fn ledger_error(&self) -> f64 {
        self.external_work
            - self.elastic_energy
            - self.fracture_energy
            - self.friction_work
            - self.nonpotential_work
            - self.release_energy
    }
}

/// A state on the way to an equilibrium.
#[derive(Clone, Debug)]
pub struct Iterate {
    /// Iteration of the load step, from 1.
    pub iteration: usize,
    /// Largest unbalanced force over largest contact force.
    pub residual: f64,
    /// Displacements and contacts.
    pub state: State,
    /// Load factor and energies since the start; only where the state is an equilibrium, after an event.
    pub ledger: Option<(f64, Energy)>,
}

/// Why linear systems are no more solved by iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Breakdown {
    /// The stiffness is not positive definite.
    NotPositive,
    /// The iteration gains no more.
    Stagnated,
}

/// Something that makes a result less than it seems, though the run goes on.
#[derive(Clone, Debug, PartialEq)]
pub enum Warning {
    /// Pivots of floppy modes that no load moves were held.
    RegularisedPivots {
        /// How many.
        count: usize,
    },
    /// Shear moduli were held at their floor.
    ShearFloor {
        /// In how many contacts.
        contacts: usize,
    },
    /// The solver that iterates failed: systems are solved directly from here on.
    SolvedDirectly {
        /// Why.
        breakdown: Breakdown,
    },
    /// Symmetric second-order work of a contact turned negative.
    SecondOrderWork {
        /// In how many contacts.
        contacts: usize,
    },
    /// Work and energies are not known to the wanted tolerance.
    WorkError {
        /// Estimate of the error over the work of the load step.
        relative: f64,
    },
    /// Nothing ties the loaded part to the supports any more; the path ends.
    Separated,
    /// The load step was taken in parts, as it did not go in one.
    StepCut {
        /// How often it was halved.
        cuts: usize,
    },
    /// More grains are set aside than before loading.
    SetAside {
        /// How many are now.
        grains: usize,
    },
    /// Contacts changed phase in circles before they settled.
    Chattered {
        /// How many contacts changed phase more than once.
        contacts: usize,
    },
    /// An iteration came near the limit at which it is given up.
    ManyIterations {
        /// How many there were.
        iterations: usize,
        /// How many there may be.
        limit: usize,
    },
    /// Modes were asked for and are not there.
    NoModes,
    /// Solved by iteration, which does not count the floppy modes that a factor would hold.
    FloppyModesUncounted,
    /// Displacements are not small against the branch lengths: results hold for the geometry of the start.
    LargeDisplacements(LargeMotion),
}

impl Warning {
    /// What it is about.
    pub fn kind(&self) -> WarningKind {
        match self {
            Self::RegularisedPivots { .. } => WarningKind::FloppyModesHeld,
            Self::ShearFloor { .. } => WarningKind::ShearFloor,
            Self::SolvedDirectly { .. } => WarningKind::SolvedDirectly,
            Self::SecondOrderWork { .. } => WarningKind::SecondOrderWork,
            Self::WorkError { .. } => WarningKind::WorkError,
            Self::Separated => WarningKind::Separated,
            Self::StepCut { .. } => WarningKind::StepCut,
            Self::SetAside { .. } => WarningKind::SetAside,
            Self::Chattered { .. } => WarningKind::Chattered,
            Self::ManyIterations { .. } => WarningKind::ManyIterations,
            Self::NoModes => WarningKind::NoModes,
            Self::FloppyModesUncounted => WarningKind::FloppyModesUncounted,
            Self::LargeDisplacements(_) => WarningKind::LargeDisplacements,
        }
    }
}

/// An equilibrium: the end of a load step, or the undeformed state as step 0.
#[derive(Clone, Debug, Default)]
pub struct Equilibrium {
    /// Load step, from 1; 0 before loading.
    pub step: usize,
    /// Index of the stage.
    pub stage: usize,
    /// Factor of the stage's actions; between two factors where a step could not be finished.
    pub load_factor: f64,
    /// False: the last equilibrium of a load step that could not be finished.
    pub complete: bool,
    /// Linear solves in this step, those for the work apart.
    pub iterations: usize,
    /// Linear solves for the work between equilibria, where stiffness depends on the state.
    pub work_iterations: usize,
    /// Largest unbalanced force over largest contact force.
    pub residual: f64,
    /// How often the step was halved.
    pub cuts: usize,
    /// Displacements and contacts.
    pub state: State,
    /// External load on each body, loads of all actions together.
    pub loads: PerBody<Load>,
    /// Reaction at held and moved freedoms; zero elsewhere.
    pub reactions: PerBody<Load>,
    /// Grains set aside: nothing holds and nothing loads them.
    pub set_aside: PerGrain<bool>,
    /// Work and energy.
    pub energy: Energy,
    /// What happened in this step, in order.
    pub events: Vec<Event>,
    /// What the user should know.
    pub warnings: Vec<Warning>,
    /// The way to it, when asked for.
    pub iterates: Vec<Iterate>,
    /// Its stability, when asked for; none before loading, and where the modes were not found.
    pub stability: Option<Stability>,
    /// ∂Q/∂v of each contact, rows normal, shear, moment, columns opening, shear, rotation, when asked for.
    pub tangents: Option<PerContact<Matrix>>,
}
