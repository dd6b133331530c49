//! The kinds of warnings: every way in which a result may be less than it seems.

use std::fmt;

/// What a warning is about. Its name stands in brackets behind the warning's text, and heads its section in
/// `docs/warnings.md`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum WarningKind {
    /// No stage applies a load or a move.
    ActionUnused,
    /// The table that the run is compared with says more, or less, than the run.
    ComparedTable,
    /// Contacts changed phase again and again before they settled.
    Chattered,
    /// Dual lengths are capped.
    DualLengthCapped,
    /// The iterative solver cannot count floppy modes.
    FloppyModesUncounted,
    /// Floppy modes that no load moves were held in place.
    FloppyModesHeld,
    /// Displacements are not small against the branch lengths.
    LargeDisplacements,
    /// No grain is met over a part of a loaded side.
    LoadUncovered,
    /// An iteration came near its limit.
    ManyIterations,
    /// The lowest modes asked for were not found.
    NoModes,
    /// The moduli asked for do not exist.
    NoModuli,
    /// Without friction the shear force jumps where a contact opens.
    NoFriction,
    /// The run is under way, or was broken off.
    RunUnfinished,
    /// The second-order work of a contact is negative.
    SecondOrderWork,
    /// The path ends, as the assembly came apart.
    Separated,
    /// Grains that nothing holds and nothing loads were set aside.
    SetAside,
    /// A shear modulus may fall to zero.
    ShearMayVanish,
    /// Shear moduli were held at their floor.
    ShearFloor,
    /// Grains near a side are not joined to it.
    SideHidden,
    /// No grain touches a side.
    SideUntouched,
    /// Systems were solved directly instead of by iteration.
    SolvedDirectly,
    /// A load step was taken in parts.
    StepCut,
    /// The window touches what is held, moved or loaded.
    WindowAtBoundary,
    /// The window holds no grain.
    WindowEmpty,
    /// Work and energies are not known to the wanted tolerance.
    WorkError,
    /// A zone holds no contact.
    ZoneEmpty,
}

impl WarningKind {
    /// Every kind.
    pub const ALL: [Self; 26] = [
        Self::ActionUnused,
        Self::ComparedTable,
        Self::Chattered,
        Self::DualLengthCapped,
        Self::FloppyModesUncounted,
        Self::FloppyModesHeld,
        Self::LargeDisplacements,
        Self::LoadUncovered,
        Self::ManyIterations,
        Self::NoModes,
        Self::NoModuli,
        Self::NoFriction,
        Self::RunUnfinished,
        Self::SecondOrderWork,
        Self::Separated,
        Self::SetAside,
        Self::ShearMayVanish,
        Self::ShearFloor,
        Self::SideHidden,
        Self::SideUntouched,
        Self::SolvedDirectly,
        Self::StepCut,
        Self::WindowAtBoundary,
        Self::WindowEmpty,
        Self::WorkError,
        Self::ZoneEmpty,
    ];

    /// Its name, as users see it.
    pub fn name(self) -> &'static str {
        match self {
            Self::ActionUnused => "action-unused",
            Self::ComparedTable => "compared-table",
            Self::Chattered => "chattered",
            Self::DualLengthCapped => "dual-length-capped",
            Self::FloppyModesUncounted => "floppy-modes-uncounted",
            Self::FloppyModesHeld => "floppy-modes-held",
            Self::LargeDisplacements => "large-displacements",
            Self::LoadUncovered => "load-uncovered",
            Self::ManyIterations => "many-iterations",
            Self::NoModes => "no-modes",
            Self::NoModuli => "no-moduli",
            Self::NoFriction => "no-friction",
            Self::RunUnfinished => "run-unfinished",
            Self::SecondOrderWork => "second-order-work",
            Self::Separated => "separated",
            Self::SetAside => "set-aside",
            Self::ShearMayVanish => "shear-may-vanish",
            Self::ShearFloor => "shear-floor",
            Self::SideHidden => "side-hidden",
            Self::SideUntouched => "side-untouched",
            Self::SolvedDirectly => "solved-directly",
            Self::StepCut => "step-cut",
            Self::WindowAtBoundary => "window-at-boundary",
            Self::WindowEmpty => "window-empty",
            Self::WorkError => "work-error",
            Self::ZoneEmpty => "zone-empty",
        }
    }

    /// A warning as users see it: what it says, and its kind in brackets.
    pub fn says(self, what: impl fmt::Display) -> String {
        format!("{what} [{}]", self.name())
    }
}
