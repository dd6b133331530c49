//! The kavics command: a thin shell around the library, the results and the report.

mod arguments;
mod check;
mod failure;
mod measure;
mod overrides;
mod own_files;
mod pack;
mod run;
mod scene_file;
mod summary;
mod texts;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Task};
use failure::Failure;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match perform(arguments.task) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{failure}");
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
        Task::Schema => texts::schema(),
        Task::Completions(arguments) => texts::completions(&arguments),
        Task::Man => texts::man(),
    }
}
