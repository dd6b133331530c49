//! A column of page data, and how it stands in an Arrow stream.

use std::sync::Arc;

use arrow_array::{ArrayRef, Float32Array, Float64Array, Int32Array, UInt8Array, UInt16Array};
use arrow_schema::{DataType, Field};

/// An integer that is not there.
pub(crate) const NO_INTEGER: i32 = i32::MIN;

/// A column of page data.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PageColumn {
    pub(crate) name: String,
    /// As in the results folder: `length`, `force`, `1`; empty for counts, ids and words.
    pub(crate) unit: String,
    pub(crate) values: Values,
}

/// The values of a column; there are no nulls.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Values {
    /// Numbers to be drawn; NaN where there is none.
    Single(Vec<f32>),
    /// Numbers to be plotted and listed; NaN where there is none.
    Double(Vec<f64>),
    /// Counts and ids; [`NO_INTEGER`] where there is none.
    Integers(Vec<i32>),
    /// Words by their places among the names.
    Words(Vec<u16>, Vec<String>),
}

impl PageColumn {
    pub(crate) fn new(name: &str, unit: &str, values: Values) -> Self {
        Self {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values,
        }
    }

    /// Its first rows as bytes.
    pub(crate) fn bytes_of(&self, rows: usize) -> Vec<u8> {
        match &self.values {
            Values::Single(values) => bytes(values, rows, f32::to_le_bytes),
            Values::Double(values) => bytes(values, rows, f64::to_le_bytes),
            Values::Integers(values) => bytes(values, rows, i32::to_le_bytes),
            Values::Words(codes, _) => bytes(codes, rows, |code| [code as u8]),
        }
    }

    pub(crate) fn field(&self) -> Field {
        let mut metadata = vec![("unit".to_owned(), self.unit.clone())];
        let kind = match &self.values {
            Values::Single(_) => DataType::Float32,
            Values::Double(_) => DataType::Float64,
            Values::Integers(_) => DataType::Int32,
            Values::Words(_, names) => {
                let names_json = serde_json::to_string(names).expect("words are JSON");
                metadata.push(("values".to_owned(), names_json));
                if fits_a_byte(names) {
                    DataType::UInt8
                } else {
                    DataType::UInt16
                }
            }
        };
        let metadata: std::collections::HashMap<String, String> = metadata.into_iter().collect();
        Field::new(&self.name, kind, false).with_metadata(metadata)
    }

    pub(crate) fn into_array(self) -> ArrayRef {
        match self.values {
            Values::Single(values) => Arc::new(Float32Array::from(values)),
            Values::Double(values) => Arc::new(Float64Array::from(values)),
            Values::Integers(values) => Arc::new(Int32Array::from(values)),
            Values::Words(codes, names) if fits_a_byte(&names) => {
                let bytes = codes.into_iter().map(|code| code as u8);
                Arc::new(UInt8Array::from_iter_values(bytes))
            }
            Values::Words(codes, _) => Arc::new(UInt16Array::from(codes)),
        }
    }
}

fn bytes<T: Copy, const N: usize>(values: &[T], rows: usize, turn: fn(T) -> [u8; N]) -> Vec<u8> {
    let some = values[..rows.min(values.len())].iter();
    some.flat_map(|&value| turn(value)).collect()
}

fn fits_a_byte(names: &[String]) -> bool {
    names.len() <= 1 << 8
}
