//! The table `cracks`: a row a crack at a recorded load step.

use kavics::measure::Crack;

use crate::column::{Column, Unit};

/// A row of `cracks`.
#[derive(Clone, Debug, PartialEq)]
pub struct CrackRow {
    /// Load step.
    pub step: usize,
    /// Number at this load step.
    pub number: usize,
    /// The crack.
    pub crack: Crack,
}

/// A row for each crack of a load step.
pub(crate) fn crack_rows(step: usize, cracks: Vec<Crack>) -> Vec<CrackRow> {
    let row = |(number, crack)| CrackRow {
        step,
        number,
        crack,
    };
    cracks.into_iter().enumerate().map(row).collect()
}

/// The columns of `cracks`, in their order.
pub(crate) fn crack_columns() -> Vec<Column<CrackRow>> {
    use Unit::{Dimensionless, Length};
    vec![
        Column::integer("step", |r: &CrackRow| r.step as i64),
        Column::integer("crack", |r: &CrackRow| r.number as i64),
        Column::integer("contacts", |r: &CrackRow| r.crack.contacts.len() as i64),
        Column::number("length", Length, |r: &CrackRow| r.crack.length),
        Column::number("extent", Length, |r: &CrackRow| r.crack.extent),
        Column::number("x", Length, |r: &CrackRow| r.crack.centroid.x),
        Column::number("y", Length, |r: &CrackRow| r.crack.centroid.y),
        Column::number("direction", Dimensionless, |r: &CrackRow| {
            r.crack.orientation
        }),
    ]
}
