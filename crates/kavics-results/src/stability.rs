//! Stability and moduli among the columns of `steps`.

use kavics::equilibrium::StabilitySummary;
use kavics::measure::{ElasticityTensor, Moduli};

use crate::column::{Column, Unit};
use crate::steps::{StepRow, measure};

/// Components of the moduli, by row and column of the tensor.
const COMPONENTS: [(&str, usize, usize); 9] = [
    ("xxxx", 0, 0),
    ("xxyy", 0, 1),
    ("xxxy", 0, 2),
    ("yyxx", 1, 0),
    ("yyyy", 1, 1),
    ("yyxy", 1, 2),
    ("xyxx", 2, 0),
    ("xyyy", 2, 1),
    ("xyxy", 2, 2),
];

pub(crate) fn stability_columns() -> Vec<Column<StepRow>> {
    let count = |name: &str, read: fn(&StabilitySummary) -> i64| {
        Column::maybe_integer(name, move |r: &StepRow| r.stability.as_ref().map(read))
    };
    vec![
        Column::maybe_number("lowest_eigenvalue", Unit::Stiffness, |r: &StepRow| {
            r.stability.and_then(|s| s.lowest_eigenvalue)
        }),
        count("negative_eigenvalues", |s| s.negative_eigenvalues as i64),
        count("zero_eigenvalues", |s| s.zero_eigenvalues as i64),
        count("static_indeterminacy", |s| s.static_indeterminacy),
        Column::maybe_number("second_order_work", Unit::ForceLength, |r: &StepRow| {
            r.stability.map(|s| s.second_order_work)
        }),
    ]
}

pub(crate) fn moduli_columns() -> Vec<Column<StepRow>> {
    let mut columns = components("modulus", |moduli| &moduli.tangent);
    columns.extend(components("voigt_modulus", |moduli| &moduli.voigt));
    columns.extend([
        measure("bulk_modulus", Unit::Stress, |m| {
            m.moduli.map(|moduli| moduli.tangent.bulk_modulus())
        }),
        measure("shear_modulus", Unit::Stress, |m| {
            m.moduli.map(|moduli| moduli.tangent.shear_modulus())
        }),
        measure("modulus_anisotropy", Unit::Dimensionless, |m| {
            m.moduli.and_then(|moduli| moduli.tangent.anisotropy())
        }),
        measure("modulus_asymmetry", Unit::Dimensionless, |m| {
            m.moduli.and_then(|moduli| moduli.tangent.asymmetry())
        }),
    ]);
    columns
}

fn components(prefix: &str, read: fn(&Moduli) -> &ElasticityTensor) -> Vec<Column<StepRow>> {
    let column = |(name, i, j): (&str, usize, usize)| {
        Column::maybe_number(
            &format!("{prefix}_{name}"),
            Unit::Stress,
            move |row: &StepRow| row.measures.moduli.as_ref().map(|m| read(m).rows[i][j]),
        )
    };
    COMPONENTS.map(column).into()
}
