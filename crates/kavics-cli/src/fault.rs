//! What is said where the program itself is at fault: a sentence, and what becomes of the results.

use std::env;
use std::panic::{set_hook, take_hook};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::terminal::say_error;

/// Results that are being written.
static RESULTS: OnceLock<PathBuf> = OnceLock::new();

/// From now on a panic is told in a sentence; the exit status is 101, as of any panic.
pub fn tell_of_faults() {
    let usual = take_hook();
    set_hook(Box::new(move |panic| {
        if kavics_results::is_guarded() {
            return;
        }
        let what = panic.payload_as_str().unwrap_or("no reason is given");
        let place = panic.location().map(ToString::to_string);
        let place = place.unwrap_or_else(|| "an unknown place".to_owned());
        say_error(&sentence(what, &place, RESULTS.get().map(PathBuf::as_path)));
        // The trace is for those who ask for it.
        if env::var_os("RUST_BACKTRACE").is_some() {
            usual(panic);
        }
    }));
}

/// From now on results are written there.
pub fn name_results(folder: &Path) {
    let _ = RESULTS.set(folder.to_owned());
}

fn sentence(what: &str, place: &str, results: Option<&Path>) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let kept = results.map(|folder| {
        format!(
            "the load steps in {} are valid; kavics run --resume goes on from its last checkpoint\n",
            folder.display()
        )
    });
    format!(
        "error: a mistake in kavics {version} itself, not in what it was given: {what} ({place})\n{}\
         please report it with the scene and this message; RUST_BACKTRACE=1 adds how it came to it",
        kept.unwrap_or_default()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_says_where_it_is_and_what_becomes_of_the_results() {
        let text = sentence(
            "index 3 of 2",
            "search.rs:7:5",
            Some(Path::new("a.results")),
        );
        assert!(text.starts_with("error: a mistake in kavics"), "{text}");
        for part in ["index 3 of 2", "search.rs:7:5", "a.results", "--resume"] {
            assert!(text.contains(part), "{part} is not in {text}");
        }
    }

    #[test]
    fn a_fault_without_results_promises_none() {
        let text = sentence("index 3 of 2", "search.rs:7:5", None);
        assert!(
            !text.contains("--resume") && text.lines().count() == 2,
            "{text}"
        );
    }
}
