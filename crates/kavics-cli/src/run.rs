//! `kavics run`: the equilibria of a scene, measured and written.

use std::io::{self, Write, stdout};
use std::path::Path;
use std::time::Instant;

use kavics::equilibrium::{Equilibrium, SolveError, State};
use kavics::measure::{Measures, Snapshot, Window, grain_stress, measures, moduli};
use kavics::scene::Scene;
use kavics::warning::WarningKind;
use kavics_results::{Options, Results, ResultsFolder, RunState, StepRow, check_apart, check_room};

use crate::arguments::RunArguments;
use crate::failure::Failure;
use crate::limits::{Estimate, bytes};
use crate::progress::Progress;
use crate::scene_file::say;
use crate::{own_files, scene_file, summary, terminal};

pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let usual = || scene_file::usual_folder(&arguments.scene.scene);
    let folder = arguments.output.clone().unwrap_or_else(usual);
    check_room(&folder, arguments.force)?;
    let threads = scene_file::start_threads(arguments.threads)?;
    let (mut scene, table) = scene_file::read(&arguments.scene)?;
    check_apart(&folder, &scene_file::files_read(&arguments.scene, &scene))?;
    scene.text = own_files::named(&scene.text, &scene.layers);
    let began = Instant::now();
    terminal::say_more(&opening(&scene, threads));
    let options = Options {
        threads,
        replace: arguments.force,
    };
    Estimate::of(&scene).check(arguments.any_size)?;
    let mut results = Results::create(&folder, &scene, options)?;
    let mut lines = JsonLines::new(arguments.json);
    let failure = follow(&scene, &mut results, &mut lines)?;
    let lone = table.map(|table| table.unmatched(results.steps()));
    for lone in lone.unwrap_or_default() {
        results.warn(WarningKind::ComparedTable.says(format_args!("compare.csv: {lone}")));
    }
    let warnings = results.warnings();
    let state = match failure {
        None => RunState::Done,
        Some(_) => RunState::NoEquilibrium,
    };
    let steps = results.finish(state, failure.as_ref().map(ToString::to_string))?;
    say(&summary::summary(&steps));
    say(&summary::closing(&scene, &steps, state, began.elapsed()));
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

/// What is about to be solved, and how.
fn opening(scene: &Scene, threads: usize) -> String {
    let unknowns = scene.load_path().unknowns();
    let solver = if scene.settings.solver.iterates(unknowns) {
        "iterative"
    } else {
        "direct"
    };
    format!(
        "{unknowns} unknowns, {solver} solver, threads: {threads}, about {} of memory\n",
        bytes(Estimate::of(scene).memory)
    )
}

/// Pushes every equilibrium of the load path; answers why it ended early.
fn follow(
    scene: &Scene,
    results: &mut Results<'_>,
    lines: &mut JsonLines,
) -> Result<Option<SolveError>, Failure> {
    let window = Window::new(scene.window.clone(), scene.assembly.grains.len());
    let path = scene.load_path();
    let mut progress = Progress::new(&scene.program, path.watch());
    for equilibrium in path {
        let equilibrium = match equilibrium {
            Ok(equilibrium) => equilibrium,
            Err(error) => {
                progress.end();
                return Ok(Some(error));
            }
        };
        push(scene, &window, &equilibrium, results)?;
        let broken = results.steps().last().map_or(0, |row| row.broken);
        progress.note(&equilibrium, broken);
        if equilibrium.step > 0 {
            lines.write(results.steps());
        }
    }
    progress.end();
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
    let (measures, stress) = rayon::join(
        || Measures {
            moduli: tangents.and_then(|tangents| moduli(&scene.assembly, tangents, window)),
            ..measures(&snapshot, window)
        },
        || grain_stress(&snapshot),
    );
    results.push(equilibrium, &measures, &stress)?;
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
