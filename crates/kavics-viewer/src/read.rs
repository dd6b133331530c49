//! From the tables of the results folder to columns of page data.

use arrow_array::cast::AsArray;
use arrow_array::types::{ArrowPrimitiveType, Float64Type, Int64Type};
use arrow_array::{Array, RecordBatch};
use arrow_schema::{DataType, Field, Schema};
use kavics_results::Columns;

use crate::column::{NO_INTEGER, PageColumn, Values};
use crate::words::Coder;

/// How numbers are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Precision {
    /// In 32 bits, to be drawn.
    Single,
    /// As they are, to be plotted and listed.
    Double,
}

/// The unit of a column.
pub(crate) fn unit(field: &Field) -> &str {
    field.metadata().get("unit").map_or("", String::as_str)
}

/// A column of a table; none where there is no such column. `known` are names of its words.
pub(crate) fn column(
    table: &Columns,
    name: &str,
    precision: Precision,
    known: &[String],
) -> Option<PageColumn> {
    let (place, field) = table.schema().column_with_name(name)?;
    let batches = table.batches();
    let values = match (field.data_type(), precision) {
        (DataType::Float64, Precision::Single) => {
            let turn = |value: f64| value as f32;
            Values::Single(gather::<Float64Type, _>(batches, place, f32::NAN, turn))
        }
        (DataType::Float64, Precision::Double) => {
            Values::Double(gather::<Float64Type, _>(batches, place, f64::NAN, |v| v))
        }
        (DataType::Int64, _) => {
            let turn = |value| i32::try_from(value).unwrap_or(NO_INTEGER);
            Values::Integers(gather::<Int64Type, _>(batches, place, NO_INTEGER, turn))
        }
        _ => words(batches, place, known)?,
    };
    Some(PageColumn::new(name, unit(field), values))
}

/// The names of all columns but `step`, which the name of the piece tells.
pub(crate) fn names(schema: &Schema, without_step: bool) -> Vec<String> {
    let fields = schema.fields().iter().map(|field| field.name().clone());
    fields
        .filter(|name| !(without_step && name == "step"))
        .collect()
}

fn gather<A: ArrowPrimitiveType, T: Copy>(
    batches: &[RecordBatch],
    place: usize,
    none: T,
    turn: impl Fn(A::Native) -> T,
) -> Vec<T> {
    let rows = batches.iter().map(RecordBatch::num_rows).sum();
    let mut all = Vec::with_capacity(rows);
    for batch in batches {
        let array = batch.column(place).as_primitive::<A>();
        if array.null_count() == 0 {
            all.extend(array.values().iter().map(|&value| turn(value)));
        } else {
            all.extend(array.iter().map(|value| value.map_or(none, &turn)));
        }
    }
    all
}

fn words(batches: &[RecordBatch], place: usize, known: &[String]) -> Option<Values> {
    let mut coder = Coder::new(known);
    let mut codes = Vec::new();
    for batch in batches {
        let array = batch.column(place).as_string_opt::<i32>()?;
        codes.reserve(array.len());
        codes.extend(
            array
                .iter()
                .map(|word| coder.code(word.unwrap_or_default())),
        );
    }
    Some(Values::Words(codes, coder.into_names()))
}
