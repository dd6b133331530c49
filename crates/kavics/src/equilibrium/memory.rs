//! What a run remembers, as columns of numbers under names: all that further load steps depend on.

use std::borrow::Cow;
use std::collections::BTreeMap;

use rayon::prelude::*;
use thiserror::Error;

/// Fewer values are not worth a task of their own.
const LEAST_TASK: usize = 4096;

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum MemoryColumn {
    /// Numbers, to the last bit.
    Numbers(Vec<f64>),
    /// Counts and ids; −1 where there is none.
    Integers(Vec<i64>),
    /// Small codes: phases, modes, yes and no.
    Codes(Vec<u8>),
}

/// Columns under their names.
///
/// A column that does not differ from what its reader expects, most often zeros, is left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Memory {
    /// The columns.
    pub columns: BTreeMap<String, MemoryColumn>,
}

/// Why nothing can be gone on from.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum MemoryError {
    /// A column is missing.
    #[error("column \"{column}\" is missing")]
    Missing {
        /// Its name.
        column: String,
    },
    /// A column has another length, or values of another kind.
    #[error("column \"{column}\" does not fit the scene")]
    Unfit {
        /// Its name.
        column: String,
    },
}

impl MemoryError {
    /// Of a column that does not fit.
    pub(crate) fn unfit(column: &str) -> Self {
        Self::Unfit {
            column: column.to_owned(),
        }
    }
}

/// What a column is made of.
pub(crate) trait Value: Copy + Default + Send + Sync {
    fn same(self, other: Self) -> bool;
    fn column(values: Vec<Self>) -> MemoryColumn;
    fn values(column: &MemoryColumn) -> Option<&[Self]>;
}

macro_rules! value {
    ($kind:ty, $variant:ident, $same:expr) => {
        impl Value for $kind {
            fn same(self, other: Self) -> bool {
                $same(self, other)
            }
            fn column(values: Vec<Self>) -> MemoryColumn {
                MemoryColumn::$variant(values)
            }
            fn values(column: &MemoryColumn) -> Option<&[Self]> {
                match column {
                    MemoryColumn::$variant(values) => Some(values),
                    _ => None,
                }
            }
        }
    };
}

value!(f64, Numbers, |a: f64, b: f64| a.to_bits() == b.to_bits());
value!(i64, Integers, |a, b| a == b);
value!(u8, Codes, |a, b| a == b);

impl Memory {
    /// Keeps a list as it is.
    pub(crate) fn put<V: Value>(&mut self, name: &str, values: Vec<V>) {
        self.columns.insert(name.to_owned(), V::column(values));
    }

    /// Keeps a column unless all of it is zero.
    pub(crate) fn put_column<V: Value>(&mut self, name: &str, values: Vec<V>) {
        let zero = V::default();
        if !values.par_iter().all(|value| value.same(zero)) {
            self.put(name, values);
        }
    }

    /// Keeps a column unless it is the same as another.
    pub(crate) fn put_unlike<V: Value>(&mut self, name: &str, values: Vec<V>, other: &[V]) {
        let pairs = values.par_iter().zip(other).with_min_len(LEAST_TASK);
        if values.len() != other.len() || !pairs.all(|(a, b)| a.same(*b)) {
            self.put(name, values);
        }
    }

    /// A list; none where it was not kept.
    pub(crate) fn list<V: Value>(&self, name: &str) -> Result<Option<&[V]>, MemoryError> {
        let Some(column) = self.columns.get(name) else {
            return Ok(None);
        };
        let values = V::values(column).ok_or_else(|| MemoryError::unfit(name))?;
        Ok(Some(values))
    }

    /// A list of a known length.
    pub(crate) fn fixed<V: Value, const N: usize>(
        &self,
        name: &str,
    ) -> Result<[V; N], MemoryError> {
        let missing = || MemoryError::Missing {
            column: name.to_owned(),
        };
        let list = self.list(name)?.ok_or_else(missing)?;
        list.try_into().map_err(|_| MemoryError::unfit(name))
    }

    /// A column of a known length; zeros where it was left out.
    pub(crate) fn column<V: Value>(
        &self,
        name: &str,
        length: usize,
    ) -> Result<Cow<'_, [V]>, MemoryError> {
        match self.list(name)? {
            None => Ok(Cow::Owned(vec![V::default(); length])),
            Some(values) if values.len() == length => Ok(Cow::Borrowed(values)),
            Some(_) => Err(MemoryError::unfit(name)),
        }
    }

    /// A column as long as another, which it is the same as where it was left out.
    pub(crate) fn column_like<'m, V: Value>(
        &'m self,
        name: &str,
        other: &'m [V],
    ) -> Result<&'m [V], MemoryError> {
        match self.list(name)? {
            None => Ok(other),
            Some(values) if values.len() == other.len() => Ok(values),
            Some(_) => Err(MemoryError::unfit(name)),
        }
    }
}

/// A count out of a column of integers.
pub(crate) fn count(name: &str, value: i64) -> Result<usize, MemoryError> {
    usize::try_from(value).map_err(|_| MemoryError::unfit(name))
}

/// Yes or no as a code.
pub(crate) fn code(yes: bool) -> u8 {
    u8::from(yes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_are_left_out_but_not_negative_ones() {
        let mut memory = Memory::default();
        memory.put_column("zero", vec![0.0, 0.0]);
        memory.put_column("negative", vec![0.0, -0.0]);
        assert_eq!(memory.columns.len(), 1);
        let back = memory.column::<f64>("negative", 2).unwrap();
        assert!(back[1].is_sign_negative());
        assert_eq!(memory.column::<f64>("zero", 2).unwrap(), vec![0.0; 2]);
    }

    #[test]
    fn a_column_of_another_length_or_kind_is_refused() {
        let mut memory = Memory::default();
        memory.put("contacts", vec![1_i64]);
        let unfit = Err(MemoryError::unfit("contacts"));
        assert_eq!(memory.fixed::<i64, 2>("contacts"), unfit);
        assert!(memory.fixed::<f64, 2>("contacts").is_err());
        assert_eq!(
            memory.fixed::<i64, 1>("grains"),
            Err(MemoryError::Missing {
                column: "grains".to_owned()
            })
        );
    }
}
