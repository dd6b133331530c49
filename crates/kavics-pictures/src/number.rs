//! Numbers as they are shown.

const MINUS: char = '\u{2212}';

/// Five significant digits, in plain notation where that is short; an en dash where there is none.
pub fn show(value: f64) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let size = value.abs();
    let text = if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&size) {
        plain(value, 5)
    } else {
        scientific(value, 4)
    };
    text.replace('-', &MINUS.to_string())
}

/// Three significant digits, for a place of its own.
pub fn brief(value: f64) -> String {
    if value != 0.0 && value.is_finite() && !(1e-3..1e6).contains(&value.abs()) {
        return scientific(value, 2).replace('-', &MINUS.to_string());
    }
    show(value)
}

/// `value` with `digits` significant digits, without zeros at the end.
fn plain(value: f64, digits: i32) -> String {
    let before = value.abs().log10().floor() as i32 + 1;
    let after = (digits - before).max(0) as usize;
    let text = format!("{value:.after$}");
    if text.contains('.') {
        let text = text.trim_end_matches('0').trim_end_matches('.');
        text.to_owned()
    } else {
        text
    }
}

/// `value` as mantissa and power of ten, without zeros at the end of the mantissa.
fn scientific(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
    format!("{mantissa}e{exponent}")
}

/// A fixed number of decimals, as in a printed table; what rounds to zero has no sign.
pub fn fixed(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let text = format!("{value:.decimals$}");
    if text.chars().all(|c| matches!(c, '-' | '0' | '.')) {
        return text.trim_start_matches('-').to_owned();
    }
    text.replace('-', &MINUS.to_string())
}

/// A tick of an axis whose ticks are `step` apart.
pub fn tick(value: f64, step: f64) -> String {
    let largest = value.abs();
    if largest != 0.0 && !(1e-3..1e6).contains(&largest.max(step)) {
        return scientific(value, 2).replace('-', &MINUS.to_string());
    }
    if value == 0.0 && step < 1e-3 {
        return "0".to_owned();
    }
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    fixed(value, decimals)
}

#[cfg(test)]
mod tests {
    use super::{fixed, show, tick};

    #[test]
    fn a_number_is_as_short_as_its_digits_allow() {
        assert_eq!(show(0.0), "0");
        assert_eq!(show(-30.07), "−30.07");
        assert_eq!(show(123_456.7), "123457");
        assert_eq!(show(3.1e-12), "3.1e−12");
        assert_eq!(show(f64::NAN), "–");
    }

    #[test]
    fn nothing_is_minus_zero() {
        assert_eq!(fixed(-1e-9, 3), "0.000");
        assert_eq!(tick(-0.0, 0.5), "0.0");
        assert_eq!(tick(0.0, 1e-14), "0");
    }
}
