//! What is said to the user on stderr, and how much of it.

use std::io::Write;
use std::sync::OnceLock;

use clap::builder::styling::{AnsiColor, Style};

/// How much is said.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Loudness {
    /// Errors only.
    Quiet,
    /// Progress, tables, warnings.
    #[default]
    Usual,
    /// What the solver does at each load step as well.
    Verbose,
}

/// Said once, at the start; every message asks for it.
static LOUDNESS: OnceLock<Loudness> = OnceLock::new();

/// Columns of a terminal that nothing exceeds.
pub const COLUMNS: usize = 80;

/// Warnings shown in full; a long run may repeat one at every load step.
const WARNINGS_SHOWN: usize = 12;

const WARNING: Style = AnsiColor::Yellow.on_default().bold();
const ERROR: Style = AnsiColor::Red.on_default().bold();

/// From here on so much is said.
pub fn speak(loudness: Loudness) {
    let _ = LOUDNESS.set(loudness);
}

/// How much is said.
pub fn loudness() -> Loudness {
    LOUDNESS.get().copied().unwrap_or_default()
}

/// Writes to stderr, unless only errors are wanted.
pub fn say(text: &str) {
    if loudness() != Loudness::Quiet {
        write(text);
    }
}

/// Writes to stderr where more than usual is wanted.
pub fn say_more(text: &str) {
    if loudness() == Loudness::Verbose {
        write(text);
    }
}

/// Writes an error to stderr, always.
pub fn say_error(text: &str) {
    match text.strip_prefix("error") {
        Some(rest) => write(&format!("{ERROR}error{ERROR:#}{rest}\n")),
        None => write(&format!("{text}\n")),
    }
}

/// Shows what the user should know.
pub fn show_warnings(warnings: &[String]) {
    for warning in warnings.iter().take(WARNINGS_SHOWN) {
        say(&shown(warning));
    }
    if let Some(more @ 1..) = warnings.len().checked_sub(WARNINGS_SHOWN) {
        say(&shown(&format!("and {more} more")));
    }
}

/// A warning in lines that fit.
fn shown(warning: &str) -> String {
    let text = wrapped(&format!("warning: {warning}"));
    let rest = text.strip_prefix("warning").unwrap_or(&text);
    format!("{WARNING}warning{WARNING:#}{rest}\n")
}

/// A sentence in lines that fit; all but the first are indented.
fn wrapped(text: &str) -> String {
    let mut lines = String::new();
    let mut column = 0;
    for word in text.split(' ') {
        let length = word.chars().count();
        if column > 0 && column + 1 + length >= COLUMNS {
            lines.push_str("\n  ");
            column = 2;
        } else if column > 0 {
            lines.push(' ');
            column += 1;
        }
        lines.push_str(word);
        column += length;
    }
    lines
}

/// Colours stay away where stderr is no terminal, and where `NO_COLOR` is set; a stderr that nobody reads any more is
/// no reason to stop.
fn write(text: &str) {
    let _ = anstream::stderr().write_all(text.as_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_sentence_is_broken_between_words() {
        let text = "word ".repeat(40);
        let text = text.trim_end();
        let lines = wrapped(text);
        assert!(lines.lines().all(|line| line.chars().count() < COLUMNS));
        let words: Vec<&str> = lines.split_whitespace().collect();
        assert_eq!(words.join(" "), text);
    }
}
