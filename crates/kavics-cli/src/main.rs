//! The kavics command: a thin shell around the library, the results and the report.

mod arguments;
mod check;
mod compared;
mod draw;
mod draw_arguments;
mod export;
mod failure;
mod fault;
mod limits;
mod measure;
mod origins;
mod overrides;
mod own_files;
mod pack;
mod pack_summary;
mod progress;
mod resume;
mod run;
mod scene_file;
mod signals;
mod summary;
mod terminal;
mod texts;
mod verify;
#[cfg(feature = "view")]
mod view;

use std::io::{ErrorKind, Write, stdout};
use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Task};
use failure::Failure;

fn main() -> ExitCode {
    fault::tell_of_faults();
    signals::block_some();
    let done = match Arguments::try_parse() {
        Ok(arguments) => {
            terminal::speak(arguments.loudness());
            perform(arguments.task)
        }
        // Help and version are told in this way too.
        Err(told) => match told.print() {
            Ok(()) => return ExitCode::from(told.exit_code() as u8),
            Err(error) => Err(error.into()),
        },
    };
    match done.and_then(|()| Ok(stdout().flush()?)) {
        Ok(()) => ExitCode::SUCCESS,
        // Who stops reading, as head does, has what it wanted.
        Err(Failure::Output(error)) if error.kind() == ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(failure) => {
            terminal::say_error(&failure.to_string());
            failure.status()
        }
    }
}

fn perform(task: Task) -> Result<(), Failure> {
    match task {
        Task::Check(arguments) => check::check(&arguments),
        Task::Pack(arguments) => pack::pack(&arguments),
        Task::Run(arguments) => run::run(&arguments),
        Task::Measure(arguments) => measure::measure(&arguments),
        Task::Report(arguments) => texts::report(&arguments),
        #[cfg(feature = "view")]
        Task::View(arguments) => view::view(&arguments),
        Task::Draw(arguments) => draw::draw(&arguments),
        Task::Export(arguments) => export::export(&arguments),
        Task::Verify(arguments) => verify::verify(&arguments),
        Task::Schema => texts::schema(),
        Task::Completions(arguments) => texts::completions(&arguments),
        Task::Man(arguments) => texts::man(&arguments),
    }
}
