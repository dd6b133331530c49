//! What a run will need, and what the machine has.

use std::fs;
use std::path::Path;

use kavics::equilibrium::Iteration;
use kavics::scene::Scene;

use crate::failure::Failure;

/// Bytes of the program itself.
const PROGRAM: f64 = 20e6;
/// Bytes a grain and a contact with a factor, the factor apart, and with the solver that iterates: fitted to the
/// largest resident size of whole runs (docs/benchmarks.md).
const DIRECT: [f64; 2] = [1950.0, 1160.0];
const ITERATIVE: [f64; 2] = [2000.0, 1200.0];
/// Bytes a grain to place it, and to find its contacts.
const PLACING: [f64; 2] = [100.0, 450.0];
/// Values of the factor for each unknown and each doubling of their number, with three contacts a grain, and the power
/// in which they fall with fewer.
const FILL: f64 = 8.4;
const FILL_POWER: f64 = 2.7;
/// An unsymmetric matrix has both triangles, and rows change places.
const UNSYMMETRIC: f64 = 2.5;
/// Bytes of a row of `steps`.
const STEP_ROW: f64 = 1000.0;
/// The estimate may be this much too high, so what needs little more than there is may try.
const DOUBT: f64 = 1.25;

/// The address space is a wall: at its end an allocation fails and the run is over. The estimate may be this much too
/// low, and there must be room for what the allocator sets apart for a run, and for each of its threads.
const CAUTION: f64 = 1.2;
const SET_APART: [f64; 2] = [220e6, 72e6];
/// The same where nothing is solved.
const SET_APART_PLACING: f64 = 20e6;

/// The report and its pictures: so many times the results, and at most so many bytes.
const REPORT: [f64; 2] = [2.0, 6e6];

/// Columns of numbers that are the same at every load step: of grains, of contacts.
const UNCHANGING: [f64; 2] = [4.0, 9.0];
/// Columns of numbers that change.
const CHANGING: [f64; 2] = [11.0, 6.0];

/// What a run will need.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    /// Largest resident memory in bytes.
    pub memory: f64,
    /// Bytes of the results on disk, without the report.
    pub results: f64,
}

/// What is counted in a scene.
#[derive(Clone, Copy, Debug)]
struct Size {
    grains: f64,
    contacts: f64,
    steps: f64,
}

impl Estimate {
    /// The estimate for a scene.
    pub fn of(scene: &Scene) -> Self {
        let stages = scene.program.stages.iter();
        let size = Size {
            grains: scene.assembly.grains.len() as f64,
            contacts: scene.assembly.contacts.len() as f64,
            steps: stages.map(|stage| stage.factors.len()).sum::<usize>() as f64,
        };
        let results = results(scene, size);
        let [share, most] = REPORT;
        Self {
            memory: memory(scene, size) + (share * results).min(most),
            results,
        }
    }

    /// Refuses what this machine has no memory for.
    ///
    /// # Errors
    /// Memory that is not there.
    pub fn check(self, any_size: bool) -> Result<(), Failure> {
        let [run, thread] = SET_APART;
        let threads = rayon::current_num_threads() as f64;
        check_memory(self.memory, run + thread * threads, any_size)
    }
}

/// Refuses to place grains that this machine has no memory for, before any is placed.
///
/// # Errors
/// Memory that is not there.
pub fn check_placing(text: &str, with_contacts: bool, any_size: bool) -> Result<(), Failure> {
    let [grain, contact] = PLACING;
    let bytes = if with_contacts {
        grain + contact
    } else {
        grain
    };
    let grains = Scene::planned_grains(text).unwrap_or_default();
    check_memory(PROGRAM + bytes * grains, SET_APART_PLACING, any_size)
}

/// Refuses what does not fit into memory, or with what is `set_apart` into the address space.
fn check_memory(needed: f64, set_apart: f64, any_size: bool) -> Result<(), Failure> {
    let too_large = |what, needed, available| Failure::TooLarge {
        what,
        needed: bytes(needed),
        available: bytes(available),
    };
    let addresses = CAUTION * needed + set_apart;
    match (available(), allowed_addresses()) {
        _ if any_size => Ok(()),
        (_, Some(allowed)) if addresses > allowed => {
            Err(too_large("address space", addresses, allowed))
        }
        (Some(available), _) if needed > DOUBT * available => {
            Err(too_large("memory", needed, available))
        }
        _ => Ok(()),
    }
}

fn memory(scene: &Scene, size: Size) -> f64 {
    let unknowns = 3.0 * size.grains;
    let iterates = scene.settings.solver.iterates(unknowns as usize);
    let [grain, contact] = if iterates { ITERATIVE } else { DIRECT };
    let factor = if iterates { 0.0 } else { factor(scene, size) };
    let per_state = 24.0 * size.grains + 96.0 * size.contacts;
    let iterates = if scene.settings.keep_iterates {
        10.0
    } else {
        0.0
    };
    PROGRAM
        + grain * size.grains
        + contact * size.contacts
        + factor
        + iterates * per_state
        + STEP_ROW * size.steps
}

/// Bytes of the factor of a plane graph, whose fill grows like n·log n.
fn factor(scene: &Scene, size: Size) -> f64 {
    if size.grains == 0.0 {
        return 0.0;
    }
    let unknowns = 3.0 * size.grains;
    let density = (size.contacts / (3.0 * size.grains)).min(1.0);
    let values = FILL * unknowns * unknowns.log2() * density.powf(FILL_POWER);
    let unsymmetric = scene.settings.iteration == Iteration::Tangent;
    8.0 * values * if unsymmetric { UNSYMMETRIC } else { 1.0 }
}

fn results(
    scene: &Scene,
    Size {
        grains,
        contacts,
        steps,
    }: Size,
) -> f64 {
    let every = scene.record_every.max(1) as f64;
    let recorded = (steps / every).floor() + if steps % every > 0.0 { 1.0 } else { 0.0 };
    let chosen = &scene.record_columns;
    let columns = |names: &Option<Vec<String>>, table: usize| match names {
        Some(names) => names.len() as f64,
        None => UNCHANGING[table] + CHANGING[table],
    };
    let before = 8.0 * (UNCHANGING[0] * grains + UNCHANGING[1] * contacts);
    let step =
        8.0 * (columns(&chosen.grains, 0) * grains + columns(&chosen.contacts, 1) * contacts);
    before + recorded * step + STEP_ROW * steps
}

/// A number of bytes in words.
pub fn bytes(count: f64) -> String {
    match count {
        ..1e6 => format!("{:.0} kB", count / 1e3),
        ..1e10 => format!("{:.0} MB", count / 1e6),
        _ => format!("{:.1} GB", count / 1e9),
    }
}

/// Memory that may still be taken, where the system says so: Linux does.
pub fn available() -> Option<f64> {
    let read = |path: &str| fs::read_to_string(path).ok();
    let meminfo = read("/proc/meminfo")?;
    let machine = kilobytes(&meminfo, "MemAvailable:")? + kilobytes(&meminfo, "SwapFree:")?;
    let groups = read("/proc/self/cgroup").unwrap_or_default();
    let limits = control_groups(&groups).into_iter();
    Some(limits.fold(machine, f64::min))
}

/// The address space that this process may have, where it is bounded.
fn allowed_addresses() -> Option<f64> {
    address_space(&fs::read_to_string("/proc/self/limits").ok()?)
}

/// A line of `/proc/meminfo` in bytes.
fn kilobytes(meminfo: &str, name: &str) -> Option<f64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix(name))?;
    let number: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(1024.0 * number)
}

/// The bound that `ulimit -v` sets.
fn address_space(limits: &str) -> Option<f64> {
    let line = limits
        .lines()
        .find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// What each control group above this process leaves of its bound.
fn control_groups(groups: &str) -> Vec<f64> {
    let mut left = Vec::new();
    for line in groups.lines() {
        let mut parts = line.splitn(3, ':');
        let (Some(_), Some(controllers), Some(group)) = (parts.next(), parts.next(), parts.next())
        else {
            continue;
        };
        let root = match controllers {
            "" => Path::new("/sys/fs/cgroup"),
            named if named.split(',').any(|name| name == "memory") => {
                Path::new("/sys/fs/cgroup/memory")
            }
            _ => continue,
        };
        let folder = root.join(group.trim_start_matches('/'));
        let folders = folder
            .ancestors()
            .take_while(|above| above.starts_with(root));
        left.extend(folders.filter_map(left_in));
    }
    left
}

/// The bound of a control group less what it holds and could not give back.
fn left_in(folder: &Path) -> Option<f64> {
    let number = |name: &str| -> Option<f64> {
        let text = fs::read_to_string(folder.join(name)).ok()?;
        text.trim().parse().ok()
    };
    let bound = number("memory.max").or_else(|| number("memory.limit_in_bytes"))?;
    let held = number("memory.current").or_else(|| number("memory.usage_in_bytes"))?;
    let statistics = fs::read_to_string(folder.join("memory.stat")).unwrap_or_default();
    let cached = statistics
        .lines()
        .find_map(|line| line.strip_prefix("inactive_file "))
        .and_then(|count| count.parse::<f64>().ok());
    Some(bound - held + cached.unwrap_or(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_system_says_is_read() {
        let meminfo = "MemTotal:  100 kB\nMemAvailable:   50 kB\n";
        assert_eq!(kilobytes(meminfo, "MemAvailable:"), Some(51_200.0));
        let limits = "Limit Soft Hard Units\nMax address space   1000000   unlimited  bytes\n";
        assert_eq!(address_space(limits), Some(1e6));
        let none = "Max address space   unlimited   unlimited  bytes\n";
        assert_eq!(address_space(none), None);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn what_no_machine_has_memory_for_is_refused_unless_it_is_wanted() {
        let estimate = Estimate {
            memory: 1e18,
            results: 0.0,
        };
        let refused = estimate.check(false).expect_err("a refusal").to_string();
        assert!(
            refused.starts_with("about 1000000000.0 GB of memory needed"),
            "{refused}"
        );
        assert!(estimate.check(true).is_ok());
    }

    #[test]
    fn a_control_group_leaves_what_it_does_not_hold() {
        let group = tempfile::tempdir().expect("a temporary folder");
        let write = |name: &str, text: &str| fs::write(group.path().join(name), text);
        write("memory.max", "1000\n").expect("room");
        write("memory.current", "700\n").expect("room");
        write("memory.stat", "anon 500\ninactive_file 200\n").expect("room");
        assert_eq!(left_in(group.path()), Some(500.0));
        write("memory.max", "max\n").expect("room");
        assert_eq!(left_in(group.path()), None);
    }
}
