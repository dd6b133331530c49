//! The pieces of page data of a results folder.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_schema::DataType;
use kavics_pictures::Layout;
use kavics_results::{Columns, ResultsFolder, RunState, TableHead};

use crate::column::PageColumn;
use crate::graphs::{self, KeptLayout};
use crate::made::{Made, breaks};
use crate::piece::{RunTable, StepTable};
use crate::read::{Precision, column, names, unit};
use crate::row::row;
use crate::run::FORMAT;
use crate::table::stream;
use crate::{ColumnRecord, Has, PageError, PageRun, Piece, crosses, words};

/// What a piece is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// JSON.
    Json(String),
    /// An Arrow stream.
    Arrow(Vec<u8>),
}

/// A results folder, seen piece by piece. Nothing outside of it is read, and nothing is written.
#[derive(Clone, Debug)]
pub struct PageFolder {
    results: ResultsFolder,
    root: PathBuf,
    layout: KeptLayout,
}

impl PageFolder {
    /// The results folder at `path`.
    ///
    /// # Errors
    /// A folder without `run.json`, or without a table that was recorded.
    pub fn open(path: &Path) -> Result<Self, PageError> {
        let results = ResultsFolder::open(path)?;
        // Refuses tables of a later version.
        results.record()?;
        results.check_whole()?;
        let root = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        Ok(Self {
            results,
            root,
            layout: KeptLayout::default(),
        })
    }

    /// The results themselves.
    pub fn results(&self) -> &ResultsFolder {
        &self.results
    }

    /// A piece of page data; of a table only the named columns, where there are names.
    ///
    /// # Errors
    /// A piece, column or row that is not there, files that lead out of the folder or cannot be read.
    pub fn piece(&self, piece: Piece, columns: Option<&[&str]>) -> Result<Content, PageError> {
        match piece {
            Piece::Run => {
                let run = serde_json::to_string(&self.run()?);
                Ok(Content::Json(run.expect("words and numbers are JSON")))
            }
            Piece::Growing(table) => self.growing(table, columns),
            Piece::Step(table, step) => self.step_table(table, step, columns),
            Piece::Row(table, step, row) => self.row(table, step, row),
            Piece::Crosses(step) => {
                let (columns, rows) = self.crosses(step)?;
                Ok(Content::Arrow(stream(columns, rows)?))
            }
            Piece::Dual => {
                let (columns, rows) = graphs::dual(&*self.layout()?);
                Ok(Content::Arrow(stream(columns, rows)?))
            }
            Piece::Cells(step) => {
                for table in StepTable::EVERY_STEP {
                    self.step_path(table, step)?;
                }
                let (columns, rows) = graphs::cells(&*self.layout()?, step)?;
                Ok(Content::Arrow(stream(columns, rows)?))
            }
        }
    }

    /// What ran, and what there is to be shown.
    ///
    /// # Errors
    /// Files that lead out of the folder or cannot be read.
    pub fn run(&self) -> Result<PageRun, PageError> {
        self.own(self.root.join("run.json"))?;
        let record = self.results.record()?;
        let scene = self.scene()?;
        let recorded = self.recorded()?;
        let load_steps = self.rows(RunTable::Steps);
        let container = record.packing.map(|packing| packing.container);
        let ended = usize::from(record.state != RunState::Running);
        Ok(PageRun {
            format: FORMAT,
            title: record.title,
            version: record.version,
            schema_version: record.schema_version,
            seed: record.seed,
            state: record.state,
            failure: record.failure,
            warnings: record.warnings,
            grains: record.grains,
            contacts: record.contacts,
            change: load_steps + recorded.len() + self.rows(RunTable::Events) + ended,
            load_steps,
            tables: self.tables(&recorded, &scene),
            has: self.has(&recorded, container.is_some()),
            container: container.unwrap_or_default(),
            recorded,
            scene,
            embedded: false,
        })
    }

    /// The load steps of which all tables that every one has are there.
    pub(crate) fn recorded(&self) -> Result<Vec<usize>, PageError> {
        let every = StepTable::EVERY_STEP;
        let whole = |step: &usize| every.iter().all(|&table| self.is_there(table, *step));
        Ok(self
            .results
            .recorded_steps()?
            .into_iter()
            .filter(whole)
            .collect())
    }

    /// What there is besides the tables of every load step; without a container no diagram is drawn.
    fn has(&self, recorded: &[usize], container: bool) -> Has {
        let with = |table| -> Vec<usize> {
            let steps = recorded.iter().copied();
            steps.filter(|step| self.is_there(table, *step)).collect()
        };
        Has {
            dual: container && recorded.first() == Some(&0),
            cells: if container && recorded.first() == Some(&0) {
                recorded.to_vec()
            } else {
                Vec::new()
            },
            crosses: !recorded.is_empty(),
            voids: with(StepTable::Voids),
            cracks: with(StepTable::Cracks),
            modes: with(StepTable::Modes),
        }
    }

    /// The columns of each table.
    fn tables(&self, recorded: &[usize], scene: &str) -> BTreeMap<&'static str, Vec<ColumnRecord>> {
        let mut tables = BTreeMap::new();
        for table in StepTable::ALL {
            let mut paths = recorded.iter().map(|&step| self.step_path(table, step));
            let head = paths.find_map(|path| TableHead::read(&path.ok()?).ok());
            if let Some(head) = head {
                let mut columns = column_records(table.name(), &head, true, scene);
                columns.extend(Made::of(table).iter().map(|&made| made_record(made)));
                tables.insert(table.name(), columns);
            }
        }
        for table in RunTable::ALL {
            let head = self.own(self.root.join(table.file())).ok();
            if let Some(head) = head.and_then(|path| TableHead::read(&path).ok()) {
                let columns = column_records(table.name(), &head, false, scene);
                tables.insert(table.name(), columns);
            }
        }
        tables
    }

    pub(crate) fn rows(&self, table: RunTable) -> usize {
        let head = TableHead::read(&self.root.join(table.file()));
        head.map_or(0, |head| head.rows)
    }

    /// How many rows a table has at a load step.
    pub(crate) fn rows_of(&self, table: StepTable, step: usize) -> Result<usize, PageError> {
        Ok(TableHead::read(&self.step_path(table, step)?)?.rows)
    }

    fn scene(&self) -> Result<String, PageError> {
        self.own(self.root.join("scene.toml"))?;
        Ok(self.results.scene()?)
    }

    fn growing(&self, table: RunTable, columns: Option<&[&str]>) -> Result<Content, PageError> {
        let path = self.own(self.root.join(table.file()))?;
        let read = Columns::read_some(&path, columns)?;
        let wanted = match columns {
            Some(columns) => columns.iter().map(|&name| name.to_owned()).collect(),
            None => names(read.schema(), false),
        };
        let column = |name: &String| {
            let known = self.known_words(table.name(), name)?;
            column(&read, name, Precision::Double, &known)
                .ok_or_else(|| no_column(table.name(), name))
        };
        let columns: Result<Vec<PageColumn>, PageError> = wanted.iter().map(column).collect();
        Ok(Content::Arrow(stream(columns?, read.len())?))
    }

    fn step_table(
        &self,
        table: StepTable,
        step: usize,
        wanted: Option<&[&str]>,
    ) -> Result<Content, PageError> {
        let (columns, rows) = self.columns(table, step, wanted, usize::MAX)?;
        Ok(Content::Arrow(stream(columns, rows)?))
    }

    /// The first rows of columns of a table at a load step, and how many there are.
    pub(crate) fn columns(
        &self,
        table: StepTable,
        step: usize,
        wanted: Option<&[&str]>,
        most: usize,
    ) -> Result<(Vec<PageColumn>, usize), PageError> {
        let path = self.step_path(table, step)?;
        let wanted: Vec<String> = match wanted {
            Some(wanted) => wanted.iter().map(|&name| name.to_owned()).collect(),
            None => all_names(table, &TableHead::read(&path)?),
        };
        let names = sources(table, &wanted);
        let read = self
            .results
            .table(table.name(), step, Some(&names), 0..most)?;
        let breaks = if wanted.iter().any(|name| name == Made::BrokeAt.name()) {
            self.breaks(step)?
        } else {
            Vec::new()
        };
        let column = |name: &String| {
            if let Some(made) = Made::named(table, name) {
                return made.column(&read, &breaks);
            }
            let known = self.known_words(table.name(), name)?;
            column(&read, name, Precision::Single, &known)
                .ok_or_else(|| no_column(table.name(), name))
        };
        let columns: Result<Vec<PageColumn>, PageError> = wanted.iter().map(column).collect();
        Ok((columns?, read.len()))
    }

    fn row(&self, table: StepTable, step: usize, number: usize) -> Result<Content, PageError> {
        self.step_path(table, step)?;
        let rows = number..number.saturating_add(1);
        let read = self.results.table(table.name(), step, None, rows)?;
        if read.is_empty() {
            return Err(PageError::NoRow {
                table: table.name().to_owned(),
                step,
                row: number,
            });
        }
        let made = Made::of(table);
        let broke_at = if made.contains(&Made::BrokeAt) {
            let breaks = self.breaks(step)?.into_iter();
            let mut of_contact = breaks.filter(|(contact, _)| *contact == number as i64);
            of_contact.next().map(|(_, event)| event)
        } else {
            None
        };
        let row = serde_json::to_string(&row(&read, made, broke_at)?);
        Ok(Content::Json(row.expect("words and numbers are JSON")))
    }

    /// The principal directions at a load step.
    pub(crate) fn crosses(&self, step: usize) -> Result<(Vec<PageColumn>, usize), PageError> {
        let read = |table: StepTable, names: &[&str]| -> Result<Columns, PageError> {
            self.step_path(table, step)?;
            let whole = 0..usize::MAX;
            Ok(self.results.table(table.name(), step, Some(names), whole)?)
        };
        let grains = read(StepTable::Grains, &crosses::OF_GRAINS)?;
        let contacts = read(StepTable::Contacts, &crosses::OF_CONTACTS)?;
        let path = self.own(self.root.join(RunTable::Steps.file()))?;
        let steps = Columns::read_some(&path, Some(&crosses::OF_STEPS))?;
        crosses::crosses(step, &grains, &contacts, &steps)
    }

    /// The undeformed assembly.
    pub(crate) fn layout(&self) -> Result<Arc<Layout>, PageError> {
        self.own(self.root.join("run.json"))?;
        for table in StepTable::EVERY_STEP {
            self.step_path(table, 0)?;
        }
        let grains = self.step_path(StepTable::Grains, 0)?;
        self.layout.of(&self.results, &grains)
    }

    fn breaks(&self, step: usize) -> Result<Vec<(i64, i64)>, PageError> {
        let path = self.own(self.root.join(RunTable::Events.file()))?;
        let names = ["event", "step", "contact", "kind"];
        breaks(&Columns::read_some(&path, Some(&names))?, step)
    }

    fn known_words(&self, table: &str, column: &str) -> Result<Vec<String>, PageError> {
        if column == "property" {
            return Ok(words::properties(&self.scene()?));
        }
        let known = words::known(table, column).iter();
        Ok(known.map(|&word| word.to_owned()).collect())
    }

    pub(crate) fn is_there(&self, table: StepTable, step: usize) -> bool {
        self.results.table_path(table.name(), step).is_file()
    }

    /// The file of a table, where it is there and in the folder.
    pub(crate) fn step_path(&self, table: StepTable, step: usize) -> Result<PathBuf, PageError> {
        if !self.is_there(table, step) {
            return Err(PageError::NotRecorded {
                table: table.name().to_owned(),
                step,
            });
        }
        self.own(self.results.table_path(table.name(), step))
    }

    /// A file of the folder itself, where no link leads out of it.
    pub(crate) fn own(&self, path: PathBuf) -> Result<PathBuf, PageError> {
        match fs::canonicalize(&path) {
            Ok(whole) if !whole.starts_with(&self.root) => Err(PageError::Outside { path }),
            _ => Ok(path),
        }
    }
}

/// The columns of a table and those made of them.
fn all_names(table: StepTable, head: &TableHead) -> Vec<String> {
    let stored = names(&head.schema, true).into_iter();
    let made = Made::of(table).iter().map(|made| made.name().to_owned());
    stored.chain(made).collect()
}

/// The columns of the file that the wanted ones are or are made of.
fn sources(table: StepTable, wanted: &[String]) -> Vec<&str> {
    let of = |name| match Made::named(table, name) {
        Some(made) => made.sources().to_vec(),
        None => vec![name],
    };
    wanted.iter().flat_map(|name| of(name.as_str())).collect()
}

fn no_column(table: &str, column: &str) -> PageError {
    PageError::NoColumn {
        table: table.to_owned(),
        column: column.to_owned(),
    }
}

fn made_record(made: Made) -> ColumnRecord {
    ColumnRecord {
        name: made.name().to_owned(),
        unit: made.unit().to_owned(),
        kind: if made == Made::BrokeAt {
            "integer"
        } else {
            "number"
        },
        values: None,
    }
}

fn column_records(
    table: &str,
    head: &TableHead,
    without_step: bool,
    scene: &str,
) -> Vec<ColumnRecord> {
    let fields = head.schema.fields().iter();
    let fields = fields.filter(|field| !(without_step && field.name() == "step"));
    let record = |field: &arrow_schema::FieldRef| {
        let kind = match field.data_type() {
            DataType::Int64 => "integer",
            DataType::Float64 => "number",
            _ => "word",
        };
        let known = words::known(table, field.name()).iter();
        let known: Vec<String> = if field.name() == "property" {
            words::properties(scene)
        } else {
            known.map(|&word| word.to_owned()).collect()
        };
        ColumnRecord {
            name: field.name().clone(),
            unit: unit(field).to_owned(),
            kind,
            values: (!known.is_empty()).then_some(known),
        }
    };
    fields.map(record).collect()
}
