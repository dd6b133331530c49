//! Which bodies touch, without dual graph: enough where only contacts and their directions count.

use crate::assembly::{Grain, Partner, Side};
use crate::geometry::{Container, Grid, HalfPlane, NearPair, Vector};
use crate::ids::{GrainId, PerGrain, PerSide, SideId};

/// Two bodies that touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touching {
    /// A grain, of two grains the one with the lower id.
    pub first: GrainId,
    /// The other body.
    pub second: Partner,
    /// Unit normal n from first to second.
    pub normal: Vector,
}

/// The bodies whose gap is at most `tolerance`: pairs of grains by (first, second), then grains with sides in the
/// order of the sides, present or not; O(N).
///
/// Between grains these are the sites of [`crate::assembly::contact_graph`], found in a small part of its time.
pub fn touching(grains: &PerGrain<Grain>, sides: &PerSide<Side>, tolerance: f64) -> Vec<Touching> {
    let centres: Vec<Vector> = grains.values().iter().map(|g| g.centre).collect();
    let radii: Vec<f64> = grains.values().iter().map(|g| g.radius).collect();
    let near = Grid::new(&centres, &radii).near_pairs(tolerance);
    let pair = |near: &NearPair| {
        let branch = centres[near.second as usize] - centres[near.first as usize];
        Touching {
            first: GrainId(near.first),
            second: Partner::Grain(GrainId(near.second)),
            normal: branch * (1.0 / branch.length()),
        }
    };
    let mut touching: Vec<Touching> = near.iter().map(pair).collect();
    for (id, side) in sides.iter() {
        touching.extend(at_side(grains, id, side, tolerance));
    }
    touching
}

fn at_side<'a>(
    grains: &'a PerGrain<Grain>,
    id: SideId,
    side: &'a Side,
    tolerance: f64,
) -> impl Iterator<Item = Touching> + 'a {
    let near = move |grain: &Grain| side.distance(grain.centre) - grain.radius <= tolerance;
    let joined = grains.iter().filter(move |(_, grain)| near(grain));
    joined.map(move |(first, _)| Touching {
        first,
        second: Partner::Side(id),
        normal: side.outward,
    })
}

/// The container with these sides.
pub fn container(sides: &PerSide<Side>) -> Container {
    let plane = |side: &Side| HalfPlane {
        point: side.start,
        outward: side.outward,
    };
    Container::new(&sides.values().iter().map(plane).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::box_sides;

    #[test]
    fn three_discs_in_a_box_touch_each_other_and_its_sides() {
        let height = 3.0_f64.sqrt();
        let centres = [(1.0, 1.0), (3.0, 1.0), (2.0, 1.0 + height)];
        let grain = |(x, y)| Grain {
            centre: Vector::new(x, y),
            radius: 1.0,
        };
        let grains: PerGrain<Grain> = centres.into_iter().map(grain).collect();
        let sides = box_sides(4.0, 9.0, [false; 4]);
        let found = touching(&grains, &sides, 1e-9);
        let partners: Vec<(u32, Partner)> = found.iter().map(|t| (t.first.0, t.second)).collect();
        let (grain, side) = (|g| Partner::Grain(GrainId(g)), |s| Partner::Side(SideId(s)));
        assert_eq!(
            partners,
            [
                (0, grain(1)),
                (0, grain(2)),
                (1, grain(2)),
                (0, side(0)),
                (1, side(1)),
                (0, side(2)),
                (1, side(2)),
            ]
        );
        let up = Vector::new(0.5, 0.5 * height);
        assert!((found[1].normal - up).length() < 1e-15);
        assert_eq!(found[5].normal, Vector::new(0.0, -1.0));
    }
}
