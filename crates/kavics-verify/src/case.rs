//! A validation case: its runs, and what is expected of them.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use tempfile::TempDir;
use thiserror::Error;

use crate::embedded::FILES;
use crate::expected::{Finding, Row};
use crate::run::Run;

/// A validation case that cannot be run.
#[derive(Debug, Error)]
pub enum VerifyError {
    /// There is no such case.
    #[error("no validation case is called {name}; expected one of {}", case_names().join(", "))]
    Unknown {
        /// What it was called.
        name: String,
    },
    /// There is no room for the runs.
    #[error("{}: {source}", path.display())]
    Room {
        /// Where room was sought.
        path: PathBuf,
        /// Why there is none.
        source: io::Error,
    },
    /// The program cannot be started.
    #[error("{}: cannot be started: {source}", program.display())]
    Program {
        /// The program.
        program: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// A validation case: a folder of `validation/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Case {
    /// Name of its folder.
    pub name: &'static str,
}

/// The names of all cases, in their order.
pub fn case_names() -> Vec<&'static str> {
    let folders = FILES.iter().filter_map(|(path, _)| {
        let name = path.strip_prefix("validation/")?;
        name.strip_suffix("/expected.csv")
    });
    folders.collect()
}

/// A line of `runs.csv`.
struct PlannedRun {
    name: String,
    task: String,
    scene: String,
    values: Vec<String>,
}

impl Case {
    /// The case of a name.
    ///
    /// # Errors
    /// No such case.
    pub fn named(name: &str) -> Result<Self, VerifyError> {
        let mut all = Self::all().into_iter();
        all.find(|case| case.name == name)
            .ok_or_else(|| VerifyError::Unknown {
                name: name.to_owned(),
            })
    }

    /// Every case.
    pub fn all() -> Vec<Self> {
        case_names().into_iter().map(|name| Self { name }).collect()
    }

    /// What it is about, in a few words.
    pub fn title(self) -> &'static str {
        let page = self.file("README.md").unwrap_or_default();
        let heading = page.lines().find_map(|line| line.strip_prefix("# "));
        heading.unwrap_or(self.name)
    }

    /// The names of its runs.
    pub fn runs(self) -> Vec<String> {
        self.plan().into_iter().map(|run| run.name).collect()
    }

    /// The runs that something is expected of.
    pub fn runs_expected(self) -> Vec<&'static str> {
        self.rows().iter().map(|row| row.run).collect()
    }

    fn file(self, name: &str) -> Option<&'static str> {
        let path = format!("validation/{}/{name}", self.name);
        let mut files = FILES.iter();
        files
            .find(|(other, _)| *other == path)
            .map(|(_, text)| *text)
    }

    fn rows(self) -> Vec<Row<'static>> {
        let lines = self.file("expected.csv").unwrap_or_default().lines();
        lines
            .skip(1)
            .filter(|line| !line.is_empty() && !line.starts_with('#'))
            .map(Row::parse)
            .collect()
    }

    /// The runs of `runs.csv`; without it every scene of the folder as it is.
    fn plan(self) -> Vec<PlannedRun> {
        let Some(list) = self.file("runs.csv") else {
            return self.scenes_as_they_are();
        };
        let line = |line: &str| {
            let mut cells = line.splitn(4, ',').map(|cell| cell.trim().to_owned());
            let mut cell = || cells.next().unwrap_or_default();
            let (name, task, scene) = (cell(), cell(), cell());
            let values = cell();
            PlannedRun {
                name,
                task,
                scene,
                values: values.split_whitespace().map(str::to_owned).collect(),
            }
        };
        list.lines().skip(1).map(line).collect()
    }

    fn scenes_as_they_are(self) -> Vec<PlannedRun> {
        let folder = format!("validation/{}/", self.name);
        let scenes = FILES.iter().filter_map(|(path, _)| {
            let scene = path.strip_prefix(&folder)?;
            Some((scene.strip_suffix(".toml")?, scene))
        });
        let run = |(name, scene): (&str, &str)| PlannedRun {
            name: name.to_owned(),
            task: "run".to_owned(),
            scene: scene.to_owned(),
            values: Vec::new(),
        };
        scenes.map(run).collect()
    }
}

/// Room for the runs of cases, with all their files.
#[derive(Debug)]
pub struct Verifier {
    program: PathBuf,
    room: TempDir,
}

impl Verifier {
    /// Lays out the files of all cases in a temporary folder; `program` is to run their scenes.
    ///
    /// # Errors
    /// No room for them.
    pub fn new(program: &Path) -> Result<Self, VerifyError> {
        let room = tempfile::tempdir().map_err(no_room(&std::env::temp_dir()))?;
        for (name, text) in FILES {
            let path = room.path().join(name);
            if let Some(folder) = path.parent() {
                fs::create_dir_all(folder).map_err(no_room(folder))?;
            }
            fs::write(&path, text).map_err(no_room(&path))?;
        }
        Ok(Self {
            program: program.to_owned(),
            room,
        })
    }

    /// Runs a case: what was expected and what was found, in the order of the expectations.
    ///
    /// # Errors
    /// A program that cannot be started; no room.
    pub fn verify(&self, case: Case) -> Result<Vec<Finding>, VerifyError> {
        let runs = case.plan().into_par_iter();
        let runs: BTreeMap<String, Run> = runs
            .map(|plan| Ok((plan.name.clone(), self.run(case, &plan)?)))
            .collect::<Result<_, VerifyError>>()?;
        let rows = case.rows();
        Ok(rows.iter().map(|row| row.find(case.name, &runs)).collect())
    }

    fn run(&self, case: Case, plan: &PlannedRun) -> Result<Run, VerifyError> {
        let folder = self.room.path().join("validation").join(case.name);
        let room = self
            .room
            .path()
            .join("runs")
            .join(case.name)
            .join(&plan.name);
        fs::create_dir_all(&room).map_err(no_room(&room))?;
        let mut arguments = vec!["--threads", "1"];
        for value in &plan.values {
            arguments.extend(["--set", value]);
        }
        let scene = folder.join(&plan.scene);
        let run = Run::of(&self.program, &plan.task, &scene, &arguments, &room);
        run.map_err(|source| VerifyError::Program {
            program: self.program.clone(),
            source,
        })
    }
}

fn no_room(path: &Path) -> impl FnOnce(io::Error) -> VerifyError + use<> {
    let path = path.to_owned();
    move |source| VerifyError::Room { path, source }
}
