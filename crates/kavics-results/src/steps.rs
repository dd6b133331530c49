//! The table `steps`: a row a load step; and `iterations`, the same for each iterate.

use std::path::Path;

use kavics::equilibrium::{Energy, StabilitySummary};
use kavics::measure::{Measures, StressPartition, SymmetricTensor, Tensor};

use crate::column::{AsObject, Column, Unit};
use crate::encode::{Format, publish, publish_table};
use crate::stability::{moduli_columns, stability_columns};
use crate::{Columns, ResultsError, ResultsFolder};

/// A row of `steps`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepRow {
    /// Load step, from 1.
    pub step: usize,
    /// Name of the stage.
    pub stage: String,
    /// Factor of the stage's actions.
    pub load_factor: f64,
    /// Linear solves.
    pub iterations: usize,
    /// Largest unbalanced force over largest contact force.
    pub residual: f64,
    /// How often the step was halved.
    pub cuts: usize,
    /// Active contacts.
    pub contacts: usize,
    /// Bonds broken so far.
    pub broken: usize,
    /// Bonds broken in this step.
    pub broken_in_step: usize,
    /// Grains without an active contact.
    pub rattlers: usize,
    /// The measures of the window.
    pub measures: Measures,
    /// Work and energy; none on the way to an equilibrium.
    pub energy: Option<Energy>,
    /// Stability; none where it was not sought.
    pub stability: Option<StabilitySummary>,
    /// Iteration, where the row is an iterate.
    pub iteration: Option<usize>,
}

impl StepRow {
    /// The row as one JSON object, keys in the order of the columns of `steps`.
    pub fn to_json(&self) -> String {
        let columns = step_columns();
        let object = AsObject {
            columns: &columns,
            row: self,
        };
        serde_json::to_string(&object).expect("numbers and words are JSON")
    }
}

impl ResultsFolder {
    /// The rows of `steps` without their measures.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub fn step_rows(&self) -> Result<Vec<StepRow>, ResultsError> {
        rows_without_measures(&self.steps()?)
    }
}

fn rows_without_measures(table: &Columns) -> Result<Vec<StepRow>, ResultsError> {
    let stage = table.texts("stage")?;
    let mut rows = vec![StepRow::default(); table.len()];
    for (row, stage) in rows.iter_mut().zip(stage) {
        stage.clone_into(&mut row.stage);
        row.energy = Some(Energy::default());
    }
    fill(&mut rows, table, "load_factor", |row| &mut row.load_factor)?;
    fill(&mut rows, table, "residual", |row| &mut row.residual)?;
    for (name, field) in COUNTS {
        for (row, value) in rows.iter_mut().zip(table.integers(name)?) {
            *field(row) = value.and_then(|v| usize::try_from(v).ok()).unwrap_or(0);
        }
    }
    for (name, field) in ENERGIES {
        for (row, value) in rows.iter_mut().zip(table.numbers(name)?) {
            if let Some(energy) = &mut row.energy {
                *field(energy) = value;
            }
        }
    }
    Ok(rows)
}

/// The rows of `steps` with the stress and its parts, and no other measures.
pub(crate) fn rows_with_stress(table: &Columns) -> Result<Vec<StepRow>, ResultsError> {
    let mut rows = rows_without_measures(table)?;
    for (row, isotropic) in rows.iter_mut().zip(table.numbers("isotropic_stress")?) {
        row.measures.stress = (!isotropic.is_nan()).then(|| StressPartition {
            isotropic,
            ..StressPartition::default()
        });
    }
    for (prefix, tensor) in STRESSES {
        for (name, component) in COMPONENTS {
            let values = table.numbers(&format!("{prefix}_{name}"))?;
            for (row, value) in rows.iter_mut().zip(values) {
                if let Some(stress) = &mut row.measures.stress {
                    *component(tensor(stress)) = value;
                }
            }
        }
    }
    Ok(rows)
}

const STRESSES: [Field<StressPartition, Tensor>; 4] = [
    ("stress", |p| &mut p.total),
    ("shear_stress", |p| &mut p.shear),
    ("variation_stress", |p| &mut p.variation),
    ("fabric_stress", |p| &mut p.fabric),
];

const COMPONENTS: [Field<Tensor, f64>; 4] = [
    ("xx", |t| &mut t.xx),
    ("xy", |t| &mut t.xy),
    ("yx", |t| &mut t.yx),
    ("yy", |t| &mut t.yy),
];

type Field<R, T> = (&'static str, fn(&mut R) -> &mut T);

const COUNTS: [Field<StepRow, usize>; 7] = [
    ("step", |r| &mut r.step),
    ("iterations", |r| &mut r.iterations),
    ("cuts", |r| &mut r.cuts),
    ("contacts", |r| &mut r.contacts),
    ("broken", |r| &mut r.broken),
    ("broken_in_step", |r| &mut r.broken_in_step),
    ("rattlers", |r| &mut r.rattlers),
];

const ENERGIES: [Field<Energy, f64>; 6] = [
    ("external_work", |e| &mut e.external_work),
    ("elastic_energy", |e| &mut e.elastic_energy),
    ("fracture_energy", |e| &mut e.fracture_energy),
    ("friction_work", |e| &mut e.friction_work),
    ("nonpotential_work", |e| &mut e.nonpotential_work),
    ("release_energy", |e| &mut e.release_energy),
];

fn fill(
    rows: &mut [StepRow],
    table: &Columns,
    name: &str,
    field: fn(&mut StepRow) -> &mut f64,
) -> Result<(), ResultsError> {
    for (row, value) in rows.iter_mut().zip(table.numbers(name)?) {
        *field(row) = value;
    }
    Ok(())
}

/// The columns of `steps`, in their order.
pub fn step_columns() -> Vec<Column<StepRow>> {
    let mut columns = progress();
    columns.extend(scalars());
    columns.extend(tensors());
    columns.extend(works());
    columns.extend(stability_columns());
    columns.extend(moduli_columns());
    columns
}

/// The columns of `iterations`: those of `steps`, and the iteration.
pub(crate) fn iterate_columns() -> Vec<Column<StepRow>> {
    let mut columns = step_columns();
    columns.push(Column::maybe_integer("iteration", |r: &StepRow| {
        r.iteration.map(|i| i as i64)
    }));
    columns
}

fn progress() -> Vec<Column<StepRow>> {
    vec![
        Column::integer("step", |r: &StepRow| r.step as i64),
        Column::text("stage", |r: &StepRow| Some(&r.stage)),
        Column::number("load_factor", Unit::Dimensionless, |r: &StepRow| {
            r.load_factor
        }),
        Column::integer("iterations", |r: &StepRow| r.iterations as i64),
        Column::number("residual", Unit::Dimensionless, |r: &StepRow| r.residual),
        Column::integer("cuts", |r: &StepRow| r.cuts as i64),
        Column::integer("contacts", |r: &StepRow| r.contacts as i64),
        Column::integer("broken", |r: &StepRow| r.broken as i64),
        Column::integer("broken_in_step", |r: &StepRow| r.broken_in_step as i64),
        Column::integer("rattlers", |r: &StepRow| r.rattlers as i64),
    ]
}

pub(crate) fn measure(
    name: &str,
    unit: Unit,
    read: fn(&Measures) -> Option<f64>,
) -> Column<StepRow> {
    Column::maybe_number(name, unit, move |row: &StepRow| read(&row.measures))
}

fn scalars() -> Vec<Column<StepRow>> {
    let pure = Unit::Dimensionless;
    vec![
        measure("coordination_number", pure, |m| m.coordination_number),
        measure("void_ratio", pure, |m| m.void_ratio),
        measure("graph_porosity", pure, |m| m.graph_porosity),
        measure("graph_porosity_printed", pure, |m| m.graph_porosity_printed),
        measure("window_area", Unit::Area, |m| {
            (m.window_area > 0.0).then_some(m.window_area)
        }),
    ]
}

fn tensors() -> Vec<Column<StepRow>> {
    let pure = Unit::Dimensionless;
    let stress = Unit::Stress;
    let mut columns = Vec::new();
    columns.extend(symmetric("fabric", |m| m.fabric));
    columns.extend(symmetric("fabric_length", |m| m.fabric_length));
    columns.extend(symmetric("branch", |m| m.branch));
    columns.extend(symmetric("contact", |m| m.contact));
    columns.extend(general("stress", stress, |m| part(m, |p| p.total)));
    columns.extend(general("shear_stress", stress, |m| part(m, |p| p.shear)));
    columns.extend(general("variation_stress", stress, |m| {
        part(m, |p| p.variation)
    }));
    columns.extend(general("fabric_stress", stress, |m| part(m, |p| p.fabric)));
    columns.push(measure("isotropic_stress", stress, |m| {
        m.stress.map(|p| p.isotropic)
    }));
    columns.extend(general("strain", pure, |m| m.strain));
    columns
}

fn part(measures: &Measures, read: fn(&StressPartition) -> Tensor) -> Option<Tensor> {
    measures.stress.as_ref().map(read)
}

fn symmetric(prefix: &str, read: fn(&Measures) -> Option<SymmetricTensor>) -> [Column<StepRow>; 3] {
    let component = |name: &str, component: fn(SymmetricTensor) -> f64| {
        Column::maybe_number(
            &format!("{prefix}_{name}"),
            Unit::Dimensionless,
            move |row: &StepRow| read(&row.measures).map(component),
        )
    };
    [
        component("xx", |t| t.xx),
        component("xy", |t| t.xy),
        component("yy", |t| t.yy),
    ]
}

fn general(
    prefix: &str,
    unit: Unit,
    read: fn(&Measures) -> Option<Tensor>,
) -> [Column<StepRow>; 4] {
    let component = |name: &str, component: fn(Tensor) -> f64| {
        Column::maybe_number(&format!("{prefix}_{name}"), unit, move |row: &StepRow| {
            read(&row.measures).map(component)
        })
    };
    [
        component("xx", |t| t.xx),
        component("xy", |t| t.xy),
        component("yx", |t| t.yx),
        component("yy", |t| t.yy),
    ]
}

fn works() -> Vec<Column<StepRow>> {
    let unit = Unit::ForceLength;
    let energy = |name: &str, read: fn(&Energy) -> f64| {
        Column::maybe_number(name, unit, move |r: &StepRow| r.energy.as_ref().map(read))
    };
    vec![
        measure("contact_work", unit, |m| m.contact_work),
        measure("macroscopic_work", unit, |m| m.macroscopic_work),
        measure("boundary_work", unit, |m| m.boundary_work),
        energy("external_work", |e| e.external_work),
        energy("elastic_energy", |e| e.elastic_energy),
        energy("fracture_energy", |e| e.fracture_energy),
        energy("friction_work", |e| e.friction_work),
        energy("nonpotential_work", |e| e.nonpotential_work),
        energy("release_energy", |e| e.release_energy),
        energy("ledger_error", Energy::ledger_error),
    ]
}

/// Writes rows of `steps` to a file, csv or parquet by its ending.
///
/// # Errors
/// Another ending; a file that cannot be written.
pub fn write_steps(path: &Path, rows: &[StepRow]) -> Result<(), ResultsError> {
    match Format::of(path)? {
        Format::Parquet => publish_table(path, &step_columns(), rows),
        Format::Csv => publish(path, &write_steps_csv(rows)),
    }
}

/// Rows of `steps` as csv, with a line of names.
pub fn write_steps_csv(rows: &[StepRow]) -> Vec<u8> {
    let columns = step_columns();
    let mut writer = csv::Writer::from_writer(Vec::new());
    let in_memory = "a vector takes every byte";
    writer
        .write_record(columns.iter().map(|column| &column.name))
        .expect(in_memory);
    for row in rows {
        writer
            .write_record(columns.iter().map(|column| column.show(row)))
            .expect(in_memory);
    }
    writer.into_inner().expect(in_memory)
}
