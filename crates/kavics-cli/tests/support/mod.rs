//! Scenes that the command runs, and their tables read back.
#![allow(dead_code, reason = "each test program uses a part of this")]

pub mod expected;
pub mod identities;
pub mod packed;
pub mod tables;

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use kavics_results::{Columns, ResultsError, ResultsFolder};
use tempfile::TempDir;

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
    room: TempDir,
}

impl Run {
    /// `kavics run SCENE -o DIR …`, or `kavics pack SCENE -o FILE …`.
    pub fn of(task: &str, scene: &Path, arguments: &[&str]) -> Self {
        let room = tempfile::tempdir().expect("a temporary folder");
        let output = if task == "pack" {
            "grains.csv"
        } else {
            "results"
        };
        let mut command = Command::cargo_bin("kavics").expect("the command");
        command.arg(task).arg(scene).arg("-o");
        command.arg(room.path().join(output)).args(arguments);
        let done = command.output().expect("the command runs");
        Self {
            status: done.status.code().unwrap_or(-1),
            stderr: String::from_utf8_lossy(&done.stderr).into_owned(),
            room,
        }
    }

    /// A scene of `scenes/`.
    pub fn scene(name: &str) -> Self {
        Self::of("run", &workspace().join("scenes").join(name), &[])
    }

    /// The results folder.
    pub fn results(&self) -> ResultsFolder {
        ResultsFolder::open(&self.room.path().join("results"))
            .unwrap_or_else(|error| panic!("{error}\n{}", self.stderr))
    }

    /// A table; `steps`, `iterations` and `events` hold all load steps.
    pub fn table(&self, name: &str, step: usize) -> Result<Columns, ResultsError> {
        let results = self.results();
        match name {
            "steps" => results.steps(),
            "events" => results.events(),
            "grains" => results.grains(step),
            "contacts" => results.contacts(step),
            "sides" => results.sides(step),
            "voids" => results.voids(step),
            "cracks" => Ok(results.cracks(step)?.expect("the scene asks for cracks")),
            other => Columns::read(&results.path().join(format!("{other}.parquet"))),
        }
    }

    /// A column of `steps`.
    pub fn steps(&self, column: &str) -> Vec<f64> {
        let steps = self.results().steps().expect("steps");
        steps.numbers(column).expect("a column of steps")
    }

    /// The last load step.
    pub fn last_step(&self) -> usize {
        self.steps("step").last().map_or(0, |step| *step as usize)
    }

    /// What `pack` wrote.
    pub fn packed(&self) -> String {
        std::fs::read_to_string(self.room.path().join("grains.csv")).expect("packed grains")
    }
}
