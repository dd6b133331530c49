//! The load steps that are exported, read one after the other.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use kavics::assembly::{Partner, extents};
use kavics::equilibrium::State;
use kavics::geometry::Vector;
use kavics::ids::{GrainId, Id};
use kavics_pictures::{Layout, PictureError, recorded_step};
use kavics_results::{Columns, ResultsError, ResultsFolder};

use crate::Options;

/// The load steps that are exported.
pub(crate) struct Frames<'a> {
    pub results: &'a ResultsFolder,
    pub layout: Layout,
    pub steps: Vec<usize>,
    load_factors: BTreeMap<usize, f64>,
    deformation: f64,
}

/// A load step.
pub(crate) struct Frame<'a> {
    pub step: usize,
    /// Load factor; 0 before loading.
    pub load_factor: f64,
    /// Tables of grains and contacts.
    pub grains: Columns,
    pub contacts: Columns,
    pub state: State,
    layout: &'a Layout,
    deformation: f64,
}

impl<'a> Frames<'a> {
    pub fn of(results: &'a ResultsFolder, options: &Options) -> Result<Self, PictureError> {
        let steps = if options.steps.is_empty() {
            results.recorded_steps()?
        } else {
            let found = options.steps.iter();
            let found = found.map(|&step| recorded_step(results, Some(step)));
            let mut steps = found.collect::<Result<Vec<_>, _>>()?;
            steps.sort_unstable();
            steps.dedup();
            steps
        };
        let table = results.steps()?;
        let numbers = table.integers("step")?.into_iter();
        let numbers = numbers.map(|step| usize::try_from(step.unwrap_or(0)).unwrap_or(0));
        Ok(Self {
            results,
            layout: Layout::read(results)?,
            steps,
            load_factors: numbers.zip(table.numbers("load_factor")?).collect(),
            deformation: options.deformation,
        })
    }

    /// A load step.
    pub fn read(&self, step: usize) -> Result<Frame<'_>, ResultsError> {
        Ok(Frame {
            step,
            load_factor: self.load_factors.get(&step).copied().unwrap_or(0.0),
            grains: self.results.grains(step)?,
            contacts: self.results.contacts(step)?,
            state: self.layout.state(step)?,
            layout: &self.layout,
            deformation: self.deformation,
        })
    }

    /// Lowest and highest corner of the container and of all grains before loading, `[length]`.
    pub fn bounds(&self) -> [Vector; 2] {
        let assembly = &self.layout.assembly;
        let corners = assembly.sides.values().iter().map(|side| side.start);
        let ends = assembly.sides.values().iter().map(|side| side.end);
        let grains = assembly.grains.values().iter().flat_map(|grain| {
            let corner = Vector::new(grain.radius, grain.radius);
            [grain.centre - corner, grain.centre + corner]
        });
        extents(corners.chain(ends).chain(grains))
    }
}

impl Frame<'_> {
    /// Where the centres of the grains are, displaced, `[length]`.
    pub fn centres(&self) -> Vec<Vector> {
        let grains = self.layout.assembly.grains.iter();
        let centre = |(id, grain): (GrainId, &kavics::assembly::Grain)| {
            let way = self
                .layout
                .way(&self.state, Partner::Grain(id), grain.centre);
            grain.centre + way * self.deformation
        };
        grains.map(centre).collect()
    }

    /// The points between which lines of contacts run: grain by grain, then where grains touch sides; and the points
    /// of each contact.
    pub fn lines(&self) -> (Vec<Vector>, Vec<[usize; 2]>) {
        let mut points = self.centres();
        let mut lines = Vec::with_capacity(self.layout.assembly.contacts.len());
        for contact in self.layout.assembly.contacts.values() {
            let line = [contact.first, contact.second].map(|partner| match partner {
                Partner::Grain(grain) => grain.index(),
                Partner::Side(_) => {
                    let end = self
                        .layout
                        .end(&self.state, contact, partner, self.deformation);
                    points.push(end);
                    points.len() - 1
                }
            });
            lines.push(line);
        }
        (points, lines)
    }

    /// The grains of each contact that is active and between grains, with the row of the contact.
    pub fn bonds(&self) -> Vec<(usize, [usize; 2])> {
        let contacts = self.layout.assembly.contacts.iter();
        let bond = |(id, contact): (kavics::ids::ContactId, &kavics::assembly::Contact)| match (
            contact.first,
            contact.second,
        ) {
            (Partner::Grain(a), Partner::Grain(b)) if self.state.contacts[id].is_active() => {
                Some((id.index(), [a.index(), b.index()]))
            }
            _ => None,
        };
        contacts.filter_map(bond).collect()
    }
}

/// Makes a folder where there is none.
pub(crate) fn make_folder(folder: &Path) -> Result<(), ResultsError> {
    let made = fs::create_dir_all(folder);
    made.map_err(ResultsError::unwritable(folder))
}
