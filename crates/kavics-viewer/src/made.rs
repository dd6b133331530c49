//! Columns that are made of those of a table.

use kavics_results::Columns;

use crate::PageError;
use crate::column::{NO_INTEGER, PageColumn, Values};
use crate::piece::StepTable;

/// A column that is made of others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Made {
    /// √(ux² + uy²) of a grain.
    Displacement,
    /// ½ (σxx + σyy) of a grain.
    MeanStress,
    /// √(N² + T²) of a contact.
    TotalForce,
    /// The number of the event in which a contact broke.
    BrokeAt,
}

impl Made {
    /// The made columns of a table.
    pub(crate) fn of(table: StepTable) -> &'static [Self] {
        match table {
            StepTable::Grains => &[Self::Displacement, Self::MeanStress],
            StepTable::Contacts => &[Self::TotalForce, Self::BrokeAt],
            _ => &[],
        }
    }

    /// The made column of this name.
    pub(crate) fn named(table: StepTable, name: &str) -> Option<Self> {
        let mut made = Self::of(table).iter().copied();
        made.find(|made| made.name() == name)
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Displacement => "displacement",
            Self::MeanStress => "mean_stress",
            Self::TotalForce => "total_force",
            Self::BrokeAt => "broke_at",
        }
    }

    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Displacement => "length",
            Self::MeanStress => "force/length^2",
            Self::TotalForce => "force",
            Self::BrokeAt => "",
        }
    }

    /// The columns that it is made of.
    pub(crate) fn sources(self) -> &'static [&'static str] {
        match self {
            Self::Displacement => &["ux", "uy"],
            Self::MeanStress => &["stress_xx", "stress_yy"],
            Self::TotalForce => &["normal_force", "shear_force"],
            Self::BrokeAt => &["contact"],
        }
    }

    /// The column in full precision, of the rows in `table`.
    pub(crate) fn numbers(self, table: &Columns) -> Result<Vec<f64>, PageError> {
        let pair = |turn: fn(f64, f64) -> f64| -> Result<Vec<f64>, PageError> {
            let [first, second] = [0, 1].map(|place| table.numbers(self.sources()[place]));
            let pairs = first?.into_iter().zip(second?);
            Ok(pairs.map(|(first, second)| turn(first, second)).collect())
        };
        match self {
            Self::Displacement | Self::TotalForce => pair(f64::hypot),
            Self::MeanStress => pair(|xx, yy| 0.5 * (xx + yy)),
            Self::BrokeAt => Ok(Vec::new()),
        }
    }

    /// The column to be drawn; `breaks` are the contacts that broke, with their events.
    pub(crate) fn column(
        self,
        table: &Columns,
        breaks: &[(i64, i64)],
    ) -> Result<PageColumn, PageError> {
        let values = if self == Self::BrokeAt {
            Values::Integers(broke_at(table.len(), breaks))
        } else {
            let numbers = self.numbers(table)?.into_iter();
            Values::Single(numbers.map(|value| value as f32).collect())
        };
        Ok(PageColumn::new(self.name(), self.unit(), values))
    }
}

/// The first break of each contact.
fn broke_at(contacts: usize, breaks: &[(i64, i64)]) -> Vec<i32> {
    let mut first = vec![NO_INTEGER; contacts];
    for &(contact, event) in breaks {
        let place = usize::try_from(contact).ok();
        if let Some(first) = place.and_then(|contact| first.get_mut(contact))
            && *first == NO_INTEGER
        {
            *first = i32::try_from(event).unwrap_or(NO_INTEGER);
        }
    }
    first
}

/// Contacts that broke up to a load step, with the numbers of the events, in their order.
pub(crate) fn breaks(events: &Columns, step: usize) -> Result<Vec<(i64, i64)>, PageError> {
    let (steps, kinds) = (events.integers("step")?, events.texts("kind")?);
    let (contacts, numbers) = (events.integers("contact")?, events.integers("event")?);
    let broke = |row: &usize| kinds[*row] == "broke" && steps[*row] <= Some(step as i64);
    let rows = (0..events.len()).filter(broke);
    Ok(rows
        .filter_map(|row| Some((contacts[row]?, numbers[row]?)))
        .collect())
}
