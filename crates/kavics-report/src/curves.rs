//! Which curves the report shows.

use std::collections::HashMap;

use kavics_results::{Columns, ResultsFolder};
use serde::Serialize;

use crate::plot::{Plot, Series, draw};
use crate::tensor::{Principal, near};
use crate::{ReportError, energy, moduli, packing};

/// Loads and moves with a curve of their own.
const ACTIONS_SHOWN: usize = 6;

/// Events on a curve, at most: of more every so many-th is drawn.
const EVENTS_DRAWN: usize = 20_000;

/// A plot with its heading and legend.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Figure {
    pub(crate) title: String,
    pub(crate) svg: String,
    pub(crate) legend: Vec<LegendEntry>,
    /// What stands under it.
    pub(crate) note: String,
}

/// A line of a plot in its legend.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct LegendEntry {
    pub(crate) name: String,
    pub(crate) colour: usize,
    pub(crate) dashed: bool,
    /// An area in place of a line.
    pub(crate) filled: bool,
}

/// Curves under one heading.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Group {
    pub(crate) heading: &'static str,
    pub(crate) note: &'static str,
    /// Whether they stand two in a row.
    pub(crate) pairs: bool,
    pub(crate) figures: Vec<Figure>,
}

/// What the curves of `steps` run over: the load factor where it only rises, the load step otherwise.
pub(crate) struct Abscissa {
    pub(crate) label: &'static str,
    pub(crate) values: Vec<f64>,
}

impl Abscissa {
    fn of(steps: &Columns) -> Result<Self, ReportError> {
        let factors = steps.numbers("load_factor")?;
        if factors.is_sorted() {
            return Ok(Self {
                label: "load factor",
                values: factors,
            });
        }
        Ok(Self {
            label: "load step",
            values: steps.numbers("step")?,
        })
    }

    pub(crate) fn with(&self, values: &[f64]) -> Vec<(f64, f64)> {
        let pairs = self.values.iter().zip(values);
        pairs.map(|(&x, &y)| (x, y)).collect()
    }
}

/// All curves of the report.
pub(crate) fn groups(folder: &ResultsFolder, steps: &Columns) -> Result<Vec<Group>, ReportError> {
    let over = Abscissa::of(steps)?;
    let groups = vec![
        Group {
            heading: "Packing",
            note: packing::NOTE,
            pairs: true,
            figures: packing::figures(folder)?,
        },
        Group {
            heading: "Load and displacement",
            note: "For a load: its whole force over the mean displacement, in its direction, of what it acts on. \
                   For a move: the reaction over the displacement. Where bonds break event by event, through \
                   every event.",
            pairs: false,
            figures: load_displacement(&folder.actions()?, &folder.events()?)?,
        },
        Group {
            heading: "Contacts",
            note: "",
            pairs: false,
            figures: contacts(steps, &over)?,
        },
        Group {
            heading: "Parts of the stress",
            note: "Average stress of the window and its parts; tension is positive.",
            pairs: false,
            figures: vec![
                stress_parts(steps, &over, "xx")?,
                stress_parts(steps, &over, "yy")?,
            ],
        },
        Group {
            heading: "Fabric",
            note: "Eigenvalues, direction of the larger one (from the x axis, counter-clockwise), and deviator \
                   (their difference) of the fabric, branch and contact tensors. Without a deviator there is no \
                   direction.",
            pairs: false,
            figures: fabric(steps, &over)?,
        },
        Group {
            heading: "Energy",
            note: energy::NOTE,
            pairs: true,
            figures: energy::figures(steps, &over)?,
        },
        Group {
            heading: "Stability and moduli over the run",
            note: "Lowest eigenvalue of the tangent, rotations counted by what they move at the rim; work of the \
                   change of the loads in each load step; force components beyond those that equilibrium determines; \
                   moduli of the nearest isotropic tensor, and Voigt's bound on them.",
            pairs: false,
            figures: moduli::figures(steps, &over)?,
        },
    ];
    let with_figures = groups.into_iter().filter(|group| !group.figures.is_empty());
    Ok(with_figures.collect())
}

pub(crate) fn figure(title: &str, x_label: &str, y_label: &str, series: &[Series]) -> Figure {
    let plot = Plot {
        x_label,
        y_label,
        sizes: false,
        heights: 5.0,
        series,
    };
    Figure {
        title: title.to_owned(),
        svg: draw(&plot),
        legend: legend(series),
        note: String::new(),
    }
}

/// The names of lines.
pub(crate) fn legend(series: &[Series]) -> Vec<LegendEntry> {
    let entry = |series: &Series| LegendEntry {
        name: series.name.clone(),
        colour: series.colour,
        dashed: series.dashed,
        filled: false,
    };
    series.iter().map(entry).collect()
}

fn load_displacement(actions: &Columns, events: &Columns) -> Result<Vec<Figure>, ReportError> {
    let names = actions.texts("action")?;
    let rows = [
        actions.numbers("step")?,
        actions.numbers("displacement")?,
        actions.numbers("force")?,
    ];
    let mut distinct: Vec<&str> = Vec::new();
    for &name in &names {
        if !distinct.contains(&name) {
            distinct.push(name);
        }
    }
    let driven = driven_steps(actions)?;
    let breaks = breaks(events)?;
    let curve = |name: &str| {
        let mut points = Vec::new();
        let mut through_events = false;
        for row in (0..names.len()).filter(|&row| names[row] == name) {
            let step = Some(rows[0][row] as i64);
            if driven.get(&step) == Some(&name) {
                let on_the_way = breaks.iter().filter(|(at, _)| *at == step);
                let before = points.len();
                points.extend(on_the_way.map(|(_, point)| *point));
                through_events |= points.len() > before;
            }
            points.push((rows[1][row], rows[2][row]));
        }
        Series {
            name: name.to_owned(),
            points,
            colour: 0,
            dashed: false,
            marked: !through_events,
        }
    };
    Ok(distinct
        .into_iter()
        .map(curve)
        .filter(|series| series.points.iter().any(|&(d, p)| d != 0.0 || p != 0.0))
        .take(ACTIONS_SHOWN)
        .map(|series| figure(&series.name.clone(), "displacement", "force", &[series]))
        .collect())
}

/// The load steps in which one action alone changes its factor, and which.
fn driven_steps(actions: &Columns) -> Result<HashMap<Option<i64>, &str>, ReportError> {
    let names = actions.texts("action")?;
    let (steps, factors) = (actions.integers("step")?, actions.numbers("factor")?);
    let mut last: HashMap<&str, f64> = HashMap::new();
    let mut changed: HashMap<Option<i64>, Vec<&str>> = HashMap::new();
    for ((&name, &step), &factor) in names.iter().zip(&steps).zip(&factors) {
        if last
            .insert(name, factor)
            .is_some_and(|before| before != factor)
        {
            changed.entry(step).or_default().push(name);
        }
    }
    let alone = changed.into_iter().filter(|(_, names)| names.len() == 1);
    Ok(alone.map(|(step, names)| (step, names[0])).collect())
}

/// Load step of a break, and the displacement and force at which it came.
type Reached = (Option<i64>, (f64, f64));

/// The breaks that tell displacement and force.
fn breaks(events: &Columns) -> Result<Vec<Reached>, ReportError> {
    if !events.names().contains(&"displacement") {
        return Ok(Vec::new());
    }
    let steps = events.integers("step")?;
    let points = events
        .numbers("displacement")?
        .into_iter()
        .zip(events.numbers("force")?);
    let told = steps.into_iter().zip(points);
    let told: Vec<_> = told.filter(|(_, (d, _))| !d.is_nan()).collect();
    let every = told.len().div_ceil(EVENTS_DRAWN).max(1);
    Ok(told.into_iter().step_by(every).collect())
}

pub(crate) fn column(
    steps: &Columns,
    over: &Abscissa,
    column: &str,
    name: &str,
    colour: usize,
) -> Result<Series, ReportError> {
    Ok(Series {
        name: name.to_owned(),
        points: over.with(&steps.numbers(column)?),
        colour,
        dashed: false,
        marked: true,
    })
}

fn contacts(steps: &Columns, over: &Abscissa) -> Result<Vec<Figure>, ReportError> {
    let broken = [
        column(steps, over, "broken", "so far", 1)?,
        column(steps, over, "broken_in_step", "in the step", 5)?,
    ];
    let active = [column(steps, over, "contacts", "active contacts", 0)?];
    let porosity = [column(steps, over, "graph_porosity", "graph porosity", 2)?];
    Ok(vec![
        figure("Broken contacts", over.label, "contacts", &broken),
        figure("Active contacts", over.label, "contacts", &active),
        figure(
            "Graph porosity",
            over.label,
            "share of the window",
            &porosity,
        ),
    ])
}

fn stress_parts(steps: &Columns, over: &Abscissa, component: &str) -> Result<Figure, ReportError> {
    let part = |prefix: &str, name: &str, colour| {
        column(steps, over, &format!("{prefix}_{component}"), name, colour)
    };
    let series = [
        part("shear_stress", "shear", 0)?,
        part("variation_stress", "normal variation", 1)?,
        part("fabric_stress", "fabric", 2)?,
        column(steps, over, "isotropic_stress", "isotropic", 3)?,
        Series {
            dashed: true,
            ..part("stress", "sum", 4)?
        },
    ];
    let title = format!("Stress {component}");
    Ok(figure(&title, over.label, "stress", &series))
}

/// The tensors whose spread the report shows, with a colour.
const FABRICS: [(&str, usize); 3] = [("fabric", 0), ("branch", 1), ("contact", 2)];

/// Middle of the half turn in which the first direction is named.
const MIDDLE: f64 = 45.0;

fn fabric(steps: &Columns, over: &Abscissa) -> Result<Vec<Figure>, ReportError> {
    let mut values = Vec::new();
    let mut directions = Vec::new();
    let mut deviators = Vec::new();
    let mut reference = None;
    for (tensor, colour) in FABRICS {
        let principal = Principal::of_column(steps, tensor)?;
        let first = principal.iter().map(|p| p.degrees).find(|d| d.is_finite());
        // Vertical is 90 degrees, never −90.
        let around = *reference.get_or_insert_with(|| near(first.unwrap_or(0.0), MIDDLE));
        let series = |name: String, dashed, read: &dyn Fn(&Principal) -> f64| Series {
            name,
            points: over.with(&principal.iter().map(read).collect::<Vec<_>>()),
            colour,
            dashed,
            marked: true,
        };
        values.push(series(format!("{tensor}, larger"), false, &|p| p.larger));
        values.push(series(format!("{tensor}, smaller"), true, &|p| p.smaller));
        directions.push(series(tensor.to_owned(), false, &|p| {
            near(p.degrees, around)
        }));
        deviators.push(series(tensor.to_owned(), false, &Principal::deviator));
    }
    Ok(vec![
        figure("Eigenvalues", over.label, "eigenvalue", &values),
        figure("Direction", over.label, "degrees", &directions),
        figure(
            "Deviator",
            over.label,
            "difference of eigenvalues",
            &deviators,
        ),
    ])
}
