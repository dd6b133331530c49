//! The tasks that only write a text: report, schema, completions, manual page.

use std::io::{Write, stdout};

use clap::CommandFactory;
use kavics_report::StepChoice;
use kavics_results::{ResultsFolder, check_output};

use crate::arguments::{Arguments, CompletionsArguments, ManArguments, ReportArguments};
use crate::failure::Failure;
use crate::scene_file::{say, show_warnings};

pub fn report(arguments: &ReportArguments) -> Result<(), Failure> {
    let steps = arguments.steps.clone();
    let steps = steps.map_or(StepChoice::Fitting, StepChoice::Named);
    let output = arguments.output.as_deref();
    if let Some(path) = output {
        check_output(path, &[])?;
    }
    let path = kavics_report::write_steps(&arguments.results, output, &steps)?;
    say(&format!("report: {}\n", path.display()));
    let folder = ResultsFolder::open(&arguments.results)?;
    let last = folder.steps()?.len();
    show_warnings(folder.record()?.state.unfinished(last).as_slice());
    Ok(())
}

pub fn schema() -> Result<(), Failure> {
    Ok(writeln!(stdout(), "{}", kavics::scene::schema())?)
}

pub fn completions(arguments: &CompletionsArguments) -> Result<(), Failure> {
    let mut command = Arguments::command();
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, "kavics", &mut text);
    Ok(stdout().write_all(&text)?)
}

pub fn man(arguments: &ManArguments) -> Result<(), Failure> {
    let mut command = Arguments::command();
    command.build();
    let task = arguments.task.as_ref();
    let task = task.and_then(|task| command.find_subcommand(task).cloned());
    let mut text = Vec::new();
    clap_mangen::Man::new(task.unwrap_or(command)).render(&mut text)?;
    Ok(stdout().write_all(&text)?)
}
