//! The table `grains`: a row a grain at a recorded load step.

use kavics::assembly::Grain;
use kavics::equilibrium::{Displacement, Load};
use kavics::measure::Tensor;

use crate::column::{Column, Unit};

/// A row of `grains`.
#[derive(Clone, Debug, PartialEq)]
pub struct GrainRow {
    /// Load step.
    pub step: usize,
    /// Id.
    pub id: usize,
    /// The disc before loading.
    pub grain: Grain,
    /// Its displacement.
    pub displacement: Displacement,
    /// External load and reaction together.
    pub load: Load,
    /// Active contacts.
    pub contacts: usize,
    /// Area of its power cell, `[length²]`.
    pub cell_area: f64,
    /// Average stress over its power cell.
    pub stress: Tensor,
    /// `held`, `free`, `rattler` or `loose`.
    pub state: &'static str,
    /// Whether it is measured.
    pub in_window: bool,
}

/// The columns of `grains`, in their order.
pub(crate) fn grain_columns() -> Vec<Column<GrainRow>> {
    use Unit::{Area, Dimensionless, Force, ForceLength, Length, Stress};
    vec![
        Column::integer("step", |r: &GrainRow| r.step as i64),
        Column::integer("grain", |r: &GrainRow| r.id as i64),
        Column::number("x", Length, |r: &GrainRow| r.grain.centre.x),
        Column::number("y", Length, |r: &GrainRow| r.grain.centre.y),
        Column::number("radius", Length, |r: &GrainRow| r.grain.radius),
        Column::number("ux", Length, |r: &GrainRow| r.displacement.x),
        Column::number("uy", Length, |r: &GrainRow| r.displacement.y),
        Column::number("rotation", Dimensionless, |r: &GrainRow| {
            r.displacement.rotation
        }),
        Column::number("fx", Force, |r: &GrainRow| r.load.x),
        Column::number("fy", Force, |r: &GrainRow| r.load.y),
        Column::number("moment", ForceLength, |r: &GrainRow| r.load.moment),
        Column::integer("contacts", |r: &GrainRow| r.contacts as i64),
        Column::number("cell_area", Area, |r: &GrainRow| r.cell_area),
        Column::number("stress_xx", Stress, |r: &GrainRow| r.stress.xx),
        Column::number("stress_xy", Stress, |r: &GrainRow| r.stress.xy),
        Column::number("stress_yx", Stress, |r: &GrainRow| r.stress.yx),
        Column::number("stress_yy", Stress, |r: &GrainRow| r.stress.yy),
        Column::text("state", |r: &GrainRow| Some(r.state)),
        Column::integer("window", |r: &GrainRow| i64::from(r.in_window)),
    ]
}
