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

use super::{Run, identities, packed};

/// A row of `expected.csv`.
pub struct Row<'a> {
    pub run: &'a str,
    table: &'a str,
    step: &'a str,
    key: &'a str,
    column: &'a str,
    expected: &'a str,
    tolerance: &'a str,
    kind: &'a str,
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

    /// What is wrong with a run, if anything.
    pub fn check(&self, runs: &BTreeMap<String, Run>) -> Result<(), String> {
        let run = &runs[self.run];
        let fail = |found: &dyn std::fmt::Display| {
            let Self {
                run,
                table,
                step,
                key,
                column,
                expected,
                tolerance,
                kind,
            } = self;
            Err(format!(
                "{run}: {table} {step} {key} {column}: found {found}, expected {kind} {expected} ({tolerance})"
            ))
        };
        if self.kind == "text" {
            let found = self.words(run)?;
            let wrong = found.iter().find(|word| *word != self.expected);
            return wrong.map_or(Ok(()), |word| fail(word));
        }
        let found = self.numbers(run)?;
        let expected = match self.expected.strip_prefix('=') {
            Some(other) => self.numbers(&runs[other])?,
            None => vec![number(self.expected); found.len()],
        };
        if found.is_empty() || found.len() != expected.len() {
            return fail(&"another number of rows");
        }
        let mut pairs = found.iter().zip(expected);
        let wrong = pairs.find(|(found, expected)| !self.holds(**found, *expected));
        wrong.map_or(Ok(()), |(found, _)| fail(found))
    }

    fn holds(&self, found: f64, expected: f64) -> bool {
        let error = (found - expected).abs();
        match self.kind {
            "abs" => error <= number(self.tolerance),
            "rel" => error <= number(self.tolerance) * expected.abs(),
            "most" => found <= expected,
            "least" => found >= expected,
            other => panic!("unknown kind {other}"),
        }
    }

    fn step(&self, run: &Run) -> usize {
        match self.step {
            "last" => run.last_step(),
            "" | "all" => 0,
            number => number.parse().expect("a load step in expected.csv"),
        }
    }

    fn numbers(&self, run: &Run) -> Result<Vec<f64>, String> {
        match self.table {
            "run" => Ok(vec![f64::from(run.status)]),
            "identity" => Ok(vec![identities::value(
                self.column,
                run,
                self.step(run),
                self.key,
            )]),
            "packed" => Ok(vec![packed::value(self.column, &run.packed(), self.key)]),
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
        let table = run.table(self.table, self.step(run));
        let table = table.map_err(|error| error.to_string())?;
        let all = 0..table.len();
        let numbers = |column: &str| table.numbers(column).map_err(|e| e.to_string());
        let words = |column: &str| table.texts(column).map_err(|e| e.to_string());
        let rows: Vec<usize> = match self.table {
            "steps" if self.step == "all" => all.collect(),
            "steps" => {
                let (steps, wanted) = (numbers("step")?, self.step(run) as f64);
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
