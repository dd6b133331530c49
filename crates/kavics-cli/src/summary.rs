//! The table that ends a run, 80 columns wide.

use std::fmt::Write;
use std::time::Duration;

use kavics::measure::{StressPartition, Tensor};
use kavics::scene::Scene;
use kavics_report::Comparison;
use kavics_results::{RunState, StepRow};

use crate::progress::time;

/// Load steps shown before and after the gap, where there are more.
const SHOWN: usize = 10;

/// The same where a load step takes two lines.
const PARTS_SHOWN: usize = 5;

/// Share of the run's largest stress below which a stress is rounding.
const ROUNDING: f64 = 1e-9;

/// The load steps and the parts of the stress.
pub fn summary(steps: &[StepRow]) -> String {
    if steps.is_empty() {
        return "no load step was finished\n".to_owned();
    }
    let scale = Scale::of(steps);
    let mut text = steps_table(steps, scale);
    if steps.iter().any(|row| row.measures.stress.is_some()) {
        text.push_str(&parts_table(steps, scale));
    }
    text
}

/// What the run came to, in a line or two.
pub fn closing(scene: &Scene, steps: &[StepRow], state: RunState, took: Duration) -> String {
    let Some(last) = steps.last() else {
        return String::new();
    };
    let residual = steps.iter().map(|row| row.residual).fold(0.0, f64::max);
    let plural = if steps.len() == 1 { "" } else { "s" };
    format!(
        "\n{}: {} load step{plural} in {}, {} of {} contacts broken,\nlargest residual {residual:.1e}\n",
        state.name(),
        steps.len(),
        time(took.as_secs_f64()),
        last.broken,
        scene.assembly.contacts.len(),
    )
}

/// How large the stresses of the run are, and the power of ten taken out of those that would not fit.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Scale {
    largest: f64,
    power: i32,
}

impl Scale {
    fn of(steps: &[StepRow]) -> Self {
        let stresses = steps.iter().filter_map(|row| row.measures.stress);
        let largest = stresses
            .flat_map(components)
            .map(f64::abs)
            .fold(0.0, f64::max);
        let fits = largest == 0.0 || (0.1..1000.0).contains(&largest);
        let thousands = (largest.log10() / 3.0).floor() as i32;
        Self {
            largest,
            power: if fits { 0 } else { 3 * thousands },
        }
    }

    fn apply(self, value: f64) -> f64 {
        // −0.0 would print as "-0.000".
        let scaled = value / 10f64.powi(self.power);
        if scaled.abs() < 5e-4 { 0.0 } else { scaled }
    }

    fn heading(self) -> String {
        if self.power == 0 {
            String::new()
        } else {
            format!(" (stresses in 1e{})", self.power)
        }
    }
}

fn components(parts: StressPartition) -> Vec<f64> {
    let tensors = [parts.total, parts.shear, parts.variation, parts.fabric];
    let mut all: Vec<f64> = tensors
        .iter()
        .flat_map(|t| [t.xx, t.xy, t.yx, t.yy])
        .collect();
    all.push(parts.isotropic);
    all
}

fn steps_table(steps: &[StepRow], scale: Scale) -> String {
    let heading = match scale.heading().as_str() {
        "" => String::new(),
        heading => format!("load steps{heading}\n"),
    };
    let mut text = format!(
        "{heading}{:>5} {:>9} {:>5} {:>9} {:>8} {:>7} {:>9} {:>9} {:>7}\n",
        "step",
        "factor",
        "iter.",
        "residual",
        "contacts",
        "broken",
        "stress xx",
        "stress yy",
        "s/v"
    );
    for row in rows_shown(steps, SHOWN) {
        text.push_str(&row.map_or_else(|| "    …\n".to_owned(), |row| step_line(row, scale)));
    }
    text
}

fn step_line(row: &StepRow, scale: Scale) -> String {
    let stress = row.measures.stress;
    let shown = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.3}"));
    let scaled = |value: f64| scale.apply(value);
    format!(
        "{:>5} {:>9} {:>5} {:>9.1e} {:>8} {:>7} {:>9} {:>9} {:>7}\n",
        row.step,
        fitting(row.load_factor, 9),
        row.iterations,
        row.residual,
        row.contacts,
        row.broken,
        shown(stress.map(|s| scaled(s.total.xx))),
        shown(stress.map(|s| scaled(s.total.yy))),
        (stress.and_then(|parts| shear_over_variation(parts, scale)))
            .map_or_else(|| "-".to_owned(), |ratio| fitting(ratio, 7)),
    )
}

/// A number with as many places as fit into some columns: six in twelve, five in nine, three in fewer.
fn fitting(value: f64, columns: usize) -> String {
    let places = match columns {
        10.. => 6,
        9 => 5,
        _ => 3,
    };
    let places = (0..=places).rev().map(|places| format!("{value:.places$}"));
    let mut fitting = places.filter(|text| text.chars().count() <= columns);
    fitting.next().unwrap_or_else(|| format!("{value:.1e}"))
}

/// The shear part over the normal variation part, by their deviators' magnitudes.
fn shear_over_variation(parts: StressPartition, scale: Scale) -> Option<f64> {
    let variation = deviator(parts.variation);
    (variation > ROUNDING * scale.largest).then(|| deviator(parts.shear) / variation)
}

fn deviator(tensor: Tensor) -> f64 {
    let difference = 0.5 * (tensor.xx - tensor.yy);
    let mixed = 0.5 * (tensor.xy + tensor.yx);
    (difference * difference + mixed * mixed).sqrt()
}

fn parts_table(steps: &[StepRow], scale: Scale) -> String {
    let mut text = format!(
        "\nparts of the stress{}\n{:<12}{:^19} {:^19} {:^19} {:>8}\n",
        scale.heading(),
        "step, factor",
        "shear",
        "variation",
        "fabric",
        "isotrop."
    );
    for row in rows_shown(steps, PARTS_SHOWN) {
        match row {
            None => text.push_str("…\n"),
            Some(row) => text.push_str(&part_lines(row, scale)),
        }
    }
    text
}

fn part_lines(row: &StepRow, scale: Scale) -> String {
    let step = row.step.to_string();
    let room = 11_usize.saturating_sub(step.len() + 3).max(4);
    let label = format!("{step} ({})", fitting(row.load_factor, room.min(8)));
    let Some(parts) = row.measures.stress else {
        return format!("{label:<12}no stress: the window is empty\n");
    };
    let tensors = [parts.shear, parts.variation, parts.fabric];
    let line = |brackets: [&str; 2], pick: fn(Tensor) -> [f64; 2]| {
        tensors
            .map(|tensor| {
                let [a, b] = pick(tensor).map(|value| scale.apply(value));
                format!("{}{a:>8.3} {b:>8.3}{}", brackets[0], brackets[1])
            })
            .join(" ")
    };
    let upper = line(["⎡", "⎤"], |t| [t.xx, t.xy]);
    let lower = line(["⎣", "⎦"], |t| [t.yx, t.yy]);
    let isotropic = scale.apply(parts.isotropic);
    format!("{label:<12}{upper} {isotropic:>8.3}\n{:12}{lower}\n", "")
}

/// All rows, or the first and the last with a gap between them.
fn rows_shown(steps: &[StepRow], shown: usize) -> Vec<Option<&StepRow>> {
    if steps.len() <= 2 * shown {
        return steps.iter().map(Some).collect();
    }
    let first = steps[..shown].iter().map(Some);
    let last = steps[steps.len() - shown..].iter().map(Some);
    first.chain([None]).chain(last).collect()
}

/// The run beside the table it is compared with: the largest difference of each column.
pub fn compared(comparison: &Comparison) -> String {
    let by = &comparison.matched_by;
    let mut text =
        format!("\nbeside compare.csv, matched by {by}: the largest difference of each column\n");
    for note in &comparison.notes {
        let _ = writeln!(text, "# {note}");
    }
    if comparison
        .columns
        .iter()
        .all(|column| column.rows.is_empty())
    {
        let _ = writeln!(
            text,
            "no row of the table belongs to a load step of the run, matched by {by}"
        );
        return text;
    }
    let _ = writeln!(
        text,
        "{:<24} {:>12} {:>12} {:>12}  at {by}",
        "column", "run", "compared", "difference"
    );
    for column in &comparison.columns {
        if let Some(value) = column.largest() {
            let difference = value.difference();
            let _ = writeln!(
                text,
                "{:<24} {:>12} {:>12} {:>12}  {}",
                column.name,
                fitting(value.run, 12),
                fitting(value.compared, 12),
                fitting(difference, 12),
                value.label
            );
        }
    }
    text
}
