//! Checks that many parts of a scene share; each adds what is wrong to the list and answers nothing then.

use std::fmt::Display;
use std::io;
use std::ops::Range;
use std::path::PathBuf;

use super::SceneError;
use super::diagnostic::{Problem, Problems, either, likely};
use super::file::SceneFile;
use super::sides::SideNames;
use super::unit::{self, Dimension, UnitError};
use super::value::{Number, Placed, Quantity};
use crate::warning::WarningKind;

/// Which values a number may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// Any finite number.
    Any,
    /// Above zero.
    Positive,
    /// Zero or above.
    NonNegative,
}

/// Largest number, and inverse of the smallest: products of a few of them neither overflow nor vanish.
pub const LARGEST: f64 = 1e30;

/// What has been found wrong, or worth a warning, so far.
#[derive(Debug, Default)]
pub struct Checker {
    /// Mistakes.
    pub problems: Problems,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// A file that the scene names, and why it could not be read.
    pub unreadable: Option<(PathBuf, io::Error)>,
    /// Names of the sides of the container.
    pub sides: SideNames,
}

impl Checker {
    /// For a scene in which nothing is checked yet.
    pub fn of(file: &SceneFile) -> Self {
        Self {
            sides: SideNames::of(file),
            ..Self::default()
        }
    }

    /// Adds a mistake.
    pub fn push(&mut self, problem: Problem) {
        self.problems.push(problem);
    }

    /// Adds a warning.
    pub fn warn(&mut self, kind: WarningKind, warning: impl Display) {
        self.warnings.push(kind.says(warning));
    }

    /// All that went wrong; mistakes come before a file that could not be read.
    pub fn error(self, text: &str, name: &str) -> SceneError {
        match self.unreadable {
            Some((path, source)) if self.problems.is_empty() => {
                SceneError::Unreadable { path, source }
            }
            _ => SceneError::Wrong(self.problems.render(text, name)),
        }
    }

    /// The value of a number in SI.
    pub fn number(
        &mut self,
        number: &Number,
        key: &str,
        dimension: Dimension,
        bound: Bound,
    ) -> Option<f64> {
        self.quantity(&number.value, &number.span, key, dimension, bound)
    }

    /// The value of a number in SI, or what it is when absent.
    pub fn number_or(
        &mut self,
        default: f64,
        number: Option<&Number>,
        key: &str,
        dimension: Dimension,
        bound: Bound,
    ) -> Option<f64> {
        number.map_or(Some(default), |n| self.number(n, key, dimension, bound))
    }

    /// The value of a quantity at a place in SI.
    pub fn quantity(
        &mut self,
        quantity: &Quantity,
        span: &Range<usize>,
        key: &str,
        dimension: Dimension,
        bound: Bound,
    ) -> Option<f64> {
        let value = match quantity {
            Quantity::Number(number) => *number,
            Quantity::Text(text) => match unit::parse(text, dimension) {
                Ok(value) => value,
                Err(error) => {
                    self.push(unit_problem(&error, text, span, key, dimension));
                    return None;
                }
            },
        };
        let expected = match bound {
            _ if !value.is_finite() => "expected a finite number",
            Bound::Positive if value <= 0.0 => "expected a number above zero",
            Bound::NonNegative if value < 0.0 => "expected zero or a number above",
            _ if value.abs() > LARGEST => "expected a magnitude of at most 1e30",
            _ if value != 0.0 && value.abs() < LARGEST.recip() => {
                "expected zero or a magnitude of at least 1e-30"
            }
            _ => return Some(value),
        };
        let message = format!("`{key}` cannot be {value:?}");
        self.push(Problem::at(span, message, expected));
        None
    }

    /// A word, if text that does not begin like a number stands in place of one.
    pub fn as_word(number: &Number) -> Option<Placed<String>> {
        match &number.value {
            Quantity::Text(text) if text.starts_with(char::is_alphabetic) => Some(Placed {
                value: text.clone(),
                span: number.span.clone(),
            }),
            _ => None,
        }
    }

    /// A whole number that is not below `least`.
    pub fn count(&mut self, count: &Placed<i64>, key: &str, least: i64) -> Option<usize> {
        // Far above what a machine holds, so that products stay in range.
        self.count_up_to(count, key, least, 1_000_000_000)
    }

    /// A whole number between two others.
    pub fn count_up_to(
        &mut self,
        count: &Placed<i64>,
        key: &str,
        least: i64,
        most: i64,
    ) -> Option<usize> {
        if (least..=most).contains(&count.value) {
            return usize::try_from(count.value).ok();
        }
        self.push(Problem::at(
            &count.span,
            format!("`{key}` cannot be {}", count.value),
            format!("expected a whole number from {least} to {most}"),
        ));
        None
    }

    /// What a word stands for.
    pub fn word<T: Copy>(
        &mut self,
        word: &Placed<String>,
        key: &str,
        choices: &[(&str, T)],
    ) -> Option<T> {
        self.word_or(word, key, choices, "")
    }

    /// What a word stands for where something else may stand as well.
    pub fn word_or<T: Copy>(
        &mut self,
        word: &Placed<String>,
        key: &str,
        choices: &[(&str, T)],
        other: &str,
    ) -> Option<T> {
        let found = choices.iter().find(|(name, _)| *name == word.value);
        if found.is_none() {
            let names = || choices.iter().map(|(name, _)| *name);
            self.push(
                Problem::at(
                    &word.span,
                    format!("`{key}` cannot be `{}`", word.value),
                    format!("expected {}{other}", either(names())),
                )
                .suggest(likely(&word.value, names())),
            );
        }
        found.map(|(_, meaning)| *meaning)
    }

    /// A side of the container by its name.
    pub fn side(&mut self, word: &Placed<String>, key: &str) -> Option<usize> {
        let found = self.sides.find(word, key);
        found.map_err(|problem| self.push(problem)).ok()
    }

    /// Two numbers.
    pub fn pair(
        &mut self,
        list: &Placed<Vec<Number>>,
        key: &str,
        dimension: Dimension,
    ) -> Option<[f64; 2]> {
        let [first, second] = list.value.as_slice() else {
            self.push(Problem::at(
                &list.span,
                format!("`{key}` needs two numbers, not {}", list.value.len()),
                match dimension {
                    Dimension::ForcePerLength => "expected two numbers, such as `[-1.0, -1.0]`",
                    _ => "expected two numbers, such as `[0.0, 2.0]`",
                },
            ));
            return None;
        };
        let first = self.number(first, key, dimension, Bound::Any);
        let second = self.number(second, key, dimension, Bound::Any);
        Some([first?, second?])
    }

    /// Two lengths, the second not below the first.
    pub fn range(&mut self, list: &Placed<Vec<Number>>, key: &str) -> Option<[f64; 2]> {
        let [from, to] = self.pair(list, key, Dimension::Length)?;
        if from <= to {
            return Some([from, to]);
        }
        self.push(Problem::at(
            &list.span,
            format!("the range `{key}` runs backwards, from {from} to {to}"),
            "expected the smaller number first",
        ));
        None
    }

    /// The one of several alternatives that is given.
    pub fn exactly_one<'a, T>(
        &mut self,
        table: &Range<usize>,
        what: &str,
        alternatives: impl IntoIterator<Item = (&'a str, Option<(T, &'a Range<usize>)>)>,
    ) -> Option<T> {
        let mut names = Vec::new();
        let mut given = Vec::new();
        for (name, alternative) in alternatives {
            names.push(name);
            given.extend(alternative.map(|(value, span)| (name, value, span)));
        }
        match given.len() {
            1 => return given.pop().map(|(_, value, _)| value),
            0 => self.push(Problem::at(
                table,
                format!("{what} is missing"),
                format!("expected one of {}", either(names)),
            )),
            _ => {
                let (first, second) = (&given[0], &given[1]);
                self.push(
                    Problem::at(
                        second.2,
                        format!("{what} is given twice, by `{}` and `{}`", first.0, second.0),
                        format!("expected only one of {}", either(names)),
                    )
                    .and(first.2, "the first is here"),
                );
            }
        }
        None
    }
}

fn unit_problem(
    error: &UnitError,
    text: &str,
    span: &Range<usize>,
    key: &str,
    dimension: Dimension,
) -> Problem {
    let expected = format!("expected {}", dimension.name());
    let problem = match error {
        UnitError::TooLarge => Problem::at(
            span,
            format!("`{key}` cannot be \"{text}\""),
            "expected a magnitude of at most 1e30",
        ),
        UnitError::Comma => Problem::at(
            span,
            format!("`{key}` cannot be \"{text}\""),
            "expected a decimal point, not a comma",
        ),
        UnitError::LoneSign => Problem::at(
            span,
            format!("`{key}` cannot be \"{text}\""),
            "expected a unit on both sides of each `/`, `·` or `*`",
        ),
        UnitError::NoNumber => Problem::at(span, format!("`{key}` cannot be \"{text}\""), expected),
        UnitError::UnknownUnit(unit, usual) => {
            Problem::at(span, format!("no unit is called `{unit}`"), expected).suggest(*usual)
        }
        UnitError::WrongDimension(Some(is)) => Problem::at(
            span,
            format!("`{key}` has a unit of the wrong dimension: \"{text}\" is {is}"),
            expected,
        ),
        UnitError::WrongDimension(None) => Problem::at(
            span,
            format!("`{key}` has a unit of the wrong dimension"),
            expected,
        ),
    };
    problem.help(format!("write {}", dimension.examples()))
}
