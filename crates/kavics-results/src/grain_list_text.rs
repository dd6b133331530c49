//! What the readers of grain lists in text share: frames, and words that are numbers.

/// Largest magnitude of a coordinate or radius, as in a scene.
const LARGEST: f64 = 1e30;

/// What is in a column that a grain is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Size {
    Radius,
    Diameter,
}

impl Size {
    /// Names of the columns, in the order in which they are looked for.
    pub(crate) const COLUMNS: [(&'static str, Self); 2] =
        [("radius", Self::Radius), ("diameter", Self::Diameter)];

    /// The radius, `[length]`.
    pub(crate) fn radius(self, size: f64) -> f64 {
        match self {
            Self::Radius => size,
            Self::Diameter => 0.5 * size,
        }
    }
}

/// A coordinate; `line` counts from 1.
pub(crate) fn number(word: &str, line: usize, column: &str) -> Result<f64, String> {
    let value: f64 = word
        .parse()
        .map_err(|_| format!("line {line}, column `{column}`: \"{word}\" is not a number"))?;
    if value.abs() <= LARGEST {
        return Ok(value);
    }
    Err(format!(
        "line {line}, column `{column}`: {word} is not a number up to 1e30"
    ))
}

/// A radius or diameter; `line` counts from 1.
pub(crate) fn size(word: &str, line: usize, column: &str) -> Result<f64, String> {
    let value = number(word, line, column)?;
    if value >= LARGEST.recip() {
        return Ok(value);
    }
    Err(format!(
        "line {line}, column `{column}`: {word} is not a positive number"
    ))
}

/// A number of grains that a file announces; `line` counts from 1.
pub(crate) fn count(text: &str, line: usize) -> Result<usize, String> {
    let text = text.trim();
    text.parse()
        .map_err(|_| format!("line {line}: \"{text}\" is not a number of grains"))
}

/// The frame that is asked for, from 0, or the last.
pub(crate) fn chosen<T>(mut frames: Vec<T>, frame: Option<usize>) -> Result<T, String> {
    let found = frames.len();
    match frame {
        None => frames.pop().ok_or_else(|| "the file is empty".to_owned()),
        Some(frame) if frame < found => Ok(frames.swap_remove(frame)),
        Some(frame) => Err(format!(
            "there is no frame {frame}; the file has {found}, counted from 0"
        )),
    }
}
