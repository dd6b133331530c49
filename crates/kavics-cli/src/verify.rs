//! `kavics verify`: the validation cases, run by this very program on this machine.

use std::env;
use std::fmt::Write as _;
use std::io::{Write, stdout};
use std::sync::atomic::Ordering;
use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};
use kavics_verify::{Case, Finding, Verifier};
use rayon::prelude::*;

use crate::arguments::VerifyArguments;
use crate::failure::Failure;
use crate::progress::time;
use crate::signals::Stop;
use crate::terminal::{self, COLUMNS, Loudness, say};

/// Columns before the values of a quantity.
const QUANTITY: usize = 27;
/// Columns of a value.
const VALUE: usize = 12;

pub fn verify(arguments: &VerifyArguments) -> Result<(), Failure> {
    let cases = cases(arguments)?;
    let began = Instant::now();
    let findings = findings(&cases)?;
    let wrong = findings.iter().filter(|finding| !finding.holds).count();
    let mut out = stdout().lock();
    if arguments.json {
        for finding in &findings {
            let line = serde_json::to_string(finding).expect("words are JSON");
            writeln!(out, "{line}")?;
        }
    } else if terminal::loudness() != Loudness::Quiet {
        let every = terminal::loudness() == Loudness::Verbose;
        write!(out, "{}", table(&cases, &findings, every))?;
    }
    say(&format!(
        "{} cases, {} quantities: {} hold, {wrong} fail; {}\n",
        cases.len(),
        findings.len(),
        findings.len() - wrong,
        time(began.elapsed().as_secs_f64())
    ));
    if wrong > 0 {
        return Err(Failure::Verdict { wrong });
    }
    Ok(())
}

fn cases(arguments: &VerifyArguments) -> Result<Vec<Case>, Failure> {
    if arguments.cases.is_empty() {
        return Ok(Case::all());
    }
    let named = arguments.cases.iter().map(|name| Case::named(name));
    Ok(named.collect::<Result<_, _>>()?)
}

fn findings(cases: &[Case]) -> Result<Vec<Finding>, Failure> {
    // The room of the runs is cleared before the program ends, so that a signal is left to this task.
    let stop = Stop::wait("stopping after the present cases; once more to end at once\n")?;
    let told = stop.begin().map_err(|_| Failure::Interrupted)?;
    let verifier = Verifier::new(&env::current_exe()?)?;
    let bar = match terminal::loudness() {
        Loudness::Quiet => ProgressBar::hidden(),
        _ => ProgressBar::new(cases.len() as u64),
    };
    let style = ProgressStyle::with_template("case {pos}/{len} {bar:14} {msg}");
    bar.set_style(style.expect("a template that is known to be right"));
    let verified = cases.par_iter().map(|case| {
        let findings = verifier.verify(*case);
        if told.load(Ordering::Relaxed) {
            return Err(Failure::Interrupted);
        }
        let findings = findings?;
        bar.set_message(case.name);
        bar.inc(1);
        Ok(findings)
    });
    let findings: Vec<Vec<Finding>> = verified.collect::<Result<_, Failure>>()?;
    bar.finish_and_clear();
    Ok(findings.concat())
}

/// A line for each quantity, or only for the one of each case that uses most of its tolerance; what fails is always
/// there.
fn table(cases: &[Case], findings: &[Finding], every: bool) -> String {
    let mut text = line("case", "expected", "found", "tolerance", "verdict");
    for case in cases {
        let rows: Vec<&Finding> = findings.iter().filter(|f| f.case == case.name).collect();
        let nearest = nearest(&rows);
        let _ = writeln!(text, "{}: {} quantities", case.name, rows.len());
        for (place, row) in rows.iter().enumerate() {
            if every || !row.holds || Some(place) == nearest {
                text.push_str(&finding_line(row));
            }
        }
    }
    text
}

/// The row that uses most of its tolerance.
fn nearest(rows: &[&Finding]) -> Option<usize> {
    let share = |place: &usize| rows[*place].share.unwrap_or(0.0);
    (0..rows.len()).max_by(|a, b| share(a).total_cmp(&share(b)).then(b.cmp(a)))
}

fn finding_line(row: &Finding) -> String {
    let verdict = if row.holds { "holds" } else { "FAILS" };
    let quantity = format!("  {}: {}", row.run, row.quantity);
    let quantity = short(&quantity, COLUMNS);
    let values = line(
        "",
        &number(&row.expected),
        &number(&row.found),
        &row.tolerance,
        verdict,
    );
    format!("{quantity}\n{values}")
}

fn line(quantity: &str, expected: &str, found: &str, tolerance: &str, verdict: &str) -> String {
    format!("{quantity:<QUANTITY$} {expected:>VALUE$} {found:>VALUE$} {tolerance:<17} {verdict}\n")
}

/// A number in few digits; what is no number as it is, in as much room.
fn number(text: &str) -> String {
    match text.parse::<f64>() {
        Ok(value) if value == 0.0 || value.trunc() == value && value.abs() < 1e9 => {
            format!("{value:.0}")
        }
        Ok(value) if (1e-3..1e5).contains(&value.abs()) => format!("{value:.6}"),
        Ok(value) => format!("{value:.4e}"),
        Err(_) => short(text, VALUE),
    }
}

fn short(text: &str, columns: usize) -> String {
    if text.chars().count() <= columns {
        return text.to_owned();
    }
    let kept: String = text.chars().take(columns - 1).collect();
    format!("{kept}…")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(share: f64, holds: bool) -> Finding {
        Finding {
            case: "three-discs".to_owned(),
            run: "potential-tangent".to_owned(),
            quantity: format!("contacts step 3 0-1 bending_moment*bending_moment {share}"),
            expected: "-0.009835391753894068".to_owned(),
            found: "-123456.789012345678".to_owned(),
            tolerance: "± 1e-12 of it".to_owned(),
            share: Some(share),
            holds,
        }
    }

    #[test]
    fn the_table_fits_into_eighty_columns() {
        let cases = [Case::named("three-discs").expect("a case")];
        let text = table(&cases, &[finding(0.5, false)], true);
        assert!(
            text.lines().all(|line| line.chars().count() <= COLUMNS),
            "{text}"
        );
    }

    #[test]
    fn what_fails_is_always_there() {
        let cases = [Case::named("three-discs").expect("a case")];
        let findings = [finding(0.1, true), finding(0.9, true), finding(0.5, false)];
        let text = table(&cases, &findings, false);
        assert_eq!(text.matches("holds").count(), 1, "{text}");
        assert_eq!(text.matches("FAILS").count(), 1, "{text}");
    }
}
