//! Displacements, contact forces, reactions, energies and stability.

use kavics::assembly::{Between, ContactPoint, DualLength, Partner, Shaping};
use kavics::contact_law::Reading;
use kavics::equilibrium::{Displacement, Equilibrium, Load};
use kavics::geometry::Vector;
use kavics::loading::Breakage;
use proptest::prelude::*;

use crate::change::{Change, changes};
use crate::pile::{Acting, Material, Pile};
use crate::twins::{Twins, close, close_vectors, largest, twins};

/// Any weight, push and move of the wall, in one step each.
pub fn actings() -> impl Strategy<Value = Acting> {
    let loads = (
        -1.0..1.0_f64,
        0.1..1.0_f64,
        -3.0..3.0_f64,
        -3.0..3.0_f64,
        -3.0..3.0_f64,
    );
    let moves = (-1e-2..1e-2_f64, -1e-2..1e-2_f64, -1e-3..1e-3_f64);
    (loads, moves).prop_map(|((wx, wy, x, y, moment), (ux, uy, rotation))| Acting {
        weight: Vector::new(wx, wy),
        push: Load { x, y, moment },
        wall: Displacement {
            x: ux,
            y: uy,
            rotation,
        },
        factors: [vec![1.0], vec![1.0]],
        breakage: Breakage::WorstFirst,
    })
}

/// Cement of constant stiffness in every shape; grains that do not touch have dual edges in full, as a capped one may be
/// of no length.
pub fn cements() -> impl Strategy<Value = Material> {
    let layouts = prop::sample::select(vec![
        (Between::Touching, DualLength::Capped),
        (Between::Touching, DualLength::Full),
        (Between::Neighbours, DualLength::Full),
    ]);
    let points = prop::sample::select(vec![ContactPoint::Tangent, ContactPoint::Midpoint]);
    (any::<bool>(), any::<bool>(), layouts, points).prop_map(
        |(is_layer, eccentric, (between, dual_length), contact_point)| Material {
            is_layer,
            between,
            shaping: Shaping {
                dual_length,
                contact_point,
            },
            eccentric,
            ..Material::CEMENT
        },
    )
}

/// Sizes that differences are measured by, before the change.
pub struct Sizes {
    pub length: f64,
    pub displacement: f64,
    pub force: f64,
}

impl Sizes {
    pub fn of(twins: &Twins, equilibrium: &Equilibrium) -> Self {
        let radius = twins.here.assembly.mean_radius();
        let moved = equilibrium.state.displacements.values().iter();
        let contacts = equilibrium.state.contacts.values().iter();
        let loads = equilibrium.loads.values().iter();
        let forces =
            contacts.flat_map(|c| [c.force.normal, c.force.shear, c.force.moment / radius]);
        let loads = loads.flat_map(|f| [f.x, f.y, f.moment / radius]);
        Self {
            length: radius,
            displacement: largest(moved.flat_map(|u| [u.x, u.y, radius * u.rotation])),
            force: largest(forces.chain(loads)),
        }
    }
}

/// Displacements, loads and reactions of all bodies.
fn bodies_agree(twins: &Twins, step: usize) -> Result<(), TestCaseError> {
    let (here, there) = (&twins.here.path[step], &twins.there.path[step]);
    let (change, sizes) = (&twins.change, Sizes::of(twins, here));
    let moved = twins.tolerance * change.displacement * sizes.displacement;
    let pushed = twins.tolerance * change.force * sizes.force;
    for body in here.state.displacements.ids() {
        let partner: Partner = twins.here.assembly.partner(body);
        let other = twins.there.assembly.body(change.partner(partner));
        let (found, expected) = (
            there.state.displacements[other],
            change.displacement(here.state.displacements[body]),
        );
        let [found_u, expected_u] = [found, expected].map(|u| Vector::new(u.x, u.y));
        close_vectors("displacement", found_u, expected_u, moved)?;
        let turned = moved / (change.scale * sizes.length);
        close("rotation", found.rotation, expected.rotation, turned)?;
        for (found, expected) in [
            (there.loads[other], here.loads[body]),
            (there.reactions[other], here.reactions[body]),
        ] {
            // On a side, moments have the arm of its length.
            let arm = change.scale * twins.here.assembly.moment_arm(partner).max(sizes.length);
            let expected = change.load(expected);
            let [found_f, expected_f] = [found, expected].map(|f| Vector::new(f.x, f.y));
            close_vectors("load", found_f, expected_f, pushed)?;
            close("moment", found.moment, expected.moment, pushed * arm)?;
        }
    }
    Ok(())
}

/// N and T stay where first and second change places; a bending moment is then seen from the other side.
fn contacts_agree(twins: &Twins, step: usize) -> Result<(), TestCaseError> {
    let (here, there) = (&twins.here.path[step], &twins.there.path[step]);
    let (change, sizes) = (&twins.change, Sizes::of(twins, here));
    let bound = twins.tolerance * change.force * sizes.force;
    for (id, twin) in twins.matches.iter() {
        let (one, other) = (&here.state.contacts[id], &there.state.contacts[twin.there]);
        let sign = if twin.is_reversed { -1.0 } else { 1.0 };
        let moment = sign * change.force * change.scale * one.force.moment;
        let arm = change.scale * sizes.length;
        close(
            "normal force",
            other.force.normal,
            change.force * one.force.normal,
            bound,
        )?;
        close(
            "shear force",
            other.force.shear,
            change.force * one.force.shear,
            bound,
        )?;
        close("bending moment", other.force.moment, moment, bound * arm)?;
        prop_assert_eq!(one.phase, other.phase);
        prop_assert_eq!(one.broken, other.broken);
        prop_assert_eq!(one.property, other.property);
    }
    Ok(())
}

/// Every term of the ledger.
pub fn energies_agree(twins: &Twins, step: usize) -> Result<(), TestCaseError> {
    let [here, there] = [&twins.here, &twins.there].map(|twin| twin.path[step].energy);
    let factor = twins.change.energy();
    let sizes = Sizes::of(twins, &twins.here.path[step]);
    let contacts = twins.matches.len() as f64;
    let bound = twins.tolerance * factor * sizes.force * sizes.displacement * contacts;
    for (what, found, expected) in [
        ("external work", there.external_work, here.external_work),
        ("elastic energy", there.elastic_energy, here.elastic_energy),
        (
            "fracture energy",
            there.fracture_energy,
            here.fracture_energy,
        ),
        ("friction work", there.friction_work, here.friction_work),
        ("release energy", there.release_energy, here.release_energy),
        (
            "work without potential",
            there.nonpotential_work,
            here.nonpotential_work,
        ),
    ] {
        close(what, found, factor * expected, bound)?;
    }
    Ok(())
}

/// Forces, displacements and energies of all load steps.
pub fn paths_agree(twins: &Twins) -> Result<(), TestCaseError> {
    prop_assert_eq!(twins.here.path.len(), twins.there.path.len());
    for step in 0..twins.here.path.len() {
        bodies_agree(twins, step)?;
        contacts_agree(twins, step)?;
        energies_agree(twins, step)?;
    }
    Ok(())
}

/// Eigenvalues are stiffnesses, k = f/u.
fn stability_agrees(twins: &Twins) -> Result<(), TestCaseError> {
    let (here, there) = (twins.here.path.iter(), twins.there.path.iter());
    let factor = twins.change.force / twins.change.displacement;
    for (here, there) in here.zip(there) {
        let (Some(here), Some(there)) = (&here.stability, &there.stability) else {
            prop_assert_eq!(here.stability.is_some(), there.stability.is_some());
            continue;
        };
        let (found, expected) = (there.summary, here.summary);
        prop_assert_eq!(found.static_indeterminacy, expected.static_indeterminacy);
        prop_assert_eq!(found.zero_eigenvalues, expected.zero_eigenvalues);
        let [found, expected] = [found, expected].map(|s| s.lowest_eigenvalue.unwrap_or(0.0));
        let bound = twins.tolerance * factor * expected;
        close("eigenvalue", found, factor * expected, bound)?;
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(60) })]

    /// Displacements are f/k: with the same loads on a layer, whose k grows with lengths, they fall as 1/scale, rotations
    /// as 1/scale².
    #[test]
    fn an_equilibrium_goes_with_its_assembly(
        seed in 0_u64..1000, material in cements(), acting in actings(), change in changes(50.0),
    ) {
        let change = change.with_stiffness(material.power());
        let twins = twins(&Pile::dropped(seed), &material, &acting, change)?;
        prop_assert_eq!(&twins.there.end, &None);
        prop_assert_eq!(twins.there.path.len(), 3);
        paths_agree(&twins)?;
        stability_agrees(&twins)?;
    }

    /// Where stiffness depends on strain, results are similar where strains are equal.
    #[test]
    fn stiffening_shear_goes_with_its_assembly(
        seed in 0_u64..1000, material in cements(), acting in actings(), change in changes(50.0),
        hardening in 0.1..0.75_f64, reading in 0..3_usize,
    ) {
        let reading = [Reading::Printed, Reading::Potential, Reading::History][reading];
        let material = Material { hardening, reading, eccentric: false, ..material };
        let change = change.similar(material.power());
        let twins = twins(&Pile::dropped(seed), &material, &acting, change)?;
        paths_agree(&twins)?;
    }
}

/// The law of the source under the same loads: u ∝ 1/scale, ω ∝ 1/scale², σ ∝ 1/scale, e ∝ 1/scale².
#[test]
fn a_larger_layer_under_the_same_loads_is_stiffer() {
    let layer = Change {
        scale: 2.0,
        ..Change::none()
    };
    let layer = layer.with_stiffness(Material::CEMENT.power());
    let one = Displacement {
        x: 1.0,
        y: 0.0,
        rotation: 1.0,
    };
    let other = layer.displacement(one);
    assert_eq!((other.x, other.rotation), (0.5, 0.25));
    assert_eq!((layer.stress(), layer.strain()), (0.5, 0.25));
}
