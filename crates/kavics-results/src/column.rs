//! What a column of a table is: its name, its unit, and how it is read from a row.

use serde::ser::{Serialize, SerializeMap, Serializer};

/// Unit of a column in the units of the scene, powers of length and force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// A count, an id, or a word.
    None,
    /// A pure number.
    Dimensionless,
    /// Length.
    Length,
    /// Length squared.
    Area,
    /// Force.
    Force,
    /// Stiffness.
    Stiffness,
    /// A rotation per displacement.
    PerLength,
    /// Moment, work or energy.
    ForceLength,
    /// Stress.
    Stress,
}

impl Unit {
    /// The unit as it stands in the field metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Dimensionless => "1",
            Self::Length => "length",
            Self::Area => "length^2",
            Self::Force => "force",
            Self::Stiffness => "force/length",
            Self::PerLength => "1/length",
            Self::ForceLength => "force*length",
            Self::Stress => "force/length^2",
        }
    }
}

type ReadValue<R, T> = dyn Fn(&R) -> Option<T>;
type ReadText<R> = dyn for<'row> Fn(&'row R) -> Option<&'row str>;

/// How a column is read from a row.
pub(crate) enum Read<R> {
    Integer(Box<ReadValue<R, i64>>),
    Number(Box<ReadValue<R, f64>>),
    Text(Box<ReadText<R>>),
}

/// One column of a table.
pub struct Column<R> {
    /// Name, in snake case.
    pub name: String,
    /// Unit.
    pub unit: Unit,
    pub(crate) read: Read<R>,
}

impl<R> Column<R> {
    /// A column of counts or ids.
    pub(crate) fn integer(name: &str, read: impl Fn(&R) -> i64 + 'static) -> Self {
        Self::maybe_integer(name, move |row| Some(read(row)))
    }

    /// A column of counts or ids that need not exist.
    pub(crate) fn maybe_integer(name: &str, read: impl Fn(&R) -> Option<i64> + 'static) -> Self {
        Self {
            name: name.to_owned(),
            unit: Unit::None,
            read: Read::Integer(Box::new(read)),
        }
    }

    /// A column of numbers.
    pub(crate) fn number(name: &str, unit: Unit, read: impl Fn(&R) -> f64 + 'static) -> Self {
        Self::maybe_number(name, unit, move |row| Some(read(row)))
    }

    /// A column of numbers that need not exist.
    pub(crate) fn maybe_number(
        name: &str,
        unit: Unit,
        read: impl Fn(&R) -> Option<f64> + 'static,
    ) -> Self {
        Self {
            name: name.to_owned(),
            unit,
            read: Read::Number(Box::new(read)),
        }
    }

    /// A column of words that need not exist.
    pub(crate) fn text(
        name: &str,
        read: impl for<'row> Fn(&'row R) -> Option<&'row str> + 'static,
    ) -> Self {
        Self {
            name: name.to_owned(),
            unit: Unit::None,
            read: Read::Text(Box::new(read)),
        }
    }

    /// Whether its values are numbers, counts and ids included.
    pub fn is_numeric(&self) -> bool {
        !matches!(self.read, Read::Text(_))
    }

    /// The value in `row` as text; empty where there is none.
    pub(crate) fn show(&self, row: &R) -> String {
        match &self.read {
            Read::Integer(read) => read(row).map(|value| value.to_string()),
            Read::Number(read) => read(row).map(|value| format!("{value:?}")),
            Read::Text(read) => read(row).map(str::to_owned),
        }
        .unwrap_or_default()
    }
}

/// A row as one JSON object, its keys in the order of the columns.
pub(crate) struct AsObject<'a, R> {
    pub(crate) columns: &'a [Column<R>],
    pub(crate) row: &'a R,
}

impl<R> Serialize for AsObject<'_, R> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.columns.len()))?;
        for column in self.columns {
            match &column.read {
                Read::Integer(read) => map.serialize_entry(&column.name, &read(self.row))?,
                Read::Number(read) => map.serialize_entry(&column.name, &read(self.row))?,
                Read::Text(read) => map.serialize_entry(&column.name, &read(self.row))?,
            }
        }
        map.end()
    }
}
