//! Load paths that take longer than anybody waits for are stopped, as a signal stops a run.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, Once, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// How long the load steps of one input may take.
const PATIENCE: Duration = Duration::from_secs(3);

static WATCHED: Mutex<Option<(Instant, Arc<AtomicBool>)>> = Mutex::new(None);

/// What stops a load path that begins now, in a while.
pub(crate) fn stop() -> Arc<AtomicBool> {
    static WATCHER: Once = Once::new();
    WATCHER.call_once(|| {
        thread::spawn(watch);
    });
    let stop = Arc::new(AtomicBool::new(false));
    let watched = (Instant::now(), Arc::clone(&stop));
    *WATCHED.lock().unwrap_or_else(PoisonError::into_inner) = Some(watched);
    stop
}

fn watch() {
    loop {
        thread::sleep(PATIENCE / 10);
        let watched = WATCHED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((began, stop)) = &*watched
            && began.elapsed() > PATIENCE
        {
            stop.store(true, Ordering::Relaxed);
        }
    }
}
