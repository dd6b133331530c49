//! `kavics check`: what would run.

use std::io::{Write, stdout};

use kavics::scene::Scene;

use crate::arguments::CheckArguments;
use crate::failure::Failure;
use crate::limits::{Estimate, bytes};
use crate::scene_file;

pub fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    let (scene, _) = scene_file::read(&arguments.scene, arguments.any_size)?;
    let counts = Counts::of(&scene);
    let mut out = stdout().lock();
    if arguments.json {
        writeln!(out, "{}", counts.json())?;
    } else {
        for (name, value) in counts.lines() {
            writeln!(out, "{name:<11}{value}")?;
        }
    }
    scene_file::show_warnings(&scene.warnings);
    counts.estimate.check(arguments.any_size)
}

struct Counts {
    grains: usize,
    contacts: usize,
    freedoms: usize,
    held: usize,
    window: usize,
    stages: usize,
    steps: usize,
    estimate: Estimate,
}

impl Counts {
    fn of(scene: &Scene) -> Self {
        let sides = scene.assembly.sides.values().iter();
        let bodies = scene.assembly.grains.len() + sides.filter(|side| side.present).count();
        let held = scene.program.held.len() + scene.program.prescribed.len();
        Self {
            grains: scene.assembly.grains.len(),
            contacts: scene.assembly.contacts.len(),
            freedoms: (3 * bodies).saturating_sub(held),
            held,
            window: scene.window.len(),
            stages: scene.program.stages.len(),
            steps: scene.program.stages.iter().map(|s| s.factors.len()).sum(),
            estimate: Estimate::of(scene),
        }
    }

    fn json(&self) -> serde_json::Value {
        serde_json::json!({
            "grains": self.grains,
            "contacts": self.contacts,
            "freedoms": self.freedoms,
            "held": self.held,
            "window": self.window,
            "stages": self.stages,
            "steps": self.steps,
            "memory": self.estimate.memory.round(),
            "results": self.estimate.results.round(),
        })
    }

    fn lines(&self) -> [(&'static str, String); 8] {
        [
            ("grains", self.grains.to_string()),
            ("contacts", self.contacts.to_string()),
            (
                "freedoms",
                format!("{} ({} held or moved)", self.freedoms, self.held),
            ),
            ("window", format!("{} grains", self.window)),
            ("stages", self.stages.to_string()),
            ("load steps", self.steps.to_string()),
            ("memory", format!("about {}", bytes(self.estimate.memory))),
            ("results", format!("about {}", bytes(self.estimate.results))),
        ]
    }
}
