//! The viewer within the page: its style, its data, its script, and the policy that admits this script and no other.

use std::path::Path;

use kavics_pictures::PictureError;
use kavics_results::ResultsError;
use kavics_viewer::{Embedded, PageError, PageFolder, StepChoice, admitted, bundle, embed, script};

use crate::ReportError;
use crate::plot::escape;

/// Bytes of the whole page, at most.
const MOST_BYTES: usize = 30_000_000;

/// Room for the elements around the data.
const ELEMENTS: usize = 4_000;

/// Where the parts stand in the page; text of the run cannot look like these, as its < is written otherwise.
const POLICY: &str = "<!-- policy -->";
const PLACE: &str = "<!-- viewer -->";
const DATA: &str = "<!-- data -->";

/// The page with the viewer of the results in `folder`, or with a sentence why it is not there.
pub(crate) fn with_viewer(
    page: &str,
    folder: &Path,
    steps: &StepChoice,
) -> Result<String, ReportError> {
    let script = script();
    let taken = page.len() + script.len() + bundle::STYLE.len() + ELEMENTS;
    let budget = MOST_BYTES.saturating_sub(taken);
    let embedded = match embed(&PageFolder::open(folder)?, steps, budget) {
        Err(error) if lacks_a_column(&error) => Embedded {
            left_out: vec![format!(
                "The viewer is left out, as a column is not recorded: {error}."
            )],
            ..Embedded::default()
        },
        embedded => embedded?,
    };
    let mut rest = page;
    let mut whole = String::with_capacity(taken + embedded.html.len());
    for (mark, part) in [
        (POLICY, policy(&script)),
        (PLACE, place(&embedded)),
        (DATA, data(&embedded, &script)),
    ] {
        let (before, after) = rest.split_once(mark).unwrap_or((rest, ""));
        whole.push_str(before);
        whole.push_str(&part);
        rest = after;
    }
    whole.push_str(rest);
    Ok(whole)
}

/// Whether it is for the scene's choice of columns that something cannot be shown.
fn lacks_a_column(error: &PageError) -> bool {
    let results = match error {
        PageError::NoColumn { .. } => return true,
        PageError::Results(error) | PageError::Picture(PictureError::Results(error)) => error,
        _ => return false,
    };
    matches!(results, ResultsError::NoColumn { .. })
}

/// No network, and no script but the viewer's.
fn policy(script: &str) -> String {
    format!(
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src {}; \
         style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; form-action 'none'\">",
        admitted(script)
    )
}

/// Where the viewer stands, with what was left out of it.
fn place(embedded: &Embedded) -> String {
    let notes: Vec<String> = embedded.left_out.iter().map(|text| escape(text)).collect();
    let notes = match notes.as_slice() {
        [] => String::new(),
        notes => format!(
            "<p class=\"soft\">{} <code>kavics view</code> shows all that is recorded.</p>\n",
            notes.join(" ")
        ),
    };
    if embedded.html.is_empty() {
        return notes;
    }
    format!(
        "<section class=\"viewer\">\n<h2>Viewer</h2>\n{notes}<style>{}</style>\n<div id=\"kavics-viewer\"></div>\n\
         <noscript><p class=\"soft\">The viewer needs JavaScript; the pictures below do not.</p></noscript>\n</section>",
        bundle::STYLE
    )
}

/// The data, and the script that shows them.
fn data(embedded: &Embedded, script: &str) -> String {
    if embedded.html.is_empty() {
        return String::new();
    }
    format!("{}<script>{script}</script>", embedded.html)
}
