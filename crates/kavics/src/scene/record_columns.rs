//! Which columns of grains and contacts a scene has recorded.

use super::checker::Checker;
use super::diagnostic::{Problem, either, likely};
use super::file::RecordFile;
use super::value::Placed;

/// Columns of the table `grains` that a scene may choose from; `step` and `grain` are always there.
pub const GRAIN_COLUMNS: [&str; 17] = [
    "x",
    "y",
    "radius",
    "ux",
    "uy",
    "rotation",
    "fx",
    "fy",
    "moment",
    "contacts",
    "cell_area",
    "stress_xx",
    "stress_xy",
    "stress_yx",
    "stress_yy",
    "state",
    "window",
];

/// Columns of the table `contacts` that a scene may choose from; `step` and `contact` are always there.
pub const CONTACT_COLUMNS: [&str; 18] = [
    "first",
    "second",
    "nx",
    "ny",
    "branch_length",
    "dual_length",
    "dual_length_full",
    "opening",
    "shear",
    "relative_rotation",
    "normal_force",
    "shear_force",
    "bending_moment",
    "property",
    "law",
    "state",
    "x",
    "y",
];

/// The columns that are recorded after loading has begun; none: all of them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordColumns {
    /// Of the table `grains`.
    pub grains: Option<Vec<String>>,
    /// Of the table `contacts`.
    pub contacts: Option<Vec<String>>,
}

/// The columns that `[record]` names.
pub(super) fn record_columns(file: &RecordFile, checker: &mut Checker) -> RecordColumns {
    let grains = file.grains.as_ref();
    let grains = grains.map(|names| chosen(names, "grains", &GRAIN_COLUMNS, checker));
    let contacts = file.contacts.as_ref();
    let contacts = contacts.map(|names| chosen(names, "contacts", &CONTACT_COLUMNS, checker));
    RecordColumns { grains, contacts }
}

fn chosen(
    names: &[Placed<String>],
    table: &str,
    known: &[&str],
    checker: &mut Checker,
) -> Vec<String> {
    let is_unknown = |name: &&Placed<String>| !known.contains(&name.value.as_str());
    for name in names.iter().filter(is_unknown) {
        let expected = format!("expected {}", either(known.iter().copied()));
        let problem = format!("`{table}` has no column `{}`", name.value);
        checker.push(
            Problem::at(&name.span, problem, expected)
                .suggest(likely(&name.value, known.iter().copied())),
        );
    }
    names.iter().map(|name| name.value.clone()).collect()
}
