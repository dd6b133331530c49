//! The table `contacts`: a row a contact at a recorded load step.

use kavics::assembly::{Contact, Partner};
use kavics::contact_law::{Law, Phase, Property};
use kavics::equilibrium::ContactState;
use kavics::ids::PerProperty;

use crate::column::{Column, Unit};

/// A row of `contacts`.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactRow<'a> {
    /// Load step.
    pub step: usize,
    /// Id.
    pub id: usize,
    /// The contact before loading.
    pub contact: Contact,
    /// The contact now.
    pub state: ContactState,
    /// Name of its property now; empty: broken into nothing.
    pub property: &'a str,
    /// Name of its law now; empty: broken into nothing.
    pub law: &'static str,
    /// `intact`, `closed`, `sliding`, `open` or `broken`.
    pub status: &'static str,
}

impl<'a> ContactRow<'a> {
    pub(crate) fn new(
        step: usize,
        id: usize,
        contact: &Contact,
        state: &ContactState,
        properties: &'a PerProperty<Property>,
    ) -> Self {
        let property = state.property.map(|id| &properties[id]);
        Self {
            step,
            id,
            contact: *contact,
            state: *state,
            property: property.map_or("", |p| p.name.as_str()),
            law: property.map_or("", |p| p.law.name()),
            status: status(state, property),
        }
    }
}

fn status(state: &ContactState, property: Option<&Property>) -> &'static str {
    let Some(property) = property else {
        return "broken";
    };
    let bonded = matches!(property.law, Law::Cemented(_)) && !state.broken;
    match state.phase {
        Phase::Open => "open",
        Phase::SlidingForward | Phase::SlidingBackward => "sliding",
        Phase::Closed if bonded => "intact",
        Phase::Closed => "closed",
    }
}

/// A partner as it stands in the tables: a grain's id, or −1−k for side k.
fn partner_number(partner: Partner) -> i64 {
    match partner {
        Partner::Grain(grain) => i64::from(grain.0),
        Partner::Side(side) => -1 - i64::from(side.0),
    }
}

/// The columns of `contacts`, in their order; `x` and `y` are the contact point before loading.
pub(crate) fn contact_columns<'a>() -> Vec<Column<ContactRow<'a>>> {
    use Unit::{Dimensionless, Force, ForceLength, Length};
    vec![
        Column::integer("step", |r: &ContactRow| r.step as i64),
        Column::integer("contact", |r: &ContactRow| r.id as i64),
        Column::integer("first", |r: &ContactRow| partner_number(r.contact.first)),
        Column::integer("second", |r: &ContactRow| partner_number(r.contact.second)),
        Column::number("nx", Dimensionless, |r: &ContactRow| r.contact.normal.x),
        Column::number("ny", Dimensionless, |r: &ContactRow| r.contact.normal.y),
        Column::number("branch_length", Length, |r: &ContactRow| {
            r.contact.branch_length
        }),
        Column::number("dual_length", Length, |r: &ContactRow| {
            r.contact.dual_length()
        }),
        Column::number("dual_length_full", Length, |r: &ContactRow| {
            r.contact.dual_length_full
        }),
        Column::number("opening", Length, |r: &ContactRow| {
            r.state.displacement.normal
        }),
        Column::number("shear", Length, |r: &ContactRow| r.state.displacement.shear),
        Column::number("relative_rotation", Dimensionless, |r: &ContactRow| {
            r.state.displacement.rotation
        }),
        Column::number("normal_force", Force, |r: &ContactRow| r.state.force.normal),
        Column::number("shear_force", Force, |r: &ContactRow| r.state.force.shear),
        Column::number("bending_moment", ForceLength, |r: &ContactRow| {
            r.state.force.moment
        }),
        Column::text("property", |r: &ContactRow| Some(r.property)),
        Column::text("law", |r: &ContactRow| Some(r.law)),
        Column::text("state", |r: &ContactRow| Some(r.status)),
        Column::number("x", Length, |r: &ContactRow| r.contact.point.x),
        Column::number("y", Length, |r: &ContactRow| r.contact.point.y),
    ]
}
