//! Void cells of small packs whose loops are known, and of dropped grains that lose contacts at random.

use std::f64::consts::{FRAC_PI_4, PI};

use kavics::assembly::{Assembly, Contact, Grain, Partner, Side};
use kavics::contact_law::{ContactForce, Phase, RelativeDisplacement};
use kavics::equilibrium::{ContactState, Displacement, Load, State};
use kavics::geometry::Vector;
use kavics::ids::{GrainId, Id, PerBody, PropertyId, SideId};
use kavics::measure::{Snapshot, Tensor, VoidCell, VoidCells, loop_orders, void_cells};
use kavics::packing::dropped::drop;
use kavics::packing::{Bed, Sizes};
use proptest::prelude::*;

const TIGHT: f64 = 1e-11;

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= TIGHT * (1.0 + a.abs().max(b.abs()))
}

fn disc(x: f64, y: f64, radius: f64) -> Grain {
    Grain {
        centre: Vector::new(x, y),
        radius,
    }
}

/// Touching discs of radius 1 in a ring, and the distance of their centres from that of the ring.
fn ring(count: u32, x: f64) -> (Vec<Grain>, f64) {
    let half = PI / f64::from(count);
    let distance = 1.0 / libm::sin(half);
    let place = |k: u32| {
        let angle = 2.0 * half * f64::from(k);
        disc(
            x + distance * libm::cos(angle),
            distance * libm::sin(angle),
            1.0,
        )
    };
    ((0..count).map(place).collect(), distance)
}

/// Area of the polygon of the centres of a ring, n·cot(π/n) for radius 1.
fn ring_area(count: u32) -> f64 {
    f64::from(count) / libm::tan(PI / f64::from(count))
}

/// Its area less the sectors of its discs, which have inner angles of π − 2π/n.
fn ring_void(count: u32) -> f64 {
    ring_area(count) - 0.5 * PI * (f64::from(count) - 2.0)
}

/// Grains whose contacts are those of touching discs, all of them active but some.
#[derive(Debug)]
struct Pack {
    assembly: Assembly,
    state: State,
    loads: PerBody<Load>,
}

impl Pack {
    fn new(grains: Vec<Grain>) -> Self {
        let touches = |a: &Grain, b: &Grain| {
            (b.centre - a.centre).length() < (a.radius + b.radius) * (1.0 + 1e-9)
        };
        let mut contacts = Vec::new();
        for (i, a) in grains.iter().enumerate() {
            let others = grains.iter().enumerate().skip(i + 1);
            contacts.extend(others.filter(|(_, b)| touches(a, b)).map(|(j, b)| {
                let second = Partner::Grain(GrainId::from_index(j));
                contact(i, second, b.centre - a.centre, a.centre)
            }));
        }
        Self::with(grains, contacts, Vec::new())
    }

    fn with(grains: Vec<Grain>, contacts: Vec<Contact>, sides: Vec<Side>) -> Self {
        let bodies = grains.len() + sides.len();
        Self {
            state: State {
                displacements: PerBody::filled(Displacement::default(), bodies),
                contacts: vec![active(); contacts.len()].into(),
            },
            loads: PerBody::filled(Load::default(), bodies),
            assembly: Assembly {
                cell_area: vec![0.0; grains.len()].into(),
                grains: grains.into(),
                sides: sides.into(),
                contacts: contacts.into(),
                triangles: Vec::new(),
                thickness: 1.0,
            },
        }
    }

    /// The pack without some of its contacts: broken, or open.
    fn without(mut self, lost: impl Fn(usize) -> bool) -> Self {
        for (k, state) in self.state.contacts.values_mut().iter_mut().enumerate() {
            if lost(k) && k % 2 == 0 {
                state.property = None;
            } else if lost(k) {
                state.phase = Phase::Open;
            }
        }
        self
    }

    fn cells(&self) -> VoidCells {
        void_cells(&Snapshot {
            assembly: &self.assembly,
            state: &self.state,
            loads: &self.loads,
            reactions: &self.loads,
        })
    }

    fn centre(&self, grain: GrainId) -> Vector {
        self.assembly.grains[grain].centre
    }

    /// The grains of each component, found by spreading over the contacts; those without one are alone.
    fn components(&self) -> Vec<usize> {
        let mut label: Vec<usize> = (0..self.assembly.grains.len()).collect();
        let pairs: Vec<[usize; 2]> = self.active_pairs().collect();
        while let Some([i, j]) = pairs.iter().find(|[i, j]| label[*i] != label[*j]) {
            let (kept, lost) = (label[*i].min(label[*j]), label[*i].max(label[*j]));
            label
                .iter_mut()
                .filter(|l| **l == lost)
                .for_each(|l| *l = kept);
        }
        label
    }

    fn active_pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        let contacts = self.assembly.contacts.iter();
        contacts
            .filter(|&(id, _)| self.state.contacts[id].is_active())
            .map(|(_, contact)| {
                let mut grains = contact.grains().map(Id::index);
                [grains.next().unwrap(), grains.next().unwrap()]
            })
    }
}

fn contact(first: usize, second: Partner, branch: Vector, from: Vector) -> Contact {
    Contact {
        first: Partner::Grain(GrainId::from_index(first)),
        second,
        normal: branch * (1.0 / branch.length()),
        branch_length: branch.length(),
        point: from + branch * 0.5,
        dual_parts: [0.5; 2],
        dual_length_full: 1.0,
        property: PropertyId(0),
        strength_factor: 1.0,
    }
}

fn active() -> ContactState {
    ContactState {
        displacement: RelativeDisplacement::default(),
        force: ContactForce::default(),
        property: Some(PropertyId(0)),
        broken: false,
        phase: Phase::Closed,
    }
}

/// The only cell of a pack without crossings.
fn only(pack: &Pack) -> VoidCell {
    let found = pack.cells();
    assert_eq!(found.euler(), 0);
    assert_eq!(found.cells.len(), 1);
    found.cells[0]
}

#[test]
fn the_loops_of_a_hexagonal_block_are_triangles() {
    let pitch = 3.0_f64.sqrt();
    let row = |count: u32, left: f64, y: f64| {
        (0..count).map(move |k| disc(left + 2.0 * f64::from(k), y, 1.0))
    };
    let grains = row(5, 1.0, 1.0).chain(row(4, 2.0, 1.0 + pitch));
    let pack = Pack::new(grains.chain(row(5, 1.0, 1.0 + 2.0 * pitch)).collect());
    let found = pack.cells();
    // 2·(4 + 3) triangles in two strips, and V − E + L = 14 − 27 + 14 = 1.
    assert_eq!(loop_orders(&found.cells), [0, 0, 0, 14]);
    assert_eq!(
        (found.grains, found.contacts, found.components),
        (14, 27, 1)
    );
    for (k, cell) in found.cells.iter().enumerate() {
        assert!(close(cell.area, pitch));
        // Three sixths of a disc.
        assert!(close(cell.void_area, pitch - 0.5 * PI));
        assert!(cell.shape.deviator() < TIGHT);
        let corners: Vec<Vector> = found.around(k).map(|grain| pack.centre(grain)).collect();
        let mean = (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0);
        assert!(corners.len() == 3 && (cell.centroid - mean).length() < TIGHT);
    }
    assert_eq!(found.mean_order(), Some(3.0));
}

#[test]
fn the_loops_of_a_square_lattice_are_squares() {
    let place = |k: u32| disc(f64::from(2 * (k % 4)), f64::from(2 * (k / 4)), 1.0);
    let found = Pack::new((0..12).map(place).collect()).cells();
    assert_eq!(loop_orders(&found.cells), [0, 0, 0, 0, 6]);
    assert_eq!(found.euler(), 0);
    for cell in &found.cells {
        assert!(close(cell.area, 4.0) && close(cell.void_area, 4.0 - PI));
        assert!(cell.shape.deviator() < TIGHT && close(cell.shape.trace(), 1.0));
    }
    assert!(close(found.enclosed_area, 24.0));
}

#[test]
fn a_long_loop_has_its_shape_along_it() {
    // Two rows of three discs without the contact in the middle.
    let place = |k: u32| disc(f64::from(2 * (k % 3)), f64::from(2 * (k / 3)), 1.0);
    let pack = Pack::new((0..6).map(place).collect());
    let middle = |k: usize| {
        let contact = &pack.assembly.contacts.values()[k];
        contact.grains().eq([GrainId(1), GrainId(4)])
    };
    let lost: Vec<bool> = (0..pack.assembly.contacts.len()).map(middle).collect();
    let cell = only(&pack.without(|k| lost[k]));
    assert_eq!(cell.order, 6);
    // Of six equal edges, four lie along x.
    assert!(close(cell.shape.xx, 4.0 / 6.0) && close(cell.shape.yy, 2.0 / 6.0));
    assert_eq!(cell.shape.principal_direction(), 0.0);
}

#[test]
fn a_lone_grain_in_a_ring_is_a_rattler_and_solid() {
    let (mut grains, _) = ring(8, 0.0);
    grains.push(disc(0.3, -0.2, 0.5));
    let cell = only(&Pack::new(grains));
    assert_eq!((cell.order, cell.islands, cell.rattlers), (8, 0, 1));
    assert!(close(cell.area, ring_area(8)));
    assert!(close(cell.void_area, ring_void(8) - 0.25 * PI));
    assert!(cell.centroid.length() < TIGHT);
}

#[test]
fn a_pair_in_a_ring_is_an_island() {
    let (mut grains, _) = ring(8, 0.0);
    grains.extend([disc(-0.4, 0.1, 0.4), disc(0.4, 0.1, 0.4)]);
    let cell = only(&Pack::new(grains));
    assert_eq!((cell.order, cell.islands, cell.rattlers), (8, 1, 0));
    assert!(close(cell.area, ring_area(8)));
    assert!(close(cell.void_area, ring_void(8) - 2.0 * 0.16 * PI));
}

#[test]
fn a_chain_that_hangs_in_a_ring_is_part_of_its_loop_but_not_of_its_order() {
    let (mut grains, distance) = ring(8, 0.0);
    grains.extend([
        disc(distance - 1.4, 0.0, 0.4),
        disc(distance - 2.2, 0.0, 0.4),
    ]);
    let pack = Pack::new(grains);
    let cell = only(&pack);
    assert_eq!((cell.order, cell.islands, cell.rattlers), (8, 0, 0));
    assert!(close(cell.area, ring_area(8)));
    assert!(close(cell.void_area, ring_void(8) - 2.0 * 0.16 * PI));
    assert!(cell.shape.deviator() < TIGHT);
    // Eight contacts of the ring and both sides of two contacts.
    assert_eq!(pack.cells().around(0).count(), 12);
}

#[test]
fn an_island_with_a_loop_is_taken_out_of_the_cell_around_it() {
    let (mut grains, _) = ring(8, 0.0);
    let height = 0.75_f64.sqrt();
    grains.extend([
        disc(-0.5, 0.0, 0.5),
        disc(0.5, 0.0, 0.5),
        disc(0.0, height, 0.5),
    ]);
    let found = Pack::new(grains).cells();
    assert_eq!((found.euler(), found.components), (0, 2));
    let triangle = 0.5 * height;
    let [outer, inner] = [found.cells[0], found.cells[1]];
    assert_eq!((outer.order, outer.islands), (8, 1));
    assert_eq!((inner.order, inner.islands), (3, 0));
    assert!(close(inner.area, triangle));
    assert!(close(outer.area, ring_area(8) - triangle));
    // Of the island's discs, half a disc lies in its triangle and the rest around it.
    assert!(close(
        outer.void_area,
        ring_void(8) - triangle - 2.5 * 0.25 * PI
    ));
    // The ring's centroid is the origin, the triangle's a third of its height above.
    let moment = outer.centroid * outer.area + Vector::new(0.0, height / 3.0) * triangle;
    assert!(moment.length() < TIGHT);
}

#[test]
fn an_island_may_touch_itself_at_one_grain() {
    let (mut grains, _) = ring(20, 0.0);
    let height = 3.0_f64.sqrt();
    grains.push(disc(0.0, 0.0, 1.0));
    let corners = [
        (1.0, height),
        (-1.0, height),
        (1.0, -height),
        (-1.0, -height),
    ];
    grains.extend(corners.map(|(x, y)| disc(x, y, 1.0)));
    let found = Pack::new(grains).cells();
    assert_eq!(found.euler(), 0);
    assert_eq!(found.cells.len(), 3);
    let outer = found.cells[0];
    assert_eq!((outer.order, outer.islands), (20, 1));
    assert!(close(outer.area, ring_area(20) - 2.0 * height));
    assert!(close(
        outer.void_area,
        ring_void(20) - 2.0 * height - 4.0 * PI
    ));
}

#[test]
fn a_ring_joined_to_one_around_it_adds_to_the_order_of_the_cell_between() {
    let (mut grains, outer) = ring(20, 0.0);
    let inner = ring(8, 0.0).1;
    grains.extend(ring(8, outer - 2.0 - inner).0);
    let found = Pack::new(grains).cells();
    assert_eq!((found.components, found.euler()), (1, 0));
    let between = found.cells[0];
    assert_eq!((between.order, between.islands), (28, 0));
    assert!(close(between.area, ring_area(20) - ring_area(8)));
}

#[test]
fn nested_rings_keep_what_lies_in_each() {
    let (mut grains, _) = ring(20, 0.0);
    grains.extend(ring(8, 0.0).0);
    let within = disc(0.2, 0.1, 0.5);
    let between = disc(-4.6, 0.0, 0.5);
    // Its nearest neighbour on the left is the inner ring, which lies in the same cell.
    let pair = [disc(4.1, 0.0, 0.3), disc(4.7, 0.0, 0.3)];
    grains.extend([within, between]);
    grains.extend(pair);
    let found = Pack::new(grains).cells();
    assert_eq!((found.components, found.euler()), (3, 0));
    let [outer, inner] = [found.cells[0], found.cells[1]];
    assert_eq!((outer.order, outer.islands, outer.rattlers), (20, 2, 1));
    assert_eq!((inner.order, inner.islands, inner.rattlers), (8, 0, 1));
    assert!(close(outer.area + inner.area, ring_area(20)));
    assert!(close(found.enclosed_area, ring_area(20)));
}

#[test]
fn components_side_by_side_lie_in_no_cell() {
    let (mut grains, _) = ring(8, 0.0);
    grains.extend(ring(8, 9.0).0);
    grains.push(disc(4.5, 3.0, 0.2));
    let found = Pack::new(grains).cells();
    assert_eq!((found.components, found.euler()), (2, 0));
    assert!(
        found
            .cells
            .iter()
            .all(|cell| (cell.islands, cell.rattlers) == (0, 0))
    );
    assert!(close(found.enclosed_area, 2.0 * ring_area(8)));
}

#[test]
fn a_side_closes_no_loop() {
    let grains = vec![disc(0.0, 1.0, 1.0), disc(2.0, 1.0, 1.0)];
    let side = |k: usize| {
        let down = Vector::new(0.0, -1.0);
        contact(k, Partner::Side(SideId(0)), down, grains[k].centre)
    };
    let beside = Partner::Grain(GrainId(1));
    let contacts = vec![
        contact(0, beside, Vector::new(2.0, 0.0), grains[0].centre),
        side(0),
        side(1),
    ];
    let floor = Side {
        name: "bottom".into(),
        start: Vector::new(-2.0, 0.0),
        end: Vector::new(4.0, 0.0),
        outward: Vector::new(0.0, -1.0),
        present: true,
    };
    let found = Pack::with(grains, contacts, vec![floor]).cells();
    assert!(found.cells.is_empty());
    assert_eq!((found.contacts, found.components, found.euler()), (1, 1, 0));
}

#[test]
fn a_graph_without_contacts_has_no_cell() {
    for grains in [vec![], vec![disc(0.0, 0.0, 1.0)]] {
        let found = Pack::new(grains).cells();
        assert!(found.cells.is_empty() && loop_orders(&found.cells).is_empty());
        assert_eq!((found.grains, found.components, found.euler()), (0, 0, 0));
        assert_eq!(found.mean_order(), None);
        assert_eq!(found.enclosed_area, 0.0);
    }
}

#[test]
fn an_eighth_of_a_turn_turns_the_shape_with_it() {
    let (c, s) = (libm::cos(FRAC_PI_4), libm::sin(FRAC_PI_4));
    let turned = |x: f64, y: f64| disc(c * x - s * y, s * x + c * y, 1.0);
    let places = [
        (0.0, 0.0),
        (2.0, 0.0),
        (4.0, 0.0),
        (0.0, 2.0),
        (2.0, 2.0),
        (4.0, 2.0),
    ];
    let pack = Pack::new(places.map(|(x, y)| turned(x, y)).to_vec());
    let pairs: Vec<[usize; 2]> = pack.active_pairs().collect();
    let cell = only(&pack.without(|k| pairs[k] == [1, 4]));
    assert!(close(cell.shape.principal_direction(), FRAC_PI_4));
    assert!(close(cell.shape.deviator(), 1.0 / 3.0));
}

fn dropped(count: usize) -> Vec<Grain> {
    let sizes = Sizes::Uniform { from: 0.5, to: 1.5 };
    let radii = sizes.radii(count, 7).unwrap();
    let dropped = drop(&Bed::empty_box(30.0), &radii, 1, 7).unwrap();
    dropped.grains.values().to_vec()
}

#[test]
fn dropped_grains_satisfy_eulers_relation_and_mean_order() {
    let pack = Pack::new(dropped(330));
    let found = pack.cells();
    assert_eq!(found.euler(), 0);
    // Every contact but those on outlines, of which there are fewer than grains on the surface, has two cells.
    let orders: usize = found.cells.iter().map(|cell| cell.order).sum();
    let outer = found
        .beside()
        .flat_map(|(_, cells)| cells)
        .filter(Option::is_none)
        .count();
    let both = found
        .beside()
        .filter(|(_, [l, r])| l == r && l.is_some())
        .count();
    assert_eq!(orders + outer + 2 * both, 2 * found.contacts);
    assert_eq!(
        loop_orders(&found.cells).iter().sum::<usize>(),
        found.cells.len()
    );
}

/// A dropped pack that has lost each contact with some probability, and a point for each possible cell.
fn packs() -> impl Strategy<Value = (Pack, Vec<Vector>)> {
    let pack = Pack::new(dropped(150));
    let (grains, count) = (
        pack.assembly.grains.values().to_vec(),
        pack.state.contacts.len(),
    );
    let fates = prop::collection::vec(0.0..1.0, count);
    let points = prop::collection::vec((-50.0..50.0, -50.0..50.0), count);
    (fates, 0.0..0.9, points).prop_map(move |(fates, lost, points)| {
        let pack = Pack::new(grains.clone()).without(|k| fates[k] < lost);
        let points = points.into_iter().map(|(x, y)| Vector::new(x, y));
        (pack, points.collect())
    })
}

/// Whether a point lies within a polygon: an odd number of its edges is met upwards.
fn lies_within(point: Vector, corners: &[Vector]) -> bool {
    let next = corners.iter().cycle().skip(1);
    let met = corners.iter().zip(next).filter(|(a, b)| {
        let crosses = (a.y > point.y) != (b.y > point.y);
        crosses && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    met.count() % 2 == 1
}

/// The cell that a grain lies in: the smallest loop of another component around it.
fn cell_around(
    pack: &Pack,
    found: &VoidCells,
    components: &[usize],
    grain: usize,
) -> Option<usize> {
    let point = pack.assembly.grains.values()[grain].centre;
    let polygon = |cell: usize| -> Vec<Vector> {
        found.around(cell).map(|grain| pack.centre(grain)).collect()
    };
    let other = |cell: &usize| {
        let mut grains = found.around(*cell);
        components[grains.next().unwrap().index()] != components[grain]
    };
    let around = (0..found.cells.len()).filter(|cell| lies_within(point, &polygon(*cell)));
    around
        .filter(other)
        .min_by(|&a, &b| shoelace(&polygon(a)).total_cmp(&shoelace(&polygon(b))))
}

fn shoelace(corners: &[Vector]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    0.5 * corners
        .iter()
        .zip(next)
        .map(|(a, b)| a.cross(*b))
        .sum::<f64>()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn a_graph_that_loses_contacts_satisfies_eulers_relation((pack, _) in packs()) {
        let found = pack.cells();
        let components = pack.components();
        let mut linked: Vec<usize> = pack.active_pairs().flatten().collect();
        linked.sort_unstable();
        linked.dedup();
        let mut labels: Vec<usize> = linked.iter().map(|&grain| components[grain]).collect();
        labels.sort_unstable();
        labels.dedup();
        prop_assert_eq!(found.grains, linked.len());
        prop_assert_eq!(found.components, labels.len());
        prop_assert_eq!(found.contacts, pack.active_pairs().count());
        prop_assert_eq!(found.euler(), 0);
    }

    #[test]
    fn areas_of_cells_add_up_to_the_enclosed_area((pack, _) in packs()) {
        let found = pack.cells();
        let sum: f64 = found.cells.iter().map(|cell| cell.area).sum();
        prop_assert!(close(sum, found.enclosed_area));
        for cell in &found.cells {
            prop_assert!(cell.order >= 3 && cell.void_area > 0.0 && cell.void_area < cell.area);
            prop_assert!(close(cell.shape.trace(), 1.0));
        }
    }

    #[test]
    fn islands_and_rattlers_lie_in_the_smallest_loop_around_them((pack, _) in packs()) {
        let found = pack.cells();
        let components = pack.components();
        let mut size = vec![0; components.len()];
        for &label in &components {
            size[label] += 1;
        }
        let mut expected = vec![(0, 0); found.cells.len()];
        for grain in 0..components.len() {
            // The lowest id stands for its component.
            if components[grain] != grain {
                continue;
            }
            let cell = cell_around(&pack, &found, &components, grain);
            if let Some(cell) = cell.map(|cell| &mut expected[cell]) {
                if size[grain] == 1 { cell.1 += 1 } else { cell.0 += 1 }
            }
        }
        let counts: Vec<_> = found.cells.iter().map(|cell| (cell.islands, cell.rattlers)).collect();
        prop_assert_eq!(counts, expected);
    }

    #[test]
    fn dual_branches_and_branches_give_the_enclosed_area((pack, points) in packs()) {
        let found = pack.cells();
        let mut sum = Tensor::default();
        for (id, cells) in found.beside() {
            let contact = &pack.assembly.contacts[id];
            let [first, second] = [contact.first, contact.second]
                .map(|partner| pack.assembly.reference_point(partner));
            let middle = (first + second) * 0.5;
            let [left, right] = cells.map(|cell| cell.map_or(middle, |cell| points[cell]));
            let dual = -(left - right).quarter_turn();
            sum += Tensor::product(dual, second - first);
        }
        let expected = Tensor::isotropic(found.enclosed_area);
        let scale = 1e-9 * (1.0 + found.enclosed_area);
        for (a, b) in [(sum.xx, expected.xx), (sum.xy, 0.0), (sum.yx, 0.0), (sum.yy, expected.yy)] {
            prop_assert!((a - b).abs() < scale, "{} {}", a, b);
        }
    }
}
