//! The names of the pieces of page data.

use std::fmt;

/// A table with a file a recorded load step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StepTable {
    /// A row a grain.
    Grains,
    /// A row a contact.
    Contacts,
    /// A row a side of the container.
    Sides,
    /// A row a void cell.
    Voids,
    /// A row a crack.
    Cracks,
    /// A row a grain and mode.
    Modes,
}

impl StepTable {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Grains,
        Self::Contacts,
        Self::Sides,
        Self::Voids,
        Self::Cracks,
        Self::Modes,
    ];

    /// Those that every recorded load step has.
    pub const EVERY_STEP: [Self; 3] = [Self::Grains, Self::Contacts, Self::Sides];

    /// The name of the table and of its folder.
    pub fn name(self) -> &'static str {
        match self {
            Self::Grains => "grains",
            Self::Contacts => "contacts",
            Self::Sides => "sides",
            Self::Voids => "voids",
            Self::Cracks => "cracks",
            Self::Modes => "modes",
        }
    }

    fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|table| table.name() == name)
    }
}

/// A table that grows with the run, in one file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RunTable {
    /// A row a load step.
    Steps,
    /// A row an event.
    Events,
    /// A row a load or move at each load step.
    Actions,
}

impl RunTable {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Steps, Self::Events, Self::Actions];

    /// The name of the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Steps => "steps",
            Self::Events => "events",
            Self::Actions => "actions",
        }
    }

    /// The name of its file.
    pub(crate) fn file(self) -> String {
        format!("{}.parquet", self.name())
    }
}

/// A piece of page data. Its name is made of known words and numbers, and no path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Piece {
    /// What ran, and what there is to be shown.
    Run,
    /// A table of the whole run.
    Growing(RunTable),
    /// A table at a load step.
    Step(StepTable, usize),
    /// The dual edges of the contacts before loading.
    Dual,
    /// Triangles that fill the void cells of a load step.
    Cells(usize),
    /// Principal directions of fabric and stress at a load step.
    Crosses(usize),
    /// A row of a table at a load step, in full precision.
    Row(StepTable, usize, usize),
}

impl Piece {
    /// The piece of this name.
    pub fn of_name(name: &str) -> Option<Self> {
        let parts: Vec<&str> = name.split('/').collect();
        match parts.as_slice() {
            ["run.json"] => Some(Self::Run),
            ["dual"] => Some(Self::Dual),
            ["cells", step] => Some(Self::Cells(number(step)?)),
            ["crosses", step] => Some(Self::Crosses(number(step)?)),
            ["row", table, step, row] => {
                let table = StepTable::of_name(table)?;
                Some(Self::Row(table, number(step)?, number(row)?))
            }
            [table, step] => Some(Self::Step(StepTable::of_name(table)?, number(step)?)),
            [table] => {
                let mut all = RunTable::ALL.into_iter();
                all.find(|known| known.name() == *table).map(Self::Growing)
            }
            _ => None,
        }
    }
}

impl fmt::Display for Piece {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Run => f.write_str("run.json"),
            Self::Growing(table) => f.write_str(table.name()),
            Self::Step(table, step) => write!(f, "{}/{step}", table.name()),
            Self::Dual => f.write_str("dual"),
            Self::Cells(step) => write!(f, "cells/{step}"),
            Self::Crosses(step) => write!(f, "crosses/{step}"),
            Self::Row(table, step, row) => write!(f, "row/{}/{step}/{row}", table.name()),
        }
    }
}

/// A number as it is usually written, so that a piece has one name.
fn number(text: &str) -> Option<usize> {
    let number: usize = text.parse().ok()?;
    (number.to_string() == text).then_some(number)
}

#[cfg(test)]
mod tests {
    use super::{Piece, RunTable, StepTable};

    #[test]
    fn a_name_leads_to_a_piece_and_back() {
        let pieces = [
            Piece::Run,
            Piece::Growing(RunTable::Events),
            Piece::Step(StepTable::Modes, 12),
            Piece::Dual,
            Piece::Cells(0),
            Piece::Crosses(7),
            Piece::Row(StepTable::Contacts, 12, 345),
        ];
        for piece in pieces {
            assert_eq!(Piece::of_name(&piece.to_string()), Some(piece));
        }
    }

    #[test]
    fn other_names_lead_nowhere() {
        let names = [
            "",
            "grains",
            "grains/",
            "grains/012",
            "grains/+1",
            "grains/-1",
            "grains/1/2",
            "grains/../run.json",
            "../run.json",
            "row/steps/1/2",
            "scene.toml",
            "log.ndjson",
            "grains/99999999999999999999999",
        ];
        for name in names {
            assert_eq!(Piece::of_name(name), None, "{name}");
        }
    }
}
