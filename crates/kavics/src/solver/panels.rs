//! Where the factor stands in memory: panels of neighbouring columns with the same rows, column by column.

use std::ops::Range;

use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;

/// Columns of the factor that share their rows.
#[derive(Clone, Debug)]
pub(super) struct Panel {
    /// Its first column.
    pub first: usize,
    /// Number of columns.
    pub columns: usize,
    /// Number of rows: its own columns, then those below.
    pub rows: usize,
    /// Place of its first value.
    values: usize,
    /// Its runs in the list of all.
    runs: Range<usize>,
    /// The panel that holds the first row below.
    parent: Option<u32>,
}

impl Panel {
    /// The values of the panel, column by column, the pivots on the diagonal.
    pub fn values(&self) -> Range<usize> {
        self.values..self.values + self.rows * self.columns
    }

    /// The columns of the panel.
    pub fn own(&self) -> Range<usize> {
        self.first..self.first + self.columns
    }
}

/// Rows of a panel that follow each other in the matrix too.
#[derive(Clone, Copy, Debug)]
struct Run {
    row: u32,
    count: u32,
}

/// All panels, in the order of elimination.
#[derive(Debug, Default)]
pub(super) struct Panels {
    pub list: Vec<Panel>,
    runs: Vec<Run>,
    /// Panel of each column.
    of_column: Vec<u32>,
    /// Most rows of a panel.
    pub most_rows: usize,
}

impl Panels {
    pub fn new(symbolic: &SymbolicSupernodalCholesky<usize>) -> Self {
        let mut panels = Self::default();
        for panel in 0..symbolic.n_supernodes() {
            let own = symbolic.supernode_begin()[panel]..symbolic.supernode_end()[panel];
            let below = &symbolic.row_idx()[symbolic.col_ptr_for_row_idx()[panel]..]
                [..symbolic.nnz_per_super()[panel]];
            let runs = panels.add_runs(own.clone().chain(below.iter().copied()));
            panels.of_column.resize(own.end, panels.list.len() as u32);
            panels.list.push(Panel {
                first: own.start,
                columns: own.len(),
                rows: own.len() + below.len(),
                values: symbolic.col_ptr_for_val()[panel],
                runs,
                parent: below.first().map(|&row| row as u32),
            });
        }
        panels.finish();
        panels
    }

    fn add_runs(&mut self, rows: impl Iterator<Item = usize>) -> Range<usize> {
        let start = self.runs.len();
        let mut next = usize::MAX;
        for row in rows {
            if row == next {
                self.runs.last_mut().expect("a run was begun").count += 1;
            } else {
                let row = row as u32;
                self.runs.push(Run { row, count: 1 });
            }
            next = row + 1;
        }
        start..self.runs.len()
    }

    /// Turns the first row below into the panel that holds it.
    fn finish(&mut self) {
        for panel in &mut self.list {
            panel.parent = panel.parent.map(|row| self.of_column[row as usize]);
            self.most_rows = self.most_rows.max(panel.rows);
        }
    }

    /// The pivots, in the order of elimination.
    pub fn pivots<'a>(&'a self, factor: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.list.iter().flat_map(move |panel| {
            let diagonal = factor[panel.values()].iter().step_by(panel.rows + 1);
            diagonal.copied().take(panel.columns)
        })
    }

    /// Copies the rows of a panel out of a vector.
    pub fn gather(&self, panel: &Panel, vector: &[f64], local: &mut [f64]) {
        let mut place = 0;
        for run in &self.runs[panel.runs.clone()] {
            let (row, count) = (run.row as usize, run.count as usize);
            local[place..place + count].copy_from_slice(&vector[row..row + count]);
            place += count;
        }
    }

    /// Copies the rows of a panel back into a vector.
    pub fn scatter(&self, panel: &Panel, local: &[f64], vector: &mut [f64]) {
        let mut place = 0;
        for run in &self.runs[panel.runs.clone()] {
            let (row, count) = (run.row as usize, run.count as usize);
            vector[row..row + count].copy_from_slice(&local[place..place + count]);
            place += count;
        }
    }
}

/// The paths from some columns to the roots of the elimination tree, merged: panels in the order of elimination, each once.
#[derive(Debug, Default)]
pub(super) struct Paths {
    /// Next panel of each path, the first of them last.
    heads: Vec<u32>,
}

impl Paths {
    /// A path more.
    pub fn start(&mut self, panels: &Panels, column: usize) {
        self.add(panels.of_column[column]);
    }

    /// The panel that is next.
    pub fn head(&self) -> Option<usize> {
        self.heads.last().map(|&panel| panel as usize)
    }

    /// Takes the next panel; its successor joins the paths.
    pub fn next(&mut self, panels: &Panels) -> Option<usize> {
        let panel = self.heads.pop()? as usize;
        if let Some(parent) = panels.list[panel].parent {
            self.add(parent);
        }
        Some(panel)
    }

    pub fn clear(&mut self) {
        self.heads.clear();
    }

    fn add(&mut self, panel: u32) {
        let place = self.heads.partition_point(|&head| head > panel);
        if self.heads.get(place) != Some(&panel) {
            self.heads.insert(place, panel);
        }
    }
}
