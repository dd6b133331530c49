//! `kavics run --resume`: where a run that was broken off goes on.

use std::path::Path;

use kavics::loading::LoadPath;
use kavics::measure::{Snapshot, grain_stress};
use kavics::scene::Scene;
use kavics_results::{
    Checkpoint, Lock, Options, Results, ResultsError, ResultsFolder, RunState, check_own,
    check_room, clear_unfinished, note_refusal,
};

use crate::failure::Failure;
use crate::scene_file::{say, show_warnings};

/// Results to be written, and where the load path begins.
pub struct Start<'a> {
    /// The results.
    pub results: Results<'a>,
    /// The load path.
    pub path: LoadPath<'a>,
    /// Keeps other runs out of the folder.
    pub lock: Lock,
}

/// How the results ended, if they have: done, or without an equilibrium.
///
/// # Errors
/// A record that cannot be read.
pub fn ended(folder: &Path) -> Result<Option<Result<(), Failure>>, Failure> {
    let Ok(results) = ResultsFolder::open(folder) else {
        return Ok(None);
    };
    let record = results.record()?;
    Ok(match record.state {
        RunState::Done => {
            say(&format!("{} is finished\n", folder.display()));
            Some(Ok(()))
        }
        RunState::NoEquilibrium => Some(Err(Failure::Ended {
            folder: folder.to_owned(),
            why: record.failure.unwrap_or_default(),
        })),
        RunState::Running | RunState::Stopped => None,
    })
}

/// Keeps other runs out of a folder, from now on.
pub fn lock(folder: &Path) -> Result<Lock, Failure> {
    let lock = Lock::take(folder)?;
    if let Some(why_not) = lock.unlocked() {
        show_warnings(&[why_not]);
    }
    Ok(lock)
}

/// Results from the beginning.
pub fn begin<'a>(scene: &'a Scene, folder: &Path, options: Options) -> Result<Start<'a>, Failure> {
    check_room(folder, options.replace)?;
    begin_locked(scene, folder, options, lock(folder)?)
}

fn begin_locked<'a>(
    scene: &'a Scene,
    folder: &Path,
    options: Options,
    lock: Lock,
) -> Result<Start<'a>, Failure> {
    Ok(Start {
        results: Results::create(folder, scene, options)?,
        path: scene.load_path(),
        lock,
    })
}

/// Results from their last checkpoint; from the beginning where there is none.
pub fn go_on<'a>(scene: &'a Scene, folder: &Path, options: Options) -> Result<Start<'a>, Failure> {
    check_own(folder)?;
    let lock = lock(folder)?;
    let record = ResultsFolder::open(folder).and_then(|results| results.record());
    if record.is_ok_and(|r| matches!(r.state, RunState::Done | RunState::NoEquilibrium)) {
        // Another run has come to its end since its record was looked at.
        let folder = folder.to_owned();
        return Err(ResultsError::Locked { folder }.into());
    }
    let found = from_checkpoint(scene, folder, options);
    if let Err(refused) = &found {
        // The terminal tells it too, so that a log that cannot be written is no matter.
        let _ = note_refusal(folder, &refused.to_string());
    }
    let Some((results, path)) = found? else {
        clear_unfinished(folder)?;
        check_room(folder, false)?;
        say(&format!(
            "nothing to go on from in {}: the run begins with load step 1\n",
            folder.display()
        ));
        return begin_locked(scene, folder, options, lock);
    };
    Ok(Start {
        results,
        path,
        lock,
    })
}

/// Results and load path as the newest checkpoint has them; none where there is none.
fn from_checkpoint<'a>(
    scene: &'a Scene,
    folder: &Path,
    options: Options,
) -> Result<Option<(Results<'a>, LoadPath<'a>)>, ResultsError> {
    let Some(checkpoint) = Checkpoint::newest(folder, scene)? else {
        return Ok(None);
    };
    // Without its scene nothing says that a checkpoint belongs to this one.
    let recorded = ResultsFolder::open(folder)?;
    recorded.scene()?;
    recorded.check_recorded(scene, checkpoint.header.step)?;
    for note in &checkpoint.notes {
        say(&format!("warning: {note}\n"));
    }
    let path = scene.load_path().resume(&checkpoint.memory);
    let path = path.map_err(|source| ResultsError::Memory {
        folder: folder.to_owned(),
        source,
    })?;
    let mut results = Results::resume(folder, scene, options, &checkpoint)?;
    if let Some(last) = path.last_equilibrium() {
        let stress = grain_stress(&Snapshot::new(&scene.assembly, &last));
        results.go_on_from(last, stress);
    }
    let step = checkpoint.header.step;
    say(&format!("going on after load step {step}\n"));
    Ok(Some((results, path)))
}
