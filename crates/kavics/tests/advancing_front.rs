//! Invariants of packs grown by an advancing front.

use kavics::assembly::Grain;
use kavics::geometry::{Container, Grid, NearPair, Vector};
use kavics::ids::PerGrain;
use kavics::packing::statistics::{packing_fraction, sieve_curve};
use kavics::packing::{Mass, PackingError, SieveCurve, Sizes, advancing_front};
use proptest::prelude::*;

const SEED: u64 = 1;

const UNIFORM: Sizes = Sizes::Uniform { from: 0.5, to: 1.5 };

fn rectangle(width: f64, height: f64) -> Container {
    let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
    Container::polygon(&corners.map(|(x, y)| Vector::new(x, y)))
}

/// Mass spread evenly over ln d.
fn wide(ratio: f64) -> SieveCurve {
    SieveCurve {
        diameter: vec![1.0, ratio],
        passing: vec![0.0, 1.0],
        mass: Mass::Disc,
    }
}

fn near_pairs(grains: &PerGrain<Grain>, reach: f64) -> Vec<NearPair> {
    let centres: Vec<Vector> = grains.values().iter().map(|g| g.centre).collect();
    let radii: Vec<f64> = grains.values().iter().map(|g| g.radius).collect();
    Grid::new(&centres, &radii).near_pairs(reach)
}

/// A few units in the last place of the coordinates.
fn rounding(container: &Container) -> f64 {
    let corners = container.corners().iter();
    16.0 * f64::EPSILON * corners.fold(0.0_f64, |m, c| m.max(c.x.abs()).max(c.y.abs()))
}

/// Touching, apart, inside.
fn assert_sound(container: &Container, grains: &PerGrain<Grain>) {
    let rounding = rounding(container);
    let smallest = grains.values().iter().fold(1.0_f64, |m, g| m.min(g.radius));
    let overlap = rounding + 1e-10 * smallest;
    let mut touching = PerGrain::filled(0, grains.len());
    for pair in near_pairs(grains, rounding) {
        assert!(pair.gap >= -overlap, "{pair:?}");
        touching.values_mut()[pair.first as usize] += 1;
        touching.values_mut()[pair.second as usize] += 1;
    }
    for (id, &contacts) in touching.iter().skip(2) {
        assert!(contacts >= 2, "grain {id} touches {contacts}");
    }
    for (id, grain) in grains.iter() {
        let depth = container.depth(grain.centre);
        assert!(depth >= grain.radius - rounding, "{id} {grain:?} {depth}");
    }
}

/// Difference of the principal values of Σ n n / N over the contacts.
fn fabric_deviator(grains: &PerGrain<Grain>, tolerance: f64) -> f64 {
    let pairs = near_pairs(grains, tolerance);
    let (mut difference, mut mixed) = (0.0, 0.0);
    for pair in &pairs {
        let ends = [pair.first, pair.second].map(|i| grains.values()[i as usize].centre);
        let branch = ends[1] - ends[0];
        let squared = branch.length_squared();
        difference += (branch.x * branch.x - branch.y * branch.y) / squared;
        mixed += 2.0 * branch.x * branch.y / squared;
    }
    Vector::new(difference, mixed).length() / pairs.len() as f64
}

fn inner_fraction(grains: &PerGrain<Grain>, width: f64, height: f64, margin: f64) -> f64 {
    let low = Vector::new(margin, margin);
    packing_fraction(grains, low, Vector::new(width - margin, height - margin))
}

#[test]
fn a_full_box_is_dense_isotropic_and_touching() {
    let container = rectangle(210.0, 210.0);
    let grains = advancing_front(&container, &UNIFORM, None, SEED).unwrap();
    assert!(grains.len() > 10_000);
    assert_sound(&container, &grains);
    let fraction = inner_fraction(&grains, 210.0, 210.0, 10.0);
    assert!((0.82..0.84).contains(&fraction), "{fraction}");
    assert!(fabric_deviator(&grains, 1e-7) <= 0.02);
    let overlaps = near_pairs(&grains, -rounding(&container));
    assert!(overlaps.is_empty(), "{overlaps:?}");
    // Two contacts a grain, but for the first two, and few by accident.
    let contacts = near_pairs(&grains, 1e-7).len();
    let supports = 2 * grains.len() - 3;
    assert!((supports..supports + supports / 1000).contains(&contacts));
}

#[test]
fn a_long_box_is_almost_isotropic() {
    let container = rectangle(800.0, 60.0);
    let grains = advancing_front(&container, &UNIFORM, None, SEED).unwrap();
    assert_sound(&container, &grains);
    let deviator = fabric_deviator(&grains, 1e-7);
    assert!(deviator <= 0.03, "{deviator}");
}

#[test]
fn a_given_count_is_placed_in_the_middle() {
    let container = rectangle(1e6, 1e6);
    let grains = advancing_front(&container, &UNIFORM, Some(10_000), SEED).unwrap();
    assert_eq!(grains.len(), 10_000);
    assert_sound(&container, &grains);
    let middle = Vector::new(5e5, 5e5);
    let farthest = grains
        .values()
        .iter()
        .fold(0.0_f64, |m, g| m.max((g.centre - middle).length()));
    // A disc with packing fraction 0.8: Σ R² = 0.8 × its squared radius; and the roughness of its rim.
    let solid: f64 = grains.values().iter().map(|g| g.radius * g.radius).sum();
    assert!(farthest < (solid / 0.8).sqrt() + 3.0, "{farthest}");
}

#[test]
fn all_radii_are_placed() {
    let container = rectangle(100.0, 100.0);
    let grains = advancing_front(&container, &UNIFORM, Some(2000), SEED).unwrap();
    let mut placed: Vec<f64> = grains.values().iter().map(|g| g.radius).collect();
    let mut wanted = UNIFORM.radii(2000, SEED).unwrap();
    placed.sort_by(f64::total_cmp);
    wanted.sort_by(f64::total_cmp);
    assert_eq!(placed, wanted);
}

#[test]
fn a_full_container_keeps_the_sieve_curve_and_holds_few_grains_more() {
    let curve = SieveCurve {
        diameter: vec![1.0, 2.0, 4.0],
        passing: vec![0.0, 0.6, 1.0],
        mass: Mass::Disc,
    };
    let container = rectangle(60.0, 80.0);
    let sizes = Sizes::Sieve(curve.clone());
    let grains = advancing_front(&container, &sizes, None, SEED).unwrap();
    assert_sound(&container, &grains);
    let realised = sieve_curve(&grains, &curve.diameter, Mass::Disc);
    for (wanted, realised) in curve.passing.iter().zip(realised) {
        assert!((wanted - realised).abs() < 1e-12);
    }
    let more = grains.len() + grains.len() / 50;
    let result = advancing_front(&container, &sizes, Some(more), SEED);
    assert!(matches!(result, Err(PackingError::ContainerFull { .. })));
}

#[test]
fn a_wide_sieve_curve_is_packed_denser() {
    let container = rectangle(1200.0, 1200.0);
    let sizes = Sizes::Sieve(wide(100.0));
    let grains = advancing_front(&container, &sizes, Some(20_000), SEED).unwrap();
    assert_sound(&container, &grains);
    let solid: f64 = grains.values().iter().map(|g| g.radius * g.radius).sum();
    let half = 0.5 * solid.sqrt();
    let corner = Vector::new(half, half);
    let middle = Vector::new(600.0, 600.0);
    let fraction = packing_fraction(&grains, middle - corner, middle + corner);
    assert!(fraction > 0.84, "{fraction}");
}

#[test]
fn equal_grains_form_a_crystal() {
    let container = rectangle(60.0, 60.0);
    let equal = Sizes::Uniform { from: 1.0, to: 1.0 };
    let grains = advancing_front(&container, &equal, Some(400), SEED).unwrap();
    assert_sound(&container, &grains);
    let middle = Vector::new(30.0, 30.0);
    let corner = Vector::new(10.0, 10.0);
    let fraction = packing_fraction(&grains, middle - corner, middle + corner);
    // π/√12 = 0.9069 for the hexagonal packing.
    assert!(fraction > 0.9, "{fraction}");
}

#[test]
fn the_seed_alone_decides() {
    let container = rectangle(50.0, 40.0);
    let pack = |seed| advancing_front(&container, &UNIFORM, None, seed).unwrap();
    assert_eq!(pack(3), pack(3));
    assert_ne!(pack(3), pack(4));
}

#[test]
fn the_bits_are_the_same_on_every_platform() {
    let hash = |sizes: &Sizes| {
        let grains = advancing_front(&rectangle(60.0, 40.0), sizes, Some(300), SEED).unwrap();
        // FNV-1a over the bits of x, y and radius, little-endian.
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        for grain in grains.values() {
            for value in [grain.centre.x, grain.centre.y, grain.radius] {
                for byte in value.to_le_bytes() {
                    hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
                }
            }
        }
        hash
    };
    assert_eq!(hash(&UNIFORM), 4_935_378_023_929_104_762);
    assert_eq!(hash(&Sizes::Sieve(wide(10.0))), 4_547_678_861_410_297_825);
}

#[test]
fn what_cannot_be_packed_says_why() {
    let says = |container: &Container, sizes: &Sizes, count| {
        let result = advancing_front(container, sizes, count, SEED);
        result.unwrap_err().to_string()
    };
    let equal = Sizes::Uniform { from: 1.0, to: 1.0 };
    assert_eq!(
        says(&rectangle(9.0, 1.5), &equal, Some(3)),
        "a grain of diameter 2 does not fit into the container"
    );
    assert_eq!(
        says(&rectangle(9.0, 1.5), &equal, None),
        "a grain of diameter 2 does not fit into the container"
    );
    assert_eq!(
        says(&rectangle(4.0, 2.0), &equal, Some(5)),
        "5 grains do not fit into the container, which is full with 2"
    );
    assert_eq!(
        says(&rectangle(4.0, 2.0), &equal, Some(0)),
        "no grains to place"
    );
    let falling = Sizes::Uniform { from: 2.0, to: 1.0 };
    assert_eq!(
        says(&rectangle(9.0, 9.0), &falling, None),
        "radii from 2 to 1 do not rise"
    );
}

#[test]
fn a_tiny_container_holds_what_fits() {
    let equal = Sizes::Uniform { from: 1.0, to: 1.0 };
    let fitted = |width, height| {
        let container = rectangle(width, height);
        let grains = advancing_front(&container, &equal, None, SEED).unwrap();
        assert_sound(&container, &grains);
        grains.len()
    };
    assert_eq!(fitted(2.0, 2.0), 1);
    assert_eq!(fitted(4.0, 2.0), 2);
    assert_eq!(fitted(2.0, 4.5), 2);
    // On the diagonal: 2 + √2 = 3.42 wide.
    assert_eq!(fitted(3.5, 3.5), 2);
}

/// Corners on an ellipse, counter-clockwise.
fn polygon(angles: &[f64], stretch: f64, size: f64) -> Container {
    let corner = |angle: &f64| {
        let (x, y) = (angle.cos(), angle.sin());
        Vector::new(size * (3.0 + x), size * (stretch * y - 2.0))
    };
    Container::polygon(&angles.iter().map(corner).collect::<Vec<_>>())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_convex_polygon_is_filled_soundly(
        seed in any::<u64>(),
        corners in 3_usize..21,
        jitter in prop::collection::vec(0.0..0.8_f64, 20),
        stretch in 0.05..1.0_f64,
        size in 3.0..40.0_f64,
        smallest in 0.02..1.0_f64,
    ) {
        let step = std::f64::consts::TAU / corners as f64;
        let angles: Vec<f64> = (0..corners).map(|k| (k as f64 + jitter[k]) * step).collect();
        let container = polygon(&angles, stretch, size);
        let sizes = Sizes::Uniform { from: smallest, to: 1.0 };
        match advancing_front(&container, &sizes, None, seed) {
            Ok(grains) => {
                assert_sound(&container, &grains);
                prop_assert!(!grains.is_empty());
            }
            Err(error) => {
                let too_narrow = matches!(error, PackingError::ContainerTooNarrow { .. });
                prop_assert!(too_narrow, "{error}");
            }
        }
    }

    #[test]
    fn every_sieve_curve_is_packed_soundly(
        seed in any::<u64>(),
        count in 1_usize..1500,
        ratio in 1.1..200.0_f64,
    ) {
        let container = rectangle(2e4, 2e4);
        let grains = advancing_front(&container, &Sizes::Sieve(wide(ratio)), Some(count), seed);
        let grains = grains.unwrap();
        prop_assert_eq!(grains.len(), count);
        assert_sound(&container, &grains);
    }
}
