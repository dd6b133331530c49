//! Why a task failed, and the exit status that says so.

use std::path::PathBuf;
use std::process::ExitCode;

use kavics::equilibrium::SolveError;
use kavics::scene::SceneError;
use kavics_pictures::PictureError;
use kavics_report::{PageError, ReportError};
use kavics_results::ResultsError;
#[cfg(feature = "view")]
use kavics_server::ServerError;
use kavics_verify::VerifyError;
use thiserror::Error;

/// Status of a run that a signal stopped, and that can be run again.
pub const STOPPED: i32 = 75;
/// Status of what a signal ended at once, as shells count.
pub const INTERRUPTED: i32 = 130;

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
    /// The results to go on with ended without an equilibrium.
    #[error("{} has ended already: {why}", folder.display())]
    Ended {
        /// Results folder.
        folder: PathBuf,
        /// Why there is no equilibrium.
        why: String,
    },
    /// The run was told to stop.
    #[error("stopped after load step {last}; kavics run --resume goes on from the checkpoint in {}", folder.display())]
    Stopped {
        /// Last load step of the results.
        last: usize,
        /// Results folder.
        folder: PathBuf,
    },
    /// A run was told to stop while it placed grains or looked for contacts.
    #[error("stopped before anything was written; nothing is lost by running it again")]
    StoppedEarly,
    /// A task that leaves nothing behind was told to stop.
    #[error("stopped")]
    Interrupted,
    /// Signals cannot be waited for.
    #[error("signals: {0}")]
    Signals(#[from] ctrlc::Error),
    /// A file of the results could not be read or written.
    #[error("{0}")]
    Results(#[from] ResultsError),
    /// The report could not be made.
    #[error("{0}")]
    Report(#[from] ReportError),
    /// Nothing is served.
    #[cfg(feature = "view")]
    #[error("{0}")]
    Server(#[from] ServerError),
    /// A picture could not be made.
    #[error("{0}")]
    Picture(#[from] PictureError),
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
        "about {needed} of {what} needed, {available} available; fewer grains, solver = \"iterative\" or a larger machine \
         may do, --any-size tries all the same"
    )]
    TooLarge {
        /// Memory, or what of it may be spoken of.
        what: &'static str,
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
            Self::Results(error)
            | Self::Report(
                ReportError::Results(error) | ReportError::Viewer(PageError::Results(error)),
            )
            | Self::Picture(PictureError::Results(error)) => Some(error),
            #[cfg(feature = "view")]
            Self::Server(ServerError::Page(PageError::Results(error))) => Some(error),
            _ => None,
        };
        if let Some(
            ResultsError::Exists { .. }
            | ResultsError::NotResults { .. }
            | ResultsError::NotOfARun { .. }
            | ResultsError::InUse { .. }
            | ResultsError::NoOutput { .. }
            | ResultsError::Locked { .. }
            | ResultsError::OtherScene { .. }
            | ResultsError::SceneChanged { .. }
            | ResultsError::OtherAssembly { .. }
            | ResultsError::UnknownEnding { .. },
        ) = results
        {
            return ExitCode::from(2);
        }
        ExitCode::from(match self {
            Self::Verdict { .. } => 1,
            Self::Verify(VerifyError::Unknown { .. }) => 2,
            Self::Picture(error) if error.is_wrong_usage() => 2,
            Self::Scene(SceneError::Wrong(_))
            | Self::Override { .. }
            | Self::Window { .. }
            | Self::TooLarge { .. }
            | Self::Report(ReportError::Viewer(PageError::Unrecorded { .. })) => 2,
            Self::NoEquilibrium { .. } | Self::Ended { .. } => 3,
            Self::Stopped { .. } | Self::StoppedEarly => STOPPED as u8,
            Self::Interrupted => INTERRUPTED as u8,
            Self::Scene(SceneError::Unreadable { .. })
            | Self::Results(_)
            | Self::Report(_)
            | Self::Picture(_)
            | Self::Verify(_)
            | Self::Output(_)
            | Self::Threads(_)
            | Self::Signals(_) => 4,
            #[cfg(feature = "view")]
            Self::Server(_) => 4,
        })
    }
}
