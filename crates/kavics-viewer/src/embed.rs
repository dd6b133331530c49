//! A part of a run that stands in a page of its own: chosen load steps within a budget of bytes.

use rayon::prelude::*;

use crate::choice::{Level, StepChoice, evenly, is_constant, level, listed};
use crate::column::PageColumn;
use crate::piece::{RunTable, StepTable};
use crate::run::PageRun;
use crate::script::{compressed, of_json, of_stream};
use crate::{Content, PageError, PageFolder, Piece};

/// Fewer load steps than this are a reason to leave out columns instead.
const ENOUGH_STEPS: usize = 5;

/// Rows from whose compression that of all rows is estimated, and how much larger the others may be.
const SAMPLE: usize = 1 << 16;
const ALLOWANCE: f64 = 1.1;

/// Letters that a byte takes in base64, and about the letters around the values of a column.
const IN_TEXT: f64 = 4.0 / 3.0;
const FRAME: f64 = 300.0;

/// About what an event, a dual edge, and the void cells about a grain take, compressed.
const BYTES_AN_EVENT: usize = 30;
const BYTES_A_DUAL_EDGE: usize = 18;
const BYTES_OF_CELLS: usize = 20;

/// What is embedded, as elements of a page.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Embedded {
    /// The elements, to stand before the script of the viewer; nothing where nothing fits.
    pub html: String,
    /// What was left out, a sentence each.
    pub left_out: Vec<String>,
}

/// A part of the data, and what it takes of a page.
#[derive(Clone, Copy, Debug)]
struct Cost {
    level: Level,
    /// Whether it is embedded once, and not with every load step.
    once: bool,
    bytes: f64,
}

/// What can be embedded of a run.
struct Embedding<'a> {
    folder: &'a PageFolder,
    run: PageRun,
}

/// Load steps of a run within `budget` bytes.
///
/// # Errors
/// Load steps that are named and not recorded; tables that cannot be read.
pub fn embed(
    folder: &PageFolder,
    choice: &StepChoice,
    budget: usize,
) -> Result<Embedded, PageError> {
    let run = folder.run()?;
    let wanted = choice.of(&run.recorded)?;
    let Some(&last) = wanted.last() else {
        return Ok(Embedded::default());
    };
    let mut embedding = Embedding { folder, run };
    let mut left_out = embedding.leave_out_events(budget);
    let growing = embedding.growing()?;
    let taken = growing.len() + embedding.record().len();
    let left = budget.saturating_sub(taken);
    let costs = embedding.costs(last)?;
    let enough = match choice {
        StepChoice::Fitting => wanted.len().min(ENOUGH_STEPS),
        StepChoice::Named(_) => wanted.len(),
    };
    let chosen = chosen(&costs, &wanted, enough, left);
    let found = chosen.map(|(level, steps)| embedding.of_steps(level, steps, left));
    let Some((level, steps, elements)) = found.transpose()?.flatten() else {
        return Ok(Embedded {
            html: String::new(),
            left_out: vec![too_large(&embedding.run, budget)],
        });
    };
    left_out.extend(sentences(level, &wanted, &steps));
    embedding.keep(level, &steps);
    Ok(Embedded {
        html: [embedding.record(), growing, elements].concat(),
        left_out,
    })
}

/// How much of how many load steps fits into `left` bytes: at least `enough` of them where columns can be left out.
fn chosen(
    costs: &[Cost],
    wanted: &[usize],
    enough: usize,
    left: usize,
) -> Option<(Level, Vec<usize>)> {
    let fitting = |level: Level| {
        let sum = |once: bool| -> f64 {
            let part = costs.iter().filter(|c| c.once == once && c.level <= level);
            part.map(|cost| cost.bytes).sum()
        };
        ((left as f64 - sum(true)) / sum(false).max(1.0)).max(0.0) as usize
    };
    let with = |enough: usize| {
        let mut levels = Level::FROM_MOST.into_iter();
        levels.find(|&level| fitting(level) >= enough)
    };
    let level = with(enough).or_else(|| with(1))?;
    Some((level, evenly(wanted, fitting(level))))
}

/// What a column takes of a page, from a part of its rows.
fn cost(column: &PageColumn, rows: usize) -> f64 {
    let sampled = rows.min(SAMPLE);
    let bytes = column.bytes_of(sampled);
    let share = rows as f64 / sampled.max(1) as f64;
    FRAME + ALLOWANCE * IN_TEXT * share * compressed(&bytes).len() as f64
}

impl Embedding<'_> {
    fn record(&self) -> String {
        let record = serde_json::to_string(&self.run);
        of_json(Piece::Run, &record.expect("words and numbers are JSON"))
    }

    /// Leaves out the events where they alone would take much of the page.
    fn leave_out_events(&mut self, budget: usize) -> Vec<String> {
        let events = self.folder.rows(RunTable::Events);
        if events * BYTES_AN_EVENT <= budget / 3 {
            return Vec::new();
        }
        self.run.tables.remove(RunTable::Events.name());
        vec![format!("The {events} events are left out.")]
    }

    /// The tables of the whole run.
    fn growing(&self) -> Result<String, PageError> {
        let there = |table: &&RunTable| self.run.tables.contains_key(table.name());
        let tables: Vec<&RunTable> = RunTable::ALL.iter().filter(there).collect();
        let element = |&table: &RunTable| self.element(Piece::Growing(table), None);
        let elements: Result<Vec<String>, PageError> = tables.into_iter().map(element).collect();
        Ok(elements?.concat())
    }

    fn element(&self, piece: Piece, columns: Option<&[&str]>) -> Result<String, PageError> {
        Ok(match self.folder.piece(piece, columns)? {
            Content::Json(text) => of_json(piece, &text),
            Content::Arrow(bytes) => of_stream(piece, &bytes),
        })
    }

    /// What the parts of a load step take, by the columns of `step`.
    fn costs(&self, step: usize) -> Result<Vec<Cost>, PageError> {
        let mut costs = Vec::new();
        for table in StepTable::ALL {
            let names = self.names(table, step, Level::All, true);
            if names.is_empty() {
                continue;
            }
            let (columns, _) = self.folder.columns(table, step, Some(&names), SAMPLE)?;
            let rows = self.folder.rows_of(table, step)?;
            costs.par_extend(columns.par_iter().filter_map(|column| {
                Some(Cost {
                    level: level(table, &column.name)?,
                    once: is_constant(table, &column.name),
                    bytes: cost(column, rows),
                })
            }));
        }
        costs.extend(self.costs_of_graphs());
        Ok(costs)
    }

    /// Estimates for what is not in the tables.
    fn costs_of_graphs(&self) -> [Cost; 2] {
        let dual = if self.run.has.dual {
            self.run.contacts
        } else {
            0
        };
        let cells = if self.run.has.cells.is_empty() {
            0
        } else {
            self.run.grains
        };
        let cost = |once, bytes: usize| Cost {
            level: Level::All,
            once,
            bytes: IN_TEXT * bytes as f64,
        };
        [
            cost(true, BYTES_A_DUAL_EDGE * dual),
            cost(false, BYTES_OF_CELLS * cells),
        ]
    }

    /// Columns of a table that are embedded at this level; those that never change with the first load step.
    fn names(&self, table: StepTable, step: usize, most: Level, first: bool) -> Vec<&str> {
        if !self.folder.is_there(table, step) {
            return Vec::new();
        }
        let columns = self.run.tables.get(table.name()).into_iter().flatten();
        let names = columns.map(|column| column.name.as_str());
        let wanted = |name: &&str| {
            level(table, name).is_some_and(|level| level <= most)
                && (first || !is_constant(table, name))
        };
        names.filter(wanted).collect()
    }

    /// The elements of load steps, of fewer where they are larger than was thought.
    fn of_steps(
        &self,
        level: Level,
        mut steps: Vec<usize>,
        left: usize,
    ) -> Result<Option<(Level, Vec<usize>, String)>, PageError> {
        let dual = if level == Level::All && self.run.has.dual {
            self.element(Piece::Dual, None)?
        } else {
            String::new()
        };
        let numbered = steps.par_iter().enumerate();
        let elements = numbered.map(|(number, &step)| self.of_step(level, step, number == 0));
        let mut elements: Vec<String> = elements.collect::<Result<_, _>>()?;
        while dual.len() + elements.iter().map(String::len).sum::<usize>() > left {
            if elements.len() < 2 {
                return Ok(None);
            }
            // The first has what never changes, the last is what the run led to.
            let place = if elements.len() > 2 {
                elements.len() - 2
            } else {
                1
            };
            elements.remove(place);
            steps.remove(place);
        }
        elements.insert(0, dual);
        Ok(Some((level, steps, elements.concat())))
    }

    fn of_step(&self, most: Level, step: usize, first: bool) -> Result<String, PageError> {
        let mut elements = Vec::new();
        for table in StepTable::ALL {
            let names = self.names(table, step, most, first);
            if !names.is_empty() {
                elements.push(self.element(Piece::Step(table, step), Some(&names))?);
            }
        }
        elements.push(self.element(Piece::Crosses(step), None)?);
        if most == Level::All && self.run.has.cells.contains(&step) {
            elements.push(self.element(Piece::Cells(step), None)?);
        }
        Ok(elements.concat())
    }

    /// Keeps of the record what is embedded.
    fn keep(&mut self, most: Level, steps: &[usize]) {
        let run = &mut self.run;
        run.embedded = true;
        run.recorded = steps.to_vec();
        for table in StepTable::ALL {
            if let Some(columns) = run.tables.get_mut(table.name()) {
                columns.retain(|column| level(table, &column.name).is_some_and(|l| l <= most));
                if columns.is_empty() {
                    run.tables.remove(table.name());
                }
            }
        }
        let whole = most == Level::All;
        run.has.dual &= whole;
        let has = &mut run.has;
        for kept in [&mut has.cells, &mut has.voids, &mut has.modes] {
            kept.retain(|step| whole && steps.contains(step));
        }
        has.cracks.retain(|step| steps.contains(step));
    }
}

fn too_large(run: &PageRun, budget: usize) -> String {
    format!(
        "{} grains with {} contacts do not fit into {} MB, so the viewer is left out.",
        run.grains,
        run.contacts,
        budget / 1_000_000
    )
}

/// What was left out of the load steps.
fn sentences(level: Level, wanted: &[usize], steps: &[usize]) -> Vec<String> {
    let mut sentences = Vec::new();
    if steps.len() < wanted.len() {
        sentences.push(format!(
            "Of {} load steps with tables {} are shown: {}.",
            wanted.len(),
            steps.len(),
            listed(steps)
        ));
    }
    if level < Level::All {
        sentences.push(format!("Left out are {}.", level.left_out()));
    }
    sentences
}
