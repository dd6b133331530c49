//! Ids as types, and the tables they index: `forces[grain]` must not compile where a contact is meant.

use std::fmt;
use std::marker::PhantomData;
use std::ops::{Index, IndexMut};

/// A type that numbers the rows of a [`Table`].
pub trait Id: Copy {
    /// The id of row `index`.
    fn from_index(index: usize) -> Self;
    /// The row of this id.
    fn index(self) -> usize;
}

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub u32);

        impl Id for $name {
            fn from_index(index: usize) -> Self {
                Self(u32::try_from(index).expect("at most 2^32 rows"))
            }
            fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

id! {
    /// A grain; counts from 0 and never changes.
    GrainId
}
id! {
    /// A contact; counts from 0 and never changes.
    ContactId
}
id! {
    /// A side of the container; left, right, bottom, top of a box are 0, 1, 2, 3.
    SideId
}
id! {
    /// A grain or a side, counted together: the grains first, then the sides.
    BodyId
}
id! {
    /// A contact property of the scene.
    PropertyId
}

/// A column with one value for each id.
#[derive(Clone, Debug, PartialEq)]
pub struct Table<I, T> {
    values: Vec<T>,
    id: PhantomData<I>,
}

/// One value a grain.
pub type PerGrain<T> = Table<GrainId, T>;
/// One value a contact.
pub type PerContact<T> = Table<ContactId, T>;
/// One value a side.
pub type PerSide<T> = Table<SideId, T>;
/// One value a body.
pub type PerBody<T> = Table<BodyId, T>;
/// One value a contact property.
pub type PerProperty<T> = Table<PropertyId, T>;

impl<I: Id, T> Table<I, T> {
    /// The same value for `count` ids.
    pub fn filled(value: T, count: usize) -> Self
    where
        T: Clone,
    {
        vec![value; count].into()
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// All ids in order.
    pub fn ids(&self) -> impl ExactSizeIterator<Item = I> + use<I, T> {
        (0..self.values.len()).map(I::from_index)
    }

    /// Ids and values, in the order of the ids.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (I, &T)> {
        self.values
            .iter()
            .enumerate()
            .map(|(i, v)| (I::from_index(i), v))
    }

    /// The values in the order of the ids.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// The values in the order of the ids, to be changed.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// A table whose values follow from these.
    pub fn map<U>(&self, f: impl FnMut(&T) -> U) -> Table<I, U> {
        self.values.iter().map(f).collect::<Vec<_>>().into()
    }
}

impl<I, T> Default for Table<I, T> {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl<I, T> From<Vec<T>> for Table<I, T> {
    fn from(values: Vec<T>) -> Self {
        Self {
            values,
            id: PhantomData,
        }
    }
}

impl<I, T> FromIterator<T> for Table<I, T> {
    fn from_iter<S: IntoIterator<Item = T>>(iter: S) -> Self {
        iter.into_iter().collect::<Vec<_>>().into()
    }
}

impl<I: Id, T> Index<I> for Table<I, T> {
    type Output = T;
    fn index(&self, id: I) -> &T {
        &self.values[id.index()]
    }
}

impl<I: Id, T> IndexMut<I> for Table<I, T> {
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.values[id.index()]
    }
}
