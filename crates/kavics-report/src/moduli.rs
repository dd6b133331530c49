//! The table of the moduli, and curves of stability and moduli.

use kavics::measure::ElasticityTensor;
use kavics_results::Columns;

use crate::ReportError;
use crate::curves::{Abscissa, Figure, column, figure};
use crate::number::{fixed, show};
use crate::page::Table;
use crate::plot::Series;

const ROWS: [&str; 3] = ["xx", "yy", "xy"];

/// Columns of the table behind load step and factor.
const NAMES: [&str; 14] = [
    "step",
    "load_factor",
    "C_xxxx",
    "C_xxyy",
    "C_xxxy",
    "C_yyyy",
    "C_yyxy",
    "C_xyxy",
    "bulk",
    "of_Voigt",
    "shear",
    "of_Voigt",
    "Poisson",
    "anisotropy",
];

/// Whether the run asked for what stands in a column.
fn is_there(steps: &Columns, name: &str) -> Result<bool, ReportError> {
    let known = steps.names().contains(&name);
    Ok(known && steps.numbers(name)?.iter().any(|value| value.is_finite()))
}

/// The moduli at each load step beside their bound; empty where there are none.
pub(crate) fn table(steps: &Columns) -> Result<Table, ReportError> {
    if !is_there(steps, "modulus_xxxx")? {
        return Ok(Table::default());
    }
    let (tangent, voigt) = (tensors(steps, "modulus")?, tensors(steps, "voigt_modulus")?);
    let (numbers, factors) = (steps.numbers("step")?, steps.numbers("load_factor")?);
    let row = |row: usize| {
        let (moduli, bound) = (&tangent[row], &voigt[row]);
        let c = moduli.symmetric().rows;
        let share = |value: f64, bound: f64| fixed(value / bound, 3);
        vec![
            show(numbers[row]),
            show(factors[row]),
            show(c[0][0]),
            show(c[0][1]),
            show(c[0][2]),
            show(c[1][1]),
            show(c[1][2]),
            show(c[2][2]),
            show(moduli.bulk_modulus()),
            share(moduli.bulk_modulus(), bound.bulk_modulus()),
            show(moduli.shear_modulus()),
            share(moduli.shear_modulus(), bound.shear_modulus()),
            fixed(moduli.poisson_ratio(), 3),
            fixed(moduli.anisotropy().unwrap_or(f64::NAN), 3),
        ]
    };
    Ok(Table {
        names: NAMES.to_vec(),
        rows: (0..steps.len()).map(row).collect(),
        left_out: 0,
    })
}

fn tensors(steps: &Columns, prefix: &str) -> Result<Vec<ElasticityTensor>, ReportError> {
    let mut tensors = vec![ElasticityTensor::default(); steps.len()];
    for (i, stress) in ROWS.iter().enumerate() {
        for (j, strain) in ROWS.iter().enumerate() {
            let values = steps.numbers(&format!("{prefix}_{stress}{strain}"))?;
            for (tensor, value) in tensors.iter_mut().zip(values) {
                tensor.rows[i][j] = value;
            }
        }
    }
    Ok(tensors)
}

/// Curves of what the run asked for.
pub(crate) fn figures(steps: &Columns, over: &Abscissa) -> Result<Vec<Figure>, ReportError> {
    let mut figures = Vec::new();
    if is_there(steps, "zero_eigenvalues")? {
        figures.extend(stability(steps, over)?);
    }
    if is_there(steps, "modulus_xxxx")? {
        figures.push(moduli(steps, over)?);
        let anisotropy = column(steps, over, "modulus_anisotropy", "anisotropy", 3)?;
        let label = "distance from isotropic";
        figures.push(figure(
            "Anisotropy of the moduli",
            over.label,
            label,
            &[anisotropy],
        ));
    }
    Ok(figures)
}

fn stability(steps: &Columns, over: &Abscissa) -> Result<Vec<Figure>, ReportError> {
    let one = |name: &str, title: &str, label: &str, colour| -> Result<Figure, ReportError> {
        let series = column(steps, over, name, title, colour)?;
        Ok(figure(title, over.label, label, &[series]))
    };
    let negative = column(steps, over, "negative_eigenvalues", "negative", 1)?;
    let zero = column(steps, over, "zero_eigenvalues", "zero", 0)?;
    let mut figures = vec![one(
        "lowest_eigenvalue",
        "Lowest eigenvalue",
        "force / length",
        0,
    )?];
    if [&negative, &zero]
        .iter()
        .any(|series| series.points.iter().any(|&(_, y)| y > 0.0))
    {
        let counts = [zero, negative];
        figures.push(figure(
            "Eigenvalues not above zero",
            over.label,
            "how many",
            &counts,
        ));
    }
    figures.push(one(
        "second_order_work",
        "Second-order work of the step",
        "force × length",
        2,
    )?);
    figures.push(one(
        "static_indeterminacy",
        "Static indeterminacy",
        "force components",
        4,
    )?);
    Ok(figures)
}

/// Bulk and shear modulus with their bounds.
fn moduli(steps: &Columns, over: &Abscissa) -> Result<Figure, ReportError> {
    let (tangent, voigt) = (tensors(steps, "modulus")?, tensors(steps, "voigt_modulus")?);
    let line = |name: &str,
                tensors: &[ElasticityTensor],
                read: fn(&ElasticityTensor) -> f64,
                colour,
                dashed| Series {
        name: name.to_owned(),
        points: over.with(&tensors.iter().map(read).collect::<Vec<_>>()),
        colour,
        dashed,
        marked: true,
    };
    let series = [
        line("bulk", &tangent, ElasticityTensor::bulk_modulus, 0, false),
        line(
            "bulk, Voigt",
            &voigt,
            ElasticityTensor::bulk_modulus,
            0,
            true,
        ),
        line("shear", &tangent, ElasticityTensor::shear_modulus, 1, false),
        line(
            "shear, Voigt",
            &voigt,
            ElasticityTensor::shear_modulus,
            1,
            true,
        ),
    ];
    Ok(figure(
        "Bulk and shear modulus",
        over.label,
        "force / length²",
        &series,
    ))
}
