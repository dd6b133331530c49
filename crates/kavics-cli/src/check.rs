//! `kavics check`: what would run.

use std::io::{Write, stdout};

use kavics::scene::Scene;

use crate::arguments::CheckArguments;
use crate::failure::Failure;
use crate::scene_file;

pub fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    let (scene, _) = scene_file::read(&arguments.scene)?;
    let counts = Counts::of(&scene);
    let mut out = stdout().lock();
    for (name, value) in counts.lines() {
        writeln!(out, "{name:<11}{value}")?;
    }
    scene_file::show_warnings(&scene.warnings);
    Ok(())
}

struct Counts {
    grains: usize,
    contacts: usize,
    freedoms: usize,
    held: usize,
    window: usize,
    stages: usize,
    steps: usize,
    bodies: usize,
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
            bodies,
        }
    }

    fn lines(&self) -> [(&'static str, String); 7] {
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
            ("memory", format!("about {}", megabytes(self.memory()))),
        ]
    }

    /// Bytes: states, contacts, and the factor of a plane graph, whose fill grows like n·log n.
    fn memory(&self) -> f64 {
        let bodies = self.bodies as f64;
        let contacts = self.contacts as f64;
        let fill = 3.0 * bodies * (bodies + 2.0).log2();
        16e6 + 600.0 * bodies + 900.0 * contacts + 9.0 * 12.0 * fill
    }
}

fn megabytes(bytes: f64) -> String {
    format!("{:.0} MB", bytes / 1e6)
}
