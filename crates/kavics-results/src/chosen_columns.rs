//! Tables of which the scene has only some columns recorded.

use crate::column::Column;

/// Columns of grains that are the same at every load step.
const UNCHANGING_OF_GRAINS: [&str; 5] = ["x", "y", "radius", "cell_area", "window"];

/// Columns of contacts that are the same at every load step.
const UNCHANGING_OF_CONTACTS: [&str; 9] = [
    "first",
    "second",
    "nx",
    "ny",
    "branch_length",
    "dual_length",
    "dual_length_full",
    "x",
    "y",
];

/// Keeps the columns that are wanted, and the ids. Before loading all columns are kept: what does not change stands
/// there.
pub(crate) fn retain<R>(columns: &mut Vec<Column<R>>, wanted: Option<&[String]>, step: usize) {
    let Some(wanted) = wanted.filter(|_| step > 0) else {
        return;
    };
    let is_id = |name: &str| ["step", "grain", "contact"].contains(&name);
    columns.retain(|column| is_id(&column.name) || wanted.contains(&column.name));
}

/// The columns of a table that are the same at every load step.
pub(crate) fn unchanging(table: &str) -> &'static [&'static str] {
    match table {
        "grains" => &UNCHANGING_OF_GRAINS,
        "contacts" => &UNCHANGING_OF_CONTACTS,
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use kavics::scene::{CONTACT_COLUMNS, GRAIN_COLUMNS};

    use super::*;
    use crate::contacts::contact_columns;
    use crate::grains::grain_columns;

    #[test]
    fn every_column_can_be_chosen() {
        let grains = grain_columns();
        for column in &grains[2..] {
            assert!(
                GRAIN_COLUMNS.contains(&column.name.as_str()),
                "{}",
                column.name
            );
        }
        let contacts = contact_columns();
        let names: Vec<&str> = contacts.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names[2..], CONTACT_COLUMNS);
    }

    #[test]
    fn before_loading_all_columns_stay() {
        let mut columns = grain_columns();
        let (all, wanted) = (columns.len(), ["ux".to_owned()]);
        retain(&mut columns, Some(&wanted), 0);
        assert_eq!(columns.len(), all);
        retain(&mut columns, Some(&wanted), 1);
        let names: Vec<&str> = columns.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["step", "grain", "ux"]);
    }
}
