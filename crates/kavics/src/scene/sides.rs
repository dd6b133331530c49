//! The sides of the container by the names that a scene gives them.

use super::diagnostic::{Problem, either, likely};
use super::file::SceneFile;
use super::value::Placed;

/// Names of the sides of a box, in the order of their ids.
const OF_A_BOX: [&str; 4] = ["left", "right", "bottom", "top"];

/// Names of the sides of the container.
#[derive(Clone, Copy, Debug, Default)]
pub enum SideNames {
    /// `left`, `right`, `bottom` and `top`.
    #[default]
    Box,
    /// As many numbers as a polygon has corners, from 0.
    Polygon(usize),
}

impl SideNames {
    /// Those of the container of a scene, right or wrong.
    pub fn of(file: &SceneFile) -> Self {
        let polygon = file
            .container
            .as_ref()
            .and_then(|c| c.value.polygon.as_ref());
        polygon.map_or(Self::Box, |corners| Self::Polygon(corners.value.len()))
    }

    /// How many there are.
    pub fn count(self) -> usize {
        match self {
            Self::Box => OF_A_BOX.len(),
            Self::Polygon(corners) => corners,
        }
    }

    /// The name of a side.
    pub fn name(self, side: usize) -> String {
        match self {
            Self::Box => OF_A_BOX[side].to_owned(),
            Self::Polygon(_) => side.to_string(),
        }
    }

    /// The side with a name, or what is wrong with the name.
    pub fn find(self, word: &Placed<String>, key: &str) -> Result<usize, Problem> {
        let found = (0..self.count()).find(|side| self.name(*side) == word.value);
        found.ok_or_else(|| self.unknown(word, key))
    }

    fn unknown(self, word: &Placed<String>, key: &str) -> Problem {
        let message = format!("`{key}` cannot be `{}`", word.value);
        match self {
            Self::Box => Problem::at(
                &word.span,
                message,
                format!("expected {}", either(OF_A_BOX)),
            )
            .suggest(likely(&word.value, OF_A_BOX)),
            Self::Polygon(corners) => Problem::at(
                &word.span,
                message,
                format!(
                    "expected a number from `0` to `{}`",
                    corners.saturating_sub(1)
                ),
            )
            .help("side k of a polygon runs from corner k to the next, both counted from 0"),
        }
    }
}

/// A side in a sentence, by its name: "the left side", or "side 2".
pub fn side_called(name: &str) -> String {
    called("side", name)
}

/// An edge in a sentence, by its name: "the left edge", or "edge 2".
pub fn edge_called(name: &str) -> String {
    called("edge", name)
}

fn called(what: &str, name: &str) -> String {
    if name.starts_with(|c: char| c.is_ascii_digit()) {
        format!("{what} {name}")
    } else {
        format!("the {name} {what}")
    }
}
