//! Signals from outside, and what is said where the program itself is wrong.

use std::panic::{set_hook, take_hook};
use std::path::Path;
use std::process::exit;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::failure::Failure;
use crate::scene_file::say;

/// Ended by a second signal, as shells count.
const INTERRUPTED: i32 = 130;

/// A flag that the first interrupt, hang-up or request to end sets; the second one ends the program at once.
pub fn stop_flag() -> Result<Arc<AtomicBool>, Failure> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            exit(INTERRUPTED);
        }
        say("stopping after the present iteration; once more to end at once\n");
    })?;
    Ok(stop)
}

/// A file beyond the limit of the process is an error like a full disk, not a signal. Threads begun later do the same.
pub fn let_large_files_fail() {
    #[cfg(unix)]
    {
        use nix::sys::signal::{SigSet, Signal};
        let mut signals = SigSet::empty();
        signals.add(Signal::SIGXFSZ);
        // Where that cannot be had the signal ends the program, as it would have.
        let _ = signals.thread_block();
    }
}

/// After a panic, which is a mistake in kavics, what has been found is not lost.
pub fn name_checkpoint_in_a_panic(folder: &Path) {
    let (usual, folder) = (take_hook(), folder.to_owned());
    set_hook(Box::new(move |panic| {
        usual(panic);
        say(&format!(
            "this is a mistake in kavics, not in the scene\nthe load steps in {0} are valid; its last checkpoint is in {1}\n\
             kavics run --resume goes on from there\n",
            folder.display(),
            folder.join("checkpoint").display()
        ));
    }));
}
