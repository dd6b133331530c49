//! Values of the scene file: each with its place, numbers with or without a unit.

use std::fmt;
use std::marker::PhantomData;
use std::ops::Range;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use toml::Spanned;

/// A value and where it stands in the scene file, in bytes.
#[derive(Clone, Debug)]
pub struct Placed<T> {
    /// What is written.
    pub value: T,
    /// First byte and the one after the last; of a table, its header.
    pub span: Range<usize>,
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Placed<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let spanned = Spanned::<T>::deserialize(deserializer)?;
        Ok(Self {
            span: spanned.span(),
            value: spanned.into_inner(),
        })
    }
}

struct TableOnly<T>(T);

struct TableVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for TableVisitor<T> {
    type Value = TableOnly<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table")
    }
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
        T::deserialize(MapAccessDeserializer::new(map)).map(TableOnly)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for TableOnly<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(TableVisitor(PhantomData))
    }
}

/// A table; serde alone would take a list of its values in the order of the fields as well.
pub fn table<'de, T, D>(deserializer: D) -> Result<Placed<T>, D::Error>
where
    T: Deserialize<'de>,
    D: Deserializer<'de>,
{
    let Placed { value, span } = Placed::<TableOnly<T>>::deserialize(deserializer)?;
    Ok(Placed {
        value: value.0,
        span,
    })
}

/// As [`table`], for a key that may be absent.
pub fn optional_table<'de, T, D>(deserializer: D) -> Result<Option<Placed<T>>, D::Error>
where
    T: Deserialize<'de>,
    D: Deserializer<'de>,
{
    table(deserializer).map(Some)
}

struct TablesVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for TablesVisitor<T> {
    type Value = Vec<Placed<T>>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of tables")
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
        let mut tables = Vec::new();
        while let Some(Placed { value, span }) = list.next_element::<Placed<TableOnly<T>>>()? {
            let value = value.0;
            tables.push(Placed { value, span });
        }
        Ok(tables)
    }
}

/// Tables that may stand any number of times, as `[[stage]]`.
pub fn tables<'de, T, D>(deserializer: D) -> Result<Vec<Placed<T>>, D::Error>
where
    T: Deserialize<'de>,
    D: Deserializer<'de>,
{
    deserializer.deserialize_seq(TablesVisitor(PhantomData))
}

/// What is written where a number stands: a number, a number with a unit, or a word in place of a number.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(untagged))]
pub enum Quantity {
    /// A plain number.
    Number(f64),
    /// A number with a unit, or a word.
    Text(String),
}

/// A number with its place.
pub type Number = Placed<Quantity>;

struct QuantityVisitor;

impl Visitor<'_> for QuantityVisitor {
    type Value = Quantity;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or a number with a unit in quotes")
    }
    fn visit_f64<E>(self, number: f64) -> Result<Quantity, E> {
        Ok(Quantity::Number(number))
    }
    fn visit_i64<E>(self, number: i64) -> Result<Quantity, E> {
        Ok(Quantity::Number(number as f64))
    }
    fn visit_u64<E>(self, number: u64) -> Result<Quantity, E> {
        Ok(Quantity::Number(number as f64))
    }
    fn visit_str<E>(self, text: &str) -> Result<Quantity, E> {
        Ok(Quantity::Text(text.to_owned()))
    }
}

impl<'de> Deserialize<'de> for Quantity {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(QuantityVisitor)
    }
}

/// What a table that may stand in place of a value is called in messages.
pub trait Described {
    /// What is expected there, with an example.
    const EXPECTED: &'static str;
}

/// A quantity, or a table in its place.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(untagged))]
pub enum ValueOr<T> {
    /// A quantity.
    Value(Quantity),
    /// The table in its place.
    Table(T),
}

struct ValueOrVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de> + Described> Visitor<'de> for ValueOrVisitor<T> {
    type Value = ValueOr<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(T::EXPECTED)
    }
    fn visit_f64<E>(self, number: f64) -> Result<Self::Value, E> {
        Ok(ValueOr::Value(Quantity::Number(number)))
    }
    fn visit_i64<E>(self, number: i64) -> Result<Self::Value, E> {
        Ok(ValueOr::Value(Quantity::Number(number as f64)))
    }
    fn visit_u64<E>(self, number: u64) -> Result<Self::Value, E> {
        Ok(ValueOr::Value(Quantity::Number(number as f64)))
    }
    fn visit_str<E>(self, text: &str) -> Result<Self::Value, E> {
        Ok(ValueOr::Value(Quantity::Text(text.to_owned())))
    }
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
        T::deserialize(MapAccessDeserializer::new(map)).map(ValueOr::Table)
    }
}

impl<'de, T: Deserialize<'de> + Described> Deserialize<'de> for ValueOr<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ValueOrVisitor(PhantomData))
    }
}

/// A list, or a table in its place.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(untagged))]
pub enum ListOr<V, T> {
    /// A list.
    List(Vec<Placed<V>>),
    /// The table in its place.
    Table(T),
}

struct ListOrVisitor<V, T>(PhantomData<(V, T)>);

impl<'de, V: Deserialize<'de>, T: Deserialize<'de> + Described> Visitor<'de>
    for ListOrVisitor<V, T>
{
    type Value = ListOr<V, T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(T::EXPECTED)
    }
    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Self::Value, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(list)).map(ListOr::List)
    }
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
        T::deserialize(MapAccessDeserializer::new(map)).map(ListOr::Table)
    }
}

impl<'de, V: Deserialize<'de>, T: Deserialize<'de> + Described> Deserialize<'de> for ListOr<V, T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ListOrVisitor(PhantomData))
    }
}

/// Tables with names of the user's choice, in the order of the file.
#[derive(Clone, Debug)]
pub struct Named<T>(pub Vec<(Placed<String>, Placed<T>)>);

impl<T> Default for Named<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

struct NamedVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for NamedVisitor<T> {
    type Value = Named<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table of tables, each with a name")
    }
    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Named<T>, A::Error> {
        let mut entries = Vec::new();
        while let Some((name, table)) = map.next_entry::<Placed<String>, Placed<TableOnly<T>>>()? {
            let Placed { value, span } = table;
            let value = value.0;
            entries.push((name, Placed { value, span }));
        }
        entries.sort_by_key(|(name, _)| name.span.start);
        Ok(Named(entries))
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(NamedVisitor(PhantomData))
    }
}

#[cfg(feature = "schema")]
mod schema {
    use std::borrow::Cow;
    use std::collections::BTreeMap;

    use schemars::{JsonSchema, Schema, SchemaGenerator};

    use super::{Named, Placed};

    impl<T: JsonSchema> JsonSchema for Placed<T> {
        fn inline_schema() -> bool {
            T::inline_schema()
        }
        fn schema_name() -> Cow<'static, str> {
            T::schema_name()
        }
        fn schema_id() -> Cow<'static, str> {
            T::schema_id()
        }
        fn json_schema(generator: &mut SchemaGenerator) -> Schema {
            T::json_schema(generator)
        }
    }

    impl<T: JsonSchema> JsonSchema for Named<T> {
        fn inline_schema() -> bool {
            true
        }
        fn schema_name() -> Cow<'static, str> {
            BTreeMap::<String, T>::schema_name()
        }
        fn json_schema(generator: &mut SchemaGenerator) -> Schema {
            BTreeMap::<String, T>::json_schema(generator)
        }
    }
}
