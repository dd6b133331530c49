//! How far a run has come, in one line on a terminal; load step by load step where more is wanted.

use std::fmt::Write;
use std::sync::Arc;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use kavics::equilibrium::{Equilibrium, Glance, Watch};
use kavics::loading::Program;

use crate::terminal::{self, Loudness};

/// The line is drawn so often, whether a load step has ended or not.
const BETWEEN: Duration = Duration::from_millis(100);
/// Cells of the bar.
const CELLS: usize = 7;
/// No time left is guessed before this share of the run is done.
const LEAST_SHARE: f64 = 0.005;

/// The line that shows how far a run has come; none where stderr is no terminal.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    step_began: Instant,
}

/// Load factors at the ends of each load step.
#[derive(Clone, Debug, Default)]
struct Plan {
    ends: Vec<[f64; 2]>,
}

impl Progress {
    /// Follows a load path through its `watch`.
    pub fn new(program: &Program, watch: Arc<Watch>) -> Self {
        let bar = match terminal::loudness() {
            Loudness::Quiet => ProgressBar::hidden(),
            _ => ProgressBar::new_spinner(),
        };
        let plan = Plan::of(program);
        let draw = move |state: &ProgressState, text: &mut dyn Write| {
            let broken = state.pos() as usize;
            let line = line(&plan, watch.glance(), broken, state.elapsed());
            let _ = text.write_str(&line);
        };
        let style = ProgressStyle::with_template("{line}");
        let style = style.expect("a template that is known to be right");
        bar.set_style(style.with_key("line", draw));
        bar.enable_steady_tick(BETWEEN);
        Self {
            bar,
            step_began: Instant::now(),
        }
    }

    /// A load step has ended; `broken` bonds have broken so far.
    pub fn note(&mut self, equilibrium: &Equilibrium, broken: usize) {
        self.bar.set_position(broken as u64);
        let took = self.step_began.elapsed();
        self.step_began = Instant::now();
        if terminal::loudness() == Loudness::Verbose {
            let line = step_line(equilibrium, broken, took);
            self.bar.suspend(|| terminal::say_more(&line));
        }
    }

    /// Takes the line away.
    pub fn end(self) {
        self.bar.finish_and_clear();
    }
}

impl Plan {
    fn of(program: &Program) -> Self {
        let mut factors = vec![0.0; program.actions.len()];
        let mut ends = Vec::new();
        for stage in &program.stages {
            for &to in &stage.factors {
                let from = stage.actions.first().map_or(0.0, |&action| factors[action]);
                ends.push([from, to]);
                for &action in &stage.actions {
                    factors[action] = to;
                }
            }
        }
        Self { ends }
    }

    /// Share of the run that is done.
    fn share(&self, glance: Glance) -> f64 {
        let Some([from, to]) = self.ends.get(glance.step.wrapping_sub(1)) else {
            return if glance.step == 0 { 0.0 } else { 1.0 };
        };
        let within = (glance.load_factor - from) / (to - from);
        let within = if within.is_finite() {
            within.clamp(0.0, 1.0)
        } else {
            0.0
        };
        ((glance.step - 1) as f64 + within) / self.ends.len() as f64
    }
}

/// The line: load step, load factor, residual, broken contacts, time left.
fn line(plan: &Plan, glance: Glance, broken_before: usize, elapsed: Duration) -> String {
    let share = plan.share(glance);
    let done = (share * CELLS as f64) as usize;
    let bar = "█".repeat(done) + &"░".repeat(CELLS - done);
    let steps = plan.ends.len();
    format!(
        "step {}/{steps} {bar} factor {:.4}, residual {:.0e}, {} broken, {}",
        glance.step,
        glance.load_factor,
        glance.residual,
        broken_before + glance.broken,
        time_left(share, elapsed),
    )
}

/// The time left if all goes on as it has.
fn time_left(share: f64, elapsed: Duration) -> String {
    if share < LEAST_SHARE {
        return format!("{} so far", time(elapsed.as_secs_f64()));
    }
    let left = elapsed.as_secs_f64() * (1.0 - share) / share;
    format!("{} left", time(left))
}

/// A time in words.
pub fn time(seconds: f64) -> String {
    match seconds {
        ..0.995 => format!("{seconds:.2} s"),
        ..99.5 => format!("{seconds:.0} s"),
        ..5970.0 => format!("{:.0} min", seconds / 60.0),
        _ => format!("{:.1} h", seconds / 3600.0),
    }
}

/// What is said of a load step where more is wanted.
fn step_line(equilibrium: &Equilibrium, broken: usize, took: Duration) -> String {
    let Equilibrium {
        step, iterations, ..
    } = equilibrium;
    let mut line = format!(
        "step {step}: factor {:.6}, {iterations} linear solves",
        equilibrium.load_factor
    );
    if equilibrium.work_iterations > 0 {
        let _ = write!(line, " and {} for the work", equilibrium.work_iterations);
    }
    if equilibrium.cuts > 0 {
        let _ = write!(line, ", halved {}×", equilibrium.cuts);
    }
    let _ = writeln!(
        line,
        ", residual {:.1e},\n  {broken} broken, {} events, {}",
        equilibrium.residual,
        equilibrium.events.len(),
        time(took.as_secs_f64())
    );
    line
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::COLUMNS;

    fn plan() -> Plan {
        Plan {
            ends: vec![[0.0, 2.0], [2.0, 1.0]],
        }
    }

    fn at(step: usize, load_factor: f64) -> Glance {
        Glance {
            step,
            load_factor,
            ..Glance::default()
        }
    }

    #[test]
    fn the_share_moves_within_a_load_step() {
        assert_eq!(plan().share(at(0, 0.0)), 0.0);
        assert_eq!(plan().share(at(1, 1.0)), 0.25);
        assert_eq!(plan().share(at(2, 1.25)), 0.875);
        assert_eq!(
            plan().share(at(3, 9.0)),
            1.0,
            "more load steps than planned"
        );
    }

    #[test]
    fn the_time_left_is_that_of_the_rest_at_the_same_speed() {
        assert_eq!(time_left(0.25, Duration::from_secs(20)), "60 s left");
        assert_eq!(time_left(0.0, Duration::from_mins(10)), "10 min so far");
    }

    #[test]
    fn a_long_run_fits_into_eighty_columns() {
        let plan = Plan {
            ends: vec![[0.0, 1.0]; 1000],
        };
        let glance = Glance {
            step: 999,
            iterations: 12_345,
            broken: 99_999,
            load_factor: -123.456,
            residual: 3.2e-11,
        };
        let line = line(&plan, glance, 0, Duration::from_hours(10));
        assert!(line.chars().count() < COLUMNS, "{line}");
    }
}
