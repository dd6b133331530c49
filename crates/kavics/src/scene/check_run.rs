//! Checks of how a scene is solved, measured and recorded.

use std::path::{Path, PathBuf};

use super::check_contacts::{Ranges, optional_range};
use super::check_control;
use super::checker::{Bound, Checker};
use super::diagnostic::Problem;
use super::file::{EquilibriumFile, MeasureFile, SceneFile, WindowFile};
use super::named_file::named_file;
use super::record_columns::{RecordColumns, record_columns};
use super::unit::Dimension;
use super::value::{Number, Placed, Quantity, ValueOr};
use crate::equilibrium::{Iteration, Settings, SolverChoice};
use crate::loading::{Breakage, PathControl};

/// How a scene is solved, measured and recorded.
#[derive(Clone, Debug)]
pub struct RunPlan {
    /// How equilibria are found.
    pub settings: Settings,
    /// When contacts break.
    pub breakage: Breakage,
    /// What steers the load steps.
    pub control: PathControl,
    /// What is measured.
    pub window: WindowPlan,
    /// Grains and contacts are recorded every so many load steps.
    pub record_every: usize,
    /// Whether void cells are recorded with them.
    pub record_voids: bool,
    /// Whether cracks are recorded with them.
    pub record_cracks: bool,
    /// Columns of grains and contacts that are recorded.
    pub record_columns: RecordColumns,
    /// Table to set beside the run.
    pub compare: Option<PathBuf>,
}

/// The window before the grains are known.
#[derive(Clone, Debug)]
pub enum WindowPlan {
    /// Grains without support, prescribed motion, load and side contact.
    Undisturbed,
    /// All grains.
    All,
    /// Grains with their centre in ranges, with the place in the file.
    Within(Ranges, std::ops::Range<usize>),
    /// Grains by id.
    Ids(Placed<Vec<Placed<i64>>>),
}

/// Equilibrium, measures, records and the table to compare with.
pub fn run(file: &SceneFile, folder: &Path, checker: &mut Checker) -> Option<RunPlan> {
    let default = (EquilibriumFile::default(), MeasureFile::default());
    let equilibrium = file.equilibrium.as_ref();
    let equilibrium = equilibrium.map_or(&default.0, |table| &table.value);
    let measure = file.measure.as_ref();
    let measure = measure.map_or(&default.1, |table| &table.value);
    let solving = solving(equilibrium, checker);
    let control = check_control::control(file, equilibrium, checker);
    let window = window(measure, checker);
    let keep_iterates = measure.every.as_ref().map_or(Some(false), |word| {
        checker.word(word, "every", &[("step", false), ("iteration", true)])
    });
    let modes = measure.stability.as_ref().map_or(Some(0), |count| {
        checker.count_up_to(count, "stability", 1, MOST_MODES)
    });
    let record = file.record.as_ref().map(|record| &record.value);
    let every = record.and_then(|record| record.every.as_ref());
    let record_every = every.map_or(Some(1), |every| checker.count(every, "every", 1));
    let columns = record.map(|record| record_columns(record, checker));
    let compare = match &file.compare {
        None => Some(None),
        Some(table) => named_file(&table.value.file, folder, "a csv file", checker).map(Some),
    };
    let (settings, breakage) = solving?;
    Some(RunPlan {
        settings: Settings {
            keep_iterates: keep_iterates?,
            modes: modes?,
            keep_tangents: measure.moduli.unwrap_or(false),
            ..settings
        },
        breakage,
        control: control?,
        window: window?,
        record_every: record_every?,
        record_voids: record.and_then(|record| record.voids).unwrap_or(false),
        record_cracks: record.and_then(|record| record.cracks).unwrap_or(false),
        record_columns: columns.unwrap_or_default(),
        compare: compare?,
    })
}

fn solving(file: &EquilibriumFile, checker: &mut Checker) -> Option<(Settings, Breakage)> {
    let default = Settings::default();
    let tolerance = file.tolerance.as_ref();
    let tolerance = self::tolerance(tolerance, default.tolerance, checker);
    let ties = Share {
        key: "tie_tolerance",
        number: file.tie_tolerance.as_ref(),
        default: default.tie_tolerance,
        bound: Bound::NonNegative,
    };
    let ties = share(&ties, MOST_TIES, checker);
    let work = Share {
        key: "work_tolerance",
        number: file.work_tolerance.as_ref(),
        default: default.work_tolerance,
        bound: Bound::Positive,
    };
    let work = share(&work, MOST_WORK, checker);
    let iteration = file
        .iteration
        .as_ref()
        .map_or(Some(default.iteration), |word| {
            let choices = [
                ("secant", Iteration::Secant),
                ("tangent", Iteration::Tangent),
            ];
            checker.word(word, "iteration", &choices)
        });
    let solver = file.solver.as_ref().map_or(Some(default.solver), |word| {
        let choices = [
            ("auto", SolverChoice::Auto),
            ("direct", SolverChoice::Direct),
            ("iterative", SolverChoice::Iterative),
        ];
        checker.word(word, "solver", &choices)
    });
    let breakage = breakage(file.breakage.as_ref(), checker);
    if let (Some(Breakage::EventDriven), Some(SolverChoice::Iterative)) = (breakage, solver) {
        events_need_a_factor(file.solver.as_ref()?, checker);
        return None;
    }
    let settings = Settings {
        tolerance: tolerance?,
        iteration: iteration?,
        solver: solver?,
        tie_tolerance: ties?,
        work_tolerance: work?,
        ..default
    };
    Some((settings, breakage?))
}

fn events_need_a_factor(solver: &Placed<String>, checker: &mut Checker) {
    checker.push(Problem::at(
        &solver.span,
        "`solver = \"iterative\"` with `breakage = \"event-driven\"`",
        "expected \"auto\" or \"direct\": events change the factor of the direct solver",
    ));
}

/// Modes that are sought at once.
const MOST_MODES: i64 = 100;

/// Least bound on the residual: a few roundings of double precision.
const LEAST_TOLERANCE: f64 = 1e-14;
/// Largest one: with forces known to fewer than three digits contacts would break or hold by the bound.
const MOST_TOLERANCE: f64 = 1e-3;

fn tolerance(number: Option<&Number>, default: f64, checker: &mut Checker) -> Option<f64> {
    let Some(number) = number else {
        return Some(default);
    };
    let value = checker.number(number, "tolerance", Dimension::Number, Bound::Positive)?;
    let expected = match value {
        LEAST_TOLERANCE..=MOST_TOLERANCE => return Some(value),
        ..LEAST_TOLERANCE => {
            format!("expected at least {LEAST_TOLERANCE:e}; double precision reaches no less")
        }
        _ => format!("expected at most {MOST_TOLERANCE:e}; what is farther off is no equilibrium"),
    };
    let problem = format!("`tolerance` cannot be {value:e}");
    checker.push(Problem::at(&number.span, problem, expected));
    None
}

/// Largest share of the utilisation within which bonds break together: those farther from their limits hold.
const MOST_TIES: f64 = 0.1;
/// Largest share of its work by which the energies of a load step may be wrong: all of it.
const MOST_WORK: f64 = 1.0;

/// A share that the scene gives, or may.
struct Share<'a> {
    key: &'static str,
    number: Option<&'a Number>,
    default: f64,
    bound: Bound,
}

fn share(given: &Share<'_>, most: f64, checker: &mut Checker) -> Option<f64> {
    let Some(number) = given.number else {
        return Some(given.default);
    };
    let value = checker.number(number, given.key, Dimension::Number, given.bound)?;
    if value <= most {
        return Some(value);
    }
    let problem = format!("`{}` cannot be {value:?}", given.key);
    let expected = format!("expected at most {most}; it is a share");
    checker.push(Problem::at(&number.span, problem, expected));
    None
}

fn breakage(word: Option<&Placed<String>>, checker: &mut Checker) -> Option<Breakage> {
    let Some(word) = word else {
        return Some(Breakage::default());
    };
    let choices = [
        ("worst-first", Breakage::WorstFirst),
        ("simultaneous", Breakage::Simultaneous),
        ("event-driven", Breakage::EventDriven),
    ];
    checker.word(word, "breakage", &choices)
}

fn window(file: &MeasureFile, checker: &mut Checker) -> Option<WindowPlan> {
    let Some(window) = &file.window else {
        return Some(WindowPlan::Undisturbed);
    };
    match &window.value {
        ValueOr::Value(Quantity::Text(text)) => {
            let word = Placed {
                value: text.clone(),
                span: window.span.clone(),
            };
            let all = checker.word(&word, "window", &[("undisturbed", false), ("all", true)])?;
            Some(if all {
                WindowPlan::All
            } else {
                WindowPlan::Undisturbed
            })
        }
        ValueOr::Value(Quantity::Number(number)) => {
            checker.push(Problem::at(
                &window.span,
                format!("`window` cannot be {number}"),
                "expected \"undisturbed\", \"all\", ranges of `x` and `y`, or `ids`",
            ));
            None
        }
        ValueOr::Table(table) => window_table(table, window, checker),
    }
}

fn window_table(
    table: &WindowFile,
    window: &Placed<ValueOr<WindowFile>>,
    checker: &mut Checker,
) -> Option<WindowPlan> {
    enum Kind<'a> {
        Ranges,
        Ids(&'a Placed<Vec<Placed<i64>>>),
    }
    let WindowFile { x, y, ids } = table;
    let alternatives = [
        (
            "x, y",
            x.as_ref().or(y.as_ref()).map(|r| (Kind::Ranges, &r.span)),
        ),
        ("ids", ids.as_ref().map(|i| (Kind::Ids(i), &i.span))),
    ];
    match checker.exactly_one(&window.span, "the choice of grains", alternatives)? {
        Kind::Ids(ids) => Some(WindowPlan::Ids(ids.clone())),
        Kind::Ranges => {
            let x = optional_range(x.as_ref(), "x", checker);
            let y = optional_range(y.as_ref(), "y", checker);
            Some(WindowPlan::Within(
                Ranges { x: x?, y: y? },
                window.span.clone(),
            ))
        }
    }
}
