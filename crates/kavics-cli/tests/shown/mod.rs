//! Pages followed as a reader would: their commands run, in their order, and they say what stands there.
//!
//! A line `…` stands for any lines, `…` within a line for any text; `^C` for Ctrl-C.
#![allow(dead_code, reason = "each test program uses a part of this")]

use std::ffi::OsString;
use std::fs;
use std::os::unix::fs::symlink;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use tempfile::TempDir;

/// A fenced block: what stands behind the fence, and the lines.
pub struct Block<'a> {
    pub language: &'a str,
    pub file: Option<&'a str>,
    pub lines: Vec<&'a str>,
}

/// A part of a page.
pub enum Part<'a> {
    Fenced(Block<'a>),
    Line(&'a str),
}

pub fn parts(page: &str) -> Vec<Part<'_>> {
    let mut lines = page.lines();
    let mut parts = Vec::new();
    while let Some(line) = lines.next() {
        let Some(fence) = line.strip_prefix("```") else {
            parts.push(Part::Line(line));
            continue;
        };
        let (language, rest) = fence.split_once(' ').unwrap_or((fence, ""));
        parts.push(Part::Fenced(Block {
            language,
            file: rest.strip_prefix("file="),
            lines: lines.by_ref().take_while(|line| *line != "```").collect(),
        }));
    }
    parts
}

pub fn blocks(page: &str) -> impl Iterator<Item = Block<'_>> {
    parts(page).into_iter().filter_map(|part| match part {
        Part::Fenced(block) => Some(block),
        Part::Line(_) => None,
    })
}

/// A command, whether Ctrl-C ends it, what it says, and what is said of it.
pub struct Shown<'a> {
    pub command: String,
    pub interrupted: bool,
    pub says: Vec<&'a str>,
    pub beside: &'a str,
}

/// The commands of a block.
pub fn shown<'a>(block: &Block<'a>) -> Vec<Shown<'a>> {
    let mut all: Vec<Shown> = Vec::new();
    for &line in &block.lines {
        if let Some(command) = line.strip_prefix("$ ") {
            all.push(Shown::new(command, ""));
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

/// The command of an indented line, with what stands beside it; what it says is not shown.
pub fn listed(line: &str) -> Option<Shown<'_>> {
    let line = line.strip_prefix("    ")?;
    let is_command = line.starts_with("kavics ") || line.contains(" kavics run ");
    let (command, beside) = line.split_once("  ").unwrap_or((line, ""));
    let beside = beside.trim_start();
    let has_places =
        command.split(' ').any(is_place) || beside.split(' ').next().is_some_and(is_place);
    let mut shown = Shown::new(command, beside);
    shown.says.push("…");
    shown.interrupted = command.starts_with("kavics view");
    (is_command && !has_places).then_some(shown)
}

/// Whether a word stands for what the reader fills in: `SCENE`, `[CASE]…`, `svg|png`.
fn is_place(word: &str) -> bool {
    let capitals = word.trim_start_matches('[').chars();
    word.contains('|') || capitals.take_while(char::is_ascii_uppercase).count() > 1
}

/// All commands of a page, in their order.
pub fn commands(page: &str) -> Vec<Shown<'_>> {
    let of_part = |part| match part {
        Part::Fenced(block) if block.language == "console" => shown(&block),
        Part::Fenced(_) => Vec::new(),
        Part::Line(line) => listed(line).into_iter().collect(),
    };
    parts(page).into_iter().flat_map(of_part).collect()
}

impl<'a> Shown<'a> {
    fn new(command: &str, beside: &'a str) -> Self {
        Self {
            command: command.to_owned(),
            interrupted: false,
            says: Vec::new(),
            beside,
        }
    }

    /// Whether the next line belongs to the command.
    fn goes_on(&self) -> bool {
        self.command.ends_with('\\')
    }

    fn is_run(&self) -> bool {
        self.command.starts_with("kavics run")
    }

    /// Status of the end, by the table of docs/command.md.
    pub fn status(&self) -> i32 {
        let says = |text| self.says.iter().any(|line| line.contains(text));
        let refusals = [
            "error:",
            " exists already",
            " is not recorded",
            " has no column",
        ];
        match (self.interrupted, self.is_run()) {
            (true, true) => 75,
            _ if refusals.into_iter().any(says) => 2,
            _ if says("are valid up to") || self.beside.contains("status 3") => 3,
            _ => 0,
        }
    }

    /// Runs in a folder; what it says must be what is shown.
    pub fn follow(&self, place: &Path) {
        let said = place.join("said.txt");
        let mut child = self.start(place, &said);
        if self.interrupted {
            self.wait(place, &said);
            interrupt(&child);
        }
        let status = child.wait().expect("an end");
        let said = fs::read(&said).expect("what was said");
        let said = String::from_utf8_lossy(&said);
        self.assert_says(&said);
        assert_eq!(
            status_of(status),
            Some(self.status()),
            "{}\n{said}",
            self.command
        );
    }

    /// No browser, and a checkpoint at once where Ctrl-C waits for it.
    fn in_test(&self) -> String {
        let lacks = |option| !self.command.contains(option);
        let views = self.command.starts_with("kavics view") && lacks("--no-open");
        let runs = self.interrupted && self.is_run() && lacks("--checkpoint");
        let option = match (views, runs) {
            (true, _) => " --no-open",
            (_, true) => " --checkpoint 0",
            _ => "",
        };
        format!("{}{option}", self.command)
    }

    /// Stderr and stdout go into one file.
    fn start(&self, place: &Path, said: &Path) -> Child {
        let file = fs::File::create(said).expect("a file");
        let mut shell = Command::new("sh");
        if self.command.contains('~') {
            shell.env("HOME", place);
        }
        shell
            .args(["-c", &format!("exec {}", self.in_test())])
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
        let runs = self.is_run();
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

/// A folder in which `scenes/` and `validation/` stand as in the workspace.
pub fn room() -> TempDir {
    let room = tempfile::tempdir().expect("a folder");
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for folder in ["scenes", "validation"] {
        symlink(workspace.join(folder), room.path().join(folder)).expect("a link");
    }
    room
}

/// Writes a block that is a file.
pub fn write(block: &Block, place: &Path) {
    if let Some(file) = block.file {
        fs::write(place.join(file), block.lines.join("\n") + "\n").expect("a file");
    }
}

/// Whether the shell finds a program.
pub fn has_program(name: &str) -> bool {
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("command -v {name}")]);
    shell.env("PATH", path_with_kavics()).stdout(Stdio::null());
    shell.status().is_ok_and(|status| status.success())
}

/// Ctrl-C may come before a command that serves is ready to end by itself; it ends all the same.
fn status_of(status: ExitStatus) -> Option<i32> {
    let by_interrupt = status.signal() == Some(Signal::SIGINT as i32);
    status.code().or(by_interrupt.then_some(0))
}

fn has_said(said: &Path) -> bool {
    fs::read_to_string(said).is_ok_and(|text| text.contains('\n'))
}

fn has_checkpoint(place: &Path) -> bool {
    let folders = fs::read_dir(place).expect("the place");
    folders
        .map(|entry| entry.expect("an entry").path().join("checkpoint"))
        .filter_map(|folder| fs::read_dir(folder).ok())
        .flat_map(Iterator::flatten)
        .any(|file| {
            file.path()
                .extension()
                .is_some_and(|ending| ending == "arrow")
        })
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
pub fn lines_match(shown: &[&str], said: &[&str]) -> bool {
    match shown.split_first() {
        None => said.is_empty(),
        Some((&"…", rest)) => (0..=said.len()).any(|skipped| lines_match(rest, &said[skipped..])),
        Some((first, rest)) => said
            .split_first()
            .is_some_and(|(line, others)| line_matches(first, line) && lines_match(rest, others)),
    }
}

/// A line in which `…` stands for any text.
pub fn line_matches(shown: &str, said: &str) -> bool {
    text_matches(&without_rounding(shown.trim_end()), said.trim_end())
}

fn text_matches(shown: &str, said: &str) -> bool {
    match shown.split_once('…') {
        None => shown == said,
        Some((begin, rest)) => said.strip_prefix(begin).is_some_and(|said| {
            let mut ends = said.char_indices().map(|(at, _)| at).chain([said.len()]);
            ends.any(|at| text_matches(rest, &said[at..]))
        }),
    }
}

/// A small residual is rounding, which may differ between machines: any text stands for it.
fn without_rounding(line: &str) -> String {
    let is_rounding = |word: &str| word.contains("e-1") && word.parse::<f64>().is_ok();
    let words = line.split(' ');
    let kept: Vec<&str> = words
        .map(|word| if is_rounding(word) { "…" } else { word })
        .collect();
    kept.join(" ")
}
