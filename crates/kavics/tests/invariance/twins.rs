//! An assembly and its changed twin, both on their load paths.

use std::collections::HashMap;

use kavics::assembly::{Assembly, Partner};
use kavics::contact_law::Strength;
use kavics::equilibrium::{Equilibrium, SolveError};
use kavics::geometry::Vector;
use kavics::ids::{ContactId, PerContact};
use kavics::measure::{Snapshot, Tensor};
use proptest::prelude::*;

use crate::change::Change;
use crate::pile::{Acting, Material, Pile};

/// By how much the rounding of a coordinate grows on its way through small differences: ends of dual edges are where lines
/// meet at angles down to a few degrees, and sums have up to a hundred terms.
const AMPLIFIED: f64 = 100.0;

/// One of the two.
#[derive(Debug)]
pub struct Twin {
    pub assembly: Assembly,
    pub path: Vec<Equilibrium>,
    pub end: Option<SolveError>,
}

impl Twin {
    /// The last equilibrium.
    pub fn last(&self) -> Snapshot<'_> {
        Snapshot::new(&self.assembly, self.path.last().expect("step 0"))
    }
}

/// Before and after a change.
#[derive(Debug)]
pub struct Twins {
    pub change: Change,
    pub here: Twin,
    pub there: Twin,
    pub matches: PerContact<Match>,
    /// Bound on relative differences of geometry.
    pub geometry: f64,
    /// Bound on those of what follows from a linear system: as many times larger as its condition number.
    pub tolerance: f64,
}

/// The contact that a contact has become.
#[derive(Clone, Copy, Debug)]
pub struct Match {
    pub there: ContactId,
    /// First and second have changed places.
    pub is_reversed: bool,
}

pub fn twins(
    pile: &Pile,
    material: &Material,
    acting: &Acting,
    change: Change,
) -> Result<Twins, TestCaseError> {
    let none = Change::none();
    let run = |change: &Change| {
        let assembly = pile.assembly(change, material.between, material.shaping);
        let (path, end) = acting.path(pile, &assembly, material, change);
        Twin {
            assembly,
            path,
            end,
        }
    };
    let (here, there) = (run(&none), run(&change));
    let matches = matched(&here.assembly, &there.assembly, &change)?;
    let stiffest = material.stiffest(&here.assembly, &none);
    let lowest = here.path.iter().filter_map(lowest_eigenvalue);
    let lowest = lowest.fold(f64::INFINITY, f64::min);
    let mut condition = (stiffest / lowest).max(1.0);
    if material.strength != Strength::UNBREAKABLE {
        condition = condition.max(hanging(&here.assembly));
    }
    let geometry = geometric_tolerance(&here.assembly, &change);
    Ok(Twins {
        change,
        here,
        there,
        matches,
        geometry,
        tolerance: condition * geometry,
    })
}

/// Condition number where all grains hang on one bond, as some do before it breaks too: with k_m = k_n·s²/12 and s = R, a turn
/// about it has the stiffness k_m over the sum of all squared distances.
pub fn hanging(assembly: &Assembly) -> f64 {
    let size = farthest(assembly) / assembly.mean_radius();
    12.0 * assembly.grains.len() as f64 * size * size
}

fn lowest_eigenvalue(equilibrium: &Equilibrium) -> Option<f64> {
    equilibrium.stability.as_ref()?.summary.lowest_eigenvalue
}

/// Relative rounding of what follows from differences of coordinates: ε times the farthest one over a radius.
pub fn geometric_tolerance(assembly: &Assembly, change: &Change) -> f64 {
    let shift = change.shift.length() / change.scale;
    AMPLIFIED * f64::EPSILON * (farthest(assembly) + shift) / assembly.mean_radius()
}

/// Farthest corner of the container from the origin.
fn farthest(assembly: &Assembly) -> f64 {
    let corners = assembly.sides.values().iter().map(|side| side.start);
    largest(corners.map(Vector::length))
}

/// Every contact has become one of the same partners, and no other has come.
pub fn matched(
    here: &Assembly,
    there: &Assembly,
    change: &Change,
) -> Result<PerContact<Match>, TestCaseError> {
    let ids: HashMap<[Partner; 2], ContactId> = (there.contacts.iter())
        .map(|(id, contact)| ([contact.first, contact.second], id))
        .collect();
    prop_assert_eq!(here.contacts.len(), there.contacts.len());
    let mut matches = Vec::new();
    for contact in here.contacts.values() {
        let [a, b] = [contact.first, contact.second].map(|partner| change.partner(partner));
        let (straight, reversed) = (ids.get(&[a, b]), ids.get(&[b, a]));
        let found = straight.or(reversed);
        prop_assert!(found.is_some(), "{:?} and {:?} meet no more", a, b);
        matches.extend(found.map(|&there| Match {
            there,
            is_reversed: straight.is_none(),
        }));
    }
    Ok(matches.into())
}

/// Two numbers that are the same to `bound`.
pub fn close(what: &str, found: f64, expected: f64, bound: f64) -> Result<(), TestCaseError> {
    let is_close = (found - expected).abs() <= bound;
    prop_assert!(is_close, "{what}: {found} is not {expected} to {bound:e}");
    Ok(())
}

pub fn close_vectors(
    what: &str,
    found: Vector,
    expected: Vector,
    bound: f64,
) -> Result<(), TestCaseError> {
    close(what, found.x, expected.x, bound)?;
    close(what, found.y, expected.y, bound)
}

pub fn close_tensors(
    what: &str,
    found: Tensor,
    expected: Tensor,
    bound: f64,
) -> Result<(), TestCaseError> {
    close(what, found.xx, expected.xx, bound)?;
    close(what, found.xy, expected.xy, bound)?;
    close(what, found.yx, expected.yx, bound)?;
    close(what, found.yy, expected.yy, bound)
}

/// The larger of the largest absolute values and zero.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().map(f64::abs).fold(0.0, f64::max)
}
