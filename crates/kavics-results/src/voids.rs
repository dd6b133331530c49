//! The table `voids`: a row a void cell at a recorded load step.

use kavics::measure::{VoidCell, VoidCells};

use crate::column::{Column, Unit};

/// A row of `voids`.
#[derive(Clone, Debug, PartialEq)]
pub struct VoidRow {
    /// Load step.
    pub step: usize,
    /// Number at this load step.
    pub number: usize,
    /// The void cell.
    pub cell: VoidCell,
}

/// A row for each void cell of a load step.
pub(crate) fn void_rows(step: usize, cells: &VoidCells) -> Vec<VoidRow> {
    let row = |(number, &cell): (usize, &VoidCell)| VoidRow { step, number, cell };
    cells.cells.iter().enumerate().map(row).collect()
}

/// The columns of `voids`, in their order.
pub(crate) fn void_columns() -> Vec<Column<VoidRow>> {
    use Unit::{Area, Dimensionless, Length};
    vec![
        Column::integer("step", |r: &VoidRow| r.step as i64),
        Column::integer("void", |r: &VoidRow| r.number as i64),
        Column::number("x", Length, |r: &VoidRow| r.cell.centroid.x),
        Column::number("y", Length, |r: &VoidRow| r.cell.centroid.y),
        Column::integer("order", |r: &VoidRow| r.cell.order as i64),
        Column::number("area", Area, |r: &VoidRow| r.cell.area),
        Column::number("void_area", Area, |r: &VoidRow| r.cell.void_area),
        Column::integer("islands", |r: &VoidRow| r.cell.islands as i64),
        Column::integer("rattlers", |r: &VoidRow| r.cell.rattlers as i64),
        Column::number("shape_xx", Dimensionless, |r: &VoidRow| r.cell.shape.xx),
        Column::number("shape_xy", Dimensionless, |r: &VoidRow| r.cell.shape.xy),
        Column::number("shape_yy", Dimensionless, |r: &VoidRow| r.cell.shape.yy),
        Column::number("anisotropy", Dimensionless, |r: &VoidRow| {
            r.cell.shape.deviator()
        }),
        Column::number("direction", Dimensionless, |r: &VoidRow| {
            r.cell.shape.principal_direction()
        }),
    ]
}
