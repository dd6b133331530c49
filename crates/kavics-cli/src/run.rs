//! `kavics run`: the equilibria of a scene, measured and written.

use std::io::{self, Write, stdout};
use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};
use kavics::equilibrium::{Equilibrium, SolveError, State};
use kavics::measure::{Measures, Snapshot, Window, grain_stress, measures, moduli};
use kavics::scene::Scene;
use kavics_results::{Options, Results, ResultsFolder, RunState, StepRow, check_apart, check_room};

use crate::arguments::RunArguments;
use crate::failure::Failure;
use crate::scene_file::say;
use crate::{own_files, scene_file, summary};

pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let usual = || scene_file::usual_folder(&arguments.scene.scene);
    let folder = arguments.output.clone().unwrap_or_else(usual);
    check_room(&folder, arguments.force)?;
    let threads = scene_file::start_threads(arguments.threads)?;
    let (mut scene, table) = scene_file::read(&arguments.scene)?;
    check_apart(&folder, &scene_file::files_read(&arguments.scene, &scene))?;
    scene.text = own_files::named(&scene.text, &scene.layers);
    let options = Options {
        threads,
        replace: arguments.force,
    };
    let mut results = Results::create(&folder, &scene, options)?;
    let mut lines = JsonLines::new(arguments.json);
    let failure = follow(&scene, &mut results, &mut lines)?;
    let lone = table.map(|table| table.unmatched(results.steps()));
    for lone in lone.unwrap_or_default() {
        results.warn(format!("compare.csv: {lone}"));
    }
    let warnings = results.warnings();
    let state = match failure {
        None => RunState::Done,
        Some(_) => RunState::NoEquilibrium,
    };
    let steps = results.finish(state, failure.as_ref().map(ToString::to_string))?;
    say(&summary::summary(&steps));
    scene_file::show_warnings(&warnings);
    finish_report(&folder)?;
    match failure {
        None => lines.end(),
        Some(error) => Err(Failure::NoEquilibrium {
            error,
            last: steps.last().map_or(0, |row| row.step),
            folder,
        }),
    }
}

/// Pushes every equilibrium of the load path; answers why it ended early.
fn follow(
    scene: &Scene,
    results: &mut Results<'_>,
    lines: &mut JsonLines,
) -> Result<Option<SolveError>, Failure> {
    let window = Window::new(scene.window.clone(), scene.assembly.grains.len());
    let bar = progress_bar(scene);
    for equilibrium in scene.load_path() {
        let equilibrium = match equilibrium {
            Ok(equilibrium) => equilibrium,
            Err(error) => {
                bar.finish_and_clear();
                return Ok(Some(error));
            }
        };
        push(scene, &window, &equilibrium, results)?;
        bar.set_position(equilibrium.step as u64);
        if equilibrium.step > 0 {
            lines.write(results.steps());
        }
    }
    bar.finish_and_clear();
    Ok(None)
}

fn push(
    scene: &Scene,
    window: &Window,
    equilibrium: &Equilibrium,
    results: &mut Results<'_>,
) -> Result<(), Failure> {
    for iterate in &equilibrium.iterates {
        let measures = measures(&snapshot(scene, equilibrium, &iterate.state), window);
        results.push_iterate(equilibrium, iterate, &measures);
    }
    let snapshot = snapshot(scene, equilibrium, &equilibrium.state);
    let tangents = equilibrium.tangents.as_ref();
    let measures = Measures {
        moduli: tangents.and_then(|tangents| moduli(&scene.assembly, tangents, window)),
        ..measures(&snapshot, window)
    };
    results.push(equilibrium, &measures, &grain_stress(&snapshot))?;
    Ok(())
}

fn snapshot<'a>(scene: &'a Scene, equilibrium: &'a Equilibrium, state: &'a State) -> Snapshot<'a> {
    Snapshot {
        assembly: &scene.assembly,
        state,
        loads: &equilibrium.loads,
        reactions: &equilibrium.reactions,
    }
}

/// Hidden where stderr is no terminal.
fn progress_bar(scene: &Scene) -> ProgressBar {
    let stages = scene.program.stages.iter();
    let steps: usize = stages.map(|stage| stage.factors.len()).sum();
    let style = ProgressStyle::with_template("load step {pos}/{len} {wide_bar} {eta}");
    ProgressBar::new(steps as u64).with_style(style.expect("a template that is known to be right"))
}

/// A JSON object per load step on stdout. A stdout that takes no more does not end the run.
struct JsonLines {
    wanted: bool,
    failure: Option<io::Error>,
}

impl JsonLines {
    fn new(wanted: bool) -> Self {
        Self {
            wanted,
            failure: None,
        }
    }

    /// Writes the last of the load steps.
    fn write(&mut self, steps: &[StepRow]) {
        let Some(row) = steps.last().filter(|_| self.wanted) else {
            return;
        };
        let mut out = stdout().lock();
        if let Err(error) = writeln!(out, "{}", row.to_json()).and_then(|()| out.flush()) {
            self.wanted = false;
            self.failure = Some(error);
        }
    }

    fn end(self) -> Result<(), Failure> {
        self.failure.map_or(Ok(()), |error| Err(error.into()))
    }
}

fn finish_report(folder: &Path) -> Result<(), Failure> {
    let report = kavics_report::write(folder, None)?;
    let compared = kavics_report::Comparison::read(&ResultsFolder::open(folder)?)?;
    if let Some(compared) = compared {
        say(&summary::compared(&compared));
    }
    say(&format!("report: {}\n", report.display()));
    Ok(())
}
