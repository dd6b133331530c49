//! Whether supports hold every piece of the assembly: its three rigid motions must be blocked.

use std::ops::Range;

use super::checker::Checker;
use super::diagnostic::{Problem, short};
use super::sides::side_called;
use crate::assembly::{Assembly, Partner};
use crate::equilibrium::{Freedom, Load};
use crate::geometry::{Pieces, Vector};
use crate::ids::{BodyId, GrainId, Id};
use crate::loading::Program;
use crate::warning::WarningKind;

/// A piece: bodies joined by contacts.
#[derive(Clone, Debug, Default)]
struct Piece {
    bodies: Vec<BodyId>,
    /// Freedoms that are held or moved.
    fixed: Vec<(BodyId, Freedom)>,
    loaded: bool,
}

/// A rigid motion u = (x − ω·(Y − y₀), y + ω·(X − x₀)) of a piece, its rotation scaled by a length.
type Motion = [f64; 3];

/// Checks that no piece of the assembly is free to move as a rigid body under the loads.
pub fn check(assembly: &Assembly, program: &Program, place: &Range<usize>, checker: &mut Checker) {
    if program.held.is_empty() && program.prescribed.is_empty() {
        checker.push(
            Problem::at(
                place,
                "the scene has no support",
                "nothing holds these grains",
            )
            .help("expected a `[[support]]`, a held side such as `[side.bottom]`, or a `[[move]]`"),
        );
        return;
    }
    let mut rattlers = 0;
    let mut adrift = Vec::new();
    for piece in pieces(assembly, program) {
        let grains = grains(&piece, assembly);
        if piece.fixed.is_empty() {
            if piece.loaded {
                adrift.extend(grains.iter().copied());
                side_adrift(&piece, &grains, assembly, place, checker);
            } else {
                rattlers += grains.len();
            }
            continue;
        }
        let Some(motion) = rigid_motion(&piece, assembly) else {
            continue;
        };
        if piece.bodies.len() == 1 && !piece.loaded {
            rattlers += grains.len();
        } else if grains.is_empty() {
            side_adrift(&piece, &grains, assembly, place, checker);
        } else {
            leaves_motion(&motion, &grains, place, checker);
        }
    }
    grains_adrift(adrift, place, checker);
    if rattlers > 0 {
        let grains = if rattlers == 1 {
            "grain is"
        } else {
            "grains are"
        };
        checker.warn(
            WarningKind::SetAside,
            format!("{rattlers} {grains} neither held nor loaded, and set aside"),
        );
    }
}

fn grains(piece: &Piece, assembly: &Assembly) -> Vec<GrainId> {
    let grain = |body: &BodyId| match assembly.partner(*body) {
        Partner::Grain(grain) => Some(grain),
        Partner::Side(_) => None,
    };
    piece.bodies.iter().filter_map(grain).collect()
}

fn named(grains: &[GrainId]) -> String {
    const TOLD: usize = 10;
    let told: Vec<String> = grains.iter().take(TOLD).map(ToString::to_string).collect();
    let word = if grains.len() == 1 { "grain" } else { "grains" };
    let more = match grains.len() - told.len() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("{word} {}{more}", told.join(", "))
}

fn grains_adrift(mut adrift: Vec<GrainId>, place: &Range<usize>, checker: &mut Checker) {
    if adrift.is_empty() {
        return;
    }
    adrift.sort_unstable();
    checker.push(
        Problem::at(
            place,
            format!(
                "nothing holds {}, which a load or weight acts on",
                named(&adrift)
            ),
            "expected a support for every piece that is loaded",
        )
        .help("these grains have no contact with a grain or side that is held"),
    );
}

fn side_adrift(
    piece: &Piece,
    grains: &[GrainId],
    assembly: &Assembly,
    place: &Range<usize>,
    checker: &mut Checker,
) {
    if let ([body], []) = (piece.bodies.as_slice(), grains)
        && let Partner::Side(side) = assembly.partner(*body)
    {
        checker.push(Problem::at(
            place,
            format!(
                "nothing holds {}, which is loaded",
                side_called(&assembly.sides[side].name)
            ),
            "expected grains that touch it",
        ));
    }
}

fn leaves_motion(motion: &str, grains: &[GrainId], place: &Range<usize>, checker: &mut Checker) {
    checker.push(
        Problem::at(
            place,
            format!("support leaves a rigid motion: {motion}"),
            format!(
                "expected that {} cannot move as a rigid body",
                named(grains)
            ),
        )
        .help("hold a further freedom against this motion"),
    );
}

fn pieces(assembly: &Assembly, program: &Program) -> Vec<Piece> {
    let count = assembly.body_count();
    let contacts = assembly.contacts.values().iter();
    let edges = contacts.map(|c| [assembly.body(c.first).0, assembly.body(c.second).0]);
    let tied = Pieces::new(count, edges);
    let mut pieces = vec![Piece::default(); count];
    for body in 0..count {
        pieces[tied.of(body)].bodies.push(BodyId::from_index(body));
    }
    let held = program.held.iter().map(|held| (held.body, held.freedom));
    let moved = program.prescribed.iter().map(|p| (p.body, p.freedom));
    for (body, freedom) in held.chain(moved) {
        pieces[tied.of(body.index())].fixed.push((body, freedom));
    }
    for load in &program.loads {
        pieces[tied.of(load.body.index())].loaded |= load.load != Load::default();
    }
    pieces.retain(|piece| !piece.bodies.is_empty());
    pieces
}

/// A rigid motion that the fixed freedoms of a piece leave, in words; none if they block all three.
fn rigid_motion(piece: &Piece, assembly: &Assembly) -> Option<String> {
    let points: Vec<Vector> = piece
        .fixed
        .iter()
        .map(|(body, _)| assembly.reference_point(assembly.partner(*body)))
        .collect();
    let centre =
        points.iter().fold(Vector::default(), |sum, p| sum + *p) * (points.len() as f64).recip();
    let size = points
        .iter()
        .map(|p| (*p - centre).length())
        .fold(0.0, f64::max)
        .max(assembly.mean_radius());
    let mut basis: Vec<Motion> = Vec::new();
    for ((_, freedom), point) in piece.fixed.iter().zip(&points) {
        let arm = (*point - centre) * size.recip();
        let row = match freedom {
            Freedom::X => [1.0, 0.0, -arm.y],
            Freedom::Y => [0.0, 1.0, arm.x],
            Freedom::Rotation => [0.0, 0.0, 1.0],
        };
        basis.extend(independent(row, &basis));
        if basis.len() == 3 {
            return None;
        }
    }
    let left = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        .into_iter()
        .find_map(|motion| independent(motion, &basis))?;
    Some(in_words(left, centre, size))
}

/// The part of a motion that is orthogonal to others, scaled to length 1; none if nothing is left.
fn independent(motion: Motion, basis: &[Motion]) -> Option<Motion> {
    let dot = |a: Motion, b: Motion| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let mut rest = motion;
    for _ in 0..2 {
        for known in basis {
            let share = dot(rest, *known);
            rest = [0, 1, 2].map(|i| rest[i] - share * known[i]);
        }
    }
    let length = dot(rest, rest).sqrt();
    (length > 1e-7).then(|| rest.map(|part| part / length))
}

fn in_words([x, y, turn]: Motion, centre: Vector, size: f64) -> String {
    if turn.abs() < 1e-7 {
        return match (x.abs() < 1e-7, y.abs() < 1e-7) {
            (false, true) => "translation in x".to_owned(),
            (true, false) => "translation in y".to_owned(),
            _ => format!("translation along ({x:.3}, {y:.3})"),
        };
    }
    // Where x − ω·(Y − y₀) and y + ω·(X − x₀) vanish.
    let turn = turn / size;
    let pole = centre + Vector::new(-y, x) * turn.recip();
    // What is nothing against the size is rounding.
    let coordinate = |value: f64| {
        short(if value.abs() < 1e-9 * size {
            0.0
        } else {
            value
        })
    };
    format!(
        "rotation about ({}, {})",
        coordinate(pole.x),
        coordinate(pole.y)
    )
}
