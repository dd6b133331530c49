//! Colours for the rows of a table, by one of its columns.

use std::ops::RangeInclusive;

use kavics_results::Columns;

use crate::PictureError;
use crate::ink::{ColourMap, Ink, SHADES};

/// Words of a column that are told apart.
const MOST_WORDS: usize = 8;

/// Which colour each row has.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Colouring {
    /// What the colours show.
    pub title: String,
    /// The ink of each row; none where it has no value.
    pub inks: Vec<Option<Ink>>,
    /// What the inks mean.
    pub key: Key,
}

/// What inks mean.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Key {
    /// A map over a range.
    Range(ColourMap, RangeInclusive<f64>),
    /// Each ink has its word.
    Words(Vec<(Ink, String)>),
}

impl Colouring {
    /// Colours by a column of a table: of numbers over their range, or `range`; of words one by one.
    pub fn by(
        table: &Columns,
        name: &'static str,
        column: &str,
        range: Option<[f64; 2]>,
    ) -> Result<Self, PictureError> {
        check_column(table, name, column)?;
        let title = column.replace('_', " ");
        Ok(match table.numbers(column) {
            Ok(numbers) => Self::of_numbers(title, &numbers, range),
            Err(_) => Self::of_words(title, &table.texts(column)?),
        })
    }

    /// Colours from a map that suits the signs of the numbers.
    pub fn of_numbers(title: String, numbers: &[f64], range: Option<[f64; 2]>) -> Self {
        let [low, high] = range.unwrap_or_else(|| extent(numbers));
        let (map, low, high) = if low < 0.0 && high > 0.0 {
            let most = high.max(-low);
            (ColourMap::Signed, -most, most)
        } else {
            (ColourMap::Rising, low, high)
        };
        Self::over(title, numbers, map, low..=high)
    }

    /// Colours from a map over a range; what lies beyond has the colour of its end.
    pub fn over(
        title: String,
        numbers: &[f64],
        map: ColourMap,
        range: RangeInclusive<f64>,
    ) -> Self {
        let (low, high) = (*range.start(), *range.end());
        let ink = |value: &f64| {
            let share = if high > low {
                (value - low) / (high - low)
            } else {
                0.5
            };
            let shade = (share * f64::from(SHADES)).clamp(0.0, f64::from(SHADES - 1)) as u8;
            value.is_finite().then_some(Ink::Shade(map, shade))
        };
        Self {
            title,
            inks: numbers.iter().map(ink).collect(),
            key: Key::Range(map, range),
        }
    }

    /// Colours for words in the order of their alphabet; those beyond the eighth share one.
    pub fn of_words(title: String, words: &[&str]) -> Self {
        let mut names: Vec<&str> = words
            .iter()
            .copied()
            .filter(|word| !word.is_empty())
            .collect();
        names.sort_unstable();
        names.dedup();
        let place = |word: &str| names.binary_search(&word).ok();
        let ink = |place: usize| Ink::Series(place.min(MOST_WORDS - 1) as u8);
        let inks = words.iter().map(|word| place(word).map(ink)).collect();
        let mut key: Vec<(Ink, String)> = (names.iter().take(MOST_WORDS).enumerate())
            .map(|(place, name)| (ink(place), (*name).replace('_', " ")))
            .collect();
        if let (Some(last), true) = (key.last_mut(), names.len() > MOST_WORDS) {
            "others".clone_into(&mut last.1);
        }
        Self {
            title,
            inks,
            key: Key::Words(key),
        }
    }
}

/// Smallest and largest of the finite numbers; 0 and 0 without any.
fn extent(numbers: &[f64]) -> [f64; 2] {
    let finite = || numbers.iter().copied().filter(|value| value.is_finite());
    let low = finite().fold(f64::INFINITY, f64::min);
    let high = finite().fold(f64::NEG_INFINITY, f64::max);
    if low > high { [0.0, 0.0] } else { [low, high] }
}

/// Checks that a table has a column.
pub(crate) fn check_column(
    table: &Columns,
    name: &'static str,
    column: &str,
) -> Result<(), PictureError> {
    let known = table.names();
    if known.contains(&column) {
        return Ok(());
    }
    Err(PictureError::no_column(name, column, &known))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_both_signs_have_nothing_in_the_middle() {
        let colouring = Colouring::of_numbers("shear".to_owned(), &[-1.0, 0.0, 3.0], None);
        assert_eq!(colouring.key, Key::Range(ColourMap::Signed, -3.0..=3.0));
        assert_eq!(colouring.inks[1], Some(Ink::Shade(ColourMap::Signed, 32)));
        assert_eq!(colouring.inks[2], Some(Ink::Shade(ColourMap::Signed, 63)));
    }

    #[test]
    fn what_is_not_there_has_no_colour() {
        let numbers = [f64::NAN, 2.0, 4.0, 9.0];
        let colouring = Colouring::of_numbers("area".to_owned(), &numbers, Some([2.0, 4.0]));
        let shade = |shade| Some(Ink::Shade(ColourMap::Rising, shade));
        assert_eq!(colouring.inks, [None, shade(0), shade(63), shade(63)]);
    }

    #[test]
    fn words_are_in_the_order_of_the_alphabet() {
        let colouring = Colouring::of_words("state".to_owned(), &["open", "", "closed"]);
        assert_eq!(
            colouring.inks,
            [Some(Ink::Series(1)), None, Some(Ink::Series(0))]
        );
    }
}
