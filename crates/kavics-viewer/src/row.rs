//! A row of a table in full precision, as a JSON object.

use arrow_schema::DataType;
use kavics_results::Columns;
use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::Value;

use crate::PageError;
use crate::made::Made;

/// Names and values, in the order of the columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Row(pub(crate) Vec<(String, Value)>);

impl Serialize for Row {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

/// The only row of `table`, with the columns made of it; `broke_at` is the event in which the contact broke.
pub(crate) fn row(table: &Columns, made: &[Made], broke_at: Option<i64>) -> Result<Row, PageError> {
    let mut values = Vec::new();
    for field in table.schema().fields() {
        let name = field.name();
        let value = match field.data_type() {
            DataType::Int64 => Value::from(table.integers(name)?[0]),
            DataType::Float64 => Value::from(table.numbers(name)?[0]),
            _ => Value::from(table.texts(name)?[0]),
        };
        values.push((name.clone(), value));
    }
    for &made in made {
        let value = if made == Made::BrokeAt {
            Value::from(broke_at)
        } else {
            Value::from(made.numbers(table)?[0])
        };
        values.push((made.name().to_owned(), value));
    }
    Ok(Row(values))
}
