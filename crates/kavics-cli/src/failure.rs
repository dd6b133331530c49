//! Why a task failed, and the exit status that says so.

use std::path::PathBuf;
use std::process::ExitCode;

use kavics::equilibrium::SolveError;
use kavics::scene::SceneError;
use kavics_report::ReportError;
use kavics_results::ResultsError;
use kavics_verify::VerifyError;
use thiserror::Error;

/// Why a task failed.
#[derive(Debug, Error)]
pub enum Failure {
    /// The scene is wrong.
    #[error("{0}")]
    Scene(SceneError),
    /// `--set` cannot be understood.
    #[error("--set {given}: {reason}")]
    Override {
        /// What was given.
        given: String,
        /// What is wrong with it.
        reason: String,
    },
    /// `--window` cannot be understood.
    #[error("--window {given}: {reason}")]
    Window {
        /// What was given.
        given: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A load step has no equilibrium.
    #[error("{error}\nthe results in {} are valid up to load step {last}", folder.display())]
    NoEquilibrium {
        /// Why.
        error: SolveError,
        /// Last load step of the results.
        last: usize,
        /// Results folder.
        folder: PathBuf,
    },
    /// A file of the results could not be read or written.
    #[error("{0}")]
    Results(#[from] ResultsError),
    /// The report could not be made.
    #[error("{0}")]
    Report(#[from] ReportError),
    /// Validation cases could not be run.
    #[error("{0}")]
    Verify(#[from] VerifyError),
    /// Validation cases do not hold.
    #[error("{wrong} of the quantities are not as expected on this machine")]
    Verdict {
        /// How many.
        wrong: usize,
    },
    /// Standard output could not be written.
    #[error("stdout: {0}")]
    Output(#[from] std::io::Error),
    /// The machine has no memory for the run.
    #[error(
        "about {needed} of memory needed, {available} available; fewer grains, solver = \"iterative\" or a larger machine \
         may do, --any-size tries all the same"
    )]
    TooLarge {
        /// What the run needs.
        needed: String,
        /// What there is.
        available: String,
    },
    /// Threads could not be started.
    #[error("threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

impl Failure {
    /// The exit status.
    pub fn status(&self) -> ExitCode {
        let results = match self {
            Self::Results(error) | Self::Report(ReportError::Results(error)) => Some(error),
            _ => None,
        };
        if let Some(
            ResultsError::Exists { .. }
            | ResultsError::NotResults { .. }
            | ResultsError::NotOfARun { .. }
            | ResultsError::InUse { .. }
            | ResultsError::OtherScene { .. }
            | ResultsError::UnknownEnding { .. },
        ) = results
        {
            return ExitCode::from(2);
        }
        ExitCode::from(match self {
            Self::Verdict { .. } => 1,
            Self::Scene(SceneError::Wrong(_))
            | Self::Override { .. }
            | Self::Window { .. }
            | Self::TooLarge { .. }
            | Self::Verify(VerifyError::Unknown { .. }) => 2,
            Self::NoEquilibrium { .. } => 3,
            Self::Scene(SceneError::Unreadable { .. })
            | Self::Results(_)
            | Self::Report(_)
            | Self::Verify(_)
            | Self::Output(_)
            | Self::Threads(_) => 4,
        })
    }
}
