//! The table `modes`: a row a grain and mode at a recorded load step.

use kavics::assembly::{Assembly, Partner};
use kavics::equilibrium::{Displacement, Stability};
use kavics::ids::Id;

use crate::column::{Column, Unit};

/// A row of `modes`.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeRow {
    /// Load step.
    pub step: usize,
    /// Number of the mode, from 0, eigenvalues rising.
    pub mode: usize,
    /// Its eigenvalue.
    pub eigenvalue: f64,
    /// How many bodies take part in it.
    pub participation: f64,
    /// Id of the grain.
    pub grain: usize,
    /// Displacement of the grain in the mode, the largest amplitude of a body 1.
    pub displacement: Displacement,
}

/// A row for each mode and grain of a load step.
pub(crate) fn mode_rows(step: usize, assembly: &Assembly, stability: &Stability) -> Vec<ModeRow> {
    let mut rows = Vec::new();
    for (number, mode) in stability.modes.iter().enumerate() {
        rows.extend(assembly.grains.ids().map(|grain| ModeRow {
            step,
            mode: number,
            eigenvalue: mode.eigenvalue,
            participation: mode.participation,
            grain: grain.index(),
            displacement: mode.displacements[assembly.body(Partner::Grain(grain))],
        }));
    }
    rows
}

/// The columns of `modes`, in their order.
pub(crate) fn mode_columns() -> Vec<Column<ModeRow>> {
    use Unit::{Dimensionless, PerLength, Stiffness};
    vec![
        Column::integer("step", |r: &ModeRow| r.step as i64),
        Column::integer("mode", |r: &ModeRow| r.mode as i64),
        Column::number("eigenvalue", Stiffness, |r: &ModeRow| r.eigenvalue),
        Column::number("participation", Dimensionless, |r: &ModeRow| {
            r.participation
        }),
        Column::integer("grain", |r: &ModeRow| r.grain as i64),
        Column::number("ux", Dimensionless, |r: &ModeRow| r.displacement.x),
        Column::number("uy", Dimensionless, |r: &ModeRow| r.displacement.y),
        Column::number("rotation", PerLength, |r: &ModeRow| r.displacement.rotation),
    ]
}
