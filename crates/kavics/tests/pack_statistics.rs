//! Statistics of packs against closed forms and identities.

use std::f64::consts::PI;

use kavics::assembly::{
    Between, Grain, Partner, Touching, box_sides, contact_graph, container, touching,
};
use kavics::geometry::Vector;
use kavics::ids::{GrainId, PerGrain, PerSide};
use kavics::measure::{Coordination, Rose, fabric_of_normals};
use kavics::packing::Bed;
use kavics::packing::dropped::drop;
use kavics::packing::statistics::{quantile_diameters, sieve_curve, strips};
use kavics::packing::{Mass, Sizes, rows};
use proptest::prelude::*;

const TOLERANCE: f64 = 1e-7;

/// Grains of radii 0.5 to 1.5, and the box that they end.
fn dropped(
    count: usize,
    width: f64,
    seed: u64,
) -> (PerGrain<Grain>, PerSide<kavics::assembly::Side>) {
    let sizes = Sizes::Uniform { from: 0.5, to: 1.5 };
    let radii = sizes.radii(count, seed).unwrap();
    let grains = drop(&Bed::empty_box(width), &radii, 1, seed)
        .unwrap()
        .grains;
    let tops = grains.values().iter().map(|g| g.centre.y + g.radius);
    let sides = box_sides(width, tops.fold(0.0, f64::max), [true; 4]);
    (grains, sides)
}

fn coordination(grains: usize, pairs: &[Touching]) -> Coordination {
    let partners = pairs.iter().map(|t| [Partner::Grain(t.first), t.second]);
    Coordination::new(grains, partners)
}

fn normals(pairs: &[Touching]) -> impl Iterator<Item = Vector> + Clone {
    let between_grains = pairs
        .iter()
        .filter(|t| matches!(t.second, Partner::Grain(_)));
    between_grains.map(|t| t.normal)
}

#[test]
fn a_grain_within_a_hexagonal_lattice_touches_six_in_six_directions() {
    let lengths: Vec<usize> = (0..21).map(|row| 20 - row % 2).collect();
    let grains = rows::hexagonal(1.0, 40.0, &lengths).unwrap();
    let height = 2.0 + 20.0 * 3.0_f64.sqrt();
    let pairs = touching(&grains, &box_sides(40.0, height, [true; 4]), TOLERANCE);
    let histogram = coordination(grains.len(), &pairs);
    // Nine long rows between the lowest and the highest, and ten short ones, all without their ends.
    assert_eq!(histogram.grains[6], 9 * 18 + 10 * 17);
    // Ends of long rows, those of the lowest and highest row too: four with the side. None has fewer.
    assert_eq!(histogram.grains[..5], [0, 0, 0, 0, 2 * 11]);
    let rose = Rose::new(normals(&pairs), 18);
    let filled: Vec<usize> = (0..18).filter(|&k| rose.contacts[k] > 0).collect();
    assert_eq!(filled, [0, 6, 12]);
    assert_eq!(rose.contacts[6], rose.contacts[12]);
    assert_eq!(rose.contacts[0], 11 * 19 + 10 * 18);
}

#[test]
fn equal_numbers_in_the_three_directions_of_a_lattice_are_isotropic() {
    let direction = |k: u32| {
        let angle = f64::from(k) * PI / 3.0 + 0.1;
        Vector::new(angle.cos(), angle.sin())
    };
    let fabric = fabric_of_normals((0..3).map(direction)).unwrap();
    assert!(fabric.deviator() < 1e-15);
    let two = fabric_of_normals((0..2).map(direction)).unwrap();
    // cos of twice the angle between: |1 + e^{2i·π/3}|/2 = ½.
    assert!((two.deviator() - 0.5).abs() < 1e-15);
}

#[test]
fn touching_bodies_are_the_sites_of_the_contact_graph() {
    let (grains, sides) = dropped(2000, 60.0, 3);
    let pairs = touching(&grains, &sides, TOLERANCE);
    let reach = PerSide::filled(0.0, 4);
    let graph = contact_graph(&grains, &sides, Between::Touching, &reach, TOLERANCE);
    let mut found: Vec<(Partner, Partner)> = pairs
        .iter()
        .map(|t| (Partner::Grain(t.first), t.second))
        .collect();
    let mut sites: Vec<(Partner, Partner)> =
        graph.sites.iter().map(|s| (s.first, s.second)).collect();
    found.sort_unstable();
    sites.sort_unstable();
    assert_eq!(found, sites);
}

#[test]
fn a_dropped_pack_has_four_contacts_a_grain_and_stands_upright() {
    let (grains, sides) = dropped(20_000, 200.0, 5);
    let pairs = touching(&grains, &sides, TOLERANCE);
    let mean = coordination(grains.len(), &pairs).mean().unwrap();
    // Two supports a grain; a contact with a side has one grain only.
    let with_sides = pairs.len() - normals(&pairs).count();
    let expected = 4.0 - with_sides as f64 / grains.len() as f64;
    assert!((mean - expected).abs() < 0.01, "{mean} {expected}");
    let fabric = fabric_of_normals(normals(&pairs)).unwrap();
    // docs/packing.md: 0.524 for these radii.
    assert!((fabric.yy - 0.524).abs() < 0.005, "{}", fabric.yy);
    assert!((fabric.principal_direction().abs() - PI / 2.0).abs() < 0.1);
}

#[test]
fn a_quantile_of_the_mass_passes_at_least_its_share() {
    let (grains, _) = dropped(300, 30.0, 1);
    let shares = [0.1, 0.25, 0.5, 0.9, 1.0];
    let diameters = quantile_diameters(&grains, &shares, Mass::Sphere);
    let passing = sieve_curve(&grains, &diameters, Mass::Sphere);
    for (share, passing) in shares.into_iter().zip(passing) {
        assert!((share - 1e-12..share + 0.02).contains(&passing));
    }
}

proptest! {
    #[test]
    fn strips_hold_all_discs_and_the_histogram_all_grains(
        seed in any::<u64>(),
        count in 1_usize..200,
        parts in 1_usize..60,
    ) {
        let (grains, sides) = dropped(count, 16.0, seed);
        let found = strips(&grains, &container(&sides), parts);
        let solid: f64 = found.iter().map(|strip| strip.solid).sum();
        let discs: f64 = grains.values().iter().map(|g| PI * g.radius * g.radius).sum();
        prop_assert!((solid - discs).abs() < 1e-10 * discs);
        let top = grains.values().iter().map(|g| g.centre.y + g.radius).fold(0.0, f64::max);
        let area: f64 = found.iter().map(|strip| strip.area).sum();
        prop_assert!((area - 16.0 * top).abs() < 1e-9);
        prop_assert!(found.iter().all(|strip| strip.solid <= strip.area * (1.0 + 1e-12)));
        let pairs = touching(&grains, &sides, TOLERANCE);
        let histogram = coordination(count, &pairs);
        prop_assert_eq!(histogram.grains.iter().sum::<usize>(), count);
        prop_assert_eq!(histogram.rattlers(), 0);
        let contacts = Rose::new(normals(&pairs), 36).contacts;
        prop_assert_eq!(contacts.iter().sum::<usize>(), normals(&pairs).count());
        prop_assert!(pairs.iter().all(|t| Partner::Grain(t.first) != t.second));
        prop_assert!(pairs.iter().all(|t| t.first < GrainId(count as u32)));
    }
}
