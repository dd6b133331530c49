//! Identities of the measures on equilibria that hold by construction: random contact forces on a small block, and
//! loads that balance them.

mod block;

use block::{Block, block, numbers, regular};
use kavics::assembly::{Contact, Partner};
use kavics::ids::{ContactId, GrainId};
use kavics::measure::{
    Measures, StressPartition, SymmetricTensor, Tensor, Window, average_stress, bending_stress,
    boundary_work, branch_tensor, contact_mean_work, contact_tensor, contact_work,
    fabric_length_tensor, fabric_tensor, geometric_measures, grain_stress, graph_porosity,
    macroscopic_work, measures, moment_asymmetry, strain, stress_partition, window_area,
};
use proptest::prelude::*;

const TIGHT: f64 = 1e-11;

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= TIGHT * (1.0 + a.abs().max(b.abs()))
}

fn same(a: Tensor, b: Tensor) -> bool {
    close(a.xx, b.xx) && close(a.xy, b.xy) && close(a.yx, b.yx) && close(a.yy, b.yy)
}

fn full(tensor: SymmetricTensor) -> Tensor {
    Tensor {
        xx: tensor.xx,
        xy: tensor.xy,
        yx: tensor.xy,
        yy: tensor.yy,
    }
}

fn plus(a: Tensor, b: Tensor) -> Tensor {
    a + b
}

/// Q·a·Qᵀ.
fn turned(a: Tensor, angle: f64) -> Tensor {
    let (c, s) = (libm::cos(angle), libm::sin(angle));
    let rows = [[c, -s], [s, c]];
    let inner = [[a.xx, a.xy], [a.yx, a.yy]];
    let at = |i: usize, j: usize| -> f64 {
        (0..2)
            .flat_map(|k| (0..2).map(move |l| (k, l)))
            .map(|(k, l)| rows[i][k] * inner[k][l] * rows[j][l])
            .sum()
    };
    Tensor {
        xx: at(0, 0),
        xy: at(0, 1),
        yx: at(1, 0),
        yy: at(1, 1),
    }
}

/// A block with random forces and displacements, and a window of some of its grains.
fn blocks() -> impl Strategy<Value = (Block, Window)> {
    let window = prop::collection::vec(any::<bool>(), block::GRAINS);
    (numbers(), window).prop_map(|(numbers, chosen)| {
        let block = block(&numbers);
        let grains = block.some_grains(&chosen);
        (block, grains)
    })
}

fn parts(block: &Block, window: &Window) -> Option<StressPartition> {
    stress_partition(&block.snapshot(), window)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn the_four_parts_add_up_and_three_have_no_trace((block, window) in blocks()) {
        let Some(parts) = parts(&block, &window) else {
            prop_assert!(window.grains().is_empty());
            return Ok(());
        };
        let sum = parts.shear + parts.variation + parts.fabric + Tensor::isotropic(parts.isotropic);
        prop_assert!(same(sum, parts.total));
        for traceless in [parts.shear, parts.variation, parts.fabric] {
            prop_assert!(close(traceless.trace(), 0.0));
        }
        prop_assert!(same(parts.total, average_stress(&block.snapshot(), &window).unwrap()));
    }

    #[test]
    fn stress_parts_of_two_windows_add_up_by_area((block, window) in blocks()) {
        let snapshot = block.snapshot();
        let (rest, all) = (block.complement(&window), block.everything());
        let whole = parts(&block, &all).unwrap();
        let area = window_area(&snapshot, &all);
        let mut sum = StressPartition::default();
        for piece in [&window, &rest] {
            let Some(share) = parts(&block, piece) else { continue };
            let weight = window_area(&snapshot, piece) / area;
            sum.shear += share.shear * weight;
            sum.variation += share.variation * weight;
            sum.fabric += share.fabric * weight;
            sum.isotropic += share.isotropic * weight;
        }
        prop_assert!(same(sum.shear, whole.shear));
        prop_assert!(same(sum.variation, whole.variation));
        prop_assert!(same(sum.fabric, whole.fabric));
        prop_assert!(close(sum.isotropic, whole.isotropic));
    }

    #[test]
    fn a_turned_block_gives_turned_tensors((block, window) in blocks(), angle in -3.0..3.0) {
        let other = block.turned(angle);
        let before = measures(&block.snapshot(), &window);
        let after = measures(&other.snapshot(), &window);
        for (old, new) in tensors(&before).into_iter().zip(tensors(&after)) {
            match (old, new) {
                (Some(old), Some(new)) => prop_assert!(same(turned(old, angle), new)),
                (old, new) => prop_assert_eq!(old, new),
            }
        }
        for (old, new) in numbers_of(&before).into_iter().zip(numbers_of(&after)) {
            prop_assert_eq!(old.is_some(), new.is_some());
            prop_assert!(close(old.unwrap_or(0.0), new.unwrap_or(0.0)));
        }
    }

    #[test]
    fn loads_alone_give_the_stress_of_the_whole((block, _) in blocks()) {
        let snapshot = block.snapshot();
        let all = block.everything();
        let stress = average_stress(&snapshot, &all).unwrap();
        let volume = window_area(&snapshot, &all) * block.assembly.thickness;
        prop_assert!(same(stress * volume, block.first_moment_of_outer_forces()));
    }

    #[test]
    fn grain_stresses_average_to_the_window((block, window) in blocks()) {
        let snapshot = block.snapshot();
        let each = grain_stress(&snapshot);
        let cells = &block.assembly.cell_area;
        let sum = window.grains().iter().map(|&p| each[p] * cells[p]).fold(Tensor::default(), plus);
        let whole = average_stress(&snapshot, &window).unwrap_or_default();
        prop_assert!(same(sum, whole * window_area(&snapshot, &window)));
    }

    #[test]
    fn contact_work_is_macroscopic_and_boundary_work((block, window) in blocks(), e in gradients()) {
        let snapshot = block.snapshot();
        let work = contact_work(&snapshot, &window);
        let stress = average_stress(&snapshot, &window).unwrap_or_default();
        let inside = macroscopic_work(&snapshot, &window, stress, e);
        prop_assert!(close(work, inside + boundary_work(&snapshot, &window, e)));
        let found = measures(&snapshot, &window);
        if let (Some(inside), Some(edge)) = (found.macroscopic_work, found.boundary_work) {
            prop_assert!(close(work, inside + edge));
        }
    }

    #[test]
    fn moments_account_for_the_asymmetry((block, window) in blocks()) {
        let snapshot = block.snapshot();
        if let Some(stress) = average_stress(&snapshot, &window) {
            let expected = moment_asymmetry(&snapshot, &window).unwrap();
            prop_assert!(close(stress.asymmetry(), expected));
        }
    }

    #[test]
    fn bending_makes_the_stress_symmetric_without_external_moments((block, window) in blocks()) {
        let snapshot = block.snapshot();
        if let Some(stress) = average_stress(&snapshot, &window) {
            let bending = bending_stress(&snapshot, &window).unwrap();
            let volume = window_area(&snapshot, &window) * block.assembly.thickness;
            let external = block.external_moment(&window) / volume;
            prop_assert!(close(bending.trace(), 0.0));
            prop_assert!(close((stress + bending).asymmetry(), -external));
        }
    }

    #[test]
    fn fabric_tensors_have_trace_one((block, window) in blocks()) {
        let found = measures(&block.snapshot(), &window);
        let all = [found.fabric, found.fabric_length, found.branch, found.contact];
        for tensor in all.into_iter().flatten() {
            prop_assert!(close(tensor.trace(), 1.0));
            prop_assert!(tensor.eigenvalues()[1] >= -TIGHT);
        }
    }

    #[test]
    fn fabric_tensors_weigh_by_one_length_squared_length_and_dual_length((block, window) in blocks()) {
        let snapshot = block.snapshot();
        let met = block.met(&window);
        let expected = |weight: fn(&Contact) -> f64| {
            let total: f64 = met.iter().map(weight).sum();
            let square = |c: &Contact| Tensor::product(c.normal, c.normal) * (weight(c) / total);
            met.iter().map(square).fold(Tensor::default(), plus)
        };
        let found = [
            (fabric_tensor(&snapshot, &window), expected(|_| 1.0)),
            (fabric_length_tensor(&snapshot, &window), expected(|c| c.branch_length.powi(2))),
            (branch_tensor(&snapshot, &window), expected(|c| c.branch_length)),
            (contact_tensor(&snapshot, &window), expected(|c| c.dual_length_full)),
        ];
        for (tensor, expected) in found {
            prop_assert_eq!(tensor.is_none(), met.is_empty());
            prop_assert!(same(tensor.map(full).unwrap_or_default(), expected));
        }
        let all = measures(&snapshot, &window);
        let fused = [all.fabric, all.fabric_length, all.branch, all.contact];
        prop_assert_eq!(fused, found.map(|(tensor, _)| tensor));
    }

    #[test]
    fn strain_of_an_affine_motion_is_exact((block, window) in blocks(), e in gradients()) {
        let moved = block.affine(e);
        if let Some(found) = strain(&moved.snapshot(), &window) {
            prop_assert!(same(found, e));
        }
    }

    #[test]
    fn the_kite_of_each_contact_does_half_its_work((block, _) in blocks()) {
        let snapshot = block.snapshot();
        for (id, contact) in block.assembly.contacts.iter() {
            let pair = Window::new(contact.grains().collect(), block::GRAINS);
            let mean = contact_mean_work(&snapshot, id);
            prop_assert_eq!(mean.is_none(), contact.touches_side());
            if let Some(mean) = mean {
                prop_assert!(close(mean, 0.5 * contact_work(&snapshot, &pair)));
            }
        }
    }
}

fn gradients() -> impl Strategy<Value = Tensor> {
    let component = || -0.1..0.1;
    (component(), component(), component(), component()).prop_map(|(xx, xy, yx, yy)| Tensor {
        xx,
        xy,
        yx,
        yy,
    })
}

fn tensors(m: &Measures) -> Vec<Option<Tensor>> {
    let directions = [m.fabric, m.fabric_length, m.branch, m.contact];
    let mut all = directions.map(|t| t.map(full)).to_vec();
    all.extend([
        m.stress.map(|s| s.total),
        m.stress.map(|s| s.shear),
        m.stress.map(|s| s.variation),
        m.stress.map(|s| s.fabric),
        m.strain,
    ]);
    all
}

fn numbers_of(m: &Measures) -> [Option<f64>; 8] {
    [
        m.coordination_number,
        m.void_ratio,
        m.graph_porosity,
        m.graph_porosity_printed,
        m.stress.map(|s| s.isotropic),
        m.contact_work,
        m.macroscopic_work,
        m.boundary_work,
    ]
}

#[test]
fn an_empty_window_has_no_measures() {
    let block = regular();
    let found = measures(&block.snapshot(), &Window::new(vec![], block::GRAINS));
    assert_eq!(found, Measures::default());
}

#[test]
fn a_hexagonal_packing_has_graph_porosity_one_and_as_printed_two() {
    let block = regular();
    let found = graph_porosity(&block.snapshot(), &Block::inner()).unwrap();
    assert!(close(found.once, 1.0));
    assert!(close(found.printed, 2.0));
}

#[test]
fn a_hexagonal_packing_is_isotropic_with_six_contacts_a_grain() {
    let block = regular();
    let found = measures(&block.snapshot(), &Block::inner());
    let half = SymmetricTensor {
        xx: 0.5,
        xy: 0.0,
        yy: 0.5,
    };
    for tensor in [
        found.fabric,
        found.branch,
        found.contact,
        found.fabric_length,
    ] {
        assert!(same(full(tensor.unwrap()), full(half)));
    }
    assert_eq!(found.coordination_number, Some(6.0));
    // Area of a cell over that of its disc, 2√3/π, less one.
    let expected = 2.0 * 3.0_f64.sqrt() / std::f64::consts::PI - 1.0;
    assert!(close(found.void_ratio.unwrap(), expected));
}

#[test]
fn equal_normal_forces_on_touching_discs_are_isotropic_stress() {
    let mut block = regular();
    for contact in block.state.contacts.values_mut() {
        contact.force.normal = -2.0;
        contact.force.shear = 0.0;
        contact.force.moment = 0.0;
    }
    let found = parts(&block, &Block::inner()).unwrap();
    // ½·6·R·F over a cell of 2√3·R².
    let expected = -3.0 * 2.0 / (2.0 * 3.0_f64.sqrt() * block.assembly.thickness);
    assert!(close(found.isotropic, expected));
    for part in [found.shear, found.variation, found.fabric] {
        assert!(same(part, Tensor::default()));
    }
}

#[test]
fn partition_of_touching_discs_is_that_of_the_source() {
    let block = regular();
    let window = Window::new(vec![block::INNER], block::GRAINS);
    let found = parts(&block, &window).unwrap();
    let area = block.assembly.cell_area[block::INNER] * block.assembly.thickness;
    let contacts = block.normals_and_forces(block::INNER);
    let mean = contacts.iter().map(|&(n, f)| f.dot(n)).sum::<f64>() / contacts.len() as f64;
    let (mut shear, mut variation) = (Tensor::default(), Tensor::default());
    for (n, force) in contacts {
        let normal = force.dot(n);
        shear += Tensor::product(n, force) + Tensor::product(n, n) * -normal;
        variation += Tensor::product(n, n) * (normal - mean);
    }
    assert!(same(found.shear, shear * (1.0 / area)));
    assert!(same(found.variation, variation * (1.0 / area)));
    assert!(same(found.fabric, Tensor::default()));
    assert!(close(found.isotropic, 3.0 * mean / area));
}

#[test]
fn geometric_measures_are_those_of_all_without_forces_and_displacements() {
    let block = regular();
    let window = Block::inner();
    let all = measures(&block.snapshot(), &window);
    let found = geometric_measures(&block.snapshot(), &window);
    let expected = Measures {
        stress: None,
        strain: None,
        contact_work: None,
        macroscopic_work: None,
        boundary_work: None,
        ..all
    };
    assert_eq!(found, expected);
}

#[test]
fn an_inactive_contact_counts_nowhere() {
    let mut block = regular();
    let window = Window::new(vec![block::INNER], block::GRAINS);
    let touching = |&id: &ContactId| {
        let contact = &block.assembly.contacts[id];
        contact.first == Partner::Grain(block::INNER)
            || contact.second == Partner::Grain(block::INNER)
    };
    let ids: Vec<_> = block.assembly.contacts.ids().filter(touching).collect();
    for id in ids {
        block.state.contacts[id].property = None;
    }
    let found = measures(&block.snapshot(), &window);
    assert_eq!(found.coordination_number, Some(0.0));
    assert_eq!(found.fabric, None);
    assert_eq!(found.graph_porosity, Some(0.0));
    assert_eq!(found.graph_porosity_printed, Some(0.0));
    assert_eq!(found.stress, Some(StressPartition::default()));
}

#[test]
fn a_window_without_triangle_has_no_strain() {
    let block = regular();
    let found = measures(
        &block.snapshot(),
        &Window::new(vec![GrainId(0), GrainId(1)], block::GRAINS),
    );
    assert_eq!(found.strain, None);
    assert_eq!(found.macroscopic_work, None);
    assert_eq!(found.boundary_work, None);
    assert!(found.contact_work.is_some());
}

#[test]
fn grains_that_spin_in_place_do_not_strain() {
    let mut block = regular();
    for body in block.state.displacements.values_mut() {
        (body.x, body.y, body.rotation) = (0.3, -0.2, 1.0);
    }
    let found = strain(&block.snapshot(), &block.everything()).unwrap();
    assert_eq!(found, Tensor::default());
}
