//! Invariants of dropped packs.

use kavics::assembly::Grain;
use kavics::geometry::{Container, Vector};
use kavics::ids::{GrainId, Id, PerGrain};
use kavics::packing::dropped::{drop, fill};
use kavics::packing::statistics::{packing_fraction, sieve_curve};
use kavics::packing::{
    Bed, Dropped, Mass, PackingError, SieveCurve, Sizes, Source, Support, advancing_front, rows,
};
use proptest::prelude::*;

const SEED: u64 = 1;

fn uniform(from: f64, to: f64) -> Sizes {
    Sizes::Uniform { from, to }
}

fn graded(mass: Mass) -> SieveCurve {
    SieveCurve {
        diameter: vec![1.0, 2.0, 4.0],
        passing: vec![0.0, 0.6, 1.0],
        mass,
    }
}

fn pack(sizes: &Sizes, count: usize, width: f64, seed: u64) -> Dropped {
    let radii = sizes.radii(count, seed).unwrap();
    drop(&Bed::empty_box(width), &radii, 1, seed).unwrap()
}

/// An empty box of a width that ends at a height.
fn below(top: f64, width: f64) -> Bed<'static> {
    let top = Some(top);
    Bed {
        top,
        ..Bed::empty_box(width)
    }
}

fn join<T: Copy>(first: &PerGrain<T>, second: &PerGrain<T>) -> PerGrain<T> {
    first
        .values()
        .iter()
        .chain(second.values())
        .copied()
        .collect()
}

/// Highest point of a pack.
fn top(grains: &PerGrain<Grain>) -> f64 {
    let tops = grains.values().iter().map(|g| g.centre.y + g.radius);
    tops.fold(f64::NEG_INFINITY, f64::max)
}

fn gap(one: &Grain, other: &Grain) -> f64 {
    (other.centre - one.centre).length() - one.radius - other.radius
}

/// Every pair of grains whose gap is below `limit`, by a sweep over x.
fn near_pairs(grains: &PerGrain<Grain>, limit: f64) -> Vec<(GrainId, GrainId, f64)> {
    let mut order: Vec<GrainId> = grains.ids().collect();
    order.sort_by(|&a, &b| grains[a].centre.x.total_cmp(&grains[b].centre.x));
    let largest = grains.values().iter().fold(0.0_f64, |a, g| a.max(g.radius));
    let mut pairs = Vec::new();
    for (place, &a) in order.iter().enumerate() {
        for &b in &order[place + 1..] {
            if grains[b].centre.x - grains[a].centre.x > 2.0 * largest + limit {
                break;
            }
            let gap = gap(&grains[a], &grains[b]);
            if gap < limit {
                pairs.push((a.min(b), a.max(b), gap));
            }
        }
    }
    pairs
}

/// Largest rounding of a pack: a few units in the last place of its height.
fn rounding(grains: &PerGrain<Grain>) -> f64 {
    let height = grains
        .values()
        .iter()
        .fold(0.0_f64, |a, g| a.max(g.centre.y));
    16.0 * f64::EPSILON * height.max(1.0)
}

fn assert_in_the_box(dropped: &Dropped, width: f64) {
    for grain in dropped.grains.values() {
        let Grain { centre, radius } = *grain;
        let slack = 1e-12 * width;
        assert!(centre.y >= radius, "{grain:?} below the floor");
        assert!(centre.x >= radius - slack, "{grain:?} beyond the left side");
        assert!(
            centre.x <= width - radius + slack,
            "{grain:?} beyond the right side"
        );
    }
}

fn assert_no_overlap(dropped: &Dropped) {
    let mean = dropped
        .grains
        .values()
        .iter()
        .map(|g| g.radius)
        .sum::<f64>()
        / dropped.grains.len() as f64;
    for (a, b, gap) in near_pairs(&dropped.grains, 0.0) {
        assert!(gap > -1e-9 * mean, "grains {a} and {b} overlap by {}", -gap);
    }
}

fn assert_stable(dropped: &Dropped, width: f64) {
    let rounding = rounding(&dropped.grains);
    for (id, supports) in dropped.supports.iter() {
        let grain = dropped.grains[id];
        let Some(second) = supports.second else {
            assert_eq!(supports.first, Support::Floor);
            assert_eq!(grain.centre.y, grain.radius);
            continue;
        };
        let mut span = [f64::INFINITY, f64::NEG_INFINITY];
        for support in [supports.first, second] {
            let x = match support {
                Support::Grain(below) => {
                    assert!(below < id, "{id} rests on {below}, which came later");
                    assert!(gap(&grain, &dropped.grains[below]).abs() < rounding);
                    dropped.grains[below].centre.x
                }
                Support::Left => grain.centre.x - grain.radius,
                Support::Right => grain.centre.x + grain.radius,
                Support::Floor => grain.centre.x,
                Support::Side(side) => panic!("a box has no side {side}"),
            };
            if support == Support::Left {
                assert_eq!(grain.centre.x, grain.radius);
            }
            if support == Support::Right {
                assert_eq!(grain.centre.x, width - grain.radius);
            }
            span = [span[0].min(x), span[1].max(x)];
        }
        assert!(
            span[0] <= grain.centre.x && grain.centre.x <= span[1],
            "{id} rolls off"
        );
    }
}

/// Contacts are the supports: two a grain, one on the bare floor.
fn assert_isostatic(dropped: &Dropped) {
    let on_floor_only = dropped
        .supports
        .values()
        .iter()
        .filter(|s| s.second.is_none())
        .count();
    let all = dropped
        .supports
        .values()
        .iter()
        .flat_map(|s| [Some(s.first), s.second])
        .flatten();
    let (between, with_sides): (Vec<Support>, Vec<Support>) =
        all.partition(|s| matches!(s, Support::Grain(_)));
    assert_eq!(
        between.len() + with_sides.len(),
        2 * dropped.grains.len() - on_floor_only
    );
    assert_eq!(near_pairs(&dropped.grains, 1e-9).len(), between.len());
}

fn interior_fraction(dropped: &Dropped, width: f64, margin: f64) -> f64 {
    let top = dropped
        .grains
        .values()
        .iter()
        .fold(0.0_f64, |a, g| a.max(g.centre.y));
    packing_fraction(
        &dropped.grains,
        Vector::new(margin, margin),
        Vector::new(width - margin, top - 2.0 * margin),
    )
}

#[test]
fn a_dropped_pack_is_stable_and_without_overlap() {
    let cases = [
        (uniform(0.9, 1.1), 10_000, 150.0),
        (uniform(0.5, 1.5), 10_000, 150.0),
        (Sizes::Sieve(graded(Mass::Disc)), 3000, 60.0),
        (uniform(0.02, 2.0), 3000, 40.0),
    ];
    for (sizes, count, width) in cases {
        let dropped = pack(&sizes, count, width, SEED);
        assert_eq!(dropped.grains.len(), count);
        assert_in_the_box(&dropped, width);
        assert_no_overlap(&dropped);
        assert_stable(&dropped, width);
        assert_isostatic(&dropped);
    }
}

#[test]
fn equal_grains_in_narrow_boxes_come_to_rest() {
    for width in [2.0, 2.5, 3.0, 4.0, 6.0, 8.0, 20.0] {
        let dropped = pack(&uniform(1.0, 1.0), 300, width, SEED);
        assert_in_the_box(&dropped, width);
        assert_no_overlap(&dropped);
        assert_stable(&dropped, width);
    }
}

#[test]
fn the_packing_fraction_is_that_of_other_programs() {
    // Two other programs of the same model: 0.810 to 0.813. Equal discs on a sticky line: about 0.80 (Acharyya).
    for (from, to) in [(0.9, 1.1), (0.5, 1.5)] {
        let dropped = pack(&uniform(from, to), 10_000, 200.0, SEED);
        let fraction = interior_fraction(&dropped, 200.0, 8.0);
        assert!(
            (0.805..0.818).contains(&fraction),
            "{from} to {to}: {fraction}"
        );
    }
}

#[test]
fn the_placed_grains_keep_the_sieve_curve() {
    for mass in [Mass::Disc, Mass::Sphere] {
        let curve = graded(mass);
        let dropped = pack(&Sizes::Sieve(curve.clone()), 1000, 50.0, SEED);
        let realised = sieve_curve(&dropped.grains, &curve.diameter, mass);
        for (wanted, realised) in curve.passing.iter().zip(realised) {
            assert!((wanted - realised).abs() < 5.0 / 1000.0);
        }
    }
}

#[test]
fn a_full_box_holds_hardly_a_grain_more_and_keeps_the_sieve_curve() {
    let curve = graded(Mass::Disc);
    let sizes = Sizes::Sieve(curve.clone());
    for (width, height) in [(40.0, 30.0), (5.0, 5.0), (300.0, 20.0), (20.0, 300.0)] {
        let dropped = fill(&below(height, width), &sizes, 1, SEED).unwrap();
        let count = dropped.grains.len();
        assert!(top(&dropped.grains) <= height);
        let gap = (count / 256).max(1);
        let more = (count + 1..=count + gap).map(|more| pack(&sizes, more, width, SEED));
        assert!(more.into_iter().any(|pack| top(&pack.grains) > height));
        let realised = sieve_curve(&dropped.grains, &curve.diameter, Mass::Disc);
        for (wanted, realised) in curve.passing.iter().zip(realised) {
            assert!((wanted - realised).abs() < 5.0 / count as f64);
        }
    }
}

#[test]
fn the_seed_alone_decides() {
    let sizes = uniform(0.5, 1.5);
    assert_eq!(pack(&sizes, 500, 30.0, 3), pack(&sizes, 500, 30.0, 3));
    assert_ne!(pack(&sizes, 500, 30.0, 3), pack(&sizes, 500, 30.0, 4));
}

#[test]
fn the_bits_are_the_same_on_every_platform() {
    let hash = |sizes: &Sizes| {
        let dropped = pack(sizes, 1000, 40.0, SEED);
        // FNV-1a over the bits of x, y and radius, little-endian.
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        for grain in dropped.grains.values() {
            for value in [grain.centre.x, grain.centre.y, grain.radius] {
                for byte in value.to_le_bytes() {
                    hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
                }
            }
        }
        hash
    };
    assert_eq!(hash(&uniform(0.5, 1.5)), 4_210_848_049_899_609_003);
    assert_eq!(
        hash(&Sizes::Sieve(graded(Mass::Sphere))),
        16_755_309_043_996_154_479
    );
}

#[test]
fn what_cannot_be_dropped_says_why() {
    let says = |result: Result<Dropped, PackingError>| result.unwrap_err().to_string();
    assert_eq!(
        says(drop(&Bed::empty_box(3.0), &[1.0, 2.0], 1, SEED)),
        "a grain of diameter 4 does not fit into a box of width 3"
    );
    assert_eq!(
        says(drop(&below(3.0, 9.0), &[2.0], 1, SEED)),
        "a grain of diameter 4 does not fit into a box of height 3"
    );
    assert_eq!(
        says(drop(&Bed::empty_box(9.0), &[1.0, f64::NAN], 1, SEED)),
        "radius NaN is not a number from 1e-30 to 1e30"
    );
    assert_eq!(
        says(drop(&Bed::empty_box(9.0), &[], 1, SEED)),
        "no grains to place"
    );
    assert_eq!(
        says(drop(&Bed::empty_box(9.0), &[1.0], 0, SEED)),
        "a grain needs at least one try"
    );
    assert_eq!(
        says(fill(&below(3.0, 9.0), &uniform(1.0, 2.0), 1, SEED)),
        "a grain of diameter 3.6666666666666665 does not fit into a box of height 3"
    );
}

#[test]
fn grains_that_coordinates_cannot_tell_apart_are_refused() {
    let (width, radius) = (1.0, 1e-12);
    let square = [(0.0, 0.0), (width, 0.0), (width, width), (0.0, width)];
    let container = Container::polygon(&square.map(|(x, y)| Vector::new(x, y)));
    let sizes = uniform(radius, radius);
    let refused = [
        drop(&Bed::empty_box(width), &[radius; 8], 1, SEED).map(|dropped| dropped.grains),
        advancing_front(&container, &sizes, Some(8), SEED),
        rows::square(radius, width, 2, 2),
    ];
    for refused in refused {
        let error = refused.expect_err("a refusal").to_string();
        let expected =
            "radius 0.000000000001 is less than 1e-10 of the coordinates of the container, up to 1";
        assert_eq!(error, expected);
    }
}

#[test]
fn lengths_whose_areas_overflow_are_refused() {
    for radius in [1e200, f64::MAX, f64::INFINITY, f64::NAN, 0.0, 1e-200] {
        let refused = drop(&Bed::empty_box(1e30), &[radius], 1, SEED);
        assert!(
            matches!(refused, Err(PackingError::Radius { .. })),
            "{radius}"
        );
        let refused = rows::square(1.0, radius, 1, 1);
        assert!(
            matches!(refused, Err(PackingError::BoxLength { .. })),
            "{radius}"
        );
    }
}

#[test]
fn ids_count_the_grains_in_the_order_of_dropping() {
    let radii = uniform(0.5, 1.5).radii(50, SEED).unwrap();
    let dropped = drop(&Bed::empty_box(20.0), &radii, 1, SEED).unwrap();
    for (id, grain) in dropped.grains.iter() {
        assert_eq!(grain.radius, radii[id.index()]);
    }
}

proptest! {
    #[test]
    fn every_dropped_pack_is_stable_and_without_overlap(
        seed in any::<u64>(),
        count in 1_usize..300,
        smallest in 0.01..1.0_f64,
        room in 1.0..20.0_f64,
        tries in 1_usize..4,
    ) {
        let width = 2.0 * room;
        let radii = uniform(smallest, 1.0).radii(count, seed).unwrap();
        let dropped = drop(&Bed::empty_box(width), &radii, tries, seed).unwrap();
        prop_assert_eq!(dropped.grains.len(), count);
        assert_in_the_box(&dropped, width);
        assert_no_overlap(&dropped);
        assert_stable(&dropped, width);
    }

    #[test]
    fn every_pack_of_equal_grains_is_stable_and_without_overlap(
        seed in any::<u64>(),
        diameters in 1_u32..24,
        fraction in prop::sample::select(vec![0.0, 0.25, 0.5, 0.7]),
    ) {
        let width = 2.0 * (f64::from(diameters) + fraction);
        let dropped = drop(&Bed::empty_box(width), &[1.0; 200], 1, seed).unwrap();
        assert_in_the_box(&dropped, width);
        assert_no_overlap(&dropped);
        assert_stable(&dropped, width);
    }

    #[test]
    fn grains_dropped_onto_a_bed_rest_on_it(
        seed in any::<u64>(),
        first in 1_usize..100,
        second in 1_usize..100,
        width in 4.0..30.0_f64,
    ) {
        let mut pack = pack(&uniform(0.7, 1.0), first, width, seed);
        let sizes = uniform(0.2, 2.0);
        let bed = Bed { resting: pack.grains.values(), layer: 1, ..Bed::empty_box(width) };
        let radii = sizes.radii(second, Source { seed, layer: 1 }).unwrap();
        let onto = drop(&bed, &radii, 1, seed).unwrap();
        prop_assert_eq!(onto.grains.len(), second);
        pack.grains = join(&pack.grains, &onto.grains);
        pack.supports = join(&pack.supports, &onto.supports);
        assert_in_the_box(&pack, width);
        assert_no_overlap(&pack);
        assert_stable(&pack, width);
    }

    #[test]
    fn a_pack_that_stops_at_a_height_is_the_start_of_the_whole(
        seed in any::<u64>(),
        height in 2.0..30.0_f64,
    ) {
        let radii = uniform(0.5, 1.0).radii(200, seed).unwrap();
        let whole = drop(&Bed::empty_box(12.0), &radii, 1, seed).unwrap();
        let stopped = drop(&below(height, 12.0), &radii, 1, seed).unwrap();
        let count = stopped.grains.len();
        let tops = whole.grains.values().iter().map(|g| g.centre.y + g.radius);
        prop_assert_eq!(tops.take_while(|&top| top <= height).count(), count);
        prop_assert_eq!(stopped.grains.values(), &whole.grains.values()[..count]);
    }

    #[test]
    fn every_sieve_curve_is_met_within_half_a_grain(
        seed in any::<u64>(),
        count in 1_usize..2000,
        steps in prop::collection::vec((1.01..3.0_f64, 0.0..1.0_f64), 1..6),
        sphere in any::<bool>(),
    ) {
        let mass = if sphere { Mass::Sphere } else { Mass::Disc };
        let whole: f64 = steps.iter().map(|step| step.1).sum();
        prop_assume!(whole > 0.1);
        let mut curve = SieveCurve { diameter: vec![0.5], passing: vec![0.0], mass };
        let mut sum = 0.0;
        for (ratio, share) in steps {
            sum += share;
            curve.diameter.push(curve.diameter.last().unwrap() * ratio);
            curve.passing.push(sum / whole);
        }
        let radii = Sizes::Sieve(curve.clone()).radii(count, seed).unwrap();
        prop_assert_eq!(radii.len(), count);
        let total: f64 = radii.iter().map(|r| mass.of(2.0 * r)).sum();
        let heaviest = mass.of(*curve.diameter.last().unwrap());
        let grains: PerGrain<Grain> = radii
            .iter()
            .map(|&radius| Grain { centre: Vector::default(), radius })
            .collect();
        let realised = sieve_curve(&grains, &curve.diameter, mass);
        for (wanted, realised) in curve.passing.iter().zip(realised) {
            prop_assert!((wanted - realised).abs() <= 0.5 * heaviest / total + 1e-9);
        }
    }

    #[test]
    fn hexagonal_rows_touch_and_do_not_overlap(
        radius in 0.1..10.0_f64,
        longest in 2_usize..12,
        count in 1_usize..30,
    ) {
        let width = 2.0 * radius * longest as f64;
        let rows: Vec<usize> = (0..count).map(|row| longest - row % 2).collect();
        let grains = rows::hexagonal(radius, width, &rows).unwrap();
        prop_assert_eq!(grains.len(), rows.iter().sum::<usize>());
        for (a, b, gap) in near_pairs(&grains, 0.1 * radius) {
            prop_assert!(gap.abs() < 1e-12 * radius * grains.len() as f64, "{} {} {}", a, b, gap);
        }
    }
}
