//! `kavics pack`: the grains alone.

use std::io::{Write, stdout};

use kavics::scene::Scene;
use kavics_results::{grains_csv, write_grains};

use crate::arguments::PackArguments;
use crate::failure::Failure;
use crate::scene_file;

pub fn pack(arguments: &PackArguments) -> Result<(), Failure> {
    scene_file::start_threads(arguments.threads)?;
    let scene = scene_file::read(&arguments.scene)?;
    scene_file::show_warnings(&scene.warnings);
    let grains = scene.assembly.grains.values();
    if let Some(path) = &arguments.output {
        write_grains(path, grains)?;
    } else if !arguments.summary {
        stdout().write_all(grains_csv(grains).as_bytes())?;
    }
    if arguments.summary {
        stdout().write_all(summary(&scene).as_bytes())?;
    }
    Ok(())
}

fn summary(scene: &Scene) -> String {
    let grains = scene.assembly.grains.values();
    let radii = || grains.iter().map(|grain| grain.radius);
    let smallest = radii().fold(f64::INFINITY, f64::min);
    let largest = radii().fold(0.0, f64::max);
    let mean = scene.assembly.mean_radius();
    let top = grains.iter().map(|grain| grain.centre.y + grain.radius);
    let height = top.fold(f64::NEG_INFINITY, f64::max);
    let solid: f64 = radii().map(|r| std::f64::consts::PI * r * r).sum();
    let container: f64 = scene.assembly.cell_area.values().iter().sum();
    format!(
        "grains       {}\ncontacts     {}\nradius       {smallest:.6} to {largest:.6}, mean {mean:.6}\n\
         highest      {height:.6}\nsolid share  {:.6} of the box\n",
        grains.len(),
        scene.assembly.contacts.len(),
        solid / container
    )
}
