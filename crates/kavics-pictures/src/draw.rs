//! A picture of the assembly at a load step.

use kavics_results::ResultsFolder;

use crate::colouring::Colouring;
use crate::ground::draw_ground;
use crate::legend::{Entry, Units, finish};
use crate::picture::Picture;
use crate::scenery::Scenery;
use crate::view::View;
use crate::{Layout, PictureError};
use crate::{damage, dual, forces, graph, voids};

/// What a picture shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum What {
    /// Contacts as wide as their normal forces are large.
    #[default]
    Forces,
    /// The contact graph.
    Graph,
    /// The dual graph: edges of the power diagram.
    Dual,
    /// Void cells of the contact graph.
    Voids,
    /// Broken contacts in the order of their breaks.
    Damage,
}

/// A picture that is wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// What it shows.
    pub what: What,
    /// Recorded load step; the last one where none is given.
    pub step: Option<usize>,
    /// Width of the sheet, mm.
    pub width: f64,
    /// Displacements are drawn so many times as large as they are; 0: the assembly before loading.
    pub deformation: f64,
    /// Column that gives what is drawn its colours: of `contacts` for forces, contact graph and dual graph, of `voids`,
    /// of `events` for damage.
    pub colour: Option<String>,
    /// Column of `grains` that gives grains their colours.
    pub grains: Option<String>,
    /// Range of the colours, instead of that of the numbers.
    pub range: Option<[f64; 2]>,
    /// Force of the widest line, instead of the largest one of the load step, `[force]`.
    pub largest: Option<f64>,
    /// Whether broken contacts stand among the forces.
    pub broken: bool,
    /// Whether the legend tells more than lengths.
    pub legend: bool,
    /// Words for units.
    pub units: Units,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            what: What::default(),
            step: None,
            width: 140.0,
            deformation: 0.0,
            colour: None,
            grains: None,
            range: None,
            largest: None,
            broken: false,
            legend: true,
            units: Units::default(),
        }
    }
}

/// A sheet with a picture in the making.
pub(crate) struct Sheet<'a> {
    pub request: &'a Request,
    pub picture: Picture,
    pub view: View,
    pub entries: Vec<Entry>,
}

impl Sheet<'_> {
    /// Adds what the colours mean to the legend.
    pub fn explain(&mut self, colouring: &Colouring) {
        self.entries.extend(Entry::of(colouring));
    }

    /// A share of a length on the sheet, within bounds, mm.
    pub fn thickness(&self, length: f64, share: f64, [least, most]: [f64; 2]) -> f64 {
        (self.view.length(length) * share).clamp(least, most)
    }
}

/// Draws the assembly of a run.
///
/// # Errors
/// Results that cannot be read; a load step that is not recorded; a column that is not there.
pub fn draw(folder: &ResultsFolder, request: &Request) -> Result<Picture, PictureError> {
    let step = recorded_step(folder, request.step)?;
    let layout = Layout::read(folder)?;
    draw_on(&layout, step, request)
}

/// Draws the assembly of a run whose layout is known, at a recorded load step.
///
/// # Errors
/// Those of [`draw`].
pub fn draw_on(layout: &Layout, step: usize, request: &Request) -> Result<Picture, PictureError> {
    let scenery = Scenery::at(layout, step, request.deformation)?;
    draw_scenery(&scenery, request)
}

fn draw_scenery(scenery: &Scenery<'_>, request: &Request) -> Result<Picture, PictureError> {
    let view = View::of(scenery.grains(), &scenery.centres, request.width);
    let mut sheet = Sheet {
        request,
        picture: Picture {
            width: request.width,
            title: title(scenery, request.what)?,
            ..Picture::default()
        },
        view,
        entries: vec![Entry::bar(&view, &request.units)],
    };
    draw_ground(&mut sheet, scenery)?;
    match request.what {
        What::Forces => forces::draw(&mut sheet, scenery)?,
        What::Graph => graph::draw(&mut sheet, scenery)?,
        What::Dual => dual::draw(&mut sheet, scenery)?,
        What::Voids => voids::draw(&mut sheet, scenery)?,
        What::Damage => damage::draw(&mut sheet, scenery)?,
    }
    let Sheet {
        mut picture,
        entries,
        view,
        ..
    } = sheet;
    let kept = if request.legend { entries.len() } else { 1 };
    finish(&mut picture, view.bottom, &entries[..kept]);
    Ok(picture)
}

/// The load step wanted, or the last one.
///
/// # Errors
/// A load step that is not recorded; a folder that cannot be listed.
pub fn recorded_step(folder: &ResultsFolder, wanted: Option<usize>) -> Result<usize, PictureError> {
    let recorded = folder.recorded_steps()?;
    let found = match wanted {
        Some(step) => recorded.iter().copied().find(|&known| known == step),
        None => recorded.last().copied(),
    };
    found.ok_or_else(|| PictureError::NotRecorded {
        step: wanted.unwrap_or(0),
        recorded: PictureError::listed(&recorded),
    })
}

fn title(scenery: &Scenery<'_>, what: What) -> Result<String, PictureError> {
    let shown = match what {
        What::Forces => "contact forces",
        What::Graph => "contact graph",
        What::Dual => "dual graph",
        What::Voids => "void cells",
        What::Damage => "broken contacts",
    };
    let title = scenery.folder.record()?.title;
    let apart = if title.is_empty() { "" } else { ": " };
    Ok(format!(
        "{title}{apart}{shown} at load step {}",
        scenery.step
    ))
}
