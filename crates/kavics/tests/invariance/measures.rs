//! Fabric, stress and its parts, strain, work, moduli and void cells.

use std::collections::BTreeMap;

use kavics::equilibrium::State;
use kavics::geometry::Vector;
use kavics::ids::GrainId;
use kavics::measure::{
    ElasticityTensor, Measures, Moduli, Snapshot, SymmetricTensor, Tensor, VoidCell, VoidCells,
    Window, bending_stress, grain_stress, loop_orders, measures, moduli, void_cells,
};
use proptest::prelude::*;

use crate::change::{Change, GRAINS, changes, full};
use crate::equilibrium::{Sizes, actings, cements};
use crate::pile::{Material, Pile};
use crate::twins::{Twin, Twins, close, close_tensors, close_vectors, twins};

/// The same window in both.
struct Windows {
    here: Window,
    there: Window,
    /// Area over that of a square as long as a mean radius, and before the change.
    area: f64,
}

impl Windows {
    fn of(twins: &Twins, chosen: &[bool]) -> Self {
        let all = twins.here.assembly.grains.ids().zip(chosen);
        let here: Vec<GrainId> = all.filter(|(_, yes)| **yes).map(|(id, _)| id).collect();
        let there = here.iter().map(|&id| twins.change.grain(id)).collect();
        let cells = &twins.here.assembly.cell_area;
        Self {
            area: here.iter().map(|&id| cells[id]).sum(),
            here: Window::new(here, GRAINS),
            there: Window::new(there, GRAINS),
        }
    }
}

/// Lengths, areas and directions of contacts.
fn geometry_agrees(
    twins: &Twins,
    found: &Measures,
    before: &Measures,
) -> Result<(), TestCaseError> {
    let (change, tolerance) = (&twins.change, twins.geometry);
    let square = change.scale * change.scale;
    let area = square * before.window_area;
    close("window area", found.window_area, area, tolerance * area)?;
    prop_assert_eq!(found.coordination_number, before.coordination_number);
    for (what, found, before, factor) in [
        ("void ratio", found.void_ratio, before.void_ratio, 1.0),
        (
            "graph porosity",
            found.graph_porosity,
            before.graph_porosity,
            1.0,
        ),
        (
            "porosity as printed",
            found.graph_porosity_printed,
            before.graph_porosity_printed,
            1.0,
        ),
    ] {
        let (found, before) = both(found, before)?;
        close(
            what,
            found,
            factor * before,
            tolerance * before.abs().max(1.0),
        )?;
    }
    for (what, found, before) in [
        ("fabric", found.fabric, before.fabric),
        (
            "fabric of lengths",
            found.fabric_length,
            before.fabric_length,
        ),
        ("branch tensor", found.branch, before.branch),
        ("contact tensor", found.contact, before.contact),
    ] {
        prop_assert_eq!(found.is_some(), before.is_some());
        let [found, before] = [found, before].map(Option::unwrap_or_default);
        close_tensors(what, full(found), change.symmetric(before), tolerance)?;
    }
    Ok(())
}

fn both<T>(found: Option<T>, before: Option<T>) -> Result<(T, T), TestCaseError> {
    found
        .zip(before)
        .ok_or_else(|| TestCaseError::fail("a measure is missing"))
}

/// Stress and its parts, of the window and grain by grain.
fn stresses_agree(twins: &Twins, windows: &Windows, step: &Sizes) -> Result<(), TestCaseError> {
    let [here, there] = [&twins.here, &twins.there].map(Twin::last);
    let (change, factor) = (&twins.change, twins.change.stress());
    // As if each contact of each grain had the largest force.
    let size = step.force * step.length * twins.matches.len() as f64 / windows.area;
    let bound = twins.tolerance * factor * size;
    let found = measures(&there, &windows.there).stress;
    let (found, before) = both(found, measures(&here, &windows.here).stress)?;
    let bending = both(
        bending_stress(&there, &windows.there),
        bending_stress(&here, &windows.here),
    )?;
    for (what, found, before) in [
        ("stress", found.total, before.total),
        ("shear part", found.shear, before.shear),
        ("variation part", found.variation, before.variation),
        ("fabric part", found.fabric, before.fabric),
        ("bending stress", bending.0, bending.1),
    ] {
        close_tensors(what, found, change.tensor(before) * factor, bound)?;
    }
    close(
        "isotropic part",
        found.isotropic,
        factor * before.isotropic,
        bound,
    )?;
    let sum = found.shear + found.variation + found.fabric + Tensor::isotropic(found.isotropic);
    close_tensors("sum of the parts", sum, found.total, bound)?;
    let (all_here, all_there) = (grain_stress(&here), grain_stress(&there));
    for (grain, stress) in all_here.iter() {
        let found = all_there[change.grain(grain)];
        let area = twins.here.assembly.cell_area[grain];
        let bound = bound * windows.area / area;
        close_tensors(
            "stress of a grain",
            found,
            change.tensor(*stress) * factor,
            bound,
        )?;
    }
    Ok(())
}

/// Strain and works; triangles of little area may have a large strain.
fn works_agree(
    twins: &Twins,
    found: &Measures,
    before: &Measures,
    step: &Sizes,
) -> Result<(), TestCaseError> {
    let change = &twins.change;
    prop_assert_eq!(found.strain.is_some(), before.strain.is_some());
    let [e, was] = [found.strain, before.strain].map(Option::unwrap_or_default);
    let size = largest_part(was).max(step.displacement / step.length);
    let bound = twins.tolerance * change.strain() * size;
    close_tensors("strain", e, change.tensor(was) * change.strain(), bound)?;
    let contacts = twins.matches.len() as f64;
    let work = change.energy() * step.force * (size * step.length) * contacts;
    for (what, found, before) in [
        ("contact work", found.contact_work, before.contact_work),
        (
            "macroscopic work",
            found.macroscopic_work,
            before.macroscopic_work,
        ),
        ("boundary work", found.boundary_work, before.boundary_work),
    ] {
        prop_assert_eq!(found.is_some(), before.is_some());
        let [found, before] = [found, before].map(Option::unwrap_or_default);
        close(
            what,
            found,
            change.energy() * before,
            twins.tolerance * work,
        )?;
    }
    Ok(())
}

fn largest_part(a: Tensor) -> f64 {
    crate::twins::largest([a.xx, a.xy, a.yx, a.yy])
}

/// C:e.
fn stress_of(moduli: &ElasticityTensor, strain: SymmetricTensor) -> Tensor {
    let e = [strain.xx, strain.yy, 2.0 * strain.xy];
    let [xx, yy, xy] = moduli
        .rows
        .map(|row| row.iter().zip(e).map(|(c, e)| c * e).sum());
    full(SymmetricTensor { xx, xy, yy })
}

/// Whatever the strain, moduli of the turned answer the turned strain with the turned stress.
fn moduli_agree(twins: &Twins, windows: &Windows) -> Result<(), TestCaseError> {
    let of = |twin: &Twin, window: &Window| -> Option<Moduli> {
        let tangents = twin.path.last()?.tangents.as_ref()?;
        moduli(&twin.assembly, tangents, window)
    };
    let found = of(&twins.there, &windows.there);
    let (found, before) = both(found, of(&twins.here, &windows.here))?;
    let change = &twins.change;
    let factor = change.stress() / change.strain();
    let size = crate::twins::largest(before.voigt.rows.into_iter().flatten());
    let bound = twins.tolerance * factor * size;
    for (xx, yy, xy) in [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 0.5)] {
        let strain = SymmetricTensor { xx, xy, yy };
        let turned = change.symmetric(strain).symmetric();
        for (what, found, before) in [
            ("moduli", &found.tangent, &before.tangent),
            ("Voigt's moduli", &found.voigt, &before.voigt),
        ] {
            let expected = change.tensor(stress_of(before, strain)) * factor;
            close_tensors(what, stress_of(found, turned), expected, bound)?;
        }
    }
    Ok(())
}

/// Cells by the grains around them, the smallest way to tell them first.
fn by_loop(
    cells: &VoidCells,
    name: impl Fn(GrainId) -> GrainId,
) -> BTreeMap<Vec<GrainId>, VoidCell> {
    let named = |(k, cell): (usize, &VoidCell)| {
        let mut around: Vec<GrainId> = cells.around(k).map(&name).collect();
        let turns = (0..around.len()).map(|turn| {
            let mut turned = around.clone();
            turned.rotate_left(turn);
            turned
        });
        if let Some(smallest) = turns.min() {
            around = smallest;
        }
        (around, *cell)
    };
    cells.cells.iter().enumerate().map(named).collect()
}

/// Which cells there are, and each of them; their order in the list follows rows of the plane and ids, so only their
/// histogram of orders is that of before.
fn void_cells_agree(
    twins: &Twins,
    here: &VoidCells,
    there: &VoidCells,
) -> Result<(), TestCaseError> {
    let (change, length) = (&twins.change, twins.here.assembly.mean_radius());
    prop_assert_eq!(loop_orders(&here.cells), loop_orders(&there.cells));
    prop_assert_eq!(here.mean_order(), there.mean_order());
    prop_assert_eq!((here.grains, here.contacts), (there.grains, there.contacts));
    prop_assert_eq!(
        (here.components, here.euler()),
        (there.components, there.euler())
    );
    let square = change.scale * change.scale;
    let bound = twins.geometry * square * length * length;
    let whole = bound * GRAINS as f64;
    close(
        "enclosed area",
        there.enclosed_area,
        square * here.enclosed_area,
        whole,
    )?;
    let renamed = by_loop(here, |grain| change.grain(grain));
    let found = by_loop(there, |grain| grain);
    prop_assert_eq!(renamed.len(), here.cells.len());
    prop_assert!(renamed.keys().eq(found.keys()));
    for (before, found) in renamed.values().zip(found.values()) {
        let counts = |cell: &VoidCell| (cell.order, cell.islands, cell.rattlers);
        prop_assert_eq!(counts(before), counts(found));
        let many = before.order.max(1) as f64;
        close("cell", found.area, square * before.area, bound * many)?;
        close(
            "void",
            found.void_area,
            square * before.void_area,
            bound * many,
        )?;
        // A first moment over an area that islands leave little of.
        let flat = (many * length * length / before.area).max(1.0);
        let far = twins.geometry * flat * many * change.scale * length;
        close_vectors(
            "centroid",
            found.centroid,
            change.point(before.centroid),
            far,
        )?;
        close_tensors(
            "shape",
            full(found.shape),
            change.symmetric(before.shape),
            twins.geometry,
        )?;
    }
    Ok(())
}

/// The state without some of its contacts, the same in both.
fn without(twins: &Twins, lost: &[bool]) -> [State; 2] {
    let mut states = [&twins.here, &twins.there].map(|twin| twin.last().state.clone());
    for ((id, twin), _) in twins.matches.iter().zip(lost).filter(|(_, lost)| **lost) {
        states[0].contacts[id].property = None;
        states[1].contacts[twin.there].property = None;
    }
    states
}

fn choices(count: usize) -> impl Strategy<Value = Vec<bool>> {
    prop::collection::vec(any::<bool>(), count)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(60) })]

    #[test]
    fn measures_of_a_window_go_with_it(
        seed in 0_u64..1000, material in cements(), acting in actings(), change in changes(50.0), mut chosen in choices(GRAINS),
    ) {
        // An empty window has no measures.
        chosen[0] = true;
        let change = change.with_stiffness(material.power());
        let twins = twins(&Pile::dropped(seed), &material, &acting, change)?;
        let windows = Windows::of(&twins, &chosen);
        let [here, there] = [&twins.here, &twins.there].map(Twin::last);
        let (found, before) = (measures(&there, &windows.there), measures(&here, &windows.here));
        let sizes = Sizes::of(&twins, &twins.here.path[2]);
        geometry_agrees(&twins, &found, &before)?;
        stresses_agree(&twins, &windows, &sizes)?;
        works_agree(&twins, &found, &before, &sizes)?;
        moduli_agree(&twins, &windows)?;
    }

    #[test]
    fn void_cells_go_with_their_grains(
        seed in 0_u64..1000, is_dense in any::<bool>(), acting in actings(), change in changes(50.0), lost in choices(300), more in choices(300),
    ) {
        let between = if is_dense {
            kavics::assembly::Between::Neighbours
        } else {
            kavics::assembly::Between::Touching
        };
        let material = Material { between, ..Material::CEMENT };
        let change: Change = change.similar(material.power());
        let twins = twins(&Pile::dropped(seed), &material, &acting, change)?;
        // A quarter of the contacts.
        let lost: Vec<bool> = lost.into_iter().zip(more).map(|(a, b)| a && b).collect();
        let [a, b] = &without(&twins, &lost);
        let [here, there] = [&twins.here, &twins.there].map(Twin::last);
        let cells = [Snapshot { state: a, ..here }, Snapshot { state: b, ..there }].map(|s| void_cells(&s));
        void_cells_agree(&twins, &cells[0], &cells[1])?;
    }
}

/// A turn by Q takes the tensor of x and y to that of Q·x and Q·y.
#[test]
fn a_tensor_turns_with_its_vectors() {
    let change = Change {
        angle: 0.7,
        ..Change::none()
    };
    let (a, b) = (Vector::new(1.0, -0.5), Vector::new(0.3, 2.0));
    let turned = Tensor::product(change.turned(a), change.turned(b));
    let found = change.tensor(Tensor::product(a, b));
    assert!(largest_part(found + turned * -1.0) < 1e-15);
}
