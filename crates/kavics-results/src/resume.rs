//! Going on with results: writing a checkpoint of a run, and beginning from one.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use arrow_array::RecordBatch;
use arrow_schema::ArrowError;
use kavics::equilibrium::{Memory, MemoryColumn};
use kavics::scene::Scene;

use crate::ResultsError;
use crate::actions::action_columns;
use crate::checkpoint::{self, CHECKPOINT_VERSION, Checkpoint, CheckpointHeader, assembly_hash};
use crate::column::Column;
use crate::columns::Columns;
use crate::encode::{array, array_after, schema};
use crate::events::event_columns;
use crate::log::{LOG, Log};
use crate::results::{Before, Options, Results, rows};
use crate::room::clear_leftovers;
use crate::steps::{iterate_columns, rows_with_stress, step_columns};
use crate::warning::SolverWarnings;

/// Checkpoints take at most one part in so many of the time; more in the first seconds, when that is little.
const SHARE: u32 = 20;
const FIRST_SHARE: u32 = 3;
const FIRST: Duration = Duration::from_secs(5);
/// At most one part in so many of the time so far is lost, nor more than this.
const LOST: u32 = 60;
const MOST_LOST: Duration = Duration::from_secs(2);

/// What results remember beside their rows.
const WARNINGS: &str = "results.warnings";
const WITHOUT_MODULI: &str = "results.without_moduli";

impl<'a> Results<'a> {
    /// Goes on with the results of a run that was broken off, from a checkpoint in the same folder.
    ///
    /// # Errors
    /// A checkpoint whose tables have other columns; files that cannot be read, written or removed.
    pub fn resume(
        folder: &Path,
        scene: &'a Scene,
        options: Options,
        checkpoint: &Checkpoint,
    ) -> Result<Self, ResultsError> {
        let mut results = Self::new(folder, scene, options);
        let before = |table, names: Vec<String>| earlier(folder, checkpoint, table, &names);
        results.before = Before {
            steps: before("steps", names(&step_columns()))?,
            iterations: before("iterations", names(&iterate_columns()))?,
            events: before("events", names(&event_columns()))?,
            actions: before("actions", names(&action_columns()))?,
        };
        if let Some(steps) = &results.before.steps {
            let table = Columns::of(&folder.join(checkpoint::CHECKPOINT), steps.clone());
            results.steps = rows_with_stress(&table)?;
        }
        results.solver_warnings = SolverWarnings::of_numbers(numbers(&checkpoint.memory, WARNINGS));
        let without_moduli = numbers(&checkpoint.memory, WITHOUT_MODULI).iter();
        results.without_moduli = without_moduli.map(|&step| step as usize).collect();
        results.broken = checkpoint.header.broken;
        let log = fs::read_to_string(folder.join(LOG)).unwrap_or_default();
        results.log = Log::resume(log, checkpoint.header.step, &checkpoint.notes);
        results.make_folders()?;
        results.write_growing()?;
        // Last, so that nothing is taken away from a folder in which nothing can be written.
        clear_leftovers(folder, |step| results.is_recorded(step))?;
        Ok(results)
    }

    /// Whether it is time for a checkpoint: `apart` after the last one, and seldom enough to cost little; with no time
    /// apart it always is. Where nothing is said, after a small part of the time so far, and of two seconds at most.
    pub fn wants_checkpoint(&self, apart: Option<Duration>) -> bool {
        let elapsed = self.checkpoints.began.elapsed();
        let apart = apart.unwrap_or_else(|| MOST_LOST.min(elapsed / LOST));
        let share = if elapsed < FIRST { FIRST_SHARE } else { SHARE };
        let least = apart.max(self.checkpoints.cost * share);
        apart.is_zero() || self.checkpoints.written.elapsed() >= least
    }

    /// Writes a checkpoint: what the load path remembers, and all rows so far.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn checkpoint(&mut self, mut memory: Memory) -> Result<(), ResultsError> {
        let start = Instant::now();
        let mut keep = |name: &str, values| {
            let column = MemoryColumn::Numbers(values);
            memory.columns.insert(name.to_owned(), column);
        };
        keep(WARNINGS, self.solver_warnings.numbers());
        let without_moduli = self.without_moduli.iter();
        keep(
            WITHOUT_MODULI,
            without_moduli.map(|&step| step as f64).collect(),
        );
        let header = CheckpointHeader {
            checkpoint_version: CHECKPOINT_VERSION,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            step: self.steps.last().map_or(0, |row| row.step),
            broken: self.broken,
            assembly: assembly_hash(self.scene),
        };
        let tables = self.tables();
        let tables = tables.map_err(|error| damaged(&self.folder, &error.to_string()))?;
        checkpoint::write(&self.folder, &header, memory, &tables)?;
        self.checkpoints.written = Instant::now();
        self.checkpoints.cost = start.elapsed();
        Ok(())
    }

    fn tables(&self) -> Result<Vec<(&'static str, RecordBatch)>, ArrowError> {
        let before = &self.before;
        let steps = &self.steps[rows(before.steps.as_ref())..];
        let mut tables = vec![
            ("steps", all(&step_columns(), before.steps.as_ref(), steps)?),
            (
                "events",
                all(&event_columns(), before.events.as_ref(), &self.events)?,
            ),
            (
                "actions",
                all(
                    &action_columns(),
                    before.actions.as_ref(),
                    &self.action_rows,
                )?,
            ),
        ];
        if self.scene.settings.keep_iterates {
            let columns = iterate_columns();
            let table = all(&columns, before.iterations.as_ref(), &self.iterates)?;
            tables.push(("iterations", table));
        }
        Ok(tables)
    }
}

/// All rows of a table.
fn all<R>(
    columns: &[Column<R>],
    before: Option<&RecordBatch>,
    rows: &[R],
) -> Result<RecordBatch, ArrowError> {
    let columns_of = columns
        .iter()
        .enumerate()
        .map(|(index, column)| match before {
            Some(before) => array_after(column, before.column(index).as_ref(), rows),
            None => array(column, rows),
        });
    RecordBatch::try_new(schema(columns), columns_of.collect())
}

fn names<R>(columns: &[Column<R>]) -> Vec<String> {
    columns.iter().map(|column| column.name.clone()).collect()
}

/// The rows of a table in a checkpoint, if their columns are these.
fn earlier(
    folder: &Path,
    checkpoint: &Checkpoint,
    table: &str,
    names: &[String],
) -> Result<Option<RecordBatch>, ResultsError> {
    let Some(rows) = checkpoint.tables.get(table) else {
        return Ok(None);
    };
    let schema = rows.schema();
    let found = schema.fields().iter().map(|field| field.name());
    if !found.eq(names) {
        let what = format!("the columns of {table} are not those of this version");
        return Err(damaged(folder, &what));
    }
    Ok(Some(rows.clone()))
}

fn damaged(folder: &Path, reason: &str) -> ResultsError {
    ResultsError::Damaged {
        path: folder.join(checkpoint::CHECKPOINT),
        reason: reason.to_owned(),
    }
}

fn numbers<'m>(memory: &'m Memory, name: &str) -> &'m [f64] {
    match memory.columns.get(name) {
        Some(MemoryColumn::Numbers(values)) => values,
        _ => &[],
    }
}
