//! `log.ndjson`: when what was done; the only file with times in it.

use std::fs;
use std::path::Path;
use std::time::Instant;

use serde::Serialize;

use crate::ResultsError;
use crate::encode::publish;

/// Its name in a results folder.
pub(crate) const LOG: &str = "log.ndjson";

/// Notes in the log of a results folder that a run could not go on there, and why.
///
/// # Errors
/// A log that cannot be written.
pub fn note_refusal(folder: &Path, why: &str) -> Result<(), ResultsError> {
    let path = folder.join(LOG);
    let mut log = Log::after(fs::read_to_string(&path).unwrap_or_default());
    log.add(Line::of("refused").because(why));
    publish(&path, log.text().as_bytes())
}

#[derive(Clone, Copy, Default, Serialize)]
struct Line<'a> {
    seconds: f64,
    what: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    step: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    iterations: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    why: Option<&'a str>,
}

impl<'a> Line<'a> {
    fn of(what: &'a str) -> Self {
        Self {
            what,
            ..Self::default()
        }
    }

    fn because(self, why: &'a str) -> Self {
        Self {
            why: Some(why),
            ..self
        }
    }
}

/// Lines with the seconds since the log was opened.
#[derive(Debug)]
pub(crate) struct Log {
    opened: Instant,
    text: String,
}

impl Log {
    pub(crate) fn open() -> Self {
        let mut log = Self {
            opened: Instant::now(),
            text: String::new(),
        };
        log.note("opened");
        log
    }

    /// Goes on with the lines of an earlier log, and with what a checkpoint says of its own.
    pub(crate) fn resume(earlier: String, step: usize, notes: &[String]) -> Self {
        let mut log = Self::after(earlier);
        log.add(Line {
            step: Some(step),
            ..Line::of("resumed")
        });
        for note in notes {
            log.add(Line::of("warning").because(note));
        }
        log
    }

    fn after(mut text: String) -> Self {
        // A line that was cut off stays as it is.
        if !text.is_empty() && !text.ends_with('\n') {
            text.push('\n');
        }
        Self {
            opened: Instant::now(),
            text,
        }
    }

    pub(crate) fn note(&mut self, what: &str) {
        self.add(Line::of(what));
    }

    pub(crate) fn note_step(&mut self, step: usize, iterations: usize) {
        self.add(Line {
            step: Some(step),
            iterations: Some(iterations),
            ..Line::of("step")
        });
    }

    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    fn add(&mut self, line: Line<'_>) {
        let line = Line {
            seconds: self.opened.elapsed().as_secs_f64(),
            ..line
        };
        let line = serde_json::to_string(&line).expect("numbers and words are JSON");
        self.text.push_str(&line);
        self.text.push('\n');
    }
}
