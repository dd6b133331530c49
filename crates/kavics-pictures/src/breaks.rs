//! The bonds that broke, in order.

use kavics_results::ResultsFolder;

use crate::PictureError;

/// A bond that broke.
#[derive(Clone, Debug, PartialEq)]
pub struct Break {
    /// Number of the event in the table `events`.
    pub event: usize,
    /// Load step.
    pub step: usize,
    /// The contact.
    pub contact: usize,
    /// Load factor at which it broke.
    pub load_factor: f64,
    /// `tension`, `compression`, `shear` or `bending`.
    pub mode: String,
}

/// The bonds that broke up to a load step, in the order of their breaks.
///
/// # Errors
/// Events that cannot be read.
pub fn breaks(folder: &ResultsFolder, step: usize) -> Result<Vec<Break>, PictureError> {
    let events = folder.events()?;
    let (kinds, modes) = (events.texts("kind")?, events.texts("mode")?);
    let (numbers, steps) = (events.integers("event")?, events.integers("step")?);
    let (contacts, factors) = (events.integers("contact")?, events.numbers("load_factor")?);
    let whole = |value: Option<i64>| usize::try_from(value?).ok();
    let of_row = |row: usize| {
        let found = Break {
            event: whole(numbers[row])?,
            step: whole(steps[row])?,
            contact: whole(contacts[row])?,
            load_factor: factors[row],
            mode: modes[row].to_owned(),
        };
        (kinds[row] == "broke" && found.step <= step).then_some(found)
    };
    Ok((0..events.len()).filter_map(of_row).collect())
}
