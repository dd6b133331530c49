//! Which columns and load steps of a run stand in a report.

use crate::PageError;
use crate::piece::StepTable;

/// Numbers in a list, at most.
const LISTED: usize = 12;

/// How much of a load step is embedded; each level holds those above it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Level {
    /// Grains where they are.
    Grains,
    /// And the contacts with their normal forces.
    Forces,
    /// And what they are mostly coloured by.
    Main,
    /// All that there is.
    All,
}

impl Level {
    pub(crate) const FROM_MOST: [Self; 4] = [Self::All, Self::Main, Self::Forces, Self::Grains];

    /// What is left out at this level, for the reader; nothing at all of [`Level::All`].
    pub(crate) fn left_out(self) -> &'static str {
        match self {
            Self::All => "",
            Self::Main => "the less used columns, the dual graph and the void cells",
            Self::Forces => "all columns but displacements, normal forces and states of contacts",
            Self::Grains => "contacts and all columns but displacements",
        }
    }
}

/// Columns that never change, with the first embedded load step alone.
pub(crate) fn is_constant(table: StepTable, column: &str) -> bool {
    match table {
        StepTable::Grains => matches!(column, "x" | "y" | "radius" | "window"),
        StepTable::Contacts => matches!(
            column,
            "first" | "second" | "x" | "y" | "nx" | "ny" | "branch_length" | "dual_length_full"
        ),
        _ => false,
    }
}

/// The level from which on a column is embedded; none if it never is, as ids are the numbers of the rows.
pub(crate) fn level(table: StepTable, column: &str) -> Option<Level> {
    Some(match (table, column) {
        (StepTable::Grains, "grain") | (StepTable::Contacts, "contact") => return None,
        (StepTable::Grains, "x" | "y" | "radius" | "window" | "ux" | "uy")
        | (StepTable::Sides | StepTable::Cracks, _) => Level::Grains,
        (StepTable::Grains, "rotation" | "contacts" | "displacement" | "mean_stress" | "state") => {
            Level::Main
        }
        (StepTable::Contacts, "first" | "second" | "x" | "y" | "normal_force" | "state") => {
            Level::Forces
        }
        (StepTable::Contacts, "nx" | "ny" | "shear_force" | "broke_at" | "property") => Level::Main,
        _ => Level::All,
    })
}

/// Load steps wanted, of those recorded.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum StepChoice {
    /// The first, the last, and as many between them as fit.
    #[default]
    Fitting,
    /// These, as far as they fit; [`StepChoice::LAST`] is the last.
    Named(Vec<usize>),
}

impl StepChoice {
    /// The last recorded load step, whatever its number.
    pub const LAST: usize = usize::MAX;

    /// The load steps wanted of those recorded, in order.
    pub(crate) fn of(&self, recorded: &[usize]) -> Result<Vec<usize>, PageError> {
        let Self::Named(named) = self else {
            return Ok(recorded.to_vec());
        };
        let last = recorded.last().copied().unwrap_or(0);
        let named = named
            .iter()
            .map(|&step| if step == Self::LAST { last } else { step });
        let mut named: Vec<usize> = named.collect();
        named.sort_unstable();
        named.dedup();
        match named.iter().find(|step| !recorded.contains(step)) {
            Some(&step) => Err(PageError::Unrecorded {
                step,
                recorded: listed(recorded),
            }),
            None => Ok(named),
        }
    }
}

/// Numbers as a list; of long ones the first and the last.
pub(crate) fn listed(numbers: &[usize]) -> String {
    let joined = |numbers: &[usize]| {
        let words: Vec<String> = numbers.iter().map(usize::to_string).collect();
        words.join(", ")
    };
    if numbers.len() <= LISTED {
        joined(numbers)
    } else {
        let half = LISTED / 2;
        let (first, last) = (&numbers[..half], &numbers[numbers.len() - half..]);
        format!("{}, …, {}", joined(first), joined(last))
    }
}

/// `count` of `steps`, the last and the first and some evenly between; all where there are no more.
pub(crate) fn evenly(steps: &[usize], count: usize) -> Vec<usize> {
    match (steps.last(), count) {
        (None, _) | (_, 0) => Vec::new(),
        (Some(&last), 1) => vec![last],
        _ if count >= steps.len() => steps.to_vec(),
        _ => {
            let (gaps, last) = (count - 1, steps.len() - 1);
            let place = |number: usize| (2 * number * last + gaps) / (2 * gaps);
            (0..count).map(|number| steps[place(number)]).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::evenly;

    #[test]
    fn chosen_steps_reach_from_the_first_to_the_last() {
        let steps: Vec<usize> = (0..=60).collect();
        assert_eq!(evenly(&steps, 4), [0, 20, 40, 60]);
        assert_eq!(evenly(&steps, 2), [0, 60]);
        assert_eq!(evenly(&steps, 1), [60]);
        assert_eq!(evenly(&steps, 99), steps);
        assert_eq!(evenly(&[0, 5, 7], 0), [] as [usize; 0]);
        for count in 2..61 {
            let chosen = evenly(&steps, count);
            assert!(chosen.is_sorted_by(|a, b| a < b), "{chosen:?}");
            assert_eq!((chosen.len(), chosen[count - 1]), (count, 60));
        }
    }
}
