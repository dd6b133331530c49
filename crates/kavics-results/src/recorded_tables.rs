//! Which load steps have tables of their own, and whether all of these are there.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::ErrorKind;

use kavics::scene::Scene;
use serde::{Deserialize, Serialize};

use crate::record::RunState;
use crate::room::{CRACKS, MODES, RECORDED, VOIDS};
use crate::{Columns, ResultsError, ResultsFolder};

/// What a run records of its load steps.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecordedTables {
    /// Every so many load steps are recorded, and the last.
    pub every: usize,
    /// The tables of each of them; `modes` only where there are some.
    pub tables: Vec<String>,
}

impl RecordedTables {
    /// What a run of `scene` records.
    pub(crate) fn of(scene: &Scene) -> Self {
        let asked_for = [
            scene.record_voids.then_some(VOIDS),
            scene.record_cracks.then_some(CRACKS),
            (scene.settings.modes > 0).then_some(MODES),
        ];
        let tables = RECORDED.into_iter().chain(asked_for.into_iter().flatten());
        Self {
            every: scene.record_every.max(1),
            tables: tables.map(str::to_owned).collect(),
        }
    }

    /// Those of results of versions that did not tell: what every run records, at the load steps that are there.
    fn unknown() -> Self {
        Self {
            every: usize::MAX,
            tables: RECORDED.map(str::to_owned).to_vec(),
        }
    }

    /// The tables that every recorded load step has; names that are not known are passed over.
    pub(crate) fn everywhere(&self) -> impl Iterator<Item = &'static str> {
        let asked_for = [VOIDS, CRACKS].into_iter();
        RECORDED
            .into_iter()
            .chain(asked_for.filter(|table| self.has(table)))
    }

    fn has(&self, table: &str) -> bool {
        self.tables.iter().any(|known| known == table)
    }
}

/// The column of `steps` that is null where the stability of a load step was not sought, or not found.
const FOUND: &str = "static_indeterminacy";

/// The load steps of each table that is there.
type Found = BTreeMap<&'static str, BTreeSet<usize>>;

impl ResultsFolder {
    /// The recorded load steps in order, 0 first. Of a run that has not ended these are all up to the last row of `steps`,
    /// and those after it whose tables are whole.
    ///
    /// # Errors
    /// A table that was recorded and is missing; a folder that cannot be listed, files that cannot be read.
    pub fn recorded_steps(&self) -> Result<Vec<usize>, ResultsError> {
        let record = self.record()?;
        let known = record.recorded.unwrap_or_else(RecordedTables::unknown);
        // First, as a run that is under way writes the tables of a load step before its row.
        let rows = self.rows_with_modes(record.state)?;
        let mut found = Found::new();
        for table in known.everywhere() {
            found.insert(table, self.steps_of(table)?);
        }
        let last = rows.last().map(|row| row.0);
        let wanted = wanted(&known, &found, record.state, last);
        let missing = |table: &str, step| ResultsError::Missing {
            path: self.table_path(table, step),
        };
        for &step in &wanted {
            if let Some((table, _)) = found.iter().find(|(_, steps)| !steps.contains(&step)) {
                return Err(missing(table, step));
            }
        }
        if known.has(MODES) {
            let modes = self.steps_of(MODES)?;
            let mut with_modes = rows.iter().filter(|row| row.1).map(|row| row.0);
            let lost = with_modes.find(|step| wanted.contains(step) && !modes.contains(step));
            lost.map_or(Ok(()), |step| Err(missing(MODES, step)))?;
        }
        Ok(wanted.into_iter().collect())
    }

    /// Checks that no table of a recorded load step is missing.
    ///
    /// # Errors
    /// Those of [`ResultsFolder::recorded_steps`].
    pub fn check_whole(&self) -> Result<(), ResultsError> {
        self.recorded_steps().map(|_| ())
    }

    /// Checks the recorded tables of a run of `scene` up to a load step from which it is to go on: they are not written
    /// again.
    ///
    /// # Errors
    /// A table that is missing, damaged, or of another load step or run.
    pub fn check_recorded(&self, scene: &Scene, last: usize) -> Result<(), ResultsError> {
        let recorded = RecordedTables::of(scene);
        for step in (0..=last).step_by(recorded.every) {
            for table in recorded.everywhere() {
                self.check_table(table, step)?;
            }
        }
        Ok(())
    }

    /// The load steps of which a table is there.
    fn steps_of(&self, table: &str) -> Result<BTreeSet<usize>, ResultsError> {
        let folder = self.path().join(table);
        let listed = fs::read_dir(&folder).and_then(Iterator::collect);
        let listed: Vec<fs::DirEntry> = match listed {
            Err(error) if error.kind() == ErrorKind::NotFound => Vec::new(),
            listed => listed.map_err(ResultsError::unreadable(&folder))?,
        };
        let names = listed.iter().map(fs::DirEntry::file_name);
        let step = |name: std::ffi::OsString| name.to_str()?.strip_suffix(".parquet")?.parse().ok();
        Ok(names.filter_map(step).collect())
    }

    /// The load steps of `steps`, and whether the stability of each was found; none where a run has only begun.
    fn rows_with_modes(&self, state: RunState) -> Result<Vec<(usize, bool)>, ResultsError> {
        let names = ["step", FOUND];
        let table = match Columns::read_some(&self.path().join("steps.parquet"), Some(&names)) {
            Err(error) if error.is_absence() && state == RunState::Running => return Ok(Vec::new()),
            table => table?,
        };
        let found = table.integers(FOUND);
        let found = found.unwrap_or_else(|_| vec![None; table.len()]);
        let steps = table.integers("step")?.into_iter().zip(found);
        let row = |(step, found): (Option<i64>, Option<i64>)| {
            Some((usize::try_from(step?).ok()?, found.is_some()))
        };
        Ok(steps.filter_map(row).collect())
    }
}

/// The load steps that were recorded, by what the run tells and by what is there.
fn wanted(
    known: &RecordedTables,
    found: &Found,
    state: RunState,
    last: Option<usize>,
) -> BTreeSet<usize> {
    let some: BTreeSet<usize> = found.values().flatten().copied().collect();
    let is_whole = |step: &usize| found.values().all(|steps| steps.contains(step));
    let mut wanted: BTreeSet<usize> = if state == RunState::Running {
        some.iter().copied().filter(is_whole).collect()
    } else {
        BTreeSet::new()
    };
    if known.every == usize::MAX {
        wanted.extend(
            some.iter()
                .filter(|step| last.is_some_and(|last| **step <= last)),
        );
    }
    if state != RunState::Running {
        wanted.extend(last);
    }
    // A run that has only begun may be writing its first tables.
    let has_some = state != RunState::Running && !some.is_empty();
    if last.is_some() || !wanted.is_empty() || has_some {
        let end = wanted.last().copied().max(last).unwrap_or(0);
        for step in (0..=end).step_by(known.every.max(1)) {
            wanted.insert(step);
            // The first that is missing is told, and no other.
            if !some.contains(&step) {
                break;
            }
        }
    }
    wanted
}
