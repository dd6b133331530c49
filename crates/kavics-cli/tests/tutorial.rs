//! docs/tutorial.md and README.md are followed as a reader would: the files shown are written, the commands run, in their
//! order, and they say what stands there.
//!
//! A line `…` stands for any lines, `…` within a line for any text; `^C` for Ctrl-C. Commands of Python are passed over
//! where there is no Python with pandas.
#![cfg(all(unix, feature = "view"))]

use std::ffi::OsString;
use std::fs;
use std::os::unix::fs::symlink;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

const TUTORIAL: &str = include_str!("../../../docs/tutorial.md");
const README: &str = include_str!("../../../README.md");

/// A fenced block: what stands behind the fence, and the lines.
struct Block<'a> {
    language: &'a str,
    file: Option<&'a str>,
    lines: Vec<&'a str>,
}

fn blocks(page: &str) -> Vec<Block<'_>> {
    let mut lines = page.lines();
    let mut blocks = Vec::new();
    while let Some(line) = lines.next() {
        let Some(fence) = line.strip_prefix("```") else {
            continue;
        };
        let (language, rest) = fence.split_once(' ').unwrap_or((fence, ""));
        blocks.push(Block {
            language,
            file: rest.strip_prefix("file="),
            lines: lines.by_ref().take_while(|line| *line != "```").collect(),
        });
    }
    blocks
}

/// A command, whether Ctrl-C ends it, and what it says.
struct Shown<'a> {
    command: String,
    interrupted: bool,
    says: Vec<&'a str>,
}

fn shown<'a>(block: &Block<'a>) -> Vec<Shown<'a>> {
    let mut all: Vec<Shown> = Vec::new();
    for &line in &block.lines {
        if let Some(command) = line.strip_prefix("$ ") {
            all.push(Shown {
                command: command.to_owned(),
                interrupted: false,
                says: Vec::new(),
            });
            continue;
        }
        let last = all.last_mut().expect("a command before what it says");
        match line {
            "^C" => last.interrupted = true,
            line if last.goes_on() => last.command.extend(["\n", line]),
            line => last.says.push(line),
        }
    }
    all
}

impl Shown<'_> {
    /// Whether the next line belongs to the command.
    fn goes_on(&self) -> bool {
        self.command.ends_with('\\')
    }

    fn status(&self) -> i32 {
        let fails = self.says.first().is_some_and(|s| s.starts_with("error:"));
        match (self.interrupted, self.command.starts_with("kavics run")) {
            (true, true) => 75,
            _ if fails => 2,
            _ => 0,
        }
    }

    /// Runs in a folder, stderr and stdout in one file.
    fn run(&self, place: &Path) -> Output {
        let said = place.join("said.txt");
        let mut child = self.start(place, &said);
        if self.interrupted {
            self.wait(place, &said);
            interrupt(&child);
        }
        let status = child.wait().expect("an end");
        let stdout = fs::read(&said).expect("what was said");
        Output {
            status,
            stdout,
            stderr: Vec::new(),
        }
    }

    fn start(&self, place: &Path, said: &Path) -> Child {
        let file = fs::File::create(said).expect("a file");
        Command::new("sh")
            .args(["-c", &format!("exec {}", self.command)])
            .current_dir(place)
            .env("PATH", path_with_kavics())
            .stdin(Stdio::null())
            .stderr(file.try_clone().expect("the same file"))
            .stdout(file)
            .spawn()
            .expect("a shell")
    }

    /// Until a run has a checkpoint, anything else has said something.
    fn wait(&self, place: &Path, said: &Path) {
        let start = Instant::now();
        let runs = self.command.starts_with("kavics run");
        while !(runs && has_checkpoint(place) || !runs && has_said(said)) {
            assert!(start.elapsed() < Duration::from_mins(1), "{}", self.command);
            sleep(Duration::from_millis(2));
        }
    }

    fn assert_says(&self, said: &str) {
        let lines: Vec<&str> = said.lines().collect();
        assert!(
            lines_match(&self.says, &lines),
            "$ {}\nshown:\n{}\n\nsaid:\n{said}",
            self.command,
            self.says.join("\n")
        );
    }
}

/// Ctrl-C may come before a command that serves is ready to end by itself; it ends all the same.
fn status_of(output: &Output) -> Option<i32> {
    let by_interrupt = output.status.signal() == Some(Signal::SIGINT as i32);
    let status = output.status.code();
    status.or(by_interrupt.then_some(0))
}

fn has_said(said: &Path) -> bool {
    fs::read_to_string(said).is_ok_and(|text| text.contains('\n'))
}

fn has_checkpoint(place: &Path) -> bool {
    let folders = fs::read_dir(place).expect("the place");
    folders
        .map(|entry| entry.expect("an entry").path().join("checkpoint"))
        .any(|folder| fs::read_dir(folder).is_ok_and(|mut files| files.next().is_some()))
}

fn interrupt(child: &Child) {
    let child = Pid::from_raw(child.id() as i32);
    kill(child, Signal::SIGINT).expect("a running child");
}

fn path_with_kavics() -> OsString {
    let program = PathBuf::from(env!("CARGO_BIN_EXE_kavics"));
    let folder = program.parent().expect("a folder").to_owned();
    let others = std::env::var_os("PATH").unwrap_or_default();
    let all = std::iter::once(folder).chain(std::env::split_paths(&others));
    std::env::join_paths(all).expect("paths")
}

/// Lines of which `…` stands for any number.
fn lines_match(shown: &[&str], said: &[&str]) -> bool {
    match shown.split_first() {
        None => said.is_empty(),
        Some((&"…", rest)) => (0..=said.len()).any(|skipped| lines_match(rest, &said[skipped..])),
        Some((first, rest)) => said
            .split_first()
            .is_some_and(|(line, others)| line_matches(first, line) && lines_match(rest, others)),
    }
}

/// A line in which `…` stands for any text.
fn line_matches(shown: &str, said: &str) -> bool {
    match shown.split_once('…') {
        None => shown.trim_end() == said.trim_end(),
        Some((begin, rest)) => said.strip_prefix(begin).is_some_and(|said| {
            let mut ends = said.char_indices().map(|(at, _)| at).chain([said.len()]);
            ends.any(|at| line_matches(rest, &said[at..]))
        }),
    }
}

fn has_pandas() -> bool {
    let mut python = Command::new("python3");
    python.args(["-c", "import pandas, pyarrow"]);
    python
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|s| s.success())
}

#[test]
fn the_tutorial_can_be_followed() {
    let (room, pandas) = (tempfile::tempdir().expect("a folder"), has_pandas());
    for block in blocks(TUTORIAL) {
        if let Some(file) = block.file {
            fs::write(room.path().join(file), block.lines.join("\n") + "\n").expect("a file");
        }
        if block.language != "console" {
            continue;
        }
        for shown in shown(&block) {
            if shown.command.starts_with("python3") && !pandas {
                eprintln!("passed over, no python3 with pandas: {}", shown.command);
                continue;
            }
            let output = shown.run(room.path());
            let said = String::from_utf8_lossy(&output.stdout);
            shown.assert_says(&said);
            assert_eq!(status_of(&output), Some(shown.status()), "{said}");
        }
    }
}

/// The commands in the first column of indented lines.
fn listed(page: &str) -> impl Iterator<Item = &str> {
    let lines = page.lines().filter_map(|line| line.strip_prefix("    "));
    let lines = lines.filter(|line| line.starts_with("kavics "));
    lines.map(|line| line.split("  ").next().unwrap_or(line))
}

#[test]
fn the_commands_of_the_readme_work() {
    let room = tempfile::tempdir().expect("a folder");
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for folder in ["scenes", "validation"] {
        symlink(workspace.join(folder), room.path().join(folder)).expect("a link");
    }
    for command in listed(README) {
        let interrupted = command.starts_with("kavics view");
        let option = if interrupted { " --no-open" } else { "" };
        let shown = Shown {
            command: format!("{command}{option}"),
            interrupted,
            says: Vec::new(),
        };
        let output = shown.run(room.path());
        let said = String::from_utf8_lossy(&output.stdout);
        let status = status_of(&output);
        assert_eq!(status, Some(shown.status()), "{command}\n{said}");
    }
    assert!(listed(README).count() > 5);
}

#[test]
fn every_block_of_the_tutorial_is_used() {
    for block in blocks(TUTORIAL) {
        let used = block.file.is_some() || block.language == "console";
        assert!(used, "{}", block.lines.join("\n"));
    }
}

#[test]
fn left_out_lines_and_words_are_passed_over() {
    assert!(line_matches("step … of …", "step 1 of 10"));
    assert!(!line_matches("step … of 9", "step 1 of 10"));
    assert!(lines_match(&["a", "…", "d"], &["a", "b", "c", "d"]));
    assert!(!lines_match(&["a", "d"], &["a", "b", "d"]));
    assert!(!lines_match(&["a"], &["a", "b"]));
}
