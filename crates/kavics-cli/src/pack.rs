//! `kavics pack`: the grains alone.

use std::io::{Write, stdout};

use kavics::assembly::Grain;
use kavics::geometry::Vector;
use kavics::ids::PerGrain;
use kavics::packing::statistics::packing_fraction;
use kavics_results::{grains_csv, write_grains};

use crate::arguments::PackArguments;
use crate::failure::Failure;
use crate::scene_file;

pub fn pack(arguments: &PackArguments) -> Result<(), Failure> {
    scene_file::start_threads(arguments.threads)?;
    let grains = scene_file::place_grains(&arguments.scene)?;
    if let Some(path) = &arguments.output {
        write_grains(path, grains.values())?;
    } else if !arguments.summary {
        stdout().write_all(grains_csv(grains.values()).as_bytes())?;
    }
    if arguments.summary {
        stdout().write_all(summary(&grains).as_bytes())?;
    }
    Ok(())
}

/// Smallest and largest of some values.
fn extent(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
        [low.min(v), high.max(v)]
    })
}

fn summary(grains: &PerGrain<Grain>) -> String {
    let discs = grains.values();
    let [smallest, largest] = extent(discs.iter().map(|grain| grain.radius));
    let mean = discs.iter().map(|grain| grain.radius).sum::<f64>() / discs.len() as f64;
    let [left, _] = extent(discs.iter().map(|grain| grain.centre.x - grain.radius));
    let [_, right] = extent(discs.iter().map(|grain| grain.centre.x + grain.radius));
    let [_, top] = extent(discs.iter().map(|grain| grain.centre.y + grain.radius));
    let solid = packing_fraction(grains, Vector::new(left, 0.0), Vector::new(right, top));
    format!(
        "grains            {}\nradius            {smallest:.6} to {largest:.6}, mean {mean:.6}\n\
         highest           {top:.6}\npacking fraction  {solid:.6} between the outermost grains, from floor to top\n",
        discs.len(),
    )
}
