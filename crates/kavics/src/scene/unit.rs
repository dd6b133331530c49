//! Numbers with a unit, turned into SI.
//!
//! A unit is made of simple ones, which `uom` knows, with `/`, `·` or `*`, and powers: `30 GPa`, `2.5 mm`,
//! `12 kN/m`, `2.4 t/m^3`.

use uom::si::f64::{Acceleration, Angle, Energy, Force, Length, Mass, Pressure, Ratio, Time};

/// Powers of mass, length, time and angle; an angle is told from a plain number, so that degrees stand for nothing else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Powers {
    mass: i32,
    length: i32,
    time: i32,
    angle: i32,
}

impl Powers {
    const NONE: Self = Self::new(0, 0, 0);
    const ANGLE: Self = Self {
        angle: 1,
        ..Self::NONE
    };

    const fn new(mass: i32, length: i32, time: i32) -> Self {
        Self {
            mass,
            length,
            time,
            angle: 0,
        }
    }

    fn plus(self, other: Self, power: i32) -> Self {
        Self {
            mass: self.mass + power * other.mass,
            length: self.length + power * other.length,
            time: self.time + power * other.time,
            angle: self.angle + power * other.angle,
        }
    }

    fn is_sane(self) -> bool {
        [self.mass, self.length, self.time, self.angle]
            .iter()
            .all(|p| p.abs() <= 12)
    }
}

/// What a number of the scene file measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// A number without unit.
    Number,
    /// An angle.
    Angle,
    /// A length.
    Length,
    /// A force.
    Force,
    /// A moment, `[force·length]`.
    Moment,
    /// `[force/length]`.
    ForcePerLength,
    /// `[force/length²]`.
    Stress,
    /// `[force/length³]`.
    StressPerLength,
    /// `[mass/length³]`.
    Density,
    /// `[length/time²]`.
    Acceleration,
}

impl Dimension {
    const ALL: [Self; 10] = [
        Self::Number,
        Self::Angle,
        Self::Length,
        Self::Force,
        Self::Moment,
        Self::ForcePerLength,
        Self::Stress,
        Self::StressPerLength,
        Self::Density,
        Self::Acceleration,
    ];

    fn powers(self) -> Powers {
        match self {
            Self::Number => Powers::NONE,
            Self::Angle => Powers::ANGLE,
            Self::Length => Powers::new(0, 1, 0),
            Self::Force => Powers::new(1, 1, -2),
            Self::Moment => Powers::new(1, 2, -2),
            Self::ForcePerLength => Powers::new(1, 0, -2),
            Self::Stress => Powers::new(1, -1, -2),
            Self::StressPerLength => Powers::new(1, -2, -2),
            Self::Density => Powers::new(1, -3, 0),
            Self::Acceleration => Powers::new(0, 1, -2),
        }
    }

    /// Whether a unit of these powers measures it; a bending stiffness is a moment, or one a radian.
    fn has(self, powers: Powers) -> bool {
        let a_radian = Powers::plus(self.powers(), Powers::ANGLE, -1);
        powers == self.powers() || (self == Self::Moment && powers == a_radian)
    }

    /// What it is called in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Number => "a number without unit",
            Self::Angle => "an angle",
            Self::Length => "a length",
            Self::Force => "a force",
            Self::Moment => "a moment (force·length)",
            Self::ForcePerLength => "a force per length",
            Self::Stress => "a stress (force/length²)",
            Self::StressPerLength => "a stress per length (force/length³)",
            Self::Density => "a density (mass/length³)",
            Self::Acceleration => "an acceleration (length/time²)",
        }
    }

    /// How it may be written.
    pub fn examples(self) -> &'static str {
        match self {
            Self::Number => "`0.5`",
            Self::Angle => "`0.1`, `\"0.1 rad\"` or `\"5 deg\"`",
            Self::Length => "`2.5`, `\"2.5 mm\"` or `\"0.3 m\"`",
            Self::Force => "`12.0`, `\"12 kN\"` or `\"800 N\"`",
            Self::Moment => "`12.0`, `\"12 kN·m\"` or `\"800 N·mm\"`",
            Self::ForcePerLength => "`12.0`, `\"12 kN/m\"` or `\"3 N/mm\"`",
            Self::Stress => "`3e10`, `\"30 GPa\"` or `\"12 N/mm^2\"`",
            Self::StressPerLength => "`1e9`, `\"1 GPa/m\"` or `\"3 N/mm^3\"`",
            Self::Density => "`2400.0`, `\"2400 kg/m^3\"` or `\"2.4 t/m^3\"`",
            Self::Acceleration => "`9.81` or `\"9.81 m/s^2\"`",
        }
    }
}

/// Why a number with a unit cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum UnitError {
    /// It does not begin with a number.
    NoNumber,
    /// No unit has this name; one that it may have meant.
    UnknownUnit(String, Option<&'static str>),
    /// The unit belongs to another dimension, with its name if it has one.
    WrongDimension(Option<&'static str>),
    /// The number is too large.
    TooLarge,
    /// A decimal comma stands after the number.
    Comma,
    /// A sign has no unit beside it.
    LoneSign,
}

/// The value of `text` in SI.
pub fn parse(text: &str, dimension: Dimension) -> Result<f64, UnitError> {
    let (number, unit) = split(text).ok_or(UnitError::NoNumber)?;
    if number.is_infinite() {
        return Err(UnitError::TooLarge);
    }
    if unit.starts_with(',') {
        return Err(UnitError::Comma);
    }
    let (factor, powers) = factor(unit)?;
    if dimension.has(powers) {
        Ok(number * factor)
    } else {
        let is = Dimension::ALL.into_iter().find(|d| d.has(powers));
        Err(UnitError::WrongDimension(is.map(Dimension::name)))
    }
}

/// The number at the start of a text, and the rest.
fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let begins = |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.');
    text.starts_with(begins).then_some(())?;
    let in_number = |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | 'e' | 'E');
    let longest = text.find(|c| !in_number(c)).unwrap_or(text.len());
    // The longest beginning that is a number, so that the e of an exponent belongs to it.
    let mut ends = (1..=longest).rev();
    ends.find_map(|end| Some((text[..end].parse().ok()?, text[end..].trim())))
}

/// The value of a unit in SI and its powers.
fn factor(unit: &str) -> Result<(f64, Powers), UnitError> {
    let mut value = 1.0;
    let mut powers = Powers::NONE;
    let mut sign = 1;
    let mut rest = unit;
    while !rest.is_empty() {
        let end = rest.find(['/', '·', '*', '⋅']).unwrap_or(rest.len());
        let (name, power) = power(rest[..end].trim());
        let (simple, simple_powers) = simple(name)?;
        value *= simple.powi(sign * power);
        powers = powers.plus(simple_powers, sign * power);
        if !powers.is_sane() {
            return Err(UnitError::WrongDimension(None));
        }
        let mut after = rest[end..].chars();
        match after.next() {
            None => break,
            Some(operator) => sign = if operator == '/' { -1 } else { 1 },
        }
        rest = after.as_str();
        if rest.trim().is_empty() {
            return Err(UnitError::LoneSign);
        }
    }
    Ok((value, powers))
}

/// A unit without its power, and the power.
fn power(text: &str) -> (&str, i32) {
    let cut = |suffix: &str, power| text.strip_suffix(suffix).map(|name| (name.trim(), power));
    let powers = [
        ("²", 2),
        ("³", 3),
        ("^2", 2),
        ("^3", 3),
        ("^4", 4),
        ("^1", 1),
        ("2", 2),
        ("3", 3),
    ];
    let inverse = [
        ("^-1", -1),
        ("^-2", -2),
        ("^-3", -3),
        ("⁻¹", -1),
        ("⁻²", -2),
        ("⁻³", -3),
    ];
    inverse
        .iter()
        .chain(&powers)
        .find_map(|(suffix, power)| cut(suffix, *power))
        .unwrap_or((text, 1))
}

/// Units that a mistyped one is compared with.
const USUAL: [&str; 24] = [
    "m", "dm", "cm", "mm", "µm", "km", "N", "kN", "MN", "GN", "mN", "Pa", "kPa", "MPa", "GPa", "g",
    "kg", "t", "s", "ms", "rad", "deg", "J", "kJ",
];

/// The value of a simple unit in SI and its powers.
fn simple(name: &str) -> Result<(f64, Powers), UnitError> {
    if name.is_empty() {
        return Err(UnitError::LoneSign);
    }
    // A nautical mile, which nobody means.
    if name == "M" {
        return Err(UnitError::UnknownUnit(name.to_owned(), Some("m")));
    }
    let name = match name {
        "deg" => "°",
        "um" | "\u{3bc}m" => "µm",
        name => name,
    };
    let text = format!("1 {name}");
    macro_rules! first_of {
        ($($quantity:ident: $powers:expr,)*) => {
            $(if let Ok(quantity) = text.parse::<$quantity>() {
                return Ok((quantity.value, $powers));
            })*
        };
    }
    first_of! {
        Length: Powers::new(0, 1, 0),
        Force: Powers::new(1, 1, -2),
        Pressure: Powers::new(1, -1, -2),
        Mass: Powers::new(1, 0, 0),
        Time: Powers::new(0, 0, 1),
        Angle: Powers::ANGLE,
        Energy: Powers::new(1, 2, -2),
        Acceleration: Powers::new(0, 1, -2),
        Ratio: Powers::NONE,
    }
    Err(UnitError::UnknownUnit(name.to_owned(), usual(name)))
}

/// The usual unit that a mistyped one is likely to be.
fn usual(name: &str) -> Option<&'static str> {
    let same_letters = USUAL
        .into_iter()
        .find(|usual| usual.eq_ignore_ascii_case(name));
    same_letters.or_else(|| {
        USUAL
            .into_iter()
            .filter(|usual| usual.len() > 1)
            .find(|usual| strsim::osa_distance(usual, name) == 1)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(text: &str, dimension: Dimension, value: f64) {
        let parsed = parse(text, dimension).unwrap_or_else(|e| panic!("{text}: {e:?}"));
        assert!(
            (parsed - value).abs() <= 1e-14 * value.abs(),
            "{text}: {parsed}"
        );
    }

    #[test]
    fn units_become_si() {
        close("30 GPa", Dimension::Stress, 30e9);
        close("30GPa", Dimension::Stress, 30e9);
        close("2.5 mm", Dimension::Length, 2.5e-3);
        close("-1e-3 m", Dimension::Length, -1e-3);
        close("12 kN/m", Dimension::ForcePerLength, 12e3);
        close("1 GPa/m", Dimension::StressPerLength, 1e9);
        close("3 N/mm^3", Dimension::StressPerLength, 3e9);
        close("5 N/mm²", Dimension::Stress, 5e6);
        close("2.4 t/m^3", Dimension::Density, 2400.0);
        close("9.81 m/s^2", Dimension::Acceleration, 9.81);
        close("9.81 m/s/s", Dimension::Acceleration, 9.81);
        close("2 kN·m", Dimension::Moment, 2e3);
        close("2 kN*mm", Dimension::Moment, 2.0);
        close("180 deg", Dimension::Angle, std::f64::consts::PI);
        close("0.1 rad", Dimension::Angle, 0.1);
        close("2 N·m/rad", Dimension::Moment, 2.0);
        close("1e3", Dimension::Number, 1e3);
        close("2650 kg/m3", Dimension::Density, 2650.0);
        close("9.81 m/s2", Dimension::Acceleration, 9.81);
        close("3 \u{b5}m", Dimension::Length, 3e-6);
        close("3 \u{3bc}m", Dimension::Length, 3e-6);
        close("3 %", Dimension::Number, 0.03);
        close(" 7 kg·m^-3 ", Dimension::Density, 7.0);
    }

    #[test]
    fn a_wrong_dimension_says_what_it_is() {
        assert_eq!(
            parse("30 GPa", Dimension::Length),
            Err(UnitError::WrongDimension(Some("a stress (force/length²)")))
        );
        assert_eq!(
            parse("1e3", Dimension::Stress),
            Err(UnitError::WrongDimension(Some("a number without unit")))
        );
        assert_eq!(
            parse("30 m/s", Dimension::Length),
            Err(UnitError::WrongDimension(None))
        );
    }

    #[test]
    fn an_angle_is_no_plain_number() {
        let is_angle = Err(UnitError::WrongDimension(Some("an angle")));
        assert_eq!(parse("30 deg", Dimension::Number), is_angle);
        assert_eq!(parse("1 rad", Dimension::Number), is_angle);
        let is_number = Err(UnitError::WrongDimension(Some("a number without unit")));
        assert_eq!(parse("3 %", Dimension::Angle), is_number);
        assert!(parse("3 m·rad", Dimension::Length).is_err());
        assert!(parse("3 rad/rad", Dimension::Number).is_ok());
    }

    #[test]
    fn what_is_no_unit_is_refused() {
        assert_eq!(parse("GPa", Dimension::Stress), Err(UnitError::NoNumber));
        assert_eq!(parse("", Dimension::Stress), Err(UnitError::NoNumber));
        assert_eq!(parse("nan m", Dimension::Length), Err(UnitError::NoNumber));
        assert_eq!(
            parse("30 gpa", Dimension::Stress),
            Err(UnitError::UnknownUnit("gpa".into(), Some("GPa")))
        );
        assert_eq!(
            parse("3 furlongz", Dimension::Length),
            Err(UnitError::UnknownUnit("furlongz".into(), None))
        );
        for lone in ["3 kN/", "3 m**1", "3 /m"] {
            assert_eq!(parse(lone, Dimension::Force), Err(UnitError::LoneSign));
        }
        assert_eq!(
            parse("1e400 m", Dimension::Length),
            Err(UnitError::TooLarge)
        );
        assert_eq!(parse("1,0 m", Dimension::Length), Err(UnitError::Comma));
        assert_eq!(parse("-inf m", Dimension::Length), Err(UnitError::NoNumber));
        assert!(parse("1 M", Dimension::Length).is_err());
        assert!(parse("3 m^2^2", Dimension::Length).is_err());
        assert!(parse("3 N//m", Dimension::Length).is_err());
    }
}
