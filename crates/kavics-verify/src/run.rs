//! A scene that the program ran, and its tables.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use kavics_results::{Columns, ResultsFolder};

/// What a run left behind.
#[derive(Clone, Debug)]
pub struct Run {
    /// Exit status.
    pub status: i32,
    /// Text for the user.
    pub stderr: String,
    output: PathBuf,
}

impl Run {
    /// `PROGRAM run SCENE -o DIR …`, or `PROGRAM pack SCENE -o FILE …`, the output in the folder `room`.
    ///
    /// # Errors
    /// A program that cannot be started.
    pub fn of(
        program: &Path,
        task: &str,
        scene: &Path,
        arguments: &[&str],
        room: &Path,
    ) -> io::Result<Self> {
        let output = room.join(if task == "pack" {
            "grains.csv"
        } else {
            "results"
        });
        let mut command = Command::new(program);
        command.arg(task).arg(scene).arg("-o").arg(&output);
        let done = command.args(arguments).stdin(Stdio::null()).output()?;
        Ok(Self {
            status: done.status.code().unwrap_or(-1),
            stderr: String::from_utf8_lossy(&done.stderr).into_owned(),
            output,
        })
    }

    /// The results folder.
    ///
    /// # Errors
    /// No such folder, in words.
    pub fn results(&self) -> Result<ResultsFolder, String> {
        ResultsFolder::open(&self.output)
            .map_err(|error| format!("{error}; {}", self.stderr.trim()))
    }

    /// A table; `steps`, `iterations` and `events` hold all load steps.
    ///
    /// # Errors
    /// A table that cannot be read, in words.
    pub fn table(&self, name: &str, step: usize) -> Result<Columns, String> {
        let results = self.results()?;
        let table = match name {
            "steps" => results.steps(),
            "events" => results.events(),
            "grains" => results.grains(step),
            "contacts" => results.contacts(step),
            "sides" => results.sides(step),
            "voids" => results.voids(step),
            "cracks" => {
                let cracks = results.cracks(step).map_err(|error| error.to_string())?;
                return cracks.ok_or_else(|| format!("no cracks at load step {step}"));
            }
            other => Columns::read(&results.path().join(format!("{other}.parquet"))),
        };
        table.map_err(|error| error.to_string())
    }

    /// A column of `steps`.
    ///
    /// # Errors
    /// A table that cannot be read, in words.
    pub fn steps(&self, column: &str) -> Result<Vec<f64>, String> {
        let steps = self.table("steps", 0)?;
        steps.numbers(column).map_err(|error| error.to_string())
    }

    /// The last load step.
    ///
    /// # Errors
    /// A table that cannot be read, in words.
    pub fn last_step(&self) -> Result<usize, String> {
        Ok(self.steps("step")?.last().map_or(0, |step| *step as usize))
    }

    /// What `pack` wrote.
    ///
    /// # Errors
    /// A file that cannot be read, in words.
    pub fn packed(&self) -> Result<String, String> {
        fs::read_to_string(&self.output).map_err(|error| format!("{error}; {}", self.stderr.trim()))
    }
}
