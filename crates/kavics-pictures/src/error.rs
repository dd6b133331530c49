//! What can go wrong with a picture.

use std::path::PathBuf;

use kavics_results::ResultsError;
use thiserror::Error;

/// A picture could not be made.
#[derive(Debug, Error)]
pub enum PictureError {
    /// The results could not be read, or the picture not written.
    #[error("{0}")]
    Results(#[from] ResultsError),
    /// The results do not tell the container.
    #[error("{}: run.json keeps no container", folder.display())]
    NoContainer {
        /// Results folder.
        folder: PathBuf,
    },
    /// A table names a grain, side or contact that is not there.
    #[error("{}: {table} names {what} {id}, which is not there", folder.display())]
    NotThere {
        /// Results folder.
        folder: PathBuf,
        /// Table.
        table: &'static str,
        /// Grain, side or contact.
        what: &'static str,
        /// Its number as the table has it.
        id: i64,
    },
    /// The load step has no tables of grains and contacts.
    #[error("load step {step} is not recorded; recorded are {recorded}")]
    NotRecorded {
        /// The load step wanted.
        step: usize,
        /// Those that are there.
        recorded: String,
    },
    /// A table has no column of this name.
    #[error("{table} has no column \"{column}\"; {hint}")]
    NoColumn {
        /// Table.
        table: &'static str,
        /// The column looked for.
        column: String,
        /// What could have been meant.
        hint: String,
    },
    /// There is no load or move of this name.
    #[error("no load or move is called \"{name}\"; {hint}")]
    NoAction {
        /// The name looked for.
        name: String,
        /// What could have been meant.
        hint: String,
    },
    /// Displacements are drawn so large that nothing of the assembly is left.
    #[error(
        "displacements {times:e} times as large as they are leave no picture: grains would be drawn {extents:.1e} times \
         the extent of the assembly away; a smaller scale is needed"
    )]
    TooFar {
        /// How many times as large as they are.
        times: f64,
        /// The longest, in extents of the assembly.
        extents: f64,
    },
    /// A column has no value at any load step.
    #[error(
        "\"{column}\" has no value at any load step: the scene did not ask for it, or it does not exist there"
    )]
    NoValue {
        /// The column.
        column: String,
    },
    /// A picture of pixels is too large, or has no pixel.
    #[error(
        "a picture of {width} x {height} pixels cannot be made; at least 1, at most {most} each way"
    )]
    TooLarge {
        /// Width.
        width: u32,
        /// Height.
        height: u32,
        /// The most each way.
        most: u32,
    },
}

impl PictureError {
    /// A column that is not there, with the nearest one or all that are.
    pub(crate) fn no_column(table: &'static str, column: &str, known: &[&str]) -> Self {
        Self::NoColumn {
            table,
            column: column.to_owned(),
            hint: hint(column, known),
        }
    }

    /// An action that is not there, with the nearest one or all that are.
    pub(crate) fn no_action(name: &str, known: &[&str]) -> Self {
        Self::NoAction {
            name: name.to_owned(),
            hint: hint(name, known),
        }
    }

    /// Load steps in words; of many the first and the last.
    pub(crate) fn listed(steps: &[usize]) -> String {
        let text = |steps: &[usize]| {
            let steps: Vec<String> = steps.iter().map(ToString::to_string).collect();
            steps.join(", ")
        };
        match steps {
            [] => "none".to_owned(),
            [a, b, c, .., last] if steps.len() > 8 => format!("{}, …, {last}", text(&[*a, *b, *c])),
            _ => text(steps),
        }
    }

    /// Whether the user asked for something that is not there, and no file is wrong.
    pub fn is_wrong_usage(&self) -> bool {
        match self {
            Self::NotRecorded { .. }
            | Self::NoColumn { .. }
            | Self::NoValue { .. }
            | Self::NoAction { .. }
            | Self::TooFar { .. }
            | Self::TooLarge { .. } => true,
            Self::Results(_) | Self::NoContainer { .. } | Self::NotThere { .. } => false,
        }
    }
}

fn hint(name: &str, known: &[&str]) -> String {
    let near = known
        .iter()
        .map(|known| (strsim::jaro_winkler(name, known), *known));
    match near.max_by(|a, b| a.0.total_cmp(&b.0)) {
        Some((likeness, near)) if likeness > 0.8 => format!("did you mean \"{near}\"?"),
        _ => format!("there are {}", known.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_column_gives_the_nearest_one() {
        let known = ["stress_xx", "stress_yy", "rotation"];
        let error = PictureError::no_column("grains", "stres_yy", &known);
        assert_eq!(
            error.to_string(),
            "grains has no column \"stres_yy\"; did you mean \"stress_yy\"?"
        );
        let error = PictureError::no_column("grains", "?", &known);
        assert!(
            error
                .to_string()
                .ends_with("there are stress_xx, stress_yy, rotation")
        );
    }

    #[test]
    fn many_steps_are_not_all_listed() {
        assert_eq!(PictureError::listed(&[0, 4]), "0, 4");
        let many: Vec<usize> = (0..100).collect();
        assert_eq!(PictureError::listed(&many), "0, 1, 2, …, 99");
    }
}
