//! Runs that are broken off, and what is left of them.
#![allow(dead_code, reason = "each test program uses a part of this")]

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use tempfile::TempDir;

/// Grains whose bonds break one by one, hundreds of them.
pub const EVENTS: &str = r#"seed = 3
[box]
width = 82.0
height = "fit"
[grains.hexagonal]
radius = 1.0
rows = { count = 40, longest = 40 }
[contact.mortar.cemented]
stiffness.layer = { normal = 1.0, shear = 0.6 }
strength.stress = { tension = 0.01, shear = 0.02, bending = 0.02 }
strength.scatter.weibull = { shape = 1.5 }
[[support]]
grains = { edge = "bottom" }
fix = ["x", "y"]
[[move]]
name = "pull"
grains = { edge = "top" }
x = 0.0
y = 1.0
[[stage]]
factors = { to = 0.4, steps = 6 }
[equilibrium]
breakage = "event-driven"
[record]
every = 4
"#;

/// Grains that break, slide and are loaded to and fro; each iterate is kept.
pub const SLIDING: &str = r#"seed = 5
[box]
width = 12.0
height = "fit"
[grains.dropped]
count = 80
radius = { from = 0.5, to = 1.0 }
[contact.mortar.cemented]
stiffness.layer = { normal = 100.0, shear = 60.0 }
shear_hardening = 0.75
reading = "history"
shear_floor = 0.05
strength.stress = { tension = 0.05, shear = 0.1, bending = 0.1 }
after_breakage = "grit"
[contact.grit.cohesionless]
stiffness.layer = { normal = 100.0, shear = 50.0 }
friction = 0.4
[[zone]]
contact = "mortar"
[side.left]
contact = "mortar"
[side.right]
contact = "mortar"
[side.bottom]
contact = "mortar"
[side.top]
contact = "mortar"
reach = 1.0
[[move]]
name = "press"
side = "top"
y = -0.02
[[stage]]
factors = [0.25, 0.5, 0.75, 1.0, 0.6, 0.2, 0.5, 0.8, 1.1, 1.3]
[measure]
every = "iteration"
stability = 2
[record]
every = 3
"#;

/// A chain of softening bonds, pulled beyond its peak.
pub const SOFTENING: &str = r#"seed = 2
[box]
width = 14.0
height = "fit"
[grains.dropped]
count = 120
radius = { from = 0.7, to = 1.3 }
[contact.mortar.cemented]
stiffness.modulus = { normal = 1000.0, shear = 500.0 }
strength.stress = { tension = 1.0, shear = 2.0, bending = 2.0 }
strength.scatter.weibull = { shape = 6.0 }
fracture_energy = 0.03
[[zone]]
contact = "mortar"
[side.bottom]
contact = "mortar"
reach = 1.0
[side.top]
contact = "mortar"
reach = 2.0
free = ["x", "y", "rotation"]
[[load]]
name = "pull"
side = "top"
force = { y = 1.0 }
[[stage]]
factors = { to = 20.0, steps = 10 }
[equilibrium]
control = "auto"
[record]
every = 20
"#;

/// A scene in a folder of its own, with an uninterrupted run of it.
pub struct Place {
    room: TempDir,
    scene: PathBuf,
    /// How long the uninterrupted run took.
    pub whole: Duration,
}

impl Place {
    /// Runs the scene once, without interruption.
    pub fn with(scene: &str) -> Self {
        let room = tempfile::tempdir().expect("a temporary folder");
        let path = room.path().join("scene.toml");
        fs::write(&path, scene).expect("room on the disk");
        let start = Instant::now();
        let place = Self {
            scene: path,
            room,
            whole: Duration::ZERO,
        };
        let done = place.run("whole", &[]);
        assert!(
            done.status.code().is_some_and(|c| c == 0 || c == 3),
            "{}",
            said(&done)
        );
        Self {
            whole: start.elapsed(),
            ..place
        }
    }

    /// A scene of `scenes/`.
    pub fn of(name: &str) -> Self {
        let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
        Self::with(&fs::read_to_string(scenes.join(name)).expect("a scene"))
    }

    /// The folder of a run.
    pub fn folder(&self, name: &str) -> PathBuf {
        self.room.path().join(name)
    }

    /// `kavics run SCENE -o FOLDER …`, a checkpoint after every load step or pause.
    pub fn command(&self, name: &str, arguments: &[&str]) -> Command {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin("kavics"));
        command.arg("run").arg(&self.scene).arg("-o");
        command.arg(self.folder(name)).args(["--checkpoint", "0"]);
        command.args(arguments).current_dir(self.room.path());
        command
    }

    pub fn run(&self, name: &str, arguments: &[&str]) -> Output {
        self.command(name, arguments)
            .output()
            .expect("the command runs")
    }

    pub fn spawn(&self, name: &str, arguments: &[&str]) -> Child {
        let mut command = self.command(name, arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command.spawn().expect("the command runs")
    }

    /// Begins a run and answers once it has come to a load step.
    pub fn run_to(&self, name: &str, step: usize) -> Child {
        let mut child = self.spawn(name, &["--json"]);
        let out = BufReader::new(child.stdout.take().expect("a pipe"));
        let reached = format!("{{\"step\":{step},");
        let mut lines = out.lines().map_while(Result::ok);
        assert!(
            lines.any(|line| line.starts_with(&reached)),
            "no load step {step}"
        );
        child
    }

    /// Goes on to the end, and compares every file but the log with those of the uninterrupted run.
    pub fn assert_ends_alike(&self, name: &str, arguments: &[&str]) -> String {
        let mut with = vec!["--resume"];
        with.extend(arguments);
        let done = self.run(name, &with);
        assert!(
            done.status.code().is_some_and(|c| c == 0 || c == 3),
            "{}",
            said(&done)
        );
        self.assert_alike(name);
        said(&done)
    }

    /// The same where the two ran on other numbers of threads, which record and report show.
    pub fn assert_ends_alike_but_for_threads(&self, name: &str) {
        let done = self.run(name, &["--resume", "--threads", "2"]);
        assert!(
            done.status.code().is_some_and(|c| c == 0 || c == 3),
            "{}",
            said(&done)
        );
        self.assert_same(name, |file| file != "report.html" && file != "run.json");
    }

    pub fn assert_alike(&self, name: &str) {
        self.assert_same(name, |_| true);
    }

    fn assert_same(&self, name: &str, counts: impl Fn(&str) -> bool) {
        let of = |name| -> Vec<(String, Vec<u8>)> {
            let files = files(&self.folder(name)).into_iter();
            files.filter(|file| counts(&file.0)).collect()
        };
        let (whole, found) = (of("whole"), of(name));
        let names = |files: &[(String, Vec<u8>)]| -> Vec<String> {
            files.iter().map(|file| file.0.clone()).collect()
        };
        assert_eq!(names(&found), names(&whole));
        for ((file, bytes), (_, expected)) in found.iter().zip(&whole) {
            assert!(bytes == expected, "{file} differs");
        }
    }
}

/// What the command said.
pub fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Waits until a file is there.
pub fn wait_for(path: &Path) {
    let start = Instant::now();
    while !path.exists() {
        assert!(
            start.elapsed() < Duration::from_mins(1),
            "{}",
            path.display()
        );
        sleep(Duration::from_millis(2));
    }
}

/// Every file under `folder` with its bytes, in the order of the names, but the log.
pub fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.path().is_dir() {
            let inner = files(&entry.path()).into_iter();
            found.extend(inner.map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
        } else if name != "log.ndjson" {
            found.push((name, fs::read(entry.path()).expect("a file")));
        }
    }
    found.sort();
    found
}

/// Random numbers in [0, 1), xorshift by Marsaglia (2003).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}
