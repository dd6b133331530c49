//! The table of all findings as a page of the documentation.

use std::fmt::Write;

use crate::case::Case;
use crate::expected::Finding;

/// Significant digits of a number on the page: fewer than rounding reaches.
const DIGITS: i32 = 8;

/// The findings as Markdown, case by case.
pub fn page(findings: &[Finding]) -> String {
    let mut text = String::from(
        "# Validation\n\n\
         What the program finds for closed forms, identities and published figures. This page is written by the test\n\
         that runs the cases (`crates/kavics-cli/tests/validation.rs`); `kavics verify` prints the same on any machine.\n\
         Where the numbers come from, and why the tolerances are what they are, stands in the README of each folder of\n\
         [validation](../validation/README.md). Of a quantity with several values the one farthest off is shown, to\n\
         eight digits; what is smaller than its tolerance is shown as 0.\n",
    );
    for case in Case::all() {
        let rows: Vec<&Finding> = findings.iter().filter(|f| f.case == case.name).collect();
        if rows.is_empty() {
            continue;
        }
        let _ = write!(
            text,
            "\n## {}\n\n[{name}](../validation/{name}/README.md)\n\n\
             | run | quantity | expected | found | tolerance | |\n|---|---|---|---|---|---|\n",
            case.title(),
            name = case.name
        );
        for row in rows {
            let _ = writeln!(
                text,
                "| {} | {} | {} | {} | {} | {} |",
                row.run,
                row.quantity.replace('*', "·"),
                brief(&row.expected, row),
                brief(&row.found, row),
                row.tolerance,
                if row.holds { "holds" } else { "**fails**" }
            );
        }
    }
    text
}

/// A number without the digits that are rounding; a word as it is.
fn brief(text: &str, row: &Finding) -> String {
    let Ok(value) = text.parse::<f64>() else {
        return text.to_owned();
    };
    let absolute = row.tolerance.strip_prefix("± ");
    let bound = absolute.and_then(|bound| bound.parse::<f64>().ok());
    if bound.is_some_and(|bound| value.abs() <= bound) || value == 0.0 {
        return "0".to_owned();
    }
    let place = DIGITS - 1 - value.abs().log10().floor() as i32;
    if (0..=12).contains(&place) {
        let text = format!("{value:.*}", place as usize);
        let text = text.trim_end_matches('0').trim_end_matches('.');
        return text.to_owned();
    }
    format!("{value:.*e}", DIGITS as usize - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(tolerance: &str) -> Finding {
        Finding {
            case: "patch-test".to_owned(),
            run: "mixed".to_owned(),
            quantity: "grains 1 * ux".to_owned(),
            expected: "0".to_owned(),
            found: "1e-14".to_owned(),
            tolerance: tolerance.to_owned(),
            share: None,
            holds: true,
        }
    }

    #[test]
    fn digits_of_rounding_are_left_out() {
        let row = finding("± 1e-12 of it");
        assert_eq!(brief("0.5773502691896258", &row), "0.57735027");
        assert_eq!(brief("-2", &row), "-2");
        assert_eq!(brief("broke", &row), "broke");
        assert_eq!(brief("1e-14", &finding("± 1e-12")), "0");
        assert_eq!(brief("0.000000009835391753", &row), "9.8353918e-9");
    }

    #[test]
    fn a_case_has_its_heading_and_a_line_a_finding() {
        let page = page(&[finding("± 1e-12")]);
        assert!(page.contains("## Patch test on a tessellation"));
        assert!(page.contains("| mixed | grains 1 · ux | 0 | 0 | ± 1e-12 | holds |"));
    }
}
