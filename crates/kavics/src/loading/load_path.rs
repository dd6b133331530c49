//! The load path: an iterator of equilibria.

use crate::assembly::Assembly;
use crate::contact_law::Property;
use crate::equilibrium::{Equilibrium, Settings, SolveError};
use crate::ids::PerProperty;
use crate::loading::{Breakage, Program};

/// The equilibria of a program, one load step after the other.
///
/// The first item is the undeformed state, step 0. Where a load step cannot be finished, the last equilibrium
/// found within it comes with `complete = false`, then the error, then nothing.
#[derive(Debug)]
pub struct LoadPath<'a> {
    assembly: &'a Assembly,
}

impl<'a> LoadPath<'a> {
    /// The path of `program` through `assembly`.
    pub fn new(
        assembly: &'a Assembly,
        _properties: &'a PerProperty<Property>,
        _program: &'a Program,
        _breakage: Breakage,
        _settings: Settings,
    ) -> Self {
        Self { assembly }
    }
}

impl Iterator for LoadPath<'_> {
    type Item = Result<Equilibrium, SolveError>;

    fn next(&mut self) -> Option<Self::Item> {
        let _ = self.assembly;
        None
    }
}
