//! The table `sides`: a row a side that grains can touch, at a recorded load step.

use kavics::equilibrium::{Displacement, Load};

use crate::column::{Column, Unit};

/// A row of `sides`.
#[derive(Clone, Debug, PartialEq)]
pub struct SideRow {
    /// Load step.
    pub step: usize,
    /// Id; left, right, bottom, top of a box are 0, 1, 2, 3.
    pub id: usize,
    /// Name.
    pub name: String,
    /// Displacement of its middle, and its rotation.
    pub displacement: Displacement,
    /// External load and reaction together; the moment is about the middle.
    pub load: Load,
}

/// The columns of `sides`, in their order.
pub(crate) fn side_columns() -> Vec<Column<SideRow>> {
    use Unit::{Dimensionless, Force, ForceLength, Length};
    vec![
        Column::integer("step", |r: &SideRow| r.step as i64),
        Column::integer("side", |r: &SideRow| r.id as i64),
        Column::text("name", |r: &SideRow| Some(&r.name)),
        Column::number("ux", Length, |r: &SideRow| r.displacement.x),
        Column::number("uy", Length, |r: &SideRow| r.displacement.y),
        Column::number("rotation", Dimensionless, |r: &SideRow| {
            r.displacement.rotation
        }),
        Column::number("fx", Force, |r: &SideRow| r.load.x),
        Column::number("fy", Force, |r: &SideRow| r.load.y),
        Column::number("moment", ForceLength, |r: &SideRow| r.load.moment),
    ]
}
