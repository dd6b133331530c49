//! The table `events`: a row an event, in order over the whole run.

use kavics::contact_law::Mode;
use kavics::equilibrium::{Event, EventKind};

use crate::column::{Column, Unit};

/// A row of `events`.
#[derive(Clone, Debug, PartialEq)]
pub struct EventRow {
    /// Number over the whole run, from 0.
    pub number: usize,
    /// Load step.
    pub step: usize,
    /// What happened.
    pub event: Event,
}

impl EventRow {
    fn kind(&self) -> &'static str {
        match self.event.kind {
            EventKind::Broke { .. } => "broke",
            EventKind::Opened(_) => "opened",
            EventKind::Closed(_) => "closed",
            EventKind::Slid(_) => "slid",
            EventKind::Stuck(_) => "stuck",
            EventKind::SetAside(_) => "set_aside",
            EventKind::TakenBack(_) => "taken_back",
        }
    }

    fn contact(&self) -> Option<i64> {
        match self.event.kind {
            EventKind::Broke { contact, .. }
            | EventKind::Opened(contact)
            | EventKind::Closed(contact)
            | EventKind::Slid(contact)
            | EventKind::Stuck(contact) => Some(i64::from(contact.0)),
            EventKind::SetAside(_) | EventKind::TakenBack(_) => None,
        }
    }

    fn grain(&self) -> Option<i64> {
        match self.event.kind {
            EventKind::SetAside(grain) | EventKind::TakenBack(grain) => Some(i64::from(grain.0)),
            _ => None,
        }
    }

    fn mode(&self) -> Option<&'static str> {
        let EventKind::Broke { mode, .. } = self.event.kind else {
            return None;
        };
        Some(match mode {
            Mode::Tension => "tension",
            Mode::Compression => "compression",
            Mode::Shear => "shear",
            Mode::Bending => "bending",
        })
    }

    fn energies(&self) -> Option<[f64; 2]> {
        match self.event.kind {
            EventKind::Broke {
                fracture_energy,
                release_energy,
                ..
            } => Some([fracture_energy, release_energy]),
            _ => None,
        }
    }
}

/// The columns of `events`, in their order.
pub(crate) fn event_columns() -> Vec<Column<EventRow>> {
    let work = Unit::ForceLength;
    vec![
        Column::integer("event", |r: &EventRow| r.number as i64),
        Column::integer("step", |r: &EventRow| r.step as i64),
        Column::integer("iteration", |r: &EventRow| r.event.iteration as i64),
        Column::number("load_factor", Unit::Dimensionless, |r: &EventRow| {
            r.event.load_factor
        }),
        Column::maybe_integer("contact", EventRow::contact),
        Column::maybe_integer("grain", EventRow::grain),
        Column::text("kind", |r: &EventRow| Some(r.kind())),
        Column::text("mode", |r: &EventRow| r.mode()),
        Column::maybe_number("fracture_energy", work, |r: &EventRow| {
            r.energies().map(|e| e[0])
        }),
        Column::maybe_number("release_energy", work, |r: &EventRow| {
            r.energies().map(|e| e[1])
        }),
        Column::maybe_integer("avalanche", |r: &EventRow| {
            r.event.avalanche.map(|number| number as i64)
        }),
        Column::maybe_number("displacement", Unit::Length, |r: &EventRow| {
            r.event.drive.map(|drive| drive.displacement)
        }),
        Column::maybe_number("force", Unit::Force, |r: &EventRow| {
            r.event.drive.map(|drive| drive.force)
        }),
    ]
}
