//! One run at a time writes a results folder.

use std::fs::{self, File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::ResultsError;
use crate::checkpoint::CHECKPOINT;

/// The file in `checkpoint/` that is locked. It is always empty: the system knows who holds it, and forgets it when the
/// process ends, however it ends.
pub(crate) const LOCK: &str = "lock";

/// How often the file is made where it vanishes at once.
const ATTEMPTS: usize = 100;

/// Keeps other runs out of a results folder until it is dropped. Readers need no lock.
#[derive(Debug)]
pub struct Lock {
    folder: PathBuf,
    /// Open, and locked where the file system can.
    _file: File,
    unlocked: Option<String>,
}

impl Lock {
    /// Locks a results folder, which is made where there is none.
    ///
    /// # Errors
    /// Another run writes there; a folder in which no file can be made.
    pub fn take(folder: &Path) -> Result<Self, ResultsError> {
        fs::create_dir_all(folder).map_err(ResultsError::unwritable(folder))?;
        let place = folder.join(CHECKPOINT);
        let path = place.join(LOCK);
        loop {
            let file = made(&place, &path)?;
            let unlocked = try_lock(&file, folder)?;
            // Whoever held it before may have taken the file away since it was opened here.
            if unlocked.is_some() || is_at(&file, &path) {
                return Ok(Self {
                    folder: folder.to_owned(),
                    _file: file,
                    unlocked,
                });
            }
        }
    }

    /// Whether no run writes a results folder now. Nothing is made, and nothing stays locked.
    ///
    /// # Errors
    /// Another run writes there.
    pub fn check_free(folder: &Path) -> Result<(), ResultsError> {
        match File::open(folder.join(CHECKPOINT).join(LOCK)) {
            Ok(file) => try_lock(&file, folder).map(|_| ()),
            // A lock that cannot be opened is told of when it is to be taken.
            Err(_) => Ok(()),
        }
    }

    /// Why the folder is not locked, where its file system cannot.
    pub fn unlocked(&self) -> Option<String> {
        let reason = self.unlocked.as_ref()?;
        Some(format!(
            "{} cannot be locked ({reason}); nothing but care keeps a second run out of it",
            self.folder.display()
        ))
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // A folder that has vanished, or holds checkpoints, stays as it is.
        let place = self.folder.join(CHECKPOINT);
        let _ = fs::remove_file(place.join(LOCK));
        let _ = fs::remove_dir(place);
    }
}

/// The file of the lock, and the folder that it is in. Whoever held it before may take both away meanwhile.
fn made(place: &Path, path: &Path) -> Result<File, ResultsError> {
    let make = || fs::create_dir_all(place).and_then(|()| File::create(path));
    let is_gone = |error: &std::io::Error| {
        matches!(error.kind(), ErrorKind::NotFound | ErrorKind::AlreadyExists)
    };
    let mut attempts = (1..ATTEMPTS).map(|_| make());
    let made = attempts.find(|made| made.as_ref().err().is_none_or(|error| !is_gone(error)));
    let unwritable = if place.is_dir() { path } else { place };
    made.unwrap_or_else(make)
        .map_err(ResultsError::unwritable(unwritable))
}

/// Locks a file; answers why it cannot be locked by anybody.
fn try_lock(file: &File, folder: &Path) -> Result<Option<String>, ResultsError> {
    match file.try_lock() {
        Ok(()) => Ok(None),
        Err(TryLockError::WouldBlock) => Err(ResultsError::Locked {
            folder: folder.to_owned(),
        }),
        Err(TryLockError::Error(error)) => Ok(Some(error.to_string())),
    }
}

/// Whether an open file is the one that is found at a path.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |found: fs::Metadata| (found.dev(), found.ino());
    let opened = file.metadata().map(place);
    fs::metadata(path).is_ok_and(|found| opened.is_ok_and(|opened| opened == place(found)))
}

/// Whether an open file is the one that is found at a path.
#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    path.is_file()
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicUsize;
    use std::sync::atomic::Ordering::SeqCst;

    use super::*;
    use crate::clear_unfinished;

    #[test]
    fn a_folder_is_locked_until_the_lock_is_dropped() {
        let place = tempfile::tempdir().expect("a temporary folder");
        let folder = place.path().join("results");
        Lock::check_free(&folder).expect("nobody is there");
        let lock = Lock::take(&folder).expect("a new folder");
        assert!(lock.unlocked().is_none(), "{:?}", lock.unlocked());
        for refused in [Lock::check_free(&folder), Lock::take(&folder).map(|_| ())] {
            let refused = refused.expect_err("a refusal");
            assert!(matches!(refused, ResultsError::Locked { .. }), "{refused}");
        }
        drop(lock);
        assert!(!folder.join(CHECKPOINT).exists());
        Lock::take(&folder).expect("nobody is there any more");
    }

    /// A run that finds nothing to go on from clears the folder while it holds it.
    #[test]
    fn a_folder_that_is_cleared_stays_locked() {
        let place = tempfile::tempdir().expect("a temporary folder");
        let folder = place.path();
        let _lock = Lock::take(folder).expect("nobody is there");
        let generation = folder
            .join(CHECKPOINT)
            .join("000001-0123456789abcdef.arrow");
        fs::write(&generation, "").expect("room");
        clear_unfinished(folder).expect("files of a run");
        assert!(!generation.exists());
        let refused = Lock::take(folder).expect_err("a refusal");
        assert!(matches!(refused, ResultsError::Locked { .. }), "{refused}");
    }

    /// Each holds the folder alone, though it takes the file away when it leaves.
    #[test]
    fn many_that_come_and_go_never_hold_a_folder_together() {
        let place = tempfile::tempdir().expect("a temporary folder");
        let inside = AtomicUsize::new(0);
        let held = AtomicUsize::new(0);
        let come_and_go = || {
            for _ in 0..300 {
                match Lock::take(place.path()) {
                    Ok(_lock) => {
                        assert_eq!(inside.fetch_add(1, SeqCst), 0);
                        held.fetch_add(1, SeqCst);
                        inside.fetch_sub(1, SeqCst);
                    }
                    Err(refused) => {
                        assert!(matches!(refused, ResultsError::Locked { .. }), "{refused}");
                    }
                }
            }
        };
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(come_and_go);
            }
        });
        assert!(held.into_inner() > 0);
    }

    #[test]
    fn a_lock_that_nobody_holds_any_more_keeps_nobody_out() {
        let place = tempfile::tempdir().expect("a temporary folder");
        fs::create_dir(place.path().join(CHECKPOINT)).expect("room");
        fs::write(place.path().join(CHECKPOINT).join(LOCK), "").expect("room");
        Lock::check_free(place.path()).expect("nobody is there");
        Lock::take(place.path()).expect("nobody is there");
    }

    #[test]
    fn a_file_that_was_taken_away_meanwhile_is_not_the_one_at_its_path() {
        let place = tempfile::tempdir().expect("a temporary folder");
        let path = place.path().join(LOCK);
        let file = File::create(&path).expect("room");
        assert!(is_at(&file, &path));
        fs::remove_file(&path).expect("a file");
        assert!(!is_at(&file, &path));
    }
}
