//! Writing a results folder, one equilibrium after the other.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use arrow_array::RecordBatch;
use kavics::assembly::{Partner, Side};
use kavics::equilibrium::{Equilibrium, EventKind, Iterate, Load, State};
use kavics::ids::{BodyId, ContactId, GrainId, Id, PerBody, PerGrain, SideId};
use kavics::measure::{Measures, Snapshot, Tensor, cracks, void_cells};
use kavics::scene::Scene;

use crate::ResultsError;
use crate::actions::{ActionRow, Actions, action_columns};
use crate::checkpoint::clear_checkpoints;
use crate::chosen_columns::retain;
use crate::contacts::{ContactRow, contact_columns};
use crate::cracks::{crack_columns, crack_rows};
use crate::encode::{publish, publish_after, publish_rows, publish_table};
use crate::events::{EventRow, event_columns};
use crate::folder::recorded_path;
use crate::grains::{GrainRow, grain_columns};
use crate::log::Log;
use crate::modes::{mode_columns, mode_rows};
use crate::packing_record::PackingRecord;
use crate::record::{RunRecord, RunState, SCHEMA_VERSION};
use crate::recorded_tables::RecordedTables;
use crate::room::{CRACKS, MODES, VOIDS, make_room};
use crate::sides::{SideRow, side_columns};
use crate::steps::{StepRow, iterate_columns, step_columns};
use crate::voids::{void_columns, void_rows};
use crate::warning::{SolverWarnings, without_moduli};

/// Tables that grow are written again so often that it takes one part in so many of the run, and at least so often.
const SHARE_OF_WRITES: u32 = 30;
const BETWEEN_WRITES: Duration = Duration::from_secs(10);

/// How a results folder is made.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Threads of the run, for `run.json`.
    pub threads: usize,
    /// Whether a results folder that is there already is replaced.
    pub replace: bool,
}

/// A results folder that is being written.
///
/// Tables of the load steps grow with the run and are complete after [`Results::finish`]; a table of grains,
/// contacts or sides is written when its load step is pushed.
#[derive(Debug)]
pub struct Results<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) folder: PathBuf,
    record: RunRecord,
    pub(crate) steps: Vec<StepRow>,
    pub(crate) iterates: Vec<StepRow>,
    pub(crate) events: Vec<EventRow>,
    pub(crate) actions: Actions,
    pub(crate) action_rows: Vec<ActionRow>,
    pub(crate) broken: usize,
    held: PerGrain<bool>,
    in_window: PerGrain<bool>,
    unrecorded: Option<(Equilibrium, PerGrain<Tensor>)>,
    pub(crate) solver_warnings: SolverWarnings,
    pub(crate) log: Log,
    /// Load steps whose moduli were asked for and do not exist.
    pub(crate) without_moduli: Vec<usize>,
    growing: Growing,
    /// Rows that an earlier run of the same results wrote.
    pub(crate) before: Before,
    pub(crate) checkpoints: Checkpoints,
}

/// When the tables that grow were written last, and what it cost.
#[derive(Debug)]
struct Growing {
    written: Instant,
    cost: Duration,
}

/// Rows of the growing tables that an earlier run wrote.
#[derive(Debug, Default)]
pub(crate) struct Before {
    pub steps: Option<RecordBatch>,
    pub iterations: Option<RecordBatch>,
    pub events: Option<RecordBatch>,
    pub actions: Option<RecordBatch>,
}

/// How many rows stand in a table already.
pub(crate) fn rows(before: Option<&RecordBatch>) -> usize {
    before.map_or(0, RecordBatch::num_rows)
}

/// When the run began or went on, when a checkpoint was written last, and what it cost.
#[derive(Debug)]
pub(crate) struct Checkpoints {
    pub began: Instant,
    pub written: Instant,
    pub cost: Duration,
}

impl<'a> Results<'a> {
    /// Makes the folder, and in it the scene and `run.json`.
    ///
    /// # Errors
    /// A folder that is there already and is not to be replaced, or is no results folder; files that cannot be
    /// written.
    pub fn create(folder: &Path, scene: &'a Scene, options: Options) -> Result<Self, ResultsError> {
        make_room(folder, options.replace)?;
        fs::create_dir_all(folder).map_err(ResultsError::unwritable(folder))?;
        let results = Self::new(folder, scene, options);
        // First of all, so that the folder is known for what it is.
        results.write_record()?;
        results.make_folders()?;
        publish(&folder.join("scene.toml"), scene.text.as_bytes())?;
        if let Some(compared) = &scene.compare {
            let table = fs::read(compared).map_err(ResultsError::unreadable(compared))?;
            publish(&folder.join("compare.csv"), &table)?;
        }
        results.write_growing()?;
        Ok(results)
    }

    /// Makes the folders of the tables that are recorded.
    pub(crate) fn make_folders(&self) -> Result<(), ResultsError> {
        for name in RecordedTables::of(self.scene).tables {
            let path = self.folder.join(name);
            fs::create_dir_all(&path).map_err(ResultsError::unwritable(&path))?;
        }
        Ok(())
    }

    /// Nothing pushed yet, nothing written.
    pub(crate) fn new(folder: &Path, scene: &'a Scene, options: Options) -> Self {
        Self {
            scene,
            folder: folder.to_owned(),
            record: record(scene, options),
            steps: Vec::new(),
            iterates: Vec::new(),
            events: Vec::new(),
            actions: Actions::new(&scene.program),
            action_rows: Vec::new(),
            broken: 0,
            held: held_grains(scene),
            in_window: window_grains(scene),
            unrecorded: None,
            solver_warnings: SolverWarnings::default(),
            without_moduli: Vec::new(),
            log: Log::open(),
            growing: Growing {
                written: Instant::now(),
                cost: Duration::ZERO,
            },
            before: Before::default(),
            checkpoints: Checkpoints {
                began: Instant::now(),
                written: Instant::now(),
                cost: Duration::ZERO,
            },
        }
    }

    /// Adds an equilibrium; step 0 is the state before loading, and no row of `steps`.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn push(
        &mut self,
        equilibrium: &Equilibrium,
        measures: &Measures,
        grain_stress: &PerGrain<Tensor>,
    ) -> Result<(), ResultsError> {
        // Before its row, so that what a row belongs to is always there.
        if self.is_recorded(equilibrium.step) {
            self.unrecorded = None;
            self.write_recorded(equilibrium, grain_stress)?;
        } else {
            self.unrecorded = Some((equilibrium.clone(), grain_stress.clone()));
        }
        self.add_rows(equilibrium, measures);
        let wait = SHARE_OF_WRITES * self.growing.cost;
        if self.growing.written.elapsed() > wait.min(BETWEEN_WRITES) {
            let begun = Instant::now();
            self.write_growing()?;
            self.growing = Growing {
                written: Instant::now(),
                cost: begun.elapsed(),
            };
        }
        Ok(())
    }

    /// Whether the grains and contacts of a load step are recorded whatever comes after it.
    pub(crate) fn is_recorded(&self, step: usize) -> bool {
        step.is_multiple_of(self.scene.record_every.max(1))
    }

    /// Takes the last equilibrium of the run that goes on, which is recorded if none comes after it.
    pub fn go_on_from(&mut self, equilibrium: Equilibrium, grain_stress: PerGrain<Tensor>) {
        if !self.is_recorded(equilibrium.step) {
            self.unrecorded = Some((equilibrium, grain_stress));
        }
    }

    /// Adds a state on the way to `equilibrium`, before or after the equilibrium itself.
    pub fn push_iterate(
        &mut self,
        equilibrium: &Equilibrium,
        iterate: &Iterate,
        measures: &Measures,
    ) {
        let row = StepRow {
            iterations: iterate.iteration,
            residual: iterate.residual,
            energy: iterate.ledger.map(|(_, energy)| energy),
            iteration: Some(iterate.iteration),
            ..self.row_of_state(equilibrium, &iterate.state, measures)
        };
        let row = match iterate.ledger {
            Some((load_factor, _)) => StepRow { load_factor, ..row },
            None => row,
        };
        self.iterates.push(row);
    }

    /// The rows of `steps` so far.
    pub fn steps(&self) -> &[StepRow] {
        &self.steps
    }

    /// What the user should know so far: of the scene, then of the load steps, each warning once.
    pub fn warnings(&self) -> Vec<String> {
        let known = self.record.warnings.iter().cloned();
        let no_moduli = without_moduli(&self.without_moduli);
        let of_steps = self.solver_warnings.texts().chain(no_moduli);
        known.chain(of_steps).collect()
    }

    /// Adds a sentence that the user should know.
    pub fn warn(&mut self, warning: String) {
        self.record.warnings.push(warning);
    }

    /// Writes the rows so far after a fault, as far as there is room for them: they need less than what there was none for.
    pub fn keep_rows(&self) {
        let _ = self.write_growing();
    }

    /// Writes all that has not been written, and how the run ended; `failure` says why there is no equilibrium.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn finish(
        mut self,
        state: RunState,
        failure: Option<String>,
    ) -> Result<Vec<StepRow>, ResultsError> {
        if let Some((equilibrium, grain_stress)) = self.unrecorded.take() {
            let recorded = self.write_recorded(&equilibrium, &grain_stress);
            recorded.inspect_err(|_| self.keep_rows())?;
        }
        self.record.state = state;
        self.record.failure = failure;
        self.log.note(state.name());
        self.write_growing()?;
        if matches!(state, RunState::Done | RunState::NoEquilibrium) {
            clear_checkpoints(&self.folder)?;
        }
        Ok(self.steps)
    }

    fn add_rows(&mut self, equilibrium: &Equilibrium, measures: &Measures) {
        self.add_events(equilibrium);
        let actions = self.actions.rows(&self.scene.program, equilibrium);
        self.action_rows.extend(actions);
        if equilibrium.step > 0 {
            self.steps.push(self.step_row(equilibrium, measures));
            if equilibrium.tangents.is_some() && measures.moduli.is_none() {
                self.without_moduli.push(equilibrium.step);
            }
        }
        self.log.note_step(equilibrium.step, equilibrium.iterations);
    }

    fn add_events(&mut self, equilibrium: &Equilibrium) {
        let step = equilibrium.step;
        for &event in &equilibrium.events {
            self.broken += usize::from(matches!(event.kind, EventKind::Broke { .. }));
            let number = rows(self.before.events.as_ref()) + self.events.len();
            self.events.push(EventRow {
                number,
                step,
                event,
            });
        }
        for warning in &equilibrium.warnings {
            self.solver_warnings.add(step, warning);
        }
    }

    fn step_row(&self, equilibrium: &Equilibrium, measures: &Measures) -> StepRow {
        StepRow {
            iterations: equilibrium.iterations,
            residual: equilibrium.residual,
            energy: Some(equilibrium.energy),
            stability: equilibrium.stability.as_ref().map(|s| s.summary),
            ..self.row_of_state(equilibrium, &equilibrium.state, measures)
        }
    }

    fn row_of_state(
        &self,
        equilibrium: &Equilibrium,
        state: &State,
        measures: &Measures,
    ) -> StepRow {
        let broken = equilibrium
            .events
            .iter()
            .filter(|event| matches!(event.kind, EventKind::Broke { .. }));
        let stage = self.scene.program.stages.get(equilibrium.stage);
        let active = self.active_contacts(state);
        StepRow {
            step: equilibrium.step,
            stage: stage.map(|stage| stage.name.clone()).unwrap_or_default(),
            load_factor: equilibrium.load_factor,
            cuts: equilibrium.cuts,
            contacts: active_count(state),
            broken: self.broken,
            broken_in_step: broken.count(),
            rattlers: active.values().iter().filter(|&&count| count == 0).count(),
            measures: *measures,
            ..StepRow::default()
        }
    }

    /// Active contacts of each grain.
    fn active_contacts(&self, state: &State) -> PerGrain<usize> {
        let assembly = &self.scene.assembly;
        let mut counts = PerGrain::filled(0, assembly.grains.len());
        for (id, contact) in assembly.contacts.iter() {
            if state.contacts[id].is_active() {
                for grain in contact.grains() {
                    counts[grain] += 1;
                }
            }
        }
        counts
    }

    fn write_recorded(
        &self,
        equilibrium: &Equilibrium,
        grain_stress: &PerGrain<Tensor>,
    ) -> Result<(), ResultsError> {
        let path = |table| recorded_path(&self.folder, table, equilibrium.step);
        let assembly = &self.scene.assembly;
        let active = self.active_contacts(&equilibrium.state);
        let grains = |range| self.grain_rows(range, equilibrium, grain_stress, &active);
        let wanted = &self.scene.record_columns;
        let (count, mut columns) = (assembly.grains.len(), grain_columns());
        retain(&mut columns, wanted.grains.as_deref(), equilibrium.step);
        let write_grains = || publish_rows(&path("grains"), &columns, count, grains);
        let contacts = |range| self.contact_rows(range, equilibrium);
        let (count, mut columns) = (assembly.contacts.len(), contact_columns());
        retain(&mut columns, wanted.contacts.as_deref(), equilibrium.step);
        let write_contacts = || publish_rows(&path("contacts"), &columns, count, contacts);
        let (grains, contacts) = rayon::join(write_grains, write_contacts);
        grains?;
        contacts?;
        let sides = self.side_rows(equilibrium);
        publish_table(&path("sides"), &side_columns(), &sides)?;
        let snapshot = Snapshot::new(&self.scene.assembly, equilibrium);
        if self.scene.record_cracks {
            let rows = crack_rows(equilibrium.step, cracks(&snapshot));
            publish_table(&path(CRACKS), &crack_columns(), &rows)?;
        }
        if self.scene.record_voids {
            let rows = void_rows(equilibrium.step, &void_cells(&snapshot));
            publish_table(&path(VOIDS), &void_columns(), &rows)?;
        }
        if let Some(stability) = &equilibrium.stability {
            let rows = mode_rows(equilibrium.step, &self.scene.assembly, stability);
            publish_table(&path(MODES), &mode_columns(), &rows)?;
        }
        Ok(())
    }

    fn grain_rows(
        &self,
        range: Range<usize>,
        equilibrium: &Equilibrium,
        grain_stress: &PerGrain<Tensor>,
        contacts: &PerGrain<usize>,
    ) -> Vec<GrainRow> {
        let assembly = &self.scene.assembly;
        let row = |id: GrainId| {
            let body = assembly.body(Partner::Grain(id));
            GrainRow {
                step: equilibrium.step,
                id: id.index(),
                grain: assembly.grains[id],
                displacement: equilibrium.state.displacements[body],
                load: load_and_reaction(equilibrium, body),
                contacts: contacts[id],
                cell_area: assembly.cell_area[id],
                stress: grain_stress[id],
                state: self.grain_state(equilibrium, id, contacts[id]),
                in_window: self.in_window[id],
            }
        };
        range.map(GrainId::from_index).map(row).collect()
    }

    fn grain_state(
        &self,
        equilibrium: &Equilibrium,
        grain: GrainId,
        contacts: usize,
    ) -> &'static str {
        let set_aside = equilibrium.set_aside.values().get(grain.index());
        if self.held[grain] {
            "held"
        } else if contacts == 0 {
            "rattler"
        } else if set_aside.is_some_and(|&aside| aside) {
            "loose"
        } else {
            "free"
        }
    }

    fn contact_rows(&self, range: Range<usize>, equilibrium: &Equilibrium) -> Vec<ContactRow<'a>> {
        let scene = self.scene;
        let row = |id: ContactId| {
            let (contact, state) = (
                &scene.assembly.contacts[id],
                &equilibrium.state.contacts[id],
            );
            let step = equilibrium.step;
            ContactRow::new(step, id.index(), contact, state, &scene.properties)
        };
        range.map(ContactId::from_index).map(row).collect()
    }

    fn side_rows(&self, equilibrium: &Equilibrium) -> Vec<SideRow> {
        let assembly = &self.scene.assembly;
        let present = assembly.sides.iter().filter(|(_, side)| side.present);
        let row = |(id, side): (SideId, &Side)| {
            let body = assembly.body(Partner::Side(id));
            SideRow {
                step: equilibrium.step,
                id: id.index(),
                name: side.name.clone(),
                displacement: equilibrium.state.displacements[body],
                load: load_and_reaction(equilibrium, body),
            }
        };
        present.map(row).collect()
    }

    pub(crate) fn write_growing(&self) -> Result<(), ResultsError> {
        let path = |name| self.folder.join(name);
        let Before {
            steps,
            iterations,
            events,
            actions,
        } = &self.before;
        let (steps, new) = (steps.as_ref(), &self.steps[rows(steps.as_ref())..]);
        publish_after(&path("steps.parquet"), &step_columns(), steps, new)?;
        let (events, new) = (events.as_ref(), &self.events);
        publish_after(&path("events.parquet"), &event_columns(), events, new)?;
        let (actions, new) = (actions.as_ref(), &self.action_rows);
        publish_after(&path("actions.parquet"), &action_columns(), actions, new)?;
        if self.scene.settings.keep_iterates {
            let (columns, before) = (iterate_columns(), iterations.as_ref());
            publish_after(
                &path("iterations.parquet"),
                &columns,
                before,
                &self.iterates,
            )?;
        }
        self.write_record()?;
        publish(&path("log.ndjson"), self.log.text().as_bytes())
    }

    fn write_record(&self) -> Result<(), ResultsError> {
        let last = self.steps.last().map_or(0, |row| row.step);
        let mut warnings = self.warnings();
        warnings.extend(self.record.state.unfinished(last));
        let record = RunRecord {
            warnings,
            ..self.record.clone()
        };
        let mut record = serde_json::to_string_pretty(&record).expect("words are JSON");
        record.push('\n');
        publish(&self.folder.join("run.json"), record.as_bytes())
    }
}

fn record(scene: &Scene, options: Options) -> RunRecord {
    RunRecord {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        schema_version: SCHEMA_VERSION,
        title: scene.title.clone(),
        seed: scene.seed,
        threads: options.threads,
        grains: scene.assembly.grains.len(),
        contacts: scene.assembly.contacts.len(),
        window_grains: scene.window.len(),
        state: RunState::Running,
        failure: None,
        warnings: scene.warnings.clone(),
        packing: Some(PackingRecord::of(scene)),
        recorded: Some(RecordedTables::of(scene)),
    }
}

/// Grains that are measured.
fn window_grains(scene: &Scene) -> PerGrain<bool> {
    let mut within = PerGrain::filled(false, scene.assembly.grains.len());
    for &grain in &scene.window {
        within[grain] = true;
    }
    within
}

/// Grains of which some freedom is held or moved.
fn held_grains(scene: &Scene) -> PerGrain<bool> {
    let program = &scene.program;
    let bodies = program.held.iter().map(|held| held.body);
    let moved = program.prescribed.iter().map(|moved| moved.body);
    let mut held = PerGrain::filled(false, scene.assembly.grains.len());
    for body in bodies.chain(moved) {
        if let Partner::Grain(grain) = scene.assembly.partner(body) {
            held[grain] = true;
        }
    }
    held
}

fn active_count(state: &State) -> usize {
    let contacts = state.contacts.values().iter();
    contacts.filter(|contact| contact.is_active()).count()
}

fn load_and_reaction(equilibrium: &Equilibrium, body: BodyId) -> Load {
    let at = |loads: &PerBody<Load>| {
        let load = loads.values().get(body.index());
        load.copied().unwrap_or_default()
    };
    let (load, reaction) = (at(&equilibrium.loads), at(&equilibrium.reactions));
    Load {
        x: load.x + reaction.x,
        y: load.y + reaction.y,
        moment: load.moment + reaction.moment,
    }
}
