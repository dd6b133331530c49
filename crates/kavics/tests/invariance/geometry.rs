//! Power cells, triangles and who meets whom.

use std::collections::BTreeSet;

use kavics::assembly::{Between, ContactGraph, Partner, Shaping};
use kavics::ids::GrainId;
use proptest::prelude::*;

use crate::change::{Change, changes};
use crate::pile::{Material, Pile};
use crate::twins::{close, close_vectors, geometric_tolerance, matched};

/// Triangles by their grains, which a change keeps counter-clockwise.
fn triangles(graph: &ContactGraph, name: impl Fn(GrainId) -> GrainId) -> BTreeSet<[GrainId; 3]> {
    let named = |triangle: &[GrainId; 3]| {
        let mut named = triangle.map(&name);
        let lowest = (0..3).min_by_key(|&k| named[k]).unwrap_or(0);
        named.rotate_left(lowest);
        named
    };
    graph.triangles.iter().map(named).collect()
}

fn cells_agree(pile: &Pile, change: &Change) -> Result<(), TestCaseError> {
    let none = Change::none();
    let assembly = pile.assembly(&none, Between::Neighbours, Shaping::default());
    let tolerance = geometric_tolerance(&assembly, change);
    let [here, there] = [&none, change].map(|change| pile.graph(change, Between::Neighbours));
    let square = change.scale * change.scale;
    let radius = assembly.mean_radius();
    for (grain, area) in here.cell_area.iter() {
        let found = there.cell_area[change.grain(grain)];
        close(
            "cell area",
            found,
            square * area,
            tolerance * square * radius * radius,
        )?;
    }
    let renamed = triangles(&here, |grain| change.grain(grain));
    prop_assert_eq!(renamed, triangles(&there, |grain| grain));
    Ok(())
}

/// Contacts of the same partners, their normals and points turned, their lengths scaled.
fn contacts_agree(pile: &Pile, material: &Material, change: &Change) -> Result<(), TestCaseError> {
    let assembly = |change: &Change| pile.assembly(change, material.between, material.shaping);
    let (here, there) = (assembly(&Change::none()), assembly(change));
    let tolerance = geometric_tolerance(&here, change);
    let length = tolerance * change.scale * here.mean_radius();
    let twins = matched(&here, &there, change)?;
    for (id, twin) in twins.iter() {
        let (one, other) = (&here.contacts[id], &there.contacts[twin.there]);
        let sign = if twin.is_reversed { -1.0 } else { 1.0 };
        close_vectors(
            "normal",
            other.normal,
            change.turned(one.normal) * sign,
            tolerance,
        )?;
        close_vectors(
            "contact point",
            other.point,
            change.point(one.point),
            length,
        )?;
        let mut parts = one.dual_parts;
        if twin.is_reversed {
            parts.reverse();
        }
        for (what, found, expected) in [
            ("branch length", other.branch_length, one.branch_length),
            ("dual length", other.dual_length_full, one.dual_length_full),
            ("dual part", other.dual_parts[0], parts[0]),
            ("dual part", other.dual_parts[1], parts[1]),
        ] {
            close(what, found, change.scale * expected, length)?;
        }
        prop_assert_eq!(one.strength_factor, other.strength_factor);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(60) })]

    #[test]
    fn power_cells_and_triangles_go_with_the_grains(seed in 0_u64..1000, change in changes(50.0)) {
        cells_agree(&Pile::dropped(seed), &change)?;
    }

    #[test]
    fn contacts_go_with_the_grains(
        seed in 0_u64..1000, material in crate::equilibrium::cements(), change in changes(50.0),
    ) {
        contacts_agree(&Pile::dropped(seed), &material, &change)?;
    }

    /// A coordinate of a thousand sizes is rounded to a thousand times more: the tolerance grows as the shift does, not as
    /// its square, because heights over the plane are taken about a point among the grains.
    #[test]
    fn a_far_shift_costs_no_more_than_the_rounding_of_coordinates(
        seed in 0_u64..1000, material in crate::equilibrium::cements(), change in changes(2e4),
    ) {
        let pile = Pile::dropped(seed);
        cells_agree(&pile, &change)?;
        contacts_agree(&pile, &material, &change)?;
    }
}

/// A scale of two is exact.
#[test]
fn a_scale_of_two_changes_no_digit_of_a_cell() {
    let pile = Pile::dropped(7);
    let doubled = Change {
        scale: 2.0,
        ..Change::none()
    };
    let [here, there] =
        [&Change::none(), &doubled].map(|change| pile.graph(change, Between::Neighbours));
    for (grain, area) in here.cell_area.iter() {
        assert_eq!(there.cell_area[grain], 4.0 * area);
    }
    assert_eq!(here.triangles, there.triangles);
    let bodies = |graph: &ContactGraph| -> Vec<[Partner; 2]> {
        graph.sites.iter().map(|s| [s.first, s.second]).collect()
    };
    assert_eq!(bodies(&here), bodies(&there));
}
