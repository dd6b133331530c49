//! The assembly at a load step, with displacements as large as they are drawn.

use std::collections::HashSet;

use kavics::assembly::{Contact, Grain, Partner, extents};
use kavics::equilibrium::{ContactState, State};
use kavics::geometry::Vector;
use kavics::ids::{ContactId, GrainId, Id, SideId};
use kavics_results::ResultsFolder;

use crate::breaks::{Break, breaks};
use crate::{Layout, PictureError};

/// What a contact is to a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Standing {
    /// It can carry a force.
    Active,
    /// It is open, and no bond of it has broken.
    Open,
    /// It carries nothing since its bond broke.
    Broken,
}

/// The assembly at a load step.
pub(crate) struct Scenery<'a> {
    pub folder: &'a ResultsFolder,
    pub layout: &'a Layout,
    pub step: usize,
    pub state: State,
    /// Where the centres of grains are drawn.
    pub centres: Vec<Vector>,
    /// The bonds broken so far, in order.
    pub breaks: Vec<Break>,
    has_broken: HashSet<usize>,
    times: f64,
}

/// How far a grain is drawn from where it was before loading, at most, in extents of the assembly.
const FARTHEST: f64 = 100.0;

impl<'a> Scenery<'a> {
    /// The assembly at a recorded load step, displacements so many times as large as they are.
    pub fn at(layout: &'a Layout, step: usize, times: f64) -> Result<Self, PictureError> {
        let folder = &layout.folder;
        let state = layout.state(step)?;
        let breaks = breaks(folder, step)?;
        let mut scenery = Self {
            folder,
            layout,
            step,
            state,
            centres: Vec::new(),
            has_broken: breaks.iter().map(|bond| bond.contact).collect(),
            breaks,
            times,
        };
        let grains = layout.assembly.grains.ids();
        scenery.centres = grains.map(|grain| scenery.centre(grain)).collect();
        scenery.check_distances()?;
        Ok(scenery)
    }

    /// Checks that displacements which are drawn larger than they are leave a picture of the assembly.
    fn check_distances(&self) -> Result<(), PictureError> {
        let grains = self.grains();
        let [low, high] = extents(grains.iter().map(|grain| grain.centre));
        let radii = grains.iter().map(|grain| grain.radius);
        let size = (high - low).length().max(radii.fold(0.0, f64::max));
        let ways = grains.iter().zip(&self.centres);
        let ways = ways.map(|(grain, &centre)| (centre - grain.centre).length());
        let longest = ways.fold(0.0, f64::max);
        if self.times.abs() <= 1.0 || longest <= FARTHEST * size {
            return Ok(());
        }
        Err(PictureError::TooFar {
            times: self.times,
            extents: longest / size,
        })
    }

    pub fn grains(&self) -> &[Grain] {
        self.layout.assembly.grains.values()
    }

    pub fn contacts(&self) -> impl ExactSizeIterator<Item = (ContactId, &Contact)> {
        self.layout.assembly.contacts.iter()
    }

    fn centre(&self, grain: GrainId) -> Vector {
        let centre = self.layout.assembly.grains[grain].centre;
        centre + self.way(Partner::Grain(grain), centre)
    }

    /// How far a partner has gone as it is drawn; of a side, a point of it.
    fn way(&self, partner: Partner, at: Vector) -> Vector {
        self.layout.way(&self.state, partner, at) * self.times
    }

    /// What a contact is.
    pub fn standing(&self, contact: ContactId) -> Standing {
        let state = self.state.contacts.values().get(contact.index());
        match state {
            Some(state) if state.is_active() => Standing::Active,
            Some(ContactState { broken: false, .. }) if !self.has_broken(contact) => Standing::Open,
            _ => Standing::Broken,
        }
    }

    /// Whether a bond of a contact has broken.
    pub fn has_broken(&self, contact: ContactId) -> bool {
        self.has_broken.contains(&contact.index())
    }

    /// From centre to centre, or from the centre to the side.
    pub fn branch(&self, contact: &Contact) -> [Vector; 2] {
        let end = |partner| self.layout.end(&self.state, contact, partner, self.times);
        [end(contact.first), end(contact.second)]
    }

    /// The dual edge, moved with the mean of its partners, or with the side.
    pub fn dual(&self, contact: &Contact, ends: [Vector; 2]) -> [Vector; 2] {
        let way = |partner| self.way(partner, contact.point);
        let mean = match contact.second {
            Partner::Grain(_) => (way(contact.first) + way(contact.second)) * 0.5,
            Partner::Side(_) => way(contact.second),
        };
        ends.map(|end| end + mean)
    }

    /// A side of the container, and whether grains can touch it.
    pub fn sides(&self) -> impl Iterator<Item = ([Vector; 2], bool)> {
        let sides = self.layout.assembly.sides.iter();
        sides.map(|(id, side): (SideId, _)| {
            let ends = [side.start, side.end];
            let moved = ends.map(|end| end + self.way(Partner::Side(id), end));
            (moved, side.present)
        })
    }

    /// Mean branch length of the contacts; without any, the mean diameter, `[length]`.
    pub fn typical_length(&self) -> f64 {
        let contacts = self.layout.assembly.contacts.values();
        if contacts.is_empty() {
            return 2.0 * self.layout.assembly.mean_radius();
        }
        contacts.iter().map(|c| c.branch_length).sum::<f64>() / contacts.len() as f64
    }
}
