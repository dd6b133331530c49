//! `kavics pack`: the grains alone.

use std::io::{Write, stdout};

use kavics_results::{check_output, grains_csv, write_grains};

use crate::arguments::PackArguments;
use crate::failure::Failure;
use crate::{pack_summary, scene_file};

pub fn pack(arguments: &PackArguments) -> Result<(), Failure> {
    scene_file::start_threads(arguments.threads)?;
    if let Some(path) = &arguments.output {
        check_output(path, &scene_file::files_placing(&arguments.scene)?)?;
    }
    let pack = scene_file::place_grains(&arguments.scene, arguments.any_size)?;
    if let Some(path) = &arguments.output {
        write_grains(path, pack.grains.values())?;
    } else if !arguments.summary {
        stdout().write_all(grains_csv(pack.grains.values()).as_bytes())?;
    }
    if arguments.summary {
        stdout().write_all(pack_summary::summary(&pack).as_bytes())?;
    }
    Ok(())
}
