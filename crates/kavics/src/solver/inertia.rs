//! Signs of the pivots.

/// How many pivots of LDLᵀ are positive, negative, and held in place of zero.
///
/// By Sylvester's law of inertia these are the numbers of positive, negative and vanishing eigenvalues of the matrix, as
/// long as no held pivot hides a growth of the factor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inertia {
    /// Positive pivots that are not held.
    pub positive: usize,
    /// Negative pivots that are not held.
    pub negative: usize,
    /// Pivots that vanished: floppy modes.
    pub held: usize,
}

/// A scaled pivot not above this, positive or negative, is that of a floppy mode.
pub(super) const FLOPPY: f64 = 1e-13;
/// What such a pivot is set to, with its sign; no pivot of a stiffness has just this value.
pub(super) const HELD_PIVOT: f64 = 1.234_567_890_123_456_7;

impl Inertia {
    /// Counts the pivots.
    pub(super) fn of(pivots: impl Iterator<Item = f64>) -> Self {
        pivots.fold(Self::default(), |mut inertia, pivot| {
            if pivot.abs() == HELD_PIVOT {
                inertia.held += 1;
            } else if pivot > 0.0 {
                inertia.positive += 1;
            } else {
                inertia.negative += 1;
            }
            inertia
        })
    }
}
