//! `log.ndjson`: when what was done; the only file with times in it.

use std::time::Instant;

use serde::Serialize;

#[derive(Serialize)]
struct Line<'a> {
    seconds: f64,
    what: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    step: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    iterations: Option<usize>,
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

    /// Goes on with the lines of an earlier log.
    pub(crate) fn resume(earlier: String, step: usize) -> Self {
        let mut log = Self {
            opened: Instant::now(),
            text: earlier,
        };
        // A line that was cut off stays as it is.
        if !log.text.is_empty() && !log.text.ends_with('\n') {
            log.text.push('\n');
        }
        log.add("resumed", Some(step), None);
        log
    }

    pub(crate) fn note(&mut self, what: &str) {
        self.add(what, None, None);
    }

    pub(crate) fn note_step(&mut self, step: usize, iterations: usize) {
        self.add("step", Some(step), Some(iterations));
    }

    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    fn add(&mut self, what: &str, step: Option<usize>, iterations: Option<usize>) {
        let line = Line {
            seconds: self.opened.elapsed().as_secs_f64(),
            what,
            step,
            iterations,
        };
        let line = serde_json::to_string(&line).expect("numbers and words are JSON");
        self.text.push_str(&line);
        self.text.push('\n');
    }
}
