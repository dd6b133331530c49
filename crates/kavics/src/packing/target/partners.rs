//! What each disc may meet before it has moved far: discs and sides, listed once for many iterations (Verlet, 1967).

use rayon::prelude::*;

use crate::assembly::Grain;
use crate::geometry::{Grid, HalfPlane, Vector};

/// The partners of every disc.
pub(super) struct Partners {
    skin: f64,
    listed_at: Vec<Vector>,
    start: Vec<u32>,
    /// Numbers of discs; from the count of discs on, sides.
    listed: Vec<u32>,
}

impl Partners {
    /// All partners at gaps up to `skin`, which no disc misses until one has moved by half of it.
    pub(super) fn new(discs: &[Grain], sides: &[HalfPlane], skin: f64) -> Self {
        let listed_at: Vec<Vector> = discs.iter().map(|d| d.centre).collect();
        let radii: Vec<f64> = discs.iter().map(|d| d.radius).collect();
        let near = Grid::new(&listed_at, &radii).near_pairs(skin);
        // Pairs come by their first discs, so each disc meets lower numbers first.
        let downwards = near.iter().map(|p| [p.second, p.first]);
        let upwards = near.iter().map(|p| [p.first, p.second]);
        let mut meetings: Vec<[u32; 2]> = downwards.chain(upwards).collect();
        meetings.extend(at_sides(discs, sides, skin));
        let start = starts(discs.len(), &meetings);
        let mut next = start.clone();
        let mut listed = vec![0_u32; meetings.len()];
        for [disc, partner] in meetings {
            let place = &mut next[disc as usize];
            listed[*place as usize] = partner;
            *place += 1;
        }
        Self {
            skin,
            listed_at,
            start,
            listed,
        }
    }

    /// The partners of a disc in the order of their numbers: discs, then sides counted from the number of discs on.
    pub(super) fn of(&self, disc: usize) -> &[u32] {
        &self.listed[self.start[disc] as usize..self.start[disc + 1] as usize]
    }

    /// Whether discs that were not listed may touch by now.
    pub(super) fn are_outdated(&self, discs: &[Grain]) -> bool {
        let moved = discs.par_iter().zip(&self.listed_at);
        let half = 0.5 * self.skin;
        moved.any(|(d, &at)| (d.centre - at).length_squared() > half * half)
    }
}

/// Discs and the sides near them, by discs.
fn at_sides(discs: &[Grain], sides: &[HalfPlane], skin: f64) -> Vec<[u32; 2]> {
    let mut found = Vec::new();
    for (k, disc) in discs.iter().enumerate() {
        for (s, side) in sides.iter().enumerate() {
            if side.distance(disc.centre) - disc.radius <= skin {
                found.push([k as u32, (discs.len() + s) as u32]);
            }
        }
    }
    found
}

/// Where the partners of each disc start.
fn starts(discs: usize, meetings: &[[u32; 2]]) -> Vec<u32> {
    let mut start = vec![0_u32; discs + 1];
    for &[disc, _] in meetings {
        start[disc as usize + 1] += 1;
    }
    for k in 0..discs {
        start[k + 1] += start[k];
    }
    start
}
