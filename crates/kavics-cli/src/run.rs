//! `kavics run`: the equilibria of a scene, measured and written.

use std::io::{self, Write, stdout};
use std::path::Path;
use std::time::{Duration, Instant};

use kavics::equilibrium::{Equilibrium, SolveError, State};
use kavics::loading::{LoadPath, Station};
use kavics::measure::{Measures, Snapshot, Window, grain_stress, measures, moduli};
use kavics::scene::Scene;
use kavics::warning::WarningKind;
use kavics_report::ComparedTable;
use kavics_results::{
    Lock, Options, Results, ResultsFolder, RunState, StepRow, check_apart, check_room, check_same,
    clear_checkpoints, clear_unpublished, has_unpublished,
};

use crate::arguments::RunArguments;
use crate::failure::Failure;
use crate::limits::{Estimate, bytes};
use crate::progress::Progress;
use crate::scene_file::say;
use crate::signals::Stop;
use crate::{fault, own_files, resume, scene_file, summary, terminal};

/// What a signal is answered by.
const STOPPING: &str = "stopping after the present iteration; once more to end at once\n";

pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let usual = || scene_file::usual_folder(&arguments.scene.scene);
    let folder = arguments.output.clone().unwrap_or_else(usual);
    let signals = Stop::wait(STOPPING)?;
    Lock::check_free(&folder)?;
    if !arguments.resume {
        check_room(&folder, arguments.force)?;
    }
    let threads = scene_file::start_threads(arguments.threads)?;
    let (scene, table) = prepare(arguments, &folder)?;
    let began = Instant::now();
    if terminal::loudness() == terminal::Loudness::Verbose {
        terminal::say_more(&opening(&scene, threads));
    }
    let options = Options {
        threads,
        replace: arguments.force,
    };
    let told = signals.begin()?;
    fault::name_results(&folder);
    let start = if arguments.resume {
        check_same(&folder, &scene)?;
        if let Some(ended) = resume::ended(&folder)? {
            finished(&folder)?;
            return ended;
        }
        resume::go_on(&scene, &folder, options)?
    } else {
        resume::begin(&scene, &folder, options)?
    };
    let _lock = start.lock;
    let mut results = start.results;
    let mut follower = Follower {
        scene: &scene,
        window: Window::new(scene.window.clone(), scene.assembly.grains.len()),
        results: &mut results,
        lines: JsonLines::new(arguments.json),
        apart: arguments.checkpoint,
    };
    let path = start.path.stopped_by(told);
    let (ended, lines) = (follower.follow(path), follower.lines);
    let ended = ended.inspect_err(|_| results.keep_rows())?;
    let (state, failure) = match ended {
        Ended::Stopped => return stop(results, &folder),
        Ended::Done => (RunState::Done, None),
        Ended::NoEquilibrium(error) => (RunState::NoEquilibrium, Some(error)),
    };
    warn_of_unmatched(table.as_ref(), &mut results);
    let why = failure.as_ref().map(ToString::to_string);
    let steps = conclude(&scene, results, state, why, began)?;
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

fn warn_of_unmatched(table: Option<&ComparedTable>, results: &mut Results<'_>) {
    let lone = table.map(|table| table.unmatched(results.steps()));
    for lone in lone.unwrap_or_default() {
        results.warn(WarningKind::ComparedTable.says(format_args!("compare.csv: {lone}")));
    }
}

/// The scene as it will run, and the table that it is compared with.
fn prepare(
    arguments: &RunArguments,
    folder: &Path,
) -> Result<(Scene, Option<ComparedTable>), Failure> {
    let (mut scene, table) = scene_file::read(&arguments.scene, arguments.any_size)?;
    check_apart(folder, &scene_file::files_read(&arguments.scene, &scene))?;
    scene.text = own_files::named(&scene.text, &scene.layers);
    Estimate::of(&scene).check(arguments.any_size)?;
    Ok((scene, table))
}

/// Writes what has not been written, and sums the run up.
fn conclude(
    scene: &Scene,
    results: Results<'_>,
    state: RunState,
    failure: Option<String>,
    began: Instant,
) -> Result<Vec<StepRow>, Failure> {
    let warnings = results.warnings();
    let steps = results.finish(state, failure)?;
    say(&summary::summary(&steps));
    say(&summary::closing(scene, &steps, state, began.elapsed()));
    scene_file::show_warnings(&warnings);
    Ok(steps)
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

/// How a load path ended.
enum Ended {
    Done,
    NoEquilibrium(SolveError),
    Stopped,
}

/// Follows a load path, and writes what it comes to.
struct Follower<'r, 'a> {
    scene: &'a Scene,
    window: Window,
    results: &'r mut Results<'a>,
    lines: JsonLines,
    /// Least time between two checkpoints, where it was given.
    apart: Option<Duration>,
}

impl Follower<'_, '_> {
    /// Pushes every equilibrium of the load path.
    fn follow(&mut self, mut path: LoadPath<'_>) -> Result<Ended, Failure> {
        let mut progress = Progress::new(&self.scene.program, path.watch());
        let ended = loop {
            match path.advance() {
                None => break Ended::Done,
                Some(Err(error)) => break Ended::NoEquilibrium(error),
                Some(Ok(Station::Stopped)) => {
                    self.checkpoint(&path)?;
                    break Ended::Stopped;
                }
                Some(Ok(Station::Event)) => {}
                Some(Ok(Station::Equilibrium(equilibrium))) => {
                    push(self.scene, &self.window, &equilibrium, self.results)?;
                    let broken = self.results.steps().last().map_or(0, |row| row.broken);
                    progress.note(&equilibrium, broken);
                    if equilibrium.step > 0 {
                        self.lines.write(self.results.steps());
                    }
                }
            }
            if self.results.wants_checkpoint(self.apart) {
                self.checkpoint(&path)?;
            }
        };
        progress.end();
        Ok(ended)
    }

    fn checkpoint(&mut self, path: &LoadPath<'_>) -> Result<(), Failure> {
        if let Some(memory) = path.memory() {
            self.results.checkpoint(memory)?;
        }
        Ok(())
    }
}

/// Ends a run that was told to stop: the tables hold all that was found, and it can go on.
fn stop(results: Results<'_>, folder: &Path) -> Result<(), Failure> {
    let mut warnings = results.warnings();
    let steps = results.finish(RunState::Stopped, None)?;
    let last = steps.last().map_or(0, |row| row.step);
    warnings.extend(RunState::Stopped.unfinished(last));
    scene_file::show_warnings(&warnings);
    Err(Failure::Stopped {
        last,
        folder: folder.to_owned(),
    })
}

/// Nothing is left to do but what a run that was broken off at its very end may have left out; nothing is locked, and may
/// be read-only, where nothing is left to do at all.
fn finished(folder: &Path) -> Result<(), Failure> {
    let is_whole = !folder.join("checkpoint").is_dir() && folder.join("report.html").is_file();
    if is_whole && !has_unpublished(folder)? {
        return Ok(());
    }
    let _lock = resume::lock(folder)?;
    clear_checkpoints(folder)?;
    clear_unpublished(folder)?;
    if folder.join("report.html").is_file() {
        return Ok(());
    }
    finish_report(folder)
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
