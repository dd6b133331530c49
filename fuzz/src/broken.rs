//! Runs that were broken off, and any bytes as their checkpoint.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use kavics::loading::Station;
use kavics::measure::{Snapshot, Window, grain_stress, measures};
use kavics::scene::Scene;
use kavics_results::{Checkpoint, Options, Results};
use xxhash_rust::xxh3::xxh3_64;

/// Bonds that break one by one; contacts that slide, each iterate kept; a load path that is steered.
const SCENES: [&str; 3] = [
    include_str!("../scenes/breaking.toml"),
    include_str!("../scenes/sliding.toml"),
    include_str!("../scenes/steered.toml"),
];

/// Where a load path came to before it was broken off: so many load steps and events.
const STATIONS: usize = 4;

/// A scene whose run was broken off.
#[derive(Debug)]
pub struct Broken {
    scene: Scene,
    /// Its checkpoint.
    whole: Vec<u8>,
}

impl Broken {
    /// The run of one of the scenes.
    pub fn off(number: u8) -> &'static Self {
        static ALL: OnceLock<Vec<Broken>> = OnceLock::new();
        let all = ALL.get_or_init(|| SCENES.map(Self::of).into());
        &all[usize::from(number) % all.len()]
    }

    fn of(text: &str) -> Self {
        let no_list = |_: &Path, _| Err("there are no lists".to_owned());
        let scene = Scene::parse(text, "fuzz.toml", Path::new("/nowhere"), &no_list);
        let scene = scene.expect("a scene");
        let whole = checkpoint(&scene);
        let broken = Self { scene, whole };
        assert_eq!(broken.goes_on_from(&broken.whole), Ok(()));
        broken
    }

    /// The bytes of its checkpoint with some of them written over: three bytes say where, the fourth with what.
    pub fn written_over(&self, edits: &[u8]) -> Vec<u8> {
        let mut bytes = self.whole.clone();
        for edit in edits.chunks_exact(4) {
            let place = u32::from_le_bytes([edit[0], edit[1], edit[2], 0]) as usize % bytes.len();
            bytes[place] = edit[3];
        }
        bytes
    }

    /// Goes on from a checkpoint of these bytes, its own up to the next equilibrium.
    ///
    /// # Errors
    /// Why it cannot.
    pub fn goes_on_from(&self, bytes: &[u8]) -> Result<(), String> {
        let place = tempfile::tempdir().expect("room for files");
        let folder = place.path();
        fs::create_dir(folder.join("checkpoint")).expect("room for a folder");
        let name = format!("checkpoint/000001-{:016x}.arrow", xxh3_64(bytes));
        fs::write(folder.join(name), bytes).expect("room for a file");
        let checkpoint = Checkpoint::newest(folder, &self.scene).map_err(|e| e.to_string())?;
        let checkpoint = checkpoint.expect("the file that was written");
        let path = self.scene.load_path().resume(&checkpoint.memory);
        let mut path = path.map_err(|error| error.to_string())?;
        path.last_equilibrium();
        let results = Results::resume(folder, &self.scene, Options::default(), &checkpoint);
        results.map_err(|error| error.to_string())?;
        // From a state that never was the next equilibrium may be farther than anybody waits for.
        match (bytes == self.whole).then(|| path.next()).flatten() {
            Some(Err(error)) => Err(error.to_string()),
            _ => Ok(()),
        }
    }
}

/// The checkpoint of a run that comes to a few stations.
fn checkpoint(scene: &Scene) -> Vec<u8> {
    let place = tempfile::tempdir().expect("room for files");
    let folder = place.path().join("results");
    let mut results = Results::create(&folder, scene, Options::default()).expect("an empty place");
    let window = Window::new(scene.window.clone(), scene.assembly.grains.len());
    let mut path = scene.load_path();
    for _ in 0..STATIONS {
        let station = path
            .advance()
            .expect("a longer path")
            .expect("an equilibrium");
        if let Station::Equilibrium(equilibrium) = station {
            let snapshot = Snapshot::new(&scene.assembly, &equilibrium);
            let pushed = results.push(
                &equilibrium,
                &measures(&snapshot, &window),
                &grain_stress(&snapshot),
            );
            pushed.expect("room for files");
        }
    }
    let memory = path.memory().expect("a path that goes on");
    results.checkpoint(memory).expect("room for a file");
    let paths: Vec<PathBuf> = fs::read_dir(folder.join("checkpoint"))
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    fs::read(&paths[0]).expect("the checkpoint")
}
