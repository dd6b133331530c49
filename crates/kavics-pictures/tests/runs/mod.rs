//! Results of small scenes.

use std::path::Path;

use kavics::measure::{Snapshot, Window, grain_stress, measures};
use kavics::scene::Scene;
use kavics_results::{Options, Results, ResultsFolder, RunState, read_grains};
use tempfile::TempDir;

/// A results folder that goes when it is dropped.
pub struct Run {
    pub scene: Scene,
    pub folder: ResultsFolder,
    _room: TempDir,
}

/// Runs a scene of `scenes/`, with lines added.
pub fn run(name: &str, added: &str) -> Run {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let text = std::fs::read_to_string(scenes.join(name)).expect("a scene") + added;
    let scene = Scene::parse(&text, name, &scenes, &read_grains).expect("a right scene");
    let room = tempfile::tempdir().expect("a temporary folder");
    let path = room.path().join("results");
    write(&path, &scene);
    let folder = ResultsFolder::open(&path).expect("results");
    Run {
        scene,
        folder,
        _room: room,
    }
}

fn write(path: &Path, scene: &Scene) {
    let window = Window::new(scene.window.clone(), scene.assembly.grains.len());
    let mut results = Results::create(path, scene, Options::default()).expect("a folder");
    for equilibrium in scene.load_path() {
        let equilibrium = equilibrium.expect("an equilibrium");
        let snapshot = Snapshot::new(&scene.assembly, &equilibrium);
        let (measures, stress) = (measures(&snapshot, &window), grain_stress(&snapshot));
        let pushed = results.push(&equilibrium, &measures, &stress);
        pushed.expect("room on the disk");
    }
    results
        .finish(RunState::Done, None)
        .expect("room on the disk");
}
