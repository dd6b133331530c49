//! Signals from outside.

use std::process::exit;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use crate::failure::{Failure, INTERRUPTED, STOPPED};
use crate::terminal::say;

/// What an interrupt, a hang-up or a request to end comes to: the first is left to the task, once it has begun to
/// write; a second one ends the program at once.
#[derive(Debug)]
pub struct Stop {
    told: Arc<AtomicBool>,
    begun: Arc<Mutex<bool>>,
}

impl Stop {
    /// Waits for signals from now on; `answer` is what the first one is answered by where the task has begun.
    pub fn wait(answer: &'static str) -> Result<Self, Failure> {
        let stop = Self {
            told: Arc::default(),
            begun: Arc::default(),
        };
        let (told, begun) = (Arc::clone(&stop.told), Arc::clone(&stop.begun));
        ctrlc::set_handler(move || {
            if told.swap(true, Ordering::Relaxed) {
                exit(INTERRUPTED);
            }
            // In a thread of its own, as a stderr that nobody reads may keep it waiting. Where there is none the task
            // finds the flag.
            let begun = Arc::clone(&begun);
            let _ = thread::Builder::new().spawn(move || first_signal(&begun, answer));
        })?;
        Ok(stop)
    }

    /// From now on the first signal is left to the task, which looks at the flag.
    ///
    /// # Errors
    /// A signal that came before.
    pub fn begin(&self) -> Result<Arc<AtomicBool>, Failure> {
        let mut begun = self.begun.lock().unwrap_or_else(PoisonError::into_inner);
        if self.told.load(Ordering::Relaxed) {
            return Err(Failure::StoppedEarly);
        }
        *begun = true;
        Ok(Arc::clone(&self.told))
    }
}

fn first_signal(begun: &Mutex<bool>, answer: &str) {
    let begun = begun.lock().unwrap_or_else(PoisonError::into_inner);
    if *begun {
        say(answer);
    } else {
        // Nothing is lost, so that nothing is waited for. The lock keeps the task from beginning meanwhile.
        say(&format!("{}\n", Failure::StoppedEarly));
        exit(STOPPED);
    }
}

/// Whether whoever started a process has it ignore a signal, by what Linux tells of it.
#[cfg(unix)]
fn ignores(status: &str, signal: nix::sys::signal::Signal) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal as i32 - 1) & 1 == 1)
}

/// A file beyond the limit of the process is an error like a full disk, not a signal; and a terminal that is closed is nothing
/// where `nohup` says so. Threads begun later do the same.
pub fn block_some() {
    #[cfg(unix)]
    {
        use nix::sys::signal::{SigSet, Signal};
        let mut signals = SigSet::empty();
        signals.add(Signal::SIGXFSZ);
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        if ignores(&status, Signal::SIGHUP) {
            signals.add(Signal::SIGHUP);
        }
        // Where that cannot be had the signal ends the program, as it would have.
        let _ = signals.thread_block();
    }
}
