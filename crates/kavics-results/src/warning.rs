//! Warnings of the solver in words.

use kavics::equilibrium::Warning;

/// What a warning of load step `step` says.
pub fn warning_text(step: usize, warning: &Warning) -> String {
    let what = match warning {
        Warning::RegularisedPivots { count } => {
            format!(
                "{} that no load moves held in place",
                counted(*count, "floppy mode")
            )
        }
        Warning::ShearFloor { contacts } => {
            format!(
                "shear modulus at its floor in {}",
                counted(*contacts, "contact")
            )
        }
        Warning::SecondOrderWork { contacts } => {
            format!(
                "second-order work negative in {}",
                counted(*contacts, "contact")
            )
        }
    };
    format!("load step {step}: {what}")
}

fn counted(count: usize, word: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {word}{plural}")
}
