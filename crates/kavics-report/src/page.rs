//! All that stands on the page, ready for the template.

use kavics_pictures::{Layout, Request, What, draw_on, largest_force};
use kavics_results::{Columns, ResultsFolder, RunRecord};
use minijinja::Environment;
use minijinja::value::Serde;
use serde::Serialize;

use crate::curves::{Group, groups};
use crate::fracture::{Fracture, fracture};
use crate::left_out::or_note;
use crate::modes::{Modes, modes};
use crate::moduli;
use crate::number::{brief, fixed, show};
use crate::{Comparison, ReportError};

/// Pictures of the contact graph, at most; and contacts in all of them together, so that the page stays small: none
/// of an assembly with more.
const PICTURES: usize = 6;

/// Width of a sheet with a picture, mm: words on it are as large as those around it where it takes a third of the page.
const PICTURE_WIDTH: f64 = 80.0;
const CONTACTS_DRAWN: usize = 900_000;

/// Above this many grains a picture takes half of the page.
const LARGE: usize = 200;

/// Share of the run's largest stress below which a stress is rounding.
const ROUNDING: f64 = 1e-9;

/// Events listed.
const EVENTS_SHOWN: usize = 200;

/// What the template fills in.
#[derive(Debug, Serialize)]
struct Page {
    record: RunRecord,
    state: &'static str,
    tiles: Vec<Tile>,
    pictures: Vec<Picture>,
    large: bool,
    largest: String,
    fracture: Fracture,
    groups: Vec<Group>,
    moduli: Table,
    modes: Modes,
    parts: Vec<PartsRow>,
    steps: Table,
    sides: Table,
    events: Table,
    comparison: Option<Comparison>,
    compared: Vec<ComparedRow>,
    scene: String,
    left_out: Vec<String>,
}

/// A picture of the contact graph.
#[derive(Debug, Serialize)]
struct Picture {
    step: usize,
    load_factor: String,
    broken: i64,
    svg: String,
}

/// A line of the table of the stress parts: three tensors row by row, and the isotropic part.
#[derive(Debug, Serialize)]
struct PartsRow {
    step: String,
    load_factor: String,
    tensors: [[String; 4]; 3],
    isotropic: String,
    ratio: String,
}

/// A table with named columns.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Table {
    pub(crate) names: Vec<&'static str>,
    pub(crate) rows: Vec<Vec<String>>,
    pub(crate) left_out: usize,
}

/// A number that sums up the run.
#[derive(Debug, Serialize)]
struct Tile {
    name: &'static str,
    value: String,
}

/// A line of the comparison.
#[derive(Debug, Serialize)]
struct ComparedRow {
    column: String,
    label: String,
    run: String,
    compared: String,
    difference: String,
}

/// The page of the results in `folder`.
pub(crate) fn page(folder: &ResultsFolder) -> Result<String, ReportError> {
    let record = folder.record()?;
    let steps = folder.steps()?;
    let events = folder.events()?;
    let mut left_out = Vec::new();
    let pictures = pictures(folder, &record, &steps);
    let (pictures, largest) = or_note("contact graph", pictures, &mut left_out)?;
    let comparison = Comparison::read(folder)?;
    let mut environment = Environment::new();
    environment.add_template("report.html", include_str!("report.html"))?;
    let page = Page {
        state: record.state.name(),
        tiles: tiles(&record, &steps)?,
        pictures,
        large: record.grains > LARGE,
        largest: show(largest),
        fracture: fracture(folder, &events, &mut left_out)?,
        groups: groups(folder, &steps)?,
        moduli: moduli::table(&steps)?,
        modes: or_note("modes", modes(folder), &mut left_out)?,
        parts: parts(&steps)?,
        steps: steps_table(&steps)?,
        sides: sides_table(folder)?,
        events: events_table(&events)?,
        compared: comparison.as_ref().map(compared_rows).unwrap_or_default(),
        comparison,
        scene: folder.scene()?,
        record,
        left_out,
    };
    let template = environment.get_template("report.html")?;
    Ok(template.render(Serde(page))?)
}

fn tiles(record: &RunRecord, steps: &Columns) -> Result<Vec<Tile>, ReportError> {
    let last = |column: &str| -> Result<String, ReportError> {
        let values = steps.numbers(column)?;
        Ok(values
            .last()
            .map_or_else(|| "–".to_owned(), |value| brief(*value)))
    };
    let residuals = steps.numbers("residual")?;
    let residual = residuals.into_iter().fold(0.0, f64::max);
    let tile = |name, value| Tile { name, value };
    Ok(vec![
        tile("grains", record.grains.to_string()),
        tile("contacts", record.contacts.to_string()),
        tile("in the window", record.window_grains.to_string()),
        tile("load steps", steps.len().to_string()),
        tile("last load factor", last("load_factor")?),
        tile("bonds broken", last("broken")?),
        tile("largest residual", brief(residual)),
        tile("ledger error", last("ledger_error")?),
    ])
}

/// The pictures, and the largest normal force in them.
fn pictures(
    folder: &ResultsFolder,
    record: &RunRecord,
    steps: &Columns,
) -> Result<(Vec<Picture>, f64), ReportError> {
    let affordable = CONTACTS_DRAWN / record.contacts.max(1);
    let chosen = chosen_steps(folder, steps, affordable.min(PICTURES))?;
    let mut largest = 0.0_f64;
    for &step in &chosen {
        largest = largest.max(largest_force(folder, step)?);
    }
    if chosen.is_empty() {
        return Ok((Vec::new(), largest));
    }
    let layout = Layout::read(folder)?;
    let request = Request {
        largest: Some(largest),
        ..request(What::Forces)
    };
    let numbers = steps.integers("step")?;
    let factors = steps.numbers("load_factor")?;
    let broken_so_far = steps.integers("broken")?;
    let mut pictures = Vec::new();
    for step in chosen {
        let row = numbers
            .iter()
            .position(|number| *number == Some(step as i64));
        pictures.push(Picture {
            step,
            load_factor: row.map_or_else(|| "0".to_owned(), |row| show(factors[row])),
            broken: row.and_then(|row| broken_so_far[row]).unwrap_or(0),
            svg: draw_on(&layout, step, &request)?.element(),
        });
    }
    Ok((pictures, largest))
}

/// At most `count` recorded load steps, the telling ones first: the last, the first with breakage and the one
/// before it, the first, the one with most breakage; then some between.
fn chosen_steps(
    folder: &ResultsFolder,
    steps: &Columns,
    count: usize,
) -> Result<Vec<usize>, ReportError> {
    let recorded: Vec<usize> = folder
        .recorded_steps()?
        .into_iter()
        .filter(|step| *step > 0)
        .collect();
    let broken = steps.numbers("broken_in_step")?;
    let first_broken = broken.iter().position(|count| *count > 0.0);
    let most = (0..broken.len()).reduce(|a, b| if broken[b] > broken[a] { b } else { a });
    let mut wanted = Vec::new();
    wanted.extend(recorded.last());
    wanted.extend(first_broken.map(|row| row + 1));
    wanted.extend(first_broken.filter(|row| *row > 0));
    wanted.extend(recorded.first());
    wanted.extend(first_broken.and(most).map(|row| row + 1));
    let between = (1..count).map(|part| part * recorded.len() / count);
    wanted.extend(between.filter_map(|at| recorded.get(at)));
    let mut chosen: Vec<usize> = Vec::new();
    for step in wanted {
        if chosen.len() < count && recorded.contains(&step) && !chosen.contains(&step) {
            chosen.push(step);
        }
    }
    chosen.sort_unstable();
    Ok(chosen)
}

/// A picture on the page, which tells itself what lines mean.
pub(crate) fn request(what: What) -> Request {
    Request {
        what,
        width: PICTURE_WIDTH,
        broken: true,
        legend: what == What::Damage,
        ..Request::default()
    }
}

fn parts(steps: &Columns) -> Result<Vec<PartsRow>, ReportError> {
    let tensor = |prefix: &str| -> Result<[Vec<f64>; 4], ReportError> {
        let component = |name: &str| steps.numbers(&format!("{prefix}_{name}"));
        Ok([
            component("xx")?,
            component("xy")?,
            component("yx")?,
            component("yy")?,
        ])
    };
    let tensors = [
        tensor("shear_stress")?,
        tensor("variation_stress")?,
        tensor("fabric_stress")?,
    ];
    let isotropic = steps.numbers("isotropic_stress")?;
    let numbers = steps.integers("step")?;
    let factors = steps.numbers("load_factor")?;
    let all = tensors.iter().flatten().flatten().chain(&isotropic);
    let largest = all
        .filter(|value| value.is_finite())
        .map(|value| value.abs())
        .fold(0.0, f64::max);
    let shown = |value: f64| {
        if largest == 0.0 || (0.1..1e5).contains(&largest) {
            fixed(value, 3)
        } else {
            show(value)
        }
    };
    let row = |row: usize| PartsRow {
        step: numbers[row]
            .map(|step| step.to_string())
            .unwrap_or_default(),
        load_factor: fixed(factors[row], 2),
        tensors: tensors
            .each_ref()
            .map(|tensor| tensor.each_ref().map(|component| shown(component[row]))),
        isotropic: shown(isotropic[row]),
        ratio: fixed(ratio(&tensors, row, ROUNDING * largest), 3),
    };
    let rows = (0..steps.len()).filter(|row| isotropic[*row].is_finite());
    Ok(rows.map(row).collect())
}

/// The shear part over the normal variation part, where that is more than rounding.
fn ratio(tensors: &[[Vec<f64>; 4]; 3], row: usize, rounding: f64) -> f64 {
    let variation = deviator(&tensors[1], row);
    if variation > rounding {
        deviator(&tensors[0], row) / variation
    } else {
        f64::NAN
    }
}

fn deviator([xx, xy, yx, yy]: &[Vec<f64>; 4], row: usize) -> f64 {
    (0.5 * (xx[row] - yy[row])).hypot(0.5 * (xy[row] + yx[row]))
}

/// Columns of `steps` that the report lists; all of them stand in the table itself.
const STEP_COLUMNS: [&str; 12] = [
    "load_factor",
    "iterations",
    "residual",
    "cuts",
    "contacts",
    "broken",
    "broken_in_step",
    "rattlers",
    "coordination_number",
    "graph_porosity",
    "stress_xx",
    "stress_yy",
];

fn steps_table(steps: &Columns) -> Result<Table, ReportError> {
    let numbers = steps.numbers("step")?;
    let stages = steps.texts("stage")?;
    let columns: Result<Vec<_>, _> = STEP_COLUMNS
        .iter()
        .map(|name| steps.numbers(name))
        .collect();
    let columns = columns?;
    let row = |row: usize| {
        let words = [show(numbers[row]), stages[row].to_owned()];
        let values = columns.iter().map(|column| show(column[row]));
        words.into_iter().chain(values).collect()
    };
    Ok(Table {
        names: ["step", "stage"].into_iter().chain(STEP_COLUMNS).collect(),
        rows: (0..steps.len()).map(row).collect(),
        left_out: 0,
    })
}

/// The sides at the last recorded load step.
fn sides_table(folder: &ResultsFolder) -> Result<Table, ReportError> {
    let Some(last) = folder.recorded_steps()?.pop() else {
        return Ok(Table::default());
    };
    let sides = folder.sides(last)?;
    let names = sides.texts("name")?;
    let numbers = ["step", "ux", "uy", "rotation", "fx", "fy", "moment"];
    let columns: Result<Vec<_>, _> = numbers.iter().map(|name| sides.numbers(name)).collect();
    let columns = columns?;
    let row = |row: usize| {
        let values = columns.iter().map(|column| show(column[row]));
        std::iter::once(names[row].to_owned())
            .chain(values)
            .collect()
    };
    Ok(Table {
        names: ["side"].into_iter().chain(numbers).collect(),
        rows: (0..sides.len()).map(row).collect(),
        left_out: 0,
    })
}

fn events_table(events: &Columns) -> Result<Table, ReportError> {
    let factors = events.numbers("load_factor")?;
    let whole = |name| -> Result<Vec<String>, ReportError> {
        let values = events.integers(name)?.into_iter();
        Ok(values
            .map(|v| v.map_or_else(String::new, |v| v.to_string()))
            .collect())
    };
    let word = |name| -> Result<Vec<String>, ReportError> {
        Ok(events
            .texts(name)?
            .into_iter()
            .map(|text| text.replace('_', " "))
            .collect())
    };
    let energy = |name| -> Result<Vec<String>, ReportError> {
        let values = events.numbers(name)?.into_iter();
        Ok(values
            .map(|v| if v.is_nan() { String::new() } else { show(v) })
            .collect())
    };
    let columns = [
        whole("event")?,
        whole("step")?,
        whole("iteration")?,
        factors.into_iter().map(show).collect(),
        whole("contact")?,
        whole("grain")?,
        word("kind")?,
        word("mode")?,
        energy("fracture_energy")?,
        energy("release_energy")?,
    ];
    let shown = events.len().min(EVENTS_SHOWN);
    Ok(Table {
        names: vec![
            "event",
            "step",
            "iteration",
            "load_factor",
            "contact",
            "grain",
            "kind",
            "mode",
            "fracture_energy",
            "release_energy",
        ],
        rows: (0..shown)
            .map(|row| columns.iter().map(|column| column[row].clone()).collect())
            .collect(),
        left_out: events.len() - shown,
    })
}

fn compared_rows(comparison: &Comparison) -> Vec<ComparedRow> {
    let mut rows = Vec::new();
    for column in &comparison.columns {
        for value in &column.rows {
            rows.push(ComparedRow {
                column: column.name.clone(),
                label: value.label.clone(),
                run: show(value.run),
                compared: show(value.compared),
                difference: show(value.difference()),
            });
        }
    }
    rows
}
