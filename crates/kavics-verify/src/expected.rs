//! `expected.csv`: what a case must give, row by row.
//!
//! Columns: run, table, step, key, column, expected, tolerance, kind.
//! * table: a table of the results; `run` (column `status`); `identity` (column: its name, key: its parameters);
//!   `packed` (the same on the grains that `pack` wrote).
//! * step: a load step, `last`, or `all` for every row of `steps`.
//! * key: of `grains` an id, `*` for all or a state; of `contacts` `first-second` or `*`; of `sides` a name; of
//!   `events` a number.
//! * column: sums of products of columns and numbers, such as `stress_xx*window_area-0.5*stress_yy`.
//! * expected: a number, a word, or `=name` for what the run of that name gives in the same place.
//! * kind: `abs`, `rel`, `most`, `least` or `text`.

use std::collections::BTreeMap;

use kavics_results::Columns;
use serde::Serialize;

use crate::run::Run;
use crate::{identities, packed};

/// A row of `expected.csv`.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a> {
    /// Name of the run.
    pub run: &'a str,
    table: &'a str,
    step: &'a str,
    key: &'a str,
    column: &'a str,
    expected: &'a str,
    tolerance: &'a str,
    kind: &'a str,
}

/// What was expected, what was found, and whether it holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Name of the validation case.
    pub case: String,
    /// Name of the run.
    pub run: String,
    /// What was looked at: table, load step, row, column.
    pub quantity: String,
    /// A number, a word, or the run that gives the number.
    pub expected: String,
    /// The value; of several, the one that is farthest off.
    pub found: String,
    /// How the two may differ: `± 1e-12`, `± 1e-12 of it`, `at most`, `at least`, or nothing.
    pub tolerance: String,
    /// Share of the tolerance that is used; none where there is no tolerance.
    pub share: Option<f64>,
    /// The verdict.
    pub holds: bool,
}

/// A value beside the one expected.
#[derive(Clone, Copy, Debug)]
struct Pair {
    found: f64,
    expected: f64,
}

impl<'a> Row<'a> {
    /// A line of the file.
    pub fn parse(line: &'a str) -> Self {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let [run, table, step, key, column, expected, tolerance, kind] = cells[..] else {
            panic!("eight cells expected: {line}");
        };
        Self {
            run,
            table,
            step,
            key,
            column,
            expected,
            tolerance,
            kind,
        }
    }

    /// Looks at the runs of a case.
    pub fn find(&self, case: &str, runs: &BTreeMap<String, Run>) -> Finding {
        let found = if self.kind == "text" {
            self.find_word(runs)
        } else {
            self.find_number(runs)
        };
        let (found, share, holds) = found.unwrap_or_else(|trouble| (trouble, None, false));
        let at = |word: &str, value: &str| match value {
            "" => String::new(),
            "*" => " all".to_owned(),
            value => format!(" {word}{value}"),
        };
        Finding {
            case: case.to_owned(),
            run: self.run.to_owned(),
            quantity: format!(
                "{}{}{} {}",
                self.table,
                at("step ", self.step),
                at("", self.key),
                self.column
            ),
            expected: self.expected.replace('=', "as run "),
            found,
            tolerance: match self.kind {
                "abs" => format!("± {}", self.tolerance),
                "rel" => format!("± {} of it", self.tolerance),
                "most" => "at most".to_owned(),
                "least" => "at least".to_owned(),
                _ => String::new(),
            },
            share,
            holds,
        }
    }

    fn find_word(
        &self,
        runs: &BTreeMap<String, Run>,
    ) -> Result<(String, Option<f64>, bool), String> {
        let words = self.words(run_called(self.run, runs)?)?;
        let wrong = words.iter().find(|word| *word != self.expected);
        let shown = wrong.or(words.first()).cloned().unwrap_or_default();
        Ok((shown, None, wrong.is_none()))
    }

    fn find_number(
        &self,
        runs: &BTreeMap<String, Run>,
    ) -> Result<(String, Option<f64>, bool), String> {
        let found = self.numbers(run_called(self.run, runs)?)?;
        let expected = match self.expected.strip_prefix('=') {
            Some(other) => self.numbers(run_called(other, runs)?)?,
            None => vec![number(self.expected); found.len()],
        };
        if found.is_empty() || found.len() != expected.len() {
            return Err("another number of rows".to_owned());
        }
        let pairs = found.into_iter().zip(expected);
        let pairs: Vec<Pair> = pairs
            .map(|(found, expected)| Pair { found, expected })
            .collect();
        let excess = |pair: &Pair| self.excess(*pair);
        // A value that is not a number is the worst of all.
        let worst = pairs
            .into_iter()
            .max_by(|a, b| excess(a).total_cmp(&excess(b)))
            .ok_or("no value")?;
        let holds = excess(&worst) <= 0.0;
        Ok((worst.found.to_string(), self.share(worst), holds))
    }

    /// How much of the tolerance a value uses.
    fn share(&self, Pair { found, expected }: Pair) -> Option<f64> {
        let allowed = self.allowed(expected)?;
        (allowed > 0.0).then(|| (found - expected).abs() / allowed)
    }

    fn allowed(&self, expected: f64) -> Option<f64> {
        match self.kind {
            "abs" => Some(number(self.tolerance)),
            "rel" => Some(number(self.tolerance) * expected.abs()),
            _ => None,
        }
    }

    /// By how much a value misses what it may be; not above zero where it holds.
    fn excess(&self, Pair { found, expected }: Pair) -> f64 {
        let excess = match (self.kind, self.allowed(expected)) {
            (_, Some(allowed)) => (found - expected).abs() - allowed,
            ("most", None) => found - expected,
            ("least", None) => expected - found,
            (other, None) => panic!("unknown kind {other}"),
        };
        if excess.is_nan() {
            f64::INFINITY
        } else {
            excess
        }
    }

    fn step(&self, run: &Run) -> Result<usize, String> {
        match self.step {
            "last" => run.last_step(),
            "" | "all" => Ok(0),
            number => Ok(number.parse().expect("a load step in expected.csv")),
        }
    }

    fn numbers(&self, run: &Run) -> Result<Vec<f64>, String> {
        match self.table {
            "run" => Ok(vec![f64::from(run.status)]),
            "identity" => {
                let step = self.step(run)?;
                Ok(vec![identities::value(self.column, run, step, self.key)?])
            }
            "packed" => Ok(vec![packed::value(self.column, &run.packed()?, self.key)]),
            _ => {
                let (table, rows) = self.rows(run)?;
                let values = expression(&table, self.column)?;
                Ok(rows.into_iter().map(|row| values[row]).collect())
            }
        }
    }

    fn words(&self, run: &Run) -> Result<Vec<String>, String> {
        let (table, rows) = self.rows(run)?;
        let words = table.texts(self.column).map_err(|e| e.to_string())?;
        Ok(rows.into_iter().map(|row| words[row].to_owned()).collect())
    }

    /// The table and the rows that are meant.
    fn rows(&self, run: &Run) -> Result<(Columns, Vec<usize>), String> {
        let table = run.table(self.table, self.step(run)?)?;
        let all = 0..table.len();
        let numbers = |column: &str| table.numbers(column).map_err(|e| e.to_string());
        let words = |column: &str| table.texts(column).map_err(|e| e.to_string());
        let rows: Vec<usize> = match self.table {
            "steps" if self.step == "all" => all.collect(),
            "steps" => {
                let (steps, wanted) = (numbers("step")?, self.step(run)? as f64);
                all.filter(|row| steps[*row] == wanted).collect()
            }
            _ if self.key == "*" => all.collect(),
            "contacts" => {
                let (first, second) = (numbers("first")?, numbers("second")?);
                let key = |row: &usize| format!("{}-{}", first[*row], second[*row]);
                all.filter(|row| key(row) == self.key).collect()
            }
            "sides" => {
                let names = words("name")?;
                all.filter(|row| names[*row] == self.key).collect()
            }
            _ => {
                if let Ok(row) = self.key.parse::<usize>() {
                    all.filter(|other| *other == row).collect()
                } else {
                    let states = words("state")?;
                    all.filter(|row| states[*row] == self.key).collect()
                }
            }
        };
        if rows.is_empty() {
            return Err(format!(
                "{}: {} has no row {}",
                self.run, self.table, self.key
            ));
        }
        Ok((table, rows))
    }
}

fn run_called<'a>(name: &str, runs: &'a BTreeMap<String, Run>) -> Result<&'a Run, String> {
    runs.get(name)
        .ok_or_else(|| format!("no run is called {name}"))
}

fn number(text: &str) -> f64 {
    text.parse()
        .unwrap_or_else(|_| panic!("{text} is no number, in expected.csv"))
}

/// The values of a sum of products for every row of a table.
fn expression(table: &Columns, text: &str) -> Result<Vec<f64>, String> {
    let mut total = vec![0.0; table.len()];
    let mut rest = text;
    let mut sign = 1.0;
    while !rest.is_empty() {
        let end = rest.find(['+', '-']).unwrap_or(rest.len());
        let term = product(table, &rest[..end])?;
        for (total, term) in total.iter_mut().zip(term) {
            *total += sign * term;
        }
        sign = if rest[end..].starts_with('-') {
            -1.0
        } else {
            1.0
        };
        rest = rest.get(end + 1..).unwrap_or("");
    }
    Ok(total)
}

fn product(table: &Columns, text: &str) -> Result<Vec<f64>, String> {
    let mut value = vec![1.0; table.len()];
    let mut rest = text;
    let mut divide = false;
    while !rest.is_empty() {
        let end = rest.find(['*', '/']).unwrap_or(rest.len());
        let name = &rest[..end];
        let factor = match name.parse::<f64>() {
            Ok(number) => vec![number; table.len()],
            Err(_) => table.numbers(name).map_err(|error| error.to_string())?,
        };
        for (value, factor) in value.iter_mut().zip(factor) {
            *value = if divide {
                *value / factor
            } else {
                *value * factor
            };
        }
        divide = rest[end..].starts_with('/');
        rest = rest.get(end + 1..).unwrap_or("");
    }
    Ok(value)
}
