//! Packs of any sizes.

use kavics::assembly::Grain;
use kavics::geometry::{Container, Vector};
use kavics::packing::{
    Bed, Mass, PackingError, Shape, SieveCurve, Sizes, advancing_front, dropped, rows, target,
};

use crate::Numbers;
use crate::scenes::assert_apart;

/// Places grains in the way that `how` says.
pub fn pack(how: u8, numbers: &mut Numbers<'_>) {
    let [width, height] = [numbers.next(), numbers.next()];
    let count = 1 + usize::from(numbers.byte() % 40);
    let seed = u64::from(numbers.byte());
    let placed = match how % 8 {
        0 => rows::hexagonal(numbers.next(), width, &[count, count + 1]),
        1 => rows::square(numbers.next(), width, count, 1 + usize::from(how / 8)),
        2 => radii(numbers, count).and_then(|radii| {
            let tries = 1 + usize::from(how / 64);
            dropped::drop(&bed(width, None), &radii, tries, seed).map(|dropped| dropped.grains)
        }),
        3 => polygon(width, height).and_then(|container| {
            let bed = Bed {
                shape: Shape::Polygon(container),
                ..bed(width, None)
            };
            dropped::drop(&bed, &radii(numbers, count)?, 1, seed).map(|dropped| dropped.grains)
        }),
        4 => sizes(numbers, width * height).and_then(|sizes| {
            dropped::fill(&bed(width, Some(height)), &sizes, 1, seed).map(|dropped| dropped.grains)
        }),
        5 => polygon(width, height).and_then(|container| {
            advancing_front(&container, &any_sizes(numbers), Some(count), seed)
        }),
        6 => polygon(width, height).and_then(|container| {
            advancing_front(&container, &sizes(numbers, width * height)?, None, seed)
        }),
        _ => polygon(width, height).and_then(|container| {
            let fraction = numbers.next();
            target(&container, &sizes(numbers, width * height)?, fraction, seed)
        }),
    };
    if let Ok(grains) = placed {
        assert!(!grains.is_empty());
        assert_apart(grains.values(), 1e-6);
        assert_inside(grains.values(), width);
    }
}

fn bed(width: f64, top: Option<f64>) -> Bed<'static> {
    Bed {
        top,
        ..Bed::empty_box(width)
    }
}

/// A box as a polygon: the library builds none of sides that are no lengths.
fn polygon(width: f64, height: f64) -> Result<Container, PackingError> {
    let length = |length: f64| {
        if (1e-30..=1e30).contains(&length) {
            Ok(length)
        } else {
            Err(PackingError::BoxLength { length })
        }
    };
    let (w, h) = (length(width)?, length(height)?);
    let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)];
    Ok(Container::polygon(&corners.map(|(x, y)| Vector::new(x, y))))
}

fn radii(numbers: &mut Numbers<'_>, count: usize) -> Result<Vec<f64>, PackingError> {
    if numbers.byte().is_multiple_of(2) {
        return any_sizes(numbers).radii(count, 1_u64);
    }
    Ok((0..count).map(|_| numbers.next()).collect())
}

fn any_sizes(numbers: &mut Numbers<'_>) -> Sizes {
    match numbers.byte() % 4 {
        0 => {
            let radius = numbers.next();
            Sizes::Uniform {
                from: radius,
                to: radius,
            }
        }
        1 => Sizes::Uniform {
            from: numbers.next(),
            to: numbers.next(),
        },
        kind => {
            let sieves = 1 + usize::from(numbers.byte() % 5);
            Sizes::Sieve(SieveCurve {
                diameter: (0..sieves).map(|_| numbers.next()).collect(),
                passing: (0..sieves).map(|_| numbers.next() / 8.0).collect(),
                mass: if kind == 2 { Mass::Disc } else { Mass::Sphere },
            })
        }
    }
}

/// Sizes of which few fill the room: others take too long.
fn sizes(numbers: &mut Numbers<'_>, area: f64) -> Result<Sizes, PackingError> {
    let sizes = any_sizes(numbers);
    let smallest = sizes
        .radii(16, 1_u64)?
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    if area / (smallest * smallest) > 1000.0 {
        return Err(PackingError::NoGrains);
    }
    Ok(sizes)
}

fn assert_inside(grains: &[Grain], width: f64) {
    for Grain { centre, radius } in grains {
        let tolerance = 1e-9 * width;
        assert!(centre.x - radius >= -tolerance && centre.x + radius <= width + tolerance);
        assert!(centre.y - radius >= -tolerance);
    }
}
