//! Scenes that the command runs, and their tables read back.

use std::path::{Path, PathBuf};

use kavics_results::Columns;
use tempfile::TempDir;

pub use kavics_verify::ContactRow;

/// The folder of the workspace.
pub fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// What the command left behind.
pub struct Run {
    /// Exit status.
    pub status: i32,
    /// Text for the user.
    pub stderr: String,
    left: kavics_verify::Run,
    _room: TempDir,
}

impl Run {
    /// `kavics run SCENE -o DIR …`, or `kavics pack SCENE -o FILE …`.
    pub fn of(task: &str, scene: &Path, arguments: &[&str]) -> Self {
        let room = tempfile::tempdir().expect("a temporary folder");
        let program = Path::new(env!("CARGO_BIN_EXE_kavics"));
        let run = kavics_verify::Run::of(program, task, scene, arguments, room.path());
        let run = run.expect("the command runs");
        Self {
            status: run.status,
            stderr: run.stderr.clone(),
            left: run,
            _room: room,
        }
    }

    /// A scene of `scenes/`.
    pub fn scene(name: &str) -> Self {
        Self::of("run", &workspace().join("scenes").join(name), &[])
    }

    /// A table; `steps`, `iterations` and `events` hold all load steps.
    pub fn table(&self, name: &str, step: usize) -> Result<Columns, String> {
        self.left.table(name, step)
    }

    /// A column of `steps`.
    pub fn steps(&self, column: &str) -> Vec<f64> {
        self.left.steps(column).expect("a column of steps")
    }

    /// The last load step.
    pub fn last_step(&self) -> usize {
        self.left.last_step().expect("steps")
    }
}

/// The tables of one load step.
pub struct Tables;

impl Tables {
    /// Those of a run.
    pub fn read(run: &Run, step: usize) -> kavics_verify::Tables {
        kavics_verify::Tables::read(&run.left, step).expect("tables")
    }
}
