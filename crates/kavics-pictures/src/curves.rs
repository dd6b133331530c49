//! Curves of a run: columns of `steps`, or displacements and forces of its loads and moves.

use std::collections::BTreeMap;

use kavics::geometry::Vector;
use kavics_results::{Columns, ResultsFolder};

use crate::PictureError;
use crate::axis::Axis;
use crate::colouring::check_column;
use crate::font::Font;
use crate::ink::Ink;
use crate::legend::{Entry, Units, finish};
use crate::picture::{Anchor, Mark, Pen, Picture, Shape, TYPE_SIZE, Text};
use crate::view::MARGIN;

/// Curves that are wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveRequest {
    /// What stands upwards: columns of `steps`, or `NAME.force`, `NAME.displacement`, `NAME.factor` of a load or move.
    pub curves: Vec<String>,
    /// What stands across.
    pub against: String,
    /// Width of the sheet, mm.
    pub width: f64,
    /// Words for units.
    pub units: Units,
}

/// Height of the frame over the width of the sheet.
const HEIGHT: f64 = 0.62;
/// Length of a tick, mm.
const TICK: f64 = 1.2;
/// Room between ticks, numbers and names, mm.
const APART: f64 = 1.0;
/// Curves with more points have no marks.
const MARKED: usize = 25;
/// What a load or move tells of itself.
const OF_ACTIONS: [&str; 3] = ["factor", "displacement", "force"];

/// Numbers by load step, with their name and dimension.
struct Quantity {
    name: String,
    unit: String,
    values: BTreeMap<usize, f64>,
}

/// Draws curves.
///
/// # Errors
/// Results that cannot be read; a column, load or move that is not there; a column without a value.
pub fn draw_curves(
    folder: &ResultsFolder,
    request: &CurveRequest,
) -> Result<Picture, PictureError> {
    let across = Quantity::read(folder, &request.against)?;
    let curves = request
        .curves
        .iter()
        .map(|name| Quantity::read(folder, name));
    let curves = curves.collect::<Result<Vec<_>, _>>()?;
    let points: Vec<Vec<Vector>> = curves.iter().map(|curve| curve.over(&across)).collect();
    let tens = [
        power_of_ten(points.iter().flatten().map(|point| point.x)),
        power_of_ten(points.iter().flatten().map(|point| point.y)),
    ];
    let points: Vec<Vec<Vector>> = points.iter().map(|points| scaled(points, tens)).collect();
    let mut chart = Chart::new(request, &points);
    chart.picture.title = title(folder, &across, &curves)?;
    let across = across.label(&request.units) + &times(tens[0]);
    let upwards = upward_label(&curves, &request.units) + &times(tens[1]);
    chart.draw_axes(across.trim_start(), upwards.trim_start());
    for (number, points) in points.iter().enumerate() {
        chart.draw_curve(points, Ink::Series(number as u8));
    }
    let entries = chart.entries(&curves, request);
    let Chart {
        mut picture,
        bottom,
        ..
    } = chart;
    let below = bottom + TICK + 2.0 * APART + 2.0 * TYPE_SIZE + 0.5 * APART;
    finish(&mut picture, below, &entries);
    if entries.is_empty() {
        picture.height = below + 0.5 * MARGIN;
    }
    Ok(picture)
}

fn title(
    folder: &ResultsFolder,
    across: &Quantity,
    curves: &[Quantity],
) -> Result<String, PictureError> {
    let title = folder.record()?.title;
    let apart = if title.is_empty() { "" } else { ": " };
    let names: Vec<&str> = curves.iter().map(|curve| curve.name.as_str()).collect();
    Ok(format!(
        "{title}{apart}{} over {}",
        names.join(", "),
        across.name
    ))
}

/// The power of ten that is taken out of numbers too small or large to be written as they are; else 0.
fn power_of_ten(values: impl Iterator<Item = f64>) -> i32 {
    let finite = values.filter(|value| value.is_finite());
    let largest = finite.fold(0.0, |most: f64, value| most.max(value.abs()));
    if largest == 0.0 || (0.01..1e5).contains(&largest) {
        return 0;
    }
    largest.log10().floor() as i32
}

/// Points without the powers of ten that stand beside the axes.
fn scaled(points: &[Vector], [across, upwards]: [i32; 2]) -> Vec<Vector> {
    let (x, y) = (10f64.powi(-across), 10f64.powi(-upwards));
    let point = |point: &Vector| Vector::new(point.x * x, point.y * y);
    points.iter().map(point).collect()
}

/// A power of ten as it stands beside an axis.
fn times(power: i32) -> String {
    if power == 0 {
        return String::new();
    }
    let raised = |digit: char| match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32(0x2070 + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit),
    };
    let power: String = power.to_string().chars().map(raised).collect();
    format!(" × 10{power}")
}

/// What stands beside the upward axis: the one curve, or the dimension that all have.
fn upward_label(curves: &[Quantity], units: &Units) -> String {
    match curves {
        [curve] => curve.label(units),
        [first, rest @ ..] if rest.iter().all(|curve| curve.unit == first.unit) => {
            dimension(&first.unit, units)
        }
        _ => String::new(),
    }
}

impl Quantity {
    fn read(folder: &ResultsFolder, name: &str) -> Result<Self, PictureError> {
        match name.rsplit_once('.') {
            Some((action, column)) if OF_ACTIONS.contains(&column) => {
                Self::of_action(&folder.actions()?, action, column)
            }
            _ => Self::of_steps(&folder.steps()?, name),
        }
    }

    fn of_steps(table: &Columns, column: &str) -> Result<Self, PictureError> {
        check_column(table, "steps", column)?;
        let values = steps(table)?.into_iter().zip(table.numbers(column)?);
        let values: BTreeMap<usize, f64> = values.collect();
        if !values.is_empty() && values.values().all(|value| value.is_nan()) {
            return Err(PictureError::NoValue {
                column: column.to_owned(),
            });
        }
        Ok(Self {
            name: column.replace('_', " "),
            unit: table.unit(column).unwrap_or_default().to_owned(),
            values,
        })
    }

    fn of_action(table: &Columns, action: &str, column: &str) -> Result<Self, PictureError> {
        let names = table.texts("action")?;
        let rows = steps(table)?
            .into_iter()
            .zip(table.numbers(column)?)
            .zip(&names);
        let own = rows
            .filter(|(_, name)| **name == action)
            .map(|(row, _)| row);
        let values: BTreeMap<usize, f64> = own.collect();
        if values.is_empty() {
            let mut known = names.clone();
            known.sort_unstable();
            known.dedup();
            return Err(PictureError::no_action(action, &known));
        }
        Ok(Self {
            name: format!("{column} of {action}"),
            unit: table.unit(column).unwrap_or_default().to_owned(),
            values,
        })
    }

    /// The points of this curve, load step by load step.
    fn over(&self, across: &Self) -> Vec<Vector> {
        let point = |(step, &y): (&usize, &f64)| Some(Vector::new(*across.values.get(step)?, y));
        self.values.iter().filter_map(point).collect()
    }

    fn label(&self, units: &Units) -> String {
        match dimension(&self.unit, units) {
            unit if unit.is_empty() => self.name.clone(),
            unit => format!("{} ({unit})", self.name),
        }
    }
}

fn steps(table: &Columns) -> Result<Vec<usize>, PictureError> {
    let steps = table.integers("step")?.into_iter();
    Ok(steps
        .map(|step| usize::try_from(step.unwrap_or(0)).unwrap_or(0))
        .collect())
}

/// A dimension of the tables in the user's words for units, where there are some.
fn dimension(unit: &str, units: &Units) -> String {
    if unit.is_empty() || unit == "1" {
        return String::new();
    }
    let given = |word: &str, given: &str| {
        if given.is_empty() {
            word.to_owned()
        } else {
            given.to_owned()
        }
    };
    unit.replace("force", &given("force", &units.force))
        .replace("length", &given("length", &units.length))
        .replace("^2", "²")
        .replace("^3", "³")
        .replace('*', "·")
}

/// A frame with axes.
struct Chart {
    picture: Picture,
    font: Font,
    x: Axis,
    y: Axis,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

impl Chart {
    fn new(request: &CurveRequest, points: &[Vec<Vector>]) -> Self {
        let all = || points.iter().flatten();
        let font = Font::new();
        let count = (request.width / 18.0).clamp(2.0, 8.0);
        let x = Axis::over(all().map(|point| point.x), count);
        let y = Axis::over(all().map(|point| point.y), (count * HEIGHT * 1.5).max(2.0));
        let widest = |axis: &Axis| {
            let widths = axis
                .ticks()
                .iter()
                .map(|tick| font.width(&tick.label, TYPE_SIZE));
            widths.fold(0.0, f64::max)
        };
        let top = MARGIN + 0.5 * TYPE_SIZE;
        Self {
            left: MARGIN + 1.2 * TYPE_SIZE + APART + widest(&y) + APART + TICK,
            right: request.width - MARGIN - 0.5 * widest(&x),
            bottom: top + HEIGHT * request.width,
            top,
            picture: Picture {
                width: request.width,
                ..Picture::default()
            },
            font,
            x,
            y,
        }
    }

    fn point(&self, point: Vector) -> Vector {
        Vector::new(
            self.left + self.x.share(point.x) * (self.right - self.left),
            self.bottom - self.y.share(point.y) * (self.bottom - self.top),
        )
    }

    fn draw_axes(&mut self, across: &str, upward: &str) {
        let (left, right, top, bottom) = (self.left, self.right, self.top, self.bottom);
        let at = Vector::new;
        let mut lines = Vec::new();
        let mut zero = Vec::new();
        for tick in self.y.ticks().to_vec() {
            let y = bottom - self.y.share(tick.value) * (bottom - top);
            lines.push(Shape::Line([at(left - TICK, y), at(left, y)]));
            if tick.value == 0.0 && y < bottom - 0.1 {
                zero.push(Shape::Line([at(left, y), at(right, y)]));
            }
            let place = at(left - TICK - APART, y + 0.36 * TYPE_SIZE);
            self.picture.text(place, &tick.label, Anchor::End);
        }
        for tick in self.x.ticks().to_vec() {
            let x = left + self.x.share(tick.value) * (right - left);
            lines.push(Shape::Line([at(x, bottom), at(x, bottom + TICK)]));
            if tick.value == 0.0 && x > left + 0.1 {
                zero.push(Shape::Line([at(x, top), at(x, bottom)]));
            }
            let place = at(x, bottom + TICK + APART + 0.8 * TYPE_SIZE);
            self.picture.text(place, &tick.label, Anchor::Middle);
        }
        self.picture.stroke(zero, Ink::Grid, Pen::of(0.2));
        lines.push(Shape::Polyline(vec![
            at(left, top),
            at(left, bottom),
            at(right, bottom),
        ]));
        self.picture.stroke(lines, Ink::Text, Pen::of(0.25));
        let middle = at(
            0.5 * (left + right),
            bottom + TICK + 2.0 * APART + 1.8 * TYPE_SIZE,
        );
        self.picture.text(middle, across, Anchor::Middle);
        self.picture.marks.push(Mark::Text(Text {
            at: at(MARGIN + 0.9 * TYPE_SIZE, 0.5 * (top + bottom)),
            words: upward.to_owned(),
            size: TYPE_SIZE,
            anchor: Anchor::Middle,
            upwards: true,
            ink: Ink::Text,
        }));
    }

    /// A line that is broken where a value is missing, with marks where there are few.
    fn draw_curve(&mut self, points: &[Vector], ink: Ink) {
        let parts = points.split(|point| !point.x.is_finite() || !point.y.is_finite());
        let lines = parts.filter(|part| part.len() > 1);
        let line = |part: &[Vector]| Shape::Polyline(part.iter().map(|&p| self.point(p)).collect());
        let lines: Vec<Shape> = lines.map(line).collect();
        let known = points
            .iter()
            .filter(|point| point.x.is_finite() && point.y.is_finite());
        let marks: Vec<Shape> = known.map(|&p| Shape::Circle(self.point(p), 0.55)).collect();
        self.picture.stroke(
            lines,
            ink,
            Pen {
                round: true,
                ..Pen::of(0.4)
            },
        );
        if points.len() <= MARKED {
            self.picture.fill(marks, ink);
        }
    }

    /// What the colours mean, where there are several; each with its dimension where they differ.
    fn entries(&self, curves: &[Quantity], request: &CurveRequest) -> Vec<Entry> {
        if curves.len() < 2 {
            return Vec::new();
        }
        let alike = curves.iter().all(|curve| curve.unit == curves[0].unit);
        let label = |curve: &Quantity| {
            if alike {
                curve.name.clone()
            } else {
                curve.label(&request.units)
            }
        };
        let room = request.width - 2.0 * MARGIN;
        let entry = |(number, curve): (usize, &Quantity)| {
            let mut label = label(curve);
            while self.font.width(&label, TYPE_SIZE) > room && label.pop().is_some() {}
            Entry::Line(Ink::Series(number as u8), Pen::of(0.5), label)
        };
        curves.iter().enumerate().map(entry).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_and_large_numbers_give_a_power_of_ten() {
        let power = |value| power_of_ten([value, f64::NAN].into_iter());
        assert_eq!(
            [power(3.7e-4), power(-0.5), power(99.0), power(2e6)],
            [-4, 0, 0, 6]
        );
        assert_eq!(times(-14), " × 10⁻¹⁴");
        assert_eq!(times(0), "");
    }

    #[test]
    fn dimensions_take_the_words_of_the_user() {
        let units = Units {
            length: "mm".to_owned(),
            force: "N".to_owned(),
        };
        assert_eq!(dimension("force/length^2", &units), "N/mm²");
        assert_eq!(dimension("force*length", &Units::default()), "force·length");
        assert_eq!(dimension("1", &units), "");
    }
}
