//! Lists of grains in csv files.

use std::path::Path;

use super::checker::LARGEST;

/// Columns of a list of grains.
const COLUMNS: [&str; 3] = ["x", "y", "radius"];

/// Rows of (x, y, radius), or a sentence that says what is wrong with the file.
pub fn read_csv(path: &Path) -> Result<Vec<[f64; 3]>, String> {
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_path(path)
        .map_err(|error| format!("cannot be read: {error}"))?;
    let header = reader.headers().map_err(|error| error.to_string())?.clone();
    if header.is_empty() {
        return Err("it is empty; expected columns `x`, `y` and `radius`".to_owned());
    }
    let mut places = [0; 3];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        let found = header.iter().position(|name| name == column);
        *place = found.ok_or_else(|| missing(column, &header))?;
        if header.iter().filter(|name| *name == column).count() > 1 {
            return Err(format!("line 1: column `{column}` stands twice"));
        }
    }
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| error.to_string())?;
        let line = record.position().map_or(0, csv::Position::line);
        let mut row = [0.0_f64; 3];
        for i in 0..3 {
            let text = record.get(places[i]).unwrap_or_default();
            row[i] = text.parse().map_err(|_| {
                format!(
                    "line {line}, column `{}`: \"{text}\" is not a number",
                    COLUMNS[i]
                )
            })?;
            if !is_right(i, row[i]) {
                return Err(wrong(&format!("line {line}"), i, row[i]));
            }
        }
        rows.push(row);
    }
    Ok(rows)
}

fn missing(column: &str, header: &csv::StringRecord) -> String {
    let names: Vec<String> = header.iter().map(|name| format!("`{name}`")).collect();
    format!("line 1: no column `{column}` among {}", names.join(", "))
}

/// Whether a column may have a value.
fn is_right(column: usize, value: f64) -> bool {
    let smallest = if column == 2 {
        LARGEST.recip()
    } else {
        -LARGEST
    };
    (smallest..=LARGEST).contains(&value)
}

fn wrong(place: &str, column: usize, value: f64) -> String {
    let expected = if column == 2 {
        "a positive number up to 1e30"
    } else {
        "a number up to 1e30"
    };
    format!(
        "{place}, column `{}`: {value:?} is not {expected}",
        COLUMNS[column]
    )
}

/// Whether rows of (x, y, radius) can be grains.
pub fn check(rows: &[[f64; 3]]) -> Result<(), String> {
    if rows.is_empty() {
        return Err("there is no grain in it".to_owned());
    }
    for (number, row) in rows.iter().enumerate() {
        for (column, value) in row.iter().enumerate() {
            if !is_right(column, *value) {
                return Err(wrong(&format!("row {}", number + 1), column, *value));
            }
        }
    }
    Ok(())
}
